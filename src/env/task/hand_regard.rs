//! Hand regard: hands in the central field of view of the eyes.

use super::scene::TaskScene;
use super::starts::random_start;
use super::{Task, TaskEvent, TaskSizes, body};
use crate::config::{Compat, Config};
use crate::env::{BehaviorInfo, EnvError, Info, PerEyeAndHand, RegardCounts, missing_camera};
use crate::math::*;
use crate::model::Model;
use crate::physics::State;

/// Half of the central field of view, degrees.
const FIELD_OF_VIEW: f64 = 15.0;

/// MIMo looks at his hands: the bodies and cameras of the eyes (right, left), and the bodies of the hands (right, left).
#[derive(Clone, Debug, Default)]
pub(super) struct HandRegard {
    eyes: [usize; 2],
    cameras: [usize; 2],
    hands: [usize; 2],
    compat: Compat,
    cos_half_angle: f64,
    /// Steps in which a hand was in view under the rule that the information does not use.
    other: [u64; 4],
}

impl HandRegard {
    /// Returns whether the origin of a hand is less than 15 degrees off the axis of an eye (0 right, 1 left, both).
    fn sees(&self, s: &State, eye: usize, hand: usize) -> bool {
        let (axis, direction) = self.axis_and_direction(s, self.compat, eye, hand);
        within_cone(axis, direction, self.cos_half_angle)
    }

    /// Returns whether the other rule counts a hand.
    fn sees_otherwise(&self, s: &State, eye: usize, hand: usize) -> bool {
        let other = match self.compat {
            Compat::Api => Compat::Reference,
            Compat::Reference => Compat::Api,
        };
        let (axis, direction) = self.axis_and_direction(s, other, eye, hand);
        within_cone(axis, direction, self.cos_half_angle)
    }

    /// Returns the axis of an eye's camera and the vector from it to the origin of a hand; under `compat: reference` the -z axis of the
    /// eye's body, which points down the face.
    fn axis_and_direction(&self, s: &State, compat: Compat, eye: usize, hand: usize) -> (Vec3, Vec3) {
        let (origin, axis) = match compat {
            Compat::Api => (
                s.cam_xpos[self.cameras[eye]],
                scale(column(&s.cam_xmat[self.cameras[eye]], 2), -1.0),
            ),
            Compat::Reference => (s.xpos[self.eyes[eye]], scale(column(&s.xmat[self.eyes[eye]], 2), -1.0)),
        };
        (axis, sub(s.xpos[self.hands[hand]], origin))
    }

    /// Computes the angles between the axes and the hands, rad; infinite for a hand at the eye.
    fn angles(&self, s: &State) -> PerEyeAndHand<f64> {
        PerEyeAndHand::from_fn(|eye, hand| {
            let (axis, direction) = self.axis_and_direction(s, self.compat, eye, hand);
            let length = norm(direction);
            if length == 0.0 {
                return f64::INFINITY;
            }
            pxfm::f_acos((dot(axis, direction) / length).clamp(-1.0, 1.0))
        })
    }
}

impl Task for HandRegard {
    fn name(&self) -> &str {
        "hand_regard"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        let purpose = "behavior hand_regard";
        let camera = |name: &str| model.camera(name).ok_or_else(|| missing_camera(name, purpose));
        *self = Self {
            eyes: [body(model, "right_eye", purpose)?, body(model, "left_eye", purpose)?],
            cameras: [camera("eye_right")?, camera("eye_left")?],
            hands: [body(model, "right_hand", purpose)?, body(model, "left_hand", purpose)?],
            compat: config.compat,
            cos_half_angle: pxfm::f_cos(FIELD_OF_VIEW.to_radians()),
            other: [0; 4],
        };
        Ok(TaskSizes::default())
    }

    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        random_start(scene, |_| Ok(()))
    }

    fn forget(&mut self) {
        self.other = [0; 4];
    }

    fn count(&mut self, state: &State) {
        let seen = PerEyeAndHand::from_fn(|eye, hand| u64::from(self.sees_otherwise(state, eye, hand))).to_array();
        for (count, seen) in self.other.iter_mut().zip(seen) {
            *count += seen;
        }
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.extend(self.other.map(|count| count as f64));
    }

    fn load(&mut self, numbers: &[f64]) {
        for (count, number) in self.other.iter_mut().zip(numbers) {
            // numbers from an untrusted snapshot must not overflow the counters
            *count = (*number as u64).min(1 << 52);
        }
    }

    fn inform(&self, event: TaskEvent<'_>, info: &mut Info) {
        info.details.gaze_angles = None;
        match (event, &mut info.behavior) {
            (TaskEvent::Step(state), BehaviorInfo::HandRegard { counts }) => {
                let seen = PerEyeAndHand::from_fn(|eye, hand| u64::from(self.sees(state, eye, hand))).to_array();
                let sums = counts.to_array();
                *counts = std::array::from_fn(|k| sums[k] + seen[k]).into();
                info.details.gaze_angles = Some(self.angles(state));
            }
            (TaskEvent::Start, behavior) => {
                let counts = PerEyeAndHand::default();
                *behavior = BehaviorInfo::HandRegard { counts };
            }
            _ => {}
        }
        if let BehaviorInfo::HandRegard { counts } = info.behavior {
            let other = PerEyeAndHand::from(self.other);
            let (page, kit) = match self.compat {
                Compat::Api => (counts, other),
                Compat::Reference => (other, counts),
            };
            info.details.regards = Some(RegardCounts { page, kit });
        }
    }
}

/// Returns whether `direction` is strictly inside the cone about the unit vector `axis`. A zero direction is not.
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
