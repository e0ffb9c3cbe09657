//! Evaluation of a training run and of a learned policy.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::film::{Film, FilmError, RoomFilm};
use super::scores::{MAX_EPISODES, Score, ScoreError};
use crate::config::Compat;
use crate::env::Env;
use crate::formats::avi::DEFAULT_FPS;
use crate::runs::logs::{EvaluationLog, LogError, read_recent, training_path};
use crate::runs::scene_compat;

/// An error of an evaluation.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// A log cannot be read or written.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The training log has no score.
    #[error("{}: {source}", path.display())]
    Score {
        /// The log.
        path: PathBuf,
        /// The cause.
        source: ScoreError,
    },
    /// The training log is of another behavior.
    #[error(
        "{}: the log is for behavior {found}, but the environment's behavior is {expected}; set save_dir to the folder \
         of a run with behavior {expected}, or to a new one", path.display()
    )]
    Behavior {
        /// The log.
        path: PathBuf,
        /// Its behavior.
        found: String,
        /// The environment's.
        expected: String,
    },
    /// An episode ends without steps.
    #[error("evaluation episode {episode} has no steps: call eval_step after every step of the environment")]
    NoSteps {
        /// The episode.
        episode: u64,
    },
    /// The video cannot be written.
    #[error("cannot make the video {}: {source}", path.display())]
    Video {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: FilmError,
    },
}

/// Returns the score of the training log in the folder of a run, by the rule of the configuration in its scene ([`Score::counted`]), or by that of
/// `compat: api` if there is none.
///
/// # Errors
/// A log that is missing, damaged, or without a score.
pub fn eval_logs(save_dir: impl AsRef<Path>) -> Result<Score, EvaluationError> {
    let compat = scene_compat(save_dir.as_ref());
    score(training_path(save_dir), None, compat)
}

/// Returns the score of a training log, which must be of the given behavior, if any.
fn score(path: PathBuf, behavior: Option<&str>, compat: Compat) -> Result<Score, EvaluationError> {
    // under compat: reference the oldest never counts
    let records = read_recent(&path, MAX_EPISODES + 1)?.records;
    let found = records.first().map(|r| r.behavior.name());
    match (found, behavior) {
        (Some(found), Some(expected)) if found != expected => {
            let [found, expected] = [found, expected].map(str::to_string);
            Err(EvaluationError::Behavior { path, found, expected })
        }
        _ => Score::new(&records, compat).map_err(|source| EvaluationError::Score { path, source }),
    }
}

/// Evaluates a behavior: the training log, and episodes with a learned policy.
///
/// ```
/// use babybench::eval::Evaluation;
/// use babybench::{Config, make_env};
/// # let save_dir = std::env::temp_dir().join("babybench_evaluation_example").display().to_string();
///
/// let text = "behavior: self_touch\nscene: crib\ntouch_active: False\nvision_active: False\nmax_episode_steps: 5";
/// let config = Config { save_dir, ..Config::from_yaml(text, "my.yml")? };
/// let mut env = make_env(config, false)?;
/// let mut evaluation = Evaluation::new(&env);
/// let mut action = Vec::new();
///
/// env.reset(Some(0))?;
/// loop {
///     env.sample_action(&mut action); // here goes the policy
///     let truncated = env.step(&action)?.truncated;
///     evaluation.eval_step(&env)?;
///     if truncated {
///         break;
///     }
/// }
/// let log = evaluation.end(0)?;
/// assert!(log.ends_with("logs/evaluation_0.pkl"));
/// # std::fs::remove_dir_all(&env.config().save_dir)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Evaluation<'f> {
    /// The name of the behavior or the task.
    behavior: String,
    compat: Compat,
    save_dir: PathBuf,
    log: EvaluationLog,
    film: Option<Box<dyn Film + 'f>>,
}

impl std::fmt::Debug for Evaluation<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Evaluation")
            .field("behavior", &self.behavior)
            .field("save_dir", &self.save_dir)
            .finish_non_exhaustive()
    }
}

