//! `babybench render`

use std::error::Error;
use std::path::PathBuf;

use babybench::Env;
use babybench::config::Compat;
use babybench::npz::Npz;
use clap::Args;
use image::ExtendedColorType;

use super::Source;

/// Arguments of `render`.
#[derive(Args)]
pub struct Render {
    #[command(flatten)]
    source: Source,
    /// Camera: corner, top, side1, side2, closeup, eye_left or eye_right.
    #[arg(long, value_name = "NAME", default_value = "corner")]
    camera: String,
    /// Width and height in pixels; `render_size` of the configuration by default.
    #[arg(long, value_name = "N")]
    size: Option<usize>,
    /// Picture to write (.png).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Draw a state of this recording instead of the settled one: its rows of qpos and qvel.
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Row of the recording; without it, the recording's start (qpos0, qvel0).
    #[arg(long, value_name = "T", requires = "state")]
    step: Option<usize>,
}

impl Render {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let mut env = self.source.blueprint(Compat::Api)?.env()?;
        let (qpos, qvel) = self.positions(&env)?;
        env.reset_to(&qpos, &qvel)?;
        let size = self.size.unwrap_or(env.config().render_size as usize);
        let picture = env.render_camera(&self.camera, size, size)?;
        let side = u32::try_from(size)?;
        image::save_buffer(&self.out, picture, side, side, ExtendedColorType::Rgb8)?;
        println!(
            "{}: {size} x {size} pixels from camera {}",
            self.out.display(),
            self.camera
        );
        Ok(())
    }

    fn positions(&self, env: &Env) -> Result<(Vec<f64>, Vec<f64>), Box<dyn Error>> {
        let Some(path) = &self.state else {
            let blueprint = env.blueprint();
            return Ok((blueprint.init_qpos().to_vec(), blueprint.init_qvel().to_vec()));
        };
        let archive = Npz::open(path)?;
        let Some(step) = self.step else {
            return Ok((archive.get_f64("qpos0")?.data, archive.get_f64("qvel0")?.data));
        };
        let row = |name: &str| -> Result<Vec<f64>, Box<dyn Error>> {
            let a = archive.get_f64(name)?;
            match a.shape[..] {
                [rows, columns] if step < rows => Ok(a.data[step * columns..(step + 1) * columns].to_vec()),
                [rows, _] => Err(format!("{name} has {rows} rows: there is no step {step}").into()),
                _ => Err(format!("{name} has shape {:?}, but needs one row per step", a.shape).into()),
            }
        };
        Ok((row("qpos")?, row("qvel")?))
    }
}
