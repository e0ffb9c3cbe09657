//! Vectors of environments: the same bits as environments alone, whatever the threads, the batch and the mode.

use std::sync::{Arc, Condvar, Mutex};

use babybench::config::{ActuationModel, Behavior, Part, Scene};
use babybench::env::{EnvStage, Observation};
use babybench::vector::{Batch, Buffers, Seeds, VectorError};
use babybench::{AutoresetMode, Blueprint, Config, Env, Info, VectorEnv, VectorOptions};
use testkit::Rng;

use crate::common::*;

const MODES: [AutoresetMode; 3] = [
    AutoresetMode::NextStep,
    AutoresetMode::SameStep,
    AutoresetMode::Disabled,
];
const THREADS: [usize; 4] = [1, 2, 3, 7];
const ENVS: usize = 7;

fn short(actuation_model: ActuationModel) -> Config {
    Config {
        actuation_model,
        max_episode_steps: 4,
        ..free(Behavior::SelfTouch, Scene::Crib)
    }
}

fn vector(blueprint: &Blueprint, n: usize, threads: usize, autoreset: AutoresetMode) -> VectorEnv {
    let options = VectorOptions {
        autoreset,
        threads,
        ..VectorOptions::default()
    };
    VectorEnv::new(blueprint, n, options).expect("memory and threads")
}

/// Everything that a step returns for one environment, as text.
fn line(observation: &Observation<'_>, flags: (f64, bool, bool), info: &Info) -> String {
    format!("{observation:?} {flags:?} {} {:?}", info.steps, info.behavior)
}

fn row(batch: &Batch<'_>, row: usize, info: &Info) -> String {
    let flags = (batch.rewards[row], batch.terminated[row], batch.truncated[row]);
    line(&batch.row(row), flags, info)
}

/// What `steps` steps of an environment alone return, by the rules of a mode: for each the result and, with
/// [`AutoresetMode::SameStep`], the end of the episode.
fn alone(env: &mut Env, mode: AutoresetMode, steps: usize) -> Vec<[String; 2]> {
    let mut action = Vec::new();
    let mut seen = Vec::new();
    let mut over = false;
    for _ in 0..steps {
        env.sample_action(&mut action);
        let mut last = String::new();
        let flags = if over && mode == AutoresetMode::NextStep {
            over = false;
            env.reset(None).expect("no divergence");
            (0.0, false, false)
        } else {
            if over {
                env.reset(None).expect("no divergence");
                env.sample_action(&mut action);
            }
            let step = env.step(&action).expect("no divergence");
            let flags = (step.reward, step.terminated, step.truncated);
            over = step.truncated;
            if over && mode == AutoresetMode::SameStep {
                last = format!("{:?} {} {:?}", step.observation, step.info.steps, step.info.behavior);
                env.reset(None).expect("no divergence");
                over = false;
            }
            flags
        };
        seen.push([line(&env.observation(), flags, env.info()), last]);
    }
    seen
}

/// The end of an episode in a row of a batch.
fn last(envs: &VectorEnv, row: usize) -> String {
    let finals = envs.finals().and_then(|finals| finals.row(row));
    let info = envs.final_info(envs.batch().ids[row]).expect("it is here");
    match (finals, info) {
        (Some(observation), Some(info)) => format!("{observation:?} {} {:?}", info.steps, info.behavior),
        (None, None) => String::new(),
        other => panic!("half an end: {other:?}"),
    }
}

/// The action of an environment of a vector, by the rules of a mode: with [`AutoresetMode::Disabled`], after a reset if
/// its episode is over.
fn next_action(envs: &mut VectorEnv, env: usize, mode: AutoresetMode, out: &mut Vec<f32>) {
    if mode == AutoresetMode::Disabled && envs.env(env).expect("it is here").truncated() {
        // as the environment alone, which draws an action before it sees that the episode is over
        let mut drawn = Vec::new();
        let alone = envs.env_mut(env).expect("it is here");
        alone.sample_action(&mut drawn);
        alone.reset(None).expect("no divergence");
    }
    envs.env_mut(env).expect("it is here").sample_action(out);
}

#[test]
fn a_vector_gives_the_bits_of_environments_alone() {
    const STEPS: usize = 11;
    let mut rng = Rng::with_seed(12);
    for &kind in ActuationModel::ALL {
        let blueprint = blueprint(short(kind));
        for mode in MODES {
            let expect: Vec<Vec<[String; 2]>> = (0..ENVS)
                .map(|env| {
                    let mut alone_env = blueprint.env().expect("available");
                    alone_env.reset(Some(5 + env as u64)).expect("no divergence");
                    alone(&mut alone_env, mode, STEPS)
                })
                .collect();
            for threads in THREADS {
                together(&blueprint, mode, threads, &expect);
                in_batches(&blueprint, mode, threads, &expect, &mut rng);
            }
        }
    }
}

