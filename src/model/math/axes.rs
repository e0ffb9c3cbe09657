//! Principal axes of symmetric matrices.

use super::{Quat, Vec3, mat_mul, quat_mul, quat_to_mat, transpose};

/// Computes the principal axes and values of a symmetric matrix given as xx yy zz xy xz yz, the largest value first.
///
/// The Jacobi rotations, kept as a quaternion, stop at an absolute 1e-12, as in MuJoCo, whose compiler and engine normalise quaternions in
/// ways that differ in the last bits.
pub fn principal_axes(full: &[f64; 6], normalize: impl Fn(Quat) -> Quat) -> (Quat, Vec3) {
    const STOP: f64 = 1e-12;
    let [xx, yy, zz, xy, xz, yz] = *full;
    let matrix = [xx, xy, xz, xy, yy, yz, xz, yz, zz];
    let mut quat = [1.0, 0.0, 0.0, 0.0];
    let mut values = [0.0; 3];
    for _ in 0..500 {
        let axes = quat_to_mat(quat);
        let d = mat_mul(&mat_mul(&transpose(&axes), &matrix), &axes);
        values = [d[0], d[4], d[8]];
        let (row, column, axis) = if d[1].abs() > d[2].abs() && d[1].abs() > d[5].abs() {
            (0, 1, 2)
        } else if d[2].abs() > d[5].abs() {
            (0, 2, 1)
        } else {
            (1, 2, 0)
        };
        let off = d[3 * row + column];
        if off.abs() < STOP {
            break;
        }
        let tau = (d[4 * column] - d[4 * row]) / (2.0 * off);
        let tangent = if tau >= 0.0 {
            1.0 / (tau + (1.0 + tau * tau).sqrt())
        } else {
            -1.0 / (-tau + (1.0 + tau * tau).sqrt())
        };
        let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
        if cosine > 1.0 - STOP {
            break;
        }
        let sine = (0.5 - 0.5 * cosine).sqrt();
        let mut turn = [0.0; 4];
        turn[axis + 1] = if (tau >= 0.0) == (axis == 1) { sine } else { -sine };
        turn[0] = (1.0 - turn[axis + 1] * turn[axis + 1]).sqrt();
        quat = normalize(quat_mul(quat, normalize(turn)));
    }
    // A bubble sort that turns the frame with every swap.
    for first in [0, 1, 0] {
        if values[first] + STOP < values[first + 1] {
            values.swap(first, first + 1);
            // Rounded to 15 digits there; the length is close enough to 1 that the rounding stays.
            let mut turn = [707_106_781_186_548e-15, 0.0, 0.0, 0.0];
            turn[(first + 2) % 3 + 1] = turn[0];
            quat = normalize(quat_mul(quat, normalize(turn)));
        }
    }
    (quat, values)
}
