//! Records of runs: self-describing folders with everything that happened, for analysis and replay.
//!
//! A folder has `manifest.json` ([`Manifest`]) and a NumPy archive for each episode. In Python two lines read one:
//!
//! ```python
//! import numpy
//! episode = numpy.load("record/episode_0.npz")    # episode["qpos"], episode["touch_val"], ...
//! ```
//!
//! An archive starts with a snapshot, so [`Record::replay`] repeats the episode with the same bits, and checks them step by step.

mod describe;
mod manifest;
mod many;
mod read;
mod rows;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

pub use describe::{GeomDescription, InfantDescription, JointDescription};
pub use manifest::{ArrayDescription, EpisodeDescription, Manifest};
pub use many::VectorRecorder;
pub use read::{Record, RepeatResult};
use rows::EpisodeRows;
use thiserror::Error;

use crate::env::{Env, EnvError, InfoWithDetails, SnapshotError};
use crate::files::replace_file;
use crate::formats::npz::NpzError;
use crate::json;
use crate::vector::VectorError;

/// The name of the description in the folder of a record.
const MANIFEST: &str = "manifest.json";

/// An error in recording a run or in reading a record.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The folder already has a record.
    #[error("{}: this folder already has a record; choose another folder, or remove this one", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// Images are to be recorded, but vision is off.
    #[error("there are no images to record: set vision_active: true, or record without the eyes")]
    Blind,
    /// A step is to be recorded before an episode has begun.
    #[error("no episode is being recorded: call Recorder::begin after the reset of the environment")]
    NotBegun,
    /// The environments to be recorded are in a vector that resets them itself.
    #[error(
        "a step of this vector resets environments before their end can be recorded: make it with AutoresetMode::Disabled"
    )]
    Autoreset,
    /// The environment returned an error.
    #[error(transparent)]
    Env(#[from] EnvError),
    /// An environment of a vector returned an error.
    #[error(transparent)]
    Vector(#[from] VectorError),
    /// An archive cannot be written or read.
    #[error(transparent)]
    Npz(#[from] NpzError),
    /// The file system returned an error.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The description is damaged, or not of a record.
    #[error("{}: not a record of babybench: {reason}", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// Description of the fault.
        reason: String,
    },
    /// The episode does not exist.
    #[error("{}: no episode {episode}; there are {}", path.display(), numbers(.there))]
    Episode {
        /// The folder.
        path: PathBuf,
        /// The requested episode.
        episode: u64,
        /// The existing episodes.
        there: Vec<u64>,
    },
    /// An archive does not match the environment or its description.
    #[error("{}: {reason}", path.display())]
    Unfit {
        /// The file.
        path: PathBuf,
        /// Description of the fault.
        reason: String,
    },
    /// The episode cannot be repeated from its start.
    #[error("{}: {source}", path.display())]
    Snapshot {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: SnapshotError,
    },
}

/// Lists the numbers of the first few episodes.
fn numbers(there: &[u64]) -> String {
    let first: Vec<String> = there.iter().take(10).map(u64::to_string).collect();
    match (there.len(), first.is_empty()) {
        (_, true) => "none".to_string(),
        (n, _) if n > first.len() => format!("{}, ... ({n})", first.join(", ")),
        _ => first.join(", "),
    }
}

/// Further contents of a record, besides states, actions, touch, contacts, rewards and information.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordOptions {
    /// Whether every other sense is recorded as observed, step by step. Otherwise they are left to a replay, which has the same bits, because they
    /// would take more space than everything else.
    pub senses: bool,
    /// Interval, in steps, at which both eyes are recorded, starting with the first step of an episode; `None` for never.
    pub eyes_every: Option<u64>,
    /// Name of the policy, for the description.
    pub policy: String,
}

/// The state shared by the recorders of one folder.
#[derive(Debug)]
struct RecordFolder {
    dir: PathBuf,
    options: RecordOptions,
    manifest: Mutex<Manifest>,
}

