//! Solvers on the forces of constraints: projected Gauss-Seidel (MuJoCo's solver `PGS`), and the solver against slip (`noslip`).
//!
//! They minimise the dual cost `f' A f / 2 + f' b` with `A = J M^-1 J' + R` and `b = J qacc_smooth - aref`, one row or contact after
//! another, each within the bounds of its force. They converge slowly, so that models that ask for them show where they stop: sweeps,
//! their order and the criteria are those of MuJoCo.

use std::ops::Range;

use super::cone::FrictionCone;
use super::friction::Quadratic;
use super::{Block, ConeShape, ConstraintType, Efc};
use crate::dynamics::{Articulated, Damping, Four};
use crate::error::EngineError;
use crate::math::MINVAL;
use crate::model::Model;
use crate::state::State;
use crate::topology::Topology;
use crate::vectorize::vectorized;

mod matrix;
mod noslip;

/// A change of forces that raises the cost by more than this is undone.
const RISE: f64 = 1e-10;

/// Maximum number of rows of an elliptic cone.
const CONE_ROWS: usize = 6;

/// Solves for the forces of constraints; holds the working memory.
#[derive(Clone, Debug, Default)]
pub struct DualSolver {
    /// `J` (nefc x nv), row by row.
    jac: Vec<f64>,
    /// `A`: nefc rows of nefc numbers, each padded with zeros to whole vectors of four.
    a: Vec<f64>,
    /// Length of such a row.
    stride: usize,
    b: Vec<f64>,
    /// `A f + b` at the current forces, which follows each of their changes: most rows no longer change after a few sweeps, and then cost nothing.
    /// Padded like rows of `A`.
    gradient: Vec<f64>,
    /// `M^-1` times the forces on the joints (nv).
    column: Vec<f64>,
    /// Half of `M^-1` times each row (nefc x nv): products of two, divided by the inertia that each degree of freedom feels, are `A`.
    halves: Vec<f64>,
    /// Four rows (nv), and half of `M^-1` times each.
    sides: Vec<Four>,
    columns: Vec<Four>,
    /// The degrees of freedom with nonzero numbers in them, with these numbers divided by the inertia that the degree of freedom feels.
    support: Vec<(usize, Four)>,
    /// The degrees of freedom between which the half of each row has its numbers.
    reaches: Vec<Range<usize>>,
    /// One over the diagonal of `A`.
    inverse: Vec<f64>,
}

/// Returns the least and greatest force of a row that does not belong to an elliptic cone.
fn bounds(block: &Block) -> [f64; 2] {
    match block.kind {
        ConstraintType::Equality => [f64::NEG_INFINITY, f64::INFINITY],
        ConstraintType::FrictionDof | ConstraintType::FrictionTendon => [-block.frictionloss, block.frictionloss],
        _ => [0.0, f64::INFINITY],
    }
}

impl DualSolver {
    /// Computes `qacc, qfrc_constraint` and the row forces by projected Gauss-Seidel. Starts from the forces that correspond to `qacc_warmstart`, or
    /// from zero forces, whichever cost less. `bodies` must be up to date.
    ///
    /// # Errors
    /// More numbers in the matrices than [`Limits::dual_numbers`](mjcf_sim_model::Limits::dual_numbers).
    #[doc(alias = "mj_solPGS")]
    pub fn solve(
        &mut self,
        model: &Model,
        topology: &Topology,
        bodies: &mut Articulated,
        s: &mut State,
    ) -> Result<(), EngineError> {
        s.qacc.copy_from_slice(&s.qacc_smooth);
        s.qfrc_constraint.fill(0.0);
        s.solver_iterations = 0;
        if s.efc.nefc() > 0 {
            let mut efc = std::mem::take(&mut s.efc);
            let prepared = self.prepare(model, topology, bodies, &efc, s);
            if prepared.is_ok() {
                efc.force.resize(self.stride, 0.0);
                self.start(model, &mut efc, s);
                s.solver_iterations = vectorized!(self.sweep(model, &mut efc));
                efc.force.truncate(efc.nefc());
                self.finish(model, bodies, &efc, s);
            }
            s.efc = efc;
            prepared?;
        }
        s.qacc_warmstart.copy_from_slice(&s.qacc);
        Ok(())
    }

