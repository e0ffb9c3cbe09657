//! Arguments of commands that can record.

use std::io;
use std::path::PathBuf;

use babybench::runs::{RecordError, RecordOptions, Recorder, VectorRecorder};
use babybench::{Env, VectorEnv};
use clap::Args;

use crate::arguments::{count, word};
use crate::print::say;

/// The contents of a recording, and its place.
#[derive(Args)]
pub struct Recording {
    /// Record everything into this new folder: manifest.json and a NumPy archive for each episode, which babybench replay repeats
    /// with the same bits
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,
    /// Also record all senses as observed, except the images
    #[arg(long, requires = "record")]
    record_senses: bool,
    /// Record what both eyes observe in every K-th step
    #[arg(long, value_name = "K", requires = "record", allow_negative_numbers = true, value_parser = count::<u64>)]
    record_eyes: Option<u64>,
}

impl Recording {
    /// Returns the folder, if recording is on.
    pub fn folder(&self) -> Option<&PathBuf> {
        self.record.as_ref()
    }

    /// Creates the recorder, if recording is on. `policy` is the name of the policy.
    pub fn recorder(&self, env: &Env, policy: &str) -> Result<Option<Recorder>, RecordError> {
        let folder = self.record.as_ref();
        folder
            .map(|folder| Recorder::create(folder, env, self.options(policy)))
            .transpose()
    }

    /// Creates the recorder of a vector, if recording is on. `policy` is the name of the policy.
    pub fn recorder_of_many(&self, envs: &VectorEnv, policy: &str) -> Result<Option<VectorRecorder>, RecordError> {
        let folder = self.record.as_ref();
        folder
            .map(|folder| VectorRecorder::create(folder, envs, self.options(policy)))
            .transpose()
    }

    fn options(&self, policy: &str) -> RecordOptions {
        RecordOptions {
            senses: self.record_senses,
            eyes_every: self.record_eyes,
            policy: policy.to_string(),
        }
    }

    /// Prints what can be done with the record, if there is one.
    pub fn say_next(&self) -> io::Result<()> {
        let Some(folder) = &self.record else { return Ok(()) };
        let word = word(folder.display());
        say!("recorded; babybench replay --recording {word} repeats it, babybench measure {word} measures it")
    }
}
