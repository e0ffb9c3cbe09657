//! The operations on vectors, quaternions and matrices.

use super::sincos::sincos;
use super::{Mat3, Quat, Vec3};

/// Lengths and norms below this count as zero (MuJoCo's `mjMINVAL`).
pub const MINVAL: f64 = 1e-15;

/// The identity quaternion.
pub const QUAT_ID: Quat = [1.0, 0.0, 0.0, 0.0];
/// The identity matrix.
pub const MAT3_ID: Mat3 = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Computes `a + b`.
#[inline(always)]
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Computes `a - b`.
#[inline(always)]
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Computes `a * s`.
#[inline(always)]
pub fn scale(a: Vec3, s: f64) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// Computes `a + b * s`.
#[inline(always)]
pub fn add_scaled(a: Vec3, b: Vec3, s: f64) -> Vec3 {
    [a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s]
}

/// Computes the dot product.
#[inline(always)]
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Computes the cross product.
#[inline(always)]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Computes the Euclidean length.
#[inline(always)]
pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// Normalises a vector by multiplying with the reciprocal of its length; returns it with the original length. A vector
/// shorter than [`MINVAL`] gives the x axis.
#[inline(always)]
pub fn unit(a: Vec3) -> (Vec3, f64) {
    let length = norm(a);
    if length < MINVAL {
        ([1.0, 0.0, 0.0], length)
    } else {
        (scale(a, 1.0 / length), length)
    }
}

/// Multiplies a matrix with a vector.
#[inline(always)]
pub fn mat_vec(m: &Mat3, v: Vec3) -> Vec3 {
    [
        m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
        m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
        m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
    ]
}

/// Multiplies a transposed matrix with a vector.
#[inline(always)]
pub fn mat_t_vec(m: &Mat3, v: Vec3) -> Vec3 {
    [
        m[0] * v[0] + m[3] * v[1] + m[6] * v[2],
        m[1] * v[0] + m[4] * v[1] + m[7] * v[2],
        m[2] * v[0] + m[5] * v[1] + m[8] * v[2],
    ]
}

/// Returns column `k` (a local axis) of a matrix.
#[inline(always)]
pub fn column(m: &Mat3, k: usize) -> Vec3 {
    [m[k], m[3 + k], m[6 + k]]
}

/// Returns row `k` of a matrix.
#[inline(always)]
pub fn row(m: &Mat3, k: usize) -> Vec3 {
    [m[3 * k], m[3 * k + 1], m[3 * k + 2]]
}

/// Computes the matrix product `a b`.
#[inline(always)]
pub fn mat_mul(a: &Mat3, b: &Mat3) -> Mat3 {
    let mut r = [0.0; 9];
    for i in 0..3 {
        for k in 0..3 {
            r[3 * i + k] = a[3 * i] * b[k] + a[3 * i + 1] * b[3 + k] + a[3 * i + 2] * b[6 + k];
        }
    }
    r
}

/// Transposes a matrix.
#[inline(always)]
pub fn transpose(m: &Mat3) -> Mat3 {
    [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]]
}

