//! The physics of an environment: an engine, the state that it advances, and the parameters that a reset restores.

use crate::actuation::Actuation;
use crate::env::{Blueprint, EnvError};
use crate::mimo::{LockReport, LockTarget, lock, lock_of, unlock};
use crate::model::Model;
use crate::physics::{Engine, EngineError, Params, State};

/// An engine and the state that it advances.
pub(super) struct Physics {
    pub engine: Box<dyn Engine>,
    pub state: State,
    /// Parameters after a reset: the blueprint's, with what locks and unlocks changed.
    pub base: Params,
}

impl std::fmt::Debug for Physics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Physics")
            .field("state", &self.state)
            .finish_non_exhaustive()
    }
}

impl Physics {
    pub fn new(blueprint: &Blueprint, actuation: &dyn Actuation) -> Self {
        let engine = blueprint.engine();
        let mut state = engine.new_state();
        actuation.prepare(blueprint.model(), &mut state);
        state.params.clone_from(blueprint.params());
        Self {
            engine,
            state,
            base: blueprint.params().clone(),
        }
    }

    /// Checks that the vectors of the state, which a program may change, still fit the model.
    pub fn check_shape(&self) -> Result<(), EngineError> {
        self.engine.check_shape(&self.state)
    }

    /// Locks joints now and for later episodes.
    pub fn lock(&mut self, model: &Model, target: LockTarget<'_>, angle: f64) -> Result<LockReport, EnvError> {
        self.check_shape()?;
        let report = lock(model, &mut self.state.params, target, angle)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    /// Unlocks joints now and for later episodes.
    pub fn unlock(&mut self, model: &Model, target: LockTarget<'_>) -> Result<LockReport, EnvError> {
        self.check_shape()?;
        let report = unlock(model, &mut self.state.params, target)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    fn keep_locks(&mut self, model: &Model, report: &LockReport) {
        let now = &self.state.params;
        for e in report.changed.iter().filter_map(|&j| lock_of(model, j)) {
            self.base.eq_active[e] = now.eq_active[e];
            self.base.eq_offset[e] = now.eq_offset[e];
        }
    }
}
