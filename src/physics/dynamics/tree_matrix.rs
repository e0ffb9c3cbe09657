//! Matrices over the degrees of freedom with the pattern of the tree, which need not be symmetric, and their factors.

use crate::tiles::Tile;
use crate::topology::Topology;

/// A matrix (nv, nv) that is zero except for pairs of a degree of freedom and one of its ancestors, on both sides of the
/// diagonal.
#[derive(Clone, Debug, Default)]
pub(super) struct TreeMatrix {
    /// For each degree of freedom its row, over its ancestors and itself.
    lower: Vec<f64>,
    /// For each degree of freedom its column, over its ancestors; the place of the diagonal is not used.
    upper: Vec<f64>,
}

impl TreeMatrix {
    /// Sets all entries to zero.
    pub fn clear(&mut self, topology: &Topology) {
        let entries = topology.chain_start(topology.slot.len());
        for side in [&mut self.lower, &mut self.upper] {
            side.clear();
            side.resize(entries, 0.0);
        }
    }

    /// Adds to an entry; one outside the pattern stays zero.
    pub fn add(&mut self, topology: &Topology, row: usize, col: usize, value: f64) {
        let Some(place) = topology.chain_place(row.min(col), row.max(col)) else {
            return;
        };
        if col <= row {
            self.lower[place] += value;
        } else {
            self.upper[place] += value;
        }
    }

    /// Returns an entry.
    #[cfg(test)]
    pub fn entry(&self, topology: &Topology, row: usize, col: usize) -> f64 {
        let side = if col <= row { &self.lower } else { &self.upper };
        topology
            .chain_place(row.min(col), row.max(col))
            .map_or(0.0, |place| side[place])
    }

    /// Adds to row `dof` at its ancestor number `place`, counted from the root.
    pub fn add_lower(&mut self, topology: &Topology, dof: usize, place: usize, value: f64) {
        self.lower[topology.chain_start(dof) + place] += value;
    }

    /// Adds to column `dof` at its ancestor number `place`, counted from the root.
    pub fn add_upper(&mut self, topology: &Topology, dof: usize, place: usize, value: f64) {
        self.upper[topology.chain_start(dof) + place] += value;
    }

    /// Adds `scale J' J` for a row `J`, given by its entries.
    pub fn add_square(&mut self, topology: &Topology, entries: &[(usize, f64)], scale: f64) {
        for &(row, a) in entries {
            for &(col, b) in entries {
                self.add(topology, row, col, scale * (a * b));
            }
        }
    }

    /// Sets row and column `dof` to zero over its ancestors, except for the diagonal.
    pub fn keep_diagonal(&mut self, topology: &Topology, dof: usize) {
        let start = topology.chain_start(dof);
        let above = start..start + topology.dof_chain(dof).len() - 1;
        self.lower[above.clone()].fill(0.0);
        self.upper[above].fill(0.0);
    }

    /// Replaces a matrix `D` by `M - h D`.
    pub fn subtract_from(&mut self, topology: &Topology, m: &[Tile], h: f64) {
        for dof in 0..topology.slot.len() {
            let start = topology.chain_start(dof);
            for (place, (_, value)) in topology.row(m, dof).enumerate() {
                let (lower, upper) = (&mut self.lower[start + place], &mut self.upper[start + place]);
                (*lower, *upper) = (value - h * *lower, value - h * *upper);
            }
        }
    }

    /// Factors the matrix into an upper triangle with ones on its diagonal times a lower triangle. Because it begins at the leaves, no entry outside
    /// the pattern arises.
    pub fn factor(&mut self, topology: &Topology) {
        for dof in (0..topology.slot.len()).rev() {
            let (chain, start) = (topology.dof_chain(dof), topology.chain_start(dof));
            let above = chain.len() - 1;
            let pivot = self.lower[start + above];
            for (a, &row) in chain[..above].iter().enumerate() {
                let factor = self.upper[start + a] / pivot;
                self.upper[start + a] = factor;
                if factor == 0.0 {
                    continue;
                }
                let first = topology.chain_start(row as usize);
                for c in 0..=a {
                    self.lower[first + c] -= factor * self.lower[start + c];
                }
                for (c, &col) in chain[..above].iter().enumerate().skip(a + 1) {
                    self.upper[topology.chain_start(col as usize) + a] -= factor * self.lower[start + c];
                }
            }
        }
    }

    /// Solves for `x` (nv) in place with the factors of the matrix.
    pub fn solve(&self, topology: &Topology, x: &mut [f64]) {
        for dof in (0..topology.slot.len()).rev() {
            let (chain, start) = (topology.dof_chain(dof), topology.chain_start(dof));
            let value = x[dof];
            for (a, &row) in chain[..chain.len() - 1].iter().enumerate() {
                x[row as usize] -= self.upper[start + a] * value;
            }
        }
        for dof in 0..topology.slot.len() {
            let (chain, start) = (topology.dof_chain(dof), topology.chain_start(dof));
            let above = chain.len() - 1;
            let mut value = x[dof];
            for (a, &col) in chain[..above].iter().enumerate() {
                value -= self.lower[start + a] * x[col as usize];
            }
            x[dof] = value / self.lower[start + above];
        }
    }
}
