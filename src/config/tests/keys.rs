//! Tests of the table of keys.

use super::*;

/// Values of a key, as they stand in a file.
struct Values {
    good: Vec<String>,
    wrong_type: &'static [&'static str],
    out_of_range: Vec<String>,
}

/// Returns values that a key accepts and values that it refuses.
fn values(kind: KeyKind) -> Values {
    let (good, wrong_type, out_of_range): (Vec<String>, &'static [&'static str], Vec<String>) = match kind {
        KeyKind::Bool => {
            let words = [
                "True", "TRUE", "true", "yes", "Yes", "on", "ON", "False", "FALSE", "no", "NO", "off",
            ];
            (
                words.map(String::from).into(),
                &["1", "y", "'True'", "tru", "[true]"],
                vec![],
            )
        }
        KeyKind::Whole { min, max } => (
            // other ways of writing numbers, where these are allowed
            [
                (min, min.to_string()),
                (max, max.to_string()),
                (1_000, "1_000".to_string()),
                (1, "+1".to_string()),
            ]
            .into_iter()
            .filter(|(value, _)| (min..=max).contains(value))
            .map(|(_, text)| text)
            .collect(),
            &["1.0", "010", "1e3", "'1'", "many", "true", "0x10", "1__", "{a: 1}"][..6],
            vec!["-1".to_string(), (i128::from(max) + 1).to_string(), "9".repeat(99)]
                .into_iter()
                .chain(min.checked_sub(1).map(|below| below.to_string()))
                .collect(),
        ),
        KeyKind::ZeroOrAtLeast(_) => (
            ["0", "0.0", "-0.0", "0.01", "1.", ".5", "2", "1e3", "1.5e+3"]
                .map(String::from)
                .into(),
            &["one", "true", "'1'", "1.2.3", "1e", "inf", "nan", "_1.", "+"],
            ["-1", "0.001", "1e999", ".inf", "-.INF", ".nan"]
                .map(String::from)
                .into(),
        ),
        KeyKind::Number { min, max } => (
            vec![
                format!("{min:?}"),
                format!("{max:?}"),
                "1".to_string(),
                "1e0".to_string(),
            ],
            &["one", "true", "'1'", "none"],
            ["-1", "2000000", ".nan", ".inf"].map(String::from).into(),
        ),
        KeyKind::NoneOr { min, max } => (
            ["none", "null", "~", "'none'", "1", "1.5", "1e1", "24"]
                .into_iter()
                .filter(|text| text.parse().map_or(true, |number: f64| (min..=max).contains(&number)))
                .map(String::from)
                .collect(),
            &["one", "true", "'1'", "None"],
            [(min - 1.0).to_string(), "2000000".to_string(), ".nan".to_string()].into(),
        ),
        KeyKind::NoneOrWhole { min, max } => (
            ["none", "null", "~", "'none'"]
                .map(String::from)
                .into_iter()
                .chain([min, max].map(|n| n.to_string()))
                .collect(),
            &["one", "true", "'1'", "None", "1.5"],
            ["-1".to_string(), (max + 1).to_string()].into(),
        ),
        KeyKind::Choice(names) => {
            // Values that depend on other keys have tests of their own.
            let legal = |name: &&&str| !["normal_force", "reference"].contains(*name);
            let good = names
                .iter()
                .filter(legal)
                .flat_map(|name| [name.to_string(), format!("'{name}'")]);
            let bad = ["nonsense", "1", "true", "''"].map(String::from).to_vec();
            (good.collect(), &["[none]"], bad)
        }
        KeyKind::ChoiceOrFile { names, ending } => {
            let path = format!("rooms/mine{ending}");
            let good = names.iter().map(|name| name.to_string());
            let bad = ["nonsense", "1", "true", "''", "rooms/mine", "\"a\\nb.xml\""];
            (
                good.chain([format!("'{path}'"), path]).collect(),
                &["[none]"],
                bad.map(String::from).to_vec(),
            )
        }
        KeyKind::NoneOrList(names) => {
            // the last name stands for a choice of the others
            let names = &names[..names.len() - 1];
            let good = names.iter().map(|name| format!("[{name}]"));
            let good = good.chain([
                "none".into(),
                "~".into(),
                names[0].into(),
                format!("[{}]", names.join(", ")),
            ]);
            (
                good.collect(),
                &["[[moro]]", "[{moro: 1}]"],
                [
                    "[]",
                    "[nonsense]",
                    "nonsense",
                    "1",
                    "[1]",
                    "['']",
                    "[none]",
                    "[moro, moro]",
                ]
                .map(String::from)
                .into(),
            )
        }
        KeyKind::NoneOrAges { max } => (
            ["none", "~", "{0: 1, 500000: 6}", "\n  0: 3.5\n  10: 1", "'0: 2'"]
                .map(String::from)
                .into(),
            &["one", "5", "true", "[1]"],
            ["{}", "{1: 1}", "{0: 1, 0: 2}", "{0: a}", "'0: 1, 3'"]
                .map(String::from)
                .into_iter()
                .chain([format!("{{0: {}}}", max + 1.0)])
                .collect(),
        ),
        KeyKind::List(names) => {
            let all = format!("[{}]", names.join(", "));
            let good = names
                .iter()
                .map(|name| format!("[{name}]"))
                .chain([all, format!("\n- '{}'", names[0])]);
            let bad = ["[]", "[nonsense]", "[1]", "['']"].map(String::from).into_iter();
            let twice = format!("[{0}, {0}]", names[0]);
            (
                good.collect(),
                &["rgb", "1", "''", "[[rgb]]", "[{rgb: 1}]"],
                bad.chain([twice]).collect(),
            )
        }
        KeyKind::Text => {
            let good = [
                "out",
                "'2025'",
                "\"true\"",
                "a/b c",
                "C:\\new",
                "~/x",
                "\"\\u4e16 \\\"\"",
                ">\n a\n b",
            ];
            let bad = ["''", "\"a\\0b\"", "\"a\\nb\""].map(String::from).to_vec();
            (good.map(String::from).into(), &["2025", "true", "1.5", "off"], bad)
        }
        KeyKind::Document => {
            let good = ["''", "<geom/>", "\"<a/>\\n\\t<b/>\"", "|\n <a>\n </a>"];
            let bad = vec!["\"a\\0b\"".to_string()];
            (good.map(String::from).into(), &["2025", "true", "1.5", "off"], bad)
        }
    };
    Values {
        good,
        wrong_type,
        out_of_range,
    }
}

