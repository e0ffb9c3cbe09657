//! Half of the inverse inertia, for four right sides at once.

use std::ops::Range;

use super::{Articulated, Link};
use crate::spatial::Spatial;
use crate::state::State;

/// One number for each of four right sides or solutions.
pub type Four = [f64; 4];

/// A force of each.
pub(super) type Four6 = [Four; 6];

impl Articulated {
    /// Computes half of `M^-1` for four right sides (nv each), for some degrees of freedom, which begin with those of a tree: `h` with
    /// `b' M^-1 c = sum_d h_d(b) h_d(c) / D_d`, only the inward pass of [`Articulated::solve`]. `D_d^-1` is
    /// [`Articulated::inverse`]. `h_d` is zero where `b` is zero for `d` and all that `d` moves.
    #[doc(alias = "mj_solveM2")]
    #[inline(always)]
    pub fn half_solve_four(&mut self, s: &State, dofs: Range<usize>, b: &[Four], h: &mut [Four]) {
        let end = |link: &Link| link.dofs.end;
        let first = self.links.partition_point(|link| end(link) <= dofs.start);
        let last = self.links.partition_point(|link| link.dofs.start < dofs.end);
        self.forces.resize(self.links.len(), [[0.0; 4]; 6]);
        let forces = &mut self.forces[..last];
        forces[first..].fill([[0.0; 4]; 6]);
        for (k, link) in self.links[..last].iter().enumerate().skip(first).rev() {
            let mut f = forces[k];
            for d in (link.dofs.start..link.dofs.end.min(dofs.end)).rev() {
                let released = &self.released[d];
                let moved = power(&s.cdof[d], &f);
                let share: Four = std::array::from_fn(|l| b[d][l] - moved[l]);
                h[d] = share;
                let taken = share.map(|v| v * released.inverse[0]);
                add(&mut f, taken, &released.unit_force.map(|v| v[0]));
            }
            if let Some(p) = link.parent {
                for (sum, v) in forces[p].as_flattened_mut().iter_mut().zip(f.as_flattened()) {
                    *sum += v;
                }
            }
        }
    }

    /// Returns the inverse of the inertia that a degree of freedom feels, without damping.
    #[inline(always)]
    pub fn inverse(&self, dof: usize) -> f64 {
        self.released[dof].inverse[0]
    }
}

/// Returns the products of one motion, or force, with four.
#[inline(always)]
fn power(one: &Spatial, four: &Four6) -> Four {
    let mut sum = four[0].map(|v| one[0] * v);
    for (a, row) in one.iter().zip(four).skip(1) {
        for (s, v) in sum.iter_mut().zip(row) {
            *s += a * v;
        }
    }
    sum
}

/// Adds four multiples of one.
#[inline(always)]
fn add(four: &mut Four6, factors: Four, one: &Spatial) {
    for (row, v) in four.iter_mut().zip(one) {
        for (sum, factor) in row.iter_mut().zip(factors) {
            *sum += factor * v;
        }
    }
}
