//! What an environment reports about the behavior it is for.

use std::fmt::Write as _;

use crate::config::{Behavior, Compat};
use crate::env::{Details, EnvError, PartNames};
use crate::math::*;
use crate::model::Model;
use crate::physics::State;

/// Half of the central field of view, degrees.
const FIELD_OF_VIEW: f64 = 15.0;

/// The information that comes with each step. Two are equal if what the reference has is: `details` follow from it and
/// from the state.
#[derive(Clone, Debug, Default)]
pub struct Info {
    /// Steps done in this episode; under `compat: reference` one less.
    pub steps: u64,
    /// What the behavior adds.
    pub behavior: BehaviorInfo,
    /// What the reference does not have: names of touched parts, angles of gaze.
    pub details: Details,
}

impl PartialEq for Info {
    fn eq(&self, other: &Self) -> bool {
        (self.steps, &self.behavior) == (other.steps, &other.behavior)
    }
}

impl Eq for Info {}

impl Info {
    /// As one line of JSON, with the keys of the reference.
    pub fn to_json(&self) -> String {
        self.json(None)
    }

    /// [`Info::to_json`] with the details: `right_hand_parts` and `left_hand_parts` (names), `gaze_angles` (rad).
    pub fn to_detailed_json(&self) -> String {
        self.json(Some(&self.details))
    }

    pub(crate) fn json(&self, details: Option<&Details>) -> String {
        let mut json = String::from("{");
        // writing to a string cannot fail
        let _ = match &self.behavior {
            BehaviorInfo::None => Ok(()),
            BehaviorInfo::SelfTouch {
                right_hand_touches,
                left_hand_touches,
            } => write!(
                json,
                "\"right_hand_touches\": {right_hand_touches:?}, \"left_hand_touches\": {left_hand_touches:?}, "
            ),
            BehaviorInfo::HandRegard {
                right_eye_right_hand,
                right_eye_left_hand,
                left_eye_right_hand,
                left_eye_left_hand,
            } => write!(
                json,
                "\"right_eye_right_hand\": {right_eye_right_hand}, \"right_eye_left_hand\": {right_eye_left_hand}, \
                 \"left_eye_right_hand\": {left_eye_right_hand}, \"left_eye_left_hand\": {left_eye_left_hand}, "
            ),
        };
        if let Some(details) = details {
            details.write_json(&mut json);
        }
        let _ = write!(json, "\"steps\": {}}}", self.steps);
        json
    }
}

/// The part of [`Info`] that depends on the behavior.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum BehaviorInfo {
    /// Nothing.
    #[default]
    None,
    /// Body parts touched in this episode, geom ids in the order of first touch.
    SelfTouch {
        /// By the right palm.
        right_hand_touches: Vec<usize>,
        /// By the left palm.
        left_hand_touches: Vec<usize>,
    },
    /// Steps of this episode in which a hand was in the central field of view of an eye.
    HandRegard {
        /// Right eye, right hand.
        right_eye_right_hand: u64,
        /// Right eye, left hand.
        right_eye_left_hand: u64,
        /// Left eye, right hand.
        left_eye_right_hand: u64,
        /// Left eye, left hand.
        left_eye_left_hand: u64,
    },
}

impl BehaviorInfo {
    /// Keys of the counters of [`BehaviorInfo::regards`].
    pub const REGARDS: [&str; 4] = [
        "right_eye_right_hand",
        "right_eye_left_hand",
        "left_eye_right_hand",
        "left_eye_left_hand",
    ];

    /// Name of the behavior.
    pub fn name(&self) -> &'static str {
        match self {
            Self::None => "none",
            Self::SelfTouch { .. } => "self_touch",
            Self::HandRegard { .. } => "hand_regard",
        }
    }

    /// Parts touched by the right and by the left hand, if this is `self_touch`.
    pub fn touches(&self) -> Option<[&[usize]; 2]> {
        match self {
            Self::SelfTouch {
                right_hand_touches,
                left_hand_touches,
            } => Some([right_hand_touches, left_hand_touches]),
            _ => None,
        }
    }

    /// The four counters, in the order of [`BehaviorInfo::REGARDS`], if this is `hand_regard`.
    pub fn regards(&self) -> Option<[u64; 4]> {
        match *self {
            Self::HandRegard {
                right_eye_right_hand,
                right_eye_left_hand,
                left_eye_right_hand,
                left_eye_left_hand,
            } => Some([
                right_eye_right_hand,
                right_eye_left_hand,
                left_eye_right_hand,
                left_eye_left_hand,
            ]),
            _ => None,
        }
    }
}

