//! Shapes of Parry as geoms of MJCF.
//!
//! Geoms are compiled by the loader from text, so that they have the numbers that a document with these geoms would have.

use std::fmt::Write;

use mjcf_sim_loader::{LoadError, load_str};
use mjcf_sim_model::assets::MemoryAssets;
use mjcf_sim_model::math::{Quat, Vec3, axis_angle_to_quat, quat_rotate};
use mjcf_sim_model::model::{Arrays, GeomType, HField, Mesh};
use rapier3d_f64::geometry::ColliderHandle;
use rapier3d_f64::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d_f64::parry::math::{Pose, Rotation, Vector};
use rapier3d_f64::parry::shape::{Capsule, HeightField, Shape, TriMesh, TypedShape};

use super::CouplingError;

/// Corners of the base of a cone.
const CONE_CORNERS: usize = 24;
/// Depth of the solid below a triangle of a fixed mesh, and below the lowest point of a height field, m.
const DEPTH: f64 = 0.05;

/// The numbers of a geom in the arrays of a model.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GeomRow {
    pub kind: GeomType,
    pub size: Vec3,
    pub pos: Vec3,
    pub quat: Quat,
    pub aabb: [f64; 6],
    pub rbound: f64,
    pub mesh: Option<Mesh>,
    pub hfield: Option<HField>,
}

/// The geoms of a body, as text.
#[derive(Debug, Default)]
pub(super) struct GeomText {
    assets: String,
    geoms: String,
    count: usize,
    /// Whether the body is fixed: planes, meshes and height fields keep their shapes then.
    fixed: bool,
    /// The region of a fixed mesh that is used, in its body.
    region: Option<Aabb>,
}

fn numbers(out: &mut String, values: impl IntoIterator<Item = f64>) {
    for value in values {
        // the shortest text that reads back as the same number
        let _ = write!(out, "{value:?} ");
    }
}

fn points<'a>(vertices: impl IntoIterator<Item = &'a Vector>) -> impl Iterator<Item = f64> {
    vertices.into_iter().flat_map(|v| [v.x, v.y, v.z])
}

/// Returns the shortest rotation that takes z to a unit vector.
fn from_z(to: Vector) -> Rotation {
    let w = 1.0 + to.z;
    if w < 1e-12 {
        return Rotation::from_xyzw(1.0, 0.0, 0.0, 0.0);
    }
    let length = (to.x * to.x + to.y * to.y + w * w).sqrt();
    Rotation::from_xyzw(-to.y / length, to.x / length, 0.0, w / length)
}

impl GeomText {
    pub fn new(fixed: bool, region: Option<Aabb>) -> Self {
        Self {
            fixed,
            region,
            ..Self::default()
        }
    }

    fn geom(&mut self, kind: &str, size: &[f64], at: Pose) {
        let out = &mut self.geoms;
        let _ = write!(out, "<geom type=\"{kind}\" size=\"");
        numbers(out, size.iter().copied());
        *out += "\" ";
        self.place(at);
    }

    fn place(&mut self, at: Pose) {
        let (t, q) = (at.translation, at.rotation);
        self.geoms += "pos=\"";
        numbers(&mut self.geoms, [t.x, t.y, t.z]);
        self.geoms += "\" quat=\"";
        numbers(&mut self.geoms, [q.w, q.x, q.y, q.z]);
        self.geoms += "\"/>";
        self.count += 1;
    }

    fn mesh(&mut self, corners: impl IntoIterator<Item = f64>, at: Pose) {
        let name = self.count;
        let _ = write!(self.assets, "<mesh name=\"m{name}\" vertex=\"");
        numbers(&mut self.assets, corners);
        self.assets += "\"/>";
        let _ = write!(self.geoms, "<geom type=\"mesh\" mesh=\"m{name}\" ");
        self.place(at);
    }

