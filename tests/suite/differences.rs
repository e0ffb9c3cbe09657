//! Infants who differ: z-scores of length, weight and head, and preterm infants.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use babybench::config::{Behavior, Proportions, Scene, Sex, StrengthModel};
use babybench::mimo::{
    BodyFigures, BodyScores, Growth, GrowthStandard, Individual, SceneError, Version, build_model, embedded,
    held_posture, strength_table,
};
use babybench::model::Model;
use babybench::physics::{Engine, SoftEngine, SoftOptions};
use babybench::{Config, Env};

use crate::common::*;

/// A body without touch and vision.
fn body(age: f64) -> Config {
    Config {
        age: Some(age),
        ..free(Behavior::None, Scene::Base)
    }
}

/// An infant of given z-scores of length, weight and head.
fn infant(sex: Sex, age: f64, [length, weight, head]: [f64; 3]) -> Config {
    let mut config = body(age);
    config.individual.sex = sex;
    config.individual.length_z = Some(length);
    config.individual.weight_z = Some(weight);
    config.individual.head_z = Some(head);
    config
}

fn model(config: &Config) -> Model {
    build_model(config, &embedded()).unwrap_or_else(|error| panic!("{:?}: {error}", config.individual))
}

fn grows(config: &Config) -> Result<Option<Growth>, SceneError> {
    Growth::of(config, Version::of(config.behavior), &embedded())
}

/// Checks that the z-scores of a model's MIMo are those of the configuration's infant.
#[track_caller]
fn check_scores(config: &Config) {
    let asked = Individual::of(config).expect("an individual");
    let found = BodyScores::of(&model(config), config).expect("an age with a standard");
    assert_eq!(found.len(), 1, "the standards of one sex");
    let off = [
        found[0].length - asked.length_z,
        found[0].weight - asked.weight_z,
        found[0].head - asked.head_z,
    ];
    let age = config.age;
    assert!(off.iter().all(|z| z.abs() < 1e-6), "{asked:?} at {age:?}: {off:?}");
}

#[test]
fn z_scores_are_those_that_were_asked_for() {
    for number in 0..200 {
        let mut config = body(0.12 * number as f64);
        (config.individual.random, config.individual.number) = (1.0, number);
        if number % 2 == 1 {
            config.behavior = Behavior::HandRegard;
        }
        config.proportions = if number % 3 == 2 {
            Proportions::Measured
        } else {
            Proportions::Mimo
        };
        if number % 5 == 4 {
            // between 27 and 64 weeks, and later by the WHO
            config.individual.gestation = Some(27.5 + 0.06 * number as f64);
        }
        check_scores(&config);
    }
    let mut three = infant(Sex::Girl, 7.5, [1.0, -1.0, 0.5]);
    for behavior in [Behavior::None, Behavior::HandRegard] {
        (three.mimo_version, three.behavior) = (3, behavior);
        check_scores(&three);
    }
}

/// Every combination of z-scores of an age, and why those that cannot be built cannot.
#[test]
fn bodies_from_minus_three_to_three_are_built_or_say_why() {
    let scores = [-3.0, -2.0, 0.0, 2.0, 3.0];
    let (mut built, mut refused) = (0, Vec::new());
    for age in [0.0, 0.25, 1.0, 2.0, 3.0, 6.0, 9.0, 12.0, 18.0, 24.0] {
        for sex in [Sex::Boy, Sex::Girl] {
            for (length, weight) in scores.iter().flat_map(|l| scores.map(|w| (*l, w))) {
                for head in [-3.0, 0.0, 3.0] {
                    match grows(&infant(sex, age, [length, weight, head])) {
                        Ok(_) => built += 1,
                        Err(error) => {
                            let error = error.to_string();
                            assert!(error.contains("_z` is") && error.contains("z-scores"), "{error}");
                            refused.push(error);
                        }
                    }
                }
            }
        }
    }
    println!("{built} have shapes, {} have not", refused.len());
    refused.iter().for_each(|error| println!("{error}"));
    assert!(refused.len() * 20 < built, "{} of {built}", refused.len());
}

