//! Tasks with goals: rewards as functions of goals, snapshots, seeds, vectors, what `compat: api` does right, and bad input.

mod ball;

use std::sync::Arc;

use babybench::assets::MemoryAssets;
use babybench::config::{Behavior, Compat, Config, Example, RollOverOptions, StartingPosition};
use babybench::env::{BehaviorInfo, Goal, Outcome};
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, EngineError, FreeBody, SoftEngine, SoftOptions, compile};
use babybench::render::{CpuRenderer, Poses, Scenery, View};
use babybench::{Env, Model, VectorEnv, VectorOptions};
use testkit::Rng;

use crate::common::*;

#[path = "../../examples/own_task.rs"]
mod own_task;

const TASKS: [Behavior; 7] = [
    Behavior::Reach,
    Behavior::Standup,
    Behavior::SelfBody,
    Behavior::Catch,
    Behavior::RollOver,
    Behavior::Mobile,
    Behavior::Play,
];

/// Tasks that the Python code does not have.
fn is_own(behavior: Behavior) -> bool {
    matches!(behavior, Behavior::Mobile | Behavior::Play)
}

fn task(behavior: Behavior) -> Env {
    env(Config::of(behavior))
}

/// Everything that comes out of random steps, and of the resets between episodes, as text.
fn course(env: &mut Env, steps: usize) -> Vec<String> {
    let mut action = Vec::new();
    let mut seen = Vec::new();
    for _ in 0..steps {
        if env.last_step().over() {
            env.reset(None).expect("no divergence");
        }
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        seen.push(format!(
            "{:?} {:?} {} {} {:?}",
            step.observation, step.reward, step.terminated, step.truncated, step.info
        ));
    }
    seen.push(bits(env.state()));
    seen
}

#[test]
fn a_program_writes_a_task_of_its_own() {
    own_task::main().expect("the example runs");
}

#[test]
fn examples_are_the_defaults_of_their_tasks() {
    for (example, behavior) in Example::TASKS.into_iter().zip(TASKS) {
        assert_eq!(example.config().expect("valid"), Config::of(behavior), "{behavior}");
        assert_eq!(example.name, behavior.name());
    }
}

#[test]
fn sizes_are_those_of_mimo() {
    for (behavior, proprioception, actions, touch, goal) in [
        (Behavior::Reach, 220, 8, None, 3),
        (Behavior::Standup, 258, 27, None, 1),
        (Behavior::SelfBody, 220, 8, Some(1836), 37),
        (Behavior::Catch, 411, 40, Some(5928), 0),
        (Behavior::RollOver, 292, 44, None, 1),
    ] {
        let env = task(behavior);
        let observation = env.observation();
        assert_eq!(observation.proprioception.len(), proprioception, "{behavior}");
        assert_eq!(env.action_space().len(), actions, "{behavior}");
        assert_eq!(observation.touch.map(<[f32]>::len), touch, "{behavior}");
        assert_eq!(observation.desired_goal.map_or(0, <[f64]>::len), goal, "{behavior}");
        let spaces = env.observation_space();
        let space = |key: &str| spaces.iter().find(|s| s.key == key).map(|s| s.shape[0]);
        assert_eq!(space("observation"), Some(proprioception));
        assert_eq!(space("achieved_goal").unwrap_or_default(), goal);
    }
}

