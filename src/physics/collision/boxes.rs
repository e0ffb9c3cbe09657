//! Boxes around geoms: along the axes of the world, for the sweep, and along those of a geom or body.

use crate::math::{Mat3, Vec3, add, column, dot, mat_vec, sub};
use crate::model::GeomType;

/// Returns a world box that contains everything nearer to a geom than `slack` (m), from its size and the box around it in its frame, which only
/// meshes and height fields need. A plane fills the half space behind it.
#[inline(always)]
pub(super) fn world(
    kind: GeomType,
    (size, own): (Vec3, &[f64; 6]),
    mut pos: Vec3,
    mat: &Mat3,
    slack: f64,
) -> [Vec3; 2] {
    let turned = |half: Vec3| -> Vec3 {
        std::array::from_fn(|k| {
            mat[3 * k].abs() * half[0] + mat[3 * k + 1].abs() * half[1] + mat[3 * k + 2].abs() * half[2]
        })
    };
    let grown = |half: Vec3| half.map(|h| h + slack);
    let half: Vec3 = match kind {
        GeomType::Plane => {
            let mut high = [f64::INFINITY; 3];
            if mat[2] == 0.0 && mat[5] == 0.0 && mat[8] > 0.0 {
                high[2] = pos[2] + slack;
            }
            return [[f64::NEG_INFINITY; 3], high];
        }
        GeomType::Sphere => grown([size[0]; 3]),
        GeomType::Capsule => grown(std::array::from_fn(|k| size[0] + mat[3 * k + 2].abs() * size[1])),
        GeomType::Cylinder => grown(std::array::from_fn(|k| {
            let a = mat[3 * k + 2];
            a.abs() * size[1] + size[0] * (1.0 - a * a).max(0.0).sqrt()
        })),
        GeomType::HField | GeomType::Mesh => {
            pos = add(pos, mat_vec(mat, [own[0], own[1], own[2]]));
            grown(turned([own[3], own[4], own[5]]))
        }
        // the routine for two boxes takes them for within the margin as long as no face and no pair of edges has it between them, which holds
        // where one reaches into the other with all faces moved out by it: at corners that is farther
        GeomType::Box => turned(grown(size)),
        GeomType::Ellipsoid => grown(turned(size)),
    };
    [
        std::array::from_fn(|k| pos[k] - half[k]),
        std::array::from_fn(|k| pos[k] + half[k]),
    ]
}

/// Half size from which a box counts as infinite in a direction (MuJoCo's `mjMAXVAL`), m.
const ENDLESS: f64 = 1e10;

/// A box along given axes: its centre, its half sizes and its axes, the columns of the matrix.
#[derive(Clone, Copy)]
pub(super) struct OrientedBox<'a> {
    centre: Vec3,
    half: Vec3,
    mat: &'a Mat3,
}

impl<'a> OrientedBox<'a> {
    /// Places a box, given by its centre and half sizes, in a frame.
    pub(super) fn placed(own: &[f64; 6], pos: Vec3, mat: &'a Mat3) -> Self {
        Self {
            centre: add(pos, mat_vec(mat, [own[0], own[1], own[2]])),
            half: [own[3], own[4], own[5]],
            mat,
        }
    }

    /// Returns half the length of its projection onto the direction `axis`.
    fn reach(&self, axis: Vec3) -> f64 {
        (0..3)
            .map(|k| dot(axis, column(self.mat, k)).abs() * self.half[k])
            .sum()
    }

    /// Returns whether one of its faces is further than `margin` (m) from another box beyond that face.
    fn clears(&self, other: &OrientedBox, margin: f64) -> bool {
        let between = sub(other.centre, self.centre);
        (0..3).any(|k| {
            let axis = column(self.mat, k);
            dot(axis, between).abs() > self.half[k] + other.reach(axis) + margin
        })
    }

    /// Returns whether a face of one of two boxes is further from the other than `margin` (m), as MuJoCo does, which skips boxes that are infinite
    /// in some direction.
    #[doc(alias = "mj_collideOBB")]
    pub(super) fn apart(&self, other: &OrientedBox, margin: f64) -> bool {
        let endless = |half: &f64| *half >= ENDLESS;
        let ends = |part: &OrientedBox| !part.half.iter().any(endless);
        let all = |part: &OrientedBox| part.half.iter().all(endless);
        if all(self) || all(other) {
            return false;
        }
        ends(other) && self.clears(other, margin) || ends(self) && other.clears(self, margin)
    }
}
