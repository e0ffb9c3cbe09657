//! Logs of training and evaluation: `logs/training.pkl` and `logs/evaluation_N.pkl` in a run's folder, as the Python
//! kit writes and reads them, each with the same data beside it for everyone else (`.jsonl`, `.npz`).
//!
//! Every file is replaced as a whole: a run that is killed leaves the last complete log.

mod episode;
mod read;

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use episode::EvaluationLog;
use read::records;
pub use read::{RecentRecords, read_recent, read_records, read_records_with, read_training};
use thiserror::Error;

use crate::config::{Compat, Config};
use crate::env::{BehaviorInfo, Detailed, EYE_HAND_PAIRS, Info, InfoDetails, PartNames};
use crate::files::{self, Owner, replace_file, replace_file_with, sweep};
use crate::formats::pickle::{self, ListWriter, PickleError, Value};
use crate::json;
use crate::limits::Limits;

/// An error in reading or writing a log.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LogError {
    /// There is no log.
    #[error(
        "{}: no such log; train into this save_dir first (babybench train, or make_env with training)", path.display()
    )]
    Missing {
        /// Where it was expected.
        path: PathBuf,
    },
    /// The file system refuses.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The file is not a pickle of a log.
    #[error("{}: {source}", path.display())]
    Pickle {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: PickleError,
    },
    /// The file is a pickle, but not of such a log.
    #[error("{}: no {kind} log of BabyBench: {reason}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Which log was expected.
        kind: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// The log cannot be expressed.
    #[error("cannot write the log: {0}")]
    Write(String),
}

/// Lines of JSON are written when there are more bytes of them than this.
const WRITTEN_AT_ONCE: usize = 1 << 16;

/// Returns the folder of the logs in the folder of a run.
fn folder(save_dir: &Path) -> PathBuf {
    save_dir.join("logs")
}

/// Returns the path of the training log in the folder of a run.
pub fn training_path(save_dir: impl AsRef<Path>) -> PathBuf {
    folder(save_dir.as_ref()).join("training.pkl")
}

/// Returns the path of the log of an evaluation episode in the folder of a run.
pub fn evaluation_path(save_dir: impl AsRef<Path>, episode: u64) -> PathBuf {
    folder(save_dir.as_ref()).join(format!("evaluation_{episode}.pkl"))
}

/// Makes the folder of the logs, or removes what killed processes left in it.
fn make_folder(save_dir: &Path) -> Result<(), LogError> {
    let path = folder(save_dir);
    std::fs::create_dir_all(&path).map_err(|source| LogError::Io {
        path: path.clone(),
        source,
    })?;
    sweep(&path);
    Ok(())
}

/// Makes the folder of the logs and takes possession of the run.
fn own_folder(save_dir: &Path) -> Result<Arc<Owner>, LogError> {
    make_folder(save_dir)?;
    let path = save_dir.to_path_buf();
    Owner::of(save_dir)
        .map(Arc::new)
        .map_err(|source| LogError::Io { path, source })
}

fn write(path: PathBuf, bytes: &[u8]) -> Result<(), LogError> {
    replace_file(&path, bytes).map_err(|source| LogError::Io { path, source })
}

fn write_pickle(path: PathBuf, value: &Value) -> Result<(), LogError> {
    let bytes = pickle::to_bytes(value).map_err(|e| LogError::Write(e.to_string()))?;
    write(path, &bytes)
}

fn read_bytes(path: &Path, limits: &Limits) -> Result<Vec<u8>, LogError> {
    let io = |source: io::Error| {
        let path = path.to_path_buf();
        match source.kind() {
            io::ErrorKind::NotFound => LogError::Missing { path },
            _ => LogError::Io { path, source },
        }
    };
    files::read(path, limits.pickle_bytes as u64).map_err(io)
}

fn read_pickle(path: &Path, limits: &Limits) -> Result<Value, LogError> {
    let bytes = read_bytes(path, limits)?;
    pickle::from_bytes_with(&bytes, limits).map_err(|source| {
        let path = path.to_path_buf();
        LogError::Pickle { path, source }
    })
}

/// Converts a record to a dictionary with the keys of the kit, in its order.
fn to_value(info: &Info) -> Value {
    let count = |n: u64| Value::Int(i64::try_from(n).unwrap_or(i64::MAX));
    let steps = ("steps", count(info.steps));
    let geoms = |list: &[usize]| Value::list(list.iter().map(|&g| count(g as u64)));
    match &info.behavior {
        BehaviorInfo::None => Value::dict([steps]),
        BehaviorInfo::SelfTouch { touches } => Value::dict([
            ("right_hand_touches", geoms(&touches.right_hand)),
            ("left_hand_touches", geoms(&touches.left_hand)),
            steps,
        ]),
        BehaviorInfo::HandRegard { counts } => {
            let counts = EYE_HAND_PAIRS.into_iter().zip(counts.to_array().map(count));
            Value::dict(counts.chain([steps]))
        }
        BehaviorInfo::Task(info) => Value::dict([
            ("task", Value::Text(info.task.name().into())),
            ("is_success", Value::Bool(info.outcome.is_success)),
            ("is_failure", Value::Bool(info.outcome.is_failure)),
            ("return", Value::Float(info.episode_return)),
            steps,
        ]),
    }
}

