//! The preliminary achievement scores of a training log, with what they are made of.
//!
//! As the kit computes them, from the same records: the oldest of the last 10,001 records is left out, so that of a log of
//! at most 10,001 records the first one never counts (the kit starts its logs with an empty one).

use std::fmt::{self, Write as _};
use std::sync::Arc;

use thiserror::Error;

use crate::env::{BehaviorInfo, Info, PartNames};
use crate::model::Model;
use crate::physics::world::PairTable;

/// Most records that count.
pub const MAX_EPISODES: usize = 10_000;
/// Parts in the denominator for each hand: MIMo v1's 36 geoms without the two of the palm itself.
const PARTS: usize = 34;

/// Why a log has no score.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ScoreError {
    /// There are no records.
    #[error("the training log has no records: train for at least two episodes, then score")]
    Empty,
    /// There are no steps in the records that count.
    #[error(
        "the training log has no steps that count ({records} records, of which the oldest never counts): \
         train for at least two episodes, then score"
    )]
    NoSteps {
        /// Records in the log.
        records: usize,
    },
    /// The log is of no behavior that has a score.
    #[error("the training log is of behavior none, which has no score; train with behavior self_touch or hand_regard")]
    NoBehavior,
}

/// A score and its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// The score: 0 to 1, for `self_touch` at most 62/68.
    pub value: f64,
    /// Records that count.
    pub episodes: usize,
    /// Their steps.
    pub steps: u64,
    /// What the score is made of.
    pub parts: ScoreParts,
}

/// What a score is made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScoreParts {
    /// Geoms touched by the right and by the left hand, ascending.
    SelfTouch([Vec<usize>; 2]),
    /// Steps of the four pairs of eye and hand, in the order of [`BehaviorInfo::REGARDS`].
    HandRegard([u64; 4]),
}

impl Score {
    /// Of the records of a training log.
    ///
    /// # Errors
    /// A log without records, steps or behavior.
    pub fn new(records: &[Info]) -> Result<Self, ScoreError> {
        let first = records.first().ok_or(ScoreError::Empty)?;
        let chosen = Self::counted(records);
        let (episodes, steps) = (chosen.len(), chosen.iter().map(|r| r.steps).sum());
        let (value, parts) = match first.behavior {
            BehaviorInfo::None => return Err(ScoreError::NoBehavior),
            BehaviorInfo::SelfTouch { .. } => {
                let touched = [0, 1].map(|hand| {
                    let lists = chosen.iter().filter_map(|r| r.behavior.touches());
                    let mut all: Vec<usize> = lists.flat_map(|t| t[hand].iter().copied()).collect();
                    all.sort_unstable();
                    all.dedup();
                    all
                });
                let number = touched[0].len() + touched[1].len();
                (number as f64 / (2 * PARTS) as f64, ScoreParts::SelfTouch(touched))
            }
            BehaviorInfo::HandRegard { .. } => {
                if steps == 0 {
                    let records = records.len();
                    return Err(ScoreError::NoSteps { records });
                }
                let counts = [0, 1, 2, 3].map(|k| {
                    let all = chosen.iter().filter_map(|r| r.behavior.regards());
                    all.map(|c| c[k]).fold(0_u64, u64::saturating_add)
                });
                let number: f64 = counts.iter().map(|&c| c as f64).sum();
                (number / (4.0 * steps as f64), ScoreParts::HandRegard(counts))
            }
        };
        Ok(Self {
            value,
            episodes,
            steps,
            parts,
        })
    }

    /// The records that count.
    pub fn counted(records: &[Info]) -> &[Info] {
        let first = records.len().saturating_sub(MAX_EPISODES).max(1);
        records.get(first..).unwrap_or_default()
    }

    /// The score of so many touched parts, of both hands together.
    #[cfg(feature = "report")]
    pub(crate) fn of_parts(touched: usize) -> f64 {
        touched as f64 / (2 * PARTS) as f64
    }

    /// The score that one episode of a number of steps has alone; `None` without steps or behavior.
    pub fn of_episode(record: &Info, steps: u64) -> Option<f64> {
        if steps == 0 {
            return None;
        }
        let touches = record.behavior.touches();
        let regards = record.behavior.regards();
        let touched = touches.map(|[right, left]| (right.len() + left.len()) as f64 / (2 * PARTS) as f64);
        touched.or_else(|| regards.map(|counts| counts.iter().map(|&c| c as f64).sum::<f64>() / (4.0 * steps as f64)))
    }

    /// Shares of the steps in which each eye had each hand in view, if this is `hand_regard`.
    pub fn fractions(&self) -> Option<[f64; 4]> {
        match self.parts {
            ScoreParts::HandRegard(counts) => Some(counts.map(|c| c as f64 / self.steps as f64)),
            ScoreParts::SelfTouch(_) => None,
        }
    }

