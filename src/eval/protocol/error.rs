//! Errors of protocols.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::Protocol;
use crate::eval::EpisodeError;
use crate::text::{quoted, suggestion};

/// An error in reading or running a protocol.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ProtocolError {
    /// The library has no protocol of this name.
    #[error(
        "there is no protocol {:?}{}; there are {}, and documents whose names end in .yml",
        quoted(.name), suggestion(.nearest.as_deref()), Protocol::names().collect::<Vec<_>>().join(", ")
    )]
    Unknown {
        /// The name.
        name: String,
        /// The nearest name, if one is near.
        nearest: Option<String>,
    },
    /// The document is invalid.
    #[error("{}:{line}: {reason}", path.display())]
    Document {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u32,
        /// Description of the fault.
        reason: String,
    },
    /// The plan of the run is invalid.
    #[error("{what} is {}, expected {expected}", quoted(.value))]
    Plan {
        /// The part of the plan.
        what: &'static str,
        /// Its value.
        value: String,
        /// The accepted values.
        expected: String,
    },
    /// The configuration of a condition is invalid with the keys of the plan.
    #[error("{reason}")]
    Config {
        /// The error of the configuration, with key and value.
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
    /// A run failed.
    #[error("{run}: {source}")]
    Run {
        /// The name of the run.
        run: String,
        /// The cause.
        source: Box<EpisodeError>,
    },
    /// The progress callback stopped the protocol.
    #[error("stopped after {done} of {planned} runs; they are kept, and the same command continues from there")]
    Stopped {
        /// Number of finished runs, which are kept.
        done: usize,
        /// Number of planned runs.
        planned: usize,
    },
}
