//! Contact geometry: where, how deep and in which direction two geoms touch.
//!
//! The results are those of MuJoCo 3.3.0, to the bit: the same contacts in the same order with the same distance, position and frame, with
//! its native convex collision detection and with that of libccd (`nativeccd`). To that end every routine keeps MuJoCo's order of
//! operations and uses nothing but `+ - * /` and square roots, so the bits are also the same on every target.
//!
//! Conventions, for all pairs:
//!
//! - In a pair the geom of the lower [`GeomType`] comes first. The normal points from the first geom to the second.
//! - `dist` is negative in penetration; `pos` lies midway between the two surfaces.
//! - A contact is reported when `dist <= margin`.
//! - Lengths are metres; everything is in the frame of the given [`PlacedGeom`]s, normally the world.
//!
//! | pair | method | contacts |
//! |---|---|---|
//! | plane with sphere, capsule, ellipsoid, cylinder, box, mesh | deepest points | up to 1, 2, 1, 4, 4, 3 |
//! | sphere with sphere, capsule, cylinder, box | nearest points | up to 1 |
//! | height field with everything but planes and height fields | GJK and EPA, or MPR, with each prism of its grid | up to 50 |
//! | capsule with capsule, box | nearest points, a second one along the capsule | up to 2 |
//! | box with box | separating axes, then clipping | up to 24 |
//! | ellipsoid and mesh with everything but planes, capsule with cylinder, cylinder with cylinder, box | GJK and EPA, or MPR | up to 1; with `multiccd` 5 |
//!
//! Planes and height fields touch neither planes nor height fields. Of meshes the convex hulls touch. The order of
//! a hull's edges is that of Qhull, as in MuJoCo: where several corners are equally far in a direction, it decides which is found first, and where more
//! than two neighbours of the deepest corner are below a plane, which of them touch it.
//!
//! ```
//! use mjcf_sim::math::MAT3_ID;
//! use mjcf_sim::model::GeomType;
//! use mjcf_sim::physics::contact::{ContactOptions, PlacedGeom, Scratch, collide};
//!
//! let floor = PlacedGeom { kind: GeomType::Plane, size: [0.0; 3], pos: [0.0; 3], mat: &MAT3_ID, mesh: None, hfield: None };
//! let ball = PlacedGeom { kind: GeomType::Sphere, size: [0.5, 0.0, 0.0], pos: [0.0, 0.0, 0.25], mat: &MAT3_ID, mesh: None, hfield: None };
//! let mut contacts = Vec::new();
//! collide(&floor, &ball, 0.0, &ContactOptions::default(), &mut Scratch::new(), &mut contacts);
//! assert_eq!(contacts[0].dist, -0.25);
//! assert_eq!(contacts[0].pos, [0.0, 0.0, -0.125]);
//! assert_eq!(contacts[0].normal(), [0.0, 0.0, 1.0]);
//! ```

mod box_box;
mod box_edge;
mod box_face;
mod box_frame;
mod capsule_box;
mod ccd_support;
mod convex;
mod distance;
mod epa;
mod faces;
mod fix_normal;
mod flex;
mod flex_part;
pub mod frame;
mod gjk;
mod hfield;
mod mesh;
mod mpr;
mod multiccd;
mod nearest;
mod plane;
mod polytope;
mod round;
mod support;
#[cfg(test)]
mod tests;
mod tolerance;
mod triangle;

pub use distance::distance;
pub use flex::{element_element, geom_element, vertex_element};
pub use flex_part::FlexPart;

use crate::MAXVAL;
use crate::math::{Mat3, Vec3, add_scaled, column, dot, sub};
use crate::model::{GeomType, HField, Mesh};

/// A geom with its pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedGeom<'a> {
    /// Geom type.
    pub kind: GeomType,
    /// Size, m; see [`GeomType`].
    pub size: Vec3,
    /// Centre, m.
    pub pos: Vec3,
    /// Orientation; the columns are the local axes.
    pub mat: &'a Mat3,
    /// The mesh of a mesh geom, which touches nothing without it, or of an ellipsoid that was fitted to a mesh.
    pub mesh: Option<&'a Mesh>,
    /// The height field of such a geom, which touches nothing without it.
    pub hfield: Option<&'a HField>,
}

impl PlacedGeom<'_> {
    /// Returns the local z axis: the axis of a capsule or cylinder, the normal of a plane.
    #[inline(always)]
    fn axis(&self) -> Vec3 {
        column(self.mat, 2)
    }
}

