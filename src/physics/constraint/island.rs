//! The problem of one island, in lanes: the cost, its force and its derivatives at a point.

use super::cone::{ConeZone, FrictionCone};
use super::jacobian::{Jacobian, SingleDofRow, add_transposed_product, product};
use super::scalar_rows::{NO_ROWS, NONE, ScalarRows};
use super::{Block, ConstraintType, Efc, MAX_ROWS};
use crate::state::State;
use crate::tiles::{Lanes, Pattern, Tile, mul, total};
use crate::topology::Topology;
use crate::vectorize::vectorize;

mod start;

/// The cost along the search direction, at the start of the search.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlongSearch {
    /// First and second derivative of the inertial part.
    pub(super) inertial_slope: f64,
    pub(super) inertial_curvature: f64,
    /// First derivative of the whole.
    pub(super) slope: f64,
    /// Length of the direction.
    pub(super) length: f64,
}

/// Trees that share constraints, with everything about them in lanes. Tiles of the island count from 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Island {
    /// Trees, each with its first tile.
    trees: Vec<(usize, usize)>,
    /// Difference between a tree's lanes and those of the whole model.
    shift: Vec<usize>,
    /// Inertia.
    pub(super) m: Vec<Tile>,
    pub(super) m_pattern: Pattern,
    force_smooth: Vec<Lanes>,
    acc_smooth: Vec<Lanes>,
    /// Number of leading entries of `scalar_rows` that hold dry friction, one for each tile: none or all of them.
    pub(super) friction_tiles: usize,
    pub(super) scalar_rows: Vec<ScalarRows>,
    /// Rows on one degree of freedom, which come after dry friction.
    pub(super) singles: Vec<SingleDofRow>,
    /// Rows on several degrees of freedom: first row in `scalar_rows`, Jacobian.
    pub(super) several: Vec<(usize, Jacobian)>,
    /// Contacts with friction.
    pub(super) cones: Vec<(FrictionCone, Jacobian)>,
    /// Tiles of the Jacobians' columns, ascending for each.
    cols: Vec<u32>,

    /// Acceleration, inertia times it, and `J' force`.
    pub(super) acc: Vec<Lanes>,
    pub(super) ma: Vec<Lanes>,
    pub(super) constraint_force: Vec<Lanes>,
    pub(super) gradient: Vec<Lanes>,
    /// Search direction, and inertia times it.
    pub(super) search: Vec<Lanes>,
    pub(super) m_search: Vec<Lanes>,
}

impl Island {
    /// Reserves memory for `nv` degrees of freedom, whose inertia has `inertia` tiles, and `contacts` contacts.
    pub(super) fn with_capacity(inertia: usize, nv: usize, contacts: usize) -> Self {
        let lanes = || Vec::with_capacity(nv);
        Self {
            trees: Vec::with_capacity(nv),
            shift: Vec::with_capacity(nv),
            m: Vec::with_capacity(inertia),
            m_pattern: Pattern::with_capacity(nv, inertia),
            force_smooth: lanes(),
            acc_smooth: lanes(),
            friction_tiles: 0,
            scalar_rows: Vec::with_capacity(nv + contacts),
            singles: Vec::with_capacity(4 * nv),
            several: Vec::with_capacity(nv + contacts),
            cones: Vec::with_capacity(contacts),
            cols: Vec::with_capacity(8 * contacts + 4 * nv),
            acc: lanes(),
            ma: lanes(),
            constraint_force: lanes(),
            gradient: lanes(),
            search: lanes(),
            m_search: lanes(),
        }
    }

    /// Returns the number of tiles of degrees of freedom.
    pub(super) fn tiles(&self) -> usize {
        self.m_pattern.rows()
    }

    /// Reads the trees and blocks (indices into `efc.blocks`) of an island.
    #[doc(alias = "mj_island")]
    #[inline(always)]
    pub(super) fn load(&mut self, topology: &Topology, trees: &[usize], blocks: &[u32], efc: &Efc, s: &State) {
        self.load_trees(topology, trees, s);
        let lanes = self.tiles();
        // cleared, not only resized: lanes beyond the last degree of freedom of a tree must be zero, as sums run over
        // whole tiles
        for v in [
            &mut self.acc,
            &mut self.ma,
            &mut self.constraint_force,
            &mut self.gradient,
            &mut self.search,
            &mut self.m_search,
        ] {
            v.clear();
            v.resize(lanes, [0.0; 4]);
        }
        self.load_rows(topology, blocks, efc);
    }

