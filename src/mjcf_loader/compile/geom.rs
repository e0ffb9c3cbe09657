//! Compiles geoms: shape, pose, volume and mass.

use super::context::{Context, Ids, named};
use super::fluid::fluid;
use super::geometry::{EPS, Solid, bounding_box, bounding_radius, inertia, segment, size_count, volume};
use super::mesh::fit;
use super::shell;
use crate::document::{Frame, Geom};
use crate::error::{ErrorKind, LoadError};
use crate::math::{Quat, Vec3, add, mat_vec, quat_mul, quat_to_mat};
use crate::model::{Arrays, GeomType, HField};
use crate::settings::single;
use crate::words::SHAPES;

/// Returns the position, orientation and size of a shape, from its frame or from `fromto`.
pub(super) fn place(
    context: &Context,
    at: usize,
    kind: GeomType,
    mut size: Vec3,
    frame: &Frame,
    fromto: Option<[f64; 6]>,
) -> Result<(Vec3, Quat, Vec3), LoadError> {
    let Some(fromto) = fromto else {
        return Ok((frame.pos, context.quat_of(at, frame)?, size));
    };
    if frame.pos != [0.0; 3] {
        return Err(context.invalid(at, "fromto and a pos that is not 0 are mutually exclusive"));
    }
    let (pos, quat, half) = segment(&fromto);
    match kind {
        GeomType::Capsule | GeomType::Cylinder => size[1] = half,
        GeomType::Box | GeomType::Ellipsoid => size = [size[0], size[0], half],
        GeomType::Plane | GeomType::HField | GeomType::Sphere | GeomType::Mesh => {
            return Err(context.invalid(at, "fromto needs a capsule, cylinder, box or ellipsoid"));
        }
    }
    if half < EPS {
        return Err(context.invalid(at, "the points of fromto are too close"));
    }
    Ok((pos, quat, size))
}

/// Checks that the entries of a size that the shape uses are positive; the extent of a plane may be zero, which means infinite.
pub(super) fn check_size(context: &Context, at: usize, kind: GeomType, size: &Vec3) -> Result<(), LoadError> {
    let first = if kind == GeomType::Plane { 2 } else { 0 };
    let count = size_count(kind);
    let Some(index) = (first..count).find(|&index| size[index] <= 0.0) else {
        return Ok(());
    };
    let word = SHAPES.values.iter().position(|&shape| shape == kind);
    let error = ErrorKind::BadSize {
        shape: word.map_or("", |word| SHAPES.names[word]),
        number: index + 1,
        count,
        value: size[index],
    };
    Err(context.error(at, error))
}

const SHELL: &str = "a mesh is a shell by inertia=\"shell\" of <mesh>, not by shellinertia of its geoms";

