//! `babybench train`

use std::error::Error;
use std::time::{Duration, Instant};

use babybench::config::Compat;
use babybench::eval::{Score, start_training, start_training_from};
use babybench::mjcf_loader::DirAssets;
use clap::Args;

use super::{Source, progress_bar};

/// Training logs are saved at least this often, under `compat: api`.
const SAVE_EVERY: Duration = Duration::from_secs(5);

/// Arguments of `train`: the kit's random policies for both behaviors.
#[derive(Args)]
pub struct Train {
    #[command(flatten)]
    source: Source,
    /// Steps in all, over all episodes.
    #[arg(long, value_name = "STEPS", default_value_t = 10_000)]
    train_for: u64,
    /// Go on with the training log in save_dir, whose steps count, instead of overwriting it.
    #[arg(long)]
    resume: bool,
    /// Seed of the random choices, if not that of the configuration.
    #[arg(long)]
    seed: Option<u64>,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
}

impl Train {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let blueprint = self.source.blueprint(Compat::Api)?;
        let config = blueprint.config();
        let mut env = match &self.source.assets {
            Some(dir) => start_training_from(&blueprint, &DirAssets::new(dir)?, self.resume)?,
            None => start_training(&blueprint, self.resume)?,
        };
        let before = env.training_log().map_or(&[][..], |log| log.records());
        let (episodes, done) = (before.len() as u64, before.iter().map(|r| r.steps).sum::<u64>());
        if self.resume && episodes > 0 {
            println!("going on after {episodes} episodes, {done} steps");
        }
        let bar = progress_bar(self.train_for, self.quiet)?;
        bar.set_position(done);
        bar.reset_eta();
        // a resumed run must not repeat the actions of the run before
        let seed = self.seed.unwrap_or(config.seed).wrapping_add(episodes);
        env.seed_action_space(seed);
        let (mut steps, mut over, mut saved) = (done, true, Instant::now());
        let mut action = Vec::new();
        while steps < self.train_for {
            if over {
                env.reset(None)?;
            }
            env.sample_action(&mut action);
            over = env.step(&action)?.truncated;
            steps += 1;
            if steps % 16 == 0 {
                bar.set_position(steps);
                if config.compat == Compat::Api && saved.elapsed() >= SAVE_EVERY {
                    env.training_log().map_or(Ok(()), |log| log.save())?;
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
        let records = env.training_log().map_or(&[][..], |log| log.records());
        println!("{} records, {steps} steps: {}", records.len(), config.save_dir);
        match Score::new(records) {
            Ok(score) => println!("{score}\nDetails: babybench score {}", config.save_dir),
            Err(e) => println!("No score yet: {e}"),
        }
        Ok(())
    }
}
