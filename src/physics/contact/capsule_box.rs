//! Capsules with boxes: the point of the capsule's segment nearest to the box, then a second one if the segment runs
//! along an edge or a face.

use super::round::ball_box;
use super::{ContactPoint, PlacedGeom, Quirks, add_scaled, dot, push, sub};
use crate::math::{MINVAL, Vec3, add, mat_t_vec, mat_vec, scale};

/// A capsule's segment in the frame of the box: points `centre + t half` with t in -1..1.
struct LocalSegment {
    centre: Vec3,
    axis: Vec3,
    half: Vec3,
    half_length: f64,
    /// Bit k is set where the segment rises along box axis k.
    rising: usize,
    size: Vec3,
}

/// The feature of the box that the segment is nearest to. A corner or edge is named by a mask: bit k is set on the
/// positive side of axis k.
#[derive(Clone, Copy)]
enum BoxFeature {
    /// The face across this axis, nearest to an end of the segment (t = -1 or 1); `None` if the end is inside the box.
    Face { axis: Option<usize> },
    /// A corner.
    Corner { corner: usize },
    /// The inside of an edge along `axis`, at `position` in -1..1.
    Edge { axis: usize, corner: usize, position: f64 },
}

/// The nearest point on the segment found so far.
struct NearestPoint {
    distance2: f64,
    t: f64,
    feature: Option<BoxFeature>,
}

/// Finds the contacts of a capsule and a box, at most two.
pub(super) fn capsule_box(a: &PlacedGeom, b: &PlacedGeom, margin: f64, quirks: &Quirks, out: &mut Vec<ContactPoint>) {
    let axis = mat_t_vec(b.mat, a.axis());
    let half = scale(axis, a.size[1]);
    let segment = LocalSegment {
        centre: mat_t_vec(b.mat, sub(a.pos, b.pos)),
        axis,
        half,
        half_length: a.size[1],
        rising: (half[0] > 0.0) as usize | ((half[1] > 0.0) as usize) << 1 | ((half[2] > 0.0) as usize) << 2,
        size: b.size,
    };
    let s = b.size;
    let mut nearest = NearestPoint {
        distance2: margin + 2.0 * (a.size[0] + a.size[1] + s[0] + s[1] + s[2]),
        t: 0.0,
        feature: None,
    };
    segment.search_ends(&mut nearest);
    segment.search_edges::<0>(&mut nearest, quirks);
    segment.search_edges::<1>(&mut nearest, quirks);
    segment.search_edges::<2>(&mut nearest, quirks);
    let Some(feature) = nearest.feature else { return };

    let mut touch = |t: f64| {
        let centre = add(mat_vec(b.mat, add_scaled(segment.centre, segment.half, t)), b.pos);
        push(ball_box(centre, a.size[0], b, margin), out);
    };
    touch(nearest.t);
    if let Some(step) = segment.second_contact(nearest.t, feature) {
        touch(step + nearest.t);
    }
}

/// A point of an edge: one of its corners or between them.
#[derive(Clone, Copy)]
enum EdgePoint {
    Lower,
    Middle,
    Upper,
}

/// The normal equations of the nearest points of an edge and the segment: `m11 p + m12 t = u` and `m12 p + m22 t = v`.
struct NormalEquations {
    m11: f64,
    m12: f64,
    m22: f64,
    u: f64,
    v: f64,
    /// 1 over the determinant.
    inverse: f64,
    /// 1 / `m11`.
    inverse11: f64,
    /// 1 / `m22`.
    inverse22: f64,
}

