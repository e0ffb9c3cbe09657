//! Projected Gauss-Seidel on the forces of constraints (MuJoCo's solver `PGS`).
//!
//! It minimises the dual cost `f' A f / 2 + f' b` with `A = J M^-1 J' + R` and `b = J qacc_smooth - aref`, one row after another,
//! each within the bounds of its force. It converges slowly, so that models that ask for it show where it stops: sweeps, their
//! order and the criterion are those of MuJoCo.

use crate::model::Model;
use crate::physics::constraint::{ConstraintType, Efc};
use crate::physics::dynamics::{Articulated, Damping};
use crate::physics::state::State;
use crate::physics::topology::Topology;

/// A row whose force would raise the cost by more than this keeps the one it had.
const RISE: f64 = 1e-10;

/// Solves for the forces of constraints; holds the working memory.
#[derive(Clone, Debug, Default)]
pub struct GaussSeidel {
    /// `J` (nefc x nv), row by row.
    jac: Vec<f64>,
    /// `A` (nefc x nefc).
    a: Vec<f64>,
    b: Vec<f64>,
    /// Least and greatest force of each row.
    bounds: Vec<[f64; 2]>,
    /// `M^-1` times a row (nv).
    column: Vec<f64>,
}

impl GaussSeidel {
    /// Computes `qacc, qfrc_constraint` and the row forces. Starts from the forces that `qacc_warmstart` asks for, or from none,
    /// whichever costs less. There must be no elliptic cones.
    pub fn solve(&mut self, model: &Model, topology: &Topology, bodies: &mut Articulated, s: &mut State) {
        s.qacc.copy_from_slice(&s.qacc_smooth);
        s.qfrc_constraint.fill(0.0);
        s.solver_iterations = 0;
        if s.efc.nefc() > 0 {
            let mut efc = std::mem::take(&mut s.efc);
            self.prepare(model, topology, bodies, &efc, s);
            self.start(model, &mut efc, s);
            s.solver_iterations = self.sweep(model, &mut efc);
            self.finish(model, bodies, &efc, s);
            s.efc = efc;
        }
        s.qacc_warmstart.copy_from_slice(&s.qacc);
    }

    /// Computes the matrix, the right side and the bounds.
    fn prepare(&mut self, model: &Model, topology: &Topology, bodies: &mut Articulated, efc: &Efc, s: &State) {
        let (n, nv) = (efc.nefc(), model.nv);
        self.jac.clear();
        self.jac.resize(n * nv, 0.0);
        self.a.clear();
        self.a.resize(n * n, 0.0);
        self.column.resize(nv, 0.0);
        self.bounds.clear();
        for block in &efc.blocks {
            for (row, dof, value) in efc.entries(topology, block) {
                self.jac[(block.row + row) * nv + dof] = value;
            }
            let bounds = match block.kind {
                ConstraintType::Equality => [f64::NEG_INFINITY, f64::INFINITY],
                ConstraintType::FrictionDof => [-block.frictionloss, block.frictionloss],
                _ => [0.0, f64::INFINITY],
            };
            self.bounds.extend(std::iter::repeat_n(bounds, block.dim));
        }
        for i in 0..n {
            let row = &self.jac[i * nv..(i + 1) * nv];
            bodies.solve(model, s, Damping::Without, row, &mut self.column);
            for k in 0..=i {
                let value = product(&self.jac[k * nv..(k + 1) * nv], &self.column);
                self.a[i * n + k] = value;
                self.a[k * n + i] = value;
            }
            self.a[i * n + i] += efc.r[i];
        }
        self.b.clear();
        let smooth = |i: usize| product(&self.jac[i * nv..(i + 1) * nv], &s.qacc_smooth) - efc.aref[i];
        self.b.extend((0..n).map(smooth));
    }

    /// Sets the forces that the last acceleration asks for, or none if those cost less.
    fn start(&self, model: &Model, efc: &mut Efc, s: &State) {
        let (n, nv) = (efc.nefc(), model.nv);
        if !model.opt.flags.warmstart {
            efc.force.fill(0.0);
            return;
        }
        for i in 0..n {
            let violation = product(&self.jac[i * nv..(i + 1) * nv], &s.qacc_warmstart) - efc.aref[i];
            let [low, high] = self.bounds[i];
            efc.force[i] = (-efc.d[i] * violation).max(low).min(high);
        }
        let rows = self.a.chunks_exact(n).zip(&self.b).zip(&efc.force);
        let cost: f64 = rows.map(|((a, b), f)| f * (b + 0.5 * product(a, &efc.force))).sum();
        if cost > 0.0 {
            efc.force.fill(0.0);
        }
    }

    /// Sweeps over the rows until a sweep improves the cost by less than the tolerance; returns the number of sweeps.
    fn sweep(&self, model: &Model, efc: &mut Efc) -> usize {
        let n = efc.nefc();
        let scale = 1.0 / (model.stat.meaninertia * model.nv.max(1) as f64);
        for sweep in 0..model.opt.iterations {
            let mut improvement = 0.0;
            for i in 0..n {
                let row = &self.a[i * n..(i + 1) * n];
                let residual = self.b[i] + product(row, &efc.force);
                let old = efc.force[i];
                let [low, high] = self.bounds[i];
                let force = (old - residual * (1.0 / row[i])).max(low).min(high);
                let moved = force - old;
                let change = 0.5 * moved * moved * row[i] + moved * residual;
                if change > RISE {
                    continue;
                }
                efc.force[i] = force;
                improvement -= change;
            }
            if improvement * scale < model.opt.tolerance {
                return sweep + 1;
            }
        }
        model.opt.iterations
    }

    /// Computes what the forces do to the joints.
    fn finish(&mut self, model: &Model, bodies: &mut Articulated, efc: &Efc, s: &mut State) {
        let nv = model.nv;
        for (row, &force) in self.jac.chunks_exact(nv).zip(&efc.force) {
            for (sum, j) in s.qfrc_constraint.iter_mut().zip(row) {
                *sum += j * force;
            }
        }
        bodies.solve(model, s, Damping::Without, &s.qfrc_constraint, &mut self.column);
        for ((acc, smooth), change) in s.qacc.iter_mut().zip(&s.qacc_smooth).zip(&self.column) {
            *acc = change + smooth;
        }
    }
}

/// Returns the sum of the products of two vectors' elements.
fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