/// A point where two geoms touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Distance between the surfaces, m; negative in penetration.
    pub dist: f64,
    /// Position, m.
    pub pos: Vec3,
    /// Contact frame; its rows are the normal (from the first geom to the second) and the two tangents.
    pub frame: Mat3,
}

impl ContactPoint {
    /// Returns the normal: the first row of the frame.
    pub fn normal(&self) -> Vec3 {
        [self.frame[0], self.frame[1], self.frame[2]]
    }
}

/// A contact before its tangents are known.
#[derive(Clone, Copy, Debug)]
struct BareContact {
    dist: f64,
    pos: Vec3,
    normal: Vec3,
}

/// Appends a contact, if there is one, with the tangents of its normal.
#[inline(always)]
fn push(touch: Option<BareContact>, out: &mut Vec<ContactPoint>) {
    if let Some(BareContact { dist, pos, normal }) = touch {
        let frame = frame::from_normal(normal);
        out.push(ContactPoint { dist, pos, frame });
    }
}

/// The options of the contact routines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactOptions {
    /// Tolerance of the convex routines, m (MuJoCo's `ccd_tolerance`).
    pub ccd_tolerance: f64,
    /// Greatest number of iterations of GJK and of EPA (MuJoCo's `ccd_iterations`).
    pub ccd_iterations: usize,
    /// Whether contacts of convex pairs are found by GJK and EPA, MuJoCo's default, or by MPR, as in libccd (MuJoCo's flag `nativeccd`).
    pub nativeccd: bool,
    /// Whether convex pairs may have several contacts (MuJoCo's flag `multiccd`).
    pub multiccd: bool,
    /// Peculiarities to keep.
    pub quirks: Quirks,
}

impl Default for ContactOptions {
    /// Returns MuJoCo's defaults: tolerance 1e-6 m, 50 iterations, GJK and EPA, one contact of a convex pair, all quirks kept.
    fn default() -> Self {
        ContactOptions {
            ccd_tolerance: 1e-6,
            ccd_iterations: 50,
            nativeccd: true,
            multiccd: false,
            quirks: Quirks::default(),
        }
    }
}

/// The peculiarities of MuJoCo 3.3.0. The default keeps them all; a `false` switches one off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quirks {
    /// Box on box face: `dist` is half of the depth. Off: the whole depth.
    pub half_box_face_depth: bool,
    /// Box edge on box edge: once a corner of the reference face has been looked at, its squared distance stands in for
    /// the determinant by which the remaining corners are located. Off: the determinant is used throughout.
    pub box_edge_determinant_reuse: bool,
    /// Capsule on box: a box edge whose nearest point moved back off the corner is still treated as that corner when the
    /// second contact is sought. Off: it is treated as an edge.
    pub stale_box_corner: bool,
    /// Convex pairs: geoms with the same centre do not touch. Off: they are treated like others.
    pub same_centre_is_no_contact: bool,
    /// Convex pairs: overlapping geoms for which EPA finds no depth do not touch. Off: the least overlap along the
    /// geoms' axes and the line of centres is taken, an upper bound of the depth.
    pub failed_depth_is_no_contact: bool,
}

impl Default for Quirks {
    /// Returns MuJoCo 3.3.0's behaviour.
    fn default() -> Self {
        Quirks {
            half_box_face_depth: true,
            box_edge_determinant_reuse: true,
            stale_box_corner: true,
            same_centre_is_no_contact: true,
            failed_depth_is_no_contact: true,
        }
    }
}

impl Quirks {
    /// Returns the sensible behaviour throughout, without any of the quirks.
    pub fn none() -> Self {
        Quirks {
            half_box_face_depth: false,
            box_edge_determinant_reuse: false,
            stale_box_corner: false,
            same_centre_is_no_contact: false,
            failed_depth_is_no_contact: false,
        }
    }
}

/// Buffers of [`collide`], allocated once and used for any number of calls.
#[derive(Clone, Debug)]
pub struct Scratch {
    polytope: polytope::Polytope,
    box_points: Vec<box_frame::BoxPoint>,
    faces: faces::MulticcdScratch,
}

impl Scratch {
    /// Allocates work space large enough for any pair at the default number of iterations.
    pub fn new() -> Self {
        Scratch {
            polytope: polytope::Polytope::new(),
            box_points: Vec::with_capacity(box_box::MAX_POINTS),
            faces: faces::MulticcdScratch::default(),
        }
    }
}

