//! Finds the measurements that make a body impossible.

use super::error::GrowthError;
use crate::config::{Config, Key, KeyValue};

/// Returns the error of an impossible body. It names each measurement whose removal makes the body `work`, or all given measurements if there is
/// none.
pub(crate) fn blame(config: &Config, age: f64, reason: String, works: impl Fn(&Config) -> bool) -> GrowthError {
    let given: Vec<&Key> = measurements()
        .filter(|key| key.value(config) != KeyValue::None)
        .collect();
    let alone = |key: &&&Key| {
        let mut other = config.clone();
        key.assign(&mut other, &KeyValue::None) && works(&other)
    };
    let mut guilty: Vec<&Key> = given.iter().filter(alone).copied().collect();
    if guilty.is_empty() {
        // no single one makes the difference: together they do
        guilty = given;
    }
    let named = |key: &&Key| format!("`{}` is {}", key.name, key.value(config).to_yaml());
    let keys: Vec<String> = guilty.iter().map(named).collect();
    let keys = match &keys[..] {
        [] if config.individual.random > 0.0 => format!("`body_number` is {}", config.individual.number),
        [] => format!("`age` is {age:?}"),
        _ => keys.join(", "),
    };
    GrowthError::Measurements { keys, age, reason }
}

/// Lists the keys of measurements and of z-scores.
fn measurements() -> impl Iterator<Item = &'static Key> {
    let growth = Key::named("age").map(|key| key.section);
    let lengths = ["circumference", "length", "breadth", "diameter", "_z"];
    let keys = Config::keys().iter();
    keys.filter(move |key| Some(key.section) == growth && lengths.iter().any(|length| key.name.ends_with(length)))
}
