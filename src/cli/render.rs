//! `babybench render`

use std::error::Error;
use std::path::{Path, PathBuf};

use babybench::config::{Compat, RendererKind};
use babybench::eval::write_png;
use babybench::npz::Npz;
use clap::Args;

use super::Source;
use super::arguments::{count, number, png};
use super::print::say;

/// Arguments of `render`.
#[derive(Args)]
pub struct Render {
    #[command(flatten)]
    source: Source,
    /// Camera: corner, top, side1, side2, closeup, eye_left or eye_right.
    #[arg(long, value_name = "NAME", default_value = "corner")]
    camera: String,
    /// Width and height in pixels; `render_size` of the configuration by default.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>)]
    size: Option<usize>,
    /// What draws: cpu, or wgpu (cargo feature `wgpu`). Overrides the configuration.
    #[arg(long, value_name = "WHICH", value_parser = parse_renderer)]
    renderer: Option<RendererKind>,
    /// Picture to write (.png).
    #[arg(long, value_name = "FILE", value_parser = png())]
    out: PathBuf,
    /// Draw a state of this recording instead of the settled one: its rows of qpos and qvel.
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Row of the recording; without it, the recording's start (qpos0, qvel0).
    #[arg(long, value_name = "T", requires = "state", allow_negative_numbers = true, value_parser = number::<usize>)]
    step: Option<usize>,
}

fn parse_renderer(text: &str) -> Result<RendererKind, String> {
    RendererKind::from_name(text).ok_or_else(|| format!("expected one of {}", RendererKind::NAMES.join(", ")))
}

impl Render {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let mut env = self.source.blueprint_with(Compat::Api, self.renderer)?.env()?;
        let cameras = &env.model().cam_name;
        if !cameras.contains(&self.camera) {
            let (camera, all) = (&self.camera, cameras.join(", "));
            return Err(format!("--camera {camera}: the scene has no such camera; it has {all}").into());
        }
        match &self.state {
            Some(path) => {
                let [qpos, qvel] = self.positions(path)?;
                let misfit = |e| format!("{}: {e}; is it of another scene or behavior?", path.display());
                env.reset_to(&qpos, &qvel).map_err(misfit)?;
            }
            None => {
                let blueprint = env.blueprint().clone();
                env.reset_to(blueprint.init_qpos(), blueprint.init_qvel())?;
            }
        }
        let size = self.size.unwrap_or(env.config().render_size as usize);
        let picture = env.render_camera(&self.camera, size, size)?;
        write_png(&self.out, picture, size, size)?;
        say!(
            "{}: {size} x {size} pixels from camera {}",
            self.out.display(),
            self.camera
        )?;
        Ok(())
    }

    /// Positions and velocities in a recording.
    fn positions(&self, path: &Path) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
        let archive = Npz::open(path)?;
        let Some(step) = self.step else {
            return Ok([archive.get_f64("qpos0")?.data, archive.get_f64("qvel0")?.data]);
        };
        let file = path.display();
        let row = |name: &str| -> Result<Vec<f64>, Box<dyn Error>> {
            let a = archive.get_f64(name)?;
            match a.shape[..] {
                [rows, columns] if step < rows => Ok(a.data[step * columns..(step + 1) * columns].to_vec()),
                [rows, _] => Err(format!("{file}: {name} has {rows} rows, from 0: there is no --step {step}").into()),
                _ => Err(format!("{file}: {name} has shape {:?}, but needs one row per step", a.shape).into()),
            }
        };
        Ok([row("qpos")?, row("qvel")?])
    }
}
