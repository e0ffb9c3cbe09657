//! Measures the cost of actuation models and snapshots: `cargo bench --bench actuation`. Numbers are medians.

use std::hint::black_box;
use std::time::Instant;

use babybench::actuation::build;
use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::physics::{Engine, SoftEngine, SoftOptions};
use babybench::{Config, Env};

const SAMPLES: usize = 2001;
const REPEAT: usize = 16;

/// Returns the median time of one call, microseconds.
fn median(mut f: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..SAMPLES)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..REPEAT {
                f();
            }
            start.elapsed().as_secs_f64() * 1e6 / REPEAT as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[SAMPLES / 2]
}

fn config(actuation_model: ActuationModel, behavior: Behavior, scene: Scene) -> Config {
    Config {
        behavior,
        scene,
        actuation_model,
        touch_active: false,
        vision_active: false,
        ..Config::default()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (behavior, version) in [(Behavior::None, "v1"), (Behavior::HandRegard, "v2")] {
        for &kind in ActuationModel::ALL {
            let config = config(kind, behavior, Scene::Base);
            let model = std::sync::Arc::new(babybench::mimo::build_model(&config, &babybench::mimo::embedded())?);
            let actuation = build(&model, &config)?;
            let mut state = SoftEngine::new(model.clone(), SoftOptions::default()).new_state();
            actuation.prepare(&model, &mut state);
            for (i, (q, v)) in state
                .qpos
                .iter_mut()
                .skip(7)
                .zip(state.qvel.iter_mut().skip(6))
                .enumerate()
            {
                (*q, *v) = (0.1 * (i as f64).sin(), (i as f64).cos());
            }
            let n = actuation.action_space().len();
            let action: Vec<f32> = (0..n).map(|i| 0.5 + 0.5 * (i as f32).sin()).collect();
            let step = median(|| actuation.set_action(&model, &mut state, black_box(&action)));
            let mut seen = vec![0.0; actuation.observation_len()];
            let observe = median(|| actuation.observe(&model, &state, black_box(&mut seen)));
            println!("{version} {kind:12} {n:4} inputs: step {step:6.3} us, observation {observe:6.3} us");
        }
    }
    for &kind in ActuationModel::ALL {
        let mut env = Env::new(config(kind, Behavior::HandRegard, Scene::Cubes))?;
        env.reset(Some(0))?;
        let snapshot = env.snapshot();
        let take = median(|| drop(black_box(env.snapshot())));
        let restore = median(|| assert!(env.restore(black_box(&snapshot)).is_ok()));
        println!(
            "v2 cubes {kind:12} snapshot of {} bytes: take {take:6.2} us, restore {restore:6.2} us",
            snapshot.as_bytes().len()
        );
    }
    Ok(())
}
