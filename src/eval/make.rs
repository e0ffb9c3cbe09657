//! Environments that log, as the kit's `make_env` makes them.

use std::path::Path;

use super::logs::TrainingLog;
use super::scene_file::{keep_scene, write_scene_from};
use crate::config::{Compat, Config};
use crate::env::{Blueprint, Env, EnvError};
use crate::mimo::embedded;
use crate::mjcf_loader::AssetSource;

/// An environment of a configuration, for training or for evaluation.
///
/// For training, the folder `save_dir` gets the complete scene (`scene.xml`) and, as episodes end, the training log, which
/// replaces an older one; [`Env::finish_training`] saves what is not yet in it. An environment for evaluation writes
/// nothing; under `compat: reference` its counters and lists go on from episode to episode, as the kit's do.
///
/// ```
/// use babybench::{Config, make_env};
///
/// let save_dir = std::env::temp_dir().join("babybench_make_env_example");
/// let config = Config {
///     save_dir: save_dir.display().to_string(),
///     touch_active: false,
///     vision_active: false,
///     max_episode_steps: 5,
///     ..Config::default()
/// };
/// let mut env = make_env(config, true)?;
/// let mut action = Vec::new();
/// for _episode in 0..3 {
///     env.reset(None)?;
///     loop {
///         env.sample_action(&mut action);
///         if env.step(&action)?.truncated {
///             break;
///         }
///     }
/// }
/// env.finish_training()?;
/// assert_eq!(babybench::eval::read_training(&save_dir)?.len(), 3);
/// # std::fs::remove_dir_all(&save_dir)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`Env::new`]; for training, files that cannot be written.
pub fn make_env(config: Config, training: bool) -> Result<Env, EnvError> {
    let blueprint = Blueprint::new(config)?;
    if training {
        start_training(&blueprint, false)
    } else {
        for_evaluation(&blueprint)
    }
}

/// An environment for training, of the embedded assets: writes `scene.xml` and starts the training log, or goes on with the
/// one that is there.
///
/// # Errors
/// Files that cannot be written; to go on, a log that is damaged or of another behavior, a scene with other bodies.
pub fn start_training(blueprint: &Blueprint, resume: bool) -> Result<Env, EnvError> {
    start_training_from(blueprint, &embedded(), resume)
}

/// [`start_training`] for a blueprint of other assets.
///
/// # Errors
/// As [`start_training`], and assets that are missing.
pub fn start_training_from(blueprint: &Blueprint, assets: &dyn AssetSource, resume: bool) -> Result<Env, EnvError> {
    let config = blueprint.config();
    let mut env = blueprint.env()?;
    let log = match resume {
        true => TrainingLog::resume(config)?,
        false => TrainingLog::create(config)?,
    };
    if resume {
        keep_scene(blueprint, assets)?;
    }
    write_scene_from(config, assets, Path::new(&config.save_dir))?;
    env.log_training(Some(log));
    Ok(env)
}

/// An environment that logs nothing; under `compat: reference`, information accumulates over episodes. The folder of a run
/// without training gets its scene from [`keep_scene`].
///
/// # Errors
/// As [`Blueprint::env`].
pub fn for_evaluation(blueprint: &Blueprint) -> Result<Env, EnvError> {
    let mut env = blueprint.env()?;
    env.accumulate_info(blueprint.config().compat == Compat::Reference);
    Ok(env)
}
