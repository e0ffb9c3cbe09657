//! Ball joints, and actuators on joints of several coordinates.

use super::*;

#[test]
fn a_ball_joint_swings_about_all_axes_up_to_its_limit() {
    let text = |attributes: &str| {
        format!(
            r#"<mujoco><compiler angle="radian"/><option integrator="RK4"/><worldbody>
                 <body pos="0 0 2"><joint name="j" type="ball" pos="0 0 .1" {attributes}/>
                   <geom type="box" size=".1 .2 .05" pos=".1 0 -.4"/></body></worldbody>
                 <sensor><ballquat joint="j"/><ballangvel joint="j"/><framequat objtype="xbody" objname="b"/></sensor></mujoco>"#
        )
        .replace("<body pos", "<body name='b' pos")
    };
    let mut free = engine(&text(""));
    let model = free.model().clone();
    assert_eq!(
        (model.nq, model.nv, &model.qpos0[..]),
        (4, 3, &[1.0, 0.0, 0.0, 0.0][..])
    );
    let mut state = free.new_state();
    // a quaternion need not have unit length
    (state.qpos, state.qvel) = (vec![3.0, 0.0, 3.0, 0.0], vec![1.0, -2.0, 4.0]);
    let energy = |s: &State| {
        let inertia = free_energy(&model, s);
        model.body_mass[1] * 9.81 * s.xipos[1][2] + inertia
    };
    free.forward(&mut state).expect("computes");
    let (before, anchor) = (energy(&state), state.xanchor[0]);
    assert_eq!(state.sensordata[..4], state.xquat[1]);
    assert_eq!(state.sensordata[4..7], state.qvel[..]);
    for _ in 0..1000 {
        free.step(&mut state).expect("steps");
    }
    free.forward(&mut state).expect("computes");
    assert!(
        (energy(&state) - before).abs() < 1e-6 * before.abs(),
        "{before} {}",
        energy(&state)
    );
    assert!((0..3).all(|k| (state.xanchor[0][k] - anchor[k]).abs() < 1e-12));
    let mut held = engine(&text(r#"range="0 .3" damping="20""#));
    let mut state = held.new_state();
    state.qvel = vec![1.0, -2.0, 4.0];
    for _ in 0..4000 {
        held.step(&mut state).expect("steps");
    }
    let angle = 2.0 * state.qpos[0].acos();
    assert!((0.2..0.35).contains(&angle), "{angle}");
}

/// The kinetic energy of a model, by its inertia matrix, J.
fn free_energy(model: &babybench::Model, s: &State) -> f64 {
    let mass = &model.body_inertia[1];
    let turning: Vec<f64> = (0..3).map(|k| dot(&column(&s.ximat[1], k), &s.cvel[1][..3])).collect();
    let offset: Vec<f64> = (0..3).map(|k| s.xipos[1][k] - s.subtree_com[1][k]).collect();
    assert!(offset.iter().all(|v| v.abs() < 1e-12), "one body is its tree");
    let turned: f64 = (0..3).map(|k| mass[k] * turning[k] * turning[k]).sum();
    0.5 * (turned + model.body_mass[1] * dot(&s.cvel[1][3..], &s.cvel[1][3..]))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn column(m: &[f64; 9], k: usize) -> [f64; 3] {
    [m[k], m[3 + k], m[6 + k]]
}

#[test]
fn motors_turn_ball_joints_and_push_free_bodies() {
    let mut engine = engine(
        r#"<mujoco><worldbody><body><joint name="b" type="ball"/><geom type="box" size=".1 .2 .3"/></body>
             <body pos="1 0 0"><freejoint name="f"/><geom size=".1"/></body></worldbody>
             <actuator><motor joint="b" gear="1 2 3"/><motor jointinparent="b" gear="1 2 3"/>
               <motor joint="f" gear="1 2 3 4 5 6"/><motor jointinparent="f" gear="1 2 3 4 5 6"/></actuator></mujoco>"#,
    );
    let mut state = engine.new_state();
    // a quarter turn about z: what is x in the parent is -y in the body
    let half = std::f64::consts::FRAC_1_SQRT_2;
    state.qpos[..4].copy_from_slice(&[half, 0.0, 0.0, half]);
    state.qpos[7..11].copy_from_slice(&[half, 0.0, 0.0, half]);
    let mut forces = |k: usize| {
        state.ctrl.fill(0.0);
        state.ctrl[k] = 1.0;
        engine.forward(&mut state).expect("computes");
        (state.actuator_length[k], state.qfrc_actuator.clone())
    };
    let near = |found: &[f64], expected: &[f64]| {
        let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12;
        assert!(found.iter().zip(expected).all(close), "{found:?}");
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let (length, force) = forces(0);
    near(&[length], &[3.0 * quarter]);
    near(&force, &[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    near(&forces(1).1, &[2.0, -1.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let (length, force) = forces(2);
    near(&[length], &[0.0]);
    near(&force, &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    near(&forces(3).1, &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 5.0, -4.0, 6.0]);
}

#[test]
fn what_no_ball_joint_can_be_is_refused() {
    let cases = [
        (
            "<joint type='ball' range='10 60'/>",
            "the range of a ball joint must begin at 0",
        ),
        (
            "<joint type='ball'/><joint/>",
            "a ball joint cannot be followed by a rotation in the same body",
        ),
    ];
    for (joints, reason) in cases {
        let text = format!("<mujoco><worldbody><body>{joints}<geom size='.1'/></body></worldbody></mujoco>");
        let error = load_str(&text, "m.xml", &MemoryAssets::new())
            .expect_err("refused")
            .to_string();
        assert!(error.ends_with(reason), "{error}");
    }
}
