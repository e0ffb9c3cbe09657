//! `babybench replay`

use std::error::Error;
use std::path::PathBuf;

use babybench::config::Compat;
use babybench::runs::replay_with_images;
use clap::Args;

use super::{Source, read_recording};
use crate::arguments::count;
use crate::print::say;

/// Arguments of `replay`. Recordings come from the reference, so its behavior is the default here.
#[derive(Args)]
pub struct ReplayArgs {
    #[command(flatten)]
    source: Source,
    /// Recording with qpos0, qvel0, actions, and for --one-step qpos, qvel, qacc; of a task with reset_row, reset_qpos, reset_qvel
    /// instead of a single start
    #[arg(long, value_name = "FILE")]
    recording: PathBuf,
    /// Directory for replay.npz and info.jsonl
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Start each step from the recording's previous row
    #[arg(long)]
    one_step: bool,
    /// Write the images of both eyes in every K-th step, as eye_steps, eye_left and eye_right
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count::<usize>)]
    images_every: Option<usize>,
}

impl ReplayArgs {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let mut env = self.source.blueprint(Compat::Reference)?.env()?;
        let recording = read_recording(&self.recording, &env)?;
        let result = replay_with_images(&mut env, &recording, self.one_step, self.images_every)?;
        result.write(&self.out, &recording)?;
        let (n, dir) = (result.len, self.out.display());
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
}
