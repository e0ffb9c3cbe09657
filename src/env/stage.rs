//! The stages of a step, for timing.

use std::sync::Arc;

use crate::physics::Stage;

/// A stage of [`Env::step`](crate::Env::step).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EnvStage {
    /// From the action to controls and torques.
    Actuation,
    /// A stage of the physics steps.
    Physics(Stage),
    /// Observations and information.
    Senses,
}

impl EnvStage {
    /// Lists all stages, in the order of a step.
    pub fn all() -> impl Iterator<Item = Self> {
        let physics = Stage::ALL.into_iter().map(Self::Physics);
        std::iter::once(Self::Actuation)
            .chain(physics)
            .chain(std::iter::once(Self::Senses))
    }

    /// Returns a display name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Actuation => "actuation",
            Self::Physics(stage) => stage.name(),
            Self::Senses => "senses",
        }
    }
}

/// A function that is called when a stage starts, and with `None` when a step is done. It is for timing, because the library has no
/// clock.
pub type EnvProbe = Arc<dyn Fn(Option<EnvStage>) + Send + Sync>;
