//! Motor milestones: with `strength: infant` and `springs: weight`, MIMo reaches those of infants of his age.

use babybench::config::{
    ActuationModel, Behavior, Compat, ConfigReader, Proportions, Scene, SpringModel, StrengthModel,
};
use babybench::mimo::{BodyFigures, Version, embedded, strength_table};
use babybench::{Config, Env};

use crate::common::milestones::{infant, leg_support, prone_head_lift, pull_to_sit, supported_sitting, volume};
use crate::common::*;

/// Head lag falls from birth to four months, when half of infants have none (Denver II).
#[test]
fn heads_lag_in_a_pull_to_sit_as_those_of_infants() {
    for version in [Version::V1, Version::V2] {
        for (age, allowed) in [
            (0.0, 45.0..91.0),
            (1.0, 45.0..91.0),
            (2.0, 20.0..40.0),
            (3.5, -5.0..15.0),
            (4.0, -5.0..8.0),
            (9.0, -5.0..8.0),
            (24.0, -5.0..8.0),
        ] {
            let [lag, _] = pull_to_sit(&infant(version, age));
            println!("{} at {age} months: {lag:.1} degrees", version.name());
            assert!(
                allowed.contains(&lag),
                "{} at {age} months: {lag} degrees",
                version.name()
            );
        }
    }
}

/// Muscles and servos have the same limits of torque.
#[test]
fn muscles_and_servos_of_a_newborn_let_his_head_lag_more_than_those_of_six_months() {
    for actuation_model in [ActuationModel::Muscle, ActuationModel::Positional] {
        let lag = |age| {
            pull_to_sit(&Config {
                actuation_model,
                ..infant(Version::V1, age)
            })[0]
        };
        let (newborn, later) = (lag(0.0), lag(6.0));
        println!("{actuation_model}: {newborn:.1}, {later:.1} degrees");
        assert!(newborn > later + 15.0, "{actuation_model}: {newborn}, {later} degrees");
    }
}

#[test]
fn ratios_do_not_fall_with_age_and_reach_those_of_the_original_body() {
    let of = |behavior, age| {
        let config = Config {
            age: Some(age),
            ..free(behavior, Scene::Base)
        };
        strength_table(&config, &embedded()).expect("a body")
    };
    for behavior in [Behavior::None, Behavior::HandRegard] {
        let ages = [0.0, 0.5, 1.0, 2.0, 3.0, 3.7, 4.0, 6.0, 9.0, 12.0, 15.0, 18.0, 24.0];
        let tables: Vec<_> = ages.into_iter().map(|age| of(behavior, age)).collect();
        for pair in tables.windows(2) {
            for (young, old) in pair[0].iter().zip(&pair[1]) {
                if young.name.starts_with("neck") || young.name.starts_with("trunk") {
                    let [a, b] = [young, old].map(|row| row.ratios()[1]);
                    assert!(a <= b + 1e-9, "{}: {a} before {b}", young.name);
                }
            }
        }
        let newborn = &tables[0];
        let forward = newborn.iter().find(|row| row.name == "neck, forward").expect("a neck");
        assert!(
            (forward.ratios()[1] - 0.5).abs() < 1e-12 && forward.ratios()[0] > 2.0,
            "{forward:?}"
        );
    }
}

#[test]
fn proportions_that_were_measured_keep_the_length_of_the_body() {
    let figures = |age, proportions| {
        let config = Config {
            proportions,
            age: Some(age),
            ..free(Behavior::None, Scene::Base)
        };
        let made = blueprint(config);
        let figures = BodyFigures::of(made.model()).expect("a MIMo");
        let sitting = BodyFigures::crown_rump(made.model()).expect("a MIMo");
        (figures.stature, sitting / figures.stature)
    };
    for (age, share) in [(0.0, 0.692), (24.0, 0.604)] {
        let (length, measured) = figures(age, Proportions::Measured);
        let (before, formula) = figures(age, Proportions::Mimo);
        println!("{age} months: {formula:.3}, measured {measured:.3}");
        assert!((measured - share).abs() < 0.01, "{age} months: {measured}");
        assert!(
            (length - before).abs() < 1e-3,
            "{age} months: {length} m, not {before} m"
        );
    }
}

