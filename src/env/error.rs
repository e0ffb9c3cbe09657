//! Errors of environments.

use thiserror::Error;

use super::{ModelChangeError, PathError, SnapshotError};
use crate::actuation::ActuationError;
use crate::config::ConfigError;
use crate::mimo::{CustomSceneError, GrowthError, LockError, SceneError};
use crate::mjcf_loader::LoadError;
use crate::physics::EngineError;
#[cfg(feature = "rapier")]
use crate::rapier::RapierError;
use crate::render::RenderError;
use crate::sensors::touch::SkinError;
use crate::sensors::transform::Sense;

/// An error in building, resetting or stepping an environment.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EnvError {
    /// The configuration is invalid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The assets cannot be loaded.
    #[error("cannot load the scene: {0}")]
    Load(#[from] LoadError),
    /// A custom scene breaks a rule.
    #[error(transparent)]
    CustomScene(#[from] CustomSceneError),
    /// The paths in the configuration cannot be read, or name bodies that the scene does not have.
    #[error(transparent)]
    MocapMotion(#[from] PathError),
    /// MIMo cannot grow to the age of the configuration.
    #[error(transparent)]
    Growth(#[from] GrowthError),
    /// The touch sensors cannot be placed.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// The scene cannot be drawn.
    #[error("cannot draw the scene: {0}")]
    Render(#[from] RenderError),
    /// A program uses the eyes while vision is off.
    #[error("vision is off: set vision_active to True")]
    NoVision,
    /// A program adds a transform to a sense that is not observed.
    #[error("{} is off, so nothing can transform it: set `{}` to True", .sense.key(), .sense.switch())]
    SenseOff {
        /// The sense.
        sense: Sense,
    },
    /// An actuator does not fit the actuation model.
    #[error(transparent)]
    Actuation(#[from] ActuationError),
    /// A joint or part cannot be locked or unlocked.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// A snapshot cannot be restored.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// The model cannot be changed in this way.
    #[error(transparent)]
    ModelChange(#[from] ModelChangeError),
    /// The configuration selects the engine `rapier`, which is not part of this build.
    #[error("engine: rapier needs the cargo feature rapier: build with `--features rapier`, or use engine: soft")]
    NoRapier,
    /// The engine that the configuration selects cannot simulate the scene.
    #[cfg(feature = "rapier")]
    #[error(transparent)]
    Rapier(#[from] RapierError),
    /// The scene lacks something the environment needs.
    #[error("the scene has no {what} named {name:?}, which {purpose} needs")]
    Missing {
        /// Kind of element.
        what: &'static str,
        /// Its name.
        name: String,
        /// The part that needs it.
        purpose: &'static str,
    },
    /// An action has the wrong length.
    #[error("the action has {found} values but the action space has {expected}")]
    ActionLength {
        /// Length found.
        found: usize,
        /// Length of the action space.
        expected: usize,
    },
    /// An action is not finite.
    #[error("action[{index}] ({actuator}) is {value}: actions must be finite")]
    ActionNotFinite {
        /// Index in the action.
        index: usize,
        /// The actuator of this number.
        actuator: String,
        /// The value.
        value: f32,
    },
    /// A state has a wrong length or numbers that are not finite.
    #[error("{what} has {found} values but the model needs {expected}")]
    StateLength {
        /// Name of the vector.
        what: &'static str,
        /// Length found.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// A task in a vector changed more than [`Task::only_moves`](crate::env::Task::only_moves) allows, which tests and debug builds detect.
    #[error(
        "the task {task:?} says that it only moves things, but a vector would return another {what} for it: return false from only_moves, \
         or change forces, controls and parameters before the physics of a step or reset, and read nothing computed before a reset"
    )]
    OnlyMoves {
        /// Name of the task.
        task: String,
        /// Quantity that would be wrong.
        what: &'static str,
    },
    /// A program changes something that a MIMo with a schedule of ages would lose at the next age.
    #[error(
        "MIMo grows by `age_schedule`, which makes his model anew at each age, so a program cannot change his {what}: leave the schedule out"
    )]
    Schedule {
        /// The subject of the change.
        what: &'static str,
    },
    /// The spaces at an age of the schedule differ from the earlier ones.
    #[error("MIMo cannot grow to {age} months by `age_schedule`: {what} would be {after} instead of {before}")]
    Spaces {
        /// The age, months.
        age: f64,
        /// The space.
        what: String,
        /// Its shape or bounds until now.
        before: String,
        /// Its shape or bounds at the age.
        after: String,
    },
    /// `step` before the first `reset`.
    #[error("call reset before step")]
    NotReset,
    /// The engine cannot continue.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

impl From<SceneError> for EnvError {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Load(error) => error.into(),
            SceneError::CustomScene(error) => error.into(),
            SceneError::Growth(error) => error.into(),
            SceneError::Engine(error) => error.into(),
        }
    }
}