/// Rewards of steps, and what [`Blueprint::compute_reward`] makes of their rows afterwards, alone and at once; then with goals of other steps.
#[test]
fn rewards_follow_from_goals_to_the_bit() {
    for behavior in TASKS {
        for compat in [Compat::Api, Compat::Reference] {
            if compat == Compat::Reference && is_own(behavior) {
                continue; // refused: `conflicting_keys_are_refused`
            }
            let mut env = env(Config {
                compat,
                ..Config::of(behavior)
            });
            env.reset(Some(4)).expect("no divergence");
            let (mut rewards, mut achieved, mut desired, mut terms) = (vec![], vec![], vec![], vec![]);
            let mut action = Vec::new();
            for _ in 0..60 {
                if env.last_step().over() {
                    env.reset(None).expect("no divergence");
                }
                env.sample_action(&mut action);
                rewards.push(env.step(&action).expect("no divergence").reward);
                achieved.extend_from_slice(env.goal().achieved);
                desired.extend_from_slice(env.goal().desired);
                terms.extend_from_slice(env.goal().terms);
            }
            let n = rewards.len();
            let mut found = vec![0.0; n];
            let all = |desired| Goal {
                achieved: &achieved,
                desired,
                terms: &terms,
            };
            env.blueprint()
                .compute_reward(all(&desired), &mut found)
                .expect("they fit");
            assert_eq!(found, rewards, "{behavior}, {compat}");

            // hindsight: every step gets the goal that a later one achieved
            let len = desired.len() / n;
            let later = |k: usize| (k * 7 + 3) % n;
            let hindsight: Vec<f64> = (0..n)
                .flat_map(|k| achieved[later(k) * len..][..len].to_vec())
                .collect();
            env.blueprint()
                .compute_reward(all(&hindsight), &mut found)
                .expect("they fit");
            let width = terms.len() / n;
            for (k, &together) in found.iter().enumerate() {
                let mut alone = [0.0];
                let row = Goal {
                    achieved: &achieved[k * len..][..len],
                    desired: &hindsight[k * len..][..len],
                    terms: &terms[k * width..][..width],
                };
                env.blueprint().compute_reward(row, &mut alone).expect("they fit");
                assert_eq!(alone[0], together, "{behavior}, step {k}");
            }
        }
    }
}

#[test]
fn hindsight_makes_successes_of_failures() {
    let mut env = task(Behavior::SelfBody);
    env.reset(Some(1)).expect("no divergence");
    let goal = env.goal();
    let (mut hip, mut touched) = (vec![0.0; 37], goal.achieved.to_vec());
    hip[2] = 1.0;
    touched[2] = 1.0;
    let mut reward = [0.0];
    let row = |achieved, desired| Goal {
        achieved,
        desired,
        terms: goal.terms,
    };
    env.blueprint()
        .compute_reward(row(&touched, &hip), &mut reward)
        .expect("it fits");
    assert_eq!(reward, [500.0]);
    env.blueprint()
        .compute_reward(row(&[0.0; 37], &hip), &mut reward)
        .expect("it fits");
    assert!(reward[0] < 0.0);
}

#[test]
fn snapshots_continue_tasks_with_the_same_bits() {
    for behavior in TASKS {
        let mut env = task(behavior);
        env.reset(Some(3)).expect("no divergence");
        course(&mut env, 9);
        let snapshot = env.snapshot();
        let expect = course(&mut env, 30);
        env.restore(&snapshot).expect("its own snapshot");
        assert!(course(&mut env, 30) == expect, "{behavior}");
        let mut other = env.blueprint().env().expect("another one");
        other.restore(&snapshot).expect("of the same configuration");
        assert!(course(&mut other, 30) == expect, "{behavior} elsewhere");
    }
}

#[test]
fn episodes_of_a_vector_are_those_of_environments_alone() {
    for behavior in [Behavior::Standup, Behavior::SelfBody, Behavior::Catch] {
        let blueprint = babybench::Blueprint::new(Config::of(behavior)).expect("valid");
        let mut envs = VectorEnv::new(&blueprint, 3, VectorOptions::default()).expect("environments");
        let mut alone: Vec<Env> = (0..3).map(|_| blueprint.env().expect("an environment")).collect();
        envs.reset(5).expect("no divergence");
        for (seed, env) in (5..).zip(&mut alone) {
            env.reset(Some(seed)).expect("no divergence");
        }
        let actions = vec![0.2; 3 * blueprint.env().expect("an environment").action_space().len()];
        for _ in 0..10 {
            let batch = envs.step(&actions).expect("no divergence");
            for (row, env) in alone.iter_mut().enumerate() {
                let step = env.step(&actions[..actions.len() / 3]).expect("no divergence");
                assert_eq!(batch.row(row), Some(step.observation), "{behavior}");
                assert_eq!(
                    (batch.rewards[row], batch.terminated[row]),
                    (step.reward, step.terminated)
                );
                let terms = batch.infos.reward_terms.expect("a task has terms");
                let width = terms.len() / 3;
                assert_eq!(&terms[row * width..][..width], env.goal().terms);
                let outcome = env.info().behavior.task().map(|task| task.outcome);
                assert_eq!(batch.infos.outcomes.map(|o| o[row]), outcome);
                assert!(
                    !env.last_step().over(),
                    "{behavior}: ten steps are too few to end an episode"
                );
            }
        }
    }
}

