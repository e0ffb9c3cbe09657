//! `babybench train`

use std::error::Error;
use std::time::{Duration, Instant};

use babybench::config::Compat;
use babybench::eval::Score;
use babybench::policy::{DEFAULT_LIMIT, Policy, PolicyError, PolicySource};
use babybench::runs::logs::{TrainingTotals, read_recent, training_path};
use babybench::runs::{RunVector, TrainingLog, start_training};
use babybench::{AutoresetMode, Config};
use clap::Args;
use indicatif::ProgressBar;

use super::many::{Babbling, Many, say_threads};
use super::{Source, progress_bar};
use crate::arguments::{count, number, word};
use crate::interrupt::{Interrupt, Interrupted};
use crate::print::{note, say};

/// Training logs are saved at least this often, under `compat: api`.
const SAVE_EVERY: Duration = Duration::from_secs(5);

/// Arguments of `train`: the kit's random policies for both behaviors, and policies that learn.
#[derive(Args)]
pub struct Train {
    #[command(flatten)]
    source: Source,
    /// Total number of steps, over all episodes
    #[arg(long, value_name = "STEPS", default_value_t = 10_000, allow_negative_numbers = true, value_parser = count::<u64>)]
    train_for: u64,
    /// Resume the training log in save_dir, whose steps count, instead of overwriting it
    #[arg(long)]
    resume: bool,
    /// Random seed; that of the configuration by default
    #[arg(long, allow_negative_numbers = true, value_parser = number::<u64>)]
    seed: Option<u64>,
    /// Policy instead of random actions, as for evaluate: babbling learns to touch itself while it acts, watching to look at its hands.
    /// No log holds what these have learned, so --resume refuses them
    #[arg(long, conflicts_with_all = ["noise", "envs"])]
    policy: Option<String>,
    #[command(flatten)]
    babbling: Babbling,
    #[command(flatten)]
    many: Many,
    /// Do not show a progress bar
    #[arg(long)]
    quiet: bool,
}

