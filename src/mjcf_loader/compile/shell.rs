//! Shells: shapes with mass only on the surface, by MuJoCo 3.3.0's formulas.

use std::f64::consts::PI;

use crate::math::Vec3;
use crate::model::GeomType;

/// Computes the area of a shape, m^2, for an ellipsoid by Thomsen's approximation; 0 for planes.
pub(super) fn area(kind: GeomType, size: &Vec3) -> f64 {
    let [a, b, c] = *size;
    match kind {
        GeomType::Plane | GeomType::Mesh => 0.0,
        GeomType::Sphere => 4.0 * PI * a * a,
        GeomType::Capsule => 4.0 * PI * a * a + 2.0 * PI * a * (2.0 * b),
        GeomType::Cylinder => 2.0 * PI * a * a + 2.0 * PI * a * (2.0 * b),
        GeomType::Ellipsoid => {
            let p = 1.6075;
            let sum = pxfm::f_pow(a * b, p) + pxfm::f_pow(b * c, p) + pxfm::f_pow(c * a, p);
            4.0 * PI * pxfm::f_pow(sum / 3.0, 1.0 / p)
        }
        GeomType::Box | GeomType::HField => 8.0 * (a * b + b * c + c * a),
    }
}

/// Computes the principal moments of a homogeneous shell, kg m^2.
pub(super) fn inertia(kind: GeomType, size: &Vec3, mass: f64) -> Vec3 {
    let [a, b, _] = *size;
    match kind {
        GeomType::Plane | GeomType::Mesh => [0.0; 3],
        GeomType::Sphere => [2.0 * mass * a * a / 3.0; 3],
        GeomType::Capsule => {
            let height = 2.0 * b;
            let (ends, wall) = (4.0 * PI * a * a, 2.0 * PI * a * height);
            let ends = mass * ends / (ends + wall);
            let wall = mass - ends;
            let sphere = 2.0 * ends * a * a / 3.0;
            // the two half spheres, moved along z by Steiner's theorem
            let centre = a / 2.0;
            let moved = b + centre;
            let across = wall * (6.0 * a * a + height * height) / 12.0;
            let across = across + (sphere + ends * (moved * moved - centre * centre));
            [across, across, wall * a * a + sphere]
        }
        GeomType::Cylinder => {
            let height = 2.0 * b;
            let (disk, wall) = (PI * a * a, 2.0 * PI * a * height);
            let disk = mass * disk / (2.0 * disk + wall);
            let wall = mass - 2.0 * disk;
            let across = wall * (6.0 * a * a + height * height) / 12.0;
            let across = across + 2.0 * (disk * a * a / 4.0 + disk * b * b);
            [across, across, wall * a * a + 2.0 * (disk * a * a / 2.0)]
        }
        GeomType::Ellipsoid => ellipsoid(*size, mass),
        GeomType::Box | GeomType::HField => cuboid(*size, mass),
    }
}

/// Returns the difference of two ellipsoids, as MuJoCo approximates the shell.
fn ellipsoid([a, b, c]: Vec3, mass: f64) -> Vec3 {
    // MuJoCo's thickness of the shell, m
    let grown = [a, b, c].map(|axis| axis + 1e-6);
    let volume = |[a, b, c]: Vec3| 4.0 * PI * a * b * c / 3.0;
    let (inner, outer) = (volume([a, b, c]), volume(grown));
    let density = mass / (outer - inner);
    let moments = |[a, b, c]: Vec3, mass: f64| {
        [
            mass * (b * b + c * c) / 5.0,
            mass * (a * a + c * c) / 5.0,
            mass * (a * a + b * b) / 5.0,
        ]
    };
    let (inner, outer) = (moments([a, b, c], inner * density), moments(grown, outer * density));
    std::array::from_fn(|k| outer[k] - inner[k])
}

/// Returns the moments of the six sides of a box; two are across each axis.
fn cuboid([a, b, c]: Vec3, mass: f64) -> Vec3 {
    let [x, y, z] = [2.0 * a, 2.0 * b, 2.0 * c];
    let areas = [x * y, y * z, z * x];
    let total = 2.0 * (areas[0] + areas[1] + areas[2]);
    let [across_z, across_x, across_y] = areas.map(|area| mass * area / total);
    let moment = |first: f64, second: f64, own: f64| 2.0 * (first + second + own);
    [
        moment(
            across_z * c * c,
            across_y * b * b,
            across_z * y * y / 12.0 + across_x * (y * y + z * z) / 12.0 + across_y * z * z / 12.0,
        ),
        moment(
            across_z * c * c,
            across_x * a * a,
            across_z * x * x / 12.0 + across_x * z * z / 12.0 + across_y * (x * x + z * z) / 12.0,
        ),
        moment(
            across_x * a * a,
            across_y * b * b,
            across_z * (x * x + y * y) / 12.0 + across_x * y * y / 12.0 + across_y * x * x / 12.0,
        ),
    ]
}