#[test]
fn individuals_are_mirror_symmetric() {
    for behavior in [Behavior::None, Behavior::HandRegard] {
        let mut config = infant(Sex::Boy, 2.0, [-1.5, 1.0, 2.0]);
        config.behavior = behavior;
        let model = model(&config);
        let mut pairs = 0;
        for (left, name) in model.body_name.iter().enumerate() {
            let Some(rest) = name.strip_prefix("left_") else {
                continue;
            };
            let right = model.body(&format!("right_{rest}")).expect("the other side");
            let [x, y, z] = model.body_pos[left];
            assert_eq!([x, -y, z], model.body_pos[right], "{name}");
            assert!(
                (model.body_mass[left] / model.body_mass[right] - 1.0).abs() < 1e-12,
                "{name}"
            );
            let (a, b) = (model.body_geomadr[left], model.body_geomadr[right]);
            for k in 0..model.body_geomnum[left] {
                assert_eq!(model.geom_size[a + k], model.geom_size[b + k], "geom {k} of {name}");
            }
            pairs += 1;
        }
        assert!(pairs > 8, "{pairs}");
    }
}

/// With `strength: infant` the ratios to gravity are those of the age; with `strength: volume` they move with size by less than a half.
#[test]
fn strength_stays_in_proportion_to_weight() {
    for age in [0.0, 6.0, 18.0] {
        let rows = |config: Config| strength_table(&config, &embedded()).expect("a body");
        let usual = rows(infant(Sex::Girl, age, [0.0; 3]));
        for scores in [[2.0, 2.0, 2.0], [-2.0, -2.0, -2.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0]] {
            for (row, usual) in rows(infant(Sex::Girl, age, scores)).iter().zip(&usual) {
                let [volume, own] = [0, 1].map(|k| row.ratios()[k] / usual.ratios()[k]);
                assert!(
                    (0.5..1.7).contains(&volume),
                    "{} at {age}, {scores:?}: {volume}",
                    row.name
                );
                // those of the arms follow volumes, and with 18 months all follow the original body
                let calibrated = row.name.starts_with("neck") || row.name.starts_with("trunk");
                if calibrated {
                    assert!((own - 1.0).abs() < 1e-9, "{} at {age}, {scores:?}: {own}", row.name);
                }
                assert!((0.5..1.7).contains(&own), "{} at {age}, {scores:?}: {own}", row.name);
            }
        }
    }
}

#[test]
fn measurements_go_before_scores_and_impossible_ones_are_named() {
    let mut config = infant(Sex::Boy, 6.0, [1.0, 1.0, 0.0]);
    config.individual.head_z = None;
    config.measurements.head_circumference = Some(45.0);
    config.measurements.hip_breadth = Some(14.0);
    let made = model(&config);
    let scores = BodyScores::of(&made, &config).expect("an age")[0];
    assert!(
        (scores.length - 1.0).abs() < 1e-6 && (scores.weight - 1.0).abs() < 1e-6,
        "{scores:?}"
    );
    let head = BodyFigures::head_circumference(&made).expect("a MIMo");
    assert!((head - 0.45).abs() < 1e-12, "{head}");
    // a leg that long leaves no length for the trunk
    config.measurements.knee_sole_length = Some(45.0);
    let error = Env::new(config).expect_err("it is impossible").to_string();
    assert!(error.contains("`knee_sole_length` is 45.0"), "{error}");
}

#[test]
fn preterm_infants_have_the_size_of_their_weeks() {
    let mut config = infant(Sex::Boy, 0.0, [0.0; 3]);
    let mut born = |gestation: f64, age: f64| {
        (config.individual.gestation, config.age) = (Some(gestation), Some(age));
        let figures = BodyFigures::of(&model(&config)).expect("a MIMo");
        (figures.mass, 100.0 * figures.stature)
    };
    let close = |(mass, length): (f64, f64), kilograms: f64, centimetres: f64| {
        assert!(
            (mass - kilograms).abs() < 5e-4 && (length - centimetres).abs() < 5e-3,
            "{mass} kg, {length} cm"
        );
    };
    close(born(28.0, 0.0), 1.073, 37.29);
    close(born(40.0, 0.0), 3.433, 50.91);
    // twelve weeks after birth at 28 weeks
    close(born(28.0, 84.0 / 30.4375), 3.433, 50.91);
    // later the WHO's at the age from a birth at term
    let [boys, _] = GrowthStandard::at(12.0);
    close(born(28.0, 12.0 + 84.0 / 30.4375), boys.weight.m, boys.length.m);
    let mut early = infant(Sex::Girl, 0.25, [0.0; 3]);
    early.individual.gestation = Some(24.0);
    let error = Env::new(early).expect_err("no standard covers it").to_string();
    assert!(error.contains("`age` is 0.25 and `gestation` is 24"), "{error}");
}

