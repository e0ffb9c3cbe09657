//! Scores in the formats of serde.

use serde::ser::{Serialize, SerializeMap as _, Serializer};

use super::{Score, ScoreParts, TouchableGeoms};
use crate::env::EYE_HAND_PAIRS;
use crate::env::SCORED_PARTS as PARTS;

impl Serialize for Score {
    /// Serializes the score as [`Score::to_json`] prints it without names.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let skin = None;
        NamedScore { score: self, skin }.serialize(serializer)
    }
}

impl Serialize for ScoreParts {
    /// Serializes the touched geoms of each hand, or the steps of each pair of eye and hand.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::SelfTouch { touched } => touched.serialize(serializer),
            Self::HandRegard { counts } => counts.serialize(serializer),
        }
    }
}

/// Keys of the right and of the left hand.
const HANDS: [&str; 2] = ["right_hand", "left_hand"];

/// A score with the names of parts.
pub(super) struct NamedScore<'a> {
    pub score: &'a Score,
    pub skin: Option<&'a TouchableGeoms>,
}

impl Serialize for NamedScore<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (score, skin) = (self.score, self.skin);
        let mut map = serializer.serialize_map(None)?;
        let behavior = match score.parts {
            ScoreParts::SelfTouch { .. } => "self_touch",
            ScoreParts::HandRegard { .. } => "hand_regard",
        };
        map.serialize_entry("behavior", behavior)?;
        map.serialize_entry("score", &score.value)?;
        map.serialize_entry("episodes", &score.episodes)?;
        map.serialize_entry("steps", &score.steps)?;
        if let Some(number) = score.parts_per_episode {
            map.serialize_entry("parts_per_episode", &number)?;
        }
        match &score.parts {
            ScoreParts::SelfTouch { touched } => {
                for (hand, (name, touched)) in HANDS.iter().zip(touched.each_ref()).enumerate() {
                    map.serialize_entry(name, &HandTouches { hand, touched, skin })?;
                }
            }
            ScoreParts::HandRegard { counts } => {
                for (name, steps) in EYE_HAND_PAIRS.iter().zip(counts.to_array()) {
                    let fraction = steps as f64 / score.steps as f64;
                    map.serialize_entry(name, &HandRegard { steps, fraction })?;
                }
            }
        }
        map.end()
    }
}

/// The parts that one hand has touched.
struct HandTouches<'a> {
    hand: usize,
    touched: &'a [usize],
    skin: Option<&'a TouchableGeoms>,
}

impl Serialize for HandTouches<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("parts", &PARTS)?;
        map.serialize_entry("touched", self.touched)?;
        if let Some(skin) = self.skin {
            let reachable = skin.reachable(self.hand);
            map.serialize_entry("reachable", reachable)?;
            let names = |geoms| GeomNames { skin, geoms };
            map.serialize_entry("touched_names", &names(self.touched))?;
            map.serialize_entry("reachable_names", &names(reachable))?;
        }
        map.end()
    }
}

/// Geoms by their names.
struct GeomNames<'a> {
    skin: &'a TouchableGeoms,
    geoms: &'a [usize],
}

impl Serialize for GeomNames<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.geoms.iter().map(|&g| self.skin.name(g).to_string()))
    }
}

/// The time for which an eye had a hand in view.
#[derive(serde::Serialize)]
struct HandRegard {
    steps: u64,
    fraction: f64,
}