/// Computes the quaternion product `a b`.
#[inline(always)]
pub fn quat_mul(a: Quat, b: Quat) -> Quat {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// Conjugates a quaternion; for unit quaternions that is the inverse.
#[inline(always)]
pub fn quat_conj(a: Quat) -> Quat {
    [a[0], -a[1], -a[2], -a[3]]
}

/// Normalises a quaternion; zero becomes the identity, and one within [`MINVAL`] of unit length stays as it is.
#[inline(always)]
pub fn quat_normalize(q: Quat) -> Quat {
    let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
    if length < MINVAL {
        QUAT_ID
    } else if (length - 1.0).abs() > MINVAL {
        let s = 1.0 / length;
        [q[0] * s, q[1] * s, q[2] * s, q[3] * s]
    } else {
        q
    }
}

/// Converts a unit quaternion to a rotation matrix.
#[inline(always)]
pub fn quat_to_mat(q: Quat) -> Mat3 {
    if q == QUAT_ID {
        return MAT3_ID;
    }
    let [w, x, y, z] = q;
    let (ww, wx, wy, wz) = (w * w, w * x, w * y, w * z);
    let (xx, xy, xz) = (x * x, x * y, x * z);
    let (yy, yz, zz) = (y * y, y * z, z * z);
    [
        ww + xx - yy - zz,
        2.0 * (xy - wz),
        2.0 * (xz + wy),
        2.0 * (xy + wz),
        ww - xx + yy - zz,
        2.0 * (yz - wx),
        2.0 * (xz - wy),
        2.0 * (yz + wx),
        ww - xx - yy + zz,
    ]
}

/// Rotates a vector by a unit quaternion: `v + 2 u x (w v + u x v)`.
#[inline(always)]
pub fn quat_rotate(q: Quat, v: Vec3) -> Vec3 {
    if v == [0.0; 3] {
        return [0.0; 3];
    }
    if q == QUAT_ID {
        return v;
    }
    let t = [
        q[0] * v[0] + q[2] * v[2] - q[3] * v[1],
        q[0] * v[1] + q[3] * v[0] - q[1] * v[2],
        q[0] * v[2] + q[1] * v[1] - q[2] * v[0],
    ];
    [
        v[0] + 2.0 * (q[2] * t[2] - q[3] * t[1]),
        v[1] + 2.0 * (q[3] * t[0] - q[1] * t[2]),
        v[2] + 2.0 * (q[1] * t[1] - q[2] * t[0]),
    ]
}

/// Returns the rotation vector (axis times angle, rad, at most pi long) that turns the unit quaternion `from` into `to`,
/// in the frame of `from` (MuJoCo's `mju_subQuat`).
pub fn rotation_between(from: Quat, to: Quat) -> Vec3 {
    let q = quat_mul(quat_conj(from), to);
    let (axis, sine) = unit([q[1], q[2], q[3]]);
    let angle = 2.0 * pxfm::f_atan2(sine, q[0]);
    // the short way round
    let short = if angle > std::f64::consts::PI {
        angle - 2.0 * std::f64::consts::PI
    } else {
        angle
    };
    scale(axis, short)
}

/// Returns the quaternion in `numbers` that starts at `at`.
#[inline(always)]
pub fn quat_at(numbers: &[f64], at: usize) -> Quat {
    [numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]]
}

/// Returns the quaternion of a rotation by `angle` (rad) about the unit vector `axis`.
#[inline(always)]
pub fn axis_angle_to_quat(axis: Vec3, angle: f64) -> Quat {
    if angle == 0.0 {
        return QUAT_ID;
    }
    let (s, c) = sincos(angle * 0.5);
    [c, axis[0] * s, axis[1] * s, axis[2] * s]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_by_matrix_and_quaternion_agree() {
        let axis = unit([1.0, -2.0, 0.5]).0;
        let q = axis_angle_to_quat(axis, 0.7);
        let v = [0.3, 0.1, -2.0];
        let a = quat_rotate(q, v);
        let b = mat_vec(&quat_to_mat(q), v);
        let c = mat_t_vec(&quat_to_mat(quat_conj(q)), v);
        for k in 0..3 {
            assert!((a[k] - b[k]).abs() < 1e-15 && (a[k] - c[k]).abs() < 1e-15);
        }
    }

    #[test]
    fn quaternion_product_composes_rotations() {
        let p = axis_angle_to_quat([0.0, 0.0, 1.0], 0.3);
        let q = axis_angle_to_quat([1.0, 0.0, 0.0], -1.1);
        let v = [0.2, 0.4, 0.9];
        let a = quat_rotate(quat_mul(p, q), v);
        let b = quat_rotate(p, quat_rotate(q, v));
        let m = mat_vec(&mat_mul(&quat_to_mat(p), &quat_to_mat(q)), v);
        for k in 0..3 {
            assert!((a[k] - b[k]).abs() < 1e-15 && (m[k] - b[k]).abs() < 1e-15);
        }
    }

    #[test]
    fn degenerate_input_has_a_defined_answer() {
        assert_eq!(unit([0.0; 3]).0, [1.0, 0.0, 0.0]);
        assert_eq!(quat_normalize([0.0; 4]), QUAT_ID);
        assert_eq!(quat_to_mat(QUAT_ID), MAT3_ID);
    }
}
