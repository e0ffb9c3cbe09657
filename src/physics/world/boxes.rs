//! Boxes around geoms: along the axes of the world, for the sweep, and along those of a geom.

use super::Pair;
use crate::math::{Mat3, Vec3, add, column, dot, mat_vec, sub};
use crate::model::{GeomType, Model};
use crate::physics::contact::PlacedGeom;
use crate::physics::state::State;

/// Returns the world box of a geom, enlarged by `slack` (m), from its size and the box around it in its frame, which only meshes
/// and height fields need. A plane fills the half space behind it.
#[inline(always)]
pub(super) fn world(
    kind: GeomType,
    (size, own): (Vec3, &[f64; 6]),
    mut pos: Vec3,
    mat: &Mat3,
    slack: f64,
) -> [Vec3; 2] {
    let half: Vec3 = match kind {
        GeomType::Plane => {
            let mut high = [f64::INFINITY; 3];
            if mat[2] == 0.0 && mat[5] == 0.0 && mat[8] > 0.0 {
                high[2] = pos[2] + slack;
            }
            return [[f64::NEG_INFINITY; 3], high];
        }
        GeomType::Sphere => [size[0]; 3],
        GeomType::Capsule => std::array::from_fn(|k| size[0] + mat[3 * k + 2].abs() * size[1]),
        GeomType::Cylinder => std::array::from_fn(|k| {
            let a = mat[3 * k + 2];
            a.abs() * size[1] + size[0] * (1.0 - a * a).max(0.0).sqrt()
        }),
        GeomType::HField | GeomType::Mesh => {
            pos = add(pos, mat_vec(mat, [own[0], own[1], own[2]]));
            std::array::from_fn(|k| {
                mat[3 * k].abs() * own[3] + mat[3 * k + 1].abs() * own[4] + mat[3 * k + 2].abs() * own[5]
            })
        }
        GeomType::Box | GeomType::Ellipsoid => std::array::from_fn(|k| {
            mat[3 * k].abs() * size[0] + mat[3 * k + 1].abs() * size[1] + mat[3 * k + 2].abs() * size[2]
        }),
    };
    [
        std::array::from_fn(|k| pos[k] - half[k] - slack),
        std::array::from_fn(|k| pos[k] + half[k] + slack),
    ]
}

/// A box around a geom: its centre, its half sizes and its axes, the columns of the matrix.
#[derive(Clone, Copy)]
struct Oriented<'a> {
    centre: Vec3,
    half: Vec3,
    mat: &'a Mat3,
}

impl<'a> Oriented<'a> {
    /// Returns the box along the axes of the geom.
    fn of(geom: &PlacedGeom<'a>, own: &[f64; 6]) -> Self {
        let size = geom.size;
        let (mut centre, mat) = (geom.pos, geom.mat);
        let half = match geom.kind {
            GeomType::Plane => [f64::INFINITY; 3],
            GeomType::Sphere => [size[0]; 3],
            GeomType::Capsule => [size[0], size[0], size[0] + size[1]],
            GeomType::Cylinder => [size[0], size[0], size[1]],
            GeomType::Box | GeomType::Ellipsoid => size,
            GeomType::HField | GeomType::Mesh => {
                centre = add(centre, mat_vec(mat, [own[0], own[1], own[2]]));
                [own[3], own[4], own[5]]
            }
        };
        Self { centre, half, mat }
    }

    /// Returns half of the length of its shadow on a line in the direction `axis`.
    fn reach(&self, axis: Vec3) -> f64 {
        (0..3)
            .map(|k| dot(axis, column(self.mat, k)).abs() * self.half[k])
            .sum()
    }

    /// Returns the box around this one along other axes.
    fn along<'b>(&self, mat: &'b Mat3) -> Oriented<'b> {
        Oriented {
            centre: self.centre,
            half: std::array::from_fn(|k| self.reach(column(mat, k))),
            mat,
        }
    }

    /// Tells whether one of its faces is further from another box than `margin` (m), which is beyond it.
    fn clears(&self, other: &Oriented, margin: f64) -> bool {
        let between = sub(other.centre, self.centre);
        (0..3).any(|k| {
            let axis = column(self.mat, k);
            dot(axis, between).abs() > self.half[k] + other.reach(axis) + margin
        })
    }
}

/// Tells whether a face of a box around one of two geoms lies between both boxes, further from the other than the margin: of the boxes along their
/// own axes, or of those along the axes of inertia of their bodies.
///
/// MuJoCo leaves such pairs out where one of the bodies has several geoms, before routines that may find a contact where there is a gap.
pub(super) fn apart(a: &PlacedGeom, b: &PlacedGeom, model: &Model, pair: &Pair, s: &State) -> bool {
    let [x, y] = pair.geom;
    let (first, second) = (
        Oriented::of(a, &model.geom_aabb[x]),
        Oriented::of(b, &model.geom_aabb[y]),
    );
    let clear = |a: Oriented, b: Oriented, margin| a.clears(&b, margin) || b.clears(&a, margin);
    let inertia = |g: usize| &s.ximat[model.geom_bodyid[g]];
    clear(first, second, pair.margin) || clear(first.along(inertia(x)), second.along(inertia(y)), pair.body_margin)
}
