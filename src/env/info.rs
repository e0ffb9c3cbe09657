//! The info that an environment returns with each step.

use std::sync::Arc;

use super::{InfoDetails, Outcome, PerEyeAndHand, PerHand};

/// Parts in the denominator of the score for each hand: MIMo v1's 36 geoms without the two of the palm itself.
pub(crate) const SCORED_PARTS: usize = 34;

/// The information that comes with each step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Info {
    /// Number of steps done in this episode; under `compat: reference` one less.
    pub steps: u64,
    /// Counters of the behavior.
    pub behavior: BehaviorInfo,
    /// Details that the reference does not report: names of touched parts, angles of gaze.
    pub details: InfoDetails,
}

/// The part of [`Info`] that depends on the behavior.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum BehaviorInfo {
    /// Nothing.
    #[default]
    None,
    /// The parts of the body that were touched in this episode.
    SelfTouch {
        /// Geom ids that each palm has touched, in the order of first touch.
        touches: PerHand<Vec<usize>>,
    },
    /// Steps of this episode in which a hand was in the central field of view of an eye.
    HandRegard {
        /// Number of steps for each eye and hand.
        counts: PerEyeAndHand<u64>,
    },
    /// The outcome of a task with a goal.
    Task(TaskInfo),
}

/// The report of a task with a goal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TaskInfo {
    /// The name of the task: [`Task::name`](crate::env::Task::name).
    pub task: Arc<str>,
    /// Success and failure in the last step.
    pub outcome: Outcome,
    /// Sum of the rewards of this episode.
    pub episode_return: f64,
    /// Further measures of the task.
    pub measures: Measures,
}

/// Measures of a task in an episode, besides its outcome: named numbers. Information, logs and Python's dictionaries use these names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measures {
    names: &'static [&'static str],
    values: Vec<f64>,
}

impl Measures {
    /// Returns the names.
    pub fn names(&self) -> &'static [&'static str] {
        self.names
    }

    /// Returns the values, one for each name.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the value with this name; `None` if there is none.
    pub fn get(&self, name: &str) -> Option<f64> {
        let at = self.names.iter().position(|n| *n == name)?;
        self.values.get(at).copied()
    }

    /// Sets names and values; names without a value get 0. With the same names as before it allocates nothing.
    pub fn set(&mut self, names: &'static [&'static str], values: impl IntoIterator<Item = f64>) {
        self.names = names;
        self.values.clear();
        self.values.reserve(names.len());
        self.values.extend(values.into_iter().take(names.len()));
        self.values.resize(names.len(), 0.0);
    }

    /// Iterates over names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.names.iter().copied().zip(self.values.iter().copied())
    }
}

impl BehaviorInfo {
    /// Returns the name of the behavior or of the task.
    pub fn name(&self) -> &str {
        match self {
            Self::None => "none",
            Self::SelfTouch { .. } => "self_touch",
            Self::HandRegard { .. } => "hand_regard",
            Self::Task(info) => &info.task,
        }
    }

    /// Returns the report of a task with a goal.
    pub fn task(&self) -> Option<&TaskInfo> {
        match self {
            Self::Task(info) => Some(info),
            _ => None,
        }
    }

    /// Returns the geoms touched by the right and the left hand, for the behavior `self_touch`.
    pub fn touches(&self) -> Option<[&[usize]; 2]> {
        match self {
            Self::SelfTouch { touches } => Some([&touches.right_hand, &touches.left_hand]),
            _ => None,
        }
    }

    /// Returns the score of a single episode of `steps` steps, 0 to 1, for `self_touch` at most 62/68; `None` without steps or behavior.
    pub fn score(&self, steps: u64) -> Option<f64> {
        if steps == 0 {
            return None;
        }
        match self {
            Self::None | Self::Task(_) => None,
            Self::SelfTouch { touches } => {
                let touched: usize = touches.each_ref().map(|t| t.len().min(SCORED_PARTS)).iter().sum();
                Some(touched as f64 / (2 * SCORED_PARTS) as f64)
            }
            Self::HandRegard { counts } => {
                // counters that continue from episode to episode may exceed the steps of this one
                let seen: f64 = counts.to_array().iter().map(|&c| c.min(steps) as f64).sum();
                Some(seen / (4.0 * steps as f64))
            }
        }
    }

    /// Returns the four counters, in the order of [`EYE_HAND_PAIRS`](crate::env::EYE_HAND_PAIRS), for the behavior `hand_regard`.
    pub fn regards(&self) -> Option<[u64; 4]> {
        match self {
            Self::HandRegard { counts } => Some(counts.to_array()),
            _ => None,
        }
    }
}
