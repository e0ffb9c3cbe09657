//! Runs steps and prints nothing: `steps CASE COUNT`. A case does the same work every time; `scripts/history.py` counts its instructions.

use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::env::Viewer;
use babybench::{Config, Env};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let case = arguments.next().unwrap_or_default();
    let count: u32 = arguments.next().ok_or("usage: steps CASE COUNT")?.parse()?;
    let base = Config {
        vision_active: false,
        behavior: Behavior::SelfTouch,
        scene: Scene::Crib,
        ..Config::default()
    };
    let cubes = Config {
        behavior: Behavior::HandRegard,
        scene: Scene::Cubes,
        touch_active: false,
        ..base.clone()
    };
    let config = match case.as_str() {
        "self_touch" | "picture" => base,
        "muscles" => Config {
            actuation_model: ActuationModel::Muscle,
            ..base
        },
        "cubes" => cubes,
        "eyes" => Config {
            vision_active: true,
            ..cubes
        },
        _ => return Err("the cases are self_touch, muscles, cubes, eyes and picture".into()),
    };
    let mut env = Env::new(config)?;
    let mut viewer = Viewer::new(env.blueprint())?;
    let mut action = Vec::new();
    env.reset(Some(0))?;
    for _ in 0..count {
        if case == "picture" {
            viewer.draw_rgba(&env, "corner", 480, 480)?;
        } else {
            env.sample_action(&mut action);
            env.step(&action)?;
        }
    }
    Ok(())
}
