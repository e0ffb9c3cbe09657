//! A MIMo who grows by a schedule of ages: alone, in vectors, in snapshots and in records.

use babybench::config::{AgeSchedule, Behavior, Reflex, ReflexSet, StrengthModel};
use babybench::env::EnvError;
use babybench::runs::start_training;
use babybench::{AutoresetMode, Blueprint, Config, Env, VectorEnv, VectorOptions};

use crate::common::*;

/// The length of an episode, steps.
const EPISODE: u64 = 5;

/// A MIMo of 1 month who is 3 months old after 20 steps.
fn growing() -> Config {
    let mut config = Config {
        behavior: Behavior::SelfTouch,
        max_episode_steps: EPISODE,
        touch_grows: true,
        touch_scale: 3.0,
        vision_active: false,
        strength: StrengthModel::Infant,
        age_schedule: AgeSchedule::new([(0, 1.0), (20, 3.0)]).expect("points"),
        ..Config::default()
    };
    (config.delays.by_age, config.reflexes.set, config.reflexes.observed) =
        (true, ReflexSet::new([Reflex::Stretch, Reflex::Vor]), true);
    config
}

/// The same MIMo at one age.
fn at(age: f64) -> Config {
    Config {
        age: Some(age),
        age_schedule: AgeSchedule::default(),
        ..growing()
    }
}

/// Steps through an episode, and returns a checksum of each step.
fn episode(env: &mut Env, seed: u64) -> Vec<Vec<f64>> {
    env.reset(Some(seed)).expect("no divergence");
    let mut action = Vec::new();
    let steps = (0..EPISODE).map(|_| {
        env.sample_action(&mut action);
        let seen = env.step(&action).expect("no divergence").observation;
        let touch = seen.touch.expect("touch");
        seen.proprioception
            .iter()
            .copied()
            .chain([touch.iter().copied().map(f64::from).sum()])
            .collect()
    });
    steps.collect()
}

#[test]
fn episodes_begin_at_the_age_of_their_first_step() {
    let mut growing = env(growing());
    let spaces = growing.observation_space();
    for (k, age) in [1.0, 1.5, 2.0, 2.5, 3.0, 3.0].into_iter().enumerate() {
        let steps = episode(&mut growing, k as u64);
        assert_eq!(growing.config().age, Some(age));
        assert_eq!(growing.info().details.age, Some(age));
        // the bits are those of an environment made at that age
        assert!(steps == episode(&mut env(at(age)), k as u64), "{age} months");
        assert_eq!(growing.observation_space(), spaces, "{age} months");
    }
}

#[test]
fn a_schedule_without_a_change_of_age_has_the_bits_of_the_age() {
    let constant = Config {
        age_schedule: AgeSchedule::new([(0, 2.0)]).expect("a point"),
        ..growing()
    };
    let (mut constant, mut fixed) = (env(constant), env(at(2.0)));
    for seed in 0..3 {
        assert!(episode(&mut constant, seed) == episode(&mut fixed, seed));
    }
    assert_eq!(fixed.info().details.age, None);
}

#[test]
fn locks_outlast_growth() {
    let mut env = env(growing());
    env.reset(Some(3)).expect("no divergence");
    env.mimo_mut().lock("robot:right_elbow", -1.0).expect("a joint");
    episode(&mut env, 3);
    let mut alone = crate::common::env(at(1.5));
    let drawn = env.snapshot();
    env.reset(None).expect("no divergence");
    assert_eq!(env.config().age, Some(1.5));
    let elbow = env.model().joint("robot:right_elbow").expect("a joint");
    let held = env.state().qpos[env.model().jnt_qposadr[elbow]];
    assert!(held < -0.5, "{held}");
    assert!(alone.restore(&drawn).is_err(), "a snapshot of a growing MIMo");
}

#[test]
fn rows_of_a_vector_grow_by_their_own_steps() {
    let mut envs = Vec::new();
    for threads in [1, 2] {
        let options = VectorOptions {
            threads,
            autoreset: AutoresetMode::SameStep,
            ..VectorOptions::default()
        };
        envs.push(VectorEnv::new(&blueprint(growing()), 3, options).expect("memory"));
    }
    let mut alone = env(growing());
    for envs in &mut envs {
        envs.reset(4).expect("no divergence");
    }
    alone.reset(Some(4)).expect("no divergence");
    let len = alone.action_space().len();
    for step in 0..4 * EPISODE {
        let action = vec![0.4 * (step % 3) as f32 - 0.4; 3 * len];
        let ended = alone.step(&action[..len]).expect("no divergence").truncated;
        if ended {
            alone.reset(None).expect("no divergence");
        }
        for envs in &mut envs {
            envs.step(&action).expect("all step");
            assert_eq!(envs.batch().row(0), Some(alone.observation()), "step {step}");
            let age = alone.config().age.expect("an age");
            assert_eq!(envs.infos().age, Some(&[age; 3][..]), "step {step}");
        }
    }
    assert_eq!(alone.config().age, Some(3.0));
    // a row that starts over on its own is younger than the others
    let [mut envs, _] = <[VectorEnv; 2]>::try_from(envs).expect("two");
    let young = envs.env_mut(1).expect("it is here");
    let mut other = env(growing());
    other.reset(Some(0)).expect("no divergence");
    young.restore(&other.snapshot()).expect("of the same schedule");
    envs.step(&vec![0.0; 3 * len]).expect("all step");
    assert_eq!(envs.infos().age, Some(&[3.0, 1.0, 3.0][..]));
}

