//! `babybench render`

use std::error::Error;
use std::path::{Path, PathBuf};

use crate::report::ages::draw_ages;
use babybench::config::{Compat, RendererKind};
use babybench::env::{ViewFrom, Viewer};
use babybench::formats::npz::Npz;
use babybench::formats::png::write_png;
use babybench::mimo::{build_model, scene_assets};
use babybench::{Config, Env, Model};
use clap::Args;

use super::Source;
use crate::arguments::{age, count, number, picture};
use crate::print::say;

/// Arguments of `render`.
#[derive(Args)]
pub struct Render {
    #[command(flatten)]
    source: Source,
    /// Camera: corner, top, side1, side2, closeup, eye_left or eye_right. Cameras are sharp, also those of the eyes; --observed draws
    /// what MIMo sees at his age
    #[arg(long, value_name = "NAME", default_value = "corner")]
    camera: String,
    /// Width and height in pixels; render_size of the configuration by default
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>)]
    size: Option<usize>,
    /// Renderer: cpu, or wgpu (cargo feature wgpu); overrides the configuration
    #[arg(long, value_name = "WHICH", value_parser = parse_renderer)]
    renderer: Option<RendererKind>,
    /// Draw MIMo's observation with both eyes instead, left and right side by side: at his resolution, with the acuity of his age and
    /// with foveation
    #[arg(long, conflicts_with_all = ["camera", "size"])]
    observed: bool,
    /// Draw MIMo alone at these ages instead (months, separated by commas), side by side on the same scale
    #[arg(long, value_name = "MONTHS", value_delimiter = ',', allow_negative_numbers = true, value_parser = age,
        conflicts_with_all = ["camera", "size", "renderer", "state", "observed"])]
    age: Vec<f64>,
    /// File to write: a PNG image, or with --age an SVG drawing
    #[arg(long, value_name = "FILE", value_parser = picture())]
    out: PathBuf,
    /// Draw a state of this recording (its rows of qpos and qvel) instead of the settled one
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Row of the recording; its start (qpos0, qvel0) by default
    #[arg(long, value_name = "T", requires = "state", allow_negative_numbers = true, value_parser = number::<usize>)]
    step: Option<usize>,
}

fn parse_renderer(text: &str) -> Result<RendererKind, String> {
    RendererKind::from_name(text).ok_or_else(|| format!("expected one of {}", RendererKind::NAMES.join(", ")))
}

impl Render {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let drawing = self.out.extension().is_some_and(|end| end.eq_ignore_ascii_case("svg"));
        match (self.age.is_empty(), drawing) {
            (false, true) => return self.draw_ages(),
            (false, false) => return Err("--age draws an SVG: choose a name for --out that ends in .svg".into()),
            (true, true) => return Err("an image is a PNG file: choose a name for --out that ends in .png".into()),
            (true, false) => {}
        }
        let mut env = self.source.blueprint_with(Compat::Api, self.renderer)?.env()?;
        let from = ViewFrom::room(&env, &self.camera);
        if matches!(from, ViewFrom::Camera(name) if env.model().camera(name).is_none()) {
            let (camera, all) = (&self.camera, env.model().cam_name.join(", "));
            return Err(format!("--camera {camera}: the scene has no such camera; it has {all}").into());
        }
        match &self.state {
            Some(path) => {
                let [qpos, qvel] = self.positions(path)?;
                let misfit = |e| {
                    format!(
                        "{}: {e}; was it recorded with another scene or behavior?",
                        path.display()
                    )
                };
                env.by_hand().reset_to(&qpos, &qvel).map_err(misfit)?;
            }
            None => {
                let blueprint = env.blueprint().clone();
                env.by_hand().reset_to(blueprint.init_qpos(), blueprint.init_qvel())?;
            }
        }
        if self.observed {
            env.senses_mut().look()?;
            return self.draw_observed(&env);
        }
        let size = self.size.unwrap_or(env.config().render_size as usize);
        let mut viewer = Viewer::new(env.blueprint())?;
        let picture = viewer.draw(&env, ViewFrom::room(&env, &self.camera), size, size)?;
        write_png(&self.out, picture, size, size)?;
        say!(
            "{}: {size} x {size} pixels from camera {}",
            self.out.display(),
            self.camera
        )?;
        Ok(())
    }

    /// Draws the images of both eyes in the observation.
    fn draw_observed(&self, env: &Env) -> Result<(), Box<dyn Error>> {
        let observation = env.observation();
        let (Some(left), Some(right)) = (observation.eye_left, observation.eye_right) else {
            let off = "--observed: the configuration observes no colour images; it needs vision_active: true and vision_outputs with rgb";
            return Err(off.into());
        };
        // side by side, from the top; black below the lower one
        let sizes = env.config().eye_sizes();
        let [width, height] = [sizes[0][0] + sizes[1][0], sizes[0][1].max(sizes[1][1])];
        let mut picture = Vec::with_capacity(3 * width * height);
        for row in 0..height {
            for (image, [own, _]) in [left, right].into_iter().zip(sizes) {
                let line = image.chunks_exact(3 * own).nth(row);
                picture.extend_from_slice(line.unwrap_or(&vec![0; 3 * own]));
            }
        }
        write_png(&self.out, &picture, width, height)?;
        say!(
            "{}: {width} x {height} pixels, left and right eye as observed",
            self.out.display()
        )?;
        Ok(())
    }

    /// Draws a row of infants.
    fn draw_ages(&self) -> Result<(), Box<dyn Error>> {
        let config = self.source.read(Compat::Api)?;
        let (given, assets) = (self.source.assets()?, scene_assets(&config, self.source.assets()?)?);
        let grown = |&age: &f64| -> Result<(f64, Model), Box<dyn Error>> {
            let config = Config {
                age: Some(age),
                ..config.clone()
            };
            Ok((age, build_model(&config, &*given)?))
        };
        let models = self.age.iter().map(grown).collect::<Result<Vec<_>, _>>()?;
        let infants: Vec<(f64, &Model)> = models.iter().map(|(age, model)| (*age, model)).collect();
        let picture = draw_ages(&infants, &*assets).ok_or("--age: the assets have no MIMo")?;
        std::fs::write(&self.out, picture).map_err(|e| format!("{}: {e}", self.out.display()))?;
        say!("{}: {} infants", self.out.display(), infants.len())?;
        Ok(())
    }

    /// Reads positions and velocities from a recording.
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
                [rows, _] => {
                    Err(format!("{file}: --step {step} is out of range: {name} has {rows} rows, counted from 0").into())
                }
                _ => Err(format!("{file}: {name} has shape {:?}, but needs one row per step", a.shape).into()),
            }
        };
        Ok([row("qpos")?, row("qvel")?])
    }
}
