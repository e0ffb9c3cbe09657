//! Compiles meshes: from the triangles of a file or the document to a mesh that is centred and along its principal axes.
//!
//! MuJoCo 3.3.0 keeps vertices in single precision between all steps, so the same is done here, in its order of operations: then
//! masses, inertias and poses are the same to the last bits.

mod fit;
mod inertia;
mod normals;
mod polygons;
mod source;

pub(super) use fit::fit;
pub(super) use source::{indices, rows};

use super::asset_name::asset_name;
use super::context::{Context, Ids};
use super::geometry::normalize;
use crate::assets::AssetSource;
use crate::document::TypedDocument;
use crate::error::LoadError;
use crate::math::hull::quickhull;
use crate::math::qhull;
use crate::math::{Vec3, mat_t_vec, mat_vec, quat_to_mat};
use crate::mesh::{Mesh, MeshInertia};
use crate::model::{self, Arrays, GeomType, MeshHull, MeshPolygons};
use inertia::MassProperties;
use source::Surface;

/// Compiles all meshes. Their files are looked up in `source`.
pub(super) fn compile_meshes(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    source: &dyn AssetSource,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let touching = touching(context, document, ids)?;
    // for all meshes together
    let mut left = context.tree.limits.mesh_elements;
    for (mesh, touches) in document.meshes.iter().zip(touching) {
        let path = mesh
            .file
            .as_ref()
            .map(|file| context.asset_path(mesh.at, file, [context.meshdir(mesh.at); 2], source))
            .transpose()?;
        let surface = source::read(context, mesh, path.as_deref(), source, &mut left)?;
        let options = (touches, document.option.flags.multiccd, document.mesh_density);
        let compiled = compile(mesh, surface, options).map_err(|m| context.invalid(mesh.at, m))?;
        let name = asset_name(context.tree, mesh.at, &mesh.name, mesh.file.as_deref())?;
        arrays.meshes.push(model::Mesh { name, ..compiled });
    }
    Ok(())
}

/// Returns the meshes that need a hull: those of geoms whose masks let them touch others. Geoms that touch only in a `<pair>` do so with all their
/// vertices, as in MuJoCo.
fn touching(context: &Context, document: &TypedDocument, ids: &Ids) -> Result<Vec<bool>, LoadError> {
    let mut touching = vec![false; document.meshes.len()];
    for geom in document.bodies.iter().flat_map(|body| &body.geoms) {
        if let Some(name) = &geom.mesh
            && geom.kind == GeomType::Mesh
            && geom.contype | geom.conaffinity != 0
        {
            touching[ids.mesh.find(context.tree, geom.at, "mesh", name)?] = true;
        }
    }
    Ok(touching)
}

const NO_HULL: &str = "the mesh has no convex hull: its vertices are on a plane, on a line or at one point";
const HULL: &str = "rounding errors leave no hull of at most maxhullvert corners: leave maxhullvert out";

/// Compiles a mesh. A mesh that can touch gets a hull, and the hull's polygons if pairs may have several contacts.
fn compile(
    mesh: &Mesh,
    surface: Surface,
    (touches, several, density): (bool, bool, f64),
) -> Result<model::Mesh, &'static str> {
    let Surface {
        mut vert,
        normal,
        texcoord,
        mut face,
        facenormal,
        facetexcoord,
    } = surface;
    if mesh.inertia == MeshInertia::Exact {
        normals::check_orientation(&vert, &face)?;
    }
    // before `transform`, as in MuJoCo: Qhull could order scaled vertices differently
    let mut hull = (touches || face.is_empty() || mesh.inertia == MeshInertia::Convex)
        .then(|| hull(&vert, usize::try_from(mesh.maxhullvert).ok()))
        .transpose()?;
    if let Some(hull) = hull.as_ref().filter(|_| face.is_empty()) {
        face.clone_from(&hull.face);
    }
    let (mut normal, facenormal) = if normal.is_empty() {
        (normals::of_vertices(&vert, &face, mesh.smoothnormal), face.clone())
    } else if facenormal.is_empty() {
        (normal, face.clone())
    } else {
        (normal, facenormal)
    };
    let facetexcoord = match () {
        () if texcoord.is_empty() => Vec::new(),
        () if facetexcoord.is_empty() => face.clone(),
        () => facetexcoord,
    };
    if !exist(&facenormal, normal.len()) || !exist(&facetexcoord, texcoord.len()) {
        return Err("there must be as many normals and texture coordinates as vertices");
    }
    let mut polygons = match &hull {
        _ if !several => MeshPolygons::default(),
        Some(hull) => polygons::join(&hull.face, &vert),
        None => polygons::join(&face, &vert),
    };
    transform(mesh, &mut vert, &mut normal);
    let of_hull = mesh.inertia == MeshInertia::Convex || hull.as_ref().is_some_and(|hull| hull.face == face);
    let counted = match (&hull, mesh.inertia) {
        (Some(hull), MeshInertia::Convex) => &hull.face,
        _ => &face,
    };
    let solid = MassProperties::of(&mut vert, &face, counted, mesh.inertia, density)?;
    let bounds = turn(&mut vert, &mut normal, solid.quat);
    polygons::turn(&mut polygons, &vert);
    if let Some(hull) = &mut hull {
        hull.place(&vert);
    }
    Ok(model::Mesh {
        name: String::new(),
        vert,
        normal,
        texcoord,
        face,
        facenormal,
        facetexcoord,
        hull,
        polygons,
        scale: mesh.scale,
        pos: solid.pos,
        quat: solid.quat,
        bounds,
        volume: solid.volume,
        of_hull,
        inertia_box: solid.inertia_box,
    })
}

