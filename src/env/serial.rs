//! The info of an environment, in the formats of serde.

use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::sync::Arc;

use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::fields::{InfoSource, InfoValue};
use super::{BehaviorInfo, Info, InfoDetails};

impl Serialize for Info {
    /// Serializes the keys of the reference, in its order; the details are a separate value
    /// ([`Info::details`], [`InfoWithDetails`]).
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        InfoWithDetails {
            info: self,
            details: None,
        }
        .serialize(serializer)
    }
}

#[cfg(feature = "eval")]
impl Info {
    /// Returns one line of JSON with the keys of the reference, as Python's `json.dumps` separates them.
    ///
    /// ```
    /// use babybench::Info;
    ///
    /// assert_eq!(Info::default().to_json(), "{\"steps\": 0}");
    /// ```
    pub fn to_json(&self) -> String {
        crate::json::text(self)
    }

    /// Returns [`Info::to_json`] with the details: `right_hand_parts` and `left_hand_parts` (names), `gaze_angles`
    /// (rad).
    pub fn to_detailed_json(&self) -> String {
        crate::json::text(&InfoWithDetails::from(self))
    }
}

impl Serialize for BehaviorInfo {
    /// Serializes the keys of the reference without `steps`; an empty map for the behavior `none`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.fields())
    }
}

impl Serialize for InfoDetails {
    /// Serializes `right_hand_parts` and `left_hand_parts` (names), or `gaze_angles` (rad, by pair of eye and hand) with `page_regards`
    /// and `kit_regards` (steps, by the same pairs), whichever exist. A hand exactly at an eye has no angle, which is `null` in JSON.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.fields())
    }
}

impl Serialize for InfoValue<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(count) => count.serialize(serializer),
            Self::Geoms(geoms) => geoms.serialize(serializer),
            Self::Name(name) => name.serialize(serializer),
            Self::Flag(flag) => flag.serialize(serializer),
            Self::Number(number) => number.serialize(serializer),
            Self::Parts(names) => serializer.collect_seq(names.iter().map(|name| &**name)),
            Self::Angles(angles) => angles.serialize(serializer),
            Self::Counts(counts) => counts.serialize(serializer),
        }
    }
}

/// An [`Info`] together with details, in one flat map: behavior, details, steps.
///
/// ```
/// use babybench::env::InfoWithDetails;
/// use babybench::Info;
///
/// let info = Info { steps: 3, ..Info::default() };
/// let detailed = InfoWithDetails { info: &info, details: Some(&info.details) };
/// assert_eq!(serde_json::to_string(&detailed)?, "{\"steps\":3}");
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct InfoWithDetails<'a> {
    /// The keys of the reference.
    pub info: &'a Info,
    /// The details, if included.
    pub details: Option<&'a InfoDetails>,
}

impl<'a> From<&'a Info> for InfoWithDetails<'a> {
    fn from(info: &'a Info) -> Self {
        let details = Some(&info.details);
        Self { info, details }
    }
}

impl Serialize for InfoWithDetails<'_> {
    /// Serializes one flat map.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.info.fields(self.details))
    }
}

/// A value of a file.
#[derive(Deserialize)]
#[serde(untagged)]
enum LogValue {
    Flag(bool),
    // before `Number`, because the first variant that fits wins
    Count(u64),
    Number(f64),
    Name(String),
    Geoms(Vec<usize>),
    Other(IgnoredAny),
}

/// The values of a file by key.
struct ValuesByKey<E> {
    values: BTreeMap<String, LogValue>,
    error: PhantomData<E>,
}

impl<E: serde::de::Error> ValuesByKey<E> {
    /// Removes and returns a value.
    fn take<T>(&mut self, key: &str, expected: &str, read: impl FnOnce(LogValue) -> Option<T>) -> Result<T, E> {
        let found = self.values.remove(key);
        let found =
            found.ok_or_else(|| E::custom(format!("missing `{key}`; expected all keys of one behavior, or none")))?;
        read(found).ok_or_else(|| E::custom(format!("`{key}` is not {expected}")))
    }
}

impl<E: serde::de::Error> InfoSource for ValuesByKey<E> {
    type Error = E;

    fn has(&self, key: &'static str) -> bool {
        self.values.contains_key(key)
    }

    fn count(&mut self, key: &'static str) -> Result<u64, E> {
        self.take(key, "a whole number", |found| match found {
            LogValue::Count(count) => Some(count),
            _ => None,
        })
    }

    fn geoms(&mut self, key: &'static str) -> Result<Vec<usize>, E> {
        self.take(key, "a list of geom ids", |found| match found {
            LogValue::Geoms(geoms) => Some(geoms),
            _ => None,
        })
    }

    fn name(&mut self, key: &'static str) -> Result<Arc<str>, E> {
        self.take(key, "a text", |found| match found {
            LogValue::Name(name) => Some(name.into()),
            _ => None,
        })
    }

    fn flag(&mut self, key: &'static str) -> Result<bool, E> {
        self.take(key, "true or false", |found| match found {
            LogValue::Flag(flag) => Some(flag),
            _ => None,
        })
    }

    fn number(&mut self, key: &'static str) -> Result<f64, E> {
        self.take(key, "a number", |found| match found {
            LogValue::Count(count) => Some(count as f64),
            LogValue::Number(number) => Some(number),
            _ => None,
        })
    }
}

impl<'de> Deserialize<'de> for Info {
    /// Deserializes the keys of the reference. Other keys, such as those of the details, are ignored.
    ///
    /// # Errors
    /// A missing `steps`, or some but not all keys of a behavior.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values = BTreeMap::<String, Option<LogValue>>::deserialize(deserializer)?;
        let mut keys = ValuesByKey {
            values: values
                .into_iter()
                .filter_map(|(key, found)| Some((key, found?)))
                .collect(),
            error: PhantomData,
        };
        let info = Self::read(&mut keys)?;
        match keys.values.keys().find(|key| BehaviorInfo::is_key(key)) {
            Some(key) => Err(D::Error::custom(format!(
                "`{key}` is not of behavior {}; expected all keys of one behavior, or none",
                info.behavior.name()
            ))),
            None => Ok(info),
        }
    }
}
