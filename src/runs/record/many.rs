//! Records of vectors of environments.

use std::path::PathBuf;

use super::{RecordError, RecordOptions, Recorder};
use crate::vector::{AutoresetMode, VectorEnv, VectorStep};

/// Records all environments of a vector into one folder, with the same episodes as if each had run alone. The `e`-th episode of
/// environment `i` of `n` gets the number `n * e + i`.
///
/// ```
/// use babybench::runs::{Record, RecordOptions, VectorRecorder};
/// use babybench::{AutoresetMode, Blueprint, Config, VectorEnv, VectorOptions};
///
/// let dir = std::env::temp_dir().join(format!("babybench-records-{}", std::process::id()));
/// let blueprint = Blueprint::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
/// let mut envs = VectorEnv::new(&blueprint, 2, VectorOptions { autoreset: AutoresetMode::Disabled, ..VectorOptions::default() })?;
/// envs.reset(0)?;
/// let mut recorder = VectorRecorder::create(&dir, &envs, RecordOptions::default())?;
/// recorder.begin(&envs, 0)?;
/// for _ in 0..3 {
///     recorder.step(&mut envs, &[0.1; 2 * 44])?;
/// }
/// recorder.end(&envs)?;
/// let replayed = Record::open(&dir)?.replay(1, &mut blueprint.env()?)?;
/// assert_eq!((replayed.steps, replayed.first_difference), (3, None));
/// # std::fs::remove_dir_all(&dir)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct VectorRecorder {
    /// The recorder of each environment.
    each: Vec<Recorder>,
    /// For each environment, whether its episode was running before the step, and how many numbers its generator had drawn.
    before: Vec<Option<u64>>,
}

impl VectorRecorder {
    /// Creates the folder of a record, for a vector that does not reset its environments itself.
    ///
    /// # Errors
    /// As [`Recorder::create`]; [`RecordError::Autoreset`]; environments in flight.
    pub fn create(dir: impl Into<PathBuf>, envs: &VectorEnv, options: RecordOptions) -> Result<Self, RecordError> {
        // an episode that a step resets itself is gone before it can be recorded
        if envs.autoreset() != AutoresetMode::Disabled {
            return Err(RecordError::Autoreset);
        }
        let first = Recorder::create(dir, envs.env(0)?, options)?;
        Ok(Self {
            each: (0..envs.len()).map(|_| first.another()).collect(),
            before: Vec::new(),
        })
    }

    /// Starts recording an episode of each environment at the current moment, as [`Recorder::begin`] does.
    ///
    /// # Errors
    /// Environments in flight.
    pub fn begin(&mut self, envs: &VectorEnv, episode: u64) -> Result<(), RecordError> {
        let n = self.each.len() as u64;
        for ((i, recorder), number) in self.each.iter_mut().enumerate().zip(n.saturating_mul(episode)..) {
            recorder.begin(envs.env(i)?, number);
        }
        Ok(())
    }

    /// Applies actions, as [`VectorEnv::step`] does, and records the results. Environments whose episode is over, and those that diverge,
    /// record nothing more.
    ///
    /// # Errors
    /// As [`VectorEnv::step`] and [`VectorEnv::look`]; no episode has begun.
    pub fn step<'v>(&mut self, envs: &'v mut VectorEnv, actions: &[f32]) -> Result<VectorStep<'v>, RecordError> {
        self.before.clear();
        for i in 0..self.each.len() {
            let env = envs.env(i)?;
            self.before.push((!env.over()).then(|| env.drawn()));
        }
        envs.step(actions)?;
        // checksums include images
        envs.look()?;
        // the step has checked the length
        let len = actions.len() / envs.len();
        for (i, (recorder, before)) in self.each.iter_mut().zip(&self.before).enumerate() {
            let env = envs.env(i)?;
            if let Some(drawn) = before.filter(|_| env.ready()) {
                recorder.push(env, &actions[i * len..][..len], drawn)?;
            }
        }
        Ok(envs.batch())
    }

    /// Ends the episodes, as [`Recorder::end`] does.
    ///
    /// # Errors
    /// Errors of the file system; environments in flight.
    pub fn end(&mut self, envs: &VectorEnv) -> Result<(), RecordError> {
        let mut each = self.each.iter_mut().enumerate();
        each.try_for_each(|(i, recorder)| recorder.end(envs.env(i)?))
    }
}
