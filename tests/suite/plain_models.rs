//! Models without MIMo: integrators, flags, keyframes, sensors, cameras.

mod ball_joints;
mod flexes;
mod several_contacts;
mod wrenches;

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
        "keyframe 3 does not exist: the model has 3, numbered from 0"
    );
}

#[test]
fn a_mocap_body_goes_where_the_program_says_and_pulls_what_is_welded_to_it() {
    let mut engine = engine(
        r#"<mujoco><option gravity="0 0 0"/><worldbody>
             <body name="led" mocap="true" pos="0 0 1"><geom type="box" size=".1 .1 .1"/>
               <body name="tip" pos="0 0 .2"><geom name="tip" size=".02"/></body></body>
             <body name="ball" pos="1 0 1"><freejoint/><geom name="ball" size=".1" contype="0" conaffinity="0"/></body>
             <body name="obstacle" pos="0 0 2"><freejoint/><geom name="obstacle" size=".1"/></body></worldbody>
             <equality><weld body1="led" body2="ball"/></equality>
             <keyframe><key mpos="0 0 3" mquat="0 2 0 0"/></keyframe></mujoco>"#,
    );
    let model = engine.model().clone();
    let [led, tip, ball] = ["led", "tip", "ball"].map(|name| model.body(name).expect("there"));
    assert_eq!(
        (model.nmocap, model.body_mocapid[led], model.body_mocapid[tip]),
        (1, Some(0), None)
    );
    let mut state = engine.new_state();
    assert_eq!(
        (state.mocap_pos[0], state.mocap_quat[0]),
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0])
    );
    engine.step(&mut state).expect("steps");
    // what stood still moves; a quaternion need not have unit length
    (state.mocap_pos[0], state.mocap_quat[0]) = ([0.0, 0.0, 1.75], [0.0, 0.0, 0.0, 5.0]);
    let mut copy = engine.new_state();
    copy.copy_dynamic_from(&state);
    for s in [&mut state, &mut copy] {
        engine.step(s).expect("steps");
    }
    assert_eq!(
        (state.xpos[led], state.xquat[led]),
        ([0.0, 0.0, 1.75], [0.0, 0.0, 0.0, 1.0])
    );
    assert_eq!(state.xpos[tip], [0.0, 0.0, 1.95]);
    let names = |k: usize| state.contact[k].geom.map(|g| &model.geom_name[g][..]);
    assert!((0..state.contact.len()).any(|k| names(k) == ["tip", "obstacle"]));
    assert_eq!((&copy.qpos, &copy.xpos), (&state.qpos, &state.xpos));
    for _ in 0..2000 {
        engine.step(&mut state).expect("steps");
    }
    let at = state.xpos[ball];
    assert!(
        (at[0] + 1.0).abs() < 1e-3 && at[1].abs() < 1e-3 && (at[2] - 1.75).abs() < 1e-3,
        "{at:?}"
    );
    engine.reset_to_keyframe(&mut state, 0).expect("there");
    assert_eq!(
        (state.mocap_pos[0], state.mocap_quat[0]),
        ([0.0, 0.0, 3.0], [0.0, 1.0, 0.0, 0.0])
    );
    state.mocap_pos[0][1] = f64::NAN;
    let error = engine.step(&mut state).expect_err("not a number").to_string();
    assert!(error.starts_with("state.mocap_pos[1] is NaN"), "{error}");
}

#[test]
fn an_ellipsoid_falls_through_a_medium_as_fast_as_its_drag_allows() {
    let mut engine = engine(
        r#"<mujoco><option density="1000" integrator="implicit"/><worldbody><body pos="0 0 2"><freejoint/>
             <geom type="ellipsoid" size=".1 .2 .05" density="3000" fluidshape="ellipsoid"/></body></worldbody></mujoco>"#,
    );
    let model = engine.model().clone();
    assert_eq!(model.geom_fluid[0][..6], [1.0, 0.5, 0.25, 1.5, 1.0, 1.0]);
    let mut state = engine.new_state();
    for _ in 0..2000 {
        engine.step(&mut state).expect("steps");
    }
    // weight and drag; nothing floats in this model of a medium
    let area = std::f64::consts::PI * 0.1 * 0.2;
    let speed = (model.body_mass[1] * 9.81 / (1000.0 * 0.5 * area)).sqrt();
    assert!(
        (state.qvel[2] + speed).abs() < 1e-6 * speed,
        "{} {speed}",
        state.qvel[2]
    );
}

