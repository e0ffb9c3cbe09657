//! The physics of an environment: the state that engines advance, and the parameters that a reset restores.

use std::sync::Arc;

use crate::actuation::Actuation;
use crate::env::engines::{EngineSource, Engines};
use crate::env::{Blueprint, EnvError};
use crate::mimo::{LockReport, LockTarget, lock, lock_of, unlock};
use crate::model::Model;
use crate::physics::{Engine, EngineError, Params, State};

/// The state of a scene, and what advances it.
pub(super) struct Physics {
    /// Those that all environments of the blueprint share.
    engines: Arc<Engines>,
    /// An engine of its own, for a program that asked for it.
    own: Option<Box<dyn Engine>>,
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

/// A copy shares the engines, which remember nothing that changes a later step.
impl Clone for Physics {
    fn clone(&self) -> Self {
        Self {
            engines: self.engines.clone(),
            own: None,
            state: self.state.clone(),
            base: self.base.clone(),
        }
    }
}

impl Physics {
    pub fn new(blueprint: &Blueprint, actuation: &dyn Actuation) -> Self {
        let engines = blueprint.engines().clone();
        let mut state = engines.reader().new_state();
        actuation.prepare(blueprint.model(), &mut state);
        state.params.clone_from(blueprint.params());
        Self {
            engines,
            own: None,
            state,
            base: blueprint.params().clone(),
        }
    }

    /// Returns where steps get their engine from, the state that it advances, and the parameters of a reset.
    pub fn parts(&mut self) -> (EngineSource<'_>, &mut State, &mut Params) {
        let source = match &mut self.own {
            Some(own) => EngineSource::Own(&mut **own),
            None => EngineSource::Shared(&self.engines),
        };
        (source, &mut self.state, &mut self.base)
    }

    /// Returns an engine that tells what follows from the model.
    pub fn reader(&self) -> &dyn Engine {
        self.own.as_deref().unwrap_or_else(|| self.engines.reader())
    }

    /// Returns an engine of its own, with which the environment goes on from now on.
    pub fn own_engine(&mut self) -> &mut dyn Engine {
        &mut **self.own.get_or_insert_with(|| self.engines.make())
    }

    /// Goes on with the engines of another model of the same sizes.
    pub fn use_engines(&mut self, engines: &Arc<Engines>) {
        self.engines = engines.clone();
        if let Some(own) = &mut self.own {
            *own = self.engines.make();
        }
    }

    /// Computes everything that follows from the state.
    pub fn forward(&mut self) -> Result<(), EngineError> {
        let (mut engine, state, _) = self.parts();
        engine.lend(|engine| engine.forward(state))
    }

    /// Checks that the vectors of the state, which a program may change, still fit the model.
    pub fn check_shape(&self) -> Result<(), EngineError> {
        self.reader().check_shape(&self.state)
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