/// Returns whether the indices of all corners are below `count`, the number of normals or texture coordinates.
fn exist(corners: &[[u32; 3]], count: usize) -> bool {
    let mut all = corners.as_flattened().iter();
    all.all(|&i| i == model::Mesh::NONE || (i as usize) < count)
}

/// Builds the convex hull, with at most `most` corners, in Qhull's order as in MuJoCo. Where Qhull would fail, the order is that of the
/// vertices.
fn hull(vert: &[[f32; 3]], most: Option<usize>) -> Result<MeshHull, &'static str> {
    let points: Vec<Vec3> = vert.iter().map(|v| v.map(f64::from)).collect();
    let ordered =
        qhull::hull(&points, most).and_then(|hull| MeshHull::ordered(hull.corners, &hull.edges, hull.triangles));
    if let Some(hull) = ordered {
        return Ok(hull);
    }
    let hull = hull_of(&points).ok_or(NO_HULL)?;
    if most.is_some_and(|most| hull.vert.len() > most) {
        return Err(HULL);
    }
    Ok(hull)
}

/// Builds the convex hull in the order of the vertices; `None` if they span no volume.
fn hull_of(points: &[Vec3]) -> Option<MeshHull> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for v in points {
        for k in 0..3 {
            low[k] = low[k].min(v[k]);
            high[k] = high[k].max(v[k]);
        }
    }
    let extent = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    // a factor of two leaves every digit as it is, and numbers near one leave room for small faces
    let unit = (-extent.log2().floor().clamp(-1000.0, 1000.0)) as i32;
    let factor = f64::from_bits(((1023 + i64::from(unit)) as u64) << 52);
    let centred = points
        .iter()
        .map(|v| std::array::from_fn(|k| (v[k] - 0.5 * (low[k] + high[k])) * factor));
    let points: Vec<Vec3> = centred.collect();
    // single precision leaves errors of 1e-7, so that even the last leaves out nothing that one could see
    let faces = [1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9]
        .iter()
        .find_map(|&tolerance| quickhull(&points, tolerance))?;
    let alive = faces.iter().filter(|face| face.alive);
    Some(MeshHull::new(alive.map(|face| face.corner.map(|i| i as u32)).collect()))
}

/// Moves, turns and scales a mesh as the document requests.
fn transform(mesh: &Mesh, vert: &mut [[f32; 3]], normal: &mut [[f32; 3]]) {
    if mesh.refpos != [0.0; 3] {
        let origin = mesh.refpos.map(|x| x as f32);
        for v in vert.iter_mut() {
            *v = std::array::from_fn(|k| v[k] - origin[k]);
        }
    }
    if mesh.refquat != [1.0, 0.0, 0.0, 0.0] {
        let mut quat = mesh.refquat;
        normalize(&mut quat);
        let mat = quat_to_mat(quat);
        for v in vert.iter_mut().chain(normal.iter_mut()) {
            *v = mat_t_vec(&mat, v.map(f64::from)).map(|x| x as f32);
        }
    }
    if mesh.scale != [1.0; 3] {
        for v in vert.iter_mut().chain(normal.iter_mut()) {
            *v = std::array::from_fn(|k| (f64::from(v[k]) * mesh.scale[k]) as f32);
        }
    }
    for n in normal {
        let square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        *n = if f64::from(square) > crate::math::MINVAL {
            let factor = 1.0 / square.sqrt();
            n.map(|x| x * factor)
        } else {
            [0.0, 0.0, 1.0]
        };
    }
}

/// Turns vertices and normals into the principal axes; returns the bounds of the vertices.
fn turn(vert: &mut [[f32; 3]], normal: &mut [[f32; 3]], quat: [f64; 4]) -> [Vec3; 2] {
    let mat = quat_to_mat([quat[0], -quat[1], -quat[2], -quat[3]]);
    let (mut low, mut high) = ([1e10; 3], [-1e10; 3]);
    for v in vert {
        let turned = mat_vec(&mat, v.map(f64::from));
        for k in 0..3 {
            low[k] = turned[k].min(low[k]);
            high[k] = turned[k].max(high[k]);
        }
        *v = turned.map(|x| x as f32);
    }
    for n in normal {
        *n = mat_vec(&mat, n.map(f64::from)).map(|x| x as f32);
    }
    [low, high]
}