    /// Returns a row of `A`.
    #[inline(always)]
    fn row(&self, i: usize) -> &[f64] {
        &self.a[i * self.stride..(i + 1) * self.stride]
    }

    /// Sets the forces that correspond to the last acceleration, or zero forces if those cost less, and the gradient there.
    fn start(&mut self, model: &Model, efc: &mut Efc, s: &State) {
        let nv = model.nv;
        if !model.opt.flags.warmstart {
            self.rest(efc);
            return;
        }
        for k in 0..efc.blocks.len() {
            let block = efc.blocks[k];
            let rate = |i: usize| product(&self.jac[i * nv..(i + 1) * nv], &s.qacc_warmstart) - efc.aref[i];
            if block.kind == ConstraintType::ContactElliptic {
                let mut cone = FrictionCone::new(&block, efc);
                (0..block.dim).for_each(|r| cone.jar[r] = rate(block.row + r));
                cone.evaluate();
                efc.force[block.row..block.row + block.dim].copy_from_slice(&cone.force[..block.dim]);
            } else {
                let [low, high] = bounds(&block);
                for i in block.row..block.row + block.dim {
                    efc.force[i] = (-efc.d[i] * rate(i)).max(low).min(high);
                }
            }
        }
        self.differentiate(efc);
        let rows = self.gradient.iter().zip(&self.b).zip(&efc.force);
        let cost: f64 = rows.map(|((g, b), f)| 0.5 * f * (b + g)).sum();
        if cost > 0.0 {
            self.rest(efc);
        }
    }

    /// Sets no forces.
    fn rest(&mut self, efc: &mut Efc) {
        efc.force.fill(0.0);
        self.gradient.clone_from(&self.b);
        self.gradient.resize(self.stride, 0.0);
    }

    /// Computes the gradient at the forces.
    fn differentiate(&mut self, efc: &Efc) {
        self.gradient.clear();
        let rows = self.a.chunks_exact(self.stride.max(1)).zip(&self.b);
        self.gradient.extend(rows.map(|(a, b)| b + product(a, &efc.force)));
        self.gradient.resize(self.stride, 0.0);
    }

    /// Records the change of the force of a row.
    #[inline(always)]
    fn shift(&mut self, row: usize, moved: f64) {
        let column = &self.a[row * self.stride..(row + 1) * self.stride];
        let (sums, _) = self.gradient.as_chunks_mut::<4>();
        for (sum, a) in sums.iter_mut().zip(column.as_chunks::<4>().0) {
            for (sum, a) in sum.iter_mut().zip(a) {
                *sum += moved * a;
            }
        }
    }

    /// Sweeps over the rows until a sweep improves the cost by less than the tolerance; returns the number of sweeps.
    #[inline(always)]
    fn sweep(&mut self, model: &Model, efc: &mut Efc) -> usize {
        let scale = scale(model);
        for sweep in 0..model.opt.iterations {
            let mut improvement = 0.0;
            for block in &efc.blocks {
                if block.kind == ConstraintType::ContactElliptic {
                    improvement -= self.cone(block, &efc.cones[block.cone as usize], &mut efc.force);
                    continue;
                }
                let [low, high] = bounds(block);
                for i in block.row..block.row + block.dim {
                    let (residual, old) = (self.gradient[i], efc.force[i]);
                    let force = (old - residual * self.inverse[i]).max(low).min(high);
                    let moved = force - old;
                    if moved == 0.0 {
                        continue;
                    }
                    let change = 0.5 * moved * moved * self.row(i)[i] + moved * residual;
                    if change > RISE {
                        continue;
                    }
                    efc.force[i] = force;
                    self.shift(i, moved);
                    improvement -= change;
                }
            }
            if improvement * scale < model.opt.tolerance {
                return sweep + 1;
            }
        }
        model.opt.iterations
    }

