//! A taut string around a sphere or a cylinder: the points where it touches, and the length of the part on the shape.
//!
//! The shape is cut to a circle, that of the sphere in the plane of both ends and the centre, or that of the cylinder seen along its
//! axis. Outside the circle the string follows one of two pairs of tangents and the arc between their points; inside it touches
//! at one point, where both parts make the same angle with the circle. Order of operations and thresholds are MuJoCo's.

use std::f64::consts::PI;

use crate::math::*;

/// A point of the plane of the circle.
type Vec2 = [f64; 2];

/// A sphere or cylinder that a tendon wraps around.
pub(super) struct WrapShape<'a> {
    pub pos: Vec3,
    pub mat: &'a Mat3,
    pub radius: f64,
    pub cylinder: bool,
}

/// The part of a tendon that lies on a shape.
pub(super) struct WrapPath {
    /// Points where it meets and leaves the shape, world, m.
    pub points: [Vec3; 2],
    /// Length between them along the shape, m.
    pub length: f64,
}

fn dot2(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn sub2(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] - b[0], a[1] - b[1]]
}

fn scale2(a: Vec2, s: f64) -> Vec2 {
    [a[0] * s, a[1] * s]
}

fn norm2(a: Vec2) -> f64 {
    dot2(a, a).sqrt()
}

fn unit2(a: Vec2) -> Vec2 {
    let length = norm2(a);
    if length < MINVAL {
        [1.0, 0.0]
    } else {
        scale2(a, 1.0 / length)
    }
}

/// Wraps a string between two points around a shape, on the side of a third point if there is one, world, m. A third point inside the radius makes
/// the string pass inside. Returns `None` if the string is straight.
#[doc(alias = "mju_wrap")]
pub(super) fn wrap(ends: [Vec3; 2], round: &WrapShape, side: Option<Vec3>) -> Option<WrapPath> {
    let local = |p: Vec3| mat_t_vec(round.mat, sub(p, round.pos));
    let p = [local(ends[0]), local(ends[1])];
    if norm(p[0]) < MINVAL || norm(p[1]) < MINVAL {
        return None;
    }
    let axes = plane(p, round.cylinder);
    let flat = |p: Vec3| [dot(p, axes[0]), dot(p, axes[1])];
    let d = [flat(p[0]), flat(p[1])];
    let side = side.map(local);
    let (touch, mut length) = match side {
        Some(side) if norm(side) < round.radius => (inside(d, round.radius)?, 0.0),
        Some(side) => outside(d, Some(scale2(unit2(flat(side)), round.radius)), round.radius)?,
        None => outside(d, None, round.radius)?,
    };
    let raised = |t: Vec2| add(scale(axes[0], t[0]), scale(axes[1], t[1]));
    let mut points = [raised(touch[0]), raised(touch[1])];
    if round.cylinder {
        // it climbs the cylinder as a helix does, in proportion to the way
        let way = |k: usize| norm2(sub2([p[k][0], p[k][1]], [points[k][0], points[k][1]]));
        let (before, behind) = (way(0), way(1));
        let (climb, total) = (p[1][2] - p[0][2], before + length + behind);
        points[0][2] = p[0][2] + climb * before / total;
        points[1][2] = p[0][2] + climb * (before + length) / total;
        let height = (points[1][2] - points[0][2]).abs();
        length = (length * length + height * height).sqrt();
    }
    let placed = |point: Vec3| add(mat_vec(round.mat, point), round.pos);
    let points = [placed(points[0]), placed(points[1])];
    Some(WrapPath { points, length })
}

/// Returns the axes of the plane of the circle, in the frame of the shape.
fn plane([a, b]: [Vec3; 2], cylinder: bool) -> [Vec3; 2] {
    if cylinder {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    }
    let first = unit(a).0;
    let (mut normal, length) = unit(cross(a, b));
    if length < MINVAL {
        // both ends and the centre are on a line: any plane through it
        let mut largest = 0;
        for k in [1, 2] {
            if (0..3).all(|other| other == k || first[k].abs() > first[other].abs()) {
                largest = k;
            }
        }
        let mut other = [1.0; 3];
        other[largest] = 0.0;
        normal = unit(cross(first, other)).0;
    }
    [first, unit(cross(normal, first)).0]
}

/// Returns whether two segments meet.
fn meet([p1, p2]: [Vec2; 2], [p3, p4]: [Vec2; 2]) -> bool {
    let (u, v, w) = (sub2(p2, p1), sub2(p4, p3), sub2(p1, p3));
    let det = v[1] * u[0] - v[0] * u[1];
    if det.abs() < MINVAL {
        return false;
    }
    let a = (v[0] * w[1] - v[1] * w[0]) / det;
    let b = (u[0] * w[1] - u[1] * w[0]) / det;
    (0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b)
}

