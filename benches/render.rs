//! What pictures cost: `cargo bench --bench render`. To be laid beside what MuJoCo's own renderer needs on the same machine
//! at the same time, which `conformance/scripts/render_goldens.py --time` prints.

use std::time::Instant;

use babybench::config::{Behavior, Scene};
use babybench::render::{Poses, Renderer, View};
use babybench::{Config, Env};

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
            scene,
            behavior: if scene == Scene::Cubes {
                Behavior::HandRegard
            } else {
                Behavior::None
            },
            touch_active: false,
            vision_active: false,
            ..Config::default()
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
    }
    Ok(())
}
