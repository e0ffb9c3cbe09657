//! The info of an environment, in the formats of serde.

use std::sync::Arc;

use serde::de::Error as _;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{BehaviorInfo, EYE_HAND_PAIRS, Info, InfoDetails, Outcome, PerEyeAndHand, PerHand, TaskInfo};
use crate::config::Behavior;

impl Serialize for Info {
    /// Serializes the keys of the reference, in its order; the details are a value of their own
    /// ([`Info::details`], [`Detailed`]).
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Detailed {
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
    /// use babybench::env::Info;
    ///
    /// assert_eq!(Info::default().to_json(), "{\"steps\": 0}");
    /// ```
    pub fn to_json(&self) -> String {
        crate::json::text(self)
    }

    /// Returns [`Info::to_json`] with the details: `right_hand_parts` and `left_hand_parts` (names), `gaze_angles`
    /// (rad).
    pub fn to_detailed_json(&self) -> String {
        crate::json::text(&Detailed::from(self))
    }
}

impl Serialize for BehaviorInfo {
    /// Serializes the keys of the reference without `steps`; nothing but an empty map for behavior `none`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        behavior(&mut map, self)?;
        map.end()
    }
}

impl Serialize for InfoDetails {
    /// Serializes `right_hand_parts` and `left_hand_parts` (names) or `gaze_angles` (rad, by pair of eye and hand),
    /// whichever there are. A hand at the very place of an eye has no angle, which is `null` in JSON.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        details(&mut map, self)?;
        map.end()
    }
}

/// An [`Info`] together with details, in one flat map: behavior, details, steps.
///
/// ```
/// use babybench::env::{Detailed, Info};
///
/// let info = Info { steps: 3, ..Info::default() };
/// let detailed = Detailed { info: &info, details: Some(&info.details) };
/// assert_eq!(serde_json::to_string(&detailed)?, "{\"steps\":3}");
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Detailed<'a> {
    /// The keys of the reference.
    pub info: &'a Info,
    /// The details, if included.
    pub details: Option<&'a InfoDetails>,
}

impl<'a> From<&'a Info> for Detailed<'a> {
    fn from(info: &'a Info) -> Self {
        let details = Some(&info.details);
        Self { info, details }
    }
}

impl Serialize for Detailed<'_> {
    /// Serializes one flat map.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        behavior(&mut map, &self.info.behavior)?;
        if let Some(more) = self.details {
            details(&mut map, more)?;
        }
        map.serialize_entry("steps", &self.info.steps)?;
        map.end()
    }
}

fn behavior<M: SerializeMap>(map: &mut M, behavior: &BehaviorInfo) -> Result<(), M::Error> {
    match behavior {
        BehaviorInfo::None => {}
        BehaviorInfo::SelfTouch { touches } => {
            map.serialize_entry("right_hand_touches", &touches.right_hand)?;
            map.serialize_entry("left_hand_touches", &touches.left_hand)?;
        }
        BehaviorInfo::HandRegard { counts } => {
            for (name, count) in EYE_HAND_PAIRS.iter().zip(counts.to_array()) {
                map.serialize_entry(name, &count)?;
            }
        }
        BehaviorInfo::Task(info) => {
            map.serialize_entry("task", &info.task)?;
            map.serialize_entry("is_success", &info.outcome.is_success)?;
            map.serialize_entry("is_failure", &info.outcome.is_failure)?;
            map.serialize_entry("return", &info.episode_return)?;
        }
    }
    Ok(())
}

fn details<M: SerializeMap>(map: &mut M, details: &InfoDetails) -> Result<(), M::Error> {
    if let Some(parts) = &details.touched_parts {
        map.serialize_entry("right_hand_parts", &Names(&parts.right_hand))?;
        map.serialize_entry("left_hand_parts", &Names(&parts.left_hand))?;
    }
    if let Some(angles) = &details.gaze_angles {
        map.serialize_entry("gaze_angles", angles)?;
    }
    Ok(())
}

/// The names of parts.
struct Names<'a>(&'a [Arc<str>]);

impl Serialize for Names<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(|name| &**name))
    }
}

/// The keys of the reference as a file may hold them.
#[derive(Deserialize)]
struct Keys {
    steps: u64,
    right_hand_touches: Option<Vec<usize>>,
    left_hand_touches: Option<Vec<usize>>,
    right_eye_right_hand: Option<u64>,
    right_eye_left_hand: Option<u64>,
    left_eye_right_hand: Option<u64>,
    left_eye_left_hand: Option<u64>,
    task: Option<Behavior>,
    is_success: Option<bool>,
    is_failure: Option<bool>,
    #[serde(rename = "return")]
    episode_return: Option<f64>,
}

impl<'de> Deserialize<'de> for Info {
    /// Deserializes the keys of the reference. Other keys, such as those of the details, are ignored.
    ///
    /// # Errors
    /// No `steps`, or some but not all keys of a behavior.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let keys = Keys::deserialize(deserializer)?;
        let touches = (keys.right_hand_touches, keys.left_hand_touches);
        let counts = [
            keys.right_eye_right_hand,
            keys.right_eye_left_hand,
            keys.left_eye_right_hand,
            keys.left_eye_left_hand,
        ];
        let behavior = match (touches, counts) {
            ((None, None), [None, None, None, None]) => BehaviorInfo::None,
            ((Some(right_hand), Some(left_hand)), [None, None, None, None]) => BehaviorInfo::SelfTouch {
                touches: PerHand { right_hand, left_hand },
            },
            ((None, None), [Some(a), Some(b), Some(c), Some(d)]) => BehaviorInfo::HandRegard {
                counts: PerEyeAndHand::from([a, b, c, d]),
            },
            _ => return Err(D::Error::custom("expected all keys of one behavior, or none")),
        };
        let behavior = match (keys.task, keys.is_success, keys.is_failure, keys.episode_return) {
            (Some(task), Some(is_success), Some(is_failure), Some(episode_return)) => BehaviorInfo::Task(TaskInfo {
                task,
                outcome: Outcome { is_success, is_failure },
                episode_return,
            }),
            (None, None, None, None) => behavior,
            _ => return Err(D::Error::custom("expected all keys of one task, or none")),
        };
        Ok(Self {
            steps: keys.steps,
            behavior,
            details: InfoDetails::default(),
        })
    }
}
