//! Constraint rows without a friction cone, four at a time.

use super::{Block, ConstraintType, Efc};
use crate::tiles::{Lanes, total};

/// No row.
pub(super) const NONE: u32 = u32::MAX;

/// Four rows whose force is `-d jar`, clamped: by nothing (equalities), to the dry friction, to one sign (limits and
/// contacts without friction). Missing rows are zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScalarRows {
    /// Inverse of the regularisation.
    pub(super) d: Lanes,
    /// Regularisation.
    r: Lanes,
    /// Bounds of `d jar`.
    low: Lanes,
    high: Lanes,
    pub(super) aref: Lanes,
    /// `J a - aref`
    pub(super) jar: Lanes,
    /// `J` times the search direction.
    pub(super) jv: Lanes,
    pub(super) force: Lanes,
    /// Curvature: `d` between the bounds, otherwise 0.
    pub(super) weight: Lanes,
    /// Rows of [`Efc`].
    pub(super) row: [u32; 4],
}

/// Four missing rows.
pub(super) const NO_ROWS: ScalarRows = ScalarRows {
    d: [0.0; 4],
    r: [0.0; 4],
    low: [0.0; 4],
    high: [0.0; 4],
    aref: [0.0; 4],
    jar: [0.0; 4],
    jv: [0.0; 4],
    force: [0.0; 4],
    weight: [0.0; 4],
    row: [NONE; 4],
};

impl ScalarRows {
    #[inline(always)]
    pub(super) fn set(&mut self, k: usize, efc: &Efc, row: usize, b: &Block) {
        let (low, high) = match b.kind {
            ConstraintType::FrictionDof | ConstraintType::FrictionTendon => (-b.frictionloss, b.frictionloss),
            ConstraintType::LimitJoint
            | ConstraintType::LimitTendon
            | ConstraintType::ContactFrictionless
            | ConstraintType::ContactPyramidal => (f64::NEG_INFINITY, 0.0),
            ConstraintType::Equality | ConstraintType::ContactElliptic => (f64::NEG_INFINITY, f64::INFINITY),
        };
        (self.d[k], self.r[k], self.aref[k]) = (efc.d[row], efc.r[row], efc.aref[row]);
        (self.low[k], self.high[k], self.row[k]) = (low, high, row as u32);
    }

    /// Fills force and weight; returns the costs.
    #[inline(always)]
    pub(super) fn evaluate(&mut self) -> Lanes {
        let mut cost = [0.0; 4];
        for k in 0..4 {
            let pull = self.d[k] * self.jar[k];
            let clamped = clamp(pull, self.low[k], self.high[k]);
            // from a bound on the cost is linear: a row that neither pulls nor is pulled, as where nothing moves yet and
            // `aref` is 0, must not stiffen the Hessian, or the first search goes elsewhere than MuJoCo's
            self.weight[k] = self.between(k, clamped, self.d[k]);
            self.force[k] = -clamped;
            // d jar^2 / 2 between the bounds and its tangent beyond them (Huber's function) in one expression, as 1 = r d
            cost[k] = clamped * (self.jar[k] - 0.5 * self.r[k] * clamped);
        }
        cost
    }

    /// Returns a value if a clamped pull is strictly between the bounds of row `k`, otherwise 0.
    #[inline(always)]
    fn between(&self, k: usize, clamped: f64, value: f64) -> f64 {
        // of the clamped pull, not of the pull: of comparisons shared with `clamp`, LLVM makes branches for single rows,
        // which are taken at random
        let inside = (self.low[k] < clamped) & (clamped < self.high[k]);
        if inside { value } else { 0.0 }
    }

    /// Returns the cost at `jar + alpha jv`.
    pub(super) fn cost(&self, alpha: f64) -> f64 {
        let mut cost = [0.0; 4];
        for k in 0..4 {
            let jar = self.jar[k] + alpha * self.jv[k];
            let clamped = clamp(self.d[k] * jar, self.low[k], self.high[k]);
            cost[k] = clamped * (jar - 0.5 * self.r[k] * clamped);
        }
        total(&cost)
    }

    /// Adds first and second derivatives of the cost at `jar + alpha jv`.
    #[inline(always)]
    pub(super) fn add_slopes(&self, alpha: f64, first: &mut Lanes, second: &mut Lanes) {
        for k in 0..4 {
            let pull = self.d[k] * (self.jar[k] + alpha * self.jv[k]);
            let clamped = clamp(pull, self.low[k], self.high[k]);
            let curvature = self.d[k] * self.jv[k] * self.jv[k];
            first[k] += clamped * self.jv[k];
            second[k] += self.between(k, clamped, curvature);
        }
    }
}

#[inline(always)]
fn clamp(x: f64, low: f64, high: f64) -> f64 {
    let x = if x < low { low } else { x };
    if x > high { high } else { x }
}
