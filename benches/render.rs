//! Measures the cost of pictures: `cargo bench --bench render`. Compare with the cost of MuJoCo's own renderer on the same machine at the same time,
//! which `conformance/scripts/render_goldens.py --time` prints.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use babybench::config::Scene;
use babybench::eval::FilmError;
use babybench::eval::film::{FRAME_HEIGHT, FRAME_WIDTH, FrameComposer, Panel};
use babybench::formats::avi::{AviWriter, DEFAULT_FPS};
use babybench::render::{CpuRenderer, Poses, Scenery, View};
use babybench::{Config, Env};
use common::seen;

/// Returns the median of repeated measurements, ms.
fn median(repeat: usize, mut work: impl FnMut()) -> f64 {
    work();
    let mut spent: Vec<f64> = (0..repeat)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    spent.sort_by(f64::total_cmp);
    spent[repeat / 2]
}

/// Returns the median time (ms) to draw a square image from each of some cameras.
fn draw(env: &Env, scenery: &Scenery, cameras: &[&str], size: usize, repeat: usize) -> Result<f64, String> {
    let mut renderer = CpuRenderer::new();
    let mut out = vec![0; 3 * size * size];
    let mut failed = None;
    let ms = median(repeat, || {
        for camera in cameras {
            let result = env.model().camera(camera).map(|camera| {
                let view = View {
                    camera,
                    width: size,
                    height: size,
                };
                renderer.rgb(scenery, &Poses::from(env.state()), &view, &mut out)
            });
            if let Some(Err(e)) = result {
                failed = Some(e.to_string());
            }
        }
    });
    failed.map_or(Ok(ms), Err)
}

/// Returns the median times (ms) to draw and to encode a frame of an evaluation video.
fn film(env: &Env, scenery: &Scenery) -> Result<[f64; 2], Box<dyn std::error::Error>> {
    let mut composer = FrameComposer::new(env.model())?;
    let mut frame = vec![0; 3 * FRAME_WIDTH * FRAME_HEIGHT];
    let file = std::io::Cursor::new(Vec::new());
    let mut video = AviWriter::new(file, FRAME_WIDTH as u32, FRAME_HEIGHT as u32, DEFAULT_FPS)?;
    let mut failed: Option<FilmError> = None;
    let drawing = median(10, || {
        let poses = Poses::from(env.state());
        let result = composer.compose(scenery, &poses, Panel::Binocular, &mut frame);
        failed = failed.take().or(result.err().map(Into::into));
    });
    let encoding = median(10, || {
        failed = failed.take().or(video.frame(&frame).err().map(Into::into));
    });
    match failed {
        Some(e) => Err(e),
        None => Ok([drawing, encoding]),
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for scene in Scene::BABYBENCH {
        let mut env = Env::new(Config {
            vision_active: false,
            ..seen(scene.clone())
        })?;
        let (qpos, qvel) = (
            env.blueprint().init_qpos().to_vec(),
            env.blueprint().init_qvel().to_vec(),
        );
        env.by_hand().reset_to(&qpos, &qvel)?;
        let scenery = env.blueprint().scenery()?;
        println!(
            "{scene}: both eyes 64 x 64, settled: {:.3} ms; corner 480 x 480: {:.2} ms",
            draw(&env, &scenery, &["eye_left", "eye_right"], 64, 100)?,
            draw(&env, &scenery, &["corner"], 480, 20)?
        );
        let [drawing, encoding] = film(&env, &scenery)?;
        println!("{scene}: evaluation frame with both eyes: {drawing:.1} ms to draw, {encoding:.1} ms to encode");
    }
    Ok(())
}
