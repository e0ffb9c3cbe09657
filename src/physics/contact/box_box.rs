//! Boxes with boxes: the axis of least overlap, the points where the boxes meet across it, and their clean-up.

use super::box_edge::edge_points;
use super::box_face::face_points;
use super::box_frame::{BoxFace, BoxPoint, EdgePair, RelativePose};
use super::{ContactPoint, PlacedGeom, Quirks, dot, frame, sub};
use crate::math::{MINVAL, Mat3, Vec3, mat_t_vec, mat_vec, row, unit};

/// Greatest number of points of one pair: 16 crossings of edges with sides and 8 corners.
pub(super) const MAX_POINTS: usize = 24;

/// The axis along which two boxes overlap least.
enum LeastAxis {
    FirstFace(BoxFace),
    SecondFace(BoxFace),
    Edges(EdgePair),
}

/// Finds the contacts of two boxes, after the clean-up.
pub(super) fn box_box(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    quirks: &Quirks,
    points: &mut Vec<BoxPoint>,
    out: &mut Vec<ContactPoint>,
) {
    let relative = RelativePose::new(a, b);
    let Some(axis) = least_axis(a.size, b.size, &relative, margin) else {
        return;
    };
    points.clear();
    let normal = match axis {
        LeastAxis::FirstFace(face) => face_points(a, b, &relative, face, false, margin, quirks, points),
        LeastAxis::SecondFace(face) => face_points(b, a, &relative, face, true, margin, quirks, points),
        LeastAxis::Edges(edges) => edge_points(a, b, &relative, &edges, margin, quirks, points),
    };
    let (bounds_a, bounds_b) = (BoxBounds::new(a, margin), BoxBounds::new(b, margin));
    points.retain(|point| !strays(point.pos, &bounds_a, &bounds_b));
    if points.is_empty() {
        return;
    }

    // of points at the same position the last one stays
    let frame = frame::from_normal(normal);
    for (k, point) in points.iter().enumerate() {
        if !points[k + 1..].iter().any(|later| later.pos == point.pos) {
            let BoxPoint { dist, pos } = *point;
            out.push(ContactPoint { dist, pos, frame });
        }
    }
}

/// Finds the axis of least overlap among the 15 that can separate two boxes; `None` if one keeps them apart.
fn least_axis(size1: Vec3, size2: Vec3, relative: &RelativePose, margin: f64) -> Option<LeastAxis> {
    let mut least = margin;
    for k in 0..3 {
        // more than any overlap can be, so that the first axis is always an improvement
        least += size1[k] * 3.0 + size2[k] * 3.0;
    }
    let mut search = AxisSearch {
        size1,
        size2,
        relative,
        margin,
        least,
        best: None,
    };
    search.faces()?;
    search.edges()?;
    search.best
}

/// The search for the axis of least overlap.
struct AxisSearch<'a> {
    size1: Vec3,
    size2: Vec3,
    relative: &'a RelativePose,
    margin: f64,
    /// Least overlap so far, m.
    least: f64,
    best: Option<LeastAxis>,
}

