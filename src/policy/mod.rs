//! Policies, which choose the actions of an evaluation.

mod babbling;
mod command;
#[cfg(feature = "onnx")]
mod onnx;
mod protocol;
mod watching;

use std::path::{Path, PathBuf};
use std::time::Duration;

pub use babbling::BabblingPolicy;
pub use command::CommandPolicy;
pub use command::DEFAULT_LIMIT;
#[cfg(fuzzing)]
pub use command::answers;
#[cfg(feature = "onnx")]
pub use onnx::OnnxError;
#[cfg(feature = "onnx")]
pub use onnx::OnnxPolicy;
use thiserror::Error;
pub use watching::WatchingPolicy;

use crate::env::Env;
use crate::spaces::{ActionNoise, Noise, NoiseError};

/// An error of a policy.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PolicyError {
    /// The noise needs an age.
    #[error(transparent)]
    Noise(#[from] NoiseError),
    /// The command cannot be started.
    #[error(
        "cannot start the policy {command:?}: {source}; a policy is random, zero, held, ou, pink, color:0.69, color_by_age, oscillators, babbling, watching, an \
         .onnx file, or a command with its arguments"
    )]
    Start {
        /// The command.
        command: String,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The command cannot be split into words.
    #[error("cannot start the policy {command:?}: {reason}")]
    Words {
        /// The command.
        command: String,
        /// Description of the fault.
        reason: &'static str,
    },
    /// The command ended.
    #[error("the policy {command:?} ended ({status}) {when}")]
    Ended {
        /// The command.
        command: String,
        /// Its exit status.
        status: String,
        /// The episode and the step.
        when: EvaluationStep,
    },
    /// The command did not answer.
    #[error(
        "the policy {command:?} gave no action within {seconds} s {when}; raise --policy-timeout for a slow policy"
    )]
    Timeout {
        /// The command.
        command: String,
        /// The time limit, s.
        seconds: f64,
        /// The episode and the step.
        when: EvaluationStep,
    },
    /// The command's answer was not an action.
    #[error(
        "the policy {command:?} answered {answer:?} {when}: {reason}; it must write one line per observation to its \
         standard output, a JSON list of {expected} numbers; anything else belongs on its standard error"
    )]
    Answer {
        /// The command.
        command: String,
        /// The start of its answer.
        answer: String,
        /// Description of the fault.
        reason: String,
        /// Length of an action.
        expected: usize,
        /// The episode and the step.
        when: EvaluationStep,
    },
    /// The model does not fit.
    #[cfg(feature = "onnx")]
    #[error("{}: {source}", path.display())]
    Onnx {
        /// The file.
        path: PathBuf,
        /// Description of the fault.
        source: OnnxError,
    },
    /// The policy is a model, but the feature `onnx` is off.
    #[error(
        "{}: this program was built without ONNX; build it with `cargo build --release --features onnx`, or with \
         `--features babybench/onnx` from another project", path.display()
    )]
    NoOnnx {
        /// The file.
        path: PathBuf,
    },
    /// A user-defined policy failed.
    #[error(transparent)]
    Other(Box<dyn std::error::Error + Send + Sync>),
}

/// A moment of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EvaluationStep {
    /// Number of the episode in the evaluation, from 0.
    pub episode: u64,
    /// Steps before this one in the episode.
    pub step: u64,
}

impl std::fmt::Display for EvaluationStep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "at step {} of episode {}", self.step, self.episode)
    }
}

/// Chooses actions.
pub trait Policy: Send {
    /// Starts an episode, after the environment was reset. `episode` is its number in the evaluation, from 0. If episodes run in
    /// parallel, a policy gets only some of them.
    ///
    /// # Errors
    /// The policy cannot continue.
    fn begin(&mut self, env: &mut Env, episode: u64) -> Result<(), PolicyError> {
        let _ = (env, episode);
        Ok(())
    }

    /// Writes the action for the environment's current observation into `action`.
    ///
    /// # Errors
    /// The policy cannot continue.
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError>;

    /// Ends learning: from now on the policy uses what it has learned, without exploring. Most policies do not learn.
    fn settle(&mut self) {}
}

