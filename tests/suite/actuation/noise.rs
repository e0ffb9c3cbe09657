//! The noise of motors.

use crate::common::*;
use babybench::config::{ActuationModel, Behavior, Scene};
use babybench::{Config, Env};

fn noisy(deviation: f64, actuation_model: ActuationModel) -> Config {
    let mut config = free(Behavior::None, Scene::Base);
    config.noise.motor = deviation;
    config.actuation_model = actuation_model;
    config
}

/// What reaches the actuators in some steps of an action whose numbers are all the same.
fn controls(deviation: f64, value: f32, steps: usize) -> Vec<f64> {
    let mut env = env(noisy(deviation, ActuationModel::SpringDamper));
    env.reset(Some(5)).expect("no divergence");
    let action = vec![value; env.action_space().len()];
    let mut controls = Vec::new();
    for _ in 0..steps {
        env.step(&action).expect("no divergence");
        controls.extend_from_slice(&env.state().ctrl);
    }
    controls
}

#[test]
fn noise_of_motors_grows_with_the_action() {
    for value in [0.2, 0.5, -0.5] {
        let (plain, noisy) = (controls(0.0, value, 60), controls(0.1, value, 60));
        let shares: Vec<f64> = plain
            .iter()
            .zip(&noisy)
            .filter(|(plain, _)| **plain != 0.0)
            .map(|(plain, noisy)| noisy / plain - 1.0)
            .collect();
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        let variance = shares.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / shares.len() as f64;
        assert!(mean.abs() < 0.01, "{value}: the mean is {mean}");
        assert!((variance.sqrt() - 0.1).abs() < 0.01, "{value}: {}", variance.sqrt());
    }
    assert_eq!(controls(0.1, 0.0, 3), controls(0.0, 0.0, 3), "no action, no noise");
}

#[test]
fn noise_of_motors_goes_on_as_before_after_a_snapshot() {
    let mut env = env(noisy(0.2, ActuationModel::Muscle));
    env.reset(Some(1)).expect("no divergence");
    random_steps(&mut env, 3);
    let snapshot = env.snapshot();
    let action = vec![0.3; env.action_space().len()];
    let mut ends = Vec::new();
    for _ in 0..2 {
        env.restore(&snapshot).expect("its own");
        for _ in 0..4 {
            env.step(&action).expect("no divergence");
        }
        ends.push(bits(env.state()));
    }
    assert_eq!(ends[0], ends[1]);
}

/// A coloured noise continues from a snapshot, in the middle of a block, and differs from the white one.
#[test]
fn coloured_motor_noise_continues_from_a_snapshot() {
    let config = |motor_color| {
        let mut config = free(Behavior::None, Scene::Base);
        (config.noise.motor, config.noise.motor_color) = (0.3, motor_color);
        config
    };
    let run = |env: &mut Env, steps: usize| {
        let action = vec![0.5; env.action_space().len()];
        for _ in 0..steps {
            env.step(&action).expect("steps");
        }
        env.state().qpos.clone()
    };
    let ends = [None, Some(0.7), Some(1.4)].map(|color| {
        let mut env = Env::new(config(color)).expect("valid");
        env.reset(Some(3)).expect("resets");
        run(&mut env, 40);
        let snapshot = env.snapshot();
        let end = run(&mut env, 40);
        let mut other = env.blueprint().env().expect("the same");
        other.restore(&snapshot).expect("fits");
        assert_eq!(run(&mut other, 40), end, "{color:?}");
        env.reset(Some(3)).expect("resets");
        run(&mut env, 40);
        assert_eq!(run(&mut env, 40), end, "{color:?}: again from the seed");
        end
    });
    assert!(ends[0] != ends[1] && ends[1] != ends[2]);
}
