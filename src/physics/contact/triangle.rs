//! The point of a triangle that is nearest to the origin, with the decisions of libccd's `ccdVec3PointTriDist2`, the last stage of MPR.

use super::tolerance::{equal, is_zero};
use super::{dot, sub};
use crate::math::{Vec3, add, scale};

/// Returns the point of a segment that is nearest to the origin, and the square of its distance.
fn of_segment(from: Vec3, to: Vec3) -> (Vec3, f64) {
    let edge = sub(to, from);
    let t = -dot(from, edge) / dot(edge, edge);
    let point = if t < 0.0 || is_zero(t) {
        from
    } else if t > 1.0 || equal(t, 1.0) {
        to
    } else {
        add(scale(edge, t), from)
    };
    (point, dot(point, point))
}

/// Returns the point of a triangle that is nearest to the origin, and the square of its distance.
pub(super) fn nearest(a: Vec3, b: Vec3, c: Vec3) -> (Vec3, f64) {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let (v, w, p, q, r) = (dot(ab, ab), dot(ac, ac), dot(a, ab), dot(a, ac), dot(ab, ac));
    let area = w * v - r * r;
    // of a triangle of hardly any area the edges count alone
    if !is_zero(area) {
        let s = (q * r - w * p) / area;
        let t = (-s * r - q) / w;
        let share = |x: f64| (is_zero(x) || x > 0.0) && (x < 1.0 || equal(x, 1.0));
        if share(s) && share(t) && (t + s < 1.0 || equal(t + s, 1.0)) {
            let point = add(add(a, scale(ab, s)), scale(ac, t));
            return (point, dot(point, point));
        }
    }
    let mut least = of_segment(a, b);
    for other in [of_segment(a, c), of_segment(b, c)] {
        if other.1 < least.1 {
            least = other;
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_inside_on_an_edge_or_a_corner() {
        let triangle = |x: f64, y: f64| nearest([x, y, 1.0], [x + 1.0, y, 1.0], [x, y + 1.0, 1.0]);
        assert_eq!(triangle(-0.25, -0.25), ([0.0, 0.0, 1.0], 1.0));
        assert_eq!(triangle(-0.5, 1.0), ([0.0, 1.0, 1.0], 2.0));
        assert_eq!(triangle(1.0, 1.0), ([1.0, 1.0, 1.0], 3.0));
        // its area counts for nothing: an edge stands for it
        let thin = nearest([-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1e-9, 1.0]);
        assert_eq!(thin, ([0.0, 0.0, 1.0], 1.0));
    }
}
