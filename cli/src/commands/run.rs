//! `babybench run`

use std::error::Error;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use babybench::config::Compat;
use babybench::env::EnvStage;
use babybench::policy::Policy;
use babybench::runs::Recorder;
use babybench::{AutoresetMode, Blueprint, Env, VectorEnv};
use clap::Args;
use indicatif::ProgressBar;

use super::many::{Babbling, Many, say_threads};
use super::record::Recording;
use super::{Source, progress_bar};
use crate::arguments::{count, number};
use crate::print::say;

/// Arguments of `run`.
#[derive(Args)]
pub struct Run {
    #[command(flatten)]
    source: Source,
    /// Number of episodes
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = count::<u64>)]
    episodes: u64,
    /// Maximum number of steps of an episode; max_episode_steps of the configuration by default
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>)]
    steps: Option<u64>,
    /// Random seed; that of the configuration by default
    #[arg(long, allow_negative_numbers = true, value_parser = number::<u64>)]
    seed: Option<u64>,
    #[command(flatten)]
    babbling: Babbling,
    #[command(flatten)]
    many: Many,
    #[command(flatten)]
    recording: Recording,
    /// Do not show a progress bar
    #[arg(long)]
    quiet: bool,
}

/// Time spent in each stage since the start.
struct Clock {
    spent: Vec<(EnvStage, Duration)>,
    since: Option<(EnvStage, Instant)>,
}

impl Clock {
    fn new() -> Self {
        Self {
            spent: EnvStage::all().map(|stage| (stage, Duration::ZERO)).collect(),
            since: None,
        }
    }

    fn enter(&mut self, stage: Option<EnvStage>) {
        let now = Instant::now();
        if let Some((last, since)) = self.since
            && let Some((_, spent)) = self.spent.iter_mut().find(|(stage, _)| *stage == last)
        {
            *spent += now - since;
        }
        self.since = stage.map(|s| (s, now));
    }
}

/// The counters of a run.
#[derive(Default)]
struct Tally {
    steps: u64,
    contacts: usize,
    most_contacts: usize,
    iterations: usize,
    stepping: Duration,
}

impl Run {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let started = Instant::now();
        let blueprint = self.source.blueprint(Compat::Api)?;
        if let Some(envs) = self.many.envs() {
            return self.many_envs(&blueprint, envs, started);
        }
        let mut env = blueprint.env()?;
        let construction = started.elapsed();
        let config = blueprint.config();
        say!("{}", description(&env))?;
        let clock = Arc::new(Mutex::new(Clock::new()));
        let probe = clock.clone();
        env.by_hand()
            .set_probe(Some(Arc::new(move |stage| lock(&probe).enter(stage))));

        let length = self.steps.unwrap_or(config.max_episode_steps);
        let bar = progress_bar(self.episodes.saturating_mul(length), self.quiet)?;
        let mut seed = self.seed;
        let mut tally = Tally::default();
        let mut policy = self.babbling.policy();
        let mut recorder = self.recording.recorder(&env, &self.babbling.name())?;
        for episode in 0..self.episodes {
            env.reset(seed.take())?;
            policy.begin(&mut env, episode)?;
            if let Some(recorder) = &mut recorder {
                recorder.begin(&env, episode);
            }
            let before = tally.stepping;
            tally.episode(&mut env, &mut *policy, recorder.as_mut(), length, &clock, &bar)?;
            if let Some(recorder) = &mut recorder {
                let writing = Instant::now();
                recorder.end(&env)?;
                let (stepping, writing) = (tally.stepping - before, writing.elapsed());
                bar.suspend(|| {
                    say!("episode {episode}: recorded in {stepping:.1?} of steps and {writing:.1?} of writing")
                })?;
            }
            bar.suspend(|| say!("episode {episode}: {}", env.info().to_json()))?;
        }
        bar.finish_and_clear();
        say!("construction {:.0} ms", construction.as_secs_f64() * 1e3)?;
        tally.print(blueprint.dt(), &lock(&clock).spent)?;
        self.recording.say_next()?;
        say_peak_memory()
    }

    /// Runs the episodes in many environments at once. Environment i is seeded with the seed plus i.
    fn many_envs(&self, blueprint: &Blueprint, n: usize, started: Instant) -> Result<(), Box<dyn Error>> {
        let mut envs = VectorEnv::new(blueprint, n, self.many.options(AutoresetMode::Disabled))?;
        let construction = started.elapsed();
        say_threads(&envs);
        let config = blueprint.config();
        say!("{}", description(envs.env(0)?))?;
        let length = self
            .steps
            .unwrap_or(config.max_episode_steps)
            .min(config.max_episode_steps);
        let bar = progress_bar(
            self.episodes.saturating_mul(length).saturating_mul(n as u64),
            self.quiet,
        )?;
        envs.seed_action_spaces(self.seed.unwrap_or(config.seed))?;
        let (mut babbling, mut actions) = (self.babbling.many(&envs)?, Vec::new());
        let mut recorder = self.recording.recorder_of_many(&envs, &self.babbling.name())?;
        let (mut steps, mut stepping) = (0, Duration::ZERO);
        for episode in 0..self.episodes {
            envs.reset(None)?;
            babbling.begin(&mut envs, None)?;
            if let Some(recorder) = &mut recorder {
                recorder.begin(&envs, episode)?;
            }
            for k in 1..=length {
                babbling.sample(&mut envs, &mut actions)?;
                let before = Instant::now();
                let batch = match &mut recorder {
                    Some(recorder) => recorder.step(&mut envs, &actions)?,
                    None => envs.step(&actions)?,
                };
                stepping += before.elapsed();
                steps += n as u64;
                if k % 16 == 0 {
                    bar.set_position(steps);
                }
                if let Some(failure) = batch.failures.first() {
                    return Err(format!("environment {}: {}", failure.env, failure.error).into());
                }
            }
            if let Some(recorder) = &mut recorder {
                recorder.end(&envs)?;
            }
            for i in 0..n {
                let info = envs.env(i)?.info().to_json();
                bar.suspend(|| say!("episode {episode}, environment {i}: {info}"))?;
            }
        }
        bar.finish_and_clear();
        say!("construction {:.0} ms", construction.as_secs_f64() * 1e3)?;
        let seconds = stepping.as_secs_f64();
        let per_second = steps as f64 / seconds;
        say!(
            "{steps} steps of {n} environments on {} threads in {seconds:.2} s: {:.0} us per step, {:.1} times real time",
            envs.threads(),
            1e6 / per_second,
            per_second * blueprint.dt()
        )?;
        say!("environment steps per second: {per_second:.0}")?;
        self.recording.say_next()?;
        say_peak_memory()
    }
}