fn together(blueprint: &Blueprint, mode: AutoresetMode, threads: usize, expect: &[Vec<[String; 2]>]) {
    let mut envs = vector(blueprint, ENVS, threads, mode);
    envs.reset(5).expect("no divergence");
    for k in 0..expect[0].len() {
        let (mut actions, mut action) = (Vec::new(), Vec::new());
        for env in 0..ENVS {
            next_action(&mut envs, env, mode, &mut action);
            actions.extend_from_slice(&action);
        }
        envs.step(&actions).expect("valid actions");
        for (env, expect) in expect.iter().enumerate() {
            let info = envs.env(env).expect("it is here").info();
            let found = [row(&envs.batch(), env, info), last(&envs, env)];
            assert!(
                found == expect[k],
                "{mode:?}, {threads} threads, environment {env}, step {k}"
            );
        }
    }
}

fn in_batches(blueprint: &Blueprint, mode: AutoresetMode, threads: usize, expect: &[Vec<[String; 2]>], rng: &mut Rng) {
    let mut envs = vector(blueprint, ENVS, threads, mode);
    envs.reset(5).expect("no divergence");
    let mut done = [0; ENVS];
    let mut next: Vec<usize> = (0..ENVS).collect();
    loop {
        next.retain(|&env| done[env] < expect[env].len());
        let (mut actions, mut action) = (Vec::new(), Vec::new());
        for &env in &next {
            next_action(&mut envs, env, mode, &mut action);
            actions.extend_from_slice(&action);
        }
        envs.send(&actions, &next).expect("they are here");
        if envs.in_flight() == 0 {
            break;
        }
        let batch = 1 + rng.usize(..envs.in_flight());
        next = envs.recv(batch).expect("that many are in flight").ids.to_vec();
        assert_eq!(next.len(), batch);
        for (k, &env) in next.iter().enumerate() {
            let info = envs.env(env).expect("it is here").info();
            let found = [row(&envs.batch(), k, info), last(&envs, k)];
            let step = done[env];
            assert!(
                found == expect[env][step],
                "{mode:?}, {threads} threads, batches, environment {env}, step {step}"
            );
            done[env] += 1;
        }
    }
    assert_eq!(done, [expect[0].len(); ENVS]);
}

#[test]
fn all_senses_are_the_bits_of_environments_alone() {
    for name in ["self_touch", "hand_regard", "test_installation"] {
        let blueprint = blueprint(example(name));
        let mut envs = vector(&blueprint, 3, 2, AutoresetMode::NextStep);
        let mut singles: Vec<Env> = (0..3).map(|_| blueprint.env().expect("available")).collect();
        envs.reset(1).expect("no divergence");
        for (seed, env) in (1..).zip(&mut singles) {
            env.reset(Some(seed)).expect("no divergence");
        }
        let mut actions = Vec::new();
        for _ in 0..3 {
            envs.sample_actions(&mut actions).expect("all are here");
            let batch = envs.step(&actions).expect("valid actions");
            let len = actions.len() / 3;
            for (k, env) in singles.iter_mut().enumerate() {
                let step = env.step(&actions[k * len..(k + 1) * len]).expect("no divergence");
                assert!(batch.row(k) == step.observation, "{name}: environment {k}");
                assert_eq!(batch.infos.steps[k], step.info.steps);
                if let Some(counts) = step.info.behavior.regards() {
                    let all = batch.infos.regards.expect("the behavior is hand_regard");
                    assert_eq!(all[4 * k..4 * (k + 1)], counts);
                }
                if let Some(touches) = step.info.behavior.touches() {
                    let all = batch.infos.touches.expect("the behavior is self_touch");
                    let geoms = all.len() / 6;
                    for (hand, touched) in touches.into_iter().enumerate() {
                        let row = &all[(2 * k + hand) * geoms..][..geoms];
                        let found: Vec<usize> = (0..geoms).filter(|&g| row[g] == 1).collect();
                        let mut touched = touched.to_vec();
                        touched.sort_unstable();
                        assert_eq!(found, touched);
                    }
                }
            }
        }
    }
}

