//! Wrenches of bodies are computed where something reads them.

use std::sync::Arc;

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};

fn stepped(integrator: &str, sensors: &str, post_constraint: bool) -> State {
    let text = format!(
        r#"<mujoco><option integrator="{integrator}"/><worldbody><geom type="plane" size="1 1 1"/>
             <body pos="0 0 .09"><freejoint/><geom size=".1"/><site name="s"/></body></worldbody>
             <sensor>{sensors}</sensor></mujoco>"#
    );
    let model = load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile);
    let model = Arc::new(model.unwrap_or_else(|e| panic!("{e}")));
    let options = SoftOptions {
        post_constraint,
        ..SoftOptions::default()
    };
    let mut engine = SoftEngine::new(model, options);
    let mut state = engine.new_state();
    engine.step(&mut state).expect("steps");
    state
}

#[test]
fn wrenches_are_computed_for_sensors_or_where_they_are_asked_for() {
    for integrator in ["Euler", "RK4"] {
        let silent = stepped(integrator, "<clock/>", false);
        let asked = stepped(integrator, "<clock/>", true);
        let sensed = stepped(integrator, r#"<accelerometer site="s"/>"#, false);
        assert_eq!(silent.cfrc_ext, vec![[0.0; 6]; 2], "{integrator}");
        assert!(asked.cfrc_ext[1][5] > 1.0, "{integrator}: the floor bears the ball");
        assert_eq!(asked.cfrc_ext, sensed.cfrc_ext, "{integrator}");
        assert_eq!(asked.cacc, sensed.cacc, "{integrator}");
        assert_eq!(asked.cfrc_int, sensed.cfrc_int, "{integrator}");
        assert_eq!(asked.qpos, silent.qpos, "{integrator}");
    }
}