    /// Improves the forces of a contact with an elliptic cone: first along the ray on which they lie, then friction at that normal force.
    /// Returns the change of the cost.
    #[inline(always)]
    fn cone(&mut self, block: &Block, shape: &ConeShape, force: &mut [f64]) -> f64 {
        let (first, dim) = (block.row, block.dim);
        let entry = |r: usize, c: usize| self.row(first + r)[first + c];
        let mut residual = [0.0; CONE_ROWS];
        let mut old = [0.0; CONE_ROWS];
        residual[..dim].copy_from_slice(&self.gradient[first..first + dim]);
        old[..dim].copy_from_slice(&force[first..first + dim]);
        let own = &mut force[first..first + dim];
        if own[0] < MINVAL {
            own[0] = (own[0] - residual[0] * self.inverse[first]).max(0.0);
            own[1..].fill(0.0);
        } else {
            let along = |r: usize| (0..dim).map(|c| entry(r, c) * old[c]).sum::<f64>();
            let curvature: f64 = (0..dim).map(|r| old[r] * along(r)).sum();
            if curvature >= MINVAL {
                let step = -product(&old[..dim], &residual[..dim]) / curvature;
                // the normal force does not pull
                let step = if own[0] + step * old[0] < 0.0 { -1.0 } else { step };
                own.iter_mut().zip(&old).for_each(|(f, v)| *f += step * v);
            }
        }
        if own[0] < MINVAL {
            own[1..].fill(0.0);
        } else {
            let mut cost = Quadratic {
                n: dim - 1,
                ..Quadratic::default()
            };
            for r in 0..dim - 1 {
                cost.b[r] = residual[r + 1] + entry(r + 1, 0) * (own[0] - old[0]);
                for c in 0..dim - 1 {
                    cost.a[r][c] = entry(r + 1, c + 1);
                    cost.b[r] -= cost.a[r][c] * old[c + 1];
                }
            }
            let friction = cost.within_ellipsoid(&shape.friction, own[0]);
            own[1..].copy_from_slice(&friction[..dim - 1]);
        }
        let change = settle(dim, entry, own, &old, &residual);
        self.follow(first, own, &old);
        change
    }

    /// Records the changes of forces starting at `first`.
    #[inline(always)]
    fn follow(&mut self, first: usize, force: &[f64], old: &[f64]) {
        for (r, (force, old)) in force.iter().zip(old).enumerate() {
            if force != old {
                self.shift(first + r, force - old);
            }
        }
    }

    /// Computes the generalised forces of the constraint forces.
    fn finish(&mut self, model: &Model, bodies: &mut Articulated, efc: &Efc, s: &mut State) {
        let nv = model.nv;
        s.qfrc_constraint.fill(0.0);
        if nv == 0 {
            return;
        }
        for (row, &force) in self.jac.chunks_exact(nv).zip(&efc.force) {
            for (sum, j) in s.qfrc_constraint.iter_mut().zip(row) {
                *sum += j * force;
            }
        }
        bodies.solve(s, Damping::Without, &s.qfrc_constraint, &mut self.column);
        for ((acc, smooth), change) in s.qacc.iter_mut().zip(&s.qacc_smooth).zip(&self.column) {
            *acc = change + smooth;
        }
    }
}

/// Returns the factor on costs before they are compared with a tolerance.
fn scale(model: &Model) -> f64 {
    1.0 / (model.stat.meaninertia * model.nv.max(1) as f64)
}

