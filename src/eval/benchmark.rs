//! Benchmarks: behaviors, policies and seeds of a plan, run on all cores, with means over seeds and their intervals.

mod job;
mod plan;
mod statistics;
mod table;

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

pub use job::{BenchmarkJob, RunResult};
pub use plan::BenchmarkPlan;
use serde::{Deserialize, Serialize};
pub use statistics::ConfidenceInterval;
pub use table::{BenchmarkRow, Metric};
use thiserror::Error;

use super::EpisodeError;
use super::side_by_side::side_by_side;
use crate::config::ConfigError;
use crate::env::EnvError;
use crate::files::replace_file;
use crate::json;
use crate::policy::PolicyError;
use crate::runs::RecordError;

/// An error in reading the plan of a benchmark or in running it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BenchmarkError {
    /// The plan is invalid.
    #[error("{}:{line}: {reason}", path.display())]
    Plan {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u32,
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
    /// A configuration is invalid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A run failed.
    #[error("{run}: {source}")]
    Run {
        /// The name of the run.
        run: String,
        /// The cause.
        source: Box<EpisodeError>,
    },
    /// The progress callback stopped the benchmark.
    #[error("stopped after {done} of {planned} runs; they are kept, and the same command continues from there")]
    Stopped {
        /// Number of finished runs, which are kept.
        done: usize,
        /// Number of planned runs.
        planned: usize,
    },
}

impl From<RecordError> for EpisodeError {
    fn from(error: RecordError) -> Self {
        Self::Observer(error.into())
    }
}

/// A benchmark with its results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Benchmark {
    /// Its name.
    pub name: String,
    /// The version of babybench.
    pub babybench: String,
    /// The commit that it was built from, if the build named it (the variable `BABYBENCH_COMMIT`).
    pub commit: Option<String>,
    /// The processor and the system on which it ran.
    pub platform: String,
    /// The plan.
    pub plan: BenchmarkPlan,
    /// A row for each behavior, age and policy: means over seeds, with intervals.
    pub rows: Vec<BenchmarkRow>,
    /// Every run.
    pub runs: Vec<RunResult>,
}

impl Benchmark {
    /// Runs a plan into a folder, `jobs` runs at a time. Finished runs in the folder are not repeated. `progress` is called after every
    /// step and can stop the benchmark.
    ///
    /// The folder gets `runs/NAME.json` and `records/NAME` for each run, then `benchmark.json` and `benchmark.md`. The command line adds a
    /// page.
    ///
    /// # Errors
    /// The first that occurs: an invalid configuration, or an error of an environment, a policy or the file system.
    pub fn run(
        plan: &BenchmarkPlan,
        dir: &Path,
        jobs: usize,
        limit: Duration,
        progress: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<Self, BenchmarkError> {
        let all = plan.jobs()?;
        let io = |path: &Path| {
            let path = path.to_path_buf();
            move |source| BenchmarkError::Io { path, source }
        };
        for folder in ["runs", "records"].map(|name| dir.join(name)) {
            std::fs::create_dir_all(&folder).map_err(io(&folder))?;
        }
        let (runs, ended) = side_by_side(&all, jobs, |job| job.run_or_read(dir, limit, progress));
        match ended {
            Err(BenchmarkError::Stopped { .. }) => {
                let (done, planned) = (runs.len(), all.len());
                return Err(BenchmarkError::Stopped { done, planned });
            }
            other => other?,
        }
        Ok(Self {
            name: plan.name.clone(),
            babybench: env!("CARGO_PKG_VERSION").to_string(),
            commit: option_env!("BABYBENCH_COMMIT").map(str::to_string),
            platform: format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            plan: plan.clone(),
            rows: table::rows(&runs),
            runs,
        })
    }

    /// Writes `benchmark.json` and `benchmark.md` into a folder.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, dir: &Path) -> Result<(), BenchmarkError> {
        for (name, text) in [
            ("benchmark.json", json::text(self) + "\n"),
            ("benchmark.md", self.to_markdown()),
        ] {
            let path = dir.join(name);
            replace_file(&path, text.as_bytes()).map_err(|source| BenchmarkError::Io { path, source })?;
        }
        Ok(())
    }
}

/// Converts an error of an environment or a policy to an error of an episode.
fn env_error(episode: u64) -> impl Fn(EnvError) -> EpisodeError {
    move |source| EpisodeError::Env {
        episode,
        source: Box::new(source),
    }
}

/// Names the error of a policy.
fn policy_error(error: PolicyError) -> EpisodeError {
    EpisodeError::Policy(error)
}
