//! A run of a benchmark.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::{BenchmarkError, BenchmarkPlan, env_error, policy_error};
use crate::config::Config;
use crate::env::{Blueprint, Env, Info};
use crate::eval::{EpisodeError, Measures, Score};
use crate::files::{self, replace_file};
use crate::json;
use crate::limits::Limits;
use crate::policy::{Policy, PolicySource};
use crate::runs::{Record, RecordOptions, Recorder};

/// Numbers of steps after which a run is scored.
const MARKS: [u64; 5] = [1_000, 10_000, 100_000, 1_000_000, 10_000_000];

/// A run of a benchmark: a configuration, a policy and a seed.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchmarkJob {
    /// Its name, which its files carry.
    pub name: String,
    stem: String,
    config: Config,
    policy: String,
    seed: u64,
    steps: u64,
    record: u64,
    evaluate: u64,
}

/// The result of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RunResult {
    /// Its name.
    pub name: String,
    /// CRC-32 of everything that decides the result, including the version of babybench.
    pub identity: u32,
    /// The file of the configuration, without its ending.
    pub config: String,
    /// The behavior.
    pub behavior: String,
    /// The age of MIMo's body, months.
    pub age: Option<f64>,
    /// The policy.
    pub policy: String,
    /// The seed.
    pub seed: u64,
    /// Number of steps.
    pub steps: u64,
    /// Number of episodes. The last one may be truncated.
    pub episodes: u64,
    /// The score of all episodes; none for tasks.
    pub score: Option<f64>,
    /// Scores of the episodes that had ended after each given number of steps, by that number.
    pub score_at: BTreeMap<u64, f64>,
    /// Mean number of parts that both hands touch in an episode.
    pub parts_per_episode: Option<f64>,
    /// Mean return of a task's episodes.
    pub mean_return: Option<f64>,
    /// Share of the episodes of a task that end in success.
    pub successes: Option<f64>,
    /// The score of the following evaluation, in which learning policies apply what they have learned.
    #[serde(default)]
    pub evaluated_score: Option<f64>,
    /// Mean number of parts that both hands touch in an episode of the evaluation.
    #[serde(default)]
    pub evaluated_parts: Option<f64>,
    /// The measures of the recorded episodes.
    pub measures: Option<Measures>,
    /// Steps per second of this run, in one thread, while the machine may have done other work.
    pub steps_per_second: f64,
}

impl BenchmarkPlan {
    /// Returns the runs, in order: by configuration, age, policy, seed.
    ///
    /// # Errors
    /// A configuration that cannot be read or is not allowed at an age.
    pub fn jobs(&self) -> Result<Vec<BenchmarkJob>, BenchmarkError> {
        let mut out = Vec::new();
        for file in &self.configs {
            let config = Config::from_file(self.dir.join(file))?;
            let stem = Path::new(file)
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            for &age in &self.ages {
                let mut config = config.clone();
                if age.is_some() {
                    // an age of the plan takes the place of a schedule
                    config.keep_age(age);
                }
                for policy in &self.policies {
                    for seed in 0..self.seeds {
                        out.push(BenchmarkJob::new(&stem, &config, policy, seed, self));
                    }
                }
            }
        }
        Ok(out)
    }
}

