//! The physics of an environment: the state that engines advance, and the parameters that a reset restores.

use std::sync::Arc;

use crate::env::engines::{EngineSource, Engines};
use crate::env::env_state::{EngineCall, EnvState, LastEngineCall, ScratchUse};
use crate::env::{Blueprint, EnvError};
use crate::mimo::{LockReport, LockTarget, lock, lock_of, unlock};
use crate::model::Model;
use crate::physics::{Engine, EngineError, Params, Shared, State};

/// The state of a scene and the engines that advance it.
pub(super) struct Physics {
    /// The engines that all environments of the blueprint share.
    engines: Arc<Engines>,
    /// An engine of its own, on a program's request.
    own: Option<Box<dyn Engine>>,
    state: EnvState,
    /// Parameters after a reset: the blueprint's, with what locks and unlocks changed.
    pub base: Shared<Params>,
}

impl std::fmt::Debug for Physics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Physics")
            .field("state", &self.state)
            .finish_non_exhaustive()
    }
}

/// A copy shares the engines, whose memory changes no later step.
impl Clone for Physics {
    fn clone(&self) -> Self {
        Self {
            engines: self.engines.clone(),
            own: None,
            state: self.state.copy(&self.engines),
            base: self.base.clone(),
        }
    }
}

impl Physics {
    pub fn new(blueprint: &Blueprint) -> Self {
        let engines = blueprint.engines().clone();
        let mut state = engines.reader().new_state();
        blueprint.actuation().prepare(blueprint.model(), &mut state);
        // shared from the start, because copies into an own allocation would stay unshared
        state.params = blueprint.params().clone();
        Self {
            engines,
            own: None,
            state: EnvState::new(state),
            base: blueprint.params().clone(),
        }
    }

    /// Returns the state.
    pub fn state(&self) -> &State {
        self.state.get(&self.engines)
    }

    /// Returns the state, to change it.
    pub fn state_mut(&mut self) -> &mut State {
        self.state.parts(&self.engines).0
    }

    /// Returns the state, which may hold only what decides how the run continues.
    pub fn dynamic(&self) -> &State {
        self.state.dynamic()
    }

    /// Lets steps and resets work in scratch states from now on: see [`EnvState::share`].
    pub fn share(&mut self) {
        self.state.share();
    }

    /// Returns whether they do.
    pub fn shares(&self) -> bool {
        self.state.shares()
    }

    /// Takes a scratch state for a step or reset, if the environment shares: see [`EnvState::begin`].
    pub fn begin(&mut self, work: ScratchUse) {
        self.state.begin(work, &self.engines);
    }

    /// Gives it back.
    pub fn end(&mut self) {
        self.state.end(&self.engines);
    }

    /// Returns what a reader would get with other bits after the present step or reset: see [`EnvState::unshareable`].
    pub fn unshareable(&self) -> Option<&'static str> {
        self.state.unshareable(&self.engines)
    }

    /// Returns where steps get their engine from, the state that it advances, where its calls are noted, and the parameters of a reset.
    pub fn parts(
        &mut self,
    ) -> (
        EngineSource<'_>,
        &mut State,
        Option<&mut LastEngineCall>,
        &mut Shared<Params>,
    ) {
        let (state, last_call) = self.state.parts(&self.engines);
        let source = match &mut self.own {
            Some(own) => EngineSource::Own(&mut **own),
            None => EngineSource::Shared(&self.engines),
        };
        (source, state, last_call, &mut self.base)
    }

    /// Returns an engine that answers questions about the model.
    pub fn reader(&self) -> &dyn Engine {
        self.own.as_deref().unwrap_or_else(|| self.engines.reader())
    }

    /// Returns an engine of its own, with which the environment steps from now on.
    pub fn own_engine(&mut self) -> &mut dyn Engine {
        self.state.parts(&self.engines);
        &mut **self.own.get_or_insert_with(|| self.engines.make())
    }

    /// Switches to the engines of another model of the same sizes.
    pub fn use_engines(&mut self, engines: &Arc<Engines>) {
        // what those of the other model computed, these would compute differently
        self.state.parts(&self.engines);
        self.engines = engines.clone();
        if let Some(own) = &mut self.own {
            *own = self.engines.make();
        }
    }

    /// Computes everything that follows from the state.
    pub fn forward(&mut self) -> Result<(), EngineError> {
        let (mut engine, state, last_call, _) = self.parts();
        if let Some(last_call) = last_call {
            last_call.note(EngineCall::Forward, state);
        }
        engine.lend(|engine| engine.forward(state))
    }

    /// Checks that the vectors of the state, which programs may change, still fit the model.
    pub fn check_shape(&self) -> Result<(), EngineError> {
        self.reader().check_shape(self.state())
    }

    /// Locks joints now and for later episodes.
    pub fn lock(&mut self, model: &Model, target: LockTarget<'_>, angle: f64) -> Result<LockReport, EnvError> {
        self.check_shape()?;
        let report = lock(model, &mut self.state_mut().params, target, angle)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    /// Unlocks joints now and for later episodes.
    pub fn unlock(&mut self, model: &Model, target: LockTarget<'_>) -> Result<LockReport, EnvError> {
        self.check_shape()?;
        let report = unlock(model, &mut self.state_mut().params, target)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    fn keep_locks(&mut self, model: &Model, report: &LockReport) {
        let now = &self.state.dynamic().params;
        for e in report.changed.iter().filter_map(|&j| lock_of(model, j)) {
            self.base.eq_active[e] = now.eq_active[e];
            self.base.eq_offset[e] = now.eq_offset[e];
        }
    }
}
