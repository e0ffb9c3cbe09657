//! `babybench replay`

use std::error::Error;
use std::path::PathBuf;

use babybench::config::Compat;
use babybench::runs::{Record, replay_with_images};
use babybench::{Blueprint, Env};
use clap::Args;

use super::{Source, parse_compat, read_recording};
use crate::arguments::{count, number};
use crate::print::say;

/// Arguments of `replay`. Recordings that are single files come from the reference, so its behavior is their default.
#[derive(Args)]
pub struct ReplayArgs {
    /// Configuration file (YAML), or the name of an example; a record has its own
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Use the MJCF and textures of this directory (babybench/*.xml, tex/*.png) instead of the embedded ones
    #[arg(long, value_name = "DIR")]
    assets: Option<PathBuf>,
    /// Follow the API page (api) or the Python code (reference) where they disagree; overrides the configuration
    #[arg(long, value_name = "WHICH", value_parser = parse_compat)]
    compat: Option<Compat>,
    /// The folder of a record (--record of run and evaluate), which is repeated in its own configuration and compared bit by bit; or a
    /// file with qpos0, qvel0, actions, and for --one-step qpos, qvel, qacc; for a task with reset_row, reset_qpos, reset_qvel instead of
    /// a single start
    #[arg(long, value_name = "FILE|DIR")]
    recording: PathBuf,
    /// Directory for replay.npz and info.jsonl, if the recording is a file
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Repeat this episode of a record only
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number::<u64>)]
    episode: Option<u64>,
    /// Start each step from the recording's previous row
    #[arg(long)]
    one_step: bool,
    /// Write the images of both eyes in every K-th step, as eye_steps, eye_left and eye_right
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count::<usize>)]
    images_every: Option<usize>,
}

impl ReplayArgs {
    /// Returns the ingredients of the environment, if given.
    fn source(&self) -> Option<Source> {
        self.config.clone().map(|config| Source {
            config,
            assets: self.assets.clone(),
            compat: self.compat,
        })
    }

    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        if self.recording.is_dir() {
            return self.repeat();
        }
        let source = self
            .source()
            .ok_or("give --config FILE, the configuration of the recording")?;
        let out = self
            .out
            .as_ref()
            .ok_or("give --out DIR, a folder for what the replay writes")?;
        let mut env = source.blueprint(Compat::Reference)?.env()?;
        let recording = read_recording(&self.recording, &env)?;
        let result = replay_with_images(&mut env, &recording, self.one_step, self.images_every)?;
        result.write(out, &recording)?;
        let (n, dir) = (result.len, out.display());
        say!("replayed {n} steps: {dir}/replay.npz, {dir}/info.jsonl")?;
        if recording.qpos.len() == result.qpos.len() && n > 0 {
            let nq = env.model().nq;
            let last = (n - 1) * nq;
            let joints = &env.senses().proprioception().joints().qpos;
            let squares = joints
                .iter()
                .map(|&q| (result.qpos[last + q] - recording.qpos[last + q]).powi(2));
            let rms = (squares.sum::<f64>() / joints.len().max(1) as f64).sqrt();
            say!("joint angles differ from the recording by {rms:.1e} rad (rms) after the last step")?;
        }
        Ok(())
    }

    /// Repeats the episodes of a record and compares their bits.
    fn repeat(&self) -> Result<(), Box<dyn Error>> {
        if self.one_step || self.images_every.is_some() || self.out.is_some() {
            return Err("--one-step, --images-every and --out are for recordings that are single files".into());
        }
        let record = Record::open(&self.recording)?;
        let configuration = &record.manifest().configuration;
        let mut env: Env = match self.source() {
            Some(source) => source.blueprint(configuration.compat)?.env()?,
            None => Blueprint::new(configuration.clone())?.env()?,
        };
        let all = record.manifest().episodes.iter().map(|episode| episode.episode);
        let episodes: Vec<u64> = self.episode.map_or_else(|| all.collect(), |episode| vec![episode]);
        let mut different = 0;
        for &episode in &episodes {
            let replayed = record.replay(episode, &mut env)?;
            match replayed.first_difference {
                None => say!("episode {episode}: the same bits in all {} steps", replayed.steps)?,
                Some(step) => {
                    different += 1;
                    say!(
                        "episode {episode}: other bits from step {step} of {} on",
                        replayed.steps
                    )?;
                }
            }
        }
        if different > 0 {
            return Err(format!(
                "{different} of {} episodes differ: the record is of another configuration, room or release, or a program changed \
                 the scene between steps",
                episodes.len()
            )
            .into());
        }
        Ok(())
    }
}