/// Returns a record of what the kit knows of an episode.
fn record(steps: u64, behavior: BehaviorInfo) -> Info {
    Info {
        steps,
        behavior,
        ..Info::default()
    }
}

/// The log of a training run, saved as often as its configuration says.
///
/// Under `compat: api` every episode of at least one step is a record, and the log is saved whenever their number is a
/// multiple of `save_logs_every`. Under `compat: reference` every reset adds a record, also the first one (an empty
/// record), and the log is saved when the number of steps of the ended episode is a multiple of `save_logs_every`.
#[derive(Clone, Debug)]
pub struct TrainingLog {
    save_dir: PathBuf,
    compat: Compat,
    save_every: u64,
    records: Vec<Info>,
    resumed: bool,
    /// For the names of touched parts in the lines of JSON.
    names: Option<PartNames>,
    /// Refuses the folder to other processes that would train into it.
    _owner: Arc<Owner>,
}

impl TrainingLog {
    /// Creates a log in the configuration's `save_dir`, which is created too; an existing log is overwritten. Until the
    /// log and its copies are dropped, other processes cannot train into that folder.
    ///
    /// # Errors
    /// A folder into which another process trains; what the file system says.
    pub fn create(config: &Config) -> Result<Self, LogError> {
        let owner = own_folder(config.save_dir.as_ref())?;
        let log = Self {
            save_dir: PathBuf::from(&config.save_dir),
            compat: config.compat,
            save_every: config.save_logs_every.max(1),
            records: Vec::new(),
            resumed: false,
            names: None,
            _owner: owner,
        };
        if log.compat == Compat::Api {
            log.save()?;
        }
        Ok(log)
    }

    /// Resumes the log in the configuration's `save_dir`, or creates one if there is none. No empty record is added.
    ///
    /// # Errors
    /// A log that cannot be read, or is of another behavior; a folder into which another process trains.
    pub fn resume(config: &Config) -> Result<Self, LogError> {
        let path = training_path(&config.save_dir);
        if !path.exists() {
            return Self::create(config);
        }
        let owner = own_folder(config.save_dir.as_ref())?;
        let records = read_records(&path)?;
        if let Some(found) = records
            .first()
            .map(|r| r.behavior.name())
            .filter(|b| *b != config.behavior.name())
        {
            return Err(LogError::Foreign {
                path,
                kind: "training",
                reason: format!("its behavior is {found}, not {}; use another save_dir", config.behavior),
            });
        }
        Ok(Self {
            save_dir: PathBuf::from(&config.save_dir),
            compat: config.compat,
            save_every: config.save_logs_every.max(1),
            resumed: !records.is_empty(),
            records,
            names: None,
            _owner: owner,
        })
    }

    /// Adds names of the touched parts to `training.jsonl`.
    #[must_use]
    pub fn with_names(self, names: Option<PartNames>) -> Self {
        Self { names, ..self }
    }

    /// Returns the records so far.
    pub fn records(&self) -> &[Info] {
        &self.records
    }

    /// Returns the folder of the run.
    pub fn save_dir(&self) -> &Path {
        &self.save_dir
    }

    /// Records an episode that ended after `steps` steps, and saves when it is time to. An environment that logs
    /// ([`crate::make_env`]) does so by itself; this is for programs that run many environments into one log.
    ///
    /// # Errors
    /// What the file system says.
    pub fn end_episode(&mut self, steps: u64, behavior: &BehaviorInfo) -> Result<(), LogError> {
        let first = std::mem::take(&mut self.resumed);
        if steps == 0 && (first || self.compat == Compat::Api) {
            return Ok(());
        }
        let behavior = behavior.clone();
        self.records.push(record(steps, behavior));
        let count = match self.compat {
            Compat::Api => self.records.len() as u64,
            Compat::Reference => steps,
        };
        match count % self.save_every {
            0 => self.save(),
            _ => Ok(()),
        }
    }

    /// Writes `training.pkl` and `training.jsonl`, in which touched parts also have names (`right_hand_parts`,
    /// `left_hand_parts`).
    ///
    /// # Errors
    /// What the file system says.
    pub fn save(&self) -> Result<(), LogError> {
        let path = training_path(&self.save_dir);
        self.save_lines(path.with_extension("jsonl"))?;
        let unwritable = |e: PickleError| LogError::Write(e.to_string());
        let mut list = ListWriter::new();
        for info in &self.records {
            list.push(&to_value(info)).map_err(unwritable)?;
        }
        write(path, &list.finish())
    }

    /// Writes the records as lines of JSON, which are not all in memory at the same time: names make them long.
    fn save_lines(&self, path: PathBuf) -> Result<(), LogError> {
        replace_file_with(&path, |file| {
            let mut lines = Vec::new();
            for info in &self.records {
                let details = self.names.as_ref().map(|names| InfoDetails::of(&info.behavior, names));
                let details = details.as_ref();
                json::line(&mut lines, &Detailed { info, details })?;
                if lines.len() > WRITTEN_AT_ONCE {
                    file.write_all(&lines)?;
                    lines.clear();
                }
            }
            file.write_all(&lines)
        })
        .map_err(|source| LogError::Io { path, source })
    }
}
