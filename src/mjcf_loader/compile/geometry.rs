//! Orientations, volumes and inertias, in the operation order of MuJoCo's compiler so that results agree to the bit.

use std::f64::consts::PI;

use crate::math::{Mat3, Quat, Vec3, cross, principal_axes, quat_mul, quat_to_mat, sub};
use crate::model::GeomType;

use crate::attribute::ZERO_QUAT;
use crate::document::{Compiler, Orientation};

/// Greatest coordinate (MuJoCo's `mjMAXVAL`).
const MAXVAL: f64 = 1e10;

/// Below this, the compiler treats lengths, volumes and eigenvalues as zero.
pub(super) const EPS: f64 = 1e-14;

/// Normalises by division; (nearly) zero or unit vectors stay as they are. Returns the old length, 0 if tiny.
pub(crate) fn normalize<const N: usize>(vector: &mut [f64; N]) -> f64 {
    let mut square = 0.0;
    for value in vector.iter() {
        square += value * value;
    }
    if square < EPS {
        return 0.0;
    }
    let length = square.sqrt();
    // dividing a unit vector by its length would change its last bits
    if (length - 1.0).abs() > EPS {
        for value in vector.iter_mut() {
            *value /= length;
        }
    }
    length
}

/// Converts an orientation, as written in the document, to a quaternion.
pub(super) fn orientation(written: &Orientation, compiler: &Compiler) -> Result<Quat, &'static str> {
    let radians = |angle: f64| if compiler.degree { angle / 180.0 * PI } else { angle };
    let mut quat = match *written {
        Orientation::Quat(quat) => quat,
        Orientation::AxisAngle([x, y, z, angle]) => {
            let mut axis = [x, y, z];
            if normalize(&mut axis) < EPS {
                return Err("the axis of axisangle is too short");
            }
            let half = radians(angle) / 2.0;
            let sine = pxfm::f_sin(half);
            [pxfm::f_cos(half), sine * axis[0], sine * axis[1], sine * axis[2]]
        }
        Orientation::XyAxes([x0, x1, x2, y0, y1, y2]) => {
            let (mut x, mut y) = ([x0, x1, x2], [y0, y1, y2]);
            if normalize(&mut x) < EPS {
                return Err("the x axis of xyaxes is too short");
            }
            let along = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
            // Gram and Schmidt: x is taken as it is, and y made perpendicular
            for k in 0..3 {
                y[k] -= x[k] * along;
            }
            if normalize(&mut y) < EPS {
                return Err("the y axis of xyaxes is too short or parallel to the x axis");
            }
            let mut z = cross(x, y);
            if normalize(&mut z) < EPS {
                return Err("the axes of xyaxes are parallel");
            }
            frame_to_quat(x, y, z)
        }
        Orientation::ZAxis(mut axis) => {
            if normalize(&mut axis) < EPS {
                return Err("zaxis is too short");
            }
            z_to_quat(axis)
        }
        Orientation::Euler(angles) => {
            let mut quat = [1.0, 0.0, 0.0, 0.0];
            for (letter, angle) in compiler.eulerseq.iter().zip(angles) {
                let half = radians(angle) / 2.0;
                let mut turn = [pxfm::f_cos(half), 0.0, 0.0, 0.0];
                turn[usize::from(letter.to_ascii_lowercase().saturating_sub(b'x').min(2)) + 1] = pxfm::f_sin(half);
                // Lower case turns about the axes that move along, upper case about the fixed ones.
                quat = if letter.is_ascii_lowercase() {
                    quat_mul(quat, turn)
                } else {
                    quat_mul(turn, quat)
                };
            }
            quat
        }
    };
    if normalize(&mut quat) == 0.0 {
        return Err(ZERO_QUAT);
    }
    Ok(quat)
}

/// Returns the shortest rotation that takes z to a direction.
pub(super) fn z_to_quat(direction: Vec3) -> Quat {
    let mut axis = cross([0.0, 0.0, 1.0], direction);
    let sine = normalize(&mut axis);
    // along z, or against it: any axis across z will do, and MuJoCo takes x
    if sine < 1e-10 {
        axis = [1.0, 0.0, 0.0];
    }
    let half = pxfm::f_atan2(sine, direction[2]) / 2.0;
    let s = pxfm::f_sin(half);
    [pxfm::f_cos(half), axis[0] * s, axis[1] * s, axis[2] * s]
}

