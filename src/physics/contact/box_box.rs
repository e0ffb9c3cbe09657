//! Box with box: the axis of least overlap, the points where the boxes meet across it, and their clean-up.

use super::box_edge::edge_points;
use super::box_face::face_points;
use super::{ContactPoint, Placed, Quirks, dot, frame, sub};
use crate::math::{MINVAL, Mat3, Vec3, mat_mul, mat_t_vec, mat_vec, row, transpose, unit};

/// Greatest number of points of one pair: 16 crossings of edges with sides and 8 corners.
pub(super) const MAX_POINTS: usize = 24;

/// A point where two boxes meet, before the clean-up.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxPoint {
    pub(super) dist: f64,
    pub(super) pos: Vec3,
}

/// Pose of two boxes relative to each other.
pub(super) struct Relative {
    /// Columns: axes of the second box in the frame of the first.
    pub(super) rot: Mat3,
    /// Rows: axes of the second box in the frame of the first.
    pub(super) rot_t: Mat3,
    /// Absolute values of `rot`.
    pub(super) abs: Mat3,
    /// Centre of the second box in the frame of the first.
    pub(super) second_from_first: Vec3,
    /// Centre of the first box in the frame of the second.
    pub(super) first_from_second: Vec3,
}

impl Relative {
    fn new(a: &Placed, b: &Placed) -> Self {
        let rot = mat_mul(&transpose(a.mat), b.mat);
        Relative {
            rot,
            rot_t: transpose(&rot),
            abs: rot.map(f64::abs),
            second_from_first: mat_t_vec(a.mat, sub(b.pos, a.pos)),
            first_from_second: mat_t_vec(b.mat, sub(a.pos, b.pos)),
        }
    }
}

/// A face of a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) axis: usize,
    pub(super) negative: bool,
}

/// Two edges that cross.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgePair {
    /// Axis of the first box along its edge.
    pub(super) first: usize,
    /// Axis of the second box along its edge.
    pub(super) second: usize,
    /// Unit normal in the frame of the first box.
    pub(super) normal: Vec3,
    /// Whether the normal points from the second box to the first.
    pub(super) reversed: bool,
    /// Sides of the first box the edge is on; bit k is set on the positive side of axis k.
    pub(super) first_sides: usize,
    /// Sides of the second box the edge is on.
    pub(super) second_sides: usize,
}

/// The axis along which two boxes overlap least.
enum LeastAxis {
    FirstFace(Face),
    SecondFace(Face),
    Edges(EdgePair),
}

