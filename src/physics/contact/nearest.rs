//! The point of a segment, triangle or tetrahedron nearest to the origin, as weights of its corners, by signed volumes
//! (Montanari, Petrinic and Barbieri, "Improving the GJK algorithm for faster and more reliable distance queries between
//! convex objects", ACM Transactions on Graphics 36, 2017), in MuJoCo's arrangement.

use super::{MAXVAL, add_scaled, dot, sub};
use crate::math::{MINVAL, Vec3, cross, scale};

/// Returns whether both numbers are positive or both negative.
#[inline(always)]
pub(super) fn agree(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}

/// Computes `wa a + wb b + wc c`.
#[inline(always)]
pub(super) fn combine3(w: Vec3, a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    add_scaled(add_scaled(scale(a, w[0]), b, w[1]), c, w[2])
}

#[inline(always)]
fn scale_down(v: Vec3, divisor: f64) -> Vec3 {
    [v[0] / divisor, v[1] / divisor, v[2] / divisor]
}

#[inline(always)]
fn determinant(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Returns the foot of the perpendicular from the origin to the plane through three points; `None` if they are on a
/// line.
#[inline(always)]
pub(super) fn foot_on_plane(a: Vec3, b: Vec3, c: Vec3) -> Option<Vec3> {
    let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
    // the normal from each pair of edges in turn, until one serves
    for (normal, base) in [(cross(bc, ab), b), (cross(ab, ac), a)] {
        let (height, length2) = (dot(normal, base), dot(normal, normal));
        if length2 == 0.0 {
            return None;
        }
        // a short normal, or one across the base point, has lost its digits to cancellation; other edges may do better
        if height != 0.0 && length2 > MINVAL {
            return Some(scale(normal, height / length2));
        }
    }
    let normal = cross(ac, bc);
    Some(scale(normal, dot(normal, c) / dot(normal, normal)))
}

/// Returns the weights of the point of a segment nearest to the origin. Off either end it is `b`, the newer one.
#[inline(always)]
pub(super) fn segment_weights(a: Vec3, b: Vec3) -> [f64; 2] {
    let edge = sub(b, a);
    let foot = add_scaled(b, edge, -(dot(b, edge) / dot(edge, edge)));
    // compare lengths on the axis along which the segment is longest
    let mut axis = 0;
    let mut length = 0.0f64;
    for k in 0..3 {
        let extent = a[k] - b[k];
        // the quotient by a short extent would magnify rounding
        if extent.abs() >= length.abs() {
            length = extent;
            axis = k;
        }
    }
    let (to_foot, from_foot) = (foot[axis] - b[axis], a[axis] - foot[axis]);
    if agree(length, to_foot) && agree(length, from_foot) {
        [to_foot / length, from_foot / length]
    } else {
        [0.0, 1.0]
    }
}

/// The coordinate plane on which a triangle's projection is largest.
#[derive(Clone, Copy)]
pub(super) struct Projection {
    /// Signed double area of the projection.
    area: f64,
    /// The two coordinates that are kept.
    kept: (usize, usize),
}

impl Projection {
    /// Returns the best projection of a triangle.
    #[inline(always)]
    pub(super) fn of(a: Vec3, b: Vec3, c: Vec3) -> Projection {
        let area =
            |x: usize, y: usize| b[x] * c[y] - b[y] * c[x] - a[x] * c[y] + a[y] * c[x] + a[x] * b[y] - a[y] * b[x];
        let (yz, xz, xy) = (area(1, 2), area(0, 2), area(0, 1));
        if yz.abs() >= xz.abs() && yz.abs() >= xy.abs() {
            Projection { area: yz, kept: (1, 2) }
        } else if xz.abs() >= xy.abs() {
            Projection { area: xz, kept: (0, 2) }
        } else {
            Projection { area: xy, kept: (0, 1) }
        }
    }

    /// Returns the signed double areas of the triangle with a point in place of each corner in turn.
    #[inline(always)]
    fn areas(&self, a: Vec3, b: Vec3, c: Vec3, p: Vec3) -> Vec3 {
        let (x, y) = self.kept;
        let area = |b: Vec3, c: Vec3| p[x] * b[y] + p[y] * c[x] + b[x] * c[y] - p[x] * c[y] - p[y] * b[x] - c[x] * b[y];
        [area(b, c), area(c, a), area(a, b)]
    }

    /// Returns the weights of the corners that make up a point of the triangle's plane; negative outside.
    #[inline(always)]
    pub(super) fn weights(&self, a: Vec3, b: Vec3, c: Vec3, p: Vec3) -> Vec3 {
        let k = self.areas(a, b, c, p);
        scale_down(k, self.area)
    }
}

/// Returns the weights of the point of a triangle nearest to the origin.
#[inline(always)]
pub(super) fn triangle_weights(a: Vec3, b: Vec3, c: Vec3) -> [f64; 3] {
    let Some(foot) = foot_on_plane(a, b, c) else {
        let w = segment_weights(a, b);
        return [w[0], w[1], 0.0];
    };
    let projection = Projection::of(a, b, c);
    let k = projection.areas(a, b, c, foot);
    let inside = [
        agree(projection.area, k[0]),
        agree(projection.area, k[1]),
        agree(projection.area, k[2]),
    ];
    // the foot is in the triangle exactly if all three parts turn the same way as the whole
    if inside == [true; 3] {
        return scale_down(k, projection.area);
    }
    // the edges opposite the corners that the foot is turned away from; the first one counts unseen
    let v = [a, b, c];
    let mut least = MAXVAL;
    let mut weights = [0.0; 3];
    for (corner, (i, j)) in [(1, 2), (0, 2), (0, 1)].into_iter().enumerate() {
        if inside[corner] {
            continue;
        }
        let w = segment_weights(v[i], v[j]);
        let point = add_scaled(scale(v[i], w[0]), v[j], w[1]);
        let distance2 = dot(point, point);
        if corner == 0 || distance2 < least {
            weights = [0.0; 3];
            (weights[i], weights[j]) = (w[0], w[1]);
            least = distance2;
        }
    }
    weights
}

/// Returns the weights of the point of a tetrahedron nearest to the origin.
pub(super) fn tetrahedron_weights(v: [Vec3; 4]) -> [f64; 4] {
    let k = [
        -determinant(v[1], v[2], v[3]),
        determinant(v[0], v[2], v[3]),
        -determinant(v[0], v[1], v[3]),
        determinant(v[0], v[1], v[2]),
    ];
    let volume = k[0] + k[1] + k[2] + k[3];
    let inside = k.map(|part| agree(volume, part));
    // the origin is inside exactly if all four parts have the sign of the whole
    if inside == [true; 4] {
        return k.map(|part| part / volume);
    }
    // the faces opposite the corners that the origin is turned away from; the first one counts unseen
    let mut least = MAXVAL;
    let mut weights = [0.0; 4];
    for (corner, [i, j, l]) in [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]].into_iter().enumerate() {
        if inside[corner] {
            continue;
        }
        let w = triangle_weights(v[i], v[j], v[l]);
        let point = combine3(w, v[i], v[j], v[l]);
        let distance2 = dot(point, point);
        if corner == 0 || distance2 < least {
            weights = [0.0; 4];
            (weights[i], weights[j], weights[l]) = (w[0], w[1], w[2]);
            least = distance2;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_off_the_origin_gives_its_newer_end() {
        assert_eq!(segment_weights([1.0, 0.0, 0.0], [2.0, 0.0, 0.0]), [0.0, 1.0]);
        assert_eq!(segment_weights([-1.0, 1.0, 0.0], [3.0, 1.0, 0.0]), [0.75, 0.25]);
    }

    #[test]
    fn a_triangle_gives_its_face_an_edge_or_no_third_weight_when_flat() {
        let w = triangle_weights([-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]);
        assert_eq!(w, [0.25, 0.25, 0.5]);
        let w = triangle_weights([-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [0.0, 3.0, 1.0]);
        assert_eq!(w, [0.5, 0.5, 0.0]);
        let w = triangle_weights([-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [3.0, 1.0, 0.0]);
        assert_eq!(w, [0.5, 0.5, 0.0]);
    }

    #[test]
    fn a_tetrahedron_around_the_origin_has_four_weights() {
        let v = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        assert_eq!(tetrahedron_weights(v), [0.25; 4]);
        let above = v.map(|p| [p[0], p[1], p[2] + 3.0]);
        let w = tetrahedron_weights(above);
        assert!(w[0] == 0.0 && w[3] == 0.0 && (w[1] - 0.5).abs() < 1e-15, "{w:?}");
    }
}
