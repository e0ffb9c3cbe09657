//! Reflexes of arms and legs.

use super::*;

/// Returns the energy in the shank after a kick, with and without the stretch reflex, and the time from the kick to the torque, s.
#[test]
fn a_stretched_muscle_pulls_back_after_17_ms() {
    for age in [Some(0.0), Some(12.0)] {
        let run = |reflexes: &[Reflex]| {
            let mut config = infant(reflexes);
            config.age = age;
            let mut env = started(config);
            for _ in 0..100 {
                rest(&mut env);
            }
            let model = env.model().clone();
            let dof = model.jnt_dofadr[model.joint("robot:right_knee").expect("a knee")];
            let motor = model.actuator("act:right_knee").expect("a motor");
            env.state_mut().qvel[dof] = -4.0;
            let mut path = vec![env.state().ctrl[motor]];
            let mut energy = 0.0;
            for _ in 0..200 {
                rest(&mut env);
                path.push(env.state().ctrl[motor]);
                energy += env.state().qvel[dof] * env.state().qvel[dof];
            }
            (path, energy)
        };
        let (with, damped) = run(&[Reflex::Stretch]);
        let (without, free) = run(&[]);
        assert!(without.iter().all(|u| *u == 0.0));
        // the control of step k acts from 5 (k - 1) ms on
        let first = with.iter().position(|u| *u > 1e-3).expect("an answer");
        let ms = 5 * (first - 1);
        assert!((15..=20).contains(&ms), "{ms} ms at {age:?}");
        assert!(damped < free, "{damped} and {free} at {age:?}");
    }
}

#[test]
fn a_turned_head_stretches_the_arm_of_the_face() {
    for model in MODELS {
        let difference = |age: f64, side: f64, reflexes: &[Reflex]| {
            let mut config = infant(reflexes);
            (config.age, config.actuation_model) = (Some(age), model);
            let mut env = started(config);
            env.mimo_mut()
                .lock("robot:head_swivel", side * 70_f64.to_radians())
                .expect("a lock");
            for _ in 0..600 {
                rest(&mut env);
            }
            let elbows = ["robot:left_elbow", "robot:right_elbow"].map(|joint| angle(&env, joint).to_degrees());
            side * (elbows[0] - elbows[1])
        };
        for side in [1.0, -1.0] {
            assert!(difference(1.4, side, &[Reflex::Atnr]) > 20.0, "{model}");
            // at 6 months it is gone: the posture is that without it
            assert_eq!(
                difference(6.0, side, &[Reflex::Atnr]),
                difference(6.0, side, &[]),
                "{model}"
            );
        }
    }
}

/// Lets MIMo fall, and returns the time until his arms move by the reflex, s, and that until they close again.
fn fall(config: Config) -> [f64; 2] {
    let run = |mut config: Config, reflex: bool| {
        if !reflex {
            config.reflexes.set = ReflexSet::default();
        }
        let mut env = started(config);
        let model = env.model().clone();
        // far above the floor
        env.state_mut().qpos[2] += 30.0;
        let joints = ["robot:right_shoulder_horizontal", "robot:left_shoulder_horizontal"];
        let mut path = Vec::new();
        for _ in 0..500 {
            rest(&mut env);
            path.push(joints.map(|joint| env.state().qvel[model.jnt_dofadr[model.joint(joint).expect("a joint")]]));
        }
        path
    };
    let (with, without) = (run(config.clone(), true), run(config, false));
    let first = with.iter().zip(&without).position(|(a, b)| a != b).expect("an answer");
    // the arms close forwards
    let close = with
        .iter()
        .skip(first + 40)
        .position(|v| v[0] > 0.5)
        .expect("an embrace")
        + first
        + 40;
    [first, close].map(|step| 0.005 * step as f64)
}

#[test]
fn a_drop_spreads_the_arms_and_closes_them() {
    for model in MODELS {
        let mut config = infant(&[Reflex::Moro]);
        (config.age, config.actuation_model) = (Some(1.0), model);
        let [spread, close] = fall(config);
        assert!((0.110..=0.135).contains(&spread), "{model}: {spread} s");
        assert!((0.8..=1.25).contains(&close), "{model}: {close} s");
    }
}