impl Default for Scratch {
    fn default() -> Self {
        Scratch::new()
    }
}

/// Returns whether the bounding spheres of two geoms come within the margin, or a bounding sphere and a plane.
///
/// MuJoCo makes this test before [`collide`], and it does decide whether some contacts exist. `radius_a` and `radius_b`
/// are the bounding radii about the centres, 0 for a plane. Needs `a.kind <= b.kind`.
#[doc(alias = "mj_filterSphere")]
#[inline(always)]
pub fn bounding_test(a: &PlacedGeom, radius_a: f64, b: &PlacedGeom, radius_b: f64, margin: f64) -> bool {
    if a.kind == GeomType::Plane {
        let height = dot(sub(b.pos, a.pos), a.axis());
        let apart = height > margin + radius_b;
        return !apart;
    }
    let between = sub(a.pos, b.pos);
    let reach = radius_a + radius_b + margin;
    let apart = dot(between, between) > reach * reach;
    !apart
}

/// Returns whether contacts of two kinds of geoms, in any order, come from the routine for all convex shapes (MuJoCo's `mjc_Convex`).
pub fn needs_convex(a: GeomType, b: GeomType) -> bool {
    use GeomType::{Box, Capsule, Cylinder, Ellipsoid, HField, Mesh, Sphere};
    matches!(
        (a.min(b), a.max(b)),
        (Sphere | Capsule | Ellipsoid, Ellipsoid)
            | (Capsule | Ellipsoid | Cylinder, Cylinder)
            | (Ellipsoid | Cylinder, Box)
            | (HField, Sphere | Capsule | Ellipsoid | Cylinder | Box | Mesh)
            | (Sphere | Capsule | Ellipsoid | Cylinder | Box | Mesh, Mesh)
    )
}

/// Appends the contacts of two geoms to `out`, in MuJoCo's order.
///
/// Needs `a.kind <= b.kind`; appends nothing otherwise, nor for pairs that do not collide. Contacts are those with
/// `dist <= margin` (m). Any input is safe; poses that are not finite give an unspecified but finite number of contacts.
#[doc(alias = "mjCOLLISIONFUNC")]
pub fn collide(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
    out: &mut Vec<ContactPoint>,
) {
    use GeomType::{Box, Capsule, Cylinder, Ellipsoid, HField, Mesh, Plane, Sphere};
    match (a.kind, b.kind) {
        (Plane, Sphere) => plane::plane_sphere(a, b, margin, out),
        (Plane, Capsule) => plane::plane_capsule(a, b, margin, out),
        (Plane, Ellipsoid) => {
            let before = out.len();
            plane::plane_ellipsoid(a, b, margin, out);
            if let Some(mesh) = b.mesh.filter(|_| out.len() > before) {
                mesh::plane_fitted(a, b, mesh, margin, out);
            }
        }
        (Plane, Cylinder) => plane::plane_cylinder(a, b, margin, out),
        (Plane, Box) => plane::plane_box(a, b, margin, out),
        (Plane, Mesh) => {
            if let Some(mesh) = b.mesh {
                mesh::plane_mesh(a, b, mesh, margin, out);
            }
        }
        (HField, Sphere | Capsule | Ellipsoid | Cylinder | Box | Mesh) => {
            hfield::hfield(a, b, margin, options, &mut scratch.polytope, out);
        }
        (Sphere, Sphere) => push(round::sphere_sphere(a, b, margin), out),
        (Sphere, Capsule) => push(round::sphere_capsule(a, b, margin), out),
        (Sphere, Cylinder) => push(round::sphere_cylinder(a, b, margin), out),
        (Sphere, Box) => push(round::ball_box(a.pos, a.size[0], b, margin), out),
        (Capsule, Capsule) => round::capsule_capsule(a, b, margin, out),
        (Capsule, Box) => capsule_box::capsule_box(a, b, margin, &options.quirks, out),
        (Box, Box) => box_box::box_box(a, b, margin, &options.quirks, &mut scratch.box_points, out),
        (Sphere | Capsule | Ellipsoid, Ellipsoid)
        | (Capsule | Ellipsoid | Cylinder, Cylinder)
        | (Ellipsoid | Cylinder, Box)
        | (Sphere | Capsule | Ellipsoid | Cylinder | Box | Mesh, Mesh) => {
            multiccd::convex(a, b, margin, options, scratch, out);
        }
        _ => {}
    }
}
