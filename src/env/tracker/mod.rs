//! Trackers follow the state for a behavior and keep its part of the information.

mod hand_regard;
mod self_touch;

use crate::config::{Behavior, Compat};
use crate::env::{BehaviorInfo, EnvError, Info, PerEyeAndHand, PerHand};
use crate::model::Model;
use crate::physics::State;
use hand_regard::HandRegard;
use self_touch::SelfTouch;

/// A tracker of one behavior.
#[derive(Clone, Debug)]
pub(super) enum BehaviorTracker {
    None,
    SelfTouch(SelfTouch),
    HandRegard(HandRegard),
}

impl BehaviorTracker {
    pub fn new(model: &Model, behavior: Behavior, compat: Compat) -> Result<Self, EnvError> {
        Ok(match behavior {
            Behavior::None => Self::None,
            Behavior::SelfTouch => Self::SelfTouch(SelfTouch::new(model)?),
            Behavior::HandRegard => Self::HandRegard(HandRegard::new(model, compat)?),
        })
    }

    /// Sets counters and lists as they are at the start of an episode.
    pub fn reset(&self, info: &mut Info) {
        self.clear(&mut info.behavior);
        match self {
            Self::SelfTouch(w) if info.details.touched_parts.is_none() => {
                info.details.reserve(&info.behavior, &w.names)
            }
            _ => {}
        }
        self.describe(None, info);
    }

    /// Empties what the behavior counts, and reserves room so that no step allocates.
    fn clear(&self, behavior: &mut BehaviorInfo) {
        match (self, behavior) {
            (Self::SelfTouch(_), BehaviorInfo::SelfTouch { touches }) => {
                touches.each_mut().into_iter().for_each(Vec::clear)
            }
            (Self::None, info) => *info = BehaviorInfo::None,
            (Self::SelfTouch(w), info) => {
                let touches = PerHand::from_fn(|_| Vec::with_capacity(w.ngeom()));
                *info = BehaviorInfo::SelfTouch { touches };
            }
            (Self::HandRegard(_), info) => {
                let counts = PerEyeAndHand::default();
                *info = BehaviorInfo::HandRegard { counts };
            }
        }
    }

    /// Computes the angles between the axes of the eyes and the hands, rad, if the behavior is `hand_regard`.
    pub fn gaze_angles(&self, s: &State) -> Option<PerEyeAndHand<f64>> {
        match self {
            Self::HandRegard(w) => Some(w.angles(s)),
            _ => None,
        }
    }

    /// Adds what the last step brought.
    pub fn update(&self, s: &State, info: &mut Info) {
        match (self, &mut info.behavior) {
            (Self::SelfTouch(w), BehaviorInfo::SelfTouch { touches }) => w.update(s, touches),
            (Self::HandRegard(w), BehaviorInfo::HandRegard { counts }) => {
                let seen = PerEyeAndHand::from_fn(|eye, hand| u64::from(w.sees(s, eye, hand))).to_array();
                let sums = counts.to_array();
                *counts = std::array::from_fn(|k| sums[k] + seen[k]).into();
            }
            _ => {}
        }
        self.describe(Some(s), info);
    }

    /// Brings the details up to date. Without a state whose poses hold, there are no angles.
    pub fn describe(&self, s: Option<&State>, info: &mut Info) {
        match self {
            Self::None => {}
            Self::SelfTouch(w) => info.details.name_parts(&info.behavior, &w.names),
            Self::HandRegard(w) => info.details.gaze_angles = s.map(|s| w.angles(s)),
        }
    }
}

/// Finds a body that a behavior needs.
fn body(model: &Model, name: &str, purpose: &'static str) -> Result<usize, EnvError> {
    let missing = || EnvError::Missing {
        what: "body",
        name: name.to_string(),
        purpose,
    };
    model.body(name).ok_or_else(missing)
}