    /// The score as lines of text; `skin` names the parts.
    pub fn to_text(&self, skin: Option<&Touchables>) -> String {
        let mut out = format!("{self}\n");
        // writing to a string cannot fail
        let _ = writeln!(out, "  {} episodes, {} steps count", self.episodes, self.steps);
        match &self.parts {
            ScoreParts::SelfTouch(touched) => {
                for (hand, (name, geoms)) in ["right hand", "left hand"].into_iter().zip(touched).enumerate() {
                    let _ = write!(out, "  {name}: {} of {PARTS} parts", geoms.len());
                    let Some(skin) = skin else {
                        let _ = writeln!(out, ", geoms {geoms:?}");
                        continue;
                    };
                    let reachable = skin.reachable(hand);
                    let _ = writeln!(out, ", of which {} can be reached", reachable.len());
                    let list = |geoms: &mut dyn Iterator<Item = usize>| {
                        let names: Vec<_> = geoms.map(|g| skin.name(g)).collect();
                        if names.is_empty() {
                            "none".to_string()
                        } else {
                            names.join(", ")
                        }
                    };
                    let _ = writeln!(out, "    touched: {}", list(&mut geoms.iter().copied()));
                    let mut rest = reachable.iter().copied().filter(|g| !geoms.contains(g));
                    let _ = writeln!(out, "    not yet: {}", list(&mut rest));
                }
            }
            ScoreParts::HandRegard(counts) => {
                for (k, name) in BehaviorInfo::REGARDS.iter().enumerate() {
                    let share = 100.0 * counts[k] as f64 / self.steps as f64;
                    let _ = writeln!(
                        out,
                        "  {:22} {:>9} steps {share:6.2} %",
                        name.replace('_', " "),
                        counts[k]
                    );
                }
            }
        }
        out
    }

    /// The score as one line of JSON; `skin` adds names of the parts.
    pub fn to_json(&self, skin: Option<&Touchables>) -> String {
        let (value, episodes, steps) = (self.value, self.episodes, self.steps);
        let head = |behavior: &str| {
            format!(
                "{{\"behavior\": \"{behavior}\", \"score\": {value:?}, \"episodes\": {episodes}, \"steps\": {steps}"
            )
        };
        match &self.parts {
            ScoreParts::SelfTouch(touched) => {
                let mut out = head("self_touch");
                for (hand, (name, geoms)) in ["right_hand", "left_hand"].into_iter().zip(touched).enumerate() {
                    // writing to a string cannot fail
                    let _ = write!(out, ", \"{name}\": {{\"parts\": {PARTS}, \"touched\": {geoms:?}");
                    if let Some(skin) = skin {
                        let names =
                            |geoms: &[usize]| -> Vec<Arc<str>> { geoms.iter().map(|&g| skin.name(g)).collect() };
                        let reachable = skin.reachable(hand);
                        let _ = write!(out, ", \"reachable\": {reachable:?}");
                        let _ = write!(out, ", \"touched_names\": {:?}", names(geoms));
                        let _ = write!(out, ", \"reachable_names\": {:?}", names(reachable));
                    }
                    out.push('}');
                }
                out + "}"
            }
            ScoreParts::HandRegard(counts) => {
                let mut out = head("hand_regard");
                for (k, name) in BehaviorInfo::REGARDS.iter().enumerate() {
                    let share = counts[k] as f64 / steps as f64;
                    let _ = write!(
                        out,
                        ", \"{name}\": {{\"steps\": {}, \"fraction\": {share:?}}}",
                        counts[k]
                    );
                }
                out + "}"
            }
        }
    }
}

impl fmt::Display for Score {
    /// The line that the kit prints.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Preliminary training score: {:?}", self.value)
    }
}

/// MIMo's geoms that hands can touch, with names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Touchables {
    names: PartNames,
    reachable: [Vec<usize>; 2],
}

impl Touchables {
    /// Of a scene; `None` if it has no MIMo. A part can be reached by a palm if the scene lets the two collide.
    pub fn new(model: &Model) -> Option<Self> {
        let (hip, hands) = (
            model.body("hip")?.0,
            [model.body("right_hand")?.0, model.body("left_hand")?.0],
        );
        let own: Vec<usize> = (0..model.ngeom())
            .filter(|&g| model.in_subtree(model.geom_bodyid[g], hip))
            .collect();
        let pairs = PairTable::new(model);
        let reachable = hands.map(|hand| {
            let palm = || own.iter().filter(|&&g| model.geom_bodyid[g] == hand);
            let by = |g: usize| palm().any(|&p| pairs.find(p, g).is_some());
            own.iter()
                .copied()
                .filter(|&g| model.geom_bodyid[g] != hand && by(g))
                .collect()
        });
        let names = PartNames::new(model);
        Some(Self { names, reachable })
    }

    /// Geoms that the right (0) or left (1) palm can touch, ascending.
    pub fn reachable(&self, hand: usize) -> &[usize] {
        self.reachable.get(hand).map_or(&[], Vec::as_slice)
    }

    /// Name of a geom as a part of the body, see [`PartNames`].
    pub fn name(&self, geom: usize) -> Arc<str> {
        self.names.get(geom)
    }
}