/// Returns the change of the cost from `old` forces to new ones, of `n` rows with the matrix `a` and the `residual` at the old ones.
/// If it rises, the old forces are restored.
#[inline(always)]
fn settle(
    n: usize,
    a: impl Fn(usize, usize) -> f64,
    force: &mut [f64],
    old: &[f64; CONE_ROWS],
    residual: &[f64; CONE_ROWS],
) -> f64 {
    let mut moved = [0.0; CONE_ROWS];
    (0..n).for_each(|k| moved[k] = force[k] - old[k]);
    let row = |r: usize| (0..n).map(|c| a(r, c) * moved[c]).sum::<f64>();
    let curved: f64 = (0..n).map(|r| moved[r] * row(r)).sum();
    let change = 0.5 * curved + product(&moved[..n], &residual[..n]);
    if change > RISE {
        force.copy_from_slice(&old[..n]);
        return 0.0;
    }
    change
}

/// Returns the sum of the products of two vectors' elements, in four partial sums, because a single sum would wait for each addition.
#[inline(always)]
fn product(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (x, y) in a.iter().zip(b) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use crate::assets::MemoryAssets;
    use crate::mjcf_loader::load_str;
    use crate::{Engine, SoftEngine, SoftOptions, State, compile};

    fn engine(text: &str) -> SoftEngine {
        let model = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
        SoftEngine::new(model.unwrap_or_else(|e| panic!("{e}")).into(), SoftOptions::default())
    }

    #[test]
    fn matrices_that_are_too_large_are_an_error() {
        let boxes: String = (0..320)
            .map(|k| {
                format!(
                    "<body pos='{} {} .099'><freejoint/><geom type='box' size='.1 .1 .1'/></body>",
                    k % 20,
                    k / 20
                )
            })
            .collect();
        for option in ["solver='PGS'", "noslip_iterations='2'"] {
            let text = format!(
                "<mujoco><option {option}/><worldbody><geom type='plane' size='1 1 1'/>{boxes}</worldbody></mujoco>"
            );
            let mut engine = engine(&text);
            let mut state = engine.new_state();
            let error = engine.step(&mut state).expect_err("1280 contacts").to_string();
            assert_eq!(
                error,
                "more than 16777216 numbers in the matrices of solver=\"PGS\" or noslip_iterations in step 0: place the bodies \
                 apart, or let fewer of them touch"
            );
        }
    }

    /// Leaves a box on a slope for a while; returns the distance that it slid, and its state.
    fn slide(option: &str) -> (f64, State) {
        let text = format!(
            "<mujoco><option gravity='3 0 -9.81' {option}/><worldbody><geom type='plane' size='9 9 1'/>
             <body pos='0 0 .1'><freejoint/><geom type='box' size='.2 .2 .1' friction='.6'/></body></worldbody></mujoco>"
        );
        let mut engine = engine(&text);
        let mut state = engine.new_state();
        for _ in 0..300 {
            engine.step(&mut state).expect("a step");
        }
        let settled = state.qpos[0];
        for _ in 0..300 {
            engine.step(&mut state).expect("a step");
        }
        (state.qpos[0] - settled, state)
    }

    #[test]
    fn what_sticks_creeps_and_without_slip_it_stays() {
        for cone in ["pyramidal", "elliptic"] {
            let (soft, _) = slide(&format!("cone='{cone}'"));
            let (rigid, _) = slide(&format!("cone='{cone}' noslip_iterations='50' noslip_tolerance='0'"));
            assert!(soft > 1e-4, "{cone}: {soft:e}");
            assert!(rigid.abs() < 1e-2 * soft, "{cone}: {rigid:e} of {soft:e}");
        }
    }

    #[test]
    fn all_solvers_find_the_same_acceleration() {
        for cone in ["pyramidal", "elliptic"] {
            let option = |solver: &str| format!("cone='{cone}' solver='{solver}' iterations='3000' tolerance='1e-14'");
            let (_, newton) = slide(&option("Newton"));
            for solver in ["CG", "PGS"] {
                let (_, other) = slide(&option(solver));
                let apart = newton.qpos.iter().zip(&other.qpos).map(|(a, b)| (a - b).abs());
                let worst = apart.fold(0.0, f64::max);
                assert!(worst < 1e-6, "{cone} {solver}: {worst:e}");
            }
        }
    }
}
