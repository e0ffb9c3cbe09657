//! A run of a protocol: all its conditions at an age, with a policy, from a seed.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::plan::TrialSteps;
use super::result::ProtocolRun;
use super::trial::{Performer, Track};
use super::{Condition, Protocol, ProtocolError, ProtocolPlan, rules};
use crate::config::Config;
use crate::env::{Blueprint, EnvError};
use crate::eval::EpisodeError;
use crate::files::{self, replace_file};
use crate::json;
use crate::limits::Limits;
use crate::policy::PolicySource;

/// The seed of another infant is that of the first one plus this, which is more than any number of seeds.
const OTHER_INFANT: u64 = 1_000_000;

/// A run: an age, a policy and a seed.
pub(super) struct Job<'p> {
    protocol: &'p Protocol,
    plan: &'p ProtocolPlan,
    /// The name of its files.
    name: String,
    age: f64,
    policy: &'p str,
    seed: u64,
}

/// Called after every step; may stop the run.
pub(super) type Progress<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

impl<'p> Job<'p> {
    /// Returns the runs of a plan, in order: by policy, age, seed.
    pub fn all(protocol: &'p Protocol, plan: &'p ProtocolPlan) -> Vec<Self> {
        let mut out = Vec::new();
        for policy in &plan.policies {
            for &age in plan.ages(protocol) {
                for seed in 0..plan.seeds {
                    let short = policy.chars().take(40);
                    let plain: String = short
                        .map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '_' })
                        .collect();
                    // policies whose names look alike are distinguished
                    let crc = crc32fast::hash(policy.as_bytes());
                    out.push(Self {
                        protocol,
                        plan,
                        name: format!("age{age}-{plain}-{crc:08x}-seed{seed}"),
                        age,
                        policy,
                        seed,
                    });
                }
            }
        }
        out
    }

    /// Returns a number that identifies the results of this run.
    fn identity(&self) -> u32 {
        let (protocol, plan) = (self.protocol, self.plan);
        let about = format!(
            "{}\n{}\n{}\n{}\n{}\n{}\n{}",
            env!("CARGO_PKG_VERSION"),
            protocol.text,
            plan.keys,
            plan.length,
            self.age,
            self.policy,
            self.seed
        );
        crc32fast::hash(about.as_bytes())
    }

    /// Reads the result from the folder, if it is there, or performs the run.
    pub fn run_or_read(&self, dir: &Path, progress: Progress<'_>) -> Result<ProtocolRun, ProtocolError> {
        let path = dir.join("runs").join(format!("{}.json", self.name));
        let kept = files::read(&path, Limits::DEFAULT.document_bytes as u64).ok();
        let kept = kept.and_then(|bytes| serde_json::from_slice::<ProtocolRun>(&bytes).ok());
        if let Some(kept) = kept.filter(|kept| kept.identity == self.identity()) {
            return Ok(kept);
        }
        let run = self.run(&dir.join("records").join(&self.name), progress)?;
        let text = json::text(&run) + "\n";
        replace_file(&path, text.as_bytes()).map_err(|source| ProtocolError::Io { path, source })?;
        Ok(run)
    }

    fn run(&self, records: &Path, progress: Progress<'_>) -> Result<ProtocolRun, ProtocolError> {
        let mut run = ProtocolRun {
            name: self.name.clone(),
            identity: self.identity(),
            age: self.age,
            policy: self.policy.to_string(),
            seed: self.seed,
            values: BTreeMap::new(),
        };
        let mut tracks = BTreeMap::new();
        for condition in &self.protocol.conditions {
            let config = self.config(condition)?;
            let folder = Folder::new(records.join(&condition.name), self.plan.keep_records)?;
            let samples = self
                .perform(condition, config, &folder, &mut tracks, progress)
                .map_err(|error| match error {
                    EpisodeError::Stopped { .. } => ProtocolError::Stopped { done: 0, planned: 0 },
                    source => ProtocolError::Run {
                        run: format!("{}, {}", self.name, condition.name),
                        source: Box::new(source),
                    },
                })?;
            run.values.insert(condition.name.clone(), samples);
        }
        if !self.plan.keep_records {
            // an empty folder
            let _ = std::fs::remove_dir(records);
        }
        Ok(run)
    }

    /// Returns the configuration of a condition, with an episode of one trial.
    fn config(&self, condition: &Condition) -> Result<Config, ProtocolError> {
        let mut config = self.protocol.configured(condition, &self.plan.keys, Some(self.age))?;
        if let Some(fixture) = &self.protocol.fixture {
            fixture
                .add_to(&mut config)
                .map_err(|reason| ProtocolError::Config { reason })?;
        }
        let steps = self.steps(&config);
        config.max_episode_steps = steps.into_iter().flatten().sum();
        config.seed = self.seed;
        Ok(config)
    }

    fn steps(&self, config: &Config) -> TrialSteps {
        self.plan.steps(self.protocol, super::plan::step(config))
    }

    fn perform(
        &self,
        condition: &Condition,
        config: Config,
        folder: &Folder,
        tracks: &mut BTreeMap<String, Track>,
        progress: Progress<'_>,
    ) -> Result<rules::PhaseValues, EpisodeError> {
        let failed = |source: EnvError| EpisodeError::Env {
            episode: 0,
            source: Box::new(source),
        };
        let steps = self.steps(&config);
        let env = Blueprint::new(config)
            .and_then(|blueprint| blueprint.env())
            .map_err(failed)?;
        let policy = PolicySource::new(self.policy).open(self.plan.limit)?;
        let mut performer = Performer::new(self.protocol, condition, env, policy, &folder.path, self.policy)?;
        performer.follow(tracks);
        let seed = match condition.yoke {
            Some(_) => self.seed + OTHER_INFANT,
            None => self.seed,
        };
        for trial in 0..self.plan.trials(self.protocol) {
            performer.trial(trial, seed, &steps, progress)?;
        }
        let (samples, track) = performer.end()?;
        tracks.insert(condition.name.clone(), track);
        Ok(rules::evaluate(self.protocol, &samples))
    }
}

/// The folder of a record, which is removed afterwards unless it is kept.
struct Folder {
    path: PathBuf,
    keep: bool,
}

impl Folder {
    fn new(path: PathBuf, keep: bool) -> Result<Self, ProtocolError> {
        // what a run that was broken off has left
        match std::fs::remove_dir_all(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(ProtocolError::Io { path, source }),
            _ => Ok(Self { path, keep }),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.keep {
            // it is not there without a record
            let _ = std::fs::remove_dir_all(&self.path);
        }
    }
}