/// Records an environment, episode by episode, into a folder.
///
/// ```
/// use babybench::runs::{Record, RecordOptions, Recorder};
/// use babybench::{Config, Env};
/// # let dir = std::env::temp_dir().join(format!("babybench_record_example_{}", std::process::id()));
///
/// let mut env = Env::new(Config { vision_active: false, ..Config::default() })?;
/// let mut recorder = Recorder::create(&dir, &env, RecordOptions::default())?;
/// let mut action = Vec::new();
/// env.reset(Some(7))?;
/// recorder.begin(&env, 0);
/// for _ in 0..5 {
///     env.sample_action(&mut action);
///     recorder.step(&mut env, &action)?; // instead of env.step(&action)
/// }
/// recorder.end(&env)?;
///
/// let record = Record::open(&dir)?;
/// assert_eq!(record.manifest().episodes[0].steps, 5);
/// assert_eq!(record.replay(0, &mut env)?.first_difference, None);
/// # std::fs::remove_dir_all(&dir)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Recorder {
    shared: Arc<RecordFolder>,
    rows: Option<(u64, Box<EpisodeRows>)>,
    /// The rows of a finished episode, kept for their allocations.
    spare: Option<Box<EpisodeRows>>,
}

impl Recorder {
    /// Creates the folder of a record, for an environment.
    ///
    /// # Errors
    /// A folder that has a record or cannot be created; eyes that are off.
    pub fn create(dir: impl Into<PathBuf>, env: &Env, options: RecordOptions) -> Result<Self, RecordError> {
        // a relative path is that of now, wherever the program goes later
        let dir = dir.into();
        let dir = std::path::absolute(&dir).unwrap_or(dir);
        // a record is a measurement: it is never overwritten in silence
        if dir.join(MANIFEST).exists() {
            return Err(RecordError::Exists { path: dir });
        }
        let sees = env.observation().entries().any(|(entry, _)| entry.image.is_some());
        if options.eyes_every.is_some() && !sees && !env.config().vision_active {
            return Err(RecordError::Blind);
        }
        std::fs::create_dir_all(&dir).map_err(|source| RecordError::Io {
            path: dir.clone(),
            source,
        })?;
        let shared = RecordFolder {
            manifest: Mutex::new(Manifest::of(env, &options)),
            dir,
            options,
        };
        describe::write_skin(env, &shared.dir)?;
        // before any episode, so that the folder is a record whenever the program stops
        save(&shared.dir, &lock(&shared.manifest))?;
        Ok(Self {
            shared: Arc::new(shared),
            rows: None,
            spare: None,
        })
    }

    /// Returns another recorder into the same folder, for a parallel environment of the same blueprint.
    #[must_use]
    pub fn another(&self) -> Self {
        Self {
            shared: self.shared.clone(),
            rows: None,
            spare: None,
        }
    }

    /// Returns the folder.
    pub fn dir(&self) -> &Path {
        &self.shared.dir
    }

    /// Returns whether steps of an episode were recorded that [`Recorder::end`] has not written.
    pub fn has_steps(&self) -> bool {
        self.rows.as_ref().is_some_and(|(_, rows)| rows.len() > 0)
    }

    /// Starts recording an episode at the current moment, under a number that no other episode in the folder has. An episode that
    /// was not ended is lost.
    pub fn begin(&mut self, env: &Env, episode: u64) {
        let options = &self.shared.options;
        let last = self.rows.take().map(|(_, rows)| rows).or(self.spare.take());
        let rows = match last {
            Some(mut rows) => {
                rows.begin(env, options);
                rows
            }
            None => Box::new(EpisodeRows::new(env, options)),
        };
        self.rows = Some((episode, rows));
    }

