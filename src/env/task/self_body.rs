//! Touching a part of his own body.

use super::pose::{Angles, free_address, own_joint, set_angles};
use super::scene::{TaskScene, TaskView};
use super::starts::relax;
use super::{Goal, StepReward, Task, TaskDocument, TaskSizes, body, spacing};
use crate::config::{Compat, Config};
use crate::env::EnvError;
use crate::math::{norm, sub};
use crate::model::Model;
use crate::sensors::Touch;

const PURPOSE: &str = "behavior selfbody";
/// Length of a goal: the reference's number of geoms. Entries of bodies and of parts of the body are numbered by body.
const GOAL: usize = 37;
/// Reward of success.
const BONUS: f64 = 500.0;
/// Reward without contact.
const NOTHING: f64 = -1.0;
/// Physics steps in which the sitting pose settles.
const SETTLING: u32 = 25;
/// Bodies that are not targets: the last ones of [`TOUCH`].
const OWN: usize = 2;

/// Bodies with touch sensors and the distances between them, m.
const TOUCH: &[(&str, f64)] = &[
    ("left_foot", 0.05),
    ("right_foot", 0.05),
    ("left_lower_leg", 0.1),
    ("right_lower_leg", 0.1),
    ("left_upper_leg", 0.1),
    ("right_upper_leg", 0.1),
    ("hip", 0.1),
    ("lower_body", 0.1),
    ("upper_body", 0.1),
    ("head", 0.1),
    ("left_upper_arm", 0.01),
    ("left_lower_arm", 0.01),
    ("right_fingers", 0.01),
];

/// Position and orientation of the base of the sitting MIMo.
const BASE: [f64; 7] = [
    0.0579584,
    -0.00157173,
    0.0566738,
    0.892294,
    -0.0284863,
    -0.450353,
    -0.0135029,
];
/// Joint angles at which all joints of the sitting MIMo except those of the right arm are locked.
const SITTING: &Angles = &[
    ("hip_lean1", 0.039088),
    ("hip_rot1", 0.113112),
    ("hip_bend1", 0.5323),
    ("hip_lean2", 0.0),
    ("hip_rot2", 0.0),
    ("hip_bend2", 0.5323),
    ("head_swivel", 0.0),
    ("head_tilt", 0.0),
    ("head_tilt_side", 0.0),
    ("left_eye_horizontal", 0.0),
    ("left_eye_vertical", 0.0),
    ("left_eye_torsional", 0.0),
    ("right_eye_horizontal", 0.0),
    ("right_eye_vertical", 0.0),
    ("right_eye_torsional", 0.0),
    ("left_shoulder_horizontal", 0.683242),
    ("left_shoulder_ad_ab", 0.3747),
    ("left_shoulder_rotation", -0.62714),
    ("left_elbow", -0.756016),
    ("left_hand1", 0.28278),
    ("left_hand2", 0.0),
    ("left_hand3", 0.0),
    ("left_fingers", -0.461583),
    ("right_hip1", -1.51997),
    ("right_hip2", -0.397578),
    ("right_hip3", 0.0976615),
    ("right_knee", -1.85479),
    ("right_foot1", -0.585865),
    ("right_foot2", -0.358165),
    ("right_foot3", 0.0),
    ("right_toes", 0.0),
    ("left_hip1", -1.23961),
    ("left_hip2", -0.8901),
    ("left_hip3", 0.7156),
    ("left_knee", -2.531),
    ("left_foot1", -0.63562),
    ("left_foot2", 0.5411),
    ("left_foot3", 0.366514),
    ("left_toes", 0.24424),
];

/// MIMo sits, all his joints except those of the right arm are locked, and he touches a part of himself with the right hand.
///
/// The desired goal has a 1 at the number of the target's body, the achieved goal a 1 at each part that the right hand or its fingers
/// touch. The reward is 500 on success; otherwise, if the fingers feel anything, minus their distance from the target, m; otherwise -1.
/// Terms: whether the fingers feel anything, and the distances from them to all possible targets.
///
/// Under `compat: reference` the achieved goal is zero, any touch of the target is a success and the left forearm counts as a finger, as
/// in the Python code, where a force counts if a component is positive. The distance is that from the body of the geom whose number is
/// the target's.
#[derive(Clone, Debug, Default)]
pub(super) struct SelfBody {
    base: usize,
    fingers: usize,
    hand: usize,
    /// Bodies with touch sensors, in the order of [`TOUCH`].
    skin: Vec<usize>,
    /// Bodies to which distances are measured, one for each target.
    aims: Vec<usize>,
    reference: bool,
}

impl SelfBody {
    fn targets(&self) -> &[usize] {
        &self.skin[..self.skin.len().saturating_sub(OWN)]
    }

