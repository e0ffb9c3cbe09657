//! Submissions to the BabyBench competition: one archive with the required files, checked before it is written.
//!
//! The page (babybench.github.io/2025/submission) asks for an extended abstract of two pages, the log of the training, and the logs of ten
//! evaluation episodes; videos may be added.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use thiserror::Error;

use super::{EvaluationError, Score, eval_logs};
use crate::files::{self, replace_file};
use crate::limits::Limits;
use crate::runs::logs::{evaluation_path, training_path};
use crate::runs::{EvaluationLog, LogError};

/// Number of evaluation episodes that a submission has.
pub const EPISODES: u64 = 10;
/// Greatest size of a file that is packed, bytes.
const FILE: u64 = 1 << 30;
/// 1980-01-01, the earliest date that an archive can store.
const EPOCH: i64 = 315_532_800;

/// An error in packing a submission.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PackError {
    /// The training log is missing, damaged or without a score.
    #[error(transparent)]
    Training(#[from] EvaluationError),
    /// An evaluation log is missing or damaged.
    #[error("{source}; a submission has {EPISODES} evaluation episodes: babybench evaluate --episodes {EPISODES}")]
    Evaluation {
        /// The cause.
        source: LogError,
    },
    /// A log does not match the other logs.
    #[error("{}: {reason}", path.display())]
    Unfit {
        /// The file.
        path: PathBuf,
        /// Description of the fault.
        reason: String,
    },
    /// The abstract is not a PDF document.
    #[error("{}: this is not a PDF document; a submission has an extended abstract of two pages", path.display())]
    Abstract {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The archive cannot be written.
    #[error("cannot make the archive: {0}")]
    Archive(#[from] rawzip::Error),
}

/// The contents of a submission.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PackOptions {
    /// The extended abstract, a PDF document.
    pub extended_abstract: Option<PathBuf>,
    /// Whether the videos of the evaluation go into the archive.
    pub videos: bool,
}

/// A packed submission.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PackedSubmission {
    /// The score of the training log, by the kit's rule.
    pub score: Score,
    /// The names of the files in the archive.
    pub files: Vec<String>,
    /// A sentence for each requirement of the page that is not met, and for each oddity.
    pub notices: Vec<String>,
}

/// Checks the folder of a run, and packs the files of a submission into an archive.
///
/// # Errors
/// Logs that are missing, damaged or of different behaviors, an abstract that is not a PDF document; errors of the file system.
pub fn pack(save_dir: &Path, options: &PackOptions, archive: &Path) -> Result<PackedSubmission, PackError> {
    let score = eval_logs(save_dir)?;
    let mut notices = Vec::new();
    let mut sources = vec![("logs/training.pkl".to_string(), training_path(save_dir))];
    let behavior = behavior(&score);
    for episode in 0..EPISODES {
        let path = evaluation_path(save_dir, episode);
        let log = EvaluationLog::read(&path).map_err(|source| PackError::Evaluation { source })?;
        let found = log.info.last().map_or("none", |info| info.behavior.name());
        if found != behavior {
            let reason = format!("this is an episode of {found}, and the training log is of {behavior}");
            return Err(PackError::Unfit { path, reason });
        }
        if log.len() < 1000 {
            notices.push(format!(
                "evaluation episode {episode} has {} steps; the kit's have 1000",
                log.len()
            ));
        }
        sources.push((format!("logs/evaluation_{episode}.pkl"), path));
    }
    match &options.extended_abstract {
        Some(path) => sources.push(("abstract.pdf".to_string(), path.clone())),
        None => notices
            .push("there is no extended abstract; the page asks for one of two pages: --abstract FILE.pdf".to_string()),
    }
    for episode in (0..EPISODES).filter(|_| options.videos) {
        let path = save_dir.join("videos").join(format!("evaluation_{episode}.avi"));
        if path.is_file() {
            sources.push((format!("videos/evaluation_{episode}.avi"), path));
        } else {
            notices.push(format!("evaluation episode {episode} has no video"));
        }
    }
    let bytes = archive_of(&sources)?;
    replace_file(archive, &bytes).map_err(|source| PackError::Io {
        path: archive.to_path_buf(),
        source,
    })?;
    Ok(PackedSubmission {
        score,
        files: sources.into_iter().map(|(name, _)| name).collect(),
        notices,
    })
}

/// Names the behavior of a score.
fn behavior(score: &Score) -> &'static str {
    match score.parts {
        super::ScoreParts::SelfTouch { .. } => "self_touch",
        super::ScoreParts::HandRegard { .. } => "hand_regard",
    }
}

/// Reads files and puts them into an archive, in order and without time stamps.
fn archive_of(sources: &[(String, PathBuf)]) -> Result<Vec<u8>, PackError> {
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, path) in sources {
        let io = |source| PackError::Io {
            path: path.clone(),
            source,
        };
        let limit = FILE.max(Limits::DEFAULT.pickle_bytes as u64);
        let bytes = files::read(path, limit).map_err(io)?;
        if name.ends_with(".pdf") && !bytes.starts_with(b"%PDF-") {
            return Err(PackError::Abstract { path: path.clone() });
        }
        let builder = archive
            .new_file(name.as_str())
            .compression_method(CompressionMethod::DEFLATE)
            .last_modified(UtcDateTime::from_unix(EPOCH));
        let (mut entry, config) = builder.start()?;
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
        writer.write_all(&bytes).map_err(io)?;
        let (encoder, descriptor) = writer.finish()?;
        encoder.finish().map_err(io)?;
        entry.finish(descriptor)?;
    }
    Ok(archive.finish()?)
}