#[test]
fn a_seed_decides_everything() {
    for behavior in TASKS {
        let mut env = task(behavior);
        let mut run = |seed| {
            env.reset(Some(seed)).expect("no divergence");
            let start = env.state().qpos.clone();
            (start, course(&mut env, 12))
        };
        let (first, other) = (run(1), run(2));
        assert!(first == run(1), "{behavior}");
        assert!(first.1 != other.1, "{behavior}: seeds make no difference");
    }
}

#[test]
fn balls_start_in_different_places_with_different_sizes() {
    let mut env = task(Behavior::Catch);
    let ball = env.model().body("target").expect("a ball");
    let geom = env.model().body_geomadr[ball];
    let mut seen = Vec::new();
    for seed in 0..6 {
        env.reset(Some(seed)).expect("no divergence");
        let (state, radius) = (env.state(), env.state().params.geom_size[geom][0]);
        assert!((0.005..=0.025).contains(&radius) && (0.05..=0.5).contains(&state.params.body_mass[ball]));
        assert_eq!(env.observation().proprioception.last(), Some(&radius));
        assert_eq!(state.params.gravity, [0.0, 0.0, -9.81]);
        seen.push(state.xpos[ball][2].to_bits());
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 6);
}

#[test]
fn contacts_of_the_last_episode_do_not_count() {
    let mut env = task(Behavior::Catch);
    env.reset(Some(0)).expect("no divergence");
    let before = env.snapshot();
    let contacts = |env: &mut Env| {
        let mut memory = Vec::new();
        env.by_hand().task().save(&mut memory);
        memory[5..105].to_vec()
    };
    assert_eq!(contacts(&mut env), [0.0; 100]);
    course(&mut env, 20);
    env.reset(Some(0)).expect("no divergence");
    assert_eq!(env.snapshot().as_bytes().len(), before.as_bytes().len());
    assert_eq!(contacts(&mut env), [0.0; 100]);
}

/// Without an action nothing is touched with the hand, whatever lies on the floor or on the body itself.
#[test]
fn only_the_hand_succeeds_in_touching_the_body() {
    let mut env = task(Behavior::SelfBody);
    let still = vec![0.0; env.action_space().len()];
    for seed in 0..12 {
        env.reset(Some(seed)).expect("no divergence");
        let step = env.step(&still).expect("no divergence");
        assert!(!step.terminated, "seed {seed}");
    }
}

#[test]
fn mimo_sits_as_he_is_locked() {
    let env = task(Behavior::SelfBody);
    let q = |name: &str| {
        let joint = env.model().joint(name).expect("a joint");
        env.blueprint().init_qpos()[env.model().jnt_qposadr[joint]]
    };
    for (joint, angle) in [
        ("robot:left_hand1", 0.28278),
        ("robot:left_knee", -2.531),
        ("robot:head_tilt", 0.0),
    ] {
        assert!((q(joint) - angle).abs() < 0.05, "{joint}: {}", q(joint));
    }
}

#[test]
fn mimo_lies_on_his_back_or_on_his_belly() {
    for (starting_position, up) in [(StartingPosition::Supine, 1.0), (StartingPosition::Prone, -1.0)] {
        let mut env = env(Config {
            roll_over: RollOverOptions { starting_position },
            ..Config::of(Behavior::RollOver)
        });
        env.reset(Some(0)).expect("no divergence");
        let hip = env.model().body("hip").expect("MIMo");
        assert!(env.state().xmat[hip][6] * up > 0.8, "{starting_position}");
        assert!(env.goal().achieved[0] < 0.3, "{starting_position}: {:?}", env.goal());
    }
}

