//! The physics of an environment: an engine, the state that it advances, and the parameters that a reset restores.

use crate::actuation::Actuation;
use crate::config::Compat;
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

    /// Forgets the past: `qpos0` at rest, of which nothing is computed.
    pub fn reset(&mut self, model: &Model) {
        let s = &mut self.state;
        s.time = 0.0;
        s.step = 0;
        s.ctrl.fill(0.0);
        s.qfrc_applied.fill(0.0);
        s.release_forces();
        s.qacc_warmstart.fill(0.0);
        s.params.clone_from(&self.base);
        s.qpos.copy_from_slice(&model.qpos0);
        s.qvel.fill(0.0);
    }

    /// Forgets the past and computes everything at the given positions and velocities.
    pub fn place(
        &mut self,
        model: &Model,
        compat: Compat,
        actuation: &dyn Actuation,
        qpos: &[f64],
        qvel: &[f64],
    ) -> Result<(), EngineError> {
        self.reset(model);
        let s = &mut self.state;
        if compat == Compat::Reference {
            // the reference resets its actuators before it sets the state
            actuation.reset(model, s);
        }
        s.qpos.copy_from_slice(qpos);
        s.qvel.copy_from_slice(qvel);
        if compat == Compat::Api {
            actuation.reset(model, s);
        }
        self.engine.forward(s)
    }

    /// Applies an action, which has the length of the action space, for `frame_skip` physics steps.
    pub fn step(
        &mut self,
        model: &Model,
        actuation: &dyn Actuation,
        action: &[f32],
        frame_skip: u32,
    ) -> Result<(), EngineError> {
        actuation.set_action(model, &mut self.state, action);
        for k in 0..frame_skip {
            if k > 0 {
                actuation.substep(model, &mut self.state);
            }
            self.engine.step(&mut self.state)?;
        }
        Ok(())
    }

    /// Locks joints now and for later episodes.
    pub fn lock(&mut self, model: &Model, target: LockTarget<'_>, angle: f64) -> Result<LockReport, EnvError> {
        let report = lock(model, &mut self.state.params, target, angle)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    /// Unlocks joints now and for later episodes.
    pub fn unlock(&mut self, model: &Model, target: LockTarget<'_>) -> Result<LockReport, EnvError> {
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