#[test]
fn factors_change_one_group_of_joints() {
    let gears = |text: &str| {
        let config = Config {
            strength: StrengthModel::Infant,
            age: Some(3.0),
            ..free(Behavior::HandRegard, Scene::Base)
        };
        let config = ConfigReader::over(config).read_text(text, "test").expect("allowed");
        let made = blueprint(config);
        let model = made.model();
        (model.actuator_name.clone(), model.actuator_gear.clone())
    };
    let (names, before) = gears("{}");
    for (key, joint) in [
        ("neck", "head_"),
        ("trunk", "hip_lean"),
        ("shoulder", "shoulder_"),
        ("elbow", "elbow"),
        ("wrist", "wrist_"),
        ("grip", "ff_"),
        ("hip", "hip_flex"),
        ("knee", "knee"),
        ("ankle", "foot_"),
    ] {
        let (_, after) = gears(&format!("strength_{key}: 0.5"));
        let mut halved = 0;
        for ((name, was), is) in names.iter().zip(&before).zip(&after) {
            if was != is {
                assert!((is / was - 0.5).abs() < 1e-12, "{key}: {name} was {was}, is {is}");
                halved += usize::from(name.contains(joint));
            }
        }
        assert!(halved > 0, "{key} changes no {joint}");
    }
}

#[test]
fn springs_by_weight_leave_the_original_body_as_it_is_and_loosen_that_of_a_newborn() {
    let stiffness = |age, springs| {
        let config = Config {
            springs,
            age: Some(age),
            ..free(Behavior::None, Scene::Base)
        };
        let made = blueprint(config);
        let model = made.model();
        let joint = model.joint("robot:head_tilt").expect("a neck");
        (model.jnt_stiffness[joint], model.dof_damping[model.jnt_dofadr[joint]])
    };
    let fixed = stiffness(0.0, SpringModel::Fixed);
    let weight = stiffness(0.0, SpringModel::Weight);
    assert!(weight.0 < 0.4 * fixed.0, "{weight:?}, {fixed:?}");
    assert!((weight.0 / fixed.0 - weight.1 / fixed.1).abs() < 1e-12);
    let grown = stiffness(18.0, SpringModel::Weight);
    assert!((grown.0 / fixed.0 - 1.0).abs() < 0.05, "{grown:?}");
}

#[test]
fn the_strength_of_infants_needs_an_age_and_is_not_in_the_reference() {
    let error = |config: Config| Env::new(config).expect_err("refused").to_string();
    let no_age = Config {
        strength: StrengthModel::Infant,
        ..free(Behavior::None, Scene::Base)
    };
    assert!(error(no_age.clone()).contains("`age` is none"));
    let reference = Config {
        age: Some(3.0),
        compat: Compat::Reference,
        touch_active: false,
        ..no_age
    };
    assert!(error(reference).contains("`strength` is infant"));
}

/// The head of a newborn leaves the floor, the trunk is held from six months on (WHO 2006: 6.0 +- 1.1), and the legs carry the body from
/// nine on (WHO 2006: stands with assistance at 7.6 +- 1.4).
#[test]
fn an_infant_lifts_his_head_sits_and_stands_at_his_age() {
    let [newborn, two, four, six, nine] = [0.0, 2.0, 4.0, 6.0, 9.0].map(|age| {
        let config = infant(Version::V1, age);
        [
            prone_head_lift(&config),
            supported_sitting(&config),
            leg_support(&config),
        ]
    });
    println!("{newborn:?}, {two:?}, {four:?}, {six:?}, {nine:?}");
    assert!(newborn[0] >= 5.0 && two[0] >= 30.0 && four[0] >= 40.0 && six[0] >= 50.0);
    assert!(newborn[1] < 8.0 && two[1] < 8.0 && four[1] < 15.0);
    assert!((15.0..25.0).contains(&six[1]) && (15.0..25.0).contains(&nine[1]));
    assert!((0.3..0.5).contains(&newborn[2]) && nine[2] >= 1.0);
    // by volume it is the other way round
    let [young, old] = [0.0, 9.0].map(|age| supported_sitting(&volume(Version::V1, age)));
    assert!(young > old + 10.0, "{young}, {old}");
}