/// Watches the state for a behavior.
#[derive(Clone, Debug)]
pub(crate) enum Watcher {
    None,
    SelfTouch(SelfTouch),
    HandRegard(HandRegard),
}

impl Watcher {
    pub fn new(model: &Model, behavior: Behavior, compat: Compat) -> Result<Self, EnvError> {
        Ok(match behavior {
            Behavior::None => Self::None,
            Behavior::SelfTouch => Self::SelfTouch(SelfTouch::new(model)?),
            Behavior::HandRegard => Self::HandRegard(HandRegard::new(model, compat)?),
        })
    }

    /// Counters and lists as at the start of an episode.
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

    fn clear(&self, behavior: &mut BehaviorInfo) {
        match (self, behavior) {
            (
                Self::SelfTouch(_),
                BehaviorInfo::SelfTouch {
                    right_hand_touches,
                    left_hand_touches,
                },
            ) => {
                right_hand_touches.clear();
                left_hand_touches.clear();
            }
            (Self::None, info) => *info = BehaviorInfo::None,
            (Self::SelfTouch(w), info) => {
                let parts = w.own.len();
                *info = BehaviorInfo::SelfTouch {
                    right_hand_touches: Vec::with_capacity(parts),
                    left_hand_touches: Vec::with_capacity(parts),
                };
            }
            (Self::HandRegard(_), info) => {
                *info = BehaviorInfo::HandRegard {
                    right_eye_right_hand: 0,
                    right_eye_left_hand: 0,
                    left_eye_right_hand: 0,
                    left_eye_left_hand: 0,
                };
            }
        }
    }

    /// Angles between the axes of the eyes and the hands, rad, in the order of [`BehaviorInfo::REGARDS`].
    pub fn gaze_angles(&self, s: &State) -> Option<[f64; 4]> {
        match self {
            Self::HandRegard(w) => Some(w.angles(s)),
            _ => None,
        }
    }

    /// Adds what the last step brought.
    pub fn update(&self, s: &State, info: &mut Info) {
        self.count(s, &mut info.behavior);
        self.describe(Some(s), info);
    }

    /// Brings the details up to date; without a state whose poses hold, there are no angles.
    pub fn describe(&self, s: Option<&State>, info: &mut Info) {
        match self {
            Self::None => {}
            Self::SelfTouch(w) => info.details.name_parts(&info.behavior, &w.names),
            Self::HandRegard(w) => info.details.gaze_angles = s.map(|s| w.angles(s)),
        }
    }

    fn count(&self, s: &State, behavior: &mut BehaviorInfo) {
        match (self, behavior) {
            (
                Self::SelfTouch(w),
                BehaviorInfo::SelfTouch {
                    right_hand_touches,
                    left_hand_touches,
                },
            ) => {
                w.update(s, right_hand_touches, left_hand_touches);
            }
            (
                Self::HandRegard(w),
                BehaviorInfo::HandRegard {
                    right_eye_right_hand,
                    right_eye_left_hand,
                    left_eye_right_hand,
                    left_eye_left_hand,
                },
            ) => {
                let [right, left] = [0, 1].map(|eye| w.hands.map(|hand| w.sees(s, eye, hand)));
                *right_eye_right_hand += u64::from(right[0]);
                *right_eye_left_hand += u64::from(right[1]);
                *left_eye_right_hand += u64::from(left[0]);
                *left_eye_left_hand += u64::from(left[1]);
            }
            _ => {}
        }
    }
}

fn body(model: &Model, name: &str, purpose: &'static str) -> Result<usize, EnvError> {
    let missing = || EnvError::Missing {
        what: "body",
        name: name.to_string(),
        purpose,
    };
    model.body(name).map(|b| b.0).ok_or_else(missing)
}

/// Which geoms are palms, and which are MIMo's.
#[derive(Clone, Debug)]
pub(crate) struct SelfTouch {
    right_palm: Vec<bool>,
    left_palm: Vec<bool>,
    own: Vec<bool>,
    names: PartNames,
}