/// A policy of random actions, drawn from the environment's generator.
#[derive(Clone, Copy, Debug, Default)]
pub struct RandomPolicy;

impl Policy for RandomPolicy {
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        env.sample_action(action);
        Ok(())
    }
}

/// A policy whose action is always 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct ZeroPolicy;

impl Policy for ZeroPolicy {
    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        action.clear();
        action.resize(env.action_space().len(), 0.0);
        Ok(())
    }
}

/// A policy that ignores observations: an [`ActionNoise`] whose seed is drawn from the environment's generator at the start of an
/// episode.
#[derive(Clone, Debug)]
pub struct NoisePolicy {
    noise: Noise,
    running: Option<ActionNoise>,
}

impl NoisePolicy {
    /// Creates the policy of a noise.
    pub fn new(noise: Noise) -> Self {
        Self { noise, running: None }
    }
}

impl Policy for NoisePolicy {
    fn begin(&mut self, env: &mut Env, _episode: u64) -> Result<(), PolicyError> {
        let seed = env.draw_seed();
        let noise = self.noise.at_age(env.config().age)?;
        self.running = Some(ActionNoise::new(noise, env.action_space(), env.blueprint().dt(), seed));
        Ok(())
    }

    fn act(&mut self, env: &mut Env, action: &mut Vec<f32>) -> Result<(), PolicyError> {
        if self.running.is_none() {
            self.begin(env, 0)?;
        }
        if let Some(running) = &mut self.running {
            running.sample(action);
        }
        Ok(())
    }
}

/// A policy, as named on the command line.
#[derive(Clone, Debug, PartialEq)]
pub enum PolicySource {
    /// `random`
    Random,
    /// `zero`
    Zero,
    /// A correlated noise: `held`, `ou`, `pink`, `color`, `color_by_age` or `oscillators`.
    Noise(Noise),
    /// `babbling`: learns to touch itself while it acts.
    Babbling,
    /// `watching`: learns to look at its hands while it acts.
    Watching,
    /// A file that ends in `.onnx`.
    Onnx(PathBuf),
    /// Any other policy.
    Command(String),
}

impl PolicySource {
    /// Parses the name of a policy. A name that ends in `.onnx` is a model if it is a file or a single word, in quotes
    /// if it has spaces; otherwise it is a command with a model among its arguments.
    pub fn new(text: &str) -> Self {
        let text = text.trim();
        if let Ok(noise) = text.parse() {
            return if noise == Noise::White {
                Self::Random
            } else {
                Self::Noise(noise)
            };
        }
        let model = |name: &str| name.to_ascii_lowercase().ends_with(".onnx");
        match text {
            "random" => Self::Random,
            "zero" => Self::Zero,
            "babbling" => Self::Babbling,
            "watching" => Self::Watching,
            file if model(file) && Path::new(file).is_file() => Self::Onnx(file.into()),
            _ => match command::words(text).as_deref() {
                Some([word]) if model(word) => Self::Onnx(word.into()),
                _ => Self::Command(text.to_string()),
            },
        }
    }

    /// Returns whether the policy learns while it acts, so that its episodes belong together, one after another.
    pub fn learns(&self) -> bool {
        matches!(self, Self::Babbling | Self::Watching)
    }

    /// Opens the policy. `limit` is the time limit of a command for an action.
    ///
    /// # Errors
    /// A command that cannot be started, a model that cannot be read.
    pub fn open(&self, limit: Duration) -> Result<Box<dyn Policy>, PolicyError> {
        Ok(match self {
            Self::Random => Box::new(RandomPolicy),
            Self::Zero => Box::new(ZeroPolicy),
            Self::Noise(noise) => Box::new(NoisePolicy::new(*noise)),
            Self::Babbling => Box::new(BabblingPolicy::new()),
            Self::Watching => Box::new(WatchingPolicy::new()),
            #[cfg(feature = "onnx")]
            Self::Onnx(path) => Box::new(OnnxPolicy::open(path)?),
            #[cfg(not(feature = "onnx"))]
            Self::Onnx(path) => return Err(PolicyError::NoOnnx { path: path.clone() }),
            Self::Command(command) => Box::new(CommandPolicy::start(command)?.with_limit(limit)),
        })
    }
}
