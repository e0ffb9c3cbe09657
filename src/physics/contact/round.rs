//! Spheres with spheres, capsules, cylinders and boxes, and capsules with capsules: pairs whose contacts are those of
//! two balls, a ball and a plane, or a ball and a box.

use super::plane::plane_ball;
use super::{BareContact, ContactPoint, PlacedGeom, add_scaled, dot, push, sub};
use crate::math::{MINVAL, Vec3, add, cross, mat_t_vec, mat_vec, scale, unit};

/// A sphere with the axis of its geom. The axes give a normal if two centres coincide.
#[derive(Clone, Copy)]
struct AxisSphere {
    centre: Vec3,
    radius: f64,
    axis: Vec3,
}

#[inline(always)]
fn ball_ball(a: AxisSphere, b: AxisSphere, margin: f64) -> Option<BareContact> {
    let between = sub(a.centre, b.centre);
    let distance2 = dot(between, between);
    let reach = margin + a.radius + b.radius;
    if distance2 > reach * reach {
        return None;
    }
    let dist = distance2.sqrt() - a.radius - b.radius;
    let (mut normal, length) = unit(sub(b.centre, a.centre));
    if length < MINVAL {
        // coinciding centres give no direction; MuJoCo takes the one across both axes
        normal = unit(cross(a.axis, b.axis)).0;
    }
    let pos = add_scaled(a.centre, normal, a.radius + dist / 2.0);
    Some(BareContact { dist, pos, normal })
}

#[inline(always)]
fn ball_of(geom: &PlacedGeom) -> AxisSphere {
    AxisSphere {
        centre: geom.pos,
        radius: geom.size[0],
        axis: geom.axis(),
    }
}

/// Finds the contact of two spheres, at most one.
#[inline]
pub(super) fn sphere_sphere(a: &PlacedGeom, b: &PlacedGeom, margin: f64) -> Option<BareContact> {
    ball_ball(ball_of(a), ball_of(b), margin)
}

/// Finds the contact of a sphere and the nearest ball of a capsule.
#[inline]
pub(super) fn sphere_capsule(a: &PlacedGeom, b: &PlacedGeom, margin: f64) -> Option<BareContact> {
    let axis = b.axis();
    let along = dot(axis, sub(a.pos, b.pos)).max(-b.size[1]).min(b.size[1]);
    let nearest = AxisSphere {
        centre: add(scale(axis, along), b.pos),
        radius: b.size[0],
        axis,
    };
    ball_ball(ball_of(a), nearest, margin)
}

/// Finds the contact of a sphere and a cylinder: with its side, an end disc, or a rim.
#[inline]
pub(super) fn sphere_cylinder(a: &PlacedGeom, b: &PlacedGeom, margin: f64) -> Option<BareContact> {
    let (radius, half) = (b.size[0], b.size[1]);
    let axis = b.axis();
    let from_centre = sub(a.pos, b.pos);
    let height = dot(axis, from_centre);
    let along = scale(axis, height);
    let radial = sub(from_centre, along);
    let radial2 = dot(radial, radial);

    // inside both bounds the nearer surface counts
    let mut side = height.abs() < half;
    let mut cap = radial2 < radius * radius;
    if side && cap {
        cap = half - height.abs() < radius - radial2.sqrt();
        side = !cap;
    }
    let ball = |centre: Vec3, radius: f64| AxisSphere { centre, radius, axis };
    if side {
        return ball_ball(ball_of(a), ball(add(along, b.pos), radius), margin);
    }
    if cap {
        let (disc, outward) = if height > 0.0 {
            (add_scaled(b.pos, axis, half), axis)
        } else {
            (add_scaled(b.pos, axis, -half), scale(axis, -1.0))
        };
        let (dist, pos) = plane_ball(disc, outward, a.pos, a.size[0], margin)?;
        let normal = scale(outward, -1.0);
        return Some(BareContact { dist, pos, normal });
    }
    let end = scale(axis, if height > 0.0 { half } else { -half });
    let rim = add(add(end, scale(radial, radius / radial2.sqrt())), b.pos);
    ball_ball(ball_of(a), ball(rim, 0.0), margin)
}

/// Finds the contact of a ball and a box. A centre inside the box is pushed out through the nearest face: the normal
/// points into the box there as well.
#[inline]
pub(super) fn ball_box(centre: Vec3, radius: f64, b: &PlacedGeom, margin: f64) -> Option<BareContact> {
    let size = b.size;
    let local = mat_t_vec(b.mat, sub(centre, b.pos));
    let mut nearest = local;
    for k in 0..3 {
        if size[k] > 0.0 {
            if nearest[k] < -size[k] {
                nearest[k] = -size[k];
            } else if nearest[k] > size[k] {
                nearest[k] = size[k];
            }
        }
    }
    let (towards, distance) = unit(sub(nearest, local));
    if distance - radius > margin {
        return None;
    }
    let (dist, point, normal) = if distance <= MINVAL {
        // centre inside: the face with the least way out, first one on ties
        let mut least = (size[0] + size[1] + size[2]) * 2.0;
        let mut inward = [0.0; 3];
        for k in 0..3 {
            for sign in [-1.0, 1.0] {
                let way = (sign * size[k] - local[k]).abs();
                if least > way {
                    least = way;
                    inward = [0.0; 3];
                    inward[k] = -sign;
                }
            }
        }
        let point = add_scaled(local, inward, (radius - least) / 2.0);
        (-least - radius, point, inward)
    } else {
        let deepest = add_scaled(local, towards, radius);
        let point = add(scale(nearest, 0.5), scale(deepest, 0.5));
        (distance - radius, point, towards)
    };
    Some(BareContact {
        dist,
        pos: add(mat_vec(b.mat, point), b.pos),
        normal: mat_vec(b.mat, normal),
    })
}

