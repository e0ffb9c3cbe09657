//! A [`Config`] as a flat map in the formats of serde, through the table of keys.

use std::fmt;

use serde::de::{DeserializeSeed, Error as _, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeMap as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::ages;
use super::error::{self, Location};
use super::kinds::{KeyKind, KeyValue, ValueFault};
use super::table::KEYS;
use super::table::Key;
use super::{Config, ConfigError, yaml};
use crate::text::nearest;

/// Name in errors of a configuration that is not a file.
const NAME: &str = "configuration";

impl Serialize for KeyValue {
    /// Serializes a boolean, a number, a text or a list of texts.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::None => serializer.serialize_none(),
            Self::Bool(on) => serializer.serialize_bool(*on),
            Self::Whole(number) => serializer.serialize_u64(*number),
            Self::Number(number) => serializer.serialize_f64(*number),
            Self::Choice(name) => serializer.serialize_str(name),
            Self::List(names) => names.serialize(serializer),
            Self::Text(text) => serializer.serialize_str(text),
        }
    }
}

impl Serialize for Config {
    /// Serializes every key with its value, in the order of [`Config::keys`].
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(KEYS.len()))?;
        for key in KEYS {
            match (key.kind, key.value(self)) {
                // formats that do not describe themselves write whether there is a number
                (KeyKind::NoneOr { .. }, KeyValue::Number(number)) => map.serialize_entry(key.name, &Some(number))?,
                (KeyKind::NoneOrWhole { .. }, KeyValue::Whole(number)) => {
                    map.serialize_entry(key.name, &Some(number))?;
                }
                (KeyKind::NoneOrList(_), KeyValue::List(names)) => map.serialize_entry(key.name, &Some(names))?,
                (KeyKind::NoneOrAges { .. }, KeyValue::Text(ages)) => map.serialize_entry(key.name, &Some(ages))?,
                (_, value) => map.serialize_entry(key.name, &value)?,
            }
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Config {
    /// Deserializes a flat map and validates it. Missing keys have their default; unknown keys, keys given twice and
    /// values that are not allowed are errors that name the key.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ConfigVisitor)
    }
}

fn place() -> Location {
    Location {
        file: NAME.to_string(),
        position: None,
    }
}

struct ConfigVisitor;

impl<'de> Visitor<'de> for ConfigVisitor {
    type Value = Config;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a flat map of configuration keys")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Config, A::Error> {
        let mut config = Config::default();
        let mut seen = vec![false; KEYS.len()];
        let mut by_age = false; // whether `age` is a schedule
        while let Some(index) = map.next_key_seed(KeySeed)? {
            let key = &KEYS[index];
            if std::mem::replace(&mut seen[index], true) {
                return Err(A::Error::duplicate_field(key.name));
            }
            let value = map.next_value_seed(ValueSeed { key })?;
            let own = ages::of_value(index, &value);
            let key = &KEYS[own];
            if own != index {
                by_age = true;
            } else if by_age && own == ages::schedule_index() && value == KeyValue::None {
                continue; // of a map of all keys, in which `age` has become a schedule
            }
            if by_age && !config.age_schedule.is_empty() && own == ages::schedule_index() {
                return Err(A::Error::duplicate_field(key.name));
            }
            if !key.assign(&mut config, &value) {
                let refusal = yaml::refusal(key, ValueFault::WrongType, value.to_yaml(), place());
                return Err(A::Error::custom(refusal));
            }
        }
        seen[ages::schedule_index()] |= by_age;
        if config.behavior != Config::default().behavior {
            // only keys that are missing take the default of the task; a map that holds all keys comes back as it was written
            config.take_defaults(|key| seen[key]);
        }
        config.validate().map_err(A::Error::custom)?;
        Ok(config)
    }
}

/// Reads a key as an index into [`KEYS`].
struct KeySeed;

impl<'de> DeserializeSeed<'de> for KeySeed {
    type Value = usize;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_identifier(self)
        } else {
            deserializer.deserialize_str(self) // binary formats have no other names
        }
    }
}

impl Visitor<'_> for KeySeed {
    type Value = usize;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a configuration key")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<usize, E> {
        KEYS.iter().position(|key| key.name == name).ok_or_else(|| {
            E::custom(ConfigError::UnknownKey {
                location: place(),
                key: error::shown(name),
                nearest: nearest(name, KEYS.iter().map(|key| key.name)),
            })
        })
    }
}

/// Reads the value of a key.
struct ValueSeed {
    key: &'static Key,
}

impl ValueSeed {
    fn refusal<E: serde::de::Error>(&self, misfit: ValueFault, written: String) -> E {
        E::custom(yaml::refusal(self.key, misfit, written, place()))
    }

    /// Checks a value against the table.
    fn checked<E: serde::de::Error>(&self, value: KeyValue) -> Result<KeyValue, E> {
        match self.key.kind.check(&value) {
            Ok(()) => Ok(value),
            Err(misfit) => Err(self.refusal(misfit, value.to_yaml())),
        }
    }
}

