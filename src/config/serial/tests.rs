//! Tests of configurations in the formats of serde.

use super::*;
use crate::config::{Behavior, Compat, EngineKind, Scene, TouchFunction};

fn read(json: &str) -> Result<Config, String> {
    serde_json::from_str(json).map_err(|e| e.to_string())
}

#[test]
fn a_configuration_comes_back_from_json() {
    let mut config = Config {
        save_dir: "a \"b\" \\ \u{301}é\u{2028}".to_string(),
        behavior: Behavior::HandRegard,
        scene: Scene::Cubes,
        engine: EngineKind::Rapier,
        seed: u64::MAX,
        touch_scale: 0.1 + 0.2,
        touch_function: TouchFunction::ForceVector,
        ..Config::default()
    };
    config.lock.head = true;
    let json = serde_json::to_string(&config).expect("JSON");
    assert_eq!(read(&json), Ok(config));
    assert_eq!(read("{}"), Ok(Config::default()));
    assert_eq!(read(r#"{"touch_scale": 2}"#).map(|c| c.touch_scale), Ok(2.0));
}

#[test]
fn a_configuration_comes_back_from_a_binary_format() {
    let mut config = Config {
        age: Some(4.5),
        seed: u64::MAX,
        ..Config::default()
    };
    config.measurements.foot_length = Some(7.25);
    config.delays.vision = Some(3.0);
    config.eyes.foveation_left = Some(2.0);
    config.eyes.width_left = Some(200);
    for config in [Config::default(), config] {
        let bytes = postcard::to_stdvec(&config).expect("bytes");
        assert_eq!(postcard::from_bytes(&bytes), Ok(config));
    }
    let bytes = postcard::to_stdvec(&[("age", Some(99.0))]).expect("bytes");
    assert!(postcard::from_bytes::<Config>(&bytes).is_err());
}

#[test]
fn keys_are_those_of_the_file_in_its_order() {
    let json = serde_json::to_string(&Config::default()).expect("JSON");
    let places: Vec<_> = KEYS.iter().map(|k| json.find(&format!("\"{}\":", k.name))).collect();
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}");
}

#[test]
fn what_a_file_may_not_hold_is_refused_by_its_key() {
    for (json, parts) in [
        (
            r#"{"behaviour": 1}"#,
            &["unknown key `behaviour`", "did you mean `behavior`?"][..],
        ),
        (r#"{"seed": 1, "seed": 2}"#, &["duplicate field `seed`"]),
        (r#"{"seed": -1}"#, &["`seed` is -1, expected a whole number from 0"]),
        (r#"{"seed": 1.5}"#, &["`seed` is 1.5, expected a whole number"]),
        (r#"{"seed": "1"}"#, &["`seed` is '1' in quotes"]),
        (r#"{"frame_skip": 0}"#, &["`frame_skip` is 0"]),
        (r#"{"frame_skip": true}"#, &["`frame_skip` is true"]),
        (r#"{"touch_scale": 0.001}"#, &["`touch_scale` is 0.001, expected 0 or"]),
        (r#"{"touch_scale": -1}"#, &["`touch_scale` is -1"]),
        (r#"{"act_eyes": 1}"#, &["`act_eyes` is 1, expected true or false"]),
        (r#"{"act_eyes": null}"#, &["`act_eyes` needs a value"]),
        (r#"{"act_eyes": [true]}"#, &["`act_eyes` is a list"]),
        (r#"{"scene": {"name": "crib"}}"#, &["`scene` is a map"]),
        (r#"{"scene": "crip"}"#, &["`scene` is crip", "did you mean `crib`?"]),
        (r#"{"save_dir": ""}"#, &["`save_dir`"]),
        (r#"{"save_dir": "a\u0000b"}"#, &["`save_dir`", "no control characters"]),
        (r#"{"save_dir": 3}"#, &["`save_dir` is 3"]),
        (
            r#"{"touch_function": "normal_force"}"#,
            &["`touch_function`", "compat: reference"],
        ),
        (r#"["behavior"]"#, &["a flat map of configuration keys"]),
    ] {
        let error = read(json).expect_err(json);
        for part in parts {
            assert!(error.contains(part), "{json}: {error}: no {part:?}");
        }
    }
}

#[test]
fn choices_are_their_names() {
    for compat in Compat::ALL {
        let json = serde_json::to_string(compat).expect("JSON");
        assert_eq!(json, format!("\"{compat}\""));
        assert_eq!(serde_json::from_str::<Compat>(&json).ok(), Some(*compat));
    }
    let error = serde_json::from_str::<Compat>("\"apy\"").expect_err("no such name");
    assert!(error.to_string().contains("unknown variant `apy`"), "{error}");
}
