//! Contact frames.

use crate::math::{Mat3, Vec3, add_scaled, cross, dot, norm, unit};

/// Returns a frame with the given normal as first row; the tangents follow the world's y axis, or z if the normal is
/// near y.
#[inline]
pub fn from_normal(normal: Vec3) -> Mat3 {
    let x = unit(normal).0;
    complete(x, default_hint(x))
}

/// Returns a frame as [`from_normal`] does, for a normal of unit length.
pub(super) fn of_unit(normal: Vec3) -> Mat3 {
    complete(normal, default_hint(normal))
}

/// Returns a frame with the given normal as first row and, as far as it is not along the normal, the hint as second.
///
/// A hint shorter than 0.5 is not used. Where hint and normal are parallel the tangents come from rounding noise, as in
/// MuJoCo (a capsule that stands upright on a plane).
#[inline]
pub(super) fn with_hint(normal: Vec3, hint: Vec3) -> Mat3 {
    let x = unit(normal).0;
    complete(x, if norm(hint) < 0.5 { default_hint(x) } else { hint })
}

#[inline(always)]
fn default_hint(x: Vec3) -> Vec3 {
    if x[1] < 0.5 && x[1] > -0.5 {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    }
}

/// Orthogonalises the hint against the unit vector `x` (Gram-Schmidt) and completes the frame.
#[inline(always)]
fn complete(x: Vec3, hint: Vec3) -> Mat3 {
    let y = unit(add_scaled(hint, x, -dot(x, hint))).0;
    let z = cross(x, y);
    [x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{MAT3_ID, mat_mul, transpose};

    #[test]
    fn frames_are_right_handed_and_orthonormal() {
        for normal in [[0.1, -2.0, 0.3], [0.0, 0.0, 1.0], [3.0, 1.0, -1.0], [0.0, -1.0, 0.0]] {
            for f in [from_normal(normal), with_hint(normal, [0.6, 0.0, 0.8])] {
                let p = mat_mul(&f, &transpose(&f));
                for (x, id) in p.iter().zip(MAT3_ID) {
                    assert!((x - id).abs() < 1e-15);
                }
                assert!(dot(cross([f[0], f[1], f[2]], [f[3], f[4], f[5]]), [f[6], f[7], f[8]]) > 0.999);
            }
        }
    }

    #[test]
    fn a_hint_along_the_normal_gives_a_defined_frame() {
        assert_eq!(with_hint([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])[3..6], [1.0, 0.0, 0.0]);
    }
}