impl<'de> DeserializeSeed<'de> for ValueSeed {
    type Value = KeyValue;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<KeyValue, D::Error> {
        // such formats know the type of what they hold, and a wrong one gets an error in our words
        if deserializer.is_human_readable() {
            return deserializer.deserialize_any(self);
        }
        // binary formats need the type of the value
        match self.key.kind {
            KeyKind::Bool => deserializer.deserialize_bool(self),
            KeyKind::Whole { .. } => deserializer.deserialize_u64(self),
            KeyKind::ZeroOrAtLeast(_) | KeyKind::Number { .. } => deserializer.deserialize_f64(self),
            KeyKind::NoneOr { .. }
            | KeyKind::NoneOrWhole { .. }
            | KeyKind::NoneOrList(_)
            | KeyKind::NoneOrAges { .. } => deserializer.deserialize_option(self),
            KeyKind::Choice(_) | KeyKind::ChoiceOrFile { .. } | KeyKind::Text | KeyKind::Document => {
                deserializer.deserialize_str(self)
            }
            KeyKind::List(_) => deserializer.deserialize_seq(self),
        }
    }
}

impl<'de> Visitor<'de> for ValueSeed {
    type Value = KeyValue;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} for `{}`", self.key.kind.expected(), self.key.name)
    }

    fn visit_bool<E: serde::de::Error>(self, on: bool) -> Result<KeyValue, E> {
        self.checked(KeyValue::Bool(on))
    }

    fn visit_u64<E: serde::de::Error>(self, number: u64) -> Result<KeyValue, E> {
        self.checked(match self.key.kind {
            KeyKind::ZeroOrAtLeast(_) | KeyKind::Number { .. } | KeyKind::NoneOr { .. } => {
                // JSON writes 2.0 as 2
                KeyValue::Number(number as f64)
            }
            _ => KeyValue::Whole(number),
        })
    }

    fn visit_i64<E: serde::de::Error>(self, number: i64) -> Result<KeyValue, E> {
        match u64::try_from(number) {
            Ok(number) => self.visit_u64(number),
            Err(_) if matches!(self.key.kind, KeyKind::Whole { .. } | KeyKind::NoneOrWhole { .. }) => {
                Err(self.refusal(ValueFault::OutOfRange { nearest: None }, number.to_string()))
            }
            // a negative number, which the range of the key judges
            Err(_) => self.visit_f64(number as f64),
        }
    }

    fn visit_f64<E: serde::de::Error>(self, number: f64) -> Result<KeyValue, E> {
        self.checked(KeyValue::Number(number + 0.0)) // -0 becomes 0
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<KeyValue, E> {
        match self.key.kind {
            kind if kind.allows_none() && text == KeyValue::None.to_yaml() => Ok(KeyValue::None),
            KeyKind::NoneOrList(_)
            | KeyKind::NoneOrAges { .. }
            | KeyKind::Choice(_)
            | KeyKind::ChoiceOrFile { .. }
            | KeyKind::Text
            | KeyKind::Document => match self.key.kind.parse(text, false) {
                Ok(value) => Ok(value),
                Err(misfit) => Err(self.refusal(misfit, error::shown(text))),
            },
            _ => Err(self.refusal(ValueFault::WrongType, format!("'{}' in quotes", error::shown(text)))),
        }
    }

    fn visit_unit<E: serde::de::Error>(self) -> Result<KeyValue, E> {
        if self.key.kind.allows_none() {
            return Ok(KeyValue::None);
        }
        Err(self.refusal(ValueFault::Missing, "null".to_string()))
    }

    fn visit_none<E: serde::de::Error>(self) -> Result<KeyValue, E> {
        self.visit_unit()
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<KeyValue, D::Error> {
        // binary formats store whole numbers and others in different ways
        match self.key.kind {
            KeyKind::NoneOrWhole { .. } => deserializer.deserialize_u64(self),
            KeyKind::NoneOrList(_) => deserializer.deserialize_seq(self),
            KeyKind::NoneOrAges { .. } => deserializer.deserialize_str(self),
            _ => deserializer.deserialize_f64(self),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<KeyValue, A::Error> {
        if !matches!(self.key.kind, KeyKind::List(_) | KeyKind::NoneOrList(_)) {
            return Err(self.refusal(ValueFault::WrongType, "a list".to_string()));
        }
        let mut names = Vec::new();
        while let Some(name) = list.next_element::<String>()? {
            if let Err(misfit) = self.key.kind.parse_item(&name, &mut names) {
                return Err(self.refusal(misfit, error::shown(&name)));
            }
        }
        self.checked(KeyValue::List(names))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<KeyValue, A::Error> {
        if ages::takes_ages(self.key) {
            let mut text = String::new();
            while let Some((Scalar(steps), Scalar(age))) = map.next_entry()? {
                text += &format!("{steps}:{age},");
                if text.len() > ages::MAX_TEXT {
                    break;
                }
            }
            let seed = Self { key: ages::schedule() };
            return seed.visit_str(text.trim_end_matches(','));
        }
        Err(self.refusal(ValueFault::WrongType, "a map".to_string()))
    }
}

/// A number, or text that may be one: formats differ in the types of map keys.
struct Scalar(String);

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScalarVisitor)
    }
}

struct ScalarVisitor;

impl Visitor<'_> for ScalarVisitor {
    type Value = Scalar;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_u64<E: serde::de::Error>(self, number: u64) -> Result<Scalar, E> {
        Ok(Scalar(number.to_string()))
    }

    fn visit_i64<E: serde::de::Error>(self, number: i64) -> Result<Scalar, E> {
        Ok(Scalar(number.to_string()))
    }

    fn visit_f64<E: serde::de::Error>(self, number: f64) -> Result<Scalar, E> {
        Ok(Scalar(number.to_string()))
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Scalar, E> {
        Ok(Scalar(text.to_string()))
    }
}

#[cfg(test)]
mod tests;
