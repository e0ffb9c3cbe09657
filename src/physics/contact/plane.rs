//! Planes with spheres, capsules, ellipsoids, cylinders and boxes.

use super::{ContactPoint, PlacedGeom, add_scaled, column, dot, frame, sub};
use crate::math::{MINVAL, Mat3, Vec3, add, cross, mat_t_vec, mat_vec, scale, unit};

/// Returns the distance and position of the contact of a plane (point and unit normal) and a ball.
#[inline(always)]
pub(super) fn plane_ball(plane: Vec3, normal: Vec3, centre: Vec3, radius: f64, margin: f64) -> Option<(f64, Vec3)> {
    let height = dot(sub(centre, plane), normal);
    if height > margin + radius {
        return None;
    }
    let dist = height - radius;
    Some((dist, add_scaled(centre, normal, -dist / 2.0 - radius)))
}

/// Appends the contact of a plane and a point at a distance from it.
#[inline(always)]
pub(super) fn push_point(out: &mut Vec<ContactPoint>, point: Vec3, normal: Vec3, dist: f64, frame: Mat3) {
    let pos = add_scaled(point, normal, -0.5 * dist);
    out.push(ContactPoint { dist, pos, frame });
}

/// Finds the contact of a plane and a sphere.
pub(super) fn plane_sphere(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = a.axis();
    if let Some((dist, pos)) = plane_ball(a.pos, normal, b.pos, b.size[0], margin) {
        let frame = frame::from_normal(normal);
        out.push(ContactPoint { dist, pos, frame });
    }
}

/// Finds the contacts of a plane and a capsule: the ball at either end, first the one at the positive end. The first
/// tangent follows the capsule.
pub(super) fn plane_capsule(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    let (normal, axis) = (a.axis(), b.axis());
    let mut frame = None;
    for end in [b.size[1], -b.size[1]] {
        if let Some((dist, pos)) = plane_ball(a.pos, normal, add_scaled(b.pos, axis, end), b.size[0], margin) {
            let frame = *frame.get_or_insert_with(|| frame::with_hint(normal, axis));
            out.push(ContactPoint { dist, pos, frame });
        }
    }
}

/// Finds the contact of a plane and an ellipsoid: its lowest point.
pub(super) fn plane_ellipsoid(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = a.axis();
    let down = mat_t_vec(b.mat, scale(normal, -1.0));
    // MuJoCo's order of operations here is not that of the convex routines
    let ball = unit(std::array::from_fn(|k| down[k] * b.size[k])).0;
    let lowest = add(mat_vec(b.mat, std::array::from_fn(|k| ball[k] * b.size[k])), b.pos);
    let dist = dot(sub(lowest, a.pos), normal);
    if dist > margin || dist.is_nan() {
        return;
    }
    let frame = frame::from_normal(normal);
    push_point(out, lowest, normal, dist, frame);
}

/// Finds the contacts of a plane and a cylinder: the lowest point of the lower rim, the lowest of the upper rim, then
/// two more points of the lower rim which complete an equilateral triangle.
pub(super) fn plane_cylinder(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = a.axis();
    let (radius, half) = (b.size[0], b.size[1]);

    // axis towards the plane, and its component along the normal
    let mut axis = b.axis();
    let mut drop = dot(normal, axis);
    if drop > 0.0 {
        axis = scale(axis, -1.0);
        drop = -drop;
    }
    let height = dot(sub(b.pos, a.pos), normal);

    // from the axis to the lowest point of a rim
    let down = sub(scale(axis, drop), normal);
    let length2 = dot(down, down);
    // an upright cylinder has no lowest point on its rim: any serves, and its own x axis turns with it
    let rim = if length2 >= MINVAL * MINVAL {
        scale(down, radius / length2.sqrt())
    } else {
        scale(column(b.mat, 0), radius)
    };
    let rim_drop = dot(rim, normal);
    axis = scale(axis, half);
    drop *= half;

    // lower rim: nothing else can be lower
    let dist = height + drop + rim_drop;
    if dist > margin || dist.is_nan() {
        return;
    }
    let frame = frame::from_normal(normal);
    let mut push = |dist: f64, point: Vec3| {
        let pos = add_scaled(point, normal, -dist * 0.5);
        out.push(ContactPoint { dist, pos, frame });
    };
    push(dist, add(add(b.pos, rim), axis));

    // upper rim
    let dist = height - drop + rim_drop;
    if dist <= margin {
        push(dist, sub(add(b.pos, rim), axis));
    }

    // the other corners of the triangle
    let dist = height + drop - rim_drop * 0.5;
    if dist <= margin {
        let side = scale(unit(cross(rim, axis)).0, radius * 3f64.sqrt() / 2.0);
        for sign in [1.0, -1.0] {
            let corner = add_scaled(add(add_scaled(b.pos, side, sign), axis), rim, -0.5);
            push(dist, corner);
        }
    }
}

/// Finds the contacts of a plane and a box: the first four corners below the box centre that reach the plane.
pub(super) fn plane_box(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    const MOST: usize = 4;
    let normal = a.axis();
    let height = dot(sub(b.pos, a.pos), normal);
    // half edges of the box; a corner is the sum of one of either direction for each axis
    let edge = |k: usize| scale(column(b.mat, k), b.size[k]);
    let edges = [edge(0), edge(1), edge(2)];
    let mut frame = None;
    let mut count = 0;
    for corner in 0..8 {
        let sign = |k: usize| if corner >> k & 1 == 1 { 1.0 } else { -1.0 };
        let arm = add_scaled(
            add_scaled(scale(edges[0], sign(0)), edges[1], sign(1)),
            edges[2],
            sign(2),
        );
        let rise = dot(normal, arm);
        let dist = height + rise;
        // corners above the centre cannot be the lowest; without this a box deep in the plane would use its four
        // contacts on any
        if dist > margin || rise > 0.0 {
            continue;
        }
        let frame = *frame.get_or_insert_with(|| frame::from_normal(normal));
        let pos = add_scaled(add(arm, b.pos), normal, -dist / 2.0);
        out.push(ContactPoint { dist, pos, frame });
        count += 1;
        if count == MOST {
            return;
        }
    }
}
