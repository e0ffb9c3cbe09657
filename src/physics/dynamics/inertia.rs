//! The joint-space inertia matrix.

use crate::model::Arrays;
use crate::spatial::{Inertia, inertia_mul};
use crate::state::State;
use crate::tiles::{Lanes, ZERO, add_outer_products};
use crate::tiles::{Tile, mul};
use crate::topology::Topology;

/// Intermediate results of the inertia stage. They belong to an engine rather than a state, because states take turns in the caches of a core:
/// an array of every state would be loaded from memory and written back in each step.
#[derive(Clone, Debug, Default)]
pub struct CompositeInertia {
    /// Composite inertias of subtrees (nbody).
    pub crb: Vec<Inertia>,
    /// Motion axes by tile: six values for each lane, zeros where there is none.
    pub axes: Vec<[Lanes; 6]>,
}

/// Computes the composite inertias and `qm` from `cinert` and `cdof`, armature included (composite-rigid-body algorithm).
#[doc(alias = "mj_crb")]
#[inline(always)]
pub fn crb(model: &Arrays, topology: &Topology, s: &mut State, composite: &mut CompositeInertia) {
    let CompositeInertia { crb, axes } = composite;
    crb.clear();
    crb.extend_from_slice(&s.cinert);
    axes.resize(topology.tiles.rows(), [[0.0; 4]; 6]);
    for b in (1..model.nbody()).rev() {
        let p = model.body_parentid[b];
        if p > 0 {
            let (head, tail) = crb.split_at_mut(b);
            for (a, c) in head[p].iter_mut().zip(&tail[0]) {
                *a += c;
            }
        }
    }
    for row in 0..topology.tiles.rows() {
        let dofs = topology.tile_dof[row]..topology.tile_dof[row + 1];
        let first = dofs.start;
        let mut force = [[0.0; 4]; 6];
        let own = &mut axes[row];
        for ((k, cdof), &body) in (0..4).zip(&s.cdof[dofs.clone()]).zip(&model.dof_bodyid[dofs]) {
            let f = inertia_mul(&crb[body], cdof);
            for c in 0..6 {
                force[c][k] = f[c];
                own[c][k] = cdof[c];
            }
        }
        let tiles = &mut s.qm[topology.tiles.start(row)..topology.tiles.start(row + 1)];
        let ancestors = topology.body_tiles(model.dof_bodyid[first]);
        for (tile, &(col, lanes)) in tiles.iter_mut().zip(ancestors) {
            *tile = ZERO;
            add_outer_products(tile, &force, &axes[col as usize]);
            // a limb may leave the trunk in the middle of a tile
            if col as usize != row && lanes < 4 {
                for row in tile {
                    row[lanes as usize..].fill(0.0);
                }
            }
        }
        if let Some(diagonal) = tiles.last_mut() {
            for k in 0..4 {
                // the force of a descendant on the axis of its ancestor
                for c in 0..k {
                    diagonal[c][k] = diagonal[k][c];
                }
                diagonal[k][k] += if k < topology.lanes(row) {
                    model.dof_armature[first + k]
                } else {
                    1.0
                };
            }
        }
    }
}

/// Computes `out = M x` (nv), for a matrix in tiles. Allocates: the solvers work in lanes throughout.
#[doc(alias = "mj_mulM")]
pub fn mul_m(topology: &Topology, m: &[Tile], x: &[f64], out: &mut [f64]) {
    let mut lanes = vec![[0.0; 4]; topology.tiles.rows()];
    let mut product = lanes.clone();
    topology.to_lanes(x, &mut lanes);
    mul(&topology.tiles, m, &lanes, &mut product);
    topology.read_lanes(&product, out);
}