/// Clamps a position to its segment. A segment without length gives the quotient of two zeros, which becomes an end.
#[inline(always)]
#[allow(clippy::manual_clamp)] // `clamp` would keep that quotient
fn clamp_to_segment(x: f64) -> f64 {
    x.max(-1.0).min(1.0)
}

/// The segments of two capsules, as `centre + x half` with x in -1..1, and the normal equations of their nearest points.
struct Segments<'a> {
    a: &'a PlacedGeom<'a>,
    b: &'a PlacedGeom<'a>,
    axis1: Vec3,
    axis2: Vec3,
    half1: Vec3,
    half2: Vec3,
    /// `m11 x1 + m12 x2 = u` and `m12 x1 + m22 x2 = v`
    m11: f64,
    m12: f64,
    m22: f64,
    u: f64,
    v: f64,
}

impl<'a> Segments<'a> {
    #[inline(always)]
    fn new(a: &'a PlacedGeom<'a>, b: &'a PlacedGeom<'a>) -> Self {
        let (axis1, axis2) = (a.axis(), b.axis());
        let (half1, half2) = (scale(axis1, a.size[1]), scale(axis2, b.size[1]));
        let between = sub(a.pos, b.pos);
        Segments {
            a,
            b,
            axis1,
            axis2,
            half1,
            half2,
            m11: dot(half1, half1),
            m12: -dot(half1, half2),
            m22: dot(half2, half2),
            u: -dot(half1, between),
            v: dot(half2, between),
        }
    }

    /// Creates the contact of the balls at two points of the segments.
    #[inline(always)]
    fn touch(&self, x1: f64, x2: f64, margin: f64) -> Option<BareContact> {
        let first = AxisSphere {
            centre: add_scaled(self.a.pos, self.half1, x1),
            radius: self.a.size[0],
            axis: self.axis1,
        };
        let second = AxisSphere {
            centre: add_scaled(self.b.pos, self.half2, x2),
            radius: self.b.size[0],
            axis: self.axis2,
        };
        ball_ball(first, second, margin)
    }

    /// Returns the nearest points of two segments that are not parallel.
    #[inline(always)]
    fn nearest(&self, det: f64) -> (f64, f64) {
        let Segments {
            m11, m12, m22, u, v, ..
        } = *self;
        let mut x1 = (m22 * u - m12 * v) / det;
        let mut x2 = (m11 * v - m12 * u) / det;
        // clamped one after the other, as the nearest point of either segment depends on the other's (Ericson 2005,
        // section 5.1.9)
        if x1 > 1.0 {
            x1 = 1.0;
            x2 = (v - m12) / m22;
        } else if x1 < -1.0 {
            x1 = -1.0;
            x2 = (v + m12) / m22;
        }
        if x2 > 1.0 {
            x2 = 1.0;
            x1 = clamp_to_segment((u - m12) / m11);
        } else if x2 < -1.0 {
            x2 = -1.0;
            x1 = clamp_to_segment((u + m12) / m11);
        }
        (x1, x2)
    }
}

/// Finds the contacts of parallel capsules: the ends of the first, then those of the second, until there are two.
#[cold]
fn parallel_capsules(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    let segments = Segments::new(a, b);
    let Segments {
        m11, m12, m22, u, v, ..
    } = segments;
    let before = out.len();
    let places = [
        (1.0, clamp_to_segment((v - m12) / m22)),
        (-1.0, clamp_to_segment((v + m12) / m22)),
        (clamp_to_segment((u - m12) / m11), 1.0),
        (clamp_to_segment((u + m12) / m11), -1.0),
    ];
    for (x1, x2) in places {
        // a line of contact is held by its two ends
        if out.len() - before < 2 {
            push(segments.touch(x1, x2, margin), out);
        }
    }
}

/// Finds the contacts of two capsules: at the nearest points of the segments, or up to two at segment ends when they
/// are parallel.
pub(super) fn capsule_capsule(a: &PlacedGeom, b: &PlacedGeom, margin: f64, out: &mut Vec<ContactPoint>) {
    let segments = Segments::new(a, b);
    let det = segments.m11 * segments.m22 - segments.m12 * segments.m12;
    if det.abs() >= MINVAL {
        let (x1, x2) = segments.nearest(det);
        push(segments.touch(x1, x2, margin), out);
    } else {
        parallel_capsules(a, b, margin, out);
    }
}
