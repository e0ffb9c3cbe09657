//! The preliminary achievement scores of a training log, and their parts.
//!
//! They are computed like the kit's, except that every episode counts: the kit leaves out the first record of a log, because its logs
//! start with an empty one. Under `compat: reference` the oldest of the last 10,001 records is left out, even if it is not empty.

mod serial;

use std::collections::BTreeSet;
use std::fmt::{self, Write as _};
use std::sync::Arc;

use thiserror::Error;

use crate::config::Compat;
use crate::env::{BehaviorInfo, EYE_HAND_PAIRS, Info, PartNames, PerEyeAndHand, PerHand, SCORED_PARTS as PARTS};
use crate::json;
use crate::model::Model;
use crate::physics::collision::ContactRules;

/// Maximum number of records that count.
pub const MAX_EPISODES: usize = 10_000;

/// An error in scoring a log.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ScoreError {
    /// The log has no records.
    #[error("the training log has no records: train for at least two episodes, then score")]
    Empty,
    /// The counted records have no steps.
    #[error(
        "the training log has no steps that count ({records} records; under compat: reference the oldest never counts): \
         train for at least two episodes, then score"
    )]
    NoSteps {
        /// Records in the log.
        records: usize,
    },
    /// The behavior of the log has no score.
    #[error("the training log is not of a behavior with a score: self_touch or hand_regard")]
    NoBehavior,
}

/// A score and its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// The score: 0 to 1, for `self_touch` at most 62/68.
    pub value: f64,
    /// Number of records that count.
    pub episodes: usize,
    /// Number of steps in these records.
    pub steps: u64,
    /// Mean number of parts that both hands touch in an episode, counted separately for each hand; none for `hand_regard`. The score is the union
    /// over all episodes, which a rare chance touch raises as much as a habit. This mean is not affected in that way.
    pub parts_per_episode: Option<f64>,
    /// The parts of the score.
    pub parts: ScoreParts,
}

/// The parts of a score.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScoreParts {
    /// The parts that were touched.
    SelfTouch {
        /// Geoms touched by each hand, ascending.
        touched: PerHand<Vec<usize>>,
    },
    /// The times in which hands were in view.
    HandRegard {
        /// Number of steps for each eye and hand.
        counts: PerEyeAndHand<u64>,
    },
}

impl Score {
    /// Computes the score of the records of a training log that [`Score::counted`] returns.
    ///
    /// # Errors
    /// A log without records, steps or behavior.
    pub fn new(records: &[Info], compat: Compat) -> Result<Self, ScoreError> {
        let first = records.first().ok_or(ScoreError::Empty)?;
        let chosen = Self::counted(records, compat);
        let (episodes, steps) = (chosen.len(), steps(chosen));
        let (value, parts) = match first.behavior {
            BehaviorInfo::None | BehaviorInfo::Task(_) => return Err(ScoreError::NoBehavior),
            BehaviorInfo::SelfTouch { .. } => {
                let touched = PerHand::from_fn(|hand| {
                    let lists = chosen.iter().filter_map(|r| r.behavior.touches());
                    let all: BTreeSet<usize> = lists.flat_map(|t| t[hand].iter().copied()).collect();
                    all.into_iter().collect::<Vec<usize>>()
                });
                (of_touched(&touched), ScoreParts::SelfTouch { touched })
            }
            BehaviorInfo::HandRegard { .. } => {
                if steps == 0 {
                    let records = records.len();
                    return Err(ScoreError::NoSteps { records });
                }
                let counts = [0, 1, 2, 3].map(|k| {
                    let all = chosen.iter().filter_map(|r| r.behavior.regards());
                    // a hand cannot be in view for longer than there are steps
                    all.map(|c| c[k]).fold(0_u64, u64::saturating_add).min(steps)
                });
                let number: f64 = counts.iter().map(|&c| c as f64).sum();
                let counts = PerEyeAndHand::from(counts);
                (number / (4.0 * steps as f64), ScoreParts::HandRegard { counts })
            }
        };
        Ok(Self {
            value,
            episodes,
            steps,
            parts_per_episode: parts_per_episode(chosen),
            parts,
        })
    }

    /// Computes the score of the episodes of a training that had ended after `steps` steps, to compare logs of different lengths.
    ///
    /// # Errors
    /// As [`Score::new`].
    pub fn after(records: &[Info], steps: u64, compat: Compat) -> Result<Self, ScoreError> {
        let ends = records.iter().scan(0_u64, |sum, record| {
            *sum = sum.saturating_add(record.steps);
            Some(*sum)
        });
        let ended = ends.take_while(|end| *end <= steps).count();
        Self::new(records.get(..ended).unwrap_or_default(), compat)
    }

    /// Leaves out the geoms that no hand can reach in the scene of `skin`, which must be the scene of the log.
    #[must_use]
    pub fn within_reach(mut self, skin: &TouchableGeoms) -> Self {
        if let ScoreParts::SelfTouch { touched } = &mut self.parts {
            let hands = [&mut touched.right_hand, &mut touched.left_hand];
            for (hand, geoms) in hands.into_iter().enumerate() {
                geoms.retain(|g| skin.reachable(hand).binary_search(g).is_ok());
            }
            self.value = of_touched(touched);
        }
        self
    }