    fn capsule(&mut self, capsule: &Capsule, at: Pose) {
        let [a, b] = [capsule.segment.a, capsule.segment.b];
        let along = b - a;
        let length = along.length();
        if length == 0.0 {
            return self.geom("sphere", &[capsule.radius], at * Pose::from_translation(a));
        }
        let local = Pose::from_parts((a + b) * 0.5, from_z(along / length));
        self.geom("capsule", &[capsule.radius, 0.5 * length], at * local);
    }

    /// Adds a cone as the hull of a regular polygon and the apex.
    fn cone(&mut self, half_height: f64, radius: f64, at: Pose) {
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / CONE_CORNERS as f64;
            let [x, _, z] = quat_rotate(axis_angle_to_quat([0.0, 1.0, 0.0], angle), [radius, 0.0, 0.0]);
            Vector::new(x, -half_height, z)
        };
        let mut corners: Vec<Vector> = (0..CONE_CORNERS).map(corner).collect();
        corners.push(Vector::new(0.0, half_height, 0.0));
        self.mesh(points(&corners), at);
    }

    /// Adds a triangle as the prism below it; its corners are counterclockwise from outside.
    fn triangle(&mut self, [a, b, c]: [Vector; 3], at: Pose) {
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        // what has no area touches nothing
        if area < 1e-12 {
            return;
        }
        let down = normal * (-DEPTH / area);
        self.mesh(points(&[a, b, c, a + down, b + down, c + down]), at);
    }

    fn trimesh(&mut self, mesh: &TriMesh, at: Pose) {
        let Some(region) = self.region.filter(|_| self.fixed) else {
            return self.mesh(points(mesh.vertices()), at);
        };
        let near = region.transform_by(&at.inverse());
        for triangle in mesh.triangles() {
            let corners = [triangle.a, triangle.b, triangle.c];
            if triangle.local_aabb().intersects(&near) {
                self.triangle(corners, at);
            }
        }
    }

    /// Adds a height field. Parry's extends along x and z with heights along y, MJCF's along x and y with heights along z.
    fn height_field(&mut self, field: &HeightField, at: Pose) {
        let (heights, scale) = (field.heights(), field.scale());
        let (nrow, ncol) = (heights.nrows(), heights.ncols());
        // MJCF lists the row of the greatest y first, which is that of Parry's least z
        let height = |row: usize, column: usize| heights[(row, column)] * scale.y;
        let all = || (0..nrow).flat_map(|row| (0..ncol).map(move |column| (row, column)));
        let low = all().map(|(r, c)| height(r, c)).fold(f64::INFINITY, f64::min);
        let high = all().map(|(r, c)| height(r, c)).fold(f64::NEG_INFINITY, f64::max);
        let name = self.count;
        let out = &mut self.assets;
        let _ = write!(out, "<hfield name=\"h{name}\" nrow=\"{nrow}\" ncol=\"{ncol}\" size=\"");
        // a flat field needs some height that its zeros are multiplied with
        let range = if high > low { high - low } else { 1.0 };
        numbers(out, [0.5 * scale.x, 0.5 * scale.z, range, DEPTH]);
        *out += "\" elevation=\"";
        numbers(out, all().map(|(r, c)| height(r, c) - low));
        *out += "\"/>";
        let _ = write!(self.geoms, "<geom type=\"hfield\" hfield=\"h{name}\" ");
        let half = 0.5_f64.sqrt();
        let upright = Pose::from_parts(Vector::new(0.0, low, 0.0), Rotation::from_xyzw(-half, 0.0, 0.0, half));
        self.place(at * upright);
    }

    /// Adds the geoms of a shape at a pose in its body.
    pub fn add(&mut self, shape: &dyn Shape, at: Pose, collider: ColliderHandle) -> Result<(), CouplingError> {
        let refused = |shape: &'static str, why: &'static str| Err(CouplingError::Shape { collider, shape, why });
        match shape.as_typed_shape() {
            TypedShape::Ball(ball) => self.geom("sphere", &[ball.radius], at),
            TypedShape::Cuboid(cuboid) => self.geom("box", &cuboid.half_extents.to_array(), at),
            TypedShape::RoundCuboid(round) => {
                let half = round.inner_shape.half_extents + Vector::splat(round.border_radius);
                self.geom("box", &half.to_array(), at);
            }
            TypedShape::Capsule(capsule) => self.capsule(capsule, at),
            TypedShape::Cylinder(c) => self.cylinder(c.half_height, c.radius, at),
            TypedShape::RoundCylinder(round) => {
                let (c, border) = (&round.inner_shape, round.border_radius);
                self.cylinder(c.half_height + border, c.radius + border, at);
            }
            TypedShape::Cone(cone) => self.cone(cone.half_height, cone.radius, at),
            TypedShape::ConvexPolyhedron(hull) => self.mesh(points(hull.points()), at),
            TypedShape::Compound(compound) => {
                for (local, part) in compound.shapes() {
                    self.add(&**part, at * *local, collider)?;
                }
            }
            TypedShape::HalfSpace(plane) if self.fixed => {
                let local = Pose::from_parts(Vector::ZERO, from_z(plane.normal));
                self.geom("plane", &[0.0, 0.0, 1.0], at * local);
            }
            TypedShape::HalfSpace(_) => return refused("a half space", "only fixed ones can touch a model"),
            TypedShape::TriMesh(mesh) => self.trimesh(mesh, at),
            TypedShape::HeightField(field) if self.fixed => self.height_field(field, at),
            TypedShape::HeightField(_) => return refused("a height field", "only fixed ones can touch a model"),
            TypedShape::Triangle(t) if self.fixed => self.triangle([t.a, t.b, t.c], at),
            TypedShape::RoundCone(_) | TypedShape::RoundConvexPolyhedron(_) | TypedShape::RoundTriangle(_) => {
                return refused("a rounded shape", "use the shape without the rounding");
            }
            TypedShape::Voxels(_) => return refused("made of voxels", "use a compound of cuboids"),
            _ => return refused("a shape without volume, or one of your own", "use a convex shape"),
        }
        Ok(())
    }

    /// Adds a cylinder: Parry's stand along y, MJCF's along z.
    fn cylinder(&mut self, half_height: f64, radius: f64, at: Pose) {
        let half = 0.5_f64.sqrt();
        let upright = Pose::from_rotation(Rotation::from_xyzw(half, 0.0, 0.0, half));
        self.geom("cylinder", &[radius, half_height], at * upright);
    }

    /// Compiles the geoms. With `multiccd`, meshes also get polygons.
    pub fn compile(&self, multiccd: bool) -> Result<Vec<GeomRow>, LoadError> {
        let (assets, geoms) = (&self.assets, &self.geoms);
        let flag = if multiccd { "enable" } else { "disable" };
        let text = format!(
            "<mujoco><option><flag multiccd=\"{flag}\"/></option><asset>{assets}</asset><worldbody>{geoms}</worldbody></mujoco>"
        );
        let (arrays, ..) = load_str(&text, "neighbor.xml", &MemoryAssets::new())?.into_parts();
        Ok((0..arrays.ngeom()).map(|g| row(&arrays, g)).collect())
    }
}

fn row(arrays: &Arrays, g: usize) -> GeomRow {
    let data = arrays.geom_dataid[g];
    let kind = arrays.geom_type[g];
    GeomRow {
        kind,
        size: arrays.geom_size[g],
        pos: arrays.geom_pos[g],
        quat: arrays.geom_quat[g],
        aabb: arrays.geom_aabb[g],
        rbound: arrays.geom_rbound[g],
        mesh: data
            .filter(|_| kind == GeomType::Mesh)
            .map(|id| arrays.meshes[id].clone()),
        hfield: data
            .filter(|_| kind == GeomType::HField)
            .map(|id| arrays.hfields[id].clone()),
    }
}
