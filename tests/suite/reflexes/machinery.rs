//! What all reflexes have in common.

use super::*;
use babybench::config::{BodyParts, Compat};
use babybench::env::Checksum;
use babybench::vector::VectorOptions;
use babybench::{Blueprint, EnvError, VectorEnv};

/// All reflexes, observed, in an infant who moves at random.
fn lively(model: ActuationModel) -> Config {
    let mut config = infant(Reflex::ALL);
    (config.age, config.actuation_model) = (Some(1.0), model);
    config.reflexes.observed = true;
    config.max_episode_steps = 40;
    config.frame_skip = 2;
    config
}

/// Steps at random, and returns the checksum of each moment.
fn course(env: &mut Env, steps: usize) -> Vec<Checksum> {
    let mut action = Vec::new();
    let step = |_| {
        env.sample_action(&mut action);
        env.step(&action).expect("a step");
        Checksum::of(env)
    };
    (0..steps).map(step).collect()
}

#[test]
fn snapshots_and_copies_continue_with_the_same_bits() {
    for model in MODELS {
        let mut env = started(lively(model));
        course(&mut env, 9);
        let snapshot = env.snapshot();
        let mut twin = env.clone();
        let mut other = env.blueprint().env().expect("it is valid");
        other.restore(&snapshot).expect("its own snapshot");
        let expect = course(&mut env, 20);
        assert!(course(&mut twin, 20) == expect, "{model}: a copy");
        assert!(course(&mut other, 20) == expect, "{model}: a snapshot");
    }
}

#[test]
fn vectors_have_the_bits_of_single_environments() {
    let blueprint = Blueprint::new(lively(ActuationModel::SpringDamper)).expect("valid");
    let mut vector = VectorEnv::new(&blueprint, 3, VectorOptions::default()).expect("valid");
    vector.reset(0).expect("a start");
    let n = vector.single_action_space().len();
    let mut singles: Vec<Env> = (0..3).map(|_| blueprint.env().expect("valid")).collect();
    for (seed, env) in (0..).zip(&mut singles) {
        env.reset(Some(seed)).expect("a start");
    }
    for k in 0..60 {
        let action: Vec<f32> = (0..3 * n)
            .map(|i| ((i * 7 + k * 13) % 21) as f32 / 10.0 - 1.0)
            .collect();
        vector.step(&action).expect("a step");
        for (row, env) in singles.iter_mut().enumerate() {
            if env.info().steps == 40 {
                // the step after the last of an episode starts the next
                env.reset(None).expect("a start");
            } else {
                env.step(&action[row * n..(row + 1) * n]).expect("a step");
            }
            assert_eq!(
                Checksum::of(vector.env(row).expect("there")),
                Checksum::of(env),
                "row {row}, step {k}"
            );
        }
    }
}

#[test]
fn activity_is_observed_and_counted() {
    let mut env = started(lively(ActuationModel::SpringDamper));
    assert_eq!(env.reflexes().collect::<Vec<_>>(), Reflex::ALL);
    course(&mut env, 30);
    let observed = env.observation().reflexes.expect("it is observed").to_vec();
    assert_eq!(observed.len(), Reflex::ALL.len());
    assert!(observed.iter().all(|v| (0.0..=1.0).contains(v)));
    let shares = env.info().details.reflexes.expect("it is counted");
    assert!(shares.get(Reflex::Stretch).is_some_and(|share| share > 0.5));
    let names: Vec<_> = env
        .info()
        .fields(Some(&env.info().details))
        .map(|(key, _)| key)
        .collect();
    assert!(
        names.contains(&"reflex_stretch") && names.contains(&"reflex_vor"),
        "{names:?}"
    );
}

#[test]
fn without_reflexes_nothing_changes() {
    // a gain of 0 drives the actuators by the action alone
    for model in MODELS {
        let mut none = lively(model);
        (none.reflexes.set, none.reflexes.observed) = (ReflexSet::default(), false);
        let mut still = none.clone();
        (still.reflexes.set, still.reflexes.gain) = (ReflexSet::new(Reflex::ALL.iter().copied()), 0.0);
        let (mut none, mut still) = (started(none), started(still));
        assert!(none.reflexes().next().is_none() && none.observation().reflexes.is_none());
        assert_eq!(course(&mut none, 20), course(&mut still, 20), "{model}");
    }
}

#[test]
fn reflexes_without_motors_are_refused_or_left_out() {
    let mut config = infant(&[Reflex::Vor]);
    config.act = BodyParts {
        eyes: false,
        ..BodyParts::all(true)
    };
    let error = Env::new(config.clone()).expect_err("no eye muscles");
    assert!(matches!(error, EnvError::Actuation(_)), "{error}");
    assert!(
        error
            .to_string()
            .contains("the reflex vor needs the motor act:left_eye_horizontal"),
        "{error}"
    );
    (config.reflexes.set, config.age) = (ReflexSet::BY_AGE, Some(1.0));
    let env = Env::new(config.clone()).expect("the others");
    assert!(env.reflexes().count() > 2 && env.reflexes().all(|reflex| reflex != Reflex::Vor));
    config.compat = Compat::Reference;
    assert!(Env::new(config).is_err());
}
