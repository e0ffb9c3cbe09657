//! The engines that step a blueprint's environments.

use std::sync::Arc;

use super::EnvError;
use crate::config::{Compat, Config, EngineKind};
use crate::model::Model;
use crate::physics::{Engine, SoftModel, SoftOptions, State};
use crate::pool::Pool;
#[cfg(feature = "rapier")]
use crate::rapier::{RapierModel, RapierOptions};

/// The source of the engine that an environment steps with.
pub(crate) enum EngineSource<'a> {
    /// The environment's own engine, which a program requested or reads.
    Own(&'a mut dyn Engine),
    /// The engines that the environments of a blueprint share.
    Shared(&'a Engines),
}

impl EngineSource<'_> {
    /// Returns an engine that answers questions about the model.
    pub fn reader(&self) -> &dyn Engine {
        match self {
            Self::Own(engine) => &**engine,
            Self::Shared(engines) => engines.reader(),
        }
    }

    /// Lends an engine for some work.
    pub fn lend<R>(&mut self, work: impl FnOnce(&mut dyn Engine) -> R) -> R {
        match self {
            Self::Own(engine) => work(&mut **engine),
            Self::Shared(engines) => engines.lend(work),
        }
    }
}

/// The engines of a blueprint. They keep nothing from one step to the next, so environments share them: a thread that steps many environments has the
/// working memory of only one engine in its cache.
pub(crate) struct Engines {
    kind: EngineMaker,
    /// An engine that answers questions about the model and never steps.
    reader: Box<dyn Engine>,
    idle: Pool<Box<dyn Engine>>,
    /// Scratch states for the computed part of one environment of a vector at a time.
    states: Pool<Box<State>>,
}

impl std::fmt::Debug for Engines {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Engines").field(&self.kind).finish()
    }
}

impl Engines {
    pub fn new(config: &Config, model: &Arc<Model>) -> Result<Self, EnvError> {
        let kind = EngineMaker::new(config, model)?;
        Ok(Self {
            reader: kind.make(),
            idle: Pool::default(),
            states: Pool::default(),
            kind,
        })
    }

    /// Returns an engine that answers questions about the model.
    pub fn reader(&self) -> &dyn Engine {
        &*self.reader
    }

    /// Creates an engine for a caller to keep.
    pub fn make(&self) -> Box<dyn Engine> {
        self.kind.make()
    }

    /// Lends an engine for some work.
    pub fn lend<R>(&self, work: impl FnOnce(&mut dyn Engine) -> R) -> R {
        self.idle.lend(|| self.kind.make(), |engine| work(&mut **engine))
    }

    /// Takes a scratch state with unspecified contents.
    pub fn take_state(&self) -> Box<State> {
        let idle = self.states.take();
        idle.unwrap_or_else(|| self.reader.new_state().into())
    }

    /// Returns a scratch state of [`Engines::take_state`].
    pub fn put_state(&self, state: Box<State>) {
        self.states.put(state);
    }
}

/// A factory of engines of one kind for one model.
#[derive(Clone, Debug)]
enum EngineMaker {
    Soft(SoftModel),
    #[cfg(feature = "rapier")]
    Rapier(RapierModel),
}

impl EngineMaker {
    fn new(config: &Config, model: &Arc<Model>) -> Result<Self, EnvError> {
        let (model, double_weld_torque) = (model.clone(), config.compat == Compat::Reference);
        Ok(match config.engine {
            EngineKind::Soft => {
                let options = SoftOptions {
                    double_weld_torque,
                    // programs may read accelerations and wrenches of bodies, even if no sensor of the scene does
                    post_constraint: true,
                    ..SoftOptions::default()
                };
                Self::Soft(SoftModel::new(model, options))
            }
            #[cfg(feature = "rapier")]
            EngineKind::Rapier => {
                let options = RapierOptions {
                    double_weld_torque,
                    ..RapierOptions::default()
                };
                Self::Rapier(RapierModel::new(model, options)?)
            }
            #[cfg(not(feature = "rapier"))]
            EngineKind::Rapier => return Err(EnvError::NoRapier),
        })
    }

    fn make(&self) -> Box<dyn Engine> {
        match self {
            Self::Soft(shared) => Box::new(shared.engine()),
            #[cfg(feature = "rapier")]
            Self::Rapier(shared) => Box::new(shared.engine()),
        }
    }
}