    /// Applies an action, as [`Env::step`] does, and records the result.
    ///
    /// A replay repeats resets, actions and random choices. It does not repeat changes by a program between steps (the state, locks,
    /// forces), and reports the step at which the bits differ.
    ///
    /// # Errors
    /// As [`Env::step`]; no episode has begun.
    pub fn step(&mut self, env: &mut Env, action: &[f32]) -> Result<(), RecordError> {
        if self.rows.is_none() {
            return Err(RecordError::NotBegun);
        }
        // before the step: a replay moves its generator there, so that noise has the same bits
        let drawn = env.drawn();
        env.step(action)?;
        // checksums include images
        env.senses_mut().look()?;
        self.push(env, action, drawn)
    }

    /// Records a step. `drawn` is the number of values that the generator had drawn before it.
    fn push(&mut self, env: &Env, action: &[f32], drawn: u64) -> Result<(), RecordError> {
        let (_, rows) = self.rows.as_mut().ok_or(RecordError::NotBegun)?;
        rows.push(env, action, drawn, &self.shared.options);
        Ok(())
    }

    /// Records the current moment of an environment as a step, with the given action as its cause, for steps that a program composes itself
    /// ([`Env::by_hand`]). A replay, which knows only actions, finds different bits there. Images that
    /// [`SensesMut::look`](crate::env::SensesMut::look) has not drawn yet are not recorded.
    ///
    /// # Errors
    /// No episode has begun; an action of wrong length or with numbers that are not finite.
    pub fn note(&mut self, env: &Env, action: &[f32]) -> Result<(), RecordError> {
        env.check_action(action)?;
        self.push(env, action, env.drawn())
    }

    /// Ends the episode, before the next reset: writes its archive and updates the description. An episode without steps is not written.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn end(&mut self, env: &Env) -> Result<(), RecordError> {
        self.write(env, false)
    }

    /// Writes the steps so far of an episode that continues or was given up, as [`Recorder::end`] does. The description marks it as
    /// [`unfinished`](EpisodeDescription::unfinished).
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn give_up(&mut self, env: &Env) -> Result<(), RecordError> {
        self.write(env, true)
    }

    fn write(&mut self, env: &Env, unfinished: bool) -> Result<(), RecordError> {
        let Some((number, mut rows)) = self.rows.take() else {
            return Ok(());
        };
        // an episode without steps has nothing to repeat
        if rows.len() == 0 {
            self.spare = Some(rows);
            return Ok(());
        }
        let dir = &self.shared.dir;
        let name = format!("episode_{number}.npz");
        let (npz, arrays) = rows.archive()?;
        let bytes = npz.finish()?;
        let path = dir.join(&name);
        // before the manifest, which must not name a file that is not there
        replace_file(&path, &bytes).map_err(|source| RecordError::Io { path, source })?;
        let description = EpisodeDescription {
            episode: number,
            file: name,
            steps: rows.len() as u64,
            crc32: crc32fast::hash(&bytes),
            last_checksum: rows.last_checksum(),
            info: serde_json::to_value(InfoWithDetails::from(env.info())).unwrap_or_default(),
            age: None,
            body_number: None,
            unfinished,
        };
        rows.clear();
        self.spare = Some(rows);
        // only now, so that parallel recorders do not wait for each other's archives
        let mut manifest = lock(&self.shared.manifest);
        let (age, number) = (env.config().age, env.config().individual.number);
        let description = EpisodeDescription {
            // only a change of age is written down, as the configuration of the manifest has the first one
            age: (age != manifest.configuration.age).then_some(age),
            body_number: (number != manifest.configuration.individual.number).then_some(number),
            ..description
        };
        manifest.add(description, arrays);
        // still under the lock, because an older description must not replace a newer one
        save(dir, &manifest)
    }
}

fn lock(manifest: &Mutex<Manifest>) -> MutexGuard<'_, Manifest> {
    manifest.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes the description into its folder.
fn save(dir: &Path, manifest: &Manifest) -> Result<(), RecordError> {
    let path = dir.join(MANIFEST);
    let text = json::text(manifest) + "\n";
    replace_file(&path, text.as_bytes()).map_err(|source| RecordError::Io { path, source })
}