/// Describes an environment in a line.
fn description(env: &Env) -> String {
    let config = env.config();
    let spaces = env.observation_space();
    let scene = if env.info().behavior.task().is_some() {
        String::new() // a task has a scene of its own
    } else {
        format!(" in {}", config.scene)
    };
    format!(
        "{}{scene}, {}: {} joints, {} actuators, {} numbers observed",
        config.behavior,
        config.actuation_model,
        env.senses().proprioception().joints().len(),
        env.blueprint().actuation().actuators().len(),
        spaces.iter().map(|s| s.shape.iter().product::<usize>()).sum::<usize>(),
    )
}

/// Prints the peak memory, if the system reports it.
fn say_peak_memory() -> Result<(), Box<dyn Error>> {
    if let Some(kib) = peak_memory() {
        say!("peak memory of the process: {:.1} MiB", kib as f64 / 1024.0)?;
    }
    Ok(())
}

impl Tally {
    /// Steps through an episode with random actions.
    fn episode(
        &mut self,
        env: &mut Env,
        policy: &mut dyn Policy,
        mut recorder: Option<&mut Recorder>,
        length: u64,
        clock: &Mutex<Clock>,
        bar: &ProgressBar,
    ) -> Result<(), Box<dyn Error>> {
        let mut action = Vec::new();
        lock(clock).enter(None);
        for k in 0..length {
            policy.act(env, &mut action)?;
            let before = Instant::now();
            match &mut recorder {
                Some(recorder) => recorder.step(env, &action)?,
                None => {
                    env.step(&action)?;
                }
            }
            lock(clock).enter(None);
            self.stepping += before.elapsed();
            self.steps += 1;
            let n = env.state().contact.len();
            self.contacts += n;
            self.most_contacts = self.most_contacts.max(n);
            self.iterations += env.state().solver_iterations;
            if k % 16 == 15 {
                bar.inc(16);
            }
            if env.last_step().over() {
                break;
            }
        }
        Ok(())
    }

    /// Prints speed, the time in each stage, and means. `step` is the simulated time of a step, s.
    fn print(&self, step: f64, spent: &[(EnvStage, Duration)]) -> io::Result<()> {
        let n = self.steps.max(1) as f64;
        let per_step = |d: Duration| d.as_secs_f64() * 1e6 / n;
        let seconds = self.stepping.as_secs_f64();
        say!(
            "{} steps in {seconds:.2} s: {:.0} steps/s, {:.0} us per step, {:.1} times real time",
            self.steps,
            self.steps as f64 / seconds,
            per_step(self.stepping),
            self.steps as f64 * step / seconds
        )?;
        for (stage, spent) in spent {
            let share = 100.0 * spent.as_secs_f64() / seconds.max(f64::MIN_POSITIVE);
            say!("  {:12} {:8.1} us {share:5.1} %", stage.name(), per_step(*spent))?;
        }
        say!(
            "contacts per step: mean {:.1}, at most {}; solver iterations per step: mean {:.1}",
            self.contacts as f64 / n,
            self.most_contacts,
            self.iterations as f64 / n
        )
    }
}

fn lock(clock: &Mutex<Clock>) -> MutexGuard<'_, Clock> {
    clock.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Returns the peak resident memory in KiB, if the system reports it (Linux).
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok()
}
