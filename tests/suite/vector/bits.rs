//! The same bits as environments alone, whatever the threads, the batch and the mode.

use super::*;
use babybench::config::{VisionOutput, VisionOutputs};
use babybench::vector::Buffers;
use babybench::{Env, Info};
use testkit::Rng;

/// Everything that a step returns for one environment, as text.
fn line(observation: &Observation<'_>, flags: (f64, bool, bool), info: &Info) -> String {
    format!("{observation:?} {flags:?} {} {:?}", info.steps, info.behavior)
}

fn row(batch: &VectorStep<'_>, row: usize, info: &Info) -> String {
    let flags = (batch.rewards[row], batch.terminated[row], batch.truncated[row]);
    line(&observed(batch, row), flags, info)
}

/// The results of `steps` steps of an environment alone, by the rules of a mode: for each the result and, with
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
    if mode == AutoresetMode::Disabled && envs.env(env).expect("it is here").last_step().truncated {
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
                assert!(observed(&batch, k) == step.observation, "{name}: environment {k}");
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

/// Lends room for the touch of some rows, of two that there is room for.
fn only_touch<'a>(touch: &'a mut [f32], touched: &'a mut [Vec<u32>], rows: usize) -> Buffers<'a> {
    let len = touch.len() / 2;
    Buffers {
        touch: Some(&mut touch[..rows * len]),
        touched: Some(&mut touched[..rows]),
        ..Buffers::default()
    }
}

#[test]
fn resets_steps_and_receipts_write_only_what_is_touched_where_the_caller_keeps_it() {
    let blueprint = blueprint(example("self_touch"));
    let [mut own, mut other] = [1, 2].map(|threads| vector(&blueprint, 2, threads, AutoresetMode::NextStep));
    let len = blueprint
        .env()
        .expect("MIMo")
        .senses()
        .touch()
        .map_or(0, |touch| touch.len());
    let (mut touch, mut touched) = (vec![0.0; 2 * len], vec![Vec::new(); 2]);
    own.reset(3).expect("no divergence");
    other
        .reset_into(None, 3, only_touch(&mut touch, &mut touched, 2))
        .expect("no divergence");
    let mut actions = Vec::new();
    for step in 0..40 {
        own.sample_actions(&mut actions).expect("all are here");
        own.step(&actions).expect("valid actions");
        other
            .step_into(&actions, only_touch(&mut touch, &mut touched, 2))
            .expect("valid actions");
        let batch = own.batch();
        assert!(batch.observation.touch == Some(&touch[..2 * len]), "step {step}");
    }
    own.sample_actions(&mut actions).expect("all are here");
    own.step(&actions).expect("valid actions");
    other.send(&actions, &[0, 1]).expect("valid actions");
    for _ in 0..2 {
        let env = other
            .recv_into(1, only_touch(&mut touch, &mut touched, 1))
            .expect("two are under way")[0];
        let felt = own.batch().row(env).expect("a row").touch;
        assert!(felt == Some(&touch[..len]), "environment {env}");
    }
    let refused = other
        .recv_into(1, only_touch(&mut touch, &mut touched, 1))
        .expect_err("none is under way")
        .to_string();
    assert!(refused.contains("call send first"), "{refused}");
    other
        .reset_into(Some(&[true, false]), 3, only_touch(&mut touch, &mut touched, 2))
        .expect("no divergence");
    own.reset_where(&[true, false], 3).expect("no divergence");
    assert!(own.batch().observation.touch == Some(&touch[..2 * len]));
}

#[test]
fn scenes_may_differ_where_the_spaces_do_not() {
    let of = |scene| {
        blueprint(Config {
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
        assert!(observed(&envs.batch(), k) == step.observation);
    }
}

#[test]
fn images_of_every_kind_have_rows_of_their_own() {
    let config = Config {
        vision_outputs: VisionOutputs::new(VisionOutput::ALL.iter().copied()),
        vision_resolution: 16,
        max_episode_steps: 3,
        ..example("test_installation")
    };
    let blueprint = Blueprint::new(config).expect("a configuration");
    let mut envs = vector(&blueprint, 3, 2, AutoresetMode::SameStep);
    let mut singles: Vec<Env> = (0..3).map(|_| blueprint.env().expect("a blueprint")).collect();
    envs.reset(5).expect("no divergence");
    for (seed, env) in (5..).zip(&mut singles) {
        env.reset(Some(seed)).expect("no divergence");
    }
    let mut actions = Vec::new();
    let (mut depth, mut geoms) = (vec![0.0; 3 * 256], vec![0; 3 * 256]);
    for step in 1..=3 {
        envs.sample_actions(&mut actions).expect("all are here");
        let batch = envs.step(&actions).expect("valid actions");
        let width = actions.len() / 3;
        for (k, env) in singles.iter_mut().enumerate() {
            env.step(&actions[k * width..(k + 1) * width]).expect("no divergence");
            let expected = env.observation();
            let last = batch.finals.and_then(|finals| finals.row(k));
            assert_eq!(last.is_some(), step == 3);
            let found = last.unwrap_or(observed(&batch, k));
            assert!(found == expected);
            assert!(found.eye_right_depth.is_some() && found.eye_right_segmentation.is_some());
        }
    }
    envs.sample_actions(&mut actions).expect("all are here");
    let buffers = Buffers {
        eye_right_depth: Some(&mut depth),
        eye_right_segmentation: Some(&mut geoms),
        ..Buffers::default()
    };
    envs.step_into(&actions, buffers).expect("they fit");
    let width = actions.len() / 3;
    for (k, env) in singles.iter_mut().enumerate() {
        env.reset(None).expect("no divergence");
        let step = env.step(&actions[k * width..(k + 1) * width]).expect("no divergence");
        let row = k * 256..(k + 1) * 256;
        assert_eq!(step.observation.eye_right_depth, Some(&depth[row.clone()]));
        assert_eq!(step.observation.eye_right_segmentation, Some(&geoms[row]));
    }
    let small = Buffers {
        eye_right_depth: Some(&mut depth[1..]),
        ..Buffers::default()
    };
    let refused = envs
        .step_into(&actions, small)
        .expect_err("it is too small")
        .to_string();
    assert!(refused.starts_with("eye_right_depth: expected [3, 256]"), "{refused}");
}