impl NormalEquations {
    /// Returns the position on the edge and that on the segment, each kept within -1..1, and the point of the edge.
    #[inline(always)]
    fn solve(&self, quirks: &Quirks) -> (f64, f64, EdgePoint) {
        let Self {
            m11,
            m12,
            m22,
            u,
            v,
            inverse,
            inverse11,
            inverse22,
        } = *self;
        let mut position = (m22 * u - m12 * v) * inverse;
        let mut t = (m11 * v - m12 * u) * inverse;
        let mut at = EdgePoint::Middle;
        if position > 1.0 {
            (position, at) = (1.0, EdgePoint::Upper);
            t = (v - m12) * inverse22;
        } else if position < -1.0 {
            (position, at) = (-1.0, EdgePoint::Lower);
            t = (v + m12) * inverse22;
        }
        if t.abs() > 1.0 {
            t = if t > 1.0 { 1.0 } else { -1.0 };
            // the end of the segment in place of the point beyond it: the nearest point of the edge moves with it
            position = (u - t * m12) * inverse11;
            if position > 1.0 {
                (position, at) = (1.0, EdgePoint::Upper);
            } else if position < -1.0 {
                (position, at) = (-1.0, EdgePoint::Lower);
            } else if !quirks.stale_box_corner {
                at = EdgePoint::Middle;
            }
        }
        (position, t, at)
    }
}

impl LocalSegment {
    /// Tests the ends of the segment over a face or inside the box.
    fn search_ends(&self, nearest: &mut NearestPoint) {
        for t in [-1.0, 1.0] {
            let end = add_scaled(self.centre, self.half, t);
            let mut clamped = end;
            let mut count = 0;
            let mut axis = None;
            for k in 0..3 {
                if end[k] < -self.size[k] {
                    clamped[k] = -self.size[k];
                } else if end[k] > self.size[k] {
                    clamped[k] = self.size[k];
                } else {
                    continue;
                }
                count += 1;
                axis = Some(k);
            }
            // nearest to an edge or a corner, which the edges find
            if count > 1 {
                continue;
            }
            let away = sub(clamped, end);
            let distance2 = dot(away, away);
            if distance2 < nearest.distance2 {
                *nearest = NearestPoint {
                    distance2,
                    t,
                    feature: Some(BoxFeature::Face { axis }),
                };
            }
        }
    }

    /// Returns the offsets from the capsule's centre to the sides of the box in the negative directions.
    #[inline(always)]
    fn to_lower_sides(&self) -> Vec3 {
        sub(scale(self.size, -1.0), self.centre)
    }

    /// Returns the offsets from the capsule's centre to the sides of the box in the positive directions.
    #[inline(always)]
    fn to_upper_sides(&self) -> Vec3 {
        sub(self.size, self.centre)
    }

    /// Searches the four edges along an axis: nearest points of two segments each.
    ///
    /// The axis is a constant so that no vector is indexed by a variable, which would keep it out of registers.
    #[inline(always)]
    fn search_edges<const AXIS: usize>(&self, nearest: &mut NearestPoint, quirks: &Quirks) {
        let (s, h) = (self.size, self.half);

        // parts of the normal equations that the four edges share
        let (m11, m12, m22) = (
            s[AXIS] * s[AXIS],
            -s[AXIS] * h[AXIS],
            self.half_length * self.half_length,
        );
        // no determinant for a segment along the edge: its ends, over faces or across other edges, are as near
        let det = m11 * m22 - m12 * m12;
        if det.abs() < MINVAL {
            return;
        }
        let (inverse, inverse11, inverse22) = (1.0 / det, 1.0 / m11, 1.0 / m22);
        let (low, high) = if AXIS == 0 { (1, 2) } else { (0, 3 - AXIS) };
        let (l, r) = (self.to_lower_sides(), self.to_upper_sides());
        for (up_low, up_high) in [(false, false), (true, false), (false, true), (true, true)] {
            let corner = (up_low as usize) << low | (up_high as usize) << high;
            let mut between = [0.0; 3]; // from the capsule's centre to the middle of the edge
            between[AXIS] = 0.0 - self.centre[AXIS];
            between[low] = if up_low { r[low] } else { l[low] };
            between[high] = if up_high { r[high] } else { l[high] };
            let (u, v) = (-s[AXIS] * between[AXIS], dot(h, between));

            let equations = NormalEquations {
                m12,
                m22,
                u,
                v,
                inverse,
                inverse11,
                inverse22,
                m11,
            };
            let (position, t, at) = equations.solve(quirks);
            let mut away = add_scaled(between, h, -t);
            away[AXIS] += s[AXIS] * position;
            let distance2 = dot(away, away);
            // a corner belongs to three edges: the first to find it keeps it, and rounding does not hand it on
            if distance2 < nearest.distance2 - MINVAL {
                nearest.distance2 = distance2;
                nearest.t = t;
                nearest.feature = Some(match at {
                    EdgePoint::Lower => BoxFeature::Corner { corner },
                    EdgePoint::Upper => BoxFeature::Corner {
                        corner: corner | 1 << AXIS,
                    },
                    EdgePoint::Middle => BoxFeature::Edge {
                        axis: AXIS,
                        corner,
                        position,
                    },
                });
            }
        }
    }

