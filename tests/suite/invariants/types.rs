//! Properties of types that programs rely on when they are compiled.

use babybench::actuation::Actuation;
use babybench::env::{EnvError, Snapshot, SnapshotError};
use babybench::eval::{EvaluationError, ScoreError};
use babybench::mjcf_loader::LoadError;
use babybench::physics::{Engine, EngineError, Params, SoftEngine, State};
use babybench::policy::PolicyError;
#[cfg(feature = "rapier")]
use babybench::rapier::{RapierEngine, RapierModel, RapierScene};
use babybench::render::{CpuRenderer, RenderError, Renderer, Scenery};
use babybench::runs::LogError;
use babybench::sensors::transform::Transform;
use babybench::sensors::{Pain, Proprioception, SkinLayout, SkinValues, Touch, Vestibular, Vision};
use babybench::spaces::{BoxSpace, NumpyRng};
use babybench::vector::VectorError;
use babybench::{Blueprint, Config, Env, Info, Model, VectorEnv};

fn moves<T: Send + 'static>() {}

fn is_shared<T: Send + Sync + 'static>() {}

/// An error that `anyhow` and `Box<dyn Error + Send + Sync>` take.
fn is_error<T: std::error::Error + Send + Sync + 'static>() {}

#[test]
fn environments_move_between_threads() {
    moves::<Env>();
    moves::<VectorEnv>();
    moves::<SoftEngine>();
    #[cfg(feature = "rapier")]
    moves::<RapierEngine>();
}

#[test]
fn what_environments_share_is_shared_between_threads() {
    is_shared::<Blueprint>();
    is_shared::<Config>();
    is_shared::<Model>();
    is_shared::<State>();
    is_shared::<Params>();
    #[cfg(feature = "rapier")]
    is_shared::<RapierModel>();
    #[cfg(feature = "rapier")]
    is_shared::<RapierScene>();
    is_shared::<Snapshot>();
    is_shared::<Info>();
    is_shared::<BoxSpace>();
    is_shared::<NumpyRng>();
    is_shared::<Scenery>();
    is_shared::<CpuRenderer>();
    is_shared::<Renderer>();
    is_shared::<Proprioception>();
    is_shared::<SkinLayout>();
    is_shared::<Touch>();
    is_shared::<SkinValues>();
    is_shared::<Pain>();
    is_shared::<Box<dyn Transform>>();
    is_shared::<Vestibular>();
    is_shared::<Vision>();
    is_shared::<Env>();
    is_shared::<Box<dyn Engine>>();
    is_shared::<Box<dyn Actuation>>();
}

#[test]
fn errors_fit_the_usual_boxes() {
    is_error::<EnvError>();
    is_error::<VectorError>();
    is_error::<EngineError>();
    is_error::<LoadError>();
    is_error::<RenderError>();
    is_error::<SnapshotError>();
    is_error::<LogError>();
    is_error::<ScoreError>();
    #[cfg(feature = "npz")]
    is_error::<babybench::runs::ReplayError>();
    is_error::<PolicyError>();
    is_error::<EvaluationError>();
}