    /// Returns whether one of the bodies in `by` touches a body with any force.
    fn touches(&self, view: &TaskView<'_>, by: &[usize], body: usize) -> bool {
        view.state.contact.iter().any(|c| {
            let [a, b] = c.geom.map(|g| view.model.geom_bodyid[g]);
            let felt = c.force.iter().take(3).any(|f| *f != 0.0);
            felt && (by.contains(&a) && b == body || by.contains(&b) && a == body)
        })
    }

    fn achieve_as_reference(&self, touch: &Touch, desired: &[f64], terms: &mut [f64]) {
        let positive = |body: usize| touch.body_values(body).iter().any(|v| *v > 0.0);
        let target = self
            .targets()
            .iter()
            .find(|body| desired.get(**body).is_some_and(|v| *v > 0.0));
        let own = &self.skin[self.skin.len().saturating_sub(OWN)..];
        let found = [
            target.is_some_and(|&body| positive(body)),
            own.iter().any(|&body| positive(body)),
        ];
        for (term, found) in terms.iter_mut().zip(found) {
            *term = f64::from(u8::from(found));
        }
    }
}

impl Task for SelfBody {
    fn name(&self) -> &str {
        "selfbody"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn document(&self, config: &Config) -> TaskDocument {
        TaskDocument {
            touch_spacing: spacing(TOUCH),
            ..TaskDocument::of(config)
        }
    }

    fn bind(&mut self, config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        self.base = free_address(model, body(model, "mimo_location", PURPOSE)?, PURPOSE)?;
        self.fingers = body(model, "right_fingers", PURPOSE)?;
        self.hand = body(model, "right_hand", PURPOSE)?;
        self.skin = TOUCH
            .iter()
            .map(|(name, _)| body(model, name, PURPOSE))
            .collect::<Result<_, _>>()?;
        self.reference = config.compat == Compat::Reference;
        let aim = |&body: &usize| {
            if self.reference {
                model.geom_bodyid.get(body).copied().unwrap_or(body)
            } else {
                body
            }
        };
        self.aims = self.targets().iter().map(aim).collect();
        Ok(TaskSizes {
            goal: GOAL,
            terms: 2 + self.aims.len(),
            observation: 0,
        })
    }

    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        set_angles(scene.model, SITTING, &mut scene.state.qpos, PURPOSE)?;
        scene.steps(1)?;
        // again, because the step has moved the joints
        set_angles(scene.model, SITTING, &mut scene.state.qpos, PURPOSE)?;
        scene.state.qpos[self.base..self.base + 7].copy_from_slice(&BASE);
        for &(joint, angle) in SITTING {
            scene.lock(&own_joint(joint), angle, !self.reference)?;
        }
        relax(scene, SETTLING)?;
        scene.state.qvel.fill(0.0);
        Ok(())
    }

    fn begin(&mut self, scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        let target = self.targets()[scene.rng.below(self.aims.len())];
        desired.fill(0.0);
        if let Some(hot) = desired.get_mut(target) {
            *hot = 1.0;
        }
    }

    fn achieve(&self, view: &TaskView<'_>, desired: &[f64], achieved: &mut [f64], terms: &mut [f64]) {
        let Some(touch) = view.touch else { return };
        let xpos = &view.state.xpos;
        for (term, &aim) in terms[2..].iter_mut().zip(&self.aims) {
            *term = norm(sub(xpos[self.fingers], xpos[aim]));
        }
        achieved.fill(0.0);
        if self.reference {
            return self.achieve_as_reference(touch, desired, terms);
        }
        for &target in self.targets() {
            if let Some(achieved) = achieved.get_mut(target) {
                *achieved = f64::from(u8::from(self.touches(view, &[self.hand, self.fingers], target)));
            }
        }
        // any force on the fingers counts for the reward, the touched target for success
        let felt = touch.body_values(self.fingers).iter().any(|v| *v != 0.0);
        (terms[0], terms[1]) = (0.0, f64::from(u8::from(felt)));
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        let both = goal
            .achieved
            .iter()
            .zip(goal.desired)
            .any(|(a, d)| *a > 0.0 && *d > 0.0);
        let is_success = both || goal.terms.first().is_some_and(|touched| *touched > 0.0);
        let felt = goal.terms.get(1).is_some_and(|felt| *felt > 0.0);
        let distances = self.targets().iter().zip(goal.terms.iter().skip(2));
        let wanted = distances.filter(|(body, _)| goal.desired.get(**body).is_some_and(|d| *d > 0.0));
        let nearest = wanted.map(|(_, distance)| *distance).reduce(f64::min);
        let reward = match nearest {
            _ if is_success => BONUS,
            Some(nearest) if felt => -nearest,
            _ => NOTHING,
        };
        StepReward {
            reward,
            is_success,
            is_failure: false,
        }
    }
}