#[test]
fn seeds_and_masks_reset_as_gymnasium_does() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let start = |seed| {
        let mut env = blueprint.env().expect("available");
        env.reset(Some(seed)).expect("no divergence").proprioception.to_vec()
    };
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::Disabled);
    let batch = envs.reset(40).expect("no divergence");
    let (first, second) = (
        batch.row(0).proprioception.to_vec(),
        batch.row(1).proprioception.to_vec(),
    );
    assert_eq!([&first, &second], [&start(40), &start(41)]);
    let list = [Some(7), None, Some(40)];
    let batch = envs.reset(Seeds::Each(&list)).expect("no divergence");
    assert_eq!(batch.row(0).proprioception, start(7));
    assert_ne!(batch.row(1).proprioception, second);
    assert_eq!(batch.row(2).proprioception, first);
    let kept = [0, 2].map(|k| envs.batch().row(k).proprioception.to_vec());
    let batch = envs.reset_where(&[false, true, false], 40).expect("no divergence");
    assert_eq!(batch.row(1).proprioception, second);
    assert_eq!(batch.row(0).proprioception, kept[0]);
    assert_eq!(batch.row(2).proprioception, kept[1]);
}

#[test]
fn environments_can_be_locked_kept_and_moved_one_by_one() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::Disabled);
    envs.reset(0).expect("no divergence");
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are here");
    envs.lock(1, Part::Arms, 0.1).expect("arms can be locked");
    let before = envs.snapshot(2).expect("it is here");
    let [_, one, two] = [0, 1, 2].map(|k| envs.step(&actions).map(|b| b.row(k).proprioception.to_vec()));
    let (one, two) = (one.expect("valid actions"), two.expect("valid actions"));
    envs.restore(2, &before).expect("its own snapshot");
    for _ in 0..3 {
        envs.step(&actions).expect("valid actions");
    }
    assert_eq!(envs.batch().row(2).proprioception, two);
    envs.unlock(1, Part::Arms).expect("arms can be unlocked");
    assert_ne!(envs.step(&actions).expect("valid actions").row(1).proprioception, one);
    let (qpos, qvel) = (blueprint.init_qpos(), blueprint.init_qvel());
    envs.set_state(0, qpos, qvel).expect("a settled state");
    assert_eq!(envs.env(0).expect("it is here").state().qpos, qpos);
}

#[test]
fn observations_go_into_memory_of_the_callers() {
    let blueprint = blueprint(example("test_installation"));
    let [mut own, mut other] = [1, 2].map(|threads| vector(&blueprint, 2, threads, AutoresetMode::NextStep));
    own.reset(0).expect("no divergence");
    other.reset(0).expect("no divergence");
    let mut actions = Vec::new();
    own.sample_actions(&mut actions).expect("all are here");
    let batch = own.step(&actions).expect("valid actions");
    let mut touch = vec![1.0; batch.observation.touch.map_or(0, <[f32]>::len)];
    let mut left = vec![0; batch.observation.eye_left.map_or(0, <[u8]>::len)];
    let mut truncated = [true; 2];
    let buffers = Buffers {
        touch: Some(&mut touch),
        eye_left: Some(&mut left),
        truncated: Some(&mut truncated),
        ..Buffers::default()
    };
    other.step_into(&actions, buffers).expect("they fit");
    assert_eq!(Some(&touch[..]), batch.observation.touch);
    assert_eq!(Some(&left[..]), batch.observation.eye_left);
    assert_eq!(truncated, [false; 2]);
    assert_eq!(other.infos().steps, batch.infos.steps);
    let small = Buffers {
        eye_left: Some(&mut left[1..]),
        ..Buffers::default()
    };
    let refused = other
        .step_into(&actions, small)
        .expect_err("it is too small")
        .to_string();
    assert!(refused.starts_with("eye_left: expected [2, 12288]"), "{refused}");
}

/// Makes an environment diverge in its next step.
fn break_physics(env: &mut Env) {
    let joints = env.state().qvel.len();
    env.state_mut().qvel[joints - 1] = 1e200;
}

