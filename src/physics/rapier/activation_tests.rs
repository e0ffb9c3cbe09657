//! Activations of actuators in Rapier's pipeline.

use std::sync::Arc;

use mjcf_sim_loader::load_str;
use mjcf_sim_model::Model;
use mjcf_sim_model::assets::MemoryAssets;
use mjcf_sim_physics::{Engine, SoftEngine, SoftOptions, compile};

use crate::{RapierEngine, RapierOptions};

const ALL: &str = "<motor joint='j'/><general joint='j' dyntype='integrator' actrange='-1 0.003'/>
    <general joint='j' dyntype='filter' dynprm='0.1'/><general joint='j' dyntype='filterexact' dynprm='0.1'/>
    <cylinder joint='j' timeconst='0.1' area='3' bias='1 0 0'/>";

/// A hinge, as Rapier's joints are, with all actuators.
fn pendulum() -> Arc<Model> {
    let text = format!(
        "<mujoco><worldbody><body><joint name='j'/><geom size='.1' pos='.2 0 0'/></body></worldbody><actuator>{ALL}</actuator></mujoco>"
    );
    let model = load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile);
    Arc::new(model.expect("a model"))
}

#[test]
fn the_rapier_engine_has_the_same_activations() {
    let model = pendulum();
    let mut engine = RapierEngine::new(model.clone(), RapierOptions::default()).expect("an engine");
    let mut other = SoftEngine::new(model, SoftOptions::default());
    let (mut ours, mut theirs) = (engine.new_state(), other.new_state());
    (ours.ctrl, theirs.ctrl) = (vec![1.0; 5], vec![1.0; 5]);
    for _ in 0..10 {
        engine.step(&mut ours).expect("a step");
        other.step(&mut theirs).expect("a step");
    }
    assert_eq!(ours.act, theirs.act);
}

#[test]
fn a_copied_state_continues_its_activations() {
    let model = pendulum();
    let mut engine = RapierEngine::new(model, RapierOptions::default()).expect("an engine");
    let mut state = engine.new_state();
    state.ctrl = vec![0.5, 1.0, 1.0, -1.0, 1.0];
    let mut copy = engine.new_state();
    for _ in 0..20 {
        engine.step(&mut state).expect("a step");
    }
    copy.copy_dynamic_from(&state);
    for state in [&mut state, &mut copy] {
        engine.step(state).expect("a step");
    }
    assert_eq!(
        (&copy.act, &copy.qpos, &copy.qvel),
        (&state.act, &state.qpos, &state.qvel)
    );
    assert!(state.act.iter().all(|act| *act != 0.0) && state.qvel[0] != 0.0);
}