    /// Returns the length of t after which the segment has crossed the box along axis `k`.
    fn crossing(&self, k: usize) -> f64 {
        2.0 * self.size[k] / self.half[k].abs()
    }

    /// Returns how far in t a second contact lies from the first, which was found at `t`.
    fn second_contact(&self, t: f64, feature: BoxFeature) -> Option<f64> {
        match feature {
            BoxFeature::Corner { corner } => self.second_from_corner(t, corner),
            BoxFeature::Edge { axis, corner, position } => self.second_from_edge(t, axis, corner, position),
            BoxFeature::Face { axis } => Some(self.second_from_face(t, axis?)),
        }
    }

    fn second_from_corner(&self, t: f64, corner: usize) -> Option<f64> {
        // axes along which the segment leads from the corner over the box in one direction, against the others
        let (single, sign) = match self.rising ^ corner {
            // no axis differs from the other two, so there is no face or edge that the segment runs along
            0 | 7 => return None,
            axes if axes.count_ones() == 1 => (axes, 1.0),
            axes => (7 - axes, -1.0),
        };
        let k = single.trailing_zeros() as usize;
        let (ahead, behind) = (1.0 - sign * t, 1.0 + sign * t);
        Some(if self.axis[k] * self.axis[k] > 0.5 {
            sign * ahead.min(self.crossing(k))
        } else {
            -sign * behind.min(self.crossing((k + 1) % 3)).min(self.crossing((k + 2) % 3))
        })
    }

    fn second_from_edge(&self, t: f64, axis: usize, corner: usize, position: f64) -> Option<f64> {
        // over the box along one of the two axes across the edge and off it along the other: the segment leans on both
        // faces or on neither
        let across = (self.rising ^ corner) & !(1 << axis);
        if across.count_ones() != 1 {
            return None;
        }
        // of the two axes across the edge the one that the segment follows most: over that face the second contact lies
        let (k1, k2) = ((axis + 1) % 3, (axis + 2) % 3);
        let main = if self.axis[k1].abs() > self.axis[k2].abs() {
            k1
        } else {
            k2
        };
        let forward = across >> main & 1 == 1;
        let sign = if forward { 1.0 } else { -1.0 };
        let upward = (self.rising >> axis & 1 == 1) == forward;
        let rest = if upward { 1.0 - position } else { 1.0 + position };
        let off_edge = self.size[axis] * rest / self.half[axis].abs();
        Some(sign * (1.0 - sign * t).min(self.crossing(main)).min(off_edge))
    }

    /// Returns the step in t from one end over a face to where the segment leaves it, or to the other end.
    fn second_from_face(&self, t: f64, axis: usize) -> f64 {
        let sign = -t;
        let end = add_scaled(self.centre, self.half, t);
        let mut step = 2.0;
        for k in (0..3).filter(|&k| k != axis) {
            for side in [self.size[k], -self.size[k]] {
                let way = (side - end[k]) / self.half[k] * sign;
                if way > 0.0 && way < step {
                    step = way;
                }
            }
        }
        sign * step
    }
}
