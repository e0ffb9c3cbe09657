//! What pictures cost: `cargo bench --bench render`. To be laid beside what MuJoCo's own renderer needs on the same machine
//! at the same time, which `conformance/scripts/render_goldens.py --time` prints.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use babybench::config::Scene;
use babybench::eval::video::{AviWriter, DEFAULT_FPS, FRAME_HEIGHT, FRAME_WIDTH, FramePainter, Panel};
use babybench::render::{Poses, Renderer, View};
use babybench::{Config, Env};
use common::seen;

/// Median of repeated measurements, ms.
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for &scene in Scene::ALL {
        let mut env = Env::new(Config {
            vision_active: false,
            ..seen(scene)
        })?;
        let (qpos, qvel) = (
            env.blueprint().init_qpos().to_vec(),
            env.blueprint().init_qvel().to_vec(),
        );
        env.reset_to(&qpos, &qvel)?;
        let visual = env.blueprint().visual()?;
        let mut renderer = Renderer::new();
        let mut time = |cameras: &[&str], size: usize, repeat: usize| -> Result<f64, String> {
            let mut out = vec![0; 3 * size * size];
            let mut failed = None;
            let ms = median(repeat, || {
                for camera in cameras {
                    let camera = env.model().camera(camera);
                    let result = camera.map(|camera| {
                        let view = View {
                            camera,
                            width: size,
                            height: size,
                        };
                        renderer.rgb(&visual, &Poses::from(env.state()), &view, &mut out)
                    });
                    if let Some(Err(e)) = result {
                        failed = Some(e.to_string());
                    }
                }
            });
            failed.map_or(Ok(ms), Err)
        };
        println!(
            "{scene}: both eyes 64 x 64, settled: {:.3} ms; corner 480 x 480: {:.2} ms",
            time(&["eye_left", "eye_right"], 64, 100)?,
            time(&["corner"], 480, 20)?
        );
        let mut painter = FramePainter::new(env.model())?;
        let mut frame = vec![0; 3 * FRAME_WIDTH * FRAME_HEIGHT];
        let file = std::io::Cursor::new(Vec::new());
        let mut video = AviWriter::new(file, FRAME_WIDTH as u32, FRAME_HEIGHT as u32, DEFAULT_FPS)?;
        let mut failed = None;
        let mut parts = [0.0; 2];
        for (part, draw) in parts.iter_mut().zip([true, false]) {
            *part = median(10, || {
                let result = if draw {
                    painter.paint(&visual, &Poses::from(env.state()), Panel::Binocular, &mut frame)
                } else {
                    video.frame(&frame)
                };
                if let Err(e) = result {
                    failed = Some(e);
                }
            });
        }
        match failed {
            Some(e) => return Err(e.into()),
            None => println!(
                "{scene}: evaluation frame with both eyes: {:.1} ms to draw, {:.1} ms to encode",
                parts[0], parts[1]
            ),
        }
    }
    Ok(())
}