/// Returns the points where a string touches a circle about the origin from outside, and the length of the arc between them.
fn outside(d: [Vec2; 2], side: Option<Vec2>, radius: f64) -> Option<([Vec2; 2], f64)> {
    let square = [dot2(d[0], d[0]), dot2(d[1], d[1])];
    let square_radius = radius * radius;
    if square[0] < square_radius || square[1] < square_radius || radius < MINVAL {
        return None;
    }
    let apart = sub2(d[1], d[0]);
    let distance = dot2(apart, apart);
    if distance < MINVAL {
        return None;
    }
    // the point of the straight string next to the centre
    let place = (-dot2(apart, d[0]) / distance).clamp(0.0, 1.0);
    let near = [place * apart[0] + d[0][0], place * apart[1] + d[0][1]];
    if dot2(near, near) > square_radius && side.is_none_or(|side| dot2(side, near) >= 0.0) {
        return None;
    }
    let tangent = |k: usize, sign: f64| {
        let root = (square[k] - square_radius).sqrt();
        [
            (d[k][0] * square_radius + sign * radius * d[k][1] * root) / square[k],
            (d[k][1] * square_radius - sign * radius * d[k][0] * root) / square[k],
        ]
    };
    let ways = [[tangent(0, 1.0), tangent(1, -1.0)], [tangent(0, -1.0), tangent(1, 1.0)]];
    let crosses = |way: [Vec2; 2]| meet([d[0], way[0]], [d[1], way[1]]);
    // the way on the given side, or the shorter one
    let good = |way: [Vec2; 2]| {
        if crosses(way) {
            return -10000.0;
        }
        match side {
            Some(side) => {
                let middle = [way[0][0] + way[1][0], way[0][1] + way[1][1]];
                dot2(unit2(middle), side)
            }
            None => {
                let chord = sub2(way[0], way[1]);
                -dot2(chord, chord)
            }
        }
    };
    let best = if good(ways[0]) > good(ways[1]) { 0 } else { 1 };
    let way = ways[best];
    if crosses(way) {
        return None;
    }
    Some((way, arc(way, best == 1, radius)))
}

/// Returns the length of the arc from one point of a circle to another, clockwise or not.
fn arc([p0, p1]: [Vec2; 2], turned: bool, radius: f64) -> f64 {
    let angle = pxfm::f_acos(dot2(unit2(p0), unit2(p1)).clamp(-1.0, 1.0));
    let cross = p0[1] * p1[0] - p0[0] * p1[1];
    if cross > 0.0 && turned || cross < 0.0 && !turned {
        radius * (2.0 * PI - angle)
    } else {
        radius * angle
    }
}

/// Solves the equation of [`inside`] for `z`; `None` if Newton's method no longer descends to the root, because MuJoCo then gives up.
fn sine_at_touch([a, b]: [f64; 2], seen: f64) -> Option<f64> {
    const STEPS: usize = 20;
    const START: f64 = 1.0 - 1e-7;
    const TOLERANCE: f64 = 1e-6;
    // The left side of the equation, and the cosines of its angles, which the slope needs, too. The sum of the angles is the argument of
    // a product of complex numbers: one arc function does for three.
    let at = |z: f64| {
        let cosine = |r: f64| (1.0 - z * z * r * r).sqrt();
        let (ca, cb, c) = (cosine(a), cosine(b), cosine(1.0));
        let (sa, sb) = (a * z, b * z);
        let (re, im) = (ca * cb - sa * sb, ca * sb + sa * cb);
        // turned back by twice the angle of z
        let (cos, sin) = (c * c - z * z, 2.0 * z * c);
        let excess = pxfm::f_atan2(im * cos - re * sin, re * cos + im * sin) + seen;
        (excess, [ca, cb, c])
    };
    let mut z = START;
    let (mut f, mut cosines) = at(z);
    if f > 0.0 {
        return None;
    }
    let mut step = 0;
    while step < STEPS && f.abs() > TOLERANCE {
        let [ca, cb, c] = cosines;
        let slope = a / ca.max(MINVAL) + b / cb.max(MINVAL) - 2.0 / c.max(MINVAL);
        if slope > -MINVAL {
            return None;
        }
        let next = z - f / slope;
        if next > z {
            return None;
        }
        z = next;
        (f, cosines) = at(z);
        if f > TOLERANCE {
            return None;
        }
        step += 1;
    }
    (step < STEPS).then_some(z)
}