#[test]
fn a_diverged_environment_is_reported_and_the_others_go_on() {
    let blueprint = blueprint(Config {
        max_episode_steps: 100,
        ..short(ActuationModel::SpringDamper)
    });
    for mode in MODES {
        let mut envs = vector(&blueprint, 3, 2, mode);
        let mut calm = vector(&blueprint, 3, 1, mode);
        envs.reset(0).expect("no divergence");
        calm.reset(0).expect("no divergence");
        break_physics(envs.env_mut(1).expect("it is here"));
        let actions = vec![0.1; 3 * calm.single_action_space().len()];
        calm.step(&actions).expect("valid actions");
        let batch = envs.step(&actions).expect("only one has diverged");
        let failure = &batch.failures[0];
        assert_eq!((batch.failures.len(), failure.env), (1, 1), "{mode:?}");
        assert!(failure.error.to_string().contains("diverged"), "{}", failure.error);
        assert_eq!(batch.truncated, [false, true, false]);
        assert!(batch.observation.proprioception.iter().all(|v| v.is_finite()));
        for env in [0, 2] {
            assert_eq!(batch.row(env), calm.batch().row(env));
        }
        assert_eq!(
            batch.finals.map(|f| f.ended[1]),
            (mode == AutoresetMode::SameStep).then_some(true)
        );
        let next = envs.step(&actions);
        match mode {
            AutoresetMode::Disabled => {
                assert!(matches!(next, Err(VectorError::NotReset { env: 1 })));
                envs.reset_where(&[false, true, false], None).expect("no divergence");
            }
            AutoresetMode::NextStep => assert_eq!(next.expect("it starts anew").infos.steps, [2, 0, 2]),
            AutoresetMode::SameStep => assert_eq!(next.expect("it has started anew").infos.steps, [2, 1, 2]),
        }
        assert!(envs.step(&actions).expect("all go on").failures.is_empty());
    }
}

#[test]
fn a_panic_reaches_the_caller_and_the_others_go_on() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    for threads in THREADS {
        let mut envs = vector(&blueprint, 4, threads, AutoresetMode::NextStep);
        envs.reset(0).expect("no divergence");
        let broken = envs.env_mut(2).expect("it is here");
        broken.set_probe(Some(Arc::new(|stage| {
            assert!(stage != Some(EnvStage::Senses), "a probe that panics")
        })));
        let actions = vec![0.1; 4 * envs.single_action_space().len()];
        let error = envs.step(&actions).expect_err("it panics").to_string();
        assert!(
            error.starts_with("environment 2 panicked: a probe that panics"),
            "{error}"
        );
        assert!(matches!(envs.step(&actions), Err(VectorError::NotReset { env: 2 })));
        // in two halves, the others come back all the same
        let len = envs.single_action_space().len();
        envs.reset_where(&[false, false, true, false], 0)
            .expect("it is made anew");
        envs.env_mut(2)
            .expect("it is here")
            .set_probe(Some(Arc::new(|_| panic!("again"))));
        envs.send(&actions, &[0, 1, 2, 3]).expect("all are here");
        let mut back = Vec::new();
        for _ in 0..4 {
            match envs.recv(1) {
                Ok(batch) => back.extend_from_slice(batch.ids),
                Err(VectorError::Panicked { env, message }) => assert_eq!((env, &*message), (2, "again")),
                Err(e) => panic!("{e}"),
            }
        }
        back.sort_unstable();
        assert_eq!(back, [0, 1, 3]);
        assert_eq!(envs.in_flight(), 0);
        envs.reset(0).expect("it is made anew");
        assert!(envs.step(&vec![0.1; 4 * len]).expect("all go on").failures.is_empty());
    }
}

#[cfg(feature = "parallel")]
#[test]
fn a_slow_environment_does_not_hold_the_others() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::NextStep);
    envs.reset(0).expect("no divergence");
    let gate = Arc::new((Mutex::new(false), Condvar::new()));
    let at_gate = gate.clone();
    let slow = envs.env_mut(0).expect("it is here");
    slow.set_probe(Some(Arc::new(move |_| {
        let open = at_gate.0.lock().expect("no panic");
        drop(at_gate.1.wait_while(open, |open| !*open).expect("no panic"));
    })));
    let len = envs.single_action_space().len();
    envs.send(&vec![0.1; 3 * len], &[0, 1, 2]).expect("all are here");
    for _ in 0..3 {
        // the first thread stands at the gate
        let ids = envs.recv(2).expect("two are quick").ids.to_vec();
        assert_eq!(ids.iter().sum::<usize>(), 3, "{ids:?}");
        envs.send(&vec![0.1; 2 * len], &ids).expect("they are here");
    }
    *gate.0.lock().expect("no panic") = true;
    gate.1.notify_all();
    let mut ids = envs.recv(3).expect("all are in flight").ids.to_vec();
    ids.sort_unstable();
    assert_eq!(ids, [0, 1, 2]);
}

