//! Environments that diverge or panic, and input that makes no sense.

use std::sync::Arc;

use super::*;
use babybench::Env;
use babybench::env::EnvStage;
use babybench::vector::VectorError;

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
            assert_eq!(observed(&batch, env), observed(&calm.batch(), env));
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
        broken.by_hand().set_probe(Some(Arc::new(|stage| {
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
            .by_hand()
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
    let none = VectorOptions {
        max_memory: Some(1),
        ..options
    };
    let none = said(VectorEnv::new(&blueprint, 2, none).expect_err("too many"));
    assert!(none.ends_with("not even one fits"), "{none}");
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
    let batch = envs.recv(1).expect("it is in flight");
    assert_eq!(batch.ids, [3]);
    assert!(batch.row(0).is_some() && batch.row(1).is_none());
    let mask = said(envs.reset_where(&[true], None).expect_err("a mask of one"));
    assert!(mask.starts_with("mask: expected [4, 1]"), "{mask}");
}
