//! The matrix and the right side of the dual problem.

use super::{DualSolver, product};
use crate::constraint::Efc;
use crate::dynamics::Articulated;
use crate::error::{EngineError, within};
use crate::limits::Limits;
use crate::model::Model;
use crate::state::State;
use crate::topology::Topology;
use crate::vectorize::vectorized;

impl DualSolver {
    /// Computes the matrix and the right side.
    #[doc(alias = "mj_projectConstraint")]
    pub(super) fn prepare(
        &mut self,
        model: &Model,
        topology: &Topology,
        bodies: &mut Articulated,
        efc: &Efc,
        s: &State,
    ) -> Result<(), EngineError> {
        let (n, nv) = (efc.nefc(), model.nv);
        let what = "numbers in the matrices of solver=\"PGS\" or noslip_iterations";
        within(
            Limits::DEFAULT.dual_numbers,
            n.saturating_mul(n.saturating_add(nv)),
            what,
            s.step,
        )?;
        self.jac.clear();
        self.jac.resize(n * nv, 0.0);
        self.stride = n.next_multiple_of(4);
        self.a.clear();
        self.a.resize(n * self.stride, 0.0);
        self.column.resize(nv, 0.0);
        for block in &efc.blocks {
            for (row, dof, value) in efc.entries(topology, block) {
                self.jac[(block.row + row) * nv + dof] = value;
            }
        }
        vectorized!(self.fill(model, topology, bodies, efc, s));
        self.b.clear();
        let smooth = |i: usize| product(&self.jac[i * nv..(i + 1) * nv], &s.qacc_smooth) - efc.aref[i];
        self.b.extend((0..n).map(smooth));
        Ok(())
    }

    /// Computes `A` from `J`, four of its columns at a time.
    #[inline(always)]
    fn fill(&mut self, model: &Model, topology: &Topology, bodies: &mut Articulated, efc: &Efc, s: &State) {
        let (n, nv) = (efc.nefc(), model.nv);
        self.sides.resize(nv, [0.0; 4]);
        self.columns.resize(nv, [0.0; 4]);
        // what a row acts on moves with all that carries it
        let reach = |row: &[f64]| {
            let first = row.iter().position(|v| *v != 0.0);
            let last = row.iter().rposition(|v| *v != 0.0);
            first.zip(last).map_or(0..0, |(first, last)| {
                topology.tree_adr[topology.dof_tree[first]]..last + 1
            })
        };
        self.reaches.clear();
        self.reaches.extend(self.jac.chunks_exact(nv.max(1)).map(reach));
        self.halves.clear();
        self.halves.resize(n * nv, 0.0);
        for first in (0..n).step_by(4) {
            let lanes = 4.min(n - first);
            self.half_solve(first, lanes, nv, bodies, s);
            for (k, reach) in self.reaches[..first + lanes].iter().enumerate() {
                let row = &self.halves[k * nv..(k + 1) * nv];
                let mut sums = [0.0; 4];
                for (d, column) in self.support.iter().take_while(|(d, _)| *d < reach.end) {
                    for (sum, c) in sums.iter_mut().zip(column) {
                        *sum += row[*d] * c;
                    }
                }
                // of these rows, those that come after this column have their own turn
                let later = k.saturating_sub(first);
                for (l, &value) in sums[..lanes].iter().enumerate().skip(later) {
                    let i = first + l;
                    self.a[i * self.stride + k] = value;
                    self.a[k * self.stride + i] = value;
                }
            }
        }
        self.inverse.clear();
        for i in 0..n {
            let diagonal = &mut self.a[i * self.stride + i];
            *diagonal += efc.r[i];
            self.inverse.push(1.0 / *diagonal);
        }
    }

    /// Computes the halves of four rows, or of the last ones, and their `support`.
    #[inline(always)]
    fn half_solve(&mut self, first: usize, lanes: usize, nv: usize, bodies: &mut Articulated, s: &State) {
        self.support.clear();
        let own = self.reaches[first..first + lanes].iter();
        let ends = own
            .filter(|reach| !reach.is_empty())
            .map(|reach| [reach.start, reach.end]);
        let Some([start, end]) = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else {
            return;
        };
        for d in start..end {
            self.sides[d] = std::array::from_fn(|l| if l < lanes { self.jac[(first + l) * nv + d] } else { 0.0 });
        }
        bodies.half_solve_four(s, start..end, &self.sides, &mut self.columns);
        for d in start..end {
            let column = self.columns[d];
            // limbs beside those of these rows have nothing
            if column != [0.0; 4] {
                for (l, &v) in column[..lanes].iter().enumerate() {
                    self.halves[(first + l) * nv + d] = v;
                }
                let inverse = bodies.inverse(d);
                self.support.push((d, column.map(|v| v * inverse)));
            }
        }
    }
}
