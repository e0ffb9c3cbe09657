//! Errors of scenes.

use thiserror::Error;

use super::{CustomSceneError, GrowthError};
use crate::mjcf_loader::LoadError;
use crate::physics::EngineError;

/// An error in making a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The assets cannot be read or compiled.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A custom scene breaks a rule.
    #[error(transparent)]
    CustomScene(#[from] CustomSceneError),
    /// MIMo cannot grow to the age of the configuration.
    #[error(transparent)]
    Growth(#[from] GrowthError),
    /// MIMo of that age has no pose that can be simulated.
    #[error(transparent)]
    Engine(#[from] EngineError),
}