#[test]
fn sensors_between_geoms_and_of_energies_and_pictures() {
    let mut engine = engine(
        r#"<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/>
             <camera name="eye" pos="0 -2 1" xyaxes="1 0 0 0 0 1" fovy="90" resolution="200 100"/>
             <body name="cube" pos="0 0 1"><joint type="slide" axis="0 0 1" stiffness="8" springref=".5" armature=".5"/>
               <geom name="cube" type="box" size=".1 .1 .1" mass="2"/><site name="top" pos="0 0 .1"/></body>
             <body name="egg" pos="1 0 1"><geom name="egg" type="ellipsoid" size=".2 .1 .1"/></body></worldbody>
             <sensor><distance geom1="cube" geom2="floor" cutoff="5"/><normal geom1="cube" geom2="floor" cutoff="5"/>
               <fromto geom1="cube" geom2="floor" cutoff="5"/><distance body1="cube" body2="egg" cutoff="5"/>
               <distance body1="cube" body2="egg" cutoff=".5"/><normal body1="cube" body2="egg" cutoff=".5"/>
               <e_potential/><e_kinetic/><camprojection site="top" camera="eye"/><user dim="2"/></sensor></mujoco>"#,
    );
    let model = engine.model().clone();
    let mut state = engine.new_state();
    state.qvel[0] = 3.0;
    let user = model.sensor_adr[9];
    state.sensordata[user..].copy_from_slice(&[4.0, 5.0]);
    engine.forward(&mut state).expect("computes");
    let value = |i: usize| &state.sensordata[model.sensor_adr[i]..][..model.sensor_dim[i]];
    let near = |i: usize, expected: &[f64]| {
        let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-5;
        assert!(
            value(i).len() == expected.len() && value(i).iter().zip(expected).all(close),
            "{i}: {:?}",
            value(i)
        );
    };
    near(0, &[0.9]);
    near(1, &[0.0, 0.0, -1.0]);
    assert_eq!([value(2)[2], value(2)[5]].map(|v| (v * 1e6).round()), [0.9e6, 0.0]);
    near(3, &[0.7]);
    near(4, &[0.5]);
    near(5, &[0.0; 3]);
    // heights and a spring; mass and armature
    let egg = model.body_mass[2];
    near(6, &[(2.0 + egg) * 9.81 + 0.5 * 8.0 * 0.25]);
    near(7, &[0.5 * 2.5 * 9.0]);
    // as far above the middle as it is a twentieth of the depth
    near(8, &[100.0, 50.0 - 2.5]);
    near(9, &[4.0, 5.0]);
}

#[test]
fn mocap_bodies_stand_in_the_world_without_joints() {
    for body in [
        "<body mocap='true'><joint/><geom size='.1'/></body>",
        "<body><body mocap='true'><geom size='.1'/></body></body>",
    ] {
        let text = format!("<mujoco><worldbody>{body}</worldbody></mujoco>");
        let error = load_str(&text, "m.xml", &MemoryAssets::new())
            .expect_err("refused")
            .to_string();
        assert!(
            error.ends_with("a mocap body must be a child of the world without joints"),
            "{error}"
        );
    }
    let text = "<mujoco><worldbody><body mocap='true'/></worldbody><keyframe><key mpos='1 2'/></keyframe></mujoco>";
    let error = load_str(text, "m.xml", &MemoryAssets::new())
        .expect_err("refused")
        .to_string();
    assert!(error.ends_with("mpos: 2 values, expected 3"), "{error}");
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
    let value = |i: usize| &state.sensordata[model.sensor_adr[i]..][..model.sensor_dim[i]];
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

/// The centre of mass is where the body turns, so that nothing moves it and rows that hold it have hardly any regularisation: MuJoCo steps there.
#[test]
fn a_body_that_turns_about_its_centre_of_mass_can_be_held() {
    let mut engine = engine(
        r#"<mujoco><worldbody><site name="there"/>
             <body pos=".3 .2 -.2" quat=".5 .5 .5 .5"><joint type="ball" range="0 .9"/><geom size=".06"/><site name="here" pos="-.22 -.2 .086"/></body>
           </worldbody><equality><weld site1="there" site2="here"/></equality></mujoco>"#,
    );
    let mut state = engine.new_state();
    state.qpos = vec![
        0.152417120599885,
        0.6906330860243203,
        -0.5663480673425142,
        0.4231368909158866,
    ];
    for _ in 0..100 {
        engine.step(&mut state).expect("steps");
    }
}

/// What has one bound or none is as if it had no more: nothing pushes it back, and no control is cut.
#[test]
fn bounds_may_be_infinite() {
    let engine_with = |joint: &str, motor: &str| {
        engine(&format!(
            r#"<mujoco><option gravity="0 0 0"/><worldbody><body><joint name="j" {joint}/><geom size=".1" pos=".2 0 0"/></body></worldbody>
               <actuator><motor joint="j" {motor}/></actuator></mujoco>"#
        ))
    };
    let after = |joint: &str, motor: &str| {
        let mut engine = engine_with(joint, motor);
        let mut state = engine.new_state();
        state.ctrl[0] = 3.0;
        (0..200).for_each(|_| engine.step(&mut state).expect("steps"));
        state.qpos[0]
    };
    let free = after("", "");
    assert!(free > 1.0, "{free}");
    assert_eq!(after("range='-10 inf'", "ctrlrange='-Infinity INF'"), free);
    assert_eq!(after("actuatorfrcrange='-inf inf'", "forcerange='-inf inf'"), free);
    assert!(after("range='-inf 10'", "") < 0.5);
    assert!(after("", "ctrlrange='-inf 1'") < 0.5 * free);
    let model = engine_with("range='-inf inf'", "");
    assert_eq!(model.model().jnt_range[0], [f64::NEG_INFINITY, f64::INFINITY]);
    for wrong in ["-1 nan", "-1 1e999", "-1 infinite"] {
        let text =
            format!("<mujoco><worldbody><body><joint range='{wrong}'/><geom size='1'/></body></worldbody></mujoco>");
        assert!(load_str(&text, "m.xml", &MemoryAssets::new()).is_err(), "{wrong}");
    }
}

#[test]
fn geoms_at_places_that_rounding_alone_tells_apart_are_ordered() {
    // each is within the tolerance of its neighbours, and not of all: no order, if places were compared with it
    let boxes: String = (0..200)
        .map(|k| {
            format!(
                "<geom type='box' size='.1 .1 .1' pos='{}e-15 0 0'/>",
                7 * (k * 37 % 200)
            )
        })
        .collect();
    let mut engine = engine(&format!(
        "<mujoco><worldbody><geom type='box' size='1 1 .1'/><body pos='0 0 .19'><freejoint/>{boxes}</body></worldbody></mujoco>"
    ));
    let mut state = engine.new_state();
    engine.step(&mut state).expect("steps");
    assert!(state.contact.len() >= 200, "{} contacts", state.contact.len());
}
