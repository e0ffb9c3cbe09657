//! `babybench evaluate`

use std::error::Error;
use std::path::Path;

use babybench::config::Compat;
use babybench::eval::logs::training_path;
use babybench::eval::{
    CommandPolicy, Evaluation, Plan, Policy, PolicyError, RandomPolicy, ZeroPolicy, read_scene, run_episodes,
};
use clap::Args;

use super::{Source, progress_bar};

/// Arguments of `evaluate`.
#[derive(Args)]
pub struct Evaluate {
    #[command(flatten)]
    source: Source,
    /// Number of episodes.
    #[arg(long, default_value_t = 10)]
    episodes: u64,
    /// Most steps of an episode.
    #[arg(long, value_name = "STEPS", default_value_t = 1000)]
    duration: u64,
    /// random, zero, or a command with its arguments that reads observations (a line of JSON each) from its standard
    /// input and writes actions (a JSON list each) to its standard output.
    #[arg(long, default_value = "random")]
    policy: String,
    /// No videos.
    #[arg(long)]
    no_render: bool,
    /// Episodes at the same time.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
}

impl Evaluate {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let blueprint = self.source.blueprint(Compat::Api)?;
        let save_dir = Path::new(&blueprint.config().save_dir);
        if save_dir.join("scene.xml").exists() && read_scene(save_dir).is_ok_and(|m| m != **blueprint.model()) {
            eprintln!(
                "warning: the scene.xml in {} is of another configuration",
                save_dir.display()
            );
        }
        if training_path(save_dir).exists() {
            match Evaluation::new(&blueprint.env()?).eval_logs() {
                Ok(score) => println!("{score}"),
                Err(e) => println!("No training score: {e}"),
            }
        }
        let plan = Plan {
            episodes: self.episodes,
            duration: self.duration,
            render: !self.no_render,
            jobs: self.jobs,
        };
        let policy = || -> Result<Box<dyn Policy>, PolicyError> {
            Ok(match self.policy.as_str() {
                "random" => Box::new(RandomPolicy),
                "zero" => Box::new(ZeroPolicy),
                command => Box::new(CommandPolicy::start(command)?),
            })
        };
        let length = self.duration.min(blueprint.config().max_episode_steps);
        let bar = progress_bar(self.episodes.saturating_mul(length), self.quiet)?;
        let infos = run_episodes(&blueprint, &plan, &policy, &|| bar.inc(1))?;
        bar.finish_and_clear();
        for (episode, info) in infos.iter().enumerate() {
            println!("episode {episode}: {}", info.to_json());
        }
        let videos = if plan.render { ", videos/evaluation_N.avi" } else { "" };
        println!(
            "{}: logs/evaluation_N.pkl, logs/evaluation_N.npz{videos}",
            save_dir.display()
        );
        Ok(())
    }
}
