//! A report of a run: one HTML page that needs no other file, with the score, the learning curve, what the hands
//! touched or the eyes saw, and key frames of the video.

pub mod ages;
mod benchmark;
mod curve;
mod doll;
mod gaze;
mod page;
mod run;
pub mod skin;
mod strip;
mod svg;

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

pub use benchmark::benchmark_page;

use babybench::files::replace_file;
use run::RunContents;

/// Returns an age in words: 1 month, 6 months.
fn months(age: f64) -> String {
    format!("{age} {}", if age == 1.0 { "month" } else { "months" })
}

/// An error in building a report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The folder does not exist.
    #[error("{}: {}; give the save_dir of a run (babybench train makes one)", path.display(), missing(path))]
    Missing {
        /// The folder.
        path: PathBuf,
    },
    /// The folder is not that of a run.
    #[error(
        "{}: not the folder of a run: it has neither logs/training.pkl nor logs/evaluation_N.pkl; run babybench train or \
         babybench evaluate into it first", path.display()
    )]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// There are logs, but none of them can be read.
    #[error("{}: none of the logs can be read: {reasons}", path.display())]
    Unreadable {
        /// The folder.
        path: PathBuf,
        /// The fault of each log.
        reasons: String,
    },
    /// The baseline run cannot be used.
    #[error("{}: {reason}; a baseline is the save_dir of a training of the same behavior", path.display())]
    Baseline {
        /// The folder.
        path: PathBuf,
        /// Description of the fault.
        reason: String,
    },
    /// The file system returned an error.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
}

/// Describes how a folder is missing.
fn missing(path: &Path) -> &'static str {
    if path.exists() {
        "this is a file, not a folder"
    } else {
        "no such folder"
    }
}

/// A written report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The page.
    pub html: String,
    /// The parts that are missing, and why.
    pub notices: Vec<String>,
}

impl Report {
    /// Builds the report of the folder of a run, ours or the Python kit's. Parts that do not exist yet (training,
    /// evaluation, video) are left out, with a notice.
    ///
    /// # Errors
    /// A folder that is missing or is not that of a run; no readable logs.
    pub fn new(save_dir: impl AsRef<Path>) -> Result<Self, ReportError> {
        Ok(Self::of(RunContents::read(save_dir.as_ref())?))
    }

    /// Builds the report of the folder of a run with the learning curve of another training, such as one with random
    /// actions, beside its own.
    ///
    /// # Errors
    /// As [`Report::new`]; a baseline without a training log of the same behavior.
    pub fn with_baseline(save_dir: impl AsRef<Path>, baseline: impl AsRef<Path>) -> Result<Self, ReportError> {
        let mut run = RunContents::read(save_dir.as_ref())?;
        run.compare(baseline.as_ref())?;
        Ok(Self::of(run))
    }

    fn of(mut run: RunContents) -> Self {
        Self {
            html: page::page(&mut run),
            notices: run.notices,
        }
    }

    /// Writes the page to a file, which is replaced as a whole.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), ReportError> {
        let path = path.as_ref();
        replace_file(path, self.html.as_bytes()).map_err(|source| ReportError::Io {
            path: path.to_path_buf(),
            source,
        })
    }
}
