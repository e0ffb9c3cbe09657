//! The solver against slip: friction without regularisation, which cannot creep, at the normal forces that another solver found.

use super::{CONE_ROWS, DualSolver, product, scale, settle};
use crate::constraint::friction::{DIRECTIONS, Quadratic};
use crate::constraint::{Block, ConstraintType, Efc};
use crate::dynamics::Articulated;
use crate::error::EngineError;
use crate::math::MINVAL;
use crate::model::Model;
use crate::state::State;
use crate::topology::Topology;
use crate::vectorize::vectorized;

/// Least diagonal entry of the matrix of a contact's friction, 1/kg, as in MuJoCo.
const LEAST: f64 = 1e-10;

impl DualSolver {
    /// Corrects dry friction and contact friction after another solver (MuJoCo's `mj_solNoSlip`), and `qacc, qfrc_constraint` with them.
    /// The warm start of the next step stays. `bodies` must be up to date.
    ///
    /// # Errors
    /// More numbers in the matrices than [`Limits::dual_numbers`](mjcf_sim_model::Limits::dual_numbers).
    #[doc(alias = "mj_solNoSlip")]
    pub fn hold(
        &mut self,
        model: &Model,
        topology: &Topology,
        bodies: &mut Articulated,
        s: &mut State,
    ) -> Result<(), EngineError> {
        if s.efc.nefc() == 0 {
            return Ok(());
        }
        let mut efc = std::mem::take(&mut s.efc);
        let prepared = self.prepare(model, topology, bodies, &efc, s);
        if prepared.is_ok() {
            efc.force.resize(self.stride, 0.0);
            s.solver_iterations += vectorized!(self.sweep_friction(model, &mut efc));
            efc.force.truncate(efc.nefc());
            self.finish(model, bodies, &efc, s);
        }
        s.efc = efc;
        prepared
    }

    /// Sweeps over friction until a sweep improves the cost by less than the tolerance; returns the number of sweeps.
    #[inline(always)]
    fn sweep_friction(&mut self, model: &Model, efc: &mut Efc) -> usize {
        self.differentiate(efc);
        for sweep in 0..model.opt.noslip_iterations {
            let mut improvement = 0.0;
            if sweep == 0 {
                // what regularisation cost, which no longer counts
                let costs = efc.force.iter().zip(&efc.r).map(|(f, r)| 0.5 * f * f * r);
                improvement = costs.sum();
            }
            for k in 0..efc.blocks.len() {
                let block = efc.blocks[k];
                improvement -= match block.kind {
                    ConstraintType::FrictionDof | ConstraintType::FrictionTendon => self.slide(efc, &block),
                    ConstraintType::ContactPyramidal => self.pyramid(efc, &block),
                    ConstraintType::ContactElliptic => self.ellipsoid(efc, &block),
                    _ => 0.0,
                };
            }
            if improvement * scale(model) < model.opt.noslip_tolerance {
                return sweep + 1;
            }
        }
        model.opt.noslip_iterations
    }

    /// Returns an entry of the matrix without regularisation.
    #[inline(always)]
    fn rigid(&self, efc: &Efc, row: usize, col: usize) -> f64 {
        let value = self.row(row)[col];
        if row == col { value - efc.r[row] } else { value }
    }

    /// Returns an entry of the matrix of a contact's friction. Directions in which nothing can move are treated as in MuJoCo, because they decide
    /// which matrices count as singular and leave forces unchanged.
    #[inline(always)]
    fn of_contact(&self, efc: &Efc, row: usize, col: usize) -> f64 {
        let value = self.rigid(efc, row, col);
        if row == col { value.max(LEAST) } else { value }
    }

    /// Returns the derivative of the cost without regularisation by the force of a row.
    #[inline(always)]
    fn residual(&self, efc: &Efc, row: usize) -> f64 {
        self.gradient[row] - efc.r[row] * efc.force[row]
    }

    /// Improves dry friction; returns the change of the cost.
    #[inline(always)]
    fn slide(&mut self, efc: &mut Efc, block: &Block) -> f64 {
        let (i, loss) = (block.row, block.frictionloss);
        let (residual, old) = (self.residual(efc, i), efc.force[i]);
        let inverse = 1.0 / self.rigid(efc, i, i).max(MINVAL);
        efc.force[i] = (old - residual * inverse).max(-loss).min(loss);
        let moved = efc.force[i] - old;
        if moved == 0.0 {
            return 0.0;
        }
        self.shift(i, moved);
        0.5 * moved * moved / inverse + moved * residual
    }

    /// Improves the friction of a pyramid: opposite edges, whose sum stays constant. Returns the change of the cost.
    #[inline(always)]
    fn pyramid(&mut self, efc: &mut Efc, block: &Block) -> f64 {
        let mut change = 0.0;
        for j in (block.row..block.row + block.dim).step_by(2) {
            let mut residual = [0.0; CONE_ROWS];
            let mut old = [0.0; CONE_ROWS];
            let mut a = [[0.0; 2]; 2];
            for r in 0..2 {
                residual[r] = self.residual(efc, j + r);
                old[r] = efc.force[j + r];
                for (c, v) in a[r].iter_mut().enumerate() {
                    *v = self.of_contact(efc, j + r, j + c);
                }
            }
            let rest = |r: usize| residual[r] - (a[r][0] * old[0] + a[r][1] * old[1]);
            let middle = 0.5 * (old[0] + old[1]);
            let curvature = a[0][0] + a[1][1] - a[0][1] - a[1][0];
            let slope = middle * (a[0][0] - a[1][1]) + rest(0) - rest(1);
            let apart = if curvature < MINVAL {
                0.0
            } else {
                (-slope / curvature).max(-middle).min(middle)
            };
            let own = &mut efc.force[j..j + 2];
            own.copy_from_slice(&[middle + apart, middle - apart]);
            change += settle(2, |r, c| a[r][c], own, &old, &residual);
            self.follow(j, own, &old);
        }
        change
    }

    /// Improves the friction of an elliptic cone; returns the change of the cost.
    #[inline(always)]
    fn ellipsoid(&mut self, efc: &mut Efc, block: &Block) -> f64 {
        let (first, n) = (block.row + 1, block.dim - 1);
        let normal = efc.force[block.row];
        let mut cost = Quadratic {
            n,
            ..Quadratic::default()
        };
        let mut residual = [0.0; CONE_ROWS];
        let mut old = [0.0; CONE_ROWS];
        for r in 0..n {
            residual[r] = self.residual(efc, first + r);
            old[r] = efc.force[first + r];
            for c in 0..n {
                cost.a[r][c] = self.of_contact(efc, first + r, first + c);
            }
        }
        for r in 0..n {
            cost.b[r] = residual[r] - product(&cost.a[r][..n], &old[..n]);
        }
        let friction = if normal < MINVAL {
            [0.0; DIRECTIONS]
        } else {
            cost.within_ellipsoid(&efc.cone(block).friction, normal)
        };
        let own = &mut efc.force[first..first + n];
        own.copy_from_slice(&friction[..n]);
        let change = settle(n, |r, c| cost.a[r][c], own, &old, &residual);
        self.follow(first, own, &old);
        change
    }
}
