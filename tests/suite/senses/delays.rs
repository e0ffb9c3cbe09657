//! Senses that arrive late, and actions that do.

use babybench::config::{Behavior, Compat, DelayUnit, Delays, Scene, TouchFunction};
use babybench::sensors::transform::Sense;
use babybench::spaces::NumpyRng;
use babybench::{Blueprint, Config};

use super::{everything, seen};
use crate::common::*;

/// Resets two environments and lets them do the same; returns what each sensed.
fn side_by_side(a: Config, b: Config, steps: usize) -> [Vec<Vec<String>>; 2] {
    let mut envs = [env(a), env(b)];
    let mut all = [Vec::new(), Vec::new()];
    let mut rng = NumpyRng::seed(5);
    for (env, all) in envs.iter_mut().zip(&mut all) {
        env.reset(Some(0)).expect("no divergence");
        all.push(seen(env));
    }
    for _ in 0..steps {
        let mut action = Vec::new();
        envs[0].action_space().sample(&mut rng, &mut action);
        for (env, all) in envs.iter_mut().zip(&mut all) {
            env.step(&action).expect("no divergence");
            all.push(seen(env));
        }
    }
    all
}

#[test]
fn a_delay_of_d_steps_shows_what_was_d_steps_ago() {
    for (compat, by) in [(Compat::Api, 0), (Compat::Reference, 1)] {
        let now = Config {
            compat,
            touch_function: TouchFunction::ForceVector,
            ..everything()
        };
        let later = Config {
            delays: Delays {
                sensory: 3.0,
                vision: Some(2.0),
                touch: Some(5.0),
                vestibular: Some(0.0),
                ..Delays::default()
            },
            ..now.clone()
        };
        let [now, later] = side_by_side(now, later, 14);
        let delays: [usize; 6] = [3, 5, 5, 5, 0, 2];
        for (k, later) in later.iter().enumerate() {
            for (sense, delay) in delays.into_iter().enumerate() {
                let then = k.saturating_sub(delay.saturating_sub(by));
                assert_eq!(
                    later[sense], now[then][sense],
                    "{compat}: sense {sense} in observation {k}"
                );
            }
        }
        let moved = |sense: usize| now.iter().any(|seen| seen[sense] != now[0][sense]);
        assert!((0..delays.len()).all(moved), "every sense changes");
    }
}

#[test]
fn actions_reach_the_actuators_later() {
    let late = Config {
        delays: Delays {
            unit: DelayUnit::Ms,
            motor: 14.0, // three steps of 5 ms
            ..Delays::default()
        },
        ..free(Behavior::None, Scene::Base)
    };
    let (mut late, mut plain) = (env(late), env(free(Behavior::None, Scene::Base)));
    let rest = vec![0.0; late.action_space().len()];
    let mut rng = NumpyRng::seed(1);
    for episode in 0..2 {
        late.reset(Some(episode)).expect("no divergence");
        plain.reset(Some(episode)).expect("no divergence");
        let mut given = vec![rest.clone(); 3];
        for k in 0..8 {
            let mut action = Vec::new();
            late.action_space().sample(&mut rng, &mut action);
            given.push(action.clone());
            late.step(&action).expect("no divergence");
            plain.step(&given[k]).expect("no divergence");
            assert_eq!(bits(late.state()), bits(plain.state()), "episode {episode}, step {k}");
        }
    }
    assert_eq!(
        (late.blueprint().action_delay(), plain.blueprint().action_delay()),
        (3, 0)
    );
}

#[test]
fn under_reference_the_actions_of_a_reset_come_out_first() {
    let reference = |motor: f64| Config {
        compat: Compat::Reference,
        delays: Delays {
            motor,
            ..Delays::default()
        },
        ..free(Behavior::SelfTouch, Scene::Crib)
    };
    let (mut late, mut plain) = (env(reference(2.0)), env(reference(0.0)));
    let len = late.action_space().len();
    let action = |k: usize| vec![0.1 * k as f32 - 0.5; len];
    let starts: Vec<f32> = (0..3).flat_map(action).collect();
    late.by_hand().reset_with(&starts).expect("no divergence");
    // one step late: the first comes out twice
    let shifted: Vec<f32> = [0, 0, 1].into_iter().flat_map(action).collect();
    plain.by_hand().reset_with(&shifted).expect("no divergence");
    assert_eq!(bits(late.state()), bits(plain.state()));
    for k in 3..6 {
        late.step(&action(k)).expect("no divergence");
        plain.step(&action(k - 1)).expect("no divergence");
        assert_eq!(bits(late.state()), bits(plain.state()), "step {k}");
    }
}

#[test]
fn delays_of_an_age_are_those_of_its_latencies_and_grow_up_with_it() {
    let of_age = |age: f64, delays: Delays| {
        let config = Config {
            age: Some(age),
            delays: Delays { by_age: true, ..delays },
            touch_scale: 4.0,
            vision_resolution: 8,
            ..Config::default()
        };
        Blueprint::new(config).expect("embedded assets")
    };
    let senses = [Sense::EyeLeft, Sense::Touch, Sense::Proprioception, Sense::Vestibular];
    let steps = |blueprint: &Blueprint| senses.map(|sense| blueprint.sense_delay(sense));
    let newborn = of_age(0.0, Delays::default());
    // 260, 30, 30 and 13.3 ms in steps of 5 ms
    assert_eq!(steps(&newborn), [52, 6, 6, 3]);
    assert_eq!(newborn.action_delay(), 0);
    assert_eq!(steps(&newborn.with_age(Some(24.0)).expect("an age")), [21, 4, 4, 3]);
    let own = Delays {
        touch: Some(9.0),
        ..Delays::default()
    };
    assert_eq!(steps(&of_age(0.0, own)), [52, 9, 6, 3]);

    // what is observed is what one with delays in numbers observes
    let numbers = Config {
        delays: Delays {
            vision: Some(52.0),
            touch: Some(6.0),
            proprioception: Some(6.0),
            vestibular: Some(3.0),
            ..Delays::default()
        },
        ..newborn.config().clone()
    };
    let [one, other] = side_by_side(newborn.config().clone(), numbers, 70);
    assert!(one == other && one[69] != one[0]);
}