impl<'f> Evaluation<'f> {
    /// Starts an evaluation without video, into the `save_dir` of the environment's configuration.
    pub fn new(env: &Env) -> Self {
        Self {
            behavior: env.info().behavior.name().to_string(),
            compat: env.config().compat,
            save_dir: PathBuf::from(&env.config().save_dir),
            log: EvaluationLog::default(),
            film: None,
        }
    }

    /// Adds a user-defined film, written to `videos/evaluation_N.avi`.
    #[must_use]
    pub fn with_film(mut self, film: impl Film + 'f) -> Self {
        self.film = Some(Box::new(film));
        self
    }

    /// Adds videos of the room and of the behavior's subject ([`RoomFilm`]), `videos/evaluation_N.avi`.
    ///
    /// # Errors
    /// As [`RoomFilm::new`].
    pub fn with_video(self, env: &Env) -> Result<Self, EvaluationError> {
        self.with_video_at(env, DEFAULT_FPS)
    }

    /// Adds videos with a given number of frames per second; see [`Evaluation::with_video`].
    ///
    /// # Errors
    /// As [`RoomFilm::new`].
    pub fn with_video_at(self, env: &Env, fps: u32) -> Result<Self, EvaluationError> {
        let path = self.save_dir.join("videos");
        match RoomFilm::new(env, &path) {
            Ok(film) => Ok(self.with_film(film.with_fps(fps))),
            Err(source) => Err(EvaluationError::Video { path, source }),
        }
    }

    /// Sets another folder for the results; call it before [`Evaluation::with_video`].
    #[must_use]
    pub fn with_save_dir(mut self, save_dir: impl Into<PathBuf>) -> Self {
        self.save_dir = save_dir.into();
        self
    }

    /// Returns the path of the video of an episode.
    pub fn video_path(&self, episode: u64) -> PathBuf {
        self.save_dir.join("videos").join(format!("evaluation_{episode}.avi"))
    }

    /// Returns the score of the training log.
    ///
    /// # Errors
    /// A log that is missing, damaged, of another behavior, or without a score.
    pub fn eval_logs(&self) -> Result<Score, EvaluationError> {
        score(training_path(&self.save_dir), Some(&self.behavior), self.compat)
    }

    /// Discards the steps since the end of the last episode.
    pub fn reset(&mut self) {
        self.log = EvaluationLog::default();
        if let Some(film) = &mut self.film {
            film.discard();
        }
    }

    /// Records a step of the environment: positions, information and, for a video, a frame.
    ///
    /// # Errors
    /// Errors of the video.
    pub fn eval_step(&mut self, env: &Env) -> Result<(), EvaluationError> {
        if let Some(film) = &mut self.film {
            film.frame(env).map_err(|source| {
                let path = self.save_dir.join("videos");
                EvaluationError::Video { path, source }
            })?;
        }
        self.log.push(&env.state().qpos, env.info());
        Ok(())
    }

    /// Ends an episode: writes `logs/evaluation_N.pkl`, the same as `.npz` with the feature `npz`, and the video.
    /// Returns the path of the log.
    ///
    /// # Errors
    /// Errors of the file system; no steps since the last end.
    pub fn end(&mut self, episode: u64) -> Result<PathBuf, EvaluationError> {
        let log = std::mem::take(&mut self.log);
        if log.is_empty() {
            return Err(EvaluationError::NoSteps { episode });
        }
        let written = log.write(&self.save_dir, episode)?;
        let path = self.video_path(episode);
        if let Some(film) = &mut self.film {
            let folder = self.save_dir.join("videos");
            let done = std::fs::create_dir_all(folder).map_err(FilmError::from);
            if let Err(source) = done.and_then(|()| film.end(&path)) {
                return Err(EvaluationError::Video { path, source });
            }
        }
        Ok(written)
    }
}