impl AxisSearch<'_> {
    /// Tests the faces of either box; `None` if one keeps the boxes apart.
    #[inline(always)]
    fn faces(&mut self) -> Option<()> {
        let (p21, p12) = (self.relative.second_from_first, self.relative.first_from_second);
        let extent2 = mat_vec(&self.relative.abs, self.size2);
        let extent1 = mat_t_vec(&self.relative.abs, self.size1);
        for axis in 0..3 {
            let overlap1 = -p21[axis].abs() + self.size1[axis] + extent2[axis];
            let overlap2 = -p12[axis].abs() + self.size2[axis] + extent1[axis];
            if overlap1 < -self.margin || overlap2 < -self.margin {
                return None;
            }
            if overlap1 < self.least {
                self.least = overlap1;
                let negative = p21[axis] < 0.0;
                self.best = Some(LeastAxis::FirstFace(BoxFace { axis, negative }));
            }
            if overlap2 < self.least {
                self.least = overlap2;
                let negative = p12[axis] < 0.0;
                self.best = Some(LeastAxis::SecondFace(BoxFace { axis, negative }));
            }
        }
        Some(())
    }

    /// Tests the edges of one box across those of the other, with a small penalty, so that they replace a face only if they are clearly better;
    /// `None` if a pair separates the boxes.
    #[inline(always)]
    fn edges(&mut self) -> Option<()> {
        let p21 = self.relative.second_from_first;
        for first in 0..3 {
            for second in 0..3 {
                let w = row(&self.relative.rot_t, second);
                let across = match first {
                    0 => [0.0, -w[2], w[1]],
                    1 => [w[2], 0.0, -w[0]],
                    _ => [-w[1], w[0], 0.0],
                };
                let (normal, length) = unit(across);
                // parallel edges have no axis across them; the faces have tested it already
                if length < MINVAL {
                    continue;
                }
                let distance = dot(p21, normal);
                let mut overlap = 0.0;
                for k in (0..3).filter(|&k| k != first) {
                    overlap += self.size1[k] * normal[k].abs();
                }
                // the axis is first x second / length, so second's axis k is along it as much as `first` is along the
                // third axis, over the length (a triple product)
                for k in (0..3).filter(|&k| k != second) {
                    overlap += self.size2[k] * self.relative.abs[3 * first + 3 - k - second] / length;
                }
                overlap -= distance.abs();
                if overlap < -self.margin {
                    return None;
                }
                // where an edge axis is a face axis up to rounding, the face wins: its points lie all around the area
                // of contact, those of edges near one corner of it
                if overlap < self.least * (1.0 - 1e-12) {
                    self.least = overlap;
                    let reversed = distance < 0.0;
                    self.best = Some(LeastAxis::Edges(self.edge_pair(first, second, normal, reversed)));
                }
            }
        }
        Some(())
    }

    /// Returns the edges of the two boxes that are nearest to each other along a normal.
    #[inline(always)]
    fn edge_pair(&self, first: usize, second: usize, normal: Vec3, reversed: bool) -> EdgePair {
        let (mut first_sides, mut second_sides) = (0, 0);
        for k in 0..3 {
            if k != first && ((normal[k] > 0.0) ^ reversed) {
                first_sides |= 1 << k;
            }
            if k != second {
                let rises = self.relative.rot[3 * first + 3 - k - second] > 0.0;
                // the same triple product, with its sign
                if rises ^ reversed ^ ((k + 3 - second) % 3 == 1) {
                    second_sides |= 1 << k;
                }
            }
        }
        EdgePair {
            first,
            second,
            normal,
            reversed,
            first_sides,
            second_sides,
        }
    }
}

/// The margins of clearly outside and clearly inside a box.
struct BoxBounds<'a> {
    pos: Vec3,
    mat: &'a Mat3,
    outer: Vec3,
    inner: Vec3,
}

impl<'a> BoxBounds<'a> {
    fn new(geom: &PlacedGeom<'a>, margin: f64) -> Self {
        let size = geom.size.map(|s| s + margin);
        BoxBounds {
            pos: geom.pos,
            mat: geom.mat,
            // one per cent either way keeps rounding at a surface from deciding
            outer: size.map(|s| s * 1.01),
            inner: size.map(|s| s / 1.01),
        }
    }

    #[inline(always)]
    fn local(&self, point: Vec3) -> Vec3 {
        mat_t_vec(self.mat, sub(point, self.pos))
    }

    #[inline(always)]
    fn is_outside(&self, local: Vec3) -> bool {
        (0..3).any(|k| local[k] > self.outer[k] || local[k] < -self.outer[k])
    }

    #[inline(always)]
    fn is_inside(&self, local: Vec3) -> bool {
        (0..3).all(|k| local[k] < self.inner[k] && local[k] > -self.inner[k])
    }
}

/// Returns whether a point is clearly outside one box without being clearly inside the other.
#[inline(always)]
fn strays(point: Vec3, a: &BoxBounds, b: &BoxBounds) -> bool {
    let (in_a, in_b) = (a.local(point), b.local(point));
    // the construction extends edges and faces beyond the boxes; a point that belongs to neither is its artefact
    (a.is_outside(in_a) && !b.is_inside(in_b)) || (b.is_outside(in_b) && !a.is_inside(in_a))
}
