//! Reset, step, info, truncation, locks.

use babybench::config::{Behavior, BodyParts, Compat, Scene};
use babybench::env::BehaviorInfo;
use babybench::model::EqualityKind;
use babybench::{Blueprint, Config, Model};

use crate::common::*;

#[test]
fn ten_start_actions_take_50_ms_except_for_behavior_none() {
    for (behavior, scene) in [
        (Behavior::None, Scene::Base),
        (Behavior::SelfTouch, Scene::Crib),
        (Behavior::HandRegard, Scene::Cubes),
    ] {
        for frame_skip in [1, 3] {
            let mut env = env(Config {
                frame_skip,
                ..free(behavior, scene.clone())
            });
            env.reset(Some(0)).expect("no divergence");
            let (steps, time) = if behavior == Behavior::None {
                (0, 0.0)
            } else {
                (10, 0.05)
            };
            assert_eq!(env.state().step, steps, "{behavior}");
            assert!(
                (env.state().time - time).abs() < 1e-12,
                "{behavior}: {}",
                env.state().time
            );
            random_steps(&mut env, 1);
            assert_eq!(env.state().step, steps + u64::from(frame_skip));
        }
    }
}

#[test]
fn info_counts_steps_from_one_or_in_reference_from_zero() {
    for (compat, first) in [(Compat::Api, 1), (Compat::Reference, 0)] {
        let mut env = env(Config {
            compat,
            ..body_only("self_touch")
        });
        for _ in 0..2 {
            env.reset(Some(0)).expect("no divergence");
            assert_eq!(env.info().steps, 0);
            let empty = BehaviorInfo::SelfTouch {
                touches: babybench::env::PerHand {
                    right_hand: vec![],
                    left_hand: vec![],
                },
            };
            assert_eq!(env.info().behavior, empty);
            let action = vec![0.0; env.action_space().len()];
            for k in 0..3 {
                assert_eq!(
                    env.step(&action).expect("no divergence").info.steps,
                    first + k,
                    "{compat}"
                );
            }
        }
    }
}

#[test]
fn touched_parts_are_unique_and_mimos_own() {
    let mut env = env(body_only("self_touch"));
    env.reset(Some(1)).expect("no divergence");
    held_steps(&mut env, 3000, 30);
    let model = env.model().clone();
    let hip = model.body("hip").expect("MIMo has a hip");
    let [right, left] = env.info().behavior.touches().expect("self_touch");
    println!("touched by the right palm: {right:?}, by the left: {left:?}");
    for list in [right, left] {
        for (i, &g) in list.iter().enumerate() {
            assert!(model.in_subtree(model.geom_bodyid[g], hip), "geom {g} is not MIMo's");
            assert!(!list[..i].contains(&g), "geom {g} is listed twice");
        }
    }
}

#[test]
fn hands_in_view_are_counted_at_most_once_per_step() {
    let mut env = env(body_only("hand_regard"));
    env.reset(Some(1)).expect("no divergence");
    held_steps(&mut env, 600, 60);
    let counts = env.info().behavior.regards().expect("hand_regard");
    println!("hands in view: {counts:?} of 600 steps");
    assert!(counts.iter().all(|&c| c <= 600));
}

#[test]
fn episodes_are_truncated_and_may_go_on() {
    let mut env = env(Config {
        max_episode_steps: 5,
        ..body_only("test_installation")
    });
    let action = vec![0.1; env.action_space().len()];
    for _ in 0..2 {
        env.reset(None).expect("no divergence");
        for k in 1..=8 {
            let step = env.step(&action).expect("stepping on is allowed");
            assert_eq!(step.truncated, k >= 5, "step {k}");
            assert!(!step.terminated && step.reward == 0.0);
        }
    }
}

/// Joints whose lock is on.
fn locked(model: &Model, eq_active: &[bool]) -> Vec<usize> {
    (0..model.neq())
        .filter(|&e| eq_active[e])
        .filter_map(|e| match model.eq_kind[e] {
            EqualityKind::Joint {
                joint1, joint2: None, ..
            } if model.jnt_name[joint1] == model.eq_name[e] => Some(joint1),
            _ => None,
        })
        .collect()
}

fn angles(blueprint: &Blueprint, qpos: &[f64]) -> Vec<(String, f64)> {
    let m = blueprint.model();
    let joints = locked(m, &blueprint.params().eq_active);
    joints
        .into_iter()
        .map(|j| (m.jnt_name[j].clone(), qpos[m.jnt_qposadr[j]]))
        .collect()
}

