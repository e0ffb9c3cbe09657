//! Touch by parts of the body, and pain.

use babybench::config::{Compat, PainOptions, TouchFunction};
use babybench::math::{add, norm};
use babybench::{Config, Env};

use super::everything;
use crate::common::*;

#[test]
fn pooled_touch_is_the_sum_of_the_sensors() {
    for function in [TouchFunction::Normal, TouchFunction::ForceVector] {
        let mut env = env(Config {
            touch_function: function,
            ..everything()
        });
        env.reset(Some(0)).expect("no divergence");
        random_steps(&mut env, 30);
        let (touch, pool) = (
            env.senses().touch().expect("touch"),
            env.senses().touch_pool().expect("pooled"),
        );
        let pooled = env.observation().touch_pooled.expect("pooled");
        assert!(pool.bodies().is_sorted() && pooled.len() == 5 * pool.bodies().len());
        let mut pressed = 0;
        for (&body, pooled) in pool.bodies().iter().zip(pooled.chunks_exact(5)) {
            let sensors = touch.body_values(body).chunks_exact(touch.width());
            let active = sensors.clone().filter(|v| v.iter().any(|v| *v != 0.0)).count();
            assert_eq!(pooled[1], active as f64);
            let felt = touch.contacts().iter().filter(|c| c.body == body && c.felt);
            let normal: f64 = felt.clone().map(|c| c.normal).sum();
            assert!((pooled[0] - normal).abs() < 1e-9);
            if function == TouchFunction::Normal {
                let sum: f64 = sensors.map(|v| f64::from(v[0])).sum();
                assert!((pooled[0] - sum).abs() < 1e-4, "{sum} N, pooled {pooled:?}");
            }
            let world = felt.fold([0.0; 3], |sum, c| add(sum, c.force));
            assert!((norm([pooled[2], pooled[3], pooled[4]]) - norm(world)).abs() < 1e-9);
            pressed += usize::from(active > 0);
        }
        assert!(pressed > 0, "something is pressed");
    }
}

/// The pain of each sensor, worked out from the contacts.
fn pain_of(env: &Env, options: &PainOptions, before: &[f32]) -> Vec<f64> {
    let touch = env.senses().touch().expect("touch");
    let new = touch.values().iter().map(|&force| {
        let pain = match env.config().compat {
            Compat::Api => options.slope * (f64::from(force) - options.threshold),
            Compat::Reference => options.slope * f64::from(force) - options.threshold,
        };
        pain.max(0.0).min(options.limit.unwrap_or(f64::INFINITY)) * options.decay_new
    });
    new.zip(before)
        .map(|(new, old)| new.max(f64::from(*old) * options.decay_old))
        .collect()
}

#[test]
fn pain_begins_at_the_threshold_and_fades() {
    let pain = PainOptions {
        threshold: 0.05,
        slope: 2.0,
        limit: Some(1.5),
        decay_old: 0.8,
        decay_new: 0.5,
    };
    let config = Config { pain, ..everything() };
    let mut env = env(config);
    env.reset(Some(0)).expect("no divergence");
    let mut before = vec![0.0; env.observation().pain.expect("pain").len()];
    let (mut hurting, mut limited) = (0, 0);
    for step in 0..40 {
        let expect = pain_of(&env, &pain, &before);
        let found = env.observation().pain.expect("pain");
        for (k, (found, expect)) in found.iter().zip(&expect).enumerate() {
            let off = (f64::from(*found) - expect).abs();
            assert!(
                off <= 1e-6 * (1.0 + expect),
                "sensor {k}, step {step}: {found}, expected {expect}"
            );
        }
        hurting = hurting.max(found.iter().filter(|p| **p > 0.0).count());
        limited = limited.max(found.iter().filter(|p| **p == 0.75).count());
        before = found.to_vec();
        random_steps(&mut env, 1);
    }
    println!("{hurting} sensors hurt, {limited} as much as they can");
    assert!(hurting > 0 && limited > 0);
}

/// The greatest pain that is left after some steps.
fn left(env: &mut Env) -> f32 {
    random_steps(env, 60);
    let pain = env.observation().pain.expect("pain");
    pain.iter().fold(0.0_f32, |most, p| most.max(*p))
}

#[test]
fn soft_things_do_not_hurt_here_and_in_copies() {
    let pain = PainOptions {
        threshold: 0.05,
        decay_old: 0.8,
        ..PainOptions::default()
    };
    let blueprint = blueprint(Config { pain, ..everything() });
    let [mut env, mut copy] = [(); 2].map(|()| blueprint.env().expect("an environment"));
    env.reset(Some(0)).expect("no divergence");
    let hard = env.snapshot();
    assert!(left(&mut env) > 0.1);
    env.restore(&hard).expect("its own snapshot");
    env.senses_mut().pain_mut().expect("pain").softness_mut().fill(0.0);
    copy.restore(&env.snapshot()).expect("of the same blueprint");
    assert!(left(&mut env) < 1e-5);
    assert!(left(&mut copy) < 1e-5);
    copy.restore(&hard).expect("of the same blueprint");
    assert!(left(&mut copy) > 0.1, "a snapshot carries how soft things are");
}
