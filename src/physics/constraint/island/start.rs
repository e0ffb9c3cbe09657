//! The starting point of Newton's method.

use super::Island;
use crate::constraint::Efc;
use crate::tiles::{mul, total};
use crate::topology::Topology;
use crate::vectorize::vectorize;

impl Island {
    /// Starts at `qacc_warmstart` (nv) or at the acceleration without constraints, whichever costs less. Returns the cost and
    /// the length of its gradient.
    #[inline(always)]
    pub(crate) fn start(&mut self, topology: &Topology, qacc_warmstart: &[f64], efc: &Efc) -> (f64, f64) {
        self.start_at(topology, qacc_warmstart, efc);
        let warm = self.evaluate();
        let length = self.differentiate(efc);
        // convexity spares the other start: both are evaluated only where it proves nothing
        if self.beats_smooth(warm) {
            return (warm, length);
        }
        self.start_smooth(efc);
        let mut cost = self.evaluate();
        // a warm start that is not a number costs no less
        if warm < cost {
            self.start_at(topology, qacc_warmstart, efc);
            cost = self.evaluate();
        }
        (cost, self.differentiate(efc))
    }

    /// Starts at the acceleration without constraints.
    #[inline(always)]
    fn start_smooth(&mut self, efc: &Efc) {
        self.acc.copy_from_slice(&self.acc_smooth);
        // M qacc_smooth is qfrc_smooth
        self.ma.copy_from_slice(&self.force_smooth);
        self.reset_rows(efc);
    }

    /// Starts at a given acceleration (nv).
    #[inline(always)]
    fn start_at(&mut self, topology: &Topology, qacc: &[f64], efc: &Efc) {
        for &(t, _) in &self.trees {
            for d in topology.tree_adr[t]..topology.tree_adr[t + 1] {
                let slot = (topology.slot[d] as usize).wrapping_add(self.shift[t]);
                self.acc[slot / 4][slot % 4] = qacc[d];
            }
        }
        let (pattern, m, acc, ma) = (&self.m_pattern, &self.m[..], &self.acc[..], &mut self.ma[..]);
        vectorize(
            #[inline(always)]
            || mul(pattern, m, acc, ma),
        );
        self.reset_rows(efc);
    }

    /// Computes all `jar` at `acc`.
    #[inline(always)]
    fn reset_rows(&mut self, efc: &Efc) {
        let x = std::mem::take(&mut self.acc);
        // the product with J is the same for an acceleration and for a search direction, and lands in `jv`
        self.rates(&x, efc);
        self.acc = x;
        for q in &mut self.scalar_rows {
            for k in 0..4 {
                q.jar[k] = q.jv[k] - q.aref[k];
            }
        }
        for (c, _) in &mut self.cones {
            for k in 0..6 {
                c.jar[k] = c.jv[k] - c.aref[k];
            }
        }
    }

    /// Returns whether the acceleration, whose cost is `cost`, certainly costs less than the one without constraints.
    ///
    /// The cost is convex, and as curved as the inertia `M` at least. So the cost without constraints exceeds this one by
    /// `gradient d + d M d / 2` or more, where `d` leads from here to there. What rounding may hide counts as unsure.
    #[inline(always)]
    fn beats_smooth(&self, cost: f64) -> bool {
        let (mut excess, mut size) = ([0.0; 4], [0.0; 4]);
        for ((((ma, f), a), b), g) in self
            .ma
            .iter()
            .zip(&self.force_smooth)
            .zip(&self.acc)
            .zip(&self.acc_smooth)
            .zip(&self.gradient)
        {
            for k in 0..4 {
                let d = b[k] - a[k];
                excess[k] += d * (g[k] - 0.5 * (ma[k] - f[k]));
                size[k] += d.abs() * (ma[k].abs() + f[k].abs());
            }
        }
        total(&excess) > 1e-9 * (cost + total(&size))
    }
}
