//! Readers and replays of records.

use std::path::{Path, PathBuf};

use super::manifest::{FORMAT, VERSION};
use super::rows::{MODEL, checksum};
use super::{MANIFEST, Manifest, RecordError};
use crate::env::{Env, Snapshot};
use crate::files;
use crate::formats::npz::Npz;
use crate::limits::Limits;
use crate::text::quoted;

/// A record in its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    dir: PathBuf,
    manifest: Manifest,
}

/// The result of repeating an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RepeatResult {
    /// Number of steps.
    pub steps: u64,
    /// The first step, from 0, whose bits differ from the record's; `None` if all are equal.
    pub first_difference: Option<u64>,
}

impl Record {
    /// Reads the description of a record.
    ///
    /// # Errors
    /// A record that is missing, damaged, or of a later version.
    pub fn open(dir: impl AsRef<Path>) -> Result<Self, RecordError> {
        Self::open_with(dir, &Limits::DEFAULT)
    }

    /// Reads the description of a record within the given limits.
    ///
    /// # Errors
    /// As [`Record::open`].
    pub fn open_with(dir: impl AsRef<Path>, limits: &Limits) -> Result<Self, RecordError> {
        let dir = dir.as_ref().to_path_buf();
        let path = dir.join(MANIFEST);
        let bytes = files::read(&path, limits.document_bytes as u64).map_err(|source| RecordError::Io {
            path: path.clone(),
            source,
        })?;
        let damaged = |reason: String| RecordError::Manifest {
            path: path.clone(),
            reason: quoted(&reason),
        };
        let manifest: Manifest = serde_json::from_slice(&bytes).map_err(|e| damaged(e.to_string()))?;
        if manifest.format != FORMAT || manifest.version > VERSION {
            return Err(damaged(format!(
                "{} of version {}; this is {FORMAT} of version {VERSION} at most",
                manifest.format, manifest.version
            )));
        }
        // names of files are untrusted and must not lead out of the folder
        // and on Windows a colon names a drive or a stream
        let plain = |file: &str| !file.is_empty() && !file.contains(['/', '\\', ':']) && file != "..";
        if let Some(episode) = manifest.episodes.iter().find(|episode| !plain(&episode.file)) {
            return Err(damaged(format!(
                "{} is not the name of a file in this folder",
                episode.file
            )));
        }
        Ok(Self { dir, manifest })
    }

    /// Returns whether a folder has a record, readable or not.
    pub fn is_in(dir: impl AsRef<Path>) -> bool {
        dir.as_ref().join(MANIFEST).is_file()
    }

    /// Returns the folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Returns the description.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Returns the path of the archive of an episode.
    ///
    /// # Errors
    /// The episode does not exist.
    pub fn path(&self, episode: u64) -> Result<PathBuf, RecordError> {
        let found = self.manifest.episodes.iter().find(|e| e.episode == episode);
        let found = found.ok_or_else(|| RecordError::Episode {
            path: self.dir.clone(),
            episode,
            there: self.manifest.episodes.iter().map(|e| e.episode).collect(),
        })?;
        Ok(self.dir.join(&found.file))
    }

    /// Opens the archive of an episode.
    ///
    /// # Errors
    /// An episode that does not exist, or an archive that cannot be read.
    pub fn npz(&self, episode: u64) -> Result<Npz, RecordError> {
        Ok(Npz::open(self.path(episode)?)?)
    }

    /// Makes an environment whose scene and body are those of an episode.
    ///
    /// # Errors
    /// An episode that does not exist, an archive that cannot be read; as [`Env::new`].
    #[cfg(feature = "eval")]
    pub(crate) fn env_of(&self, episode: u64) -> Result<Env, RecordError> {
        let mut env = Env::new(self.manifest.configuration.clone())?;
        self.become_of(episode, &self.npz(episode)?, &mut env)?;
        Ok(env)
    }

    /// Sets the infant, his age and the changed numbers of an episode in an environment.
    fn become_of(&self, episode: u64, npz: &Npz, env: &mut Env) -> Result<(), RecordError> {
        let described = self.manifest.episodes.iter().find(|e| e.episode == episode);
        let number = described.and_then(|e| e.body_number);
        let number = number.unwrap_or(self.manifest.configuration.individual.number);
        if env.config().individual.number != number {
            env.mimo_mut().set_body_number(number)?;
        }
        let age = described.and_then(|e| e.age).unwrap_or(self.manifest.configuration.age);
        if env.config().age != age {
            if env.grows() {
                env.grow_to(age)?;
            } else {
                env.mimo_mut().set_age(age)?;
            }
        }
        let mut changes = Vec::new();
        for array in npz.arrays() {
            if let Some(changed) = array.name.strip_prefix(MODEL) {
                changes.push((changed.to_string(), npz.get_f64(&array.name)?.data));
            }
        }
        env.model_mut().set_changed_numbers(&changes)?;
        Ok(())
    }

    /// Repeats an episode in an environment of the record's configuration, and compares the bits of every step.
    ///
    /// # Errors
    /// An episode that does not exist, an archive that cannot be read or does not match the environment; as [`Env::step`].
    pub fn replay(&self, episode: u64, env: &mut Env) -> Result<RepeatResult, RecordError> {
        let path = self.path(episode)?;
        let npz = Npz::open(&path)?;
        let unfit = |reason: &str| RecordError::Unfit {
            path: path.clone(),
            reason: reason.to_string(),
        };
        let (actions, drawn) = (npz.get_f64("actions")?, npz.get_i64("drawn")?);
        let (checksums, na) = (npz.get_i64("checksum")?.data, env.action_space().len());
        let steps = checksums.len();
        if actions.shape != [steps, na] || drawn.shape != [steps] {
            return Err(unfit("its actions do not match this configuration"));
        }
        let snapshot = |source| RecordError::Snapshot {
            path: path.clone(),
            source,
        };
        let start = Snapshot::from_bytes(npz.get_u8("snapshot")?.data).map_err(snapshot)?;
        // before the snapshot, which fits only an environment with this body and these numbers
        self.become_of(episode, &npz, env)?;
        env.restore(&start).map_err(snapshot)?;
        let (mut action, mut first_difference) = (Vec::with_capacity(na), None);
        for (t, &expected) in checksums.iter().enumerate() {
            action.clear();
            action.extend(actions.data[t * na..(t + 1) * na].iter().map(|&v| v as f32));
            // the policy's random numbers are not drawn again
            env.by_hand().draw_from(drawn.data[t] as u64);
            env.step(&action)?;
            env.senses_mut().look()?;
            if first_difference.is_none() && checksum(env) != expected {
                first_difference = Some(t as u64);
            }
        }
        Ok(RepeatResult {
            steps: steps as u64,
            first_difference,
        })
    }
}
