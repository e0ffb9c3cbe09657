//! Environments that log their episodes, like those of the kit's `make_env`.

use std::ops::Deref;

use thiserror::Error;

use super::logs::{LogError, TrainingLog};
use super::scene_file::{SceneFileError, keep_scene, write_scene_of};
use crate::config::{Behavior, Compat, Config};
use crate::env::{Blueprint, Env, EnvError, Observation, PartNames, Step, reports_outcome};
use crate::vector::VectorError;

/// An error that prevents a run from starting or continuing.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The environment returned an error.
    #[error(transparent)]
    Env(#[from] EnvError),
    /// The vector of environments returned an error.
    #[error(transparent)]
    Vector(#[from] VectorError),
    /// The log cannot be read or written.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The scene cannot be written, or the folder holds a different one.
    #[error(transparent)]
    SceneFile(#[from] SceneFileError),
}

/// An [`Env`] that adds its episodes to a training log, if it has one, as they end.
///
/// It dereferences to the [`Env`]. Changes go through [`RunEnv::reset`] and [`RunEnv::step`], so that no episode is lost.
#[derive(Debug)]
pub struct RunEnv {
    env: Env,
    log: Option<TrainingLog>,
}

impl Deref for RunEnv {
    type Target = Env;

    fn deref(&self) -> &Env {
        &self.env
    }
}

impl RunEnv {
    /// Adds a training log, or none, to an environment.
    pub fn new(env: Env, log: Option<TrainingLog>) -> Self {
        let names = (env.config().behavior == Behavior::SelfTouch).then(|| PartNames::new(env.model()));
        let log = log.map(|log| log.with_names(names));
        Self { env, log }
    }

    /// Logs the current episode and starts the next one: see [`Env::reset`].
    ///
    /// # Errors
    /// As [`Env::reset`]; a log that cannot be written.
    pub fn reset(&mut self, seed: Option<u64>) -> Result<Observation<'_>, RunError> {
        self.log_episode()?;
        Ok(self.env.reset(seed)?)
    }

    /// Applies an action: see [`Env::step`].
    ///
    /// # Errors
    /// As [`Env::step`].
    pub fn step(&mut self, action: &[f32]) -> Result<Step<'_>, EnvError> {
        self.env.step(action)
    }

    /// Fills `action` with a random action: see [`Env::sample_action`].
    pub fn sample_action(&mut self, action: &mut Vec<f32>) {
        self.env.sample_action(action);
    }

    /// Seeds the random actions: see [`ManualControl::seed_action_space`](crate::env::ManualControl::seed_action_space).
    pub fn seed_action_space(&mut self, seed: u64) {
        self.env.by_hand().seed_action_space(seed);
    }

    /// Returns the inner environment mutably; episodes reset through it are not logged.
    pub fn env_mut(&mut self) -> &mut Env {
        &mut self.env
    }

    /// Returns the log with the episodes so far, if this environment logs.
    pub fn log(&self) -> Option<&TrainingLog> {
        self.log.as_ref()
    }

    /// Saves the training log. Under `compat: api` the running episode ends and is included. Without a log this has no effect.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn finish_training(&mut self) -> Result<(), LogError> {
        // the kit's code loses the episode that runs when a training ends
        if self.log.is_some() && self.env.config().compat == Compat::Api {
            self.log_episode()?;
        }
        self.log.as_ref().map_or(Ok(()), TrainingLog::save)
    }

    fn log_episode(&mut self) -> Result<(), LogError> {
        // before the record is made, so that an environment whose log cannot be written does not go on in this episode
        let steps = self.env.by_hand().end_episode();
        match &mut self.log {
            Some(log) => log.end_episode_of(steps, self.env.info()),
            None => Ok(()),
        }
    }
}

/// Creates the environment of a configuration, for training or for evaluation.
///
/// For training, the folder `save_dir` gets the complete scene (`scene.xml`) and, as episodes end, the training log, which replaces an
/// older one. [`RunEnv::finish_training`] saves the rest. An environment for evaluation writes nothing. Under `compat: reference` its
/// counters and lists continue from episode to episode, as the kit's do.
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
/// assert_eq!(babybench::runs::read_training(&save_dir)?.len(), 3);
/// # std::fs::remove_dir_all(&save_dir)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`Env::new`]; for training, files that cannot be written.
pub fn make_env(config: Config, training: bool) -> Result<RunEnv, RunError> {
    let blueprint = Blueprint::new(config)?;
    if training {
        start_training(&blueprint, false)
    } else {
        Ok(RunEnv::new(for_evaluation(&blueprint)?, None))
    }
}

/// Creates an environment for training: writes `scene.xml` and starts the training log, or resumes an existing one.
///
/// # Errors
/// Files that cannot be written; when resuming, a log that is damaged or of another behavior, or a scene with other bodies.
pub fn start_training(blueprint: &Blueprint, resume: bool) -> Result<RunEnv, RunError> {
    let mut env = blueprint.env()?;
    // after the environment, whose errors must leave the log of an earlier run alone
    let log = open_training_log(blueprint, resume)?;
    // a MIMo who grows goes on at the age that he has reached
    env.set_earlier_steps(log.totals().steps);
    Ok(RunEnv::new(env, Some(log)))
}

/// Returns the names of the parts that can be touched, if touches are logged.
fn part_names(blueprint: &Blueprint) -> Option<PartNames> {
    (blueprint.config().behavior == Behavior::SelfTouch).then(|| PartNames::new(blueprint.model()))
}

/// Starts the training log in the configuration's `save_dir`, or resumes an existing one, and writes the scene next to it.
pub(super) fn open_training_log(blueprint: &Blueprint, resume: bool) -> Result<TrainingLog, RunError> {
    let config = blueprint.config();
    let names = part_names(blueprint);
    let log = if resume {
        TrainingLog::resume_with(config, names)?
    } else {
        TrainingLog::create(config)?.with_names(names)
    };
    if resume {
        let task = blueprint.task();
        // records of BabyBench's behaviors differ in their keys, which reading checks; those of tasks differ in a name
        if reports_outcome(task) {
            log.check_task(task.name())?;
        }
        keep_scene(blueprint)?;
    }
    // after the log, which refuses a folder that belongs to another run
    write_scene_of(blueprint)?;
    Ok(log)
}

/// Creates an environment that logs nothing; under `compat: reference`, information accumulates over episodes. The
/// folder of a run without training gets its scene from [`keep_scene`].
///
/// # Errors
/// As [`Blueprint::env`].
pub fn for_evaluation(blueprint: &Blueprint) -> Result<Env, EnvError> {
    let mut env = blueprint.env()?;
    env.by_hand()
        // the kit's evaluation counts on from episode to episode
        .accumulate_info(blueprint.config().compat == Compat::Reference);
    Ok(env)
}