    /// Returns the records that count: the last 10,000, without the empty record at the start of the kit's logs; under
    /// [`Compat::Reference`] without the first record of the log, even if it is not empty.
    pub fn counted(records: &[Info], compat: Compat) -> &[Info] {
        let left_out = match compat {
            Compat::Api => records.iter().take_while(|record| record.steps == 0).count(),
            Compat::Reference => 1,
        };
        let first = records.len().saturating_sub(MAX_EPISODES).max(left_out);
        records.get(first..).unwrap_or_default()
    }

    /// Returns the score of a number of touched parts, of both hands together.
    pub fn of_parts(touched: usize) -> f64 {
        touched as f64 / (2 * PARTS) as f64
    }

    /// Returns the score of a single episode; `None` without steps or behavior.
    pub fn of_episode(record: &Info, steps: u64) -> Option<f64> {
        record.behavior.score(steps)
    }

    /// Returns the shares of the steps in which each eye had each hand in view, for the behavior `hand_regard`.
    pub fn fractions(&self) -> Option<PerEyeAndHand<f64>> {
        match self.parts {
            ScoreParts::HandRegard { counts } => Some(counts.to_array().map(|c| c as f64 / self.steps as f64).into()),
            ScoreParts::SelfTouch { .. } => None,
        }
    }

    /// Returns the score as lines of text; `skin` names the parts.
    pub fn to_text(&self, skin: Option<&TouchableGeoms>) -> String {
        let mut out = format!("{self}\n");
        // writing to a string cannot fail
        let _ = write!(out, "  {} episodes, {} steps count", self.episodes, self.steps);
        if let Some(number) = self.parts_per_episode {
            let _ = write!(out, "; {number:.1} parts touched in an episode");
        }
        out.push('\n');
        match &self.parts {
            ScoreParts::SelfTouch { touched } => {
                let hands = ["right hand", "left hand"].into_iter().zip(touched.each_ref());
                for (hand, (name, geoms)) in hands.enumerate() {
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
            ScoreParts::HandRegard { counts } => {
                for (name, count) in EYE_HAND_PAIRS.iter().zip(counts.to_array()) {
                    let share = 100.0 * count as f64 / self.steps as f64;
                    let name = name.replace('_', " ");
                    let _ = writeln!(out, "  {name:22} {count:>9} steps {share:6.2} %");
                }
            }
        }
        out
    }

    /// Returns the score as one line of JSON; `skin` adds names of the parts.
    pub fn to_json(&self, skin: Option<&TouchableGeoms>) -> String {
        json::text(&serial::NamedScore { score: self, skin })
    }
}

/// Returns the score of the geoms that each hand has touched, limited to the parts of a hand.
fn of_touched(touched: &PerHand<Vec<usize>>) -> f64 {
    let number: usize = touched.each_ref().iter().map(|t| t.len().min(PARTS)).sum();
    number as f64 / (2 * PARTS) as f64
}

/// Returns the mean number of parts that both hands touch in an episode; `None` if there are no episodes of `self_touch`.
fn parts_per_episode(records: &[Info]) -> Option<f64> {
    let touches = records.iter().filter_map(|r| r.behavior.touches());
    let numbers = touches.map(|t| t.each_ref().iter().map(|geoms| geoms.len().min(PARTS)).sum::<usize>());
    let (episodes, sum) = numbers.fold((0_usize, 0_usize), |(n, sum), number| (n + 1, sum + number));
    (episodes > 0).then(|| sum as f64 / episodes as f64)
}

/// Returns the number of steps in records.
pub fn steps(records: &[Info]) -> u64 {
    records.iter().fold(0, |sum, r| sum.saturating_add(r.steps))
}

impl fmt::Display for Score {
    /// Formats the line that the kit prints.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Preliminary training score: {:?}", self.value)
    }
}

/// MIMo's geoms that hands can touch, with names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TouchableGeoms {
    names: PartNames,
    reachable: [Vec<usize>; 2],
}

impl TouchableGeoms {
    /// Finds MIMo's geoms in a scene; returns `None` if it has no MIMo. A palm can reach a part if the two can collide.
    pub fn new(model: &Model) -> Option<Self> {
        let (hip, hands) = (
            model.body("hip")?,
            [model.body("right_hand")?, model.body("left_hand")?],
        );
        let own: Vec<usize> = (0..model.ngeom())
            .filter(|&g| model.in_subtree(model.geom_bodyid[g], hip))
            .collect();
        let rules = ContactRules::new(model);
        let reachable = hands.map(|hand| {
            let palm = || own.iter().filter(|&&g| model.geom_bodyid[g] == hand);
            let by = |g: usize| palm().any(|&p| rules.allow(p, g));
            own.iter()
                .copied()
                .filter(|&g| model.geom_bodyid[g] != hand && by(g))
                .collect()
        });
        let names = PartNames::new(model);
        Some(Self { names, reachable })
    }

    /// Returns the geoms that the right (0) or left (1) palm can touch, ascending.
    pub fn reachable(&self, hand: usize) -> &[usize] {
        self.reachable.get(hand).map_or(&[], Vec::as_slice)
    }

    /// Returns the name of a geom as a part of the body; see [`PartNames`].
    pub fn name(&self, geom: usize) -> Arc<str> {
        self.names.get(geom)
    }
}