    #[inline(always)]
    fn load_trees(&mut self, topology: &Topology, trees: &[usize], s: &State) {
        self.trees.clear();
        self.shift.resize(topology.ntree(), 0);
        self.m.clear();
        self.m_pattern.clear();
        self.force_smooth.clear();
        self.acc_smooth.clear();
        for &t in trees {
            let (first, rows) = (self.tiles(), topology.tile_adr[t]..topology.tile_adr[t + 1]);
            // tiles count from 0 in the island, so that its matrices have no gaps for the trees that are elsewhere
            self.trees.push((t, first));
            // wraps where a tree moves down; so does the sum with it
            self.shift[t] = (4 * first).wrapping_sub(4 * rows.start);
            let tiles = topology.tiles.start(rows.start)..topology.tiles.start(rows.end);
            self.m.extend_from_slice(&s.qm[tiles]);
            for row in rows.clone() {
                for &c in topology.tiles.cols(row) {
                    self.m_pattern.push_col(c - rows.start as u32 + first as u32);
                }
                self.m_pattern.end_row();
            }
            self.force_smooth.resize(self.m_pattern.rows(), [0.0; 4]);
            self.acc_smooth.resize(self.m_pattern.rows(), [0.0; 4]);
            for d in topology.tree_adr[t]..topology.tree_adr[t + 1] {
                let slot = (topology.slot[d] as usize).wrapping_add(self.shift[t]);
                self.force_smooth[slot / 4][slot % 4] = s.qfrc_smooth[d];
                self.acc_smooth[slot / 4][slot % 4] = s.qacc_smooth[d];
            }
        }
    }

    /// Returns the lane of a degree of freedom, counted over the tiles of the island.
    #[inline(always)]
    fn slot(&self, topology: &Topology, dof: usize) -> usize {
        (topology.slot[dof] as usize).wrapping_add(self.shift[topology.dof_tree[dof]])
    }

    #[inline(always)]
    fn load_rows(&mut self, topology: &Topology, blocks: &[u32], efc: &Efc) {
        self.scalar_rows.clear();
        self.singles.clear();
        self.several.clear();
        self.cones.clear();
        self.cols.clear();
        let block = |k: &u32| &efc.blocks[*k as usize];
        let friction = |b: &Block| b.kind == ConstraintType::FrictionDof;
        // Dry friction is a row for each degree of freedom with a Jacobian of 1. In the lanes of the degrees of freedom
        // such rows need no Jacobian at all; lanes without friction have d = 0, and so neither force nor cost.
        self.friction_tiles = if blocks.iter().any(|k| friction(block(k))) {
            self.tiles()
        } else {
            0
        };
        self.scalar_rows.resize(self.friction_tiles, NO_ROWS);
        let mut row = 4 * self.friction_tiles;
        for b in blocks.iter().map(block) {
            if friction(b) {
                let slot = self.slot(topology, b.id);
                self.scalar_rows[slot / 4].set(slot % 4, efc, b.row, b);
            } else if b.kind == ConstraintType::ContactElliptic {
                let jacobian = self.load_jacobian(topology, b, efc);
                self.cones.push((FrictionCone::new(b, efc), jacobian));
            } else {
                for k in 0..b.dim {
                    // rows are packed without regard to their blocks, as a row is evaluated without its neighbours
                    if (row + k).is_multiple_of(4) {
                        self.scalar_rows.push(NO_ROWS);
                    }
                    self.scalar_rows[(row + k) / 4].set((row + k) % 4, efc, b.row + k, b);
                }
                // a limit of a joint is one number instead of a tile for each ancestor
                if let Some(dof) = b.dof {
                    let slot = self.slot(topology, dof as usize);
                    let value = efc.jac[b.jac][slot % 4];
                    self.singles.push(SingleDofRow { row, slot, value });
                } else {
                    let jacobian = self.load_jacobian(topology, b, efc);
                    self.several.push((row, jacobian));
                }
                row += b.dim;
            }
        }
    }

