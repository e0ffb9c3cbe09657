//! Frames of two boxes: their relative pose, their faces and edges, and what crosses the rectangle of a face.

use super::{PlacedGeom, sub};
use crate::math::{MINVAL, Mat3, Vec3, mat_mul, mat_t_vec, transpose};

/// A point where two boxes meet, before the clean-up.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxPoint {
    pub(super) dist: f64,
    pub(super) pos: Vec3,
}

/// The pose of two boxes relative to each other.
pub(super) struct RelativePose {
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

impl RelativePose {
    pub(super) fn new(a: &PlacedGeom, b: &PlacedGeom) -> Self {
        let rot = mat_mul(&transpose(a.mat), b.mat);
        RelativePose {
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
pub(super) struct BoxFace {
    pub(super) axis: usize,
    pub(super) negative: bool,
}

/// A pair of edges that cross, one of each box.
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
    /// Sides of the first box on which the edge lies; bit k is set on the positive side of axis k.
    pub(super) first_sides: usize,
    /// Sides of the second box on which the edge lies.
    pub(super) second_sides: usize,
}

/// The frame of a box with its axes permuted and reflected such that one face is at +z.
pub(super) struct FaceFrame {
    /// Axis of the box along each axis of the frame.
    axis: [usize; 3],
    /// Sign of that axis.
    sign: Vec3,
}

impl FaceFrame {
    /// Returns the frame in which a face is at +z.
    pub(super) fn new(face: BoxFace) -> Self {
        let (axis, sign) = match (face.axis, face.negative) {
            (0, false) => ([2, 1, 0], [-1.0, 1.0, 1.0]),
            (1, false) => ([0, 2, 1], [1.0, -1.0, 1.0]),
            (_, false) => ([0, 1, 2], [1.0, 1.0, 1.0]),
            (0, true) => ([2, 1, 0], [1.0, 1.0, -1.0]),
            (1, true) => ([0, 2, 1], [1.0, 1.0, -1.0]),
            (_, true) => ([0, 1, 2], [-1.0, 1.0, -1.0]),
        };
        Self { axis, sign }
    }

    /// Rotates a vector from the box frame to the face frame.
    #[inline(always)]
    pub(super) fn vector(&self, v: Vec3) -> Vec3 {
        [0, 1, 2].map(|k| v[self.axis[k]] * self.sign[k])
    }

    /// Returns the half sizes in the face frame.
    #[inline(always)]
    pub(super) fn sizes(&self, size: Vec3) -> Vec3 {
        self.vector(size).map(f64::abs)
    }

    /// Returns the orientation of the face frame, given that of the box.
    #[inline(always)]
    pub(super) fn orientation(&self, mat: &Mat3) -> Mat3 {
        let mut rotated = [0.0; 9];
        for i in 0..3 {
            for k in 0..3 {
                rotated[3 * i + k] = mat[3 * i + self.axis[k]] * self.sign[k];
            }
        }
        rotated
    }
}

/// The crossing of an edge with a side of the face rectangle.
pub(super) struct Crossing {
    /// Coordinate that is constant on the side: 0 or 1.
    pub(super) axis: usize,
    /// Value of that coordinate on the side.
    pub(super) side: f64,
    /// Position on the edge, 0..1.
    pub(super) t: f64,
    /// The other coordinate of the crossing.
    pub(super) other: f64,
}

/// Passes the crossings of the edge from `start` along `dir` with the sides of the rectangle of half sizes `size` to
/// `found`: -x, +x, -y, +y.
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

/// Returns the corners of the face rectangle in MuJoCo's order.
#[inline(always)]
pub(super) fn rectangle(size: &Vec3) -> [[f64; 2]; 4] {
    let [x, y, _] = *size;
    [[-x, -y], [-x, y], [x, -y], [x, y]]
}