impl BenchmarkJob {
    pub(super) fn new(stem: &str, config: &Config, policy: &str, seed: u64, plan: &BenchmarkPlan) -> Self {
        let plain = |text: &str| -> String {
            let short = text.chars().take(40);
            short
                .map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '_' })
                .collect()
        };
        let age = config.age.map_or_else(String::new, |age| format!("-age{age}"));
        // policies whose names look alike are distinguished
        let name = format!(
            "{}{age}-{}-{:08x}-seed{seed}",
            plain(stem),
            plain(policy),
            crc32fast::hash(policy.as_bytes())
        );
        Self {
            name,
            stem: stem.to_string(),
            config: Config { seed, ..config.clone() },
            policy: policy.to_string(),
            seed,
            steps: plan.steps,
            record: plan.record,
            evaluate: plan.evaluate,
        }
    }

    /// Returns a number that identifies the results of this run.
    fn identity(&self) -> u32 {
        let about = format!(
            "{}\n{}\n{}\n{}\n{}\n{}",
            env!("CARGO_PKG_VERSION"),
            self.config.to_yaml(),
            self.policy,
            self.steps,
            self.record,
            self.evaluate
        );
        crc32fast::hash(about.as_bytes())
    }

    /// Reads the result from the folder, if it is there, or performs the run.
    pub(super) fn run_or_read(
        &self,
        dir: &Path,
        limit: Duration,
        progress: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<RunResult, BenchmarkError> {
        let path = dir.join("runs").join(format!("{}.json", self.name));
        let kept = files::read(&path, Limits::DEFAULT.document_bytes as u64).ok();
        let kept = kept.and_then(|bytes| serde_json::from_slice::<RunResult>(&bytes).ok());
        if let Some(kept) = kept.filter(|kept| kept.identity == self.identity()) {
            for _ in 0..kept.steps {
                let _ = progress();
            }
            return Ok(kept);
        }
        let result = self
            .run(&dir.join("records").join(&self.name), limit, progress)
            .map_err(|e| match e {
                EpisodeError::Stopped { .. } => BenchmarkError::Stopped { done: 0, planned: 0 },
                other => BenchmarkError::Run {
                    run: self.name.clone(),
                    source: Box::new(other),
                },
            })?;
        let text = json::text(&result) + "\n";
        replace_file(&path, text.as_bytes()).map_err(|source| BenchmarkError::Io { path, source })?;
        Ok(result)
    }

    fn run(
        &self,
        record_dir: &Path,
        limit: Duration,
        progress: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<RunResult, EpisodeError> {
        let blueprint = Blueprint::new(self.config.clone()).map_err(env_error(0))?;
        let mut env = blueprint.env().map_err(env_error(0))?;
        let mut policy = PolicySource::new(&self.policy).open(limit).map_err(policy_error)?;
        let mut recorder = self.recorder(&env, record_dir)?;
        let (mut records, mut steps) = (Vec::<Info>::new(), 0);
        let started = Instant::now();
        while steps < self.steps {
            let episode = records.len() as u64;
            // one seed for the whole run
            env.reset((episode == 0).then_some(self.seed))
                .map_err(env_error(episode))?;
            let recorder = recorder.as_mut().filter(|_| episode < self.record);
            steps += run_episode(
                &mut env,
                policy.as_mut(),
                episode,
                self.steps - steps,
                recorder,
                progress,
            )?;
            records.push(env.info().clone());
        }
        let seconds = started.elapsed().as_secs_f64().max(f64::MIN_POSITIVE);
        policy.settle();
        let mut evaluated = Vec::<Info>::new();
        for episode in records.len() as u64..records.len() as u64 + self.evaluate {
            env.reset(None).map_err(env_error(episode))?;
            run_episode(&mut env, policy.as_mut(), episode, u64::MAX, None, progress)?;
            evaluated.push(env.info().clone());
        }
        self.result(&records, &evaluated, steps, steps as f64 / seconds, record_dir)
    }

    fn recorder(&self, env: &Env, dir: &Path) -> Result<Option<Recorder>, EpisodeError> {
        if self.record == 0 {
            return Ok(None);
        }
        // what a run that was broken off has left
        if Record::is_in(dir) {
            std::fs::remove_dir_all(dir).map_err(|source| EpisodeError::Observer(source.into()))?;
        }
        let options = RecordOptions {
            policy: self.policy.clone(),
            ..RecordOptions::default()
        };
        Ok(Some(Recorder::create(dir, env, options)?))
    }

    fn result(
        &self,
        records: &[Info],
        evaluated: &[Info],
        steps: u64,
        steps_per_second: f64,
        record_dir: &Path,
    ) -> Result<RunResult, EpisodeError> {
        let compat = self.config.compat;
        let score = |records: &[Info]| Score::new(records, compat).ok();
        let (all, evaluated) = (score(records), score(evaluated));
        let mut score_at = BTreeMap::new();
        for mark in MARKS.into_iter().filter(|mark| *mark <= steps) {
            if let Ok(score) = Score::after(records, mark, compat) {
                score_at.insert(mark, score.value);
            }
        }
        let tasks: Vec<_> = records.iter().filter_map(|record| record.behavior.task()).collect();
        let mean = |sum: f64| (!tasks.is_empty()).then(|| sum / tasks.len() as f64);
        let measures = match self.record {
            0 => None,
            _ => Measures::mean(&Measures::of_record(&Record::open(record_dir)?)?),
        };
        Ok(RunResult {
            name: self.name.clone(),
            identity: self.identity(),
            config: self.stem.clone(),
            behavior: self.config.behavior.to_string(),
            age: self.config.age,
            policy: self.policy.clone(),
            seed: self.seed,
            steps,
            episodes: records.len() as u64,
            score: all.as_ref().map(|score| score.value),
            score_at,
            parts_per_episode: all.and_then(|score| score.parts_per_episode),
            mean_return: mean(tasks.iter().map(|task| task.episode_return).sum()),
            successes: mean(tasks.iter().filter(|task| task.outcome.is_success).count() as f64),
            evaluated_score: evaluated.as_ref().map(|score| score.value),
            evaluated_parts: evaluated.and_then(|score| score.parts_per_episode),
            measures,
            steps_per_second,
        })
    }
}

/// Runs an episode of an environment that has been reset, of at most `most` steps. Returns their number.
fn run_episode(
    env: &mut Env,
    policy: &mut dyn Policy,
    episode: u64,
    most: u64,
    mut recorder: Option<&mut Recorder>,
    progress: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<u64, EpisodeError> {
    policy.begin(env, episode).map_err(policy_error)?;
    if let Some(recorder) = &mut recorder {
        recorder.begin(env, episode);
    }
    let (mut steps, mut action) = (0, Vec::new());
    while steps < most && !env.over() {
        policy.act(env, &mut action).map_err(policy_error)?;
        match &mut recorder {
            Some(recorder) => recorder.step(env, &action)?,
            None => {
                env.step(&action).map_err(env_error(episode))?;
            }
        }
        steps += 1;
        if progress().is_break() {
            let (done, planned) = (0, 0);
            return Err(EpisodeError::Stopped { done, planned });
        }
    }
    if let Some(recorder) = recorder {
        recorder.end(env)?;
    }
    Ok(steps)
}