    #[inline(always)]
    fn load_jacobian(&mut self, topology: &Topology, b: &Block, efc: &Efc) -> Jacobian {
        let col = self.cols.len();
        for &tile in &efc.cols[b.col..b.col + b.ncol] {
            // a constraint between two trees has columns of both, which moved by different amounts
            let shift = self.shift[topology.tile_tree(tile as usize)];
            self.cols.push((4 * tile as usize).wrapping_add(shift) as u32 / 4);
        }
        Jacobian {
            dim: b.dim,
            col,
            ncol: b.ncol,
            jac: b.jac,
        }
    }

    /// Returns the tiles of the columns, ascending.
    #[inline(always)]
    pub(super) fn cols(&self, j: &Jacobian) -> &[u32] {
        &self.cols[j.col..j.col + j.ncol]
    }

    /// Computes `m_search` and all `jv` for `search`.
    #[inline(always)]
    pub(super) fn follow_search(&mut self, efc: &Efc) {
        let (pattern, m) = (&self.m_pattern, &self.m[..]);
        let (search, m_search) = (&self.search[..], &mut self.m_search[..]);
        vectorize(
            #[inline(always)]
            || mul(pattern, m, search, m_search),
        );
        // `rates` writes to the rows of the island that the direction is part of
        let x = std::mem::take(&mut self.search);
        self.rates(&x, efc);
        self.search = x;
    }

    /// Computes `jv = J x`.
    #[inline(always)]
    fn rates(&mut self, x: &[Lanes], efc: &Efc) {
        for (q, x) in self.scalar_rows[..self.friction_tiles].iter_mut().zip(x) {
            // the Jacobian of dry friction is 1
            q.jv = *x;
        }
        for s in &self.singles {
            self.scalar_rows[s.row / 4].jv[s.row % 4] = s.value * x[s.slot / 4][s.slot % 4];
        }
        for &(row, j) in &self.several {
            let v: [f64; MAX_ROWS] = product(&self.cols, &efc.jac, &j, x);
            for (k, v) in v.iter().enumerate().take(j.dim) {
                self.scalar_rows[(row + k) / 4].jv[(row + k) % 4] = *v;
            }
        }
        for (c, j) in &mut self.cones {
            c.jv = product(&self.cols, &efc.jac, j, x);
        }
    }

    /// Moves by `alpha` along the search direction.
    #[inline(always)]
    pub(super) fn advance(&mut self, alpha: f64) {
        #[inline(always)]
        fn axpy(x: &mut Lanes, alpha: f64, v: &Lanes) {
            for k in 0..4 {
                x[k] += alpha * v[k];
            }
        }
        for (x, v) in self.acc.iter_mut().zip(&self.search) {
            axpy(x, alpha, v);
        }
        // all of it is linear along the search direction, so a step costs no product with M or J
        for (x, v) in self.ma.iter_mut().zip(&self.m_search) {
            axpy(x, alpha, v);
        }
        for q in &mut self.scalar_rows {
            axpy(&mut q.jar, alpha, &q.jv);
        }
        for (c, _) in &mut self.cones {
            for k in 0..6 {
                c.jar[k] += alpha * c.jv[k];
            }
        }
    }

    /// Returns the cost at the acceleration; fills in forces and curvatures.
    #[inline(always)]
    pub(super) fn evaluate(&mut self) -> f64 {
        // a sum for each lane, so that vector instructions add in the same order as single ones: the bits agree on
        // every processor
        let mut cost = [0.0; 4];
        for (((ma, f), a), b) in self
            .ma
            .iter()
            .zip(&self.force_smooth)
            .zip(&self.acc)
            .zip(&self.acc_smooth)
        {
            for k in 0..4 {
                // M (a - a_smooth) is at hand: `ma`, less the smooth force, since M qacc_smooth is qfrc_smooth
                cost[k] += 0.5 * (ma[k] - f[k]) * (a[k] - b[k]);
            }
        }
        for q in &mut self.scalar_rows {
            let c = q.evaluate();
            for k in 0..4 {
                cost[k] += c[k];
            }
        }
        // cones are few and differ in size: they are added one by one, always in the same order
        let mut cost = total(&cost);
        for (c, _) in &mut self.cones {
            cost += c.evaluate();
        }
        cost
    }

