//! `babybench senses`

use std::error::Error;
use std::path::PathBuf;

use babybench::Limits;
use babybench::config::Compat;
use babybench::runs::{Motion, MotionMode, play_motion};
use clap::Args;

use super::record::Recording;
use super::{Source, progress_bar};
use crate::arguments::number;
use crate::interrupt::{Interrupt, Interrupted};
use crate::print::{note, say};

/// Arguments of `senses`.
#[derive(Args)]
pub struct Senses {
    #[command(flatten)]
    source: Source,
    /// The motion: a NumPy archive with names, angles (frames, joints) and rate, or a table (.csv) whose columns are time and joints
    #[arg(long, value_name = "FILE")]
    motion: PathBuf,
    /// The angles of the file are in degrees
    #[arg(long)]
    degrees: bool,
    /// Let the motors follow the angles, with everything else moved by the physics, instead of setting MIMo to each pose
    #[arg(long)]
    track: bool,
    /// Random seed of the reset; that of the configuration by default
    #[arg(long, allow_negative_numbers = true, value_parser = number::<u64>)]
    seed: Option<u64>,
    /// Write the motion as a NumPy archive, in rad
    #[arg(long, value_name = "FILE.npz")]
    save: Option<PathBuf>,
    #[command(flatten)]
    recording: Recording,
    /// Do not show a progress bar
    #[arg(long)]
    quiet: bool,
}

impl Senses {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let motion = Motion::read_with(&self.motion, self.degrees, &Limits::DEFAULT)?;
        if self.save.is_none() && self.recording.folder().is_none() {
            return Err("give --record DIR, a new folder for what MIMo senses, or --save FILE.npz".into());
        }
        if let Some(path) = &self.save {
            motion.write(path)?;
            say!(
                "{}: {} frames of {} joints",
                path.display(),
                motion.frames(),
                motion.names().len()
            )?;
        }
        if self.recording.folder().is_none() {
            return Ok(());
        }
        let mut env = self.source.blueprint(Compat::Api)?.env()?;
        let (playing, how) = if self.track {
            (MotionMode::Tracking, "tracking")
        } else {
            (MotionMode::Kinematic, "kinematic")
        };
        let mut recorder = self.recording.recorder(&env, &format!("motion, {how}"))?;
        env.reset(self.seed)?;
        let interrupt = Interrupt::watch();
        let bar = progress_bar((motion.seconds() / env.blueprint().dt()) as u64 + 1, self.quiet)?;
        let played = play_motion(&mut env, &motion, playing, recorder.as_mut().map(|r| (r, 0)), |_| {
            bar.inc(1);
            !interrupt.wanted()
        })?;
        bar.finish_and_clear();
        if interrupt.wanted() {
            return Err(Interrupted(format!("the record has {} steps of the motion", played.steps)).into());
        }
        if !played.beyond_limits.is_empty() {
            note!(
                "note: the motion leaves the range of {}",
                played.beyond_limits.join(", ")
            );
        }
        say!(
            "played {} frames at {} Hz in {} steps",
            motion.frames(),
            motion.rate(),
            played.steps
        )?;
        if let Some((joint, error)) = &played.worst {
            let all = played.error;
            say!("joint angles differ from the motion by {all:.3} rad (rms); most in {joint}, {error:.3} rad")?;
        }
        if let Some(recorder) = &recorder {
            say!("{} has what MIMo sensed", recorder.dir().display())?;
        }
        Ok(())
    }
}
