//! Uses MIMo without the environment: model, physics engine, actuation and one sense as separate parts.
//!
//! ```sh
//! cargo run --release --example embedding
//! ```

use std::sync::Arc;

use babybench::Config;
use babybench::actuation;
use babybench::config::{Behavior, Scene};
use babybench::mimo::{build_model, embedded};
use babybench::physics::{Engine, SoftEngine, SoftOptions};
use babybench::sensors::Vestibular;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // the model: MIMo and a scene, compiled from the embedded MJCF
    let config = Config {
        behavior: Behavior::SelfTouch,
        scene: Scene::Base,
        ..Config::default()
    };
    let model = Arc::new(build_model(&config, &embedded())?);

    // the engine advances a state, which holds everything that changes
    let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
    let mut state = engine.new_state();
    let motors = actuation::build(&model, &config)?;
    motors.prepare(&model, &mut state);
    let vestibular = Vestibular::new(&model);
    let mut head = vec![0.0; vestibular.len()];

    engine.forward(&mut state)?; // computes everything that follows from the initial positions
    for second in 0..5 {
        for step in 0..200 {
            let push = if step < 100 { 0.2 } else { -0.2 };
            let action = vec![push; motors.action_space().len()];
            motors.set_action(&model, &mut state, &action);
            engine.step(&mut state)?;
        }
        vestibular.observe(&state, &mut head);
        let hip = model.body("hip").map(|b| state.xpos[b]).unwrap_or_default();
        println!(
            "{} s: hip at {:.3?} m, head accelerates {:.2?} m/s^2, {} contacts",
            second + 1,
            hip,
            &head[..3],
            state.contact.len()
        );
    }
    Ok(())
}