    /// Computes the gradient of the cost and returns its length.
    ///
    /// `constraint_force = J' force`, `gradient = M acc - qfrc_smooth - J' force`.
    #[inline(always)]
    pub(super) fn differentiate(&mut self, efc: &Efc) -> f64 {
        let out = &mut self.constraint_force;
        if self.friction_tiles > 0 {
            for (o, q) in out.iter_mut().zip(&self.scalar_rows) {
                // J' of dry friction is 1, and these rows stand in the lanes of their degrees of freedom
                *o = q.force;
            }
        } else {
            out.fill([0.0; 4]);
        }
        for s in &self.singles {
            out[s.slot / 4][s.slot % 4] += s.value * self.scalar_rows[s.row / 4].force[s.row % 4];
        }
        for (row, j) in &self.several {
            let mut force = [0.0; MAX_ROWS];
            for (k, f) in force.iter_mut().enumerate().take(j.dim) {
                *f = self.scalar_rows[(row + k) / 4].force[(row + k) % 4];
            }
            add_transposed_product(&self.cols, &efc.jac, j, &force, out);
        }
        for (c, j) in &self.cones {
            // an open contact has no force
            if c.zone != ConeZone::Flat {
                add_transposed_product(&self.cols, &efc.jac, j, &c.force, out);
            }
        }
        // the gradient's length is MuJoCo's second criterion of convergence
        let mut length2 = [0.0; 4];
        for (((g, ma), f), c) in self.gradient.iter_mut().zip(&self.ma).zip(&self.force_smooth).zip(out) {
            for k in 0..4 {
                g[k] = ma[k] - f[k] - c[k];
                length2[k] += g[k] * g[k];
            }
        }
        total(&length2).sqrt()
    }

    /// Returns the length of the constraint force.
    pub(super) fn constraint_force_length(&self) -> f64 {
        let squares = self.constraint_force.iter().flatten().map(|force| force * force);
        squares.sum::<f64>().sqrt()
    }

    /// Computes the sums along the search direction from which the line search starts.
    #[inline(always)]
    pub(super) fn along_search(&self) -> AlongSearch {
        let mut sums = [[0.0; 4]; 4];
        for ((((s, ms), ma), f), g) in self
            .search
            .iter()
            .zip(&self.m_search)
            .zip(&self.ma)
            .zip(&self.force_smooth)
            .zip(&self.gradient)
        {
            for k in 0..4 {
                // the inertial part of the cost is a parabola along the line: its slope and curvature are all that
                // the line search needs of M
                sums[0][k] += s[k] * (ma[k] - f[k]);
                sums[1][k] += s[k] * ms[k];
                sums[2][k] += s[k] * g[k];
                sums[3][k] += s[k] * s[k];
            }
        }
        AlongSearch {
            inertial_slope: total(&sums[0]),
            inertial_curvature: total(&sums[1]),
            slope: total(&sums[2]),
            length: total(&sums[3]).sqrt(),
        }
    }

    /// Writes back the acceleration, the constraint force and the forces of the rows.
    #[inline(always)]
    pub(super) fn store(&self, topology: &Topology, efc: &mut Efc, s: &mut State) {
        for &(t, _) in &self.trees {
            for d in topology.tree_adr[t]..topology.tree_adr[t + 1] {
                let slot = (topology.slot[d] as usize).wrapping_add(self.shift[t]);
                s.qacc[d] = self.acc[slot / 4][slot % 4];
                s.qfrc_constraint[d] = self.constraint_force[slot / 4][slot % 4];
            }
        }
        for q in &self.scalar_rows {
            for (&row, &f) in q.row.iter().zip(&q.force) {
                // the last four may not be full, and lanes without dry friction are none
                if row != NONE {
                    efc.force[row as usize] = f;
                }
            }
        }
        for (c, j) in &self.cones {
            efc.force[c.row..c.row + j.dim].copy_from_slice(&c.force[..j.dim]);
        }
    }
}