/// Converts orthonormal axes to a quaternion, by the best conditioned of four formulas.
pub(crate) fn frame_to_quat(x: Vec3, y: Vec3, z: Vec3) -> Quat {
    let mut q = if x[0] + y[1] + z[2] > 0.0 {
        let w = 0.5 * (1.0 + x[0] + y[1] + z[2]).sqrt();
        [
            w,
            0.25 * (y[2] - z[1]) / w,
            0.25 * (z[0] - x[2]) / w,
            0.25 * (x[1] - y[0]) / w,
        ]
    } else if x[0] > y[1] && x[0] > z[2] {
        let i = 0.5 * (1.0 + x[0] - y[1] - z[2]).sqrt();
        [
            0.25 * (y[2] - z[1]) / i,
            i,
            0.25 * (y[0] + x[1]) / i,
            0.25 * (z[0] + x[2]) / i,
        ]
    } else if y[1] > z[2] {
        let j = 0.5 * (1.0 - x[0] + y[1] - z[2]).sqrt();
        [
            0.25 * (z[0] - x[2]) / j,
            0.25 * (y[0] + x[1]) / j,
            j,
            0.25 * (z[1] + y[2]) / j,
        ]
    } else {
        let k = 0.5 * (1.0 - x[0] - y[1] + z[2]).sqrt();
        [
            0.25 * (x[1] - y[0]) / k,
            0.25 * (z[0] + x[2]) / k,
            0.25 * (z[1] + y[2]) / k,
            k,
        ]
    };
    normalize(&mut q);
    q
}

/// Returns centre, orientation and half length of a `fromto` segment; z points from the second point to the first.
pub(super) fn segment(fromto: &[f64; 6]) -> (Vec3, Quat, f64) {
    let [a0, a1, a2, b0, b1, b2] = *fromto;
    let mut vector = sub([a0, a1, a2], [b0, b1, b2]);
    let half = normalize(&mut vector) / 2.0;
    let mut quat = z_to_quat(vector);
    normalize(&mut quat);
    ([0.5 * (a0 + b0), 0.5 * (a1 + b1), 0.5 * (a2 + b2)], quat, half)
}

/// Returns the number of entries of `size` that a shape uses.
pub(super) fn size_count(kind: GeomType) -> usize {
    match kind {
        GeomType::Sphere => 1,
        GeomType::Capsule | GeomType::Cylinder => 2,
        GeomType::Plane | GeomType::Ellipsoid | GeomType::Box => 3,
        GeomType::HField | GeomType::Mesh => 0,
    }
}

/// Computes the volume of a shape, m^3; 0 for planes, and for meshes, which store their own.
pub(crate) fn volume(kind: GeomType, size: &Vec3) -> f64 {
    let [a, b, c] = *size;
    match kind {
        GeomType::Plane | GeomType::Mesh => 0.0,
        GeomType::Sphere => 4.0 * PI * a * a * a / 3.0,
        GeomType::Capsule => {
            let height = 2.0 * b;
            PI * (a * a * height + 4.0 * a * a * a / 3.0)
        }
        GeomType::Cylinder => {
            let height = 2.0 * b;
            PI * a * a * height
        }
        GeomType::Ellipsoid => 4.0 * PI * a * b * c / 3.0,
        GeomType::Box | GeomType::HField => a * b * c * 8.0,
    }
}

/// Computes the principal moments of a homogeneous solid, kg m^2. The size of a mesh is the box of the same inertia.
pub(super) fn inertia(kind: GeomType, size: &Vec3, mass: f64) -> Vec3 {
    let [a, b, c] = *size;
    match kind {
        GeomType::Plane => [0.0; 3],
        GeomType::Sphere => [2.0 * mass * a * a / 5.0; 3],
        GeomType::Capsule => {
            let height = 2.0 * b;
            // by volume: both ends make a sphere, 4/3 pi a^3, and the cylinder has pi a^2 height
            let sphere_mass = mass * 4.0 * a / (4.0 * a + 3.0 * height);
            let cylinder_mass = mass - sphere_mass;
            let across = cylinder_mass * (3.0 * a * a + height * height) / 12.0;
            let along = cylinder_mass * a * a / 2.0;
            // The two half spheres, moved along z by Steiner's theorem.
            let sphere = 2.0 * sphere_mass * a * a / 5.0;
            let across = across + (sphere + sphere_mass * height * (3.0 * a + 2.0 * height) / 8.0);
            [across, across, along + sphere]
        }
        GeomType::Cylinder => {
            let height = 2.0 * b;
            let across = mass * (3.0 * a * a + height * height) / 12.0;
            [across, across, mass * a * a / 2.0]
        }
        GeomType::Ellipsoid => [
            mass * (b * b + c * c) / 5.0,
            mass * (a * a + c * c) / 5.0,
            mass * (a * a + b * b) / 5.0,
        ],
        GeomType::Box | GeomType::HField | GeomType::Mesh => [
            mass * (b * b + c * c) / 3.0,
            mass * (a * a + c * c) / 3.0,
            mass * (a * a + b * b) / 3.0,
        ],
    }
}

