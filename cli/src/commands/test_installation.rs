//! `babybench test-installation`

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use babybench::config::Example;
use babybench::env::Viewer;
use babybench::eval::{Film, FilmError};
use babybench::mimo::{Version, build_model, embedded};
use babybench::runs::{read_training, start_training};
use babybench::{Blueprint, Env};
use clap::Args;

use crate::print::say;

/// Frames of the video.
const FRAMES: usize = 10;

/// Arguments of `test-installation`.
#[derive(Args)]
pub struct TestInstallation {
    /// Folder for the results; results/test_installation by default
    #[arg(long, value_name = "DIR")]
    save_dir: Option<String>,
}

/// Prints a check and its result, with advice if it fails.
fn check<T>(
    what: &str,
    hint: &str,
    run: impl FnOnce() -> Result<(T, String), Box<dyn Error>>,
) -> Result<T, Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    write!(out, "Checking {what}... ")?;
    // a line without its end may stay in the buffer
    out.flush()?;
    drop(out);
    match run() {
        Ok((value, note)) => {
            say!("OK{}{note}", if note.is_empty() { "" } else { ", " })?;
            Ok(value)
        }
        Err(e) => {
            say!("FAILED")?;
            Err(format!("{hint}: {e}").into())
        }
    }
}

impl TestInstallation {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let started = Instant::now();
        say!("Starting BabyBench installation test")?;
        check("libraries", "the program is damaged", || {
            let (version, os, arch) = (env!("CARGO_PKG_VERSION"), std::env::consts::OS, std::env::consts::ARCH);
            Ok(((), format!("babybench {version} on {os} {arch}")))
        })?;
        let mut config = check("config", "the program is damaged", || {
            Ok((Example::TEST_INSTALLATION.config()?, String::new()))
        })?;
        if let Some(dir) = &self.save_dir {
            config.save_dir = dir.clone();
        }
        check("MIMo", "the assets in the program are damaged", || {
            let model = build_model(&config, &embedded())?;
            let note = format!("{}: {} bodies", Version::of(config.behavior).name(), model.nbody());
            Ok(((), note))
        })?;
        let save_dir = PathBuf::from(&config.save_dir);
        let hint = format!(
            "{} must be a writable folder; choose one with --save-dir",
            save_dir.display()
        );
        let mut env = check("environment initialization", &hint, || {
            let mut env = start_training(&Blueprint::new(config)?, false)?;
            env.reset(Some(0))?;
            let note = format!("{}/scene.xml", save_dir.display());
            Ok((env, note))
        })?;
        check("environment simulation", "the physics failed", || {
            simulate(env.env_mut())
        })?;
        check("image rendering", "the renderer failed", || {
            let different = |image: &[u8]| image.iter().any(|v| *v != image[0]);
            let mut viewer = Viewer::new(env.blueprint())?;
            let eyes = [env.observation().eye_left, env.observation().eye_right];
            if !eyes.into_iter().flatten().all(different) || !different(viewer.render(&env)?) {
                return Err("an image is blank".into());
            }
            let size = env.config().render_size;
            Ok(((), format!("{size} x {size} pixels")))
        })?;
        check("video rendering", &hint, || video(env.env_mut(), &save_dir))?;
        check("logs", &hint, || {
            env.finish_training()?;
            let n = read_training(&save_dir)?.len();
            Ok(((), format!("{}/logs/training.pkl, {n} episode", save_dir.display())))
        })?;
        say!(
            "Installation test successful! ({:.1} s)",
            started.elapsed().as_secs_f64()
        )?;
        Ok(())
    }
}

/// Takes 100 random steps.
fn simulate(env: &mut Env) -> Result<((), String), Box<dyn Error>> {
    let (mut action, clock) = (Vec::new(), Instant::now());
    let steps = 100;
    for _ in 0..steps {
        env.sample_action(&mut action);
        let step = env.step(&action)?;
        if !step.observation.proprioception.iter().all(|v| v.is_finite()) {
            return Err("an observation is not finite".into());
        }
    }
    let rate = f64::from(steps) / clock.elapsed().as_secs_f64();
    Ok(((), format!("{steps} steps, {rate:.0} steps/s")))
}

/// Films a few random steps.
fn video(env: &mut Env, save_dir: &Path) -> Result<((), String), Box<dyn Error>> {
    let path = save_dir.join("videos").join("test_installation.avi");
    let plain = |e: FilmError| -> Box<dyn Error> { e };
    let mut film = babybench::eval::RoomFilm::new(env, save_dir.join("videos")).map_err(plain)?;
    let mut action = Vec::new();
    for _ in 0..FRAMES {
        env.sample_action(&mut action);
        env.step(&action)?;
        film.frame(env).map_err(plain)?;
    }
    film.end(&path).map_err(plain)?;
    Ok(((), format!("{}, {FRAMES} frames", path.display())))
}
