//! Logs of training and evaluation: `logs/training.pkl` and `logs/evaluation_N.pkl` in a run's folder, in the Python kit's format, each
//! with the same data next to it in a common format (`.jsonl`, `.npz`).
//!
//! Every file is replaced as a whole, so a killed run leaves the last complete log.

mod episode;
mod line;
mod lines;
mod read;
mod training;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use episode::EvaluationLog;
use read::records;
pub use read::{RecentRecords, read_recent, read_records, read_records_with, read_training};
use thiserror::Error;
pub use training::{TrainingLog, TrainingTotals};

use crate::env::{BehaviorInfo, Info, InfoValue};
use crate::files::{self, Owner, replace_file, sweep};
use crate::formats::pickle::{self, PickleError, Value};
use crate::limits::Limits;

/// An error in reading or writing a log.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LogError {
    /// The log does not exist.
    #[error(
        "{}: no such log; train into this save_dir first (babybench train, or make_env with training)", path.display()
    )]
    Missing {
        /// Its expected path.
        path: PathBuf,
    },
    /// The file system returned an error.
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
        /// Description of the fault.
        source: PickleError,
    },
    /// The file is a pickle, but not of this kind of log.
    #[error("{}: no {kind} log of BabyBench: {reason}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The expected kind of log.
        kind: &'static str,
        /// Description of the fault.
        reason: String,
    },
    /// A link leads out of the folder of the run.
    #[error("{}: a link leads out of the folder of the run; put the file itself there", path.display())]
    Outside {
        /// The file or folder of logs.
        path: PathBuf,
    },
    /// The log cannot be encoded.
    #[error("cannot write the log: {0}")]
    Write(String),
}

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

/// Creates the folder of the logs, or removes unfinished files of killed processes from it.
fn make_folder(save_dir: &Path) -> Result<(), LogError> {
    let path = folder(save_dir);
    check_inside(&path)?;
    std::fs::create_dir_all(&path).map_err(|source| LogError::Io {
        path: path.clone(),
        source,
    })?;
    // a run that was killed may have left parts of files
    sweep(&path);
    Ok(())
}

/// Creates the folder of the logs and locks the run.
fn own_folder(save_dir: &Path) -> Result<Arc<Owner>, LogError> {
    make_folder(save_dir)?;
    let path = save_dir.to_path_buf();
    Owner::of(save_dir)
        .map(Arc::new)
        .map_err(|source| LogError::Io { path, source })
}

/// Returns an error if a link leads from the folder of logs, or from a file in it, out of the folder of the run.
fn check_inside(path: &Path) -> Result<(), LogError> {
    // the path is the folder `logs` or a file in it
    let logs = path.ancestors().take(2).find(|at| at.ends_with("logs"));
    let run = match logs.and_then(Path::parent) {
        // for a relative path: the current folder
        Some(run) if run.as_os_str().is_empty() => Path::new("."),
        Some(run) => run,
        // a single log belongs to no run
        None => return Ok(()),
    };
    // a missing file leads nowhere
    let (Ok(run), Ok(target)) = (run.canonicalize(), path.canonicalize()) else {
        return Ok(());
    };
    // a folder that someone else made must not lead this program to read or overwrite files outside it
    if target.starts_with(&run) {
        Ok(())
    } else {
        Err(LogError::Outside {
            path: path.to_path_buf(),
        })
    }
}

fn write(path: PathBuf, bytes: &[u8]) -> Result<(), LogError> {
    replace_file(&path, bytes).map_err(|source| LogError::Io { path, source })
}

fn write_pickle(path: PathBuf, value: &Value) -> Result<(), LogError> {
    let bytes = pickle::to_bytes(value).map_err(|e| LogError::Write(e.to_string()))?;
    write(path, &bytes)
}

fn read_bytes(path: &Path, limits: &Limits) -> Result<Vec<u8>, LogError> {
    check_inside(path)?;
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

/// Converts a whole number to Python's.
fn whole(n: u64) -> i64 {
    // a pickle's whole numbers are signed here; no counter of a run comes near the bound
    i64::try_from(n).unwrap_or(i64::MAX)
}

/// Converts a record to a dictionary with the kit's keys, in its order.
fn to_value(info: &Info) -> Value {
    let number = |n: u64| Value::Int(whole(n));
    Value::dict(info.fields(None).filter_map(|(key, value)| {
        let value = match value {
            InfoValue::Count(count) => number(count),
            InfoValue::Geoms(geoms) => Value::list(geoms.iter().map(|&geom| number(geom as u64))),
            InfoValue::Name(name) => Value::Text(name.into()),
            InfoValue::Flag(flag) => Value::Bool(flag),
            InfoValue::Number(sum) => Value::Float(sum),
            // details, which pickles leave out
            InfoValue::Parts(_) | InfoValue::Angles(_) | InfoValue::Counts(_) => return None,
        };
        Some((key, value))
    }))
}

/// Returns the kit's record of an episode.
fn record(steps: u64, behavior: BehaviorInfo) -> Info {
    Info {
        steps,
        behavior,
        ..Info::default()
    }
}