#[test]
fn snapshots_go_back_to_their_age_and_continue_with_the_same_bits() {
    let mut env = env(growing());
    episode(&mut env, 0);
    env.reset(Some(1)).expect("no divergence");
    random_steps(&mut env, 2);
    let snapshot = env.snapshot();
    let course = |env: &mut Env| {
        let action = vec![0.3; env.action_space().len()];
        let mut seen = Vec::new();
        for _ in 0..12 {
            if env.step(&action).expect("no divergence").truncated {
                seen.push(env.config().age.expect("an age"));
                env.reset(None).expect("no divergence");
            }
            seen.extend_from_slice(env.observation().proprioception);
        }
        seen
    };
    let expected = course(&mut env);
    assert!(env.config().age > Some(1.5));
    // in the same environment, in which he has grown since, and in a new one, in which he has not
    env.restore(&snapshot).expect("its own");
    assert_eq!((env.config().age, env.info().details.age), (Some(1.5), Some(1.5)));
    assert!(course(&mut env) == expected);
    let mut other = crate::common::env(growing());
    other.restore(&snapshot).expect("of the same schedule");
    assert!(course(&mut other) == expected);

    // a damaged one leaves age and bits alone
    let before = other.snapshot();
    let mut bytes = snapshot.as_bytes().to_vec();
    let end = bytes.len() - 200;
    bytes[end] ^= 1;
    if let Ok(damaged) = babybench::env::Snapshot::from_bytes(bytes) {
        assert!(other.restore(&damaged).is_err());
    }
    assert_eq!(other.snapshot(), before);
}

#[test]
fn what_growth_would_change_or_lose_is_refused_by_name() {
    let text = "age: {0: 1, 100: 2}\n";
    for (more, part) in [
        ("", "touch_grows"),
        ("touch_active: false\ncompat: reference\n", "age_schedule"),
        ("touch_active: false\nage_schedule: '0: 1'\n", "age_schedule"),
    ] {
        let error = Config::from_yaml(&format!("{text}{more}"), "c.yml").expect_err(more);
        assert!(error.to_string().contains(part), "{error}");
    }
    let mut env = env(growing());
    env.reset(Some(0)).expect("no divergence");
    for error in [
        env.mimo_mut().set_age(Some(4.0)),
        env.model_mut().change(|model| model.opt.gravity[2] = -1.0),
        env.model_mut().paint(|model| model.geom_rgba[0] = [1.0; 4]),
    ] {
        assert!(matches!(error, Err(EnvError::Schedule { .. })), "{error:?}");
    }
    let fixed = env.blueprint().with_age(Some(4.0)).expect("he grows");
    assert!(fixed.config().age_schedule.is_empty() && fixed.config().age == Some(4.0));
}

#[test]
fn blueprints_of_an_age_are_compiled_once() {
    let first = blueprint(at(1.0));
    let one = first.with_age(Some(2.0)).expect("he grows");
    let same = |a: &Blueprint, b: &Blueprint| std::sync::Arc::ptr_eq(a.model(), b.model());
    assert!(same(&one, &first.with_age(Some(2.0)).expect("it is kept")));
    assert!(same(&first, &one.with_age(Some(1.0)).expect("it is kept")));
    // of many ages the last are kept
    for age in 0..40 {
        first.with_age(Some(f64::from(age) / 2.0)).expect("he grows");
    }
    let again = first.with_age(Some(2.0)).expect("he grows");
    assert!(!same(&one, &again) && one.model().body_mass == again.model().body_mass);
}

#[cfg(all(feature = "eval", feature = "npz"))]
#[test]
fn a_record_of_a_childhood_is_repeated_with_the_same_bits() {
    use babybench::runs::{Record, RecordOptions, Recorder};

    let folder = Folder::new("childhood");
    let mut env = env(growing());
    let mut recorder = Recorder::create(folder.path(), &env, RecordOptions::default()).expect("a folder");
    let mut action = Vec::new();
    for number in 0..4 {
        env.reset(Some(number)).expect("no divergence");
        recorder.begin(&env, number);
        for _ in 0..EPISODE {
            env.sample_action(&mut action);
            recorder.step(&mut env, &action).expect("no divergence");
        }
        recorder.end(&env).expect("the episode can be written");
    }
    let record = Record::open(folder.path()).expect("a record");
    let mut again = Env::new(record.manifest().configuration.clone()).expect("its configuration");
    for number in [3, 0, 2, 1] {
        let repeated = record.replay(number, &mut again).expect("it can be repeated");
        assert_eq!(repeated.first_difference, None, "episode {number}");
        assert_eq!(again.config().age, Some(1.0 + 0.5 * number as f64));
    }
}

#[test]
fn a_resumed_run_goes_on_growing() {
    let folder = Folder::new("growing");
    let blueprint = blueprint(Config {
        save_dir: folder.path().display().to_string(),
        ..growing()
    });
    for (run, ages) in [[1.0, 1.5], [2.0, 2.5], [3.0, 3.0]].into_iter().enumerate() {
        let mut env = start_training(&blueprint, run > 0).expect("a log to go on with");
        for age in ages {
            env.reset(None).expect("no divergence");
            assert_eq!(env.config().age, Some(age), "run {run}");
            random_steps(env.env_mut(), EPISODE as usize);
        }
        env.reset(None).expect("no divergence");
        env.finish_training().expect("the log can be written");
    }
}
