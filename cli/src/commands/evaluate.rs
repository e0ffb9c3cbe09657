//! `babybench evaluate`

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

use babybench::Blueprint;
use babybench::config::Compat;
use babybench::eval::{EpisodeError, Evaluation, EvaluationError, Observer, Plan, run_episodes, run_episodes_watched};
use babybench::formats::avi::DEFAULT_FPS;
use babybench::policy::{DEFAULT_LIMIT, PolicySource};
use babybench::runs::logs::training_path;
use babybench::runs::{SceneFileStatus, keep_scene};
use clap::Args;

use super::record::Recording;
use super::{Source, progress_bar};
use crate::arguments::{count, word};
use crate::interrupt::{Interrupt, Interrupted};
use crate::print::{note, say};

/// Arguments of `evaluate`.
#[derive(Args)]
pub struct Evaluate {
    #[command(flatten)]
    source: Source,
    /// Number of episodes
    #[arg(long, value_name = "N", default_value_t = 10, allow_negative_numbers = true, value_parser = count::<u64>)]
    episodes: u64,
    /// Maximum number of steps of an episode
    #[arg(long, value_name = "STEPS", default_value_t = 1000, allow_negative_numbers = true, value_parser = count::<u64>)]
    duration: u64,
    /// Policy: random, zero, a noise (held, ou, pink, oscillators), babbling or watching (which learn while they act, one episode after another),
    /// a model (FILE.onnx, if this program is built with the feature onnx), or a command with its arguments that reads observations
    /// (a line of JSON each) from its standard input and writes actions (a JSON list each) to its standard output; quotes keep words
    /// with spaces together
    #[arg(long, default_value = "random")]
    policy: String,
    /// Time limit of a command for an action, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_LIMIT.as_secs_f64(), allow_negative_numbers = true, value_parser = seconds)]
    policy_timeout: f64,
    /// Do not make videos
    #[arg(long)]
    no_render: bool,
    /// Frames per second of the videos; 200 / frame_skip plays them in real time
    #[arg(long, value_name = "N", default_value_t = DEFAULT_FPS, allow_negative_numbers = true, value_parser = fps)]
    fps: u32,
    /// Number of episodes to run in parallel, each in an environment of its own
    #[arg(long, visible_alias = "envs", value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = count::<usize>)]
    jobs: usize,
    #[command(flatten)]
    recording: Recording,
    /// Do not show a progress bar
    #[arg(long)]
    quiet: bool,
}

/// Parses a timeout in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(s) if (0.001..=1e6).contains(&s) => Ok(s),
        _ => Err("expected seconds, from 0.001 to 1000000".to_string()),
    }
}

/// Parses a frame rate.
fn fps(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(n) if (1..=1000).contains(&n) => Ok(n),
        _ => Err("expected frames per second, from 1 to 1000".to_string()),
    }
}

impl Evaluate {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let interrupt = Interrupt::watch();
        let blueprint = self.source.blueprint(Compat::Api)?;
        let save_dir = Path::new(&blueprint.config().save_dir);
        if training_path(save_dir).exists() {
            match Evaluation::new(&blueprint.env()?).eval_logs() {
                Ok(score) => say!("{score}")?,
                Err(e @ EvaluationError::Behavior { .. }) => return Err(e.into()),
                Err(e) => say!("No training score: {e}")?,
            }
        }
        self.keep_scene(&blueprint)?;
        let (source, limit) = (
            PolicySource::new(&self.policy),
            Duration::from_secs_f64(self.policy_timeout),
        );
        // episodes of a policy that learns belong together
        let jobs = if source.learns() { 1 } else { self.jobs };
        let plan = Plan {
            episodes: self.episodes,
            duration: self.duration,
            render: !self.no_render,
            fps: self.fps,
            jobs,
        };
        if jobs < self.jobs {
            note!(
                "note: one job instead of {}: this policy learns from one episode for the next",
                self.jobs
            );
        }
        if plan.parallel() < plan.jobs {
            let (given, wanted) = (plan.parallel(), plan.jobs);
            note!("note: {given} instead of {wanted} jobs: that is all that these episodes and this machine can use");
        }
        let policy = || source.open(limit);
        let length = self.duration.min(blueprint.config().max_episode_steps);
        let bar = progress_bar(self.episodes.saturating_mul(length), self.quiet)?;
        let progress = || {
            bar.inc(1);
            if interrupt.wanted() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let result = match self.recording.recorder(&blueprint.env()?, &self.policy)? {
            Some(recorder) => {
                let observer = || -> Box<dyn Observer> { Box::new(recorder.another()) };
                run_episodes_watched(&blueprint, &plan, &policy, &observer, &progress)
            }
            None => run_episodes(&blueprint, &plan, &policy, &progress),
        };
        bar.finish_and_clear();
        let infos = match result {
            Err(e @ EpisodeError::Stopped { .. }) => return Err(Interrupted(e.to_string()).into()),
            // a policy that is interrupted too may end first
            Err(e @ EpisodeError::Policy(_)) if interrupt.wanted() => return Err(Interrupted(e.to_string()).into()),
            result => result?,
        };
        for (episode, info) in infos.iter().enumerate() {
            say!("episode {episode}: {}", info.to_detailed_json())?;
        }
        let videos = if plan.render { ", videos/evaluation_N.avi" } else { "" };
        say!(
            "{dir}: logs/evaluation_N.pkl, .jsonl, .npz{videos}\nLook at it: babybench report {word}",
            dir = save_dir.display(),
            word = word(save_dir.display())
        )?;
        self.recording.say_next()?;
        Ok(())
    }

    /// Writes the scene next to the logs, or checks the existing one.
    fn keep_scene(&self, blueprint: &Blueprint) -> Result<(), Box<dyn Error>> {
        let dir = &blueprint.config().save_dir;
        match keep_scene(blueprint)? {
            SceneFileStatus::Written | SceneFileStatus::Same => {}
            SceneFileStatus::Similar => note!(
                "warning: the scene.xml in {dir} has the same bodies but different numbers: it comes from other \
                 assets, another actuation_model or another release"
            ),
            SceneFileStatus::Foreign(e) => {
                note!("note: the scene.xml in {dir} cannot be loaded and is left unchanged: {e}")
            }
        }
        Ok(())
    }
}