/// Compiles a geom; returns it as a solid.
pub(super) fn compile_geom(
    context: &Context,
    geom: &Geom,
    body: usize,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<Solid, LoadError> {
    let (mut pos, mut quat, mut size) = place(context, geom.at, geom.kind, geom.size, &geom.frame, geom.fromto)?;
    let hfield = hfield_of(context, geom, ids)?;
    let mesh = place_mesh(context, geom, ids, (&mut pos, &mut quat, &mut size), arrays)?;
    let (pos, quat) = context.placed(geom.within, pos, quat);
    // after `place_mesh`, which sets the sizes of meshes and fitted shapes
    check_size(context, geom.at, geom.kind, &size)?;
    if !matches!(geom.condim, 1 | 3 | 4 | 6) {
        return Err(context.invalid(geom.at, "condim must be 1, 3, 4 or 6"));
    }
    if geom.kind == GeomType::Plane && arrays.body_weldid[body] != 0 {
        return Err(context.invalid(geom.at, "a plane can only be in a body that does not move"));
    }
    let find = |name: &String| ids.material.find(context.tree, geom.at, "material", name);
    arrays.geom_name.push(geom.name.clone());
    arrays.geom_type.push(geom.kind);
    if let Some(id) = hfield {
        let [x, y, top, base] = arrays.hfields[id].size;
        // MuJoCo's size of the geom: a box that has the height of the base and half that of the terrain
        size = [x, y, 0.25 * top + 0.5 * base];
    }
    arrays.geom_size.push(size);
    arrays.geom_bodyid.push(body);
    arrays.geom_pos.push(pos);
    arrays.geom_quat.push(quat);
    arrays.geom_contype.push(geom.contype);
    arrays.geom_conaffinity.push(geom.conaffinity);
    arrays.geom_condim.push(geom.condim);
    arrays.geom_priority.push(geom.priority);
    arrays.geom_friction.push(geom.friction);
    arrays.geom_solmix.push(geom.solmix);
    arrays.geom_solref.push(geom.solref);
    arrays.geom_solimp.push(geom.solimp);
    arrays.geom_margin.push(geom.margin);
    arrays.geom_gap.push(geom.gap);
    arrays.geom_fluid.push(if geom.ellipsoid {
        fluid(geom.kind, &size, geom.fluidcoef)
    } else {
        [0.0; 12]
    });
    let extent = match hfield.map(|id| &arrays.hfields[id]) {
        Some(hfield) => Extent::of_hfield(hfield),
        None => Extent::of(geom.kind, &size, mesh, arrays),
    };
    arrays.geom_aabb.push(extent.aabb);
    arrays.geom_dataid.push(mesh.or(hfield));
    arrays
        .geom_rbound
        .push(extent.radius.unwrap_or_else(|| bounding_radius(geom.kind, &size)));
    arrays.geom_group.push(geom.group);
    arrays.geom_rgba.push(geom.rgba.map(single));
    arrays.geom_matid.push(named(&geom.material).map(find).transpose()?);
    solid(context, geom, &extent, (pos, quat))
}

/// Returns a geom of this extent as a solid at a pose.
fn solid(context: &Context, geom: &Geom, extent: &Extent, (pos, quat): (Vec3, Quat)) -> Result<Solid, LoadError> {
    if geom.shell && geom.kind == GeomType::Mesh {
        return Err(context.invalid(geom.at, SHELL));
    }
    let volume = if geom.shell {
        shell::area(geom.kind, &extent.inertia_box)
    } else {
        extent.volume
    };
    let mass = match geom.mass {
        // MuJoCo turns a mass into a density, and a geom without volume has none
        Some(mass) if volume > EPS => mass,
        Some(_) => 0.0,
        None => geom.density * volume,
    };
    let inertia = if geom.shell { shell::inertia } else { inertia };
    Ok(Solid {
        pos,
        quat,
        mass,
        inertia: inertia(geom.kind, &extent.inertia_box, mass),
    })
}

/// The space that a geom fills.
struct Extent {
    aabb: [f64; 6],
    volume: f64,
    /// The size from which inertia is computed.
    inertia_box: Vec3,
    /// Radius of its bounding sphere, if that does not follow from its size.
    radius: Option<f64>,
}

impl Extent {
    /// Returns the extent of a height field, whose mass is that of a box of its mean height.
    fn of_hfield(hfield: &HField) -> Self {
        let [x, y, top, base] = hfield.size;
        let size = [x, y, 0.25 * top + 0.5 * base];
        Self {
            aabb: [0.0, 0.0, (top - base) / 2.0, x, y, (top + base) / 2.0],
            volume: volume(GeomType::HField, &size),
            inertia_box: size,
            radius: Some((x * x + y * y + (top * top).max(base * base)).sqrt()),
        }
    }

    /// Returns the extent of a mesh geom, or of a primitive shape, which may have been fitted to a mesh.
    fn of(kind: GeomType, size: &Vec3, mesh: Option<usize>, arrays: &Arrays) -> Self {
        match mesh.filter(|_| kind == GeomType::Mesh).map(|id| &arrays.meshes[id]) {
            Some(mesh) => {
                let [low, high] = mesh.bounds;
                let half = |k: usize, sign: f64| (high[k] + sign * low[k]) / 2.0;
                let [centre, reach] = [1.0, -1.0].map(|sign| [half(0, sign), half(1, sign), half(2, sign)]);
                Self {
                    aabb: [centre[0], centre[1], centre[2], reach[0], reach[1], reach[2]],
                    volume: mesh.volume,
                    inertia_box: mesh.inertia_box,
                    radius: None,
                }
            }
            None => Self {
                aabb: bounding_box(kind, size),
                volume: volume(kind, size),
                inertia_box: *size,
                radius: None,
            },
        }
    }
}

/// Returns the height field of a geom that is one.
fn hfield_of(context: &Context, geom: &Geom, ids: &Ids) -> Result<Option<usize>, LoadError> {
    match (&geom.hfield, geom.kind) {
        (Some(name), GeomType::HField) => ids.hfield.find(context.tree, geom.at, "hfield", name).map(Some),
        (None, GeomType::HField) => Err(context.error(geom.at, ErrorKind::MissingAttribute("hfield"))),
        (Some(_), _) => Err(context.invalid(geom.at, "only a geom with type=\"hfield\" has a height field")),
        (None, _) => Ok(None),
    }
}

/// Moves a geom to the frame of its mesh, and sets its size to that of the mesh or of the shape that is fitted to it. Returns the mesh.
fn place_mesh(
    context: &Context,
    geom: &Geom,
    ids: &Ids,
    (pos, quat, size): (&mut Vec3, &mut Quat, &mut Vec3),
    arrays: &mut Arrays,
) -> Result<Option<usize>, LoadError> {
    let Some(name) = &geom.mesh else {
        return match geom.kind {
            GeomType::Mesh => Err(context.error(geom.at, ErrorKind::MissingAttribute("mesh"))),
            _ => Ok(None),
        };
    };
    if geom.fromto.is_some() {
        return Err(context.error(geom.at, ErrorKind::Conflict("fromto", "mesh")));
    }
    let id = ids.mesh.find(context.tree, geom.at, "mesh", name)?;
    let mesh = &mut arrays.meshes[id];
    if geom.kind == GeomType::Mesh {
        let [low, high] = mesh.bounds;
        // a box around the origin, as MuJoCo sizes mesh geoms; their bounding boxes are tighter
        *size = std::array::from_fn(|k| low[k].abs().max(high[k].abs()));
    } else {
        let fitted = fit(geom.kind, mesh, context.compiler(geom.at).fitaabb, geom.fitscale)
            .ok_or_else(|| context.invalid(geom.at, "a plane cannot be fitted to a mesh"))?;
        // entries that the shape does not use keep what the document gives
        let used = size_count(geom.kind);
        size[..used].copy_from_slice(&fitted.size[..used]);
        // MuJoCo moves the mesh itself, for all geoms that follow
        mesh.pos = fitted.pos;
    }
    *pos = add(*pos, mat_vec(&quat_to_mat(*quat), mesh.pos));
    *quat = quat_mul(*quat, mesh.quat);
    Ok(Some(id))
}
