//! An infant whose senses have every transform: copies, vectors, other ages.

use babybench::config::Delays;
use babybench::env::{Snapshot, draw_eyes};
use babybench::sensors::transform::Sense;
use babybench::vector::Buffers;
use babybench::{AutoresetMode, Blueprint, Config, Env, VectorEnv, VectorOptions};

use super::course;
use crate::common::*;

#[test]
fn a_copy_of_an_infant_continues_with_the_same_bits() {
    let blueprint = blueprint(infant());
    let mut first = blueprint.env().expect("an environment");
    first.reset(Some(3)).expect("no divergence");
    random_steps(&mut first, 7);
    let snapshot = first.snapshot();
    let expect = course(&mut first, 9);
    first.restore(&snapshot).expect("its own snapshot");
    assert_eq!(first.snapshot(), snapshot);
    assert!(course(&mut first, 9) == expect, "the same environment");
    let mut other = blueprint.env().expect("an environment");
    let kept = Snapshot::from_bytes(snapshot.as_bytes().to_vec()).expect("whole");
    other.restore(&kept).expect("of the same blueprint");
    assert!(course(&mut other, 9) == expect, "another environment");
    let without = Config {
        delays: Delays::default(),
        ..infant()
    };
    assert!(env(without).restore(&snapshot).is_err());
}

#[test]
fn a_reset_forgets_the_last_episode() {
    let mut used = env(infant());
    used.reset(Some(1)).expect("no divergence");
    random_steps(&mut used, 15);
    let mut fresh = env(infant());
    used.reset(Some(4)).expect("no divergence");
    fresh.reset(Some(4)).expect("no divergence");
    assert_eq!(used.observation(), fresh.observation());
    assert!(course(&mut used, 8) == course(&mut fresh, 8));
}

#[test]
fn infants_in_a_vector_are_as_if_alone() {
    const ENVS: usize = 3;
    let blueprint = blueprint(infant());
    let mut alone: Vec<Env> = (0..ENVS).map(|_| blueprint.env().expect("an environment")).collect();
    let options = VectorOptions {
        threads: 2,
        autoreset: AutoresetMode::SameStep,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint, ENVS, options).expect("memory");
    envs.reset(9).expect("no divergence");
    for (seed, env) in (9..).zip(&mut alone) {
        env.reset(Some(seed)).expect("no divergence");
    }
    let mut actions = Vec::new();
    let (mut pooled, mut pain) = (Vec::new(), Vec::new());
    for step in 0..25 {
        envs.sample_actions(&mut actions).expect("all are here");
        let len = actions.len() / ENVS;
        let batch = envs.step(&actions).expect("no divergence");
        for (k, env) in alone.iter_mut().enumerate() {
            let mut action = Vec::new();
            env.sample_action(&mut action);
            assert_eq!(action, actions[k * len..(k + 1) * len], "environment {k}, step {step}");
            let truncated = env.step(&action).expect("no divergence").truncated;
            if truncated {
                let last = batch
                    .finals
                    .and_then(|finals| finals.row(k))
                    .expect("the end of an episode");
                assert_eq!(last, env.observation(), "environment {k}, the last of step {step}");
                env.reset(None).expect("no divergence");
            }
            assert_eq!(batch.row(k), Some(env.observation()), "environment {k}, step {step}");
        }
        pooled.resize(batch.observation.touch_pooled.map_or(0, <[f64]>::len), 0.0);
        pain.resize(batch.observation.pain.map_or(0, <[f32]>::len), 0.0);
    }
    let buffers = Buffers {
        touch_pooled: Some(&mut pooled),
        pain: Some(&mut pain),
        ..Buffers::default()
    };
    envs.step_into(&actions, buffers).expect("room for all");
    assert!(pooled.iter().any(|v| *v != 0.0));
    assert!(pain.iter().any(|v| *v != 0.0));
}

#[test]
fn eyes_drawn_later_are_transformed_too() {
    let (mut direct, mut deferred) = (env(infant()), env(infant()));
    deferred.senses_mut().defer_vision(true);
    for env in [&mut direct, &mut deferred] {
        env.reset(Some(2)).expect("no divergence");
    }
    draw_eyes([&mut deferred]).expect("a renderer");
    let mut action = Vec::new();
    for step in 0..8 {
        assert_eq!(direct.observation(), deferred.observation(), "before step {step}");
        for env in [&mut direct, &mut deferred] {
            env.sample_action(&mut action);
            env.step(&action).expect("no divergence");
        }
        draw_eyes([&mut deferred]).expect("a renderer");
    }
}

#[test]
fn each_environment_of_a_vector_has_its_own_age() {
    let config = Config {
        age: Some(12.0),
        touch_grows: true,
        touch_scale: 2.0,
        vision_active: false,
        ..Config::default()
    };
    let make = |config: Config| VectorEnv::new(&blueprint(config), 3, VectorOptions::default()).expect("memory");
    let mut envs = make(config.clone());
    for (env, age) in [(0, Some(0.5)), (2, Some(24.0))] {
        envs.set_age(env, age).expect("the spaces stay");
    }
    envs.reset(1).expect("no divergence");
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are here");
    envs.step(&actions).expect("no divergence");
    let masses: Vec<f64> = (0..3)
        .map(|k| envs.env(k).expect("it is here").model().body_mass.iter().sum())
        .collect();
    assert!(
        masses.is_sorted() && masses[0] < 5.0 && masses[2] > 12.0,
        "{masses:?} kg"
    );
    let len = actions.len() / 3;
    for (k, age) in [(0, 0.5), (2, 24.0)] {
        let mut alone = env(Config {
            age: Some(age),
            ..config.clone()
        });
        alone.reset(Some(1 + k as u64)).expect("no divergence");
        alone.step(&actions[k * len..(k + 1) * len]).expect("no divergence");
        assert_eq!(envs.batch().row(k), Some(alone.observation()), "{age} months");
    }

    let mut shrinking = make(Config {
        touch_grows: false,
        ..config
    });
    shrinking.reset(0).expect("no divergence");
    let error = shrinking
        .set_age(1, Some(3.0))
        .expect_err("less skin has fewer sensors")
        .to_string();
    assert!(error.contains("environment 1") && error.contains("touch"), "{error}");
    assert!(error.contains("touch_grows"), "{error}");
    assert_eq!(shrinking.env(1).expect("it is here").config().age, Some(12.0));
    assert!(shrinking.set_age(1, Some(99.0)).is_err() && shrinking.set_age(9, None).is_err());
}

#[test]
fn a_blueprint_of_an_infant_makes_infants() {
    let grown: Vec<f64> = [None, Some(0.0), Some(24.0)]
        .into_iter()
        .map(|age| {
            let blueprint = Blueprint::new(infant())
                .and_then(|b| b.with_age(age))
                .expect("he grows");
            let env = blueprint.env().expect("an environment");
            let (_, mut chain) = env
                .senses()
                .transforms()
                .find(|(sense, _)| *sense == Sense::EyeRight)
                .expect("an eye");
            let acuity = chain.next().expect("acuity").describe();
            let age = acuity.split(' ').nth(2).expect("an age");
            age.parse::<f64>().expect("a number")
        })
        .collect();
    assert_eq!(grown, [18.0, 0.0, 24.0], "the acuity is that of the age");
}
