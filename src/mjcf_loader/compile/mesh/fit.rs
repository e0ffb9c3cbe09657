//! Primitive shapes fitted to meshes.

use crate::math::{Vec3, add, norm, sub};
use crate::model::{GeomType, Mesh};

/// A primitive shape that is fitted to a mesh.
pub(crate) struct FittedShape {
    /// Size, m.
    pub size: Vec3,
    /// The new position of the mesh, m.
    pub pos: Vec3,
}

/// Fits a shape to a mesh: to the box with its inertia, or to the box around it; `None` for a shape that cannot be fitted.
pub(crate) fn fit(kind: GeomType, mesh: &Mesh, to_bounds: bool, scale: f64) -> Option<FittedShape> {
    let (size, pos) = if to_bounds {
        let [low, high] = mesh.bounds;
        let centre: Vec3 = std::array::from_fn(|k| (low[k] + high[k]) / 2.0);
        // the centre is in the axes of the mesh and the position in those of the document; MuJoCo adds them anyway
        (around(kind, mesh, centre)?, add(mesh.pos, centre))
    } else {
        (like_box(kind, mesh.inertia_box)?, mesh.pos)
    };
    let size = size.map(|x| x * scale);
    Some(FittedShape { size, pos })
}

/// Returns the size of a shape from the box of the same inertia.
fn like_box(kind: GeomType, [a, b, c]: Vec3) -> Option<Vec3> {
    match kind {
        GeomType::Sphere => Some([(a + b + c) / 3.0, 0.0, 0.0]),
        GeomType::Capsule => {
            let radius = (a + b) / 2.0;
            Some([radius, (c - radius / 2.0).max(0.0), 0.0])
        }
        GeomType::Cylinder => Some([(a + b) / 2.0, c, 0.0]),
        GeomType::Ellipsoid | GeomType::Box => Some([a, b, c]),
        GeomType::Plane | GeomType::HField | GeomType::Mesh => None,
    }
}

/// Returns the size of a shape about a centre that contains all vertices.
fn around(kind: GeomType, mesh: &Mesh, centre: Vec3) -> Option<Vec3> {
    let arms = || mesh.vert.iter().map(|v| sub(v.map(f64::from), centre));
    let across = |v: Vec3| (v[0] * v[0] + v[1] * v[1]).sqrt();
    let radius = || arms().map(across).fold(0.0, f64::max);
    match kind {
        GeomType::Sphere => Some([arms().map(norm).fold(0.0, f64::max), 0.0, 0.0]),
        GeomType::Cylinder => Some([radius(), arms().map(|v| v[2].abs()).fold(0.0, f64::max), 0.0]),
        GeomType::Capsule => {
            let radius = radius();
            // the cap is lower at a distance from the axis
            let above = |v: Vec3| v[2].abs() - radius * pxfm::f_sin(pxfm::f_acos(across(v) / radius));
            Some([radius, arms().map(above).fold(0.0, f64::max), 0.0])
        }
        GeomType::Ellipsoid | GeomType::Box => Some(sub(mesh.bounds[1], centre)),
        GeomType::Plane | GeomType::HField | GeomType::Mesh => None,
    }
}
