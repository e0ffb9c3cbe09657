//! Trains infants that are curious about their own bodies, and compares them with random ones.
//!
//! ```sh
//! cargo run --release -p learner
//! cargo run --release -- report results/learner/0/curious --baseline results/learner/0/random
//! ```

use std::path::{Path, PathBuf};
use std::time::Instant;

use babybench::{Blueprint, Config};
use clap::Parser;
use learner::Error;
use learner::evaluation::evaluate;
use learner::training::{Kind, Round, Settings, Training};

/// Trains infants that are curious about their own bodies, and compares them with random ones.
#[derive(Parser)]
struct Arguments {
    /// Number of trainings of each kind, with the seeds 0, 1, ..
    #[arg(long, value_name = "N", default_value_t = 1)]
    seeds: u64,
    /// Number of updates; before each, every environment runs an episode
    #[arg(long, value_name = "N", default_value_t = 100)]
    updates: usize,
    /// Number of environments
    #[arg(long, value_name = "N", default_value_t = 32)]
    envs: usize,
    /// Number of threads that step them; one for each core by default. Results do not depend on it
    #[arg(long, value_name = "T", default_value_t = 0)]
    threads: usize,
    /// Number of evaluation episodes
    #[arg(long, value_name = "N", default_value_t = 8)]
    episodes: u64,
    /// Make videos of the evaluation episodes
    #[arg(long)]
    render: bool,
    /// Folder of the logs
    #[arg(long, value_name = "DIR", default_value = "results/learner")]
    out: PathBuf,
}

/// The result of a training.
struct Outcome {
    seed: u64,
    kind: Kind,
    /// Mean of the last fifth of the rounds.
    end: Round,
    score: f64,
    /// Mean number of parts touched in an evaluation episode.
    evaluated: f64,
}

impl Arguments {
    fn train(&self, kind: Kind, seed: u64) -> Result<Outcome, Error> {
        let text = include_str!("../../../configs/config_selftouch.yml");
        let blueprint = Blueprint::new(Config {
            save_dir: self.folder(kind, seed).display().to_string(),
            seed,
            ..Config::from_yaml(text, "config_selftouch.yml")?
        })?;
        let settings = Settings {
            envs: self.envs,
            threads: self.threads,
            updates: self.updates,
            seed,
        };
        let start = Instant::now();
        let mut training = Training::new(&blueprint, kind, settings)?;
        let rounds = training.run(|k, round| {
            if k % 10 == 0 || k + 1 == self.updates {
                let Round { reward, parts } = round;
                let seconds = start.elapsed().as_secs_f64();
                println!(
                    "  update {k:3}: intrinsic reward {reward:6.3}, {parts:5.2} parts per episode, {seconds:4.0} s"
                );
            }
        })?;
        let score = training.score()?;
        let infos = evaluate(&blueprint, kind, training.into_mind(), self.episodes, self.render)?;
        let parts = infos.iter().filter_map(|info| info.behavior.touches()).flatten();
        Ok(Outcome {
            seed,
            kind,
            end: Round::end(&rounds),
            score,
            evaluated: parts.map(<[usize]>::len).sum::<usize>() as f64 / infos.len().max(1) as f64,
        })
    }

    fn folder(&self, kind: Kind, seed: u64) -> PathBuf {
        self.out.join(seed.to_string()).join(kind.name())
    }
}

fn main() -> Result<(), Error> {
    let arguments = Arguments::parse();
    let mut outcomes = Vec::new();
    for seed in 0..arguments.seeds {
        for kind in Kind::ALL {
            println!("{}, seed {seed}", kind.name());
            outcomes.push(arguments.train(kind, seed)?);
        }
    }
    println!("\n| seed | policy | score | parts per episode | in evaluation | intrinsic reward |");
    println!("|--:|---|--:|--:|--:|--:|");
    for outcome in &outcomes {
        let Outcome {
            seed,
            kind,
            end,
            score,
            evaluated,
        } = outcome;
        let (kind, Round { reward, parts }) = (kind.name(), end);
        println!("| {seed} | {kind} | {score:.3} | {parts:.1} | {evaluated:.1} | {reward:.2} |");
    }
    let quoted = |kind| shown(&arguments.folder(kind, 0));
    let (own, random) = (quoted(Kind::Curious), quoted(Kind::Random));
    println!("\nsee: cargo run --release -- report {own} --baseline {random}");
    Ok(())
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}