#[test]
fn locks_hold_from_construction_and_in_reference_from_the_first_reset() {
    for (name, active) in [("self_touch", 15), ("hand_regard", 33), ("test_installation", 8)] {
        for compat in [Compat::Api, Compat::Reference] {
            let blueprint = blueprint(Config {
                compat,
                ..body_only(name)
            });
            assert_eq!(
                blueprint.params().eq_active.iter().filter(|a| **a).count(),
                active,
                "{name}"
            );
            let settled = angles(&blueprint, blueprint.init_qpos());
            let worst = settled
                .iter()
                .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
                .expect("some joints are locked");
            println!(
                "{name:18} {compat:9}: {} locked joints, after settling at most {:.1e} rad ({})",
                settled.len(),
                worst.1,
                worst.0
            );
            match compat {
                Compat::Api => assert!(worst.1.abs() < 5e-3, "{worst:?}"),
                Compat::Reference => assert!(worst.1.abs() > 1e-3, "{worst:?}"),
            }
            let mut env = blueprint.env().expect("available");
            env.reset(Some(0)).expect("no divergence");
            random_steps(&mut env, 200);
            let later = angles(&blueprint, &env.state().qpos);
            let worst = max_abs(later.iter().map(|a| &a.1));
            println!("{name:18} {compat:9}: after 200 random steps at most {worst:.1e} rad");
            assert!(worst < 1e-2);
        }
    }
}

#[test]
fn joints_held_by_the_scene_keep_their_targets_when_locked() {
    let config = Config {
        lock: BodyParts {
            body: true,
            legs: true,
            ..BodyParts::all(false)
        },
        ..free(Behavior::HandRegard, Scene::Cubes)
    };
    let blueprint = blueprint(config);
    let m = blueprint.model();
    let held = [
        ("hip_bend1", 0.532),
        ("hip_bend2", 0.532),
        ("right_knee", -1.45),
        ("left_knee", -2.14),
        ("left_hip1", -1.41),
    ];
    for (name, angle) in held {
        let name = format!("robot:{name}");
        let joint = m.joint(&name).expect("a joint of MIMo");
        let lock = m.equality(&name).expect("every joint has a lock");
        let found = blueprint.init_qpos()[m.jnt_qposadr[joint]];
        println!("{name:18} target {angle:6}, settled at {found:.4}");
        assert!(!blueprint.params().eq_active[lock], "{name} is held twice");
        assert!((found - angle).abs() < 2e-2, "{name}: {found}");
    }
}

#[test]
fn a_seed_of_reset_counts_and_in_reference_only_that_of_the_action_space() {
    let start = |env: &mut babybench::Env, seed, space| {
        if let Some(s) = space {
            env.by_hand().seed_action_space(s);
        }
        env.reset(seed).expect("no divergence");
        env.state().qpos.clone()
    };
    for (compat, seed_counts) in [(Compat::Api, true), (Compat::Reference, false)] {
        let mut env = env(Config {
            compat,
            ..body_only("self_touch")
        });
        let first = start(&mut env, Some(3), Some(9));
        assert_eq!(
            start(&mut env, Some(3), None) == first,
            seed_counts,
            "{compat}: the seed of a reset"
        );
        assert_eq!(
            start(&mut env, None, Some(9)) == first,
            !seed_counts,
            "{compat}: the seed of the action space"
        );
    }
}

#[test]
fn without_actuators_the_action_is_empty() {
    let mut env = env(Config {
        act: BodyParts::all(false),
        ..body_only("self_touch")
    });
    env.reset(Some(0)).expect("no divergence");
    let step = env.step(&[]).expect("no divergence");
    assert_eq!(step.observation.proprioception.len(), 3 * 47 + 3 * 21);
}

#[test]
fn random_actions_equal_those_of_the_same_seed_and_stay_in_the_space() {
    let shared = blueprint(body_only("self_touch"));
    let [mut a, mut b] = [0, 1].map(|_| shared.env().expect("available"));
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for seed in [0, 1, u64::MAX] {
        a.by_hand().seed_action_space(seed);
        b.by_hand().seed_action_space(seed);
        for _ in 0..50 {
            a.sample_action(&mut x);
            b.sample_action(&mut y);
            assert_eq!(x, y);
            assert!(a.action_space().contains(&x));
        }
    }
}
