//! Draws what 64 infants see with one submission to a GPU per step, and saves the left eyes' last images side by side as
//! `many_eyes.png`.
//!
//! ```sh
//! cargo run --release --features wgpu --example many_eyes
//! ```
//!
//! Without a graphics adapter it says what to install. `renderer: cpu` needs none.

use std::time::Instant;

use babybench::config::{Behavior, RendererKind, Scene};
use babybench::env::draw_eyes;
use babybench::{Blueprint, Config, Env};

const COLUMNS: usize = 8;
const ROWS: usize = 8;
const STEPS: u32 = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let blueprint = Blueprint::new(Config {
        scene: Scene::Cubes,
        behavior: Behavior::HandRegard,
        touch_active: false,
        renderer: RendererKind::Wgpu,
        ..Config::default()
    })?;
    let mut environments: Vec<Env> = (0..COLUMNS * ROWS).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
    for (seed, env) in environments.iter_mut().enumerate() {
        // steps leave the eyes to `env::draw_eyes`, which draws them all at once
        env.senses_mut().defer_vision(true);
        env.reset(Some(seed as u64))?;
    }
    let mut action = Vec::new();
    let mut drawing = 0.0;
    for _ in 0..STEPS {
        for env in &mut environments {
            env.sample_action(&mut action);
            env.step(&action)?;
        }
        let start = Instant::now();
        draw_eyes(&mut environments)?;
        drawing += start.elapsed().as_secs_f64();
    }
    let images = f64::from(STEPS) * (2 * environments.len()) as f64;
    if let Ok(gpu) = blueprint.gpu()?.lock() {
        println!("{}: {:.0} images per second", gpu.adapter(), images / drawing);
    }

    // one sheet with a tile for each environment
    let side = blueprint.config().vision_resolution as usize;
    let mut sheet = vec![0; 3 * side * side * environments.len()];
    for (k, env) in environments.iter().enumerate() {
        let image = env.observation().eye_left.ok_or("vision is off")?;
        for (y, row) in image.chunks_exact(3 * side).enumerate() {
            let at = 3 * side * ((k / COLUMNS * side + y) * COLUMNS + k % COLUMNS);
            sheet[at..at + 3 * side].copy_from_slice(row);
        }
    }
    let (width, height) = ((COLUMNS * side) as u32, (ROWS * side) as u32);
    image::save_buffer("many_eyes.png", &sheet, width, height, image::ExtendedColorType::Rgb8)?;
    println!("many_eyes.png shows the left eyes");
    Ok(())
}
