//! `babybench run`

use std::error::Error;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use babybench::config::Compat;
use babybench::physics::Stage;
use clap::Args;

use super::arguments::{count, number};
use super::print::say;
use super::{Source, progress_bar};

/// Arguments of `run`.
#[derive(Args)]
pub struct Run {
    #[command(flatten)]
    source: Source,
    /// Number of episodes.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = count::<u64>)]
    episodes: u64,
    /// Steps of an episode, if not those of the configuration.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u64>)]
    steps: Option<u64>,
    /// Seed of the random choices, if not that of the configuration.
    #[arg(long, allow_negative_numbers = true, value_parser = number::<u64>)]
    seed: Option<u64>,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
}

/// Time spent in each stage since the start.
#[derive(Default)]
struct Clock {
    spent: [Duration; Stage::ALL.len()],
    since: Option<(Stage, Instant)>,
}

impl Clock {
    fn enter(&mut self, stage: Option<Stage>) {
        let now = Instant::now();
        if let Some((last, since)) = self.since {
            self.spent[last as usize] += now - since;
        }
        self.since = stage.map(|s| (s, now));
    }
}

impl Run {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let started = Instant::now();
        let blueprint = self.source.blueprint(Compat::Api)?;
        let mut env = blueprint.env()?;
        let construction = started.elapsed();
        let config = blueprint.config();
        say!(
            "{} in {}, {}: {} joints, {} actuators, {} numbers observed",
            config.behavior,
            config.scene,
            config.actuation_model,
            env.proprioception().joints().len(),
            env.model().nu(),
            env.observation_space()
                .iter()
                .map(|s| s.shape.iter().product::<usize>())
                .sum::<usize>(),
        )?;
        let clock = Arc::new(Mutex::new(Clock::default()));
        let probe = clock.clone();
        env.set_probe(Some(Box::new(move |stage| lock(&probe).enter(stage))));

        let length = self.steps.unwrap_or(config.max_episode_steps);
        let bar = progress_bar(self.episodes.saturating_mul(length), self.quiet)?;
        let mut seed = self.seed;
        let mut action = Vec::new();
        let (mut steps, mut contacts, mut most, mut iterations) = (0_u64, 0_usize, 0_usize, 0_usize);
        let mut stepping = Duration::ZERO;
        for episode in 0..self.episodes {
            env.reset(seed.take())?;
            lock(&clock).enter(None);
            for k in 0..length {
                env.sample_action(&mut action);
                let before = Instant::now();
                let truncated = env.step(&action)?.truncated;
                lock(&clock).enter(None);
                stepping += before.elapsed();
                steps += 1;
                let n = env.state().contacts.len();
                (contacts, most) = (contacts + n, most.max(n));
                iterations += env.state().solver_iterations;
                if k % 16 == 15 {
                    bar.inc(16);
                }
                if truncated {
                    break;
                }
            }
            bar.suspend(|| say!("episode {episode}: {}", env.info().to_json()))?;
        }
        bar.finish_and_clear();

        let per_step = |d: Duration| d.as_secs_f64() * 1e6 / steps.max(1) as f64;
        let seconds = stepping.as_secs_f64();
        let simulated = steps as f64 * env.model().opt.timestep * f64::from(config.frame_skip);
        say!("construction {:.0} ms", construction.as_secs_f64() * 1e3)?;
        say!(
            "{steps} steps in {seconds:.2} s: {:.0} steps/s, {:.0} us per step, {:.1} times real time",
            steps as f64 / seconds,
            per_step(stepping),
            simulated / seconds
        )?;
        for (stage, spent) in Stage::ALL.iter().zip(lock(&clock).spent) {
            let share = 100.0 * spent.as_secs_f64() / seconds.max(f64::MIN_POSITIVE);
            say!("  {:12} {:8.1} us {share:5.1} %", stage.name(), per_step(spent))?;
        }
        say!(
            "contacts per step: mean {:.1}, most {most}; solver iterations per step: mean {:.1}",
            contacts as f64 / steps.max(1) as f64,
            iterations as f64 / steps.max(1) as f64
        )?;
        if let Some(kib) = peak_memory() {
            say!("peak memory of the process: {:.1} MiB", kib as f64 / 1024.0)?;
        }
        Ok(())
    }
}

fn lock(clock: &Mutex<Clock>) -> MutexGuard<'_, Clock> {
    clock.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Largest resident size so far, KiB, where the system tells (Linux).
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok()
}
