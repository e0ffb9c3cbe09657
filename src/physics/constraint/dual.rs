//! Solvers on the forces of constraints: projected Gauss-Seidel (MuJoCo's solver `PGS`), and the solver against slip (`noslip`).
//!
//! They minimise the dual cost `f' A f / 2 + f' b` with `A = J M^-1 J' + R` and `b = J qacc_smooth - aref`, one row or contact after
//! another, each within the bounds of its force. They converge slowly, so that models that ask for them show where they stop: sweeps,
//! their order and the criteria are those of MuJoCo.

use crate::limits::Limits;
use crate::math::MINVAL;
use crate::model::Model;
use crate::physics::constraint::cone::Cone;
use crate::physics::constraint::friction::Quadratic;
use crate::physics::constraint::{Block, ConstraintType, Efc};
use crate::physics::dynamics::{Articulated, Damping};
use crate::physics::engine::{EngineError, within};
use crate::physics::state::State;
use crate::physics::topology::Topology;

mod noslip;

/// A change of forces that would raise the cost by more than this is taken back.
const RISE: f64 = 1e-10;

/// Most rows of an elliptic cone.
const CONE_ROWS: usize = 6;

/// Solves for the forces of constraints; holds the working memory.
#[derive(Clone, Debug, Default)]
pub struct Dual {
    /// `J` (nefc x nv), row by row.
    jac: Vec<f64>,
    /// `A` (nefc x nefc).
    a: Vec<f64>,
    b: Vec<f64>,
    /// `M^-1` times a row (nv).
    column: Vec<f64>,
}

/// Returns the least and greatest force of a row that is none of an elliptic cone.
fn bounds(block: &Block) -> [f64; 2] {
    match block.kind {
        ConstraintType::Equality => [f64::NEG_INFINITY, f64::INFINITY],
        ConstraintType::FrictionDof | ConstraintType::FrictionTendon => [-block.frictionloss, block.frictionloss],
        _ => [0.0, f64::INFINITY],
    }
}

impl Dual {
    /// Computes `qacc, qfrc_constraint` and the row forces by projected Gauss-Seidel. Starts from the forces that `qacc_warmstart`
    /// asks for, or from none, whichever costs less. `bodies` must be up to date.
    ///
    /// # Errors
    /// More numbers in the matrices than [`Limits::dual_numbers`].
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
                self.start(model, &mut efc, s);
                s.solver_iterations = self.sweep(model, &mut efc);
                self.finish(model, bodies, &efc, s);
            }
            s.efc = efc;
            prepared?;
        }
        s.qacc_warmstart.copy_from_slice(&s.qacc);
        Ok(())
    }

    /// Computes the matrix and the right side.
    fn prepare(
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
        self.a.clear();
        self.a.resize(n * n, 0.0);
        self.column.resize(nv, 0.0);
        for block in &efc.blocks {
            for (row, dof, value) in efc.entries(topology, block) {
                self.jac[(block.row + row) * nv + dof] = value;
            }
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
        Ok(())
    }

    /// Sets the forces that the last acceleration asks for, or none if those cost less.
    fn start(&self, model: &Model, efc: &mut Efc, s: &State) {
        let (n, nv) = (efc.nefc(), model.nv);
        if !model.opt.flags.warmstart {
            efc.force.fill(0.0);
            return;
        }
        for k in 0..efc.blocks.len() {
            let block = efc.blocks[k];
            let rate = |i: usize| product(&self.jac[i * nv..(i + 1) * nv], &s.qacc_warmstart) - efc.aref[i];
            if block.kind == ConstraintType::ContactElliptic {
                let mut cone = Cone::new(&block, efc);
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
        let rows = self.a.chunks_exact(n).zip(&self.b).zip(&efc.force);
        let cost: f64 = rows.map(|((a, b), f)| f * (b + 0.5 * product(a, &efc.force))).sum();
        if cost > 0.0 {
            efc.force.fill(0.0);
        }
    }

    /// Sweeps over the rows until a sweep improves the cost by less than the tolerance; returns the number of sweeps.
    fn sweep(&self, model: &Model, efc: &mut Efc) -> usize {
        let n = efc.nefc();
        let scale = scale(model);
        for sweep in 0..model.opt.iterations {
            let mut improvement = 0.0;
            for block in &efc.blocks {
                if block.kind == ConstraintType::ContactElliptic {
                    improvement -= self.cone(n, block, &mut efc.force);
                    continue;
                }
                let [low, high] = bounds(block);
                for i in block.row..block.row + block.dim {
                    let row = &self.a[i * n..(i + 1) * n];
                    let residual = self.b[i] + product(row, &efc.force);
                    let old = efc.force[i];
                    let force = (old - residual * (1.0 / row[i])).max(low).min(high);
                    let moved = force - old;
                    let change = 0.5 * moved * moved * row[i] + moved * residual;
                    if change > RISE {
                        continue;
                    }
                    efc.force[i] = force;
                    improvement -= change;
                }
            }
            if improvement * scale < model.opt.tolerance {
                return sweep + 1;
            }
        }
        model.opt.iterations
    }

    /// Improves the forces of a contact with an elliptic cone: along the ray on which they are, then friction at that normal force.
    /// Returns the change of the cost.
    fn cone(&self, n: usize, block: &Block, force: &mut [f64]) -> f64 {
        let (first, dim) = (block.row, block.dim);
        let entry = |r: usize, c: usize| self.a[(first + r) * n + first + c];
        let mut residual = [0.0; CONE_ROWS];
        let mut old = [0.0; CONE_ROWS];
        for r in 0..dim {
            residual[r] = self.b[first + r] + product(&self.a[(first + r) * n..(first + r + 1) * n], force);
            old[r] = force[first + r];
        }
        let own = &mut force[first..first + dim];
        if own[0] < MINVAL {
            own[0] = (own[0] - residual[0] * (1.0 / entry(0, 0))).max(0.0);
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
            let friction = cost.within_ellipsoid(&block.friction, own[0]);
            own[1..].copy_from_slice(&friction[..dim - 1]);
        }
        settle(dim, entry, own, &old, &residual)
    }

    /// Computes what the forces do to the joints.
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
        bodies.solve(model, s, Damping::Without, &s.qfrc_constraint, &mut self.column);
        for ((acc, smooth), change) in s.qacc.iter_mut().zip(&s.qacc_smooth).zip(&self.column) {
            *acc = change + smooth;
        }
    }
}

/// Returns what costs are scaled by before they are compared with a tolerance.
fn scale(model: &Model) -> f64 {
    1.0 / (model.stat.meaninertia * model.nv.max(1) as f64)
}

/// Returns the change of the cost from `old` forces to new ones, of `n` rows with the matrix `a` and the `residual` at the old ones.
/// Where it rises, the old ones are put back.
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

/// Returns the sum of the products of two vectors' elements.
fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use crate::assets::MemoryAssets;
    use crate::mjcf_loader::load_str;
    use crate::physics::{Engine, SoftEngine, SoftOptions, State, compile};

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

    /// Lets a box lie on a slope for a while; returns how far it went, and its state.
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