impl SelfTouch {
    fn new(model: &Model) -> Result<Self, EnvError> {
        let purpose = "behavior self_touch";
        let (right, left) = (body(model, "right_hand", purpose)?, body(model, "left_hand", purpose)?);
        let hip = body(model, "hip", purpose)?;
        let of = |f: &dyn Fn(usize) -> bool| model.geom_bodyid.iter().map(|&b| f(b)).collect::<Vec<bool>>();
        Ok(Self {
            right_palm: of(&|b| b == right),
            left_palm: of(&|b| b == left),
            own: of(&|b| model.in_subtree(b, hip)),
            names: PartNames::new(model),
        })
    }

    /// A contact counts for the first rule that fits: right palm as first geom, as second, left palm as first, as second.
    fn update(&self, s: &State, right: &mut Vec<usize>, left: &mut Vec<usize>) {
        for c in &s.contacts {
            let [a, b] = c.geom;
            let (list, other) = if self.right_palm[a] {
                (&mut *right, b)
            } else if self.right_palm[b] {
                (&mut *right, a)
            } else if self.left_palm[a] {
                (&mut *left, b)
            } else if self.left_palm[b] {
                (&mut *left, a)
            } else {
                continue;
            };
            if self.own[other] && !list.contains(&other) {
                list.push(other);
            }
        }
    }
}

/// Eyes (right, left) and hands (right, left).
#[derive(Clone, Debug)]
pub(crate) struct HandRegard {
    eyes: [usize; 2],
    cameras: [usize; 2],
    hands: [usize; 2],
    compat: Compat,
    cos_half_angle: f64,
}

impl HandRegard {
    fn new(model: &Model, compat: Compat) -> Result<Self, EnvError> {
        let purpose = "behavior hand_regard";
        let camera = |name: &str| {
            let missing = || EnvError::Missing {
                what: "camera",
                name: name.to_string(),
                purpose,
            };
            model.camera(name).map(|c| c.0).ok_or_else(missing)
        };
        Ok(Self {
            eyes: [body(model, "right_eye", purpose)?, body(model, "left_eye", purpose)?],
            cameras: [camera("eye_right")?, camera("eye_left")?],
            hands: [body(model, "right_hand", purpose)?, body(model, "left_hand", purpose)?],
            compat,
            cos_half_angle: pxfm::f_cos(FIELD_OF_VIEW.to_radians()),
        })
    }

    /// Whether the origin of a hand lies less than 15 degrees off the axis of an eye.
    fn sees(&self, s: &State, eye: usize, hand: usize) -> bool {
        let (axis, direction) = self.axis_and_direction(s, eye, hand);
        within_cone(axis, direction, self.cos_half_angle)
    }

    /// The axis of an eye's camera and the way from it to the origin of a hand; under `compat: reference` the -z axis of the
    /// eye's body, which points down the face.
    fn axis_and_direction(&self, s: &State, eye: usize, hand: usize) -> (Vec3, Vec3) {
        let (origin, axis) = match self.compat {
            Compat::Api => (
                s.cam_xpos[self.cameras[eye]],
                scale(column(&s.cam_xmat[self.cameras[eye]], 2), -1.0),
            ),
            Compat::Reference => (s.xpos[self.eyes[eye]], scale(column(&s.xmat[self.eyes[eye]], 2), -1.0)),
        };
        (axis, sub(s.xpos[hand], origin))
    }

    /// Angles between the axes and the hands, rad, in the order of [`BehaviorInfo::REGARDS`].
    fn angles(&self, s: &State) -> [f64; 4] {
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(eye, hand)| {
            let (axis, direction) = self.axis_and_direction(s, eye, self.hands[hand]);
            let length = norm(direction);
            if length == 0.0 {
                return f64::INFINITY;
            }
            pxfm::f_acos((dot(axis, direction) / length).clamp(-1.0, 1.0))
        })
    }
}

/// Whether `direction` is strictly inside the cone about the unit vector `axis`; a zero direction is not.
fn within_cone(axis: Vec3, direction: Vec3, cos_half_angle: f64) -> bool {
    let length = norm(direction);
    length > 0.0 && dot(axis, direction) > cos_half_angle * length
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cone_is_15_degrees_wide() {
        let cos = pxfm::f_cos(FIELD_OF_VIEW.to_radians());
        let axis = [0.0, 0.0, -1.0];
        assert!(within_cone(axis, [0.1, 0.0, -0.4], cos));
        assert!(!within_cone(axis, [0.11, 0.0, -0.4], cos));
        assert!(!within_cone(axis, [0.0; 3], cos));
    }
}
