//! Appends constraint rows: blocks, Jacobians, impedance.

use super::impedance::Impedance;
use super::{Block, ConeShape, ConstraintType, Efc, impedance};
use crate::math::*;
use crate::model::Model;
use crate::state::State;
use crate::tiles::Lanes;
use crate::topology::Topology;

/// Parameters shared by the rows of a block.
#[derive(Clone, Copy)]
pub(super) struct RowParameters {
    pub(super) solref: [f64; 2],
    pub(super) solimp: [f64; 5],
    /// Approximation of the diagonal of `J M^-1 J'`.
    pub(super) diag: f64,
}

/// Appends blocks and rows to the constraint rows of a step.
pub(super) struct RowAppender<'a> {
    pub(super) model: &'a Model,
    pub(super) topology: &'a Topology,
    /// Motion axes by tile.
    pub(super) axes: &'a [[Lanes; 6]],
    pub(super) efc: &'a mut Efc,
}

impl RowAppender<'_> {
    /// Starts a block without columns.
    #[inline(always)]
    pub(super) fn block(&mut self, kind: ConstraintType, id: usize, dim: usize) {
        let e = &mut *self.efc;
        e.blocks.push(Block {
            kind,
            id,
            row: e.pos.len(),
            dim,
            col: e.cols.len(),
            jac: e.jac.len(),
            ..Block::default()
        });
    }

    #[inline(always)]
    pub(super) fn block_mut(&mut self) -> &mut Block {
        let last = self.efc.blocks.len() - 1;
        &mut self.efc.blocks[last]
    }

    /// Sets the friction of the last block, which is a contact.
    #[inline(always)]
    pub(super) fn cone(&mut self, mu: f64, friction: [f64; 5]) {
        self.block_mut().cone = self.efc.cones.len() as u32;
        self.efc.cones.push(ConeShape { mu, friction });
    }

    /// Removes the last block, which has no rows yet.
    #[inline(always)]
    pub(super) fn drop_block(&mut self) {
        let e = &mut *self.efc;
        if let Some(b) = e.blocks.pop() {
            e.cols.truncate(b.col);
            e.jac.truncate(b.jac);
        }
    }

    /// Adds to the entry of a degree of freedom in the last block, whose dimension is 1. Degrees of freedom come
    /// ascending.
    #[inline(always)]
    pub(super) fn entry(&mut self, dof: usize, value: f64) {
        let slot = self.topology.slot[dof];
        let e = &mut *self.efc;
        let last = e.blocks.len() - 1;
        let b = &mut e.blocks[last];
        if b.ncol == 0 || e.cols.last() != Some(&(slot / 4)) {
            e.cols.push(slot / 4);
            e.jac.push([0.0; 4]);
            b.ncol += 1;
        }
        if let Some(lanes) = e.jac.last_mut() {
            lanes[slot as usize % 4] += value;
        }
    }

    /// Starts a block with one row on one degree of freedom.
    #[inline(always)]
    pub(super) fn single(&mut self, kind: ConstraintType, id: usize, dof: usize, value: f64) {
        self.block(kind, id, 1);
        self.entry(dof, value);
        self.block_mut().dof = Some(dof as u32);
    }

    /// Starts a block for the motion of a point of body `b` relative to a point of body `a`, over the tiles that move
    /// either; those that move both in the same way are left out. `rows` turns translation and rotation (three axes each) of a
    /// tile into rows.
    #[inline(always)]
    pub(super) fn relative(
        &mut self,
        (kind, id, dim): (ConstraintType, usize, usize),
        s: &State,
        (a, point_a): (usize, Vec3),
        (b, point_b): (usize, Vec3),
        mut rows: impl FnMut(&[Lanes; 3], &[Lanes; 3], &mut Vec<Lanes>),
    ) {
        self.block(kind, id, dim);
        let (model, topology) = (self.model, self.topology);
        let (mut tiles_a, mut tiles_b) = (topology.body_tiles(a), topology.body_tiles(b));
        // both points are in one tree, or one of them is in the world, whose centre is not used
        let com_a = s.subtree_com[model.body_rootid[a]];
        let com_b = s.subtree_com[model.body_rootid[b]];
        let (offset_a, offset_b) = (sub(point_a, com_a), sub(point_b, com_b));
        let mut ncol = 0;
        loop {
            let next = |tiles: &[(u32, u32)]| tiles.first().map_or((u32::MAX, 0), |t| *t);
            let ((tile_a, lanes_a), (tile_b, lanes_b)) = (next(tiles_a), next(tiles_b));
            let tile = tile_a.min(tile_b);
            if tile == u32::MAX {
                break;
            }
            let (mut translation, mut rotation) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
            let cdof = &self.axes[tile as usize];
            if tile_b == tile {
                tiles_b = &tiles_b[1..];
            }
            if tile_a == tile {
                tiles_a = &tiles_a[1..];
            }
            // the same joints move both points alike: their columns would cancel
            if tile_a == tile_b && lanes_a == lanes_b && point_a == point_b {
                continue;
            }
            if tile_b == tile {
                add_motion(cdof, lanes_b, offset_b, |v, w| v + w, &mut translation, &mut rotation);
            }
            if tile_a == tile {
                add_motion(cdof, lanes_a, offset_a, |v, w| v - w, &mut translation, &mut rotation);
            }
            self.efc.cols.push(tile);
            rows(&translation, &rotation, &mut self.efc.jac);
            ncol += 1;
        }
        self.block_mut().ncol = ncol;
    }

    /// Starts a block for the sum of the motions of a point of several bodies, each times a weight, over the tiles that move any of
    /// them. `rows` turns translation and rotation of a tile into rows.
    pub(super) fn weighted(
        &mut self,
        (kind, id, dim): (ConstraintType, usize, usize),
        s: &State,
        point: Vec3,
        bodies: &[(usize, f64)],
        mut rows: impl FnMut(&[Lanes; 3], &[Lanes; 3], &mut Vec<Lanes>),
    ) {
        self.block(kind, id, dim);
        let (model, topology) = (self.model, self.topology);
        let mut reached = 0;
        let mut ncol = 0;
        loop {
            let next = |&(b, _): &(usize, f64)| {
                let tiles = topology.body_tiles(b);
                tiles.get(tiles.partition_point(|t| t.0 < reached)).copied()
            };
            let Some(tile) = bodies.iter().filter_map(next).map(|(tile, _)| tile).min() else {
                break;
            };
            let (mut translation, mut rotation) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
            let cdof = &self.axes[tile as usize];
            for body in bodies {
                if let Some((_, lanes)) = next(body).filter(|next| next.0 == tile) {
                    let &(b, weight) = body;
                    let offset = sub(point, s.subtree_com[model.body_rootid[b]]);
                    let join = |v: f64, w: f64| v + weight * w;
                    add_motion(cdof, lanes, offset, join, &mut translation, &mut rotation);
                }
            }
            self.efc.cols.push(tile);
            rows(&translation, &rotation, &mut self.efc.jac);
            ncol += 1;
            reached = tile + 1;
        }
        self.block_mut().ncol = ncol;
    }

    /// Appends a row whose impedance follows from `violation` (the distance to the margin, or the norm of a weld's
    /// error). Returns its damping.
    #[inline(always)]
    pub(super) fn row(&mut self, pos: f64, margin: f64, violation: f64, spec: RowParameters) -> f64 {
        let i = impedance(spec.solref, spec.solimp, violation, self.model.opt.least_timeconst());
        self.row_with(pos, margin, spec.diag, i);
        i.b
    }

    /// Appends a row with an impedance; `diag` approximates the diagonal of `J M^-1 J'`.
    #[inline(always)]
    pub(super) fn row_with(&mut self, pos: f64, margin: f64, diag: f64, i: Impedance) {
        // the regularisation R in chapter "Computation" of MuJoCo's manual
        let r = ((1.0 - i.imp) / i.imp * diag).max(MINVAL);
        // dry friction opposes velocity only: it has no position to return to
        let k = if self.block_mut().kind.is_friction() { 0.0 } else { i.k };
        self.push(pos, margin, diag, r, -k * i.imp * (pos - margin), i.b);
    }

    #[doc(alias = "mj_referenceConstraint")]
    #[inline(always)]
    pub(super) fn push(&mut self, pos: f64, margin: f64, diag: f64, r: f64, aref: f64, damping: f64) {
        let e = &mut *self.efc;
        e.pos.push(pos);
        e.margin.push(margin);
        e.diag_approx.push(diag);
        e.r.push(r);
        e.d.push(1.0 / r);
        e.aref.push(aref);
        e.vel.push(damping);
    }
}

/// Adds (or subtracts) the motion of a point at `offset` from the centre of mass due to the first `lanes` of a tile.
#[inline(always)]
fn add_motion(
    cdof: &[Lanes; 6],
    lanes: u32,
    offset: Vec3,
    join: impl Fn(f64, f64) -> f64,
    translation: &mut [Lanes; 3],
    rotation: &mut [Lanes; 3],
) {
    let [wx, wy, wz, x, y, z] = cdof;
    for k in 0..4 {
        let moves = if (k as u32) < lanes { 1.0 } else { 0.0 };
        let (wx, wy, wz) = (moves * wx[k], moves * wy[k], moves * wz[k]);
        let v = [
            moves * x[k] + (wy * offset[2] - wz * offset[1]),
            moves * y[k] + (wz * offset[0] - wx * offset[2]),
            moves * z[k] + (wx * offset[1] - wy * offset[0]),
        ];
        for (c, w) in [wx, wy, wz].into_iter().enumerate() {
            translation[c][k] = join(translation[c][k], v[c]);
            rotation[c][k] = join(rotation[c][k], w);
        }
    }
}