#[test]
fn bad_input_says_what_and_where() {
    let blueprint = blueprint(short(ActuationModel::SpringDamper));
    let said = |error: VectorError| error.to_string();
    let options = VectorOptions::default();
    assert!(matches!(
        VectorEnv::new(&blueprint, 0, options),
        Err(VectorError::NoEnvironments)
    ));
    let huge = said(VectorEnv::new(&blueprint, usize::MAX, options).expect_err("too many"));
    assert!(huge.contains("of memory") && huge.contains("use at most"), "{huge}");
    let million = VectorOptions {
        max_memory: Some(1 << 30),
        ..options
    };
    let million = said(VectorEnv::new(&blueprint, 1_000_000, million).expect_err("too many"));
    assert!(million.contains("1000000 environments would take"), "{million}");

    let other = Blueprint::new(Config {
        touch_active: true,
        ..short(ActuationModel::SpringDamper)
    });
    let muscles = blueprint
        .with_actuation(ActuationModel::Muscle)
        .expect("the same scene");
    let mixed = [blueprint.clone(), blueprint.clone(), other.expect("available")];
    let mixed = said(VectorEnv::from_blueprints(&mixed, options).expect_err("one has touch"));
    assert!(
        mixed.contains("environment 2 differs") && mixed.contains("\"touch\""),
        "{mixed}"
    );
    let mixed = said(VectorEnv::from_blueprints(&[blueprint.clone(), muscles], options).expect_err("muscles"));
    assert!(
        mixed.contains("environment 1") && mixed.contains("action space"),
        "{mixed}"
    );

    let mut envs = vector(&blueprint, 4, 2, AutoresetMode::NextStep);
    let len = envs.single_action_space().len();
    let actions = vec![0.1; 4 * len];
    assert!(matches!(envs.step(&actions), Err(VectorError::NotReset { env: 0 })));
    envs.reset(0).expect("no divergence");
    let shape = said(envs.step(&actions[len..]).expect_err("three actions"));
    assert_eq!(
        shape,
        format!(
            "actions: expected [4, {len}] ({} values), found [3, {len}] ({} values)",
            4 * len,
            3 * len
        )
    );
    let mut wrong = actions.clone();
    wrong[2 * len + 1] = f32::NAN;
    let nan = said(envs.step(&wrong).expect_err("not a number"));
    assert!(nan.starts_with("environment 2: action[1]"), "{nan}");
    assert_eq!(envs.step(&actions).expect("untouched").infos.steps, [1; 4]);
    assert!(matches!(
        envs.recv(1),
        Err(VectorError::NotSent {
            wanted: 1,
            in_flight: 0
        })
    ));
    assert!(matches!(
        envs.send(&actions[..len], &[4]),
        Err(VectorError::Unknown { env: 4, envs: 4 })
    ));
    assert!(matches!(
        envs.send(&actions[..2 * len], &[1, 1]),
        Err(VectorError::InFlight { env: 1 })
    ));
    envs.send(&actions[..len], &[3]).expect("it is here");
    assert!(matches!(envs.step(&actions), Err(VectorError::InFlight { env: 3 })));
    assert!(matches!(envs.env(3), Err(VectorError::InFlight { env: 3 })));
    assert!(matches!(envs.recv(2), Err(VectorError::NotSent { .. })));
    assert!(matches!(envs.recv(0), Err(VectorError::NotSent { .. })));
    assert_eq!(envs.recv(1).expect("it is in flight").ids, [3]);
    let mask = said(envs.reset_where(&[true], None).expect_err("a mask of one"));
    assert!(mask.starts_with("mask: expected [4, 1]"), "{mask}");
}

#[test]
fn scenes_may_differ_where_the_spaces_do_not() {
    let of = |scene| {
        blueprint(Config {
            scene,
            max_episode_steps: 3,
            ..free(Behavior::SelfTouch, scene)
        })
    };
    let blueprints = [of(Scene::Base), of(Scene::Crib)];
    let mut envs = VectorEnv::from_blueprints(&blueprints, VectorOptions::default()).expect("the same spaces");
    envs.reset(3).expect("no divergence");
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are here");
    envs.step(&actions).expect("valid actions");
    let len = envs.single_action_space().len();
    for (k, blueprint) in blueprints.iter().enumerate() {
        let mut env = blueprint.env().expect("available");
        env.reset(Some(3 + k as u64)).expect("no divergence");
        let step = env.step(&actions[k * len..(k + 1) * len]).expect("no divergence");
        assert!(envs.batch().row(k) == step.observation);
    }
}
