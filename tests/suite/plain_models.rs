//! Models without MIMo: integrators, flags, keyframes, sensors, cameras.

use std::sync::Arc;

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::load_str;
use babybench::model::SensorType;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};

fn engine(text: &str) -> SoftEngine {
    let model = load_str(text, "m.xml", &MemoryAssets::new()).and_then(compile);
    let model = model.unwrap_or_else(|e| panic!("{e}"));
    SoftEngine::new(Arc::new(model), SoftOptions::default())
}

/// A pendulum of two links without damping, with an integrator and a time step.
fn pendulum(integrator: &str, timestep: f64) -> SoftEngine {
    engine(&format!(
        r#"<mujoco><option integrator="{integrator}" timestep="{timestep}"/><worldbody>
             <body pos="0 0 2"><joint name="upper" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .5 0 0" size=".02" mass="1"/>
               <body pos=".5 0 0"><joint axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .5 0 0" size=".02" mass="1"/></body>
             </body></worldbody>
             <sensor><subtreecom body="world"/><clock/></sensor></mujoco>"#
    ))
}

/// Where the pendulum is after half a second.
fn after(integrator: &str, timestep: f64) -> [f64; 2] {
    let mut engine = pendulum(integrator, timestep);
    let mut state = engine.new_state();
    for _ in 0..(0.5 / timestep).round() as usize {
        engine.step(&mut state).expect("steps");
    }
    [state.qpos[0], state.qpos[1]]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

/// Halving the time step of a method of order four takes away fifteen sixteenths of its error, of one of order one half.
#[test]
fn runge_and_kutta_is_of_fourth_order() {
    let exact = after("RK4", 0.000_5);
    let error = |integrator, timestep| distance(after(integrator, timestep), exact);
    let ratio = error("RK4", 0.02) / error("RK4", 0.01);
    assert!((10.0..24.0).contains(&ratio), "{ratio}");
    let ratio = error("Euler", 0.002) / error("Euler", 0.001);
    assert!((1.7..2.3).contains(&ratio), "{ratio}");
}

/// A step by Runge and Kutta's method leaves the sensors of its start, and poses of its last evaluation.
#[test]
fn sensors_are_those_of_the_start_of_a_step() {
    let mut engine = pendulum("RK4", 0.01);
    let mut state = engine.new_state();
    engine.forward(&mut state).expect("finite");
    let start = state.sensordata.clone();
    engine.step(&mut state).expect("steps");
    assert_eq!(state.sensordata, start);
    assert_eq!(state.sensordata[3], 0.0);
    engine.step(&mut state).expect("steps");
    assert_eq!(state.sensordata[3], 0.01);
    assert_ne!(state.sensordata[..3], start[..3]);
}

/// Returns what is computed of a ball that falls on the floor, with a flag.
fn falling(flags: &str) -> State {
    let mut engine = engine(&format!(
        r#"<mujoco><option><flag {flags}/></option><worldbody><geom type="plane" size="1 1 1"/>
             <body pos="0 0 .09"><joint name="up" type="slide" axis="0 0 1" damping="2" frictionloss="1"/><geom size=".1" mass="1"/></body>
           </worldbody><actuator><motor joint="up" ctrlrange="-1 1"/></actuator></mujoco>"#
    ));
    let mut state = engine.new_state();
    state.qvel[0] = -1.0;
    state.ctrl[0] = 3.0;
    engine.forward(&mut state).expect("finite");
    state
}

#[test]
fn flags_switch_parts_of_the_simulation_off() {
    let all = falling("energy=\"enable\"");
    assert_eq!((all.contact.len(), all.nefc()), (1, 5));
    assert_eq!((all.actuator_force[0], all.qfrc_passive[0]), (1.0, 2.0));
    assert!((all.qfrc_bias[0] - 9.81).abs() < 1e-12);
    assert_eq!(falling("contact=\"disable\"").contact.len(), 0);
    assert_eq!(falling("contact=\"disable\"").nefc(), 1);
    assert_eq!(falling("frictionloss=\"disable\"").nefc(), 4);
    assert_eq!(falling("constraint=\"disable\"").nefc(), 0);
    assert_eq!(falling("passive=\"disable\"").qfrc_passive[0], 0.0);
    assert_eq!(falling("gravity=\"disable\"").qfrc_bias[0], 0.0);
    assert_eq!(falling("actuation=\"disable\"").actuator_force[0], 0.0);
    assert_eq!(falling("clampctrl=\"disable\"").actuator_force[0], 3.0);
}

#[test]
fn keyframes_set_the_whole_state() {
    let mut engine = engine(
        r#"<mujoco><size nkey="3"/><worldbody><body><freejoint/><geom size=".1"/></body>
             <body pos="1 0 0"><joint name="j"/><geom size=".1"/></body></worldbody>
             <actuator><motor joint="j"/></actuator>
             <keyframe><key name="home" time="2" qpos="0 0 1 0 2 0 0 .5" qvel="0 0 0 0 0 0 3" ctrl=".25"/><key/></keyframe></mujoco>"#,
    );
    let model = engine.model().clone();
    assert_eq!((model.nkey(), model.key("home"), model.key("away")), (3, Some(0), None));
    let mut state = engine.new_state();
    engine.step(&mut state).expect("steps");
    state.qfrc_applied[0] = 5.0;
    engine.reset_to_keyframe(&mut state, 0).expect("there");
    // quaternions are normalised
    assert_eq!(state.qpos, [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.5]);
    assert_eq!(
        (state.time, state.qvel[6], state.ctrl[0], state.qfrc_applied[0]),
        (2.0, 3.0, 0.25, 0.0)
    );
    engine.reset_to_keyframe(&mut state, 2).expect("there");
    assert_eq!((&state.qpos, state.time), (&model.qpos0, 0.0));
    let error = engine.reset_to_keyframe(&mut state, 3).expect_err("only three");
    assert_eq!(
        error.to_string(),
        "there is no keyframe 3; the model has 3, numbered from 0"
    );
}

#[test]
fn sensors_measure_what_they_say() {
    let mut engine = engine(
        r#"<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/>
             <body name="ball" pos="0 0 .5"><freejoint/><geom size=".1" mass="2"/><site name="below" zaxis="0 0 -1"/></body>
             <body name="arm" pos="2 0 1"><joint name="j" axis="0 0 1" range="-60 60"/>
               <geom type="box" size=".1 .1 .1" pos=".5 0 0"/><site name="tip" pos="1 0 0"/></body>
           </worldbody><sensor>
             <rangefinder site="below"/><framepos objtype="site" objname="tip" reftype="xbody" refname="ball"/>
             <framelinvel objtype="site" objname="tip"/><jointpos joint="j" cutoff=".1"/><subtreelinvel body="ball"/>
             <jointlimitpos joint="j"/><magnetometer site="tip"/><touch site="below"/>
           </sensor></mujoco>"#,
    );
    let model = engine.model().clone();
    assert_eq!(model.sensor_type[1], SensorType::FramePos);
    assert_eq!(model.nsensordata(), 1 + 3 + 3 + 1 + 3 + 1 + 3 + 1);
    let mut state = engine.new_state();
    (state.qpos[7], state.qvel[2], state.qvel[6]) = (0.5, -1.0, 2.0);
    engine.forward(&mut state).expect("finite");
    let value = |i: usize| &state.sensordata[model.sensor_adr[i]..][..model.sensor_type[i].dim()];
    let near = |i: usize, expected: &[f64]| {
        let worst = value(i)
            .iter()
            .zip(expected)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(
            worst < 1e-12,
            "{:?}: {:?}, not {expected:?}",
            model.sensor_type[i],
            value(i)
        );
    };
    let (sin, cos) = (0.5_f64.sin(), 0.5_f64.cos());
    near(0, &[0.5]);
    near(1, &[2.0 + cos, sin, 0.5]);
    near(2, &[-2.0 * sin, 2.0 * cos, 0.0]);
    near(3, &[0.1]);
    near(4, &[0.0, 0.0, -1.0]);
    // the limit is far
    near(5, &[0.0]);
    near(6, &[-0.5 * sin, -0.5 * cos, 0.0]);
    near(7, &[0.0]);
}

/// A camera that tracks keeps its orientation; one that aims has its target in the middle.
#[test]
fn cameras_follow_and_aim() {
    let mut engine = engine(
        r#"<mujoco><worldbody><camera name="aim" mode="targetbodycom" target="ball" pos="0 -3 1"/>
             <body name="ball" pos="0 0 .5"><freejoint/><geom size=".1" pos=".3 0 0"/>
               <camera name="track" mode="track" pos="0 -1 0"/><camera name="com" mode="trackcom" pos="0 -1 0"/></body>
           </worldbody></mujoco>"#,
    );
    let mut state = engine.new_state();
    let turned = std::f64::consts::FRAC_1_SQRT_2;
    state.qpos.copy_from_slice(&[1.0, 2.0, 0.5, turned, 0.0, 0.0, turned]);
    engine.forward(&mut state).expect("finite");
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
    assert!(close(state.cam_xpos[1], [1.0, 1.0, 0.5]), "{:?}", state.cam_xpos[1]);
    assert_eq!(state.cam_xmat[1], engine.model().cam_mat0[1]);
    // the centre of mass is now at (1, 2.3, 0.5), from which it was (-0.3, -1, 0) at the start
    assert!(close(state.cam_xpos[2], [0.7, 1.3, 0.5]), "{:?}", state.cam_xpos[2]);
    let (mat, to): (_, [f64; 3]) = (state.cam_xmat[0], [1.0, 5.3, -0.5]);
    let length = (to[0] * to[0] + to[1] * to[1] + to[2] * to[2]).sqrt();
    assert!(
        close([-mat[2], -mat[5], -mat[8]], to.map(|v: f64| v / length)),
        "{mat:?}"
    );
}