/// Returns the point, twice, where a string touches a circle about the origin from inside.
///
/// With `z` the sine of the angle between a part of the string and the radius at that point, and `A`, `B` the ratios of the radius to
/// the distances of the ends, the angles of the triangles add up to `asin(A z) + asin(B z) - 2 asin(z) + G = 0`, `G` the angle
/// between the ends seen from the centre; Newton's method solves it from `z = 1` downwards.
fn inside(d: [Vec2; 2], radius: f64) -> Option<[Vec2; 2]> {
    let length = [norm2(d[0]), norm2(d[1])];
    let apart = sub2(d[1], d[0]);
    let distance = dot2(apart, apart);
    let reached = |l: f64| l <= radius || l < MINVAL;
    if radius < MINVAL || reached(length[0]) || reached(length[1]) {
        return None;
    }
    if distance > MINVAL {
        let place = -dot2(apart, d[0]) / distance;
        let near = [d[0][0] + apart[0] * place, d[0][1] + apart[1] * place];
        if place > 0.0 && place < 1.0 && norm2(near) <= radius {
            return None;
        }
    }
    // where no solution is found
    let middle = unit2([0.5 * (d[0][0] + d[1][0]), 0.5 * (d[0][1] + d[1][1])]);
    let middle = Some([scale2(middle, radius); 2]);
    let [a, b] = [radius / length[0], radius / length[1]];
    let cosine = (length[0] * length[0] + length[1] * length[1] - distance) / (2.0 * length[0] * length[1]);
    if cosine < -1.0 + MINVAL {
        return None;
    }
    if cosine > 1.0 - MINVAL {
        return middle;
    }
    let Some(z) = sine_at_touch([a, b], pxfm::f_acos(cosine)) else {
        return middle;
    };
    let asin = pxfm::f_asin;
    let (from, angle) = if d[0][0] * d[1][1] - d[0][1] * d[1][0] > 0.0 {
        (d[0], asin(z) - asin(a * z))
    } else {
        (d[1], asin(z) - asin(b * z))
    };
    let (from, (sin, cos)) = (unit2(from), pxfm::f_sincos(angle));
    let touch = [
        radius * (cos * from[0] - sin * from[1]),
        radius * (sin * from[0] + cos * from[1]),
    ];
    Some([touch; 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(radius: f64) -> WrapShape<'static> {
        WrapShape {
            pos: [0.0; 3],
            mat: &MAT3_ID,
            radius,
            cylinder: false,
        }
    }

    #[test]
    fn a_string_over_a_ball_is_two_tangents_and_an_arc() {
        let ends = [[-2.0, 0.5, 0.0], [2.0, 0.5, 0.0]];
        let wrapped = wrap(ends, &ball(1.0), None).expect("the ball is in the way");
        let [p, q] = wrapped.points;
        // tangents stand on the radius
        assert!(dot(p, sub(p, ends[0])).abs() < 1e-14 && dot(q, sub(q, ends[1])).abs() < 1e-14);
        assert!(p[1] > 0.0, "the nearer side");
        assert!((wrapped.length - pxfm::f_acos(dot(p, q))).abs() < 1e-14);
        // above the ball it is straight
        assert!(wrap([[-2.0, 1.1, 0.0], [2.0, 1.1, 0.0]], &ball(1.0), None).is_none());
        // a side site below pulls it around
        let around = wrap(ends, &ball(1.0), Some([0.0, -3.0, 0.0])).expect("a way below");
        assert!(around.points[0][1] < 0.0 && around.length > wrapped.length);
    }

    #[test]
    fn a_string_through_a_ring_touches_it_at_equal_angles() {
        let ends = [[-2.0, 1.5, 0.0], [1.0, 2.0, 0.0]];
        let wrapped = wrap(ends, &ball(1.0), Some([0.1, 0.0, 0.0])).expect("the string passes above the ring");
        let [p, q] = wrapped.points;
        assert_eq!((p, wrapped.length), (q, 0.0));
        assert!((norm(p) - 1.0).abs() < 1e-14);
        let angle = |end: Vec3| dot(unit(sub(end, p)).0, p);
        assert!((angle(ends[0]) - angle(ends[1])).abs() < 1e-6, "{p:?}");
    }

    #[test]
    fn a_string_climbs_a_cylinder_evenly() {
        let post = WrapShape {
            cylinder: true,
            ..ball(1.0)
        };
        let ends = [[-2.0, 0.5, 0.0], [2.0, 0.5, 3.0]];
        let wrapped = wrap(ends, &post, None).expect("the post is in the way");
        let [p, q] = wrapped.points;
        let slope = |from: Vec3, to: Vec3, way: f64| (to[2] - from[2]) / way;
        let flat = |from: Vec3, to: Vec3| norm2([to[0] - from[0], to[1] - from[1]]);
        let height = q[2] - p[2];
        let arc = (wrapped.length * wrapped.length - height * height).sqrt();
        let slopes = [
            slope(ends[0], p, flat(ends[0], p)),
            height / arc,
            slope(q, ends[1], flat(q, ends[1])),
        ];
        assert!(slopes.iter().all(|s| (s - slopes[0]).abs() < 1e-14), "{slopes:?}");
    }
}