/// Two boxes: contacts after the clean-up.
pub(super) fn box_box(
    a: &Placed,
    b: &Placed,
    margin: f64,
    quirks: &Quirks,
    points: &mut Vec<BoxPoint>,
    out: &mut Vec<ContactPoint>,
) {
    let relative = Relative::new(a, b);
    let Some(axis) = least_axis(a.size, b.size, &relative, margin) else {
        return;
    };
    points.clear();
    let normal = match axis {
        LeastAxis::FirstFace(face) => face_points(a, b, &relative, face, false, margin, quirks, points),
        LeastAxis::SecondFace(face) => face_points(b, a, &relative, face, true, margin, quirks, points),
        LeastAxis::Edges(edges) => edge_points(a, b, &relative, &edges, margin, quirks, points),
    };
    let (bounds_a, bounds_b) = (Bounds::new(a, margin), Bounds::new(b, margin));
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

/// Tests the 15 axes. `None` if one keeps the boxes apart.
fn least_axis(size1: Vec3, size2: Vec3, relative: &Relative, margin: f64) -> Option<LeastAxis> {
    let (rot, abs) = (&relative.rot, &relative.abs);
    let (p21, p12) = (relative.second_from_first, relative.first_from_second);
    let extent2 = mat_vec(abs, size2);
    let extent1 = mat_t_vec(abs, size1);

    let mut least = margin;
    for k in 0..3 {
        least += size1[k] * 3.0 + size2[k] * 3.0;
    }
    let mut best = None;

    // faces of either box
    for axis in 0..3 {
        let overlap1 = -p21[axis].abs() + size1[axis] + extent2[axis];
        let overlap2 = -p12[axis].abs() + size2[axis] + extent1[axis];
        if overlap1 < -margin || overlap2 < -margin {
            return None;
        }
        if overlap1 < least {
            least = overlap1;
            let negative = p21[axis] < 0.0;
            best = Some(LeastAxis::FirstFace(Face { axis, negative }));
        }
        if overlap2 < least {
            least = overlap2;
            let negative = p12[axis] < 0.0;
            best = Some(LeastAxis::SecondFace(Face { axis, negative }));
        }
    }

    // an edge of one across an edge of the other; a little behind where it is no better than a face
    for first in 0..3 {
        for second in 0..3 {
            let w = row(&relative.rot_t, second);
            let across = match first {
                0 => [0.0, -w[2], w[1]],
                1 => [w[2], 0.0, -w[0]],
                _ => [-w[1], w[0], 0.0],
            };
            let (normal, length) = unit(across);
            if length < MINVAL {
                continue;
            }
            let distance = dot(p21, normal);
            let mut overlap = 0.0;
            for k in (0..3).filter(|&k| k != first) {
                overlap += size1[k] * normal[k].abs();
            }
            for k in (0..3).filter(|&k| k != second) {
                overlap += size2[k] * abs[3 * first + 3 - k - second] / length;
            }
            overlap -= distance.abs();
            if overlap < -margin {
                return None;
            }
            if overlap < least * (1.0 - 1e-12) {
                least = overlap;
                let reversed = distance < 0.0;
                let (mut first_sides, mut second_sides) = (0, 0);
                for k in 0..3 {
                    if k != first && ((normal[k] > 0.0) ^ reversed) {
                        first_sides |= 1 << k;
                    }
                    if k != second {
                        let rises = rot[3 * first + 3 - k - second] > 0.0;
                        if rises ^ reversed ^ ((k + 3 - second) % 3 == 1) {
                            second_sides |= 1 << k;
                        }
                    }
                }
                best = Some(LeastAxis::Edges(EdgePair {
                    first,
                    second,
                    normal,
                    reversed,
                    first_sides,
                    second_sides,
                }));
            }
        }
    }
    best
}

/// A box frame turned such that one face of the box is at +z: for each new axis the old one and its sign.
pub(super) struct Turned([(usize, f64); 3]);

impl Turned {
    /// The frame that belongs to a face.
    pub(super) fn to(face: Face) -> Turned {
        Turned(match (face.axis, face.negative) {
            (0, false) => [(2, -1.0), (1, 1.0), (0, 1.0)],
            (1, false) => [(0, 1.0), (2, -1.0), (1, 1.0)],
            (_, false) => [(0, 1.0), (1, 1.0), (2, 1.0)],
            (0, true) => [(2, 1.0), (1, 1.0), (0, -1.0)],
            (1, true) => [(0, 1.0), (2, 1.0), (1, -1.0)],
            (_, true) => [(0, -1.0), (1, 1.0), (2, -1.0)],
        })
    }

    /// A vector of the box frame in the turned one.
    #[inline(always)]
    pub(super) fn vector(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.0;
        [v[x.0] * x.1, v[y.0] * y.1, v[z.0] * z.1]
    }

    /// Half sizes in the turned frame.
    #[inline(always)]
    pub(super) fn sizes(&self, size: Vec3) -> Vec3 {
        let [x, y, z] = self.vector(size);
        [x.abs(), y.abs(), z.abs()]
    }

    /// Orientation of the turned frame, given that of the box.
    #[inline(always)]
    pub(super) fn orientation(&self, mat: &Mat3) -> Mat3 {
        let mut turned = [0.0; 9];
        for i in 0..3 {
            for (k, (source, sign)) in self.0.into_iter().enumerate() {
                turned[3 * i + k] = mat[3 * i + source] * sign;
            }
        }
        turned
    }
}

/// Crossing of an edge with a side of the face rectangle.
pub(super) struct Crossing {
    /// Coordinate that is constant on the side: 0 or 1.
    pub(super) axis: usize,
    /// Its value there.
    pub(super) side: f64,
    /// Place on the edge, 0..1.
    pub(super) t: f64,
    /// The other coordinate of the crossing.
    pub(super) other: f64,
}

/// Crossings of the edge from `start` along `dir` with the sides of the rectangle of half sizes `size`: -x, +x, -y, +y.
#[inline(always)]
pub(super) fn crossings(start: Vec3, dir: Vec3, size: &Vec3, mut found: impl FnMut(Crossing)) {
    for axis in 0..2 {
        if dir[axis].abs() > MINVAL {
            let inverse = 1.0 / dir[axis];
            for sign in [-1.0, 1.0] {
                let side = size[axis] * sign;
                let t = (side - start[axis]) * inverse;
                if !(0.0..=1.0).contains(&t) {
                    continue;
                }
                let other = start[1 - axis] + dir[1 - axis] * t;
                if other.abs() > size[1 - axis] {
                    continue;
                }
                found(Crossing { axis, side, t, other });
            }
        }
    }
}

/// Corners of the face rectangle in MuJoCo's order.
#[inline(always)]
pub(super) fn rectangle(size: &Vec3) -> [[f64; 2]; 4] {
    let [x, y, _] = *size;
    [[-x, -y], [-x, y], [x, -y], [x, y]]
}

/// What counts as clearly outside and clearly inside a box.
struct Bounds<'a> {
    pos: Vec3,
    mat: &'a Mat3,
    outer: Vec3,
    inner: Vec3,
}

impl<'a> Bounds<'a> {
    fn new(geom: &Placed<'a>, margin: f64) -> Self {
        let size = geom.size.map(|s| s + margin);
        Bounds {
            pos: geom.pos,
            mat: geom.mat,
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

/// Whether a point is clearly outside one box without being clearly inside the other.
#[inline(always)]
fn strays(point: Vec3, a: &Bounds, b: &Bounds) -> bool {
    let (in_a, in_b) = (a.local(point), b.local(point));
    (a.is_outside(in_a) && !b.is_inside(in_b)) || (b.is_outside(in_b) && !a.is_inside(in_a))
}
