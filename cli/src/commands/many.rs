//! Arguments of commands that run many environments at once.

use babybench::{AutoresetMode, VectorEnv, VectorOptions};
use clap::Args;

use crate::arguments::count;
use crate::print::note;

/// The number of environments and of threads.
#[derive(Args)]
pub struct Many {
    /// Number of environments to run at once; the seed of each is one more than that of the one before
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>)]
    envs: Option<usize>,
    /// Number of threads that step them; one for each core by default. Results do not depend on it
    #[arg(long, value_name = "T", requires = "envs", allow_negative_numbers = true, value_parser = count::<usize>)]
    threads: Option<usize>,
}

impl Many {
    /// Returns the number of environments, if it is given.
    pub fn envs(&self) -> Option<usize> {
        self.envs
    }

    /// Returns how the vector is built.
    pub fn options(&self, autoreset: AutoresetMode) -> VectorOptions {
        VectorOptions {
            autoreset,
            threads: self.threads.unwrap_or(0),
            ..VectorOptions::default()
        }
    }
}

/// Says that there are fewer threads than asked for, if so.
pub fn say_threads(envs: &VectorEnv) {
    if let Some(clipped) = envs.clipped_threads() {
        note!("note: {clipped}");
    }
}