/// Computes the radius of the bounding sphere, m; 0 for planes.
pub fn bounding_radius(kind: GeomType, size: &Vec3) -> f64 {
    let [a, b, c] = *size;
    match kind {
        GeomType::Plane => 0.0,
        GeomType::Sphere => a,
        GeomType::Capsule => a + b,
        GeomType::Cylinder => (a * a + b * b).sqrt(),
        GeomType::Ellipsoid => a.max(b).max(c),
        GeomType::Box | GeomType::HField | GeomType::Mesh => (a * a + b * b + c * c).sqrt(),
    }
}

/// Returns the box around a shape in its frame: centre and half lengths, m.
pub(super) fn bounding_box(kind: GeomType, size: &Vec3) -> [f64; 6] {
    let [a, b, c] = *size;
    match kind {
        GeomType::Plane => {
            // all space below the plane
            let half = MAXVAL / 2.0;
            [0.0, 0.0, -half, MAXVAL, MAXVAL, half]
        }
        GeomType::Sphere => [0.0, 0.0, 0.0, a, a, a],
        GeomType::Capsule => [0.0, 0.0, 0.0, a, a, a + b],
        GeomType::Cylinder => [0.0, 0.0, 0.0, a, a, b],
        GeomType::Ellipsoid | GeomType::Box | GeomType::HField | GeomType::Mesh => [0.0, 0.0, 0.0, a, b, c],
    }
}

/// Rotates principal moments into the parent frame: xx yy zz xy xz yz.
fn turned_inertia(local: &Vec3, quat: Quat) -> [f64; 6] {
    let m = quat_to_mat(quat);
    let t: Mat3 = std::array::from_fn(|k| m[3 * (k % 3) + k / 3] * local[k / 3]);
    [
        m[0] * t[0] + m[1] * t[3] + m[2] * t[6],
        m[3] * t[1] + m[4] * t[4] + m[5] * t[7],
        m[6] * t[2] + m[7] * t[5] + m[8] * t[8],
        m[0] * t[1] + m[1] * t[4] + m[2] * t[7],
        m[0] * t[2] + m[1] * t[5] + m[2] * t[8],
        m[3] * t[2] + m[4] * t[5] + m[5] * t[8],
    ]
}

/// Computes the inertia about the origin of a point mass at `p`: xx yy zz xy xz yz.
fn point_inertia(mass: f64, p: Vec3) -> [f64; 6] {
    [
        mass * (p[1] * p[1] + p[2] * p[2]),
        mass * (p[0] * p[0] + p[2] * p[2]),
        mass * (p[0] * p[0] + p[1] * p[1]),
        -mass * p[0] * p[1],
        -mass * p[0] * p[2],
        -mass * p[1] * p[2],
    ]
}

/// A solid placed in a body.
pub(super) struct Solid {
    pub pos: Vec3,
    pub quat: Quat,
    pub mass: f64,
    pub inertia: Vec3,
}

/// Merges several solids into one, in its principal frame.
pub(super) fn merge(solids: &[Solid]) -> Result<Solid, &'static str> {
    let mut mass = 0.0;
    let mut pos = [0.0; 3];
    for solid in solids {
        mass += solid.mass;
        for (sum, p) in pos.iter_mut().zip(solid.pos) {
            *sum += solid.mass * p;
        }
    }
    if mass < EPS {
        return Err("several geoms without mass have no centre of mass");
    }
    let pos = pos.map(|sum| sum / mass);
    let mut total = [0.0; 6];
    for solid in solids {
        let own = turned_inertia(&solid.inertia, solid.quat);
        let moved = point_inertia(solid.mass, sub(solid.pos, pos));
        for k in 0..6 {
            // one sum at a time, in MuJoCo's order; `+=` of a sum rounds differently
            total[k] = total[k] + own[k] + moved[k];
        }
    }
    let (quat, inertia) = principal(&total)?;
    Ok(Solid {
        pos,
        quat,
        mass,
        inertia,
    })
}

/// Computes the principal axes and moments of a symmetric matrix given as xx yy zz xy xz yz, the largest moment first.
///
/// The Jacobi rotations, kept as a quaternion, stop at an absolute 1e-12, so small inertias stay slightly off diagonal,
/// as in MuJoCo.
pub(super) fn principal(full: &[f64; 6]) -> Result<(Quat, Vec3), &'static str> {
    let (quat, values) = diagonalize(full);
    if values[2] >= EPS {
        Ok((quat, values))
    } else {
        Err("the inertia must have positive principal moments")
    }
}

/// Computes principal axes and moments as [`principal`] does, without checking the moments.
pub(super) fn diagonalize(full: &[f64; 6]) -> (Quat, Vec3) {
    principal_axes(full, |mut quat| {
        normalize(&mut quat);
        quat
    })
}