#[test]
fn success_terminates_and_the_return_adds_up() {
    let mut env = task(Behavior::Reach);
    env.reset(Some(0)).expect("no divergence");
    let ball = env.model().body("target").expect("a ball");
    let dof = env.model().body_dofadr[ball];
    let still = vec![0.0; env.action_space().len()];
    let first = env.step(&still).expect("no divergence").reward;
    env.state_mut().qvel[dof] = 2.0;
    let step = env.step(&still).expect("no divergence");
    let (reward, terminated) = (step.reward, step.terminated);
    assert!(terminated && reward > 90.0);
    let info = env.info().behavior.task().cloned().expect("a task");
    assert_eq!(
        info.outcome,
        Outcome {
            is_success: true,
            is_failure: false
        }
    );
    assert_eq!(info.episode_return, first + reward);
    assert!(matches!(env.info().behavior, BehaviorInfo::Task(_)));
}

#[test]
fn keys_of_tasks_have_an_effect() {
    let run = |text: &str| {
        let mut env = env(Config::from_yaml(text, "c.yml").expect("allowed"));
        env.reset(Some(2)).expect("no divergence");
        let still = vec![0.5; env.action_space().len()];
        let mut ends = Vec::new();
        for k in 0..3 {
            if k == 1 && env.model().body("target").is_some() {
                let ball = env.model().nv - 6;
                env.state_mut().qvel[ball] = 60.0;
            }
            let step = env.step(&still).expect("no divergence");
            ends.push((step.reward.to_bits(), step.terminated));
        }
        (ends, bits(env.state()))
    };
    for (base, change) in [
        ("behavior: reach", "done_active: false"),
        ("behavior: catch", "action_penalty: false"),
        ("behavior: catch", "jitter: true"),
        ("behavior: catch", "position_inaccurate: true"),
        ("behavior: roll_over", "starting_position: prone"),
        ("behavior: mobile", "mobile_limb: left_hand"),
        ("behavior: mobile", "mobile_baseline: 0"),
        ("behavior: mobile\nmobile_baseline: 0", "mobile_extinction: 1"),
        ("behavior: mobile", "mobile_reward: true"),
    ] {
        assert_ne!(run(base), run(&format!("{base}\n{change}")), "{change} changes nothing");
    }
}

#[test]
fn conflicting_keys_are_refused() {
    for (config, key, advice) in [
        ("behavior: reach\nscene: crib", "scene", "leave `scene` out"),
        ("compat: reference\nbehavior: mobile", "behavior", "leave `compat` out"),
        (
            "mobile_baseline: 0.9\nmobile_extinction: 0.2\nbehavior: mobile",
            "mobile_extinction",
            "add up to 1 at most",
        ),
        ("behavior: standup\nact_head: false", "act_head", "leave `act_...` out"),
        (
            "behavior: catch\nactuation_model: positional",
            "actuation_model",
            "use spring_damper or muscle",
        ),
        (
            "behavior: selfbody\ntouch_active: false",
            "touch_active",
            "leave `touch_active`",
        ),
    ] {
        let error = Config::from_yaml(config, "c.yml").expect_err(config).to_string();
        assert!(
            error.contains("c.yml:2:") && error.contains(key) && error.contains(advice),
            "{error}"
        );
    }
}

#[test]
fn goals_of_a_wrong_shape_are_refused() {
    let mut env = task(Behavior::Standup);
    env.reset(Some(0)).expect("no divergence");
    let error = env.by_hand().set_goal(&[0.1, 0.2]).expect_err("too long").to_string();
    assert!(error.contains("desired_goal has 2 values"), "{error}");
    assert!(env.by_hand().set_goal(&[f64::NAN]).is_err());
    let goal = Goal {
        achieved: &[0.1, 0.2],
        desired: &[0.5],
        terms: &[0.0, 0.0],
    };
    let error = env
        .blueprint()
        .compute_reward(goal, &mut [0.0; 2])
        .expect_err("too short")
        .to_string();
    assert!(error.contains("desired has 1 values"), "{error}");
    env.by_hand().set_goal(&[0.1]).expect("it fits");
    assert!(env.info().behavior.task().is_some_and(|task| task.outcome.is_success));
}
