//! Senses that look less often than the environment steps.

use babybench::Config;
use babybench::config::{Compat, Delays, TouchFunction};

use super::{everything, seen};
use crate::common::*;

/// Eyes that see 50 pictures a second, and a skin that feels 80 times, in an environment of 200 steps a second.
fn rated() -> Config {
    Config {
        vision_rate: Some(50.0),
        touch_rate: Some(80.0),
        ..everything()
    }
}

/// The images of a reset and some steps, and how old they are, s.
fn watch(config: Config, seed: u64, steps: usize) -> (Vec<Vec<String>>, Vec<Option<f64>>) {
    let mut env = env(config);
    env.reset(Some(seed)).expect("no divergence");
    let (mut all, mut ages) = (vec![seen(&env)], vec![env.info().details.vision_age]);
    for _ in 0..steps {
        random_steps(&mut env, 1);
        all.push(seen(&env));
        ages.push(env.info().details.vision_age);
    }
    (all, ages)
}

/// Indices into what [`seen`] returns.
const SKIN: [usize; 3] = [1, 2, 3];
const EYES: usize = 5;

#[test]
fn between_two_pictures_the_last_one_is_observed() {
    let (every, none) = watch(everything(), 3, 60);
    let (some, ages) = watch(rated(), 3, 60);
    assert!(none.iter().all(Option::is_none));
    let mut looks = 0;
    for (k, (some_seen, every_seen)) in some.iter().zip(&every).enumerate() {
        assert_eq!(
            (&some_seen[0], &some_seen[4]),
            (&every_seen[0], &every_seen[4]),
            "step {k}"
        );
        // none right after the reset, which looks
        let age = ages[k].unwrap_or_default();
        let back = (age / 0.005).round() as usize;
        assert_eq!(some_seen[EYES], every[k - back][EYES], "step {k}, {age} s old");
        assert!(back < 5, "step {k}: {back} steps old");
        looks += usize::from(k > 0 && back == 0);
    }
    assert!((14..=16).contains(&looks), "{looks} pictures in 0.3 s");
    let felt = |all: &[Vec<String>], k: usize| SKIN.map(|sense| all[k][sense].clone());
    let news = (1..=60).filter(|&k| felt(&some, k) != felt(&some, k - 1)).count();
    assert!(
        (10..=25).contains(&news),
        "the skin feels {news} times something else in 0.3 s"
    );
    // pain apart, which remembers its last feeling, what is felt was there at most three steps ago
    for k in 3..=60 {
        let fresh = (0..3).any(|back| some[k][1] == every[k - back][1] && some[k][2] == every[k - back][2]);
        assert!(fresh, "step {k}");
    }
}

#[test]
fn environments_with_other_seeds_look_in_other_steps() {
    let when = |seed| -> Vec<usize> {
        let (_, ages) = watch(rated(), seed, 20);
        (1..=20).filter(|&k| ages[k] == Some(0.0)).collect()
    };
    assert_eq!(when(1), when(1));
    let different: std::collections::BTreeSet<Vec<usize>> = (0..8).map(when).collect();
    assert!(different.len() >= 3, "{different:?}");
}

#[test]
fn a_delay_counts_from_the_picture_that_was_held() {
    let late = Config {
        delays: Delays {
            vision: Some(3.0),
            ..Delays::default()
        },
        ..rated()
    };
    let (now, _) = watch(rated(), 4, 40);
    let (late, _) = watch(late, 4, 40);
    for (k, late) in late.iter().enumerate() {
        assert_eq!(late[EYES], now[k.saturating_sub(3)][EYES], "step {k}");
    }
}

#[test]
fn a_restored_environment_shows_the_picture_that_the_original_held() {
    let mut held = 0;
    for (config, delayed) in [(rated(), false), (infant(), true)] {
        let mut one = env(config.clone());
        one.reset(Some(6)).expect("no divergence");
        for steps in [1, 2, 3, 1] {
            random_steps(&mut one, steps);
            let mut other = env(config.clone());
            other
                .by_hand()
                .resume(&one.snapshot())
                .expect("of the same configuration");
            // a picture that is due now is drawn at the present poses, as `refresh` does
            if !delayed && one.info().details.vision_age != Some(0.0) {
                assert!(seen(&one)[EYES] == seen(&other)[EYES], "what is held");
                held += 1;
            }
            let mut one = one.clone();
            for _ in 0..6 {
                random_steps(&mut one, 1);
                random_steps(&mut other, 1);
                assert!(seen(&one) == seen(&other), "what follows");
                assert_eq!(one.info(), other.info());
            }
        }
    }
    assert!(held > 0, "some snapshot lies between two pictures");
}

#[test]
fn the_reference_looks_in_every_step() {
    let config = Config {
        compat: Compat::Reference,
        touch_function: TouchFunction::ForceVector,
        ..rated()
    };
    let error = config.validate().expect_err("refused").to_string();
    assert!(error.contains("vision_rate") && error.contains("every step"), "{error}");
    let drawn = Config {
        vision_rate: Some(1e4),
        ..everything()
    };
    assert_eq!(
        watch(drawn, 1, 5).0,
        watch(everything(), 1, 5).0,
        "a rate beyond the steps"
    );
}
