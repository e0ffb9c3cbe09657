//! Populations of infants: in vectors, while they grow, in snapshots and in records.

use std::sync::Arc;
use std::time::Instant;

use babybench::config::{AgeSchedule, Behavior, Scene, Sex};
use babybench::mimo::{BodyFigures, BodyScores, Individual};
use babybench::{AutoresetMode, Blueprint, Config, VectorEnv, VectorOptions};

use crate::common::*;

/// A population with the spread of the standards, whose skins have equal numbers of sensors.
fn population(age: f64) -> Config {
    let mut config = Config {
        touch_grows: true,
        age: Some(age),
        ..free(Behavior::None, Scene::Base)
    };
    config.individual.random = 1.0;
    config
}

/// The bits of a few steps of every environment of a vector.
fn course(envs: &mut VectorEnv) -> Vec<Vec<f64>> {
    let n = envs.len();
    envs.reset(5).expect("no divergence");
    let len = envs.single_action_space().len();
    let mut rows = vec![Vec::new(); n];
    for step in 0..4 {
        let action = vec![0.3 * (step % 3) as f32 - 0.3; n * len];
        let batch = envs.step(&action).expect("all step");
        for (row, seen) in rows.iter_mut().enumerate() {
            seen.extend_from_slice(batch.row(row).expect("a row").proprioception);
        }
    }
    rows
}

#[test]
fn a_hundred_infants_of_one_seed_differ_and_are_the_same_again() {
    let n = 100;
    let first = blueprint(population(3.0));
    let made = |threads| {
        let options = VectorOptions {
            threads,
            ..VectorOptions::default()
        };
        VectorEnv::new(&first, n, options).expect("memory")
    };
    let start = Instant::now();
    let mut envs = made(1);
    let (compiled, again) = (start.elapsed(), Instant::now());
    let mut parallel = made(2);
    println!("{n} infants: {compiled:.1?}, and again {:.1?}", again.elapsed());
    let rows = course(&mut envs);
    assert!(rows == course(&mut parallel), "threads change nothing");
    let mut masses = Vec::new();
    for (row, seen) in rows.iter().enumerate() {
        let config = envs.env(row).expect("it is here").config();
        assert_eq!(config.individual.number, row as u64);
        let mass = BodyFigures::of(envs.env(row).expect("it is here").model())
            .expect("a MIMo")
            .mass;
        assert!(!masses.contains(&mass), "{config:?}");
        masses.push(mass);
        assert!(rows[..row].iter().all(|other| other != seen), "row {row}");
    }
    // another seed, other infants
    let mut other = population(3.0);
    other.individual.seed = 1;
    assert_ne!(Individual::of(&other), Individual::of(first.config()));
    // a row alone
    for row in [0, 7, 99] {
        let mut config = population(3.0);
        config.individual.number = row;
        let mut alone = env(config);
        alone.reset(Some(5 + row)).expect("no divergence");
        let len = alone.action_space().len();
        let mut seen = Vec::new();
        for step in 0..4 {
            let action = vec![0.3 * (step % 3) as f32 - 0.3; len];
            seen.extend_from_slice(alone.step(&action).expect("no divergence").observation.proprioception);
        }
        assert!(seen == rows[row as usize], "row {row}");
    }
}

/// A body that was needed among the last 128 is kept, and others are compiled again with the same bits.
#[test]
fn as_many_bodies_are_kept_as_a_vector_usually_has() {
    let first = blueprint(population(3.0));
    let infant = |number| first.with_body_number(number).expect("an infant");
    let same = |a: &Blueprint, b: &Blueprint| Arc::ptr_eq(a.model(), b.model());
    let one = infant(1);
    assert!(same(&one, &infant(1)) && same(&first, &infant(0)));
    (2..128).for_each(|number| drop(infant(number)));
    assert!(same(&one, &infant(1)));
    (128..257).for_each(|number| drop(infant(number)));
    let again = infant(1);
    assert!(!same(&one, &again) && one.model().body_mass == again.model().body_mass);
}