/// Prints what an individual adds to a body.
#[test]
fn individuals_take_about_a_millisecond_to_make() {
    let time = |config: &Config| {
        let each = (0..20).map(|_| {
            let start = Instant::now();
            grows(config).expect("a body");
            start.elapsed()
        });
        each.min().expect("twenty")
    };
    let (usual, own) = (time(&body(6.0)), time(&infant(Sex::Boy, 6.0, [1.0, 1.0, 1.0])));
    println!("by the formulas {usual:.2?}, an individual {own:.2?}");
    let whole = {
        let start = Instant::now();
        model(&body(6.0));
        start.elapsed()
    };
    println!("the whole scene {whole:.2?}");
    // a generous bound for a busy machine
    assert!(own.as_secs_f64() < 0.1, "{own:?}");
}

/// With `strength: infant` and a preterm infant the ratios are those of the corrected age.
#[test]
fn strength_of_preterm_infants_is_that_of_the_corrected_age() {
    let row = |gestation: Option<f64>, age: f64| {
        let mut config = infant(Sex::Boy, age, [0.0; 3]);
        (config.individual.gestation, config.strength) = (gestation, StrengthModel::Infant);
        let rows = strength_table(&config, &embedded()).expect("a body");
        rows.iter()
            .find(|row| row.name == "neck, forward")
            .expect("a neck")
            .ratios()[1]
    };
    let late = 12.0 * 7.0 / 30.4375;
    assert!((row(Some(28.0), 3.0 + late) - row(None, 3.0)).abs() < 1e-9);
    assert!((row(Some(28.0), 1.0) - row(None, 0.0)).abs() < 1e-9);
}

/// Returns how deep parts of MIMo are in each other at rest, m, by their geoms.
fn overlaps(model: &Model) -> BTreeMap<[usize; 2], f64> {
    let model = Arc::new(model.clone());
    let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
    let mut state = engine.new_state();
    state.qpos = held_posture(&model);
    engine.forward(&mut state).expect("a pose");
    let hip = model.body("hip").expect("a MIMo");
    let own = |geom: usize| model.in_subtree(model.geom_bodyid[geom], hip);
    let inside = state.contact.iter().filter(|c| c.geom.iter().all(|&geom| own(geom)));
    inside.map(|c| (c.geom, -c.dist)).collect()
}

/// Parts of infants whose weight is far from their length would run into each other, and no others.
#[test]
fn parts_of_infants_do_not_run_into_each_other() {
    let depth = |median: &Model, config: &Config| {
        let (usual, found) = (overlaps(median), overlaps(&model(config)));
        let more = found
            .into_iter()
            .map(|(geoms, depth)| depth - usual.get(&geoms).copied().unwrap_or(0.0));
        more.fold(0.0, f64::max)
    };
    for behavior in [Behavior::None, Behavior::HandRegard] {
        for age in [0.0, 1.0, 6.0, 18.0] {
            let made = |scores| Config {
                behavior,
                ..infant(Sex::Boy, age, scores)
            };
            let median = model(&made([0.0; 3]));
            for (length, weight) in [
                (-3.0, 0.0),
                (0.0, 3.0),
                (-1.5, 1.5),
                (1.5, -1.5),
                (3.0, 3.0),
                (3.0, 0.0),
                (-3.0, -3.0),
            ] {
                for head in [-3.0, 3.0] {
                    let more = depth(&median, &made([length, weight, head]));
                    assert!(
                        more < 0.008,
                        "{behavior} at {age}, {length}, {weight}, {head}: {:.1} mm",
                        1e3 * more
                    );
                }
            }
            let result = build_model(&made([-3.0, 3.0, 0.0]), &embedded());
            match result {
                Ok(_) => println!("{behavior} at {age}: the shortest may be the heaviest"),
                Err(error) => {
                    let error = error.to_string();
                    println!("{error}");
                    assert!(
                        error.contains("`length_z` is -3.0") && error.contains("in each other at rest"),
                        "{error}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_newborn_who_is_heavy_for_his_length_rests_as_others_do() {
    let speed = |scores| {
        let mut env = env(infant(Sex::Boy, 0.0, scores));
        env.reset(Some(1)).expect("no divergence");
        let still = vec![0.0; env.action_space().len()];
        repeat(&mut env, &still, 300);
        max_abs(&env.state().qvel)
    };
    let (median, heavy) = (speed([0.0; 3]), speed([0.0, 3.0, 0.0]));
    println!("fastest joint: {median:.4}, {heavy:.4} rad/s");
    assert!(heavy < 3.0 * median + 0.05, "{heavy}, {median}");
}
