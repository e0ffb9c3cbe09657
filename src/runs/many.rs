//! Training in a vector of environments, with one log.

use std::ops::Deref;

use super::logs::TrainingLog;
use super::training::{RunError, open_training_log};
use crate::config::Compat;
use crate::env::Blueprint;
use crate::vector::{AutoresetMode, VectorEnv, VectorError, VectorOptions, VectorStep};

/// A [`VectorEnv`] whose episodes are added to one training log as they end.
///
/// Episodes that end in the same step are logged in the order of their environments, so the log does not depend on the number of threads.
///
/// ```
/// use babybench::runs::RunVector;
/// use babybench::{Blueprint, Config, VectorOptions};
///
/// let save_dir = std::env::temp_dir().join("babybench_run_vector_example");
/// let config = Config {
///     save_dir: save_dir.display().to_string(),
///     touch_active: false,
///     vision_active: false,
///     max_episode_steps: 5,
///     ..Config::default()
/// };
/// let mut envs = RunVector::start(&Blueprint::new(config)?, 2, VectorOptions::default(), false)?;
/// let mut actions = Vec::new();
/// for _ in 0..15 {
///     envs.start_episodes()?;
///     envs.vector_mut().sample_actions(&mut actions)?;
///     envs.step(&actions)?;
/// }
/// envs.finish_training()?;
/// assert_eq!(babybench::runs::read_training(&save_dir)?.len(), 6);
/// # std::fs::remove_dir_all(&save_dir)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RunVector {
    vector: VectorEnv,
    log: TrainingLog,
    compat: Compat,
    /// The environments that start an episode.
    mask: Vec<bool>,
    ids: Vec<usize>,
}

impl Deref for RunVector {
    type Target = VectorEnv;

    fn deref(&self) -> &VectorEnv {
        &self.vector
    }
}

impl RunVector {
    /// Creates `n` environments for training: writes `scene.xml` and starts the training log, or resumes an existing one, as
    /// [`start_training`](super::start_training) does.
    ///
    /// # Errors
    /// As [`VectorEnv::new`], [`start_training`](super::start_training).
    pub fn start(blueprint: &Blueprint, n: usize, options: VectorOptions, resume: bool) -> Result<Self, RunError> {
        let options = VectorOptions {
            // episodes are logged at their end, which an automatic reset would hide
            autoreset: AutoresetMode::Disabled,
            ..options
        };
        let mut vector = VectorEnv::new(blueprint, n, options)?;
        // after the environments, whose errors must leave the log of an earlier run alone
        let log = open_training_log(blueprint, resume)?;
        // each MIMo who grows goes on at the age that he has reached
        let each = log.totals().steps / n as u64;
        for env in 0..n {
            vector.env_mut(env)?.set_earlier_steps(each);
        }
        let config = blueprint.config();
        Ok(Self {
            log,
            compat: config.compat,
            mask: vec![true; n],
            ids: (0..n).collect(),
            vector,
        })
    }

    /// Returns the log with the episodes so far.
    pub fn log(&self) -> &TrainingLog {
        &self.log
    }

    /// Returns the inner vector mutably; episodes reset through it are not logged.
    pub fn vector_mut(&mut self) -> &mut VectorEnv {
        &mut self.vector
    }

    /// Logs the episodes that are over, in the order of their environments, and starts the next ones. Their first observations are in
    /// [`VectorEnv::batch`]. Returns for each environment whether it started an episode.
    ///
    /// # Errors
    /// As [`VectorEnv::reset`]; a log that cannot be written.
    pub fn start_episodes(&mut self) -> Result<&[bool], RunError> {
        for env in 0..self.vector.len() {
            self.mask[env] = self.over(env)?;
            if self.mask[env] {
                self.log_episode(env)?;
            }
        }
        if self.mask.contains(&true) {
            self.vector.reset_where(&self.mask, None)?;
        }
        Ok(&self.mask)
    }

    /// Applies actions, (n, len), in the first n environments.
    ///
    /// # Errors
    /// As [`VectorEnv::step`]; a diverged environment that [`RunVector::start_episodes`] has not restarted.
    pub fn step(&mut self, actions: &[f32]) -> Result<VectorStep<'_>, RunError> {
        let len = self.vector.single_action_space().len().max(1);
        let n = actions.len() / len;
        // all of them, or a wrong length, which the vector refuses in its words
        if n == 0 || n >= self.vector.len() {
            return Ok(self.vector.step(actions)?);
        }
        // the last steps of a training may be fewer than there are environments
        self.vector.send(actions, &self.ids[..n])?;
        Ok(self.vector.recv(n)?)
    }

    fn over(&self, env: usize) -> Result<bool, VectorError> {
        let env = self.vector.env(env)?;
        // an environment that diverged needs a reset, too
        Ok(env.over() || !env.ready())
    }

    fn log_episode(&mut self, env: usize) -> Result<(), RunError> {
        let first = env == 0;
        let env = self.vector.env_mut(env)?;
        let steps = env.by_hand().end_episode();
        if steps > 0 || first {
            // the empty record of the kit's first reset appears once
            self.log.end_episode_of(steps, env.info())?;
        }
        Ok(())
    }

    /// Saves the training log. Under `compat: api` the running episodes end and are included; under `compat: reference` only finished
    /// ones are.
    ///
    /// # Errors
    /// Errors of the file system; environments in flight.
    pub fn finish_training(&mut self) -> Result<(), RunError> {
        for env in 0..self.vector.len() {
            if self.compat == Compat::Api || self.vector.env(env)?.over() {
                self.log_episode(env)?;
            }
        }
        Ok(self.log.save()?)
    }
}