#[test]
fn z_scores_stay_while_he_grows() {
    let mut config = Config {
        age_schedule: AgeSchedule::new([(0, 1.0), (8, 3.0)]).expect("points"),
        age: None,
        max_episode_steps: 4,
        ..population(1.0)
    };
    config.individual.sex = Sex::Girl;
    let options = VectorOptions {
        autoreset: AutoresetMode::SameStep,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint(config.clone()), 3, options).expect("memory");
    envs.reset(0).expect("no divergence");
    let before: Vec<_> = (0..3)
        .map(|row| Individual::of(envs.env(row).expect("it is here").config()))
        .collect();
    let action = vec![0.1; 3 * envs.single_action_space().len()];
    for _ in 0..9 {
        envs.step(&action).expect("all step");
    }
    for (row, before) in before.iter().enumerate() {
        let grown = envs.env(row).expect("it is here");
        assert_eq!(grown.config().age, Some(3.0));
        assert_eq!(Individual::of(grown.config()), *before);
        let found = BodyScores::of(grown.model(), grown.config()).expect("an age")[0];
        assert!(
            (found.weight - before.expect("a girl").weight_z).abs() < 1e-6,
            "{found:?}"
        );
    }
    // a snapshot belongs to its infant
    let snapshot = envs.snapshot(0).expect("it is here");
    envs.restore(0, &snapshot).expect("his own");
    let error = envs.restore(1, &snapshot).expect_err("another's").to_string();
    assert!(error.contains("body_number was 0, but here it is 1"), "{error}");
}

#[test]
fn infants_whose_skins_differ_say_what_makes_them_equal() {
    let config = Config {
        touch_active: true,
        touch_grows: false,
        touch_scale: 2.0,
        ..population(6.0)
    };
    let result = VectorEnv::new(&blueprint(config.clone()), 4, VectorOptions::default());
    let error = result.expect_err("they differ").to_string();
    assert!(error.contains("touch_grows"), "{error}");
    let equal = Config {
        touch_grows: true,
        ..config
    };
    let equal = blueprint(equal);
    let mut envs = VectorEnv::new(&equal, 4, VectorOptions::default()).expect("equal skins");
    envs.reset(0).expect("no divergence");
    // the bodies count, before any is compiled
    let small = VectorOptions {
        max_memory: Some(1 << 30),
        ..VectorOptions::default()
    };
    let error = VectorEnv::new(&equal, 1_000_000, small)
        .expect_err("too many")
        .to_string();
    assert!(error.contains("use at most"), "{error}");
}

#[cfg(all(feature = "eval", feature = "npz"))]
#[test]
fn records_describe_the_infant_and_repeat_every_row() {
    use babybench::runs::{Record, RecordOptions, VectorRecorder};

    let folder = Folder::new("record_infants");
    let options = VectorOptions {
        autoreset: AutoresetMode::Disabled,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint(population(6.0)), 3, options).expect("memory");
    let mut recorder = VectorRecorder::create(folder.path(), &envs, RecordOptions::default()).expect("a folder");
    envs.reset(2).expect("no divergence");
    recorder.begin(&envs, 0).expect("all are here");
    let action = vec![0.2; 3 * envs.single_action_space().len()];
    for _ in 0..3 {
        recorder.step(&mut envs, &action).expect("all step");
    }
    recorder.end(&envs).expect("it is written");
    let record = Record::open(folder.path()).expect("a record");
    let infant = record.manifest().infant.expect("an individual");
    let asked = Individual::of(envs.env(0).expect("it is here").config()).expect("an individual");
    assert_eq!((infant.sex, infant.weight_z), (asked.sex, asked.weight_z));
    let mut env = env(population(6.0));
    for (episode, number) in [(0, None), (1, Some(1)), (2, Some(2))] {
        assert_eq!(record.manifest().episodes[episode as usize].body_number, number);
        let repeated = record.replay(episode, &mut env).expect("it fits");
        assert_eq!(repeated.first_difference, None, "episode {episode}");
    }
}