/// Returns the error for a value of a key, which names the key, its line and what is allowed.
fn refusal(key: &Key, value: &str) -> ConfigError {
    let name = key.name;
    match read(&format!("\n{name}: {value}\n")) {
        Ok(_) => panic!("{name}: {value} was accepted"),
        Err(error) => {
            assert_eq!(
                (error.key(), error.position().map(|(line, _)| line)),
                (Some(name), Some(2)),
                "{error}"
            );
            let expected = key.kind.expected();
            assert!(error.to_string().contains(&expected), "{error} does not say {expected}");
            error
        }
    }
}

/// Checks every key of the table: other values load, are the only change, and survive `to_yaml`; a wrong type, null, a
/// list and values past the range are errors naming key, value and line.
#[test]
fn every_key_takes_what_it_says_and_nothing_else() {
    for key in Config::keys() {
        let name = key.name;
        let Values {
            good,
            wrong_type,
            out_of_range,
        } = values(key.kind);
        for value in good {
            // A block scalar ends with a line break, which no folder name may have, unless stripped.
            let value = value.replace(">\n", ">-\n");
            let beside = match (key.section, name) {
                ("Growth", "age") | ("Pain", "pain_active") => "",
                ("Growth", name) if name.starts_with("strength_") && name != "strength_age" => {
                    "age: 3\nstrength: infant\n"
                }
                ("Growth", "age_schedule") => "touch_active: false\n",
                ("Growth", "age_grid") => "touch_active: false\nage_schedule: '0: 1, 9: 3'\n",
                ("Growth", "length_z" | "weight_z" | "head_z" | "gestation") => "age: 3\nsex: boy\n",
                ("Growth", "body_seed" | "body_number") => "age: 3\nbody_random: 1\n",
                // the other keys of growth change MIMo at an age
                ("Growth", _) => "age: 3\n",
                ("Pain", _) => "pain_active: true\n",
                (_, "noise_motor_color") => "noise_motor: 0.1\n",
                ("Reflexes", name) if name != "reflexes" => "reflexes: by_age\n",
                // only rooms of one's own have a second infant
                (_, "learner" | "other_age") => "scene: room.xml\n",
                (_, "delay_by_age") => "age: 3\n",
                // 10,000 steps are too many
                ("Delays", _) if name != "delay_unit" => "delay_unit: ms\nframe_skip: 2\nvision_resolution: 16\n",
                _ => "",
            };
            let config = read(&format!("\n{beside}{name}: {value}\n"))
                .unwrap_or_else(|error| panic!("{name}: {value}: {error}"));
            let set = |other: &&Key| other.name != name && !beside.contains(&format!("{}:", other.name));
            // tasks have defaults of their own
            let defaults = Config::of(config.behavior);
            for other in Config::keys().iter().filter(set) {
                assert_eq!(
                    other.value(&config),
                    other.value(&defaults),
                    "{name} changes {}",
                    other.name
                );
            }
            assert_eq!(read(&config.to_yaml()).ok(), Some(config), "{name}: {value}");
        }
        let refused = |value: &str| refusal(key, value);
        for value in wrong_type {
            assert!(
                matches!(refused(value), ConfigError::WrongType { .. }),
                "{name}: {value}"
            );
        }
        for value in &out_of_range {
            assert!(
                matches!(refused(value), ConfigError::OutOfRange { .. }),
                "{name}: {value}"
            );
        }
        for value in ["", "~", "null", "Null", "NULL"] {
            if key.kind.allows_none() {
                assert_eq!(read(&format!("{name}: {value}\n")).ok(), Some(Config::default()));
                continue;
            }
            assert!(
                matches!(refused(value), ConfigError::MissingValue { .. }),
                "{name}: {value}"
            );
        }
    }
}
