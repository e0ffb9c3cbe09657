//! Models that both engines step a few times: a step is an error or leaves finite numbers.
#![no_main]

use std::sync::Arc;

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, SoftEngine, SoftOptions, compile};
use babybench::rapier::{RapierModel, RapierOptions};
use libfuzzer_sys::fuzz_target;

/// Larger models are skipped, because their cost hides that of others.
const LARGE: usize = 40;

/// Returns how many steps a model takes: most failures happen in the first ones, so only one model in four takes many.
fn steps(data: &[u8]) -> usize {
    let sum = data
        .iter()
        .fold(0usize, |sum, &byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
    if (sum ^ sum >> 7) % 4 == 0 { 20 } else { 3 }
}

fn run(engine: &mut dyn Engine, steps: usize) {
    let mut state = engine.new_state();
    for step in 0..steps {
        for (k, control) in state.ctrl.iter_mut().enumerate() {
            *control = if (k + step) % 2 == 0 { 1.0 } else { -1.0 };
        }
        if engine.step(&mut state).is_err() {
            return;
        }
        let numbers = state.qpos.iter().chain(&state.qvel).chain(&state.qacc);
        let forces = state.contact.iter().flat_map(|c| c.force.iter().chain(&c.pos));
        assert!(numbers.chain(forces).all(|v| v.is_finite()), "step {step}: not finite");
    }
}

fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(spec) = load_str(text, "m.xml", &MemoryAssets::new()) else {
        return;
    };
    if spec.nv() > LARGE || spec.nbody() > LARGE {
        return;
    }
    let Ok(model) = compile(spec) else { return };
    if model.ngeom() > LARGE {
        return;
    }
    let model = Arc::new(model);
    run(&mut SoftEngine::new(model.clone(), SoftOptions::default()), steps(data));
    if let Ok(rapier) = RapierModel::new(model, RapierOptions::default()) {
        run(&mut rapier.engine(), steps(data));
    }
});
