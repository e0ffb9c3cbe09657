//! Prints the milliseconds that a piece of work takes in the fastest of some rounds: `pace physics`, `pace eyes` or
//! `pace picture`. The script `web/bench.mjs` runs it next to a browser that does the same.

use std::time::Instant;

use babybench::config::{Behavior, Scene};
use babybench::env::Viewer;
use babybench::{Config, Env};

/// Number of rounds; the fastest counts.
const ROUNDS: usize = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args().nth(1).unwrap_or_default();
    let (behavior, scene, vision_active, work) = match name.as_str() {
        "physics" => (Behavior::SelfTouch, Scene::Crib, false, 200),
        "eyes" => (Behavior::HandRegard, Scene::Cubes, true, 200),
        "picture" => (Behavior::SelfTouch, Scene::Crib, false, 4),
        _ => return Err("say which: physics, eyes or picture".into()),
    };
    let mut env = Env::new(Config {
        behavior,
        scene,
        vision_active,
        touch_active: false,
        ..Config::default()
    })?;
    let mut viewer = Viewer::new(env.blueprint())?;
    let mut action = Vec::new();
    env.reset(Some(0))?;
    let mut least = f64::INFINITY;
    for round in 0..=ROUNDS {
        let started = Instant::now();
        for _ in 0..work {
            if name == "picture" {
                viewer.draw_rgba(&env, "corner", 480, 480)?;
            } else {
                env.sample_action(&mut action);
                env.step(&action)?;
            }
        }
        if round > 0 {
            // the first warms up
            least = least.min(started.elapsed().as_secs_f64() * 1e3 / f64::from(work));
        }
    }
    println!("{least}");
    Ok(())
}