impl Train {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let interrupt = Interrupt::watch();
        let blueprint = self.source.blueprint(Compat::Api)?;
        let config = blueprint.config();
        if self.resume {
            self.refuse_forgetting(config)?;
        } else {
            look_at_old_log(config)?;
        }
        if let Some(n) = self.many.envs() {
            let options = self.many.options(AutoresetMode::Disabled);
            let envs = RunVector::start(&blueprint, n, options, self.resume)?;
            return self.many_envs(envs, config, &interrupt);
        }
        // before an existing log is replaced, so that a policy that cannot be opened costs nothing
        let mut policy = self.policy()?;
        let mut env = start_training(&blueprint, self.resume)?;
        let (seed, done, bar) = self.begin(env.log(), config)?;
        env.seed_action_space(seed);
        let (mut steps, mut over, mut saved) = (done, true, Instant::now());
        let (mut action, mut episode) = (Vec::new(), 0);
        while steps < self.train_for && !interrupt.wanted() {
            if over {
                env.reset(None)?;
                policy.begin(env.env_mut(), episode)?;
                episode += 1;
            }
            policy.act(env.env_mut(), &mut action)?;
            env.step(&action)?;
            over = env.last_step().over();
            steps += 1;
            if steps % 16 == 0 {
                bar.set_position(steps);
                if config.compat == Compat::Api && saved.elapsed() >= SAVE_EVERY {
                    env.log().map_or(Ok(()), |log| log.save())?;
                    saved = Instant::now();
                }
            }
        }
        bar.finish_and_clear();
        if over && steps > done && config.compat == Compat::Reference {
            // only a reset logs an episode there
            env.reset(None)?;
        }
        env.finish_training()?;
        self.print_result(env.log(), config, steps)
    }

    fn policy(&self) -> Result<Box<dyn Policy>, PolicyError> {
        match &self.policy {
            Some(name) => PolicySource::new(name).open(DEFAULT_LIMIT),
            None => Ok(self.babbling.policy()),
        }
    }

    /// Returns whether the policy learns while it acts.
    fn learns(&self) -> bool {
        self.policy
            .as_deref()
            .is_some_and(|name| PolicySource::new(name).learns())
    }

    /// Returns an error when a learning policy is to resume a log, because its memory is lost.
    fn refuse_forgetting(&self, config: &Config) -> Result<(), String> {
        let path = training_path(&config.save_dir);
        if !self.learns() || !path.exists() {
            return Ok(());
        }
        let (path, name) = (path.display(), self.policy.as_deref().unwrap_or_default());
        Err(format!(
            "--resume continues from {path}, but what the policy {name} had learned by its end was not saved: train without --resume, in \
             a save_dir of its own if the log is to stay"
        ))
    }

    /// Trains in many environments at once. Environment i has the seed plus i.
    fn many_envs(&self, mut envs: RunVector, config: &Config, interrupt: &Interrupt) -> Result<(), Box<dyn Error>> {
        say_threads(&envs);
        let (seed, done, bar) = self.begin(Some(envs.log()), config)?;
        envs.vector_mut().seed_action_spaces(seed)?;
        let (mut steps, mut saved) = (done, Instant::now());
        let (mut babbling, mut actions, mut begun) = (self.babbling.many(&envs)?, Vec::new(), Vec::new());
        while steps < self.train_for && !interrupt.wanted() {
            begun.clear();
            begun.extend_from_slice(envs.start_episodes()?);
            babbling.begin(envs.vector_mut(), Some(&begun))?;
            babbling.sample(envs.vector_mut(), &mut actions)?;
            // the last steps are those of the first environments
            let n = usize::try_from(self.train_for - steps).map_or(envs.len(), |rest| rest.min(envs.len()));
            actions.truncate(n * envs.single_action_space().len());
            for failure in envs.step(&actions)?.failures {
                bar.suspend(|| note!("warning: environment {} restarts: {}", failure.env, failure.error));
            }
            steps += n as u64;
            bar.set_position(steps);
            if config.compat == Compat::Api && saved.elapsed() >= SAVE_EVERY {
                envs.log().save()?;
                saved = Instant::now();
            }
        }
        bar.finish_and_clear();
        envs.finish_training()?;
        self.print_result(Some(envs.log()), config, steps)
    }

    /// Prints what is resumed. Returns the seed of this run, the number of earlier steps, and a progress bar.
    fn begin(&self, before: Option<&TrainingLog>, config: &Config) -> Result<(u64, u64, ProgressBar), Box<dyn Error>> {
        let before = before.map_or_else(TrainingTotals::default, |log| *log.totals());
        let (episodes, done) = (before.records as u64, before.steps);
        if self.resume && episodes > 0 {
            say!("resuming after {episodes} episodes, {done} steps")?;
        }
        let bar = progress_bar(self.train_for, self.quiet)?;
        bar.set_position(done);
        bar.reset_eta();
        // a resumed run must not repeat the actions of the earlier run
        let seed = self.seed.unwrap_or(config.seed).wrapping_add(episodes);
        Ok((seed, done, bar))
    }

    /// Prints the contents of the log, and its score.
    fn print_result(&self, log: Option<&TrainingLog>, config: &Config, steps: u64) -> Result<(), Box<dyn Error>> {
        let Some(log) = log else { return Ok(()) };
        let (totals, dir) = (log.totals(), word(&config.save_dir));
        let n = totals.records;
        if steps < self.train_for {
            let goal = self.train_for;
            let next = if self.learns() {
                "what the policy has learned is lost"
            } else {
                "--resume continues from there"
            };
            let done = format!("{n} records, {steps} of {goal} steps are in {dir}; {next}");
            return Err(Interrupted(done).into());
        }
        say!("{n} records, {steps} steps: {}", config.save_dir)?;
        if totals.tasks > 0 {
            let (mean, successes) = (totals.returns / totals.tasks as f64, totals.successes);
            say!(
                "mean return {mean:.3}, {successes} of {} episodes end in success",
                totals.tasks
            )?;
            say!("Details: babybench report {dir}")?;
            return Ok(());
        }
        match Score::new(&log.recent().records, config.compat) {
            Ok(score) => {
                say!("{score}")?;
                if score.episodes == 0 {
                    say!(
                        "No record counts yet (under compat: reference the oldest never does); train for at least two episodes"
                    )?;
                }
                say!("Details: babybench score {dir}, babybench report {dir}")?;
            }
            Err(e) => say!("No score yet: {e}")?,
        }
        Ok(())
    }
}

/// Returns an error if the training log is of another behavior, and warns before one is replaced.
fn look_at_old_log(config: &Config) -> Result<(), Box<dyn Error>> {
    let path = training_path(&config.save_dir);
    if !path.exists() {
        return Ok(());
    }
    let path = path.display();
    match read_recent(training_path(&config.save_dir), 1) {
        Ok(log) => match log.records.first().map(|r| r.behavior.name()) {
            Some(found) if found != config.behavior.name() => {
                let wanted = config.behavior;
                return Err(format!(
                    "{path} is the training log of a run with behavior {found}, but the configuration is for {wanted}; \
                     choose another save_dir or delete the log"
                )
                .into());
            }
            Some(_) => note!(
                "warning: replacing the training log of {} records in {} (--resume continues it)",
                log.total,
                config.save_dir
            ),
            None => {}
        },
        Err(e) => note!("warning: replacing a training log that cannot be read: {e}"),
    }
    Ok(())
}
