//! The limbs that bring hands before eyes: the numbers of an action that move them, and the control that holds a posture.

use crate::config::ActuationModel;
use crate::env::Env;
use crate::policy::PolicyError;
use crate::sensors::ProprioceptionComponent;
use crate::spaces::{BoxSpace, NumpyRng};

/// Number of hands: right, left.
pub(super) const HANDS: usize = 2;
/// Effort per rad of error, and per rad/s.
const STIFFNESS: f64 = 2.0;
const DAMPING: f64 = 0.15;
/// Movement of a wrist: amplitude, rad, and frequency, Hz.
const SWING: f64 = 0.5;
const RATE: f64 = 4.0;

/// The part that one number of an action moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DrivenPart {
    /// The arm of a hand: the joints above its palm.
    Arm(usize),
    /// The wrist of a hand, which moves only the palm.
    Wrist(usize),
    /// The head.
    Head,
    /// Any other joint.
    Other,
}

impl DrivenPart {
    /// Returns the hand that it moves.
    pub(super) fn hand(self) -> Option<usize> {
        match self {
            Self::Arm(hand) | Self::Wrist(hand) => Some(hand),
            Self::Head | Self::Other => None,
        }
    }
}

/// A joint and the actuator that moves it.
#[derive(Clone, Debug)]
struct DrivenJoint {
    limb: DrivenPart,
    /// Indices of its angle and its velocity in proprioception.
    angle: usize,
    velocity: Option<usize>,
    /// Its range, rad.
    range: [f64; 2],
}

/// The joints that an action moves, in its order.
#[derive(Clone, Debug)]
pub(super) struct DrivenJoints {
    drives: Vec<DrivenJoint>,
    space: BoxSpace,
    kind: ActuationModel,
}

impl DrivenJoints {
    /// Finds the limbs of an environment's MIMo.
    pub(super) fn new(env: &Env) -> Result<Self, PolicyError> {
        let model = env.model();
        let body = |name: &str| {
            let missing = || PolicyError::Other(format!("watching needs MIMo, with a body {name}").into());
            model.body(name).ok_or_else(missing)
        };
        let palms = [body("right_hand")?, body("left_hand")?];
        let (head, trunk) = (body("head")?, body("upper_body")?);
        let limb = |moved: usize| {
            // the neck, the head and the eyes
            if model.in_subtree(moved, head)
                || model.in_subtree(head, moved) && model.in_subtree(moved, trunk) && moved != trunk
            {
                return DrivenPart::Head;
            }
            // the chest of MIMo 3 carries both arms and belongs to neither
            let carries = |hand: usize| model.in_subtree(palms[hand], moved);
            let both = (0..HANDS).all(carries);
            let of = |hand: &usize| moved != trunk && model.in_subtree(moved, trunk) && !both && carries(*hand);
            match (0..HANDS).find(of) {
                Some(hand) if moved == palms[hand] => DrivenPart::Wrist(hand),
                Some(hand) => DrivenPart::Arm(hand),
                None => DrivenPart::Other,
            }
        };
        let senses = env.senses().proprioception();
        let drive = |&actuator: &usize| {
            let joint = model.actuator_trnid[actuator];
            let name = model.jnt_name.get(joint)?;
            let place = |component| senses.find(model, component, name).map(|range| range.start);
            Some(DrivenJoint {
                limb: limb(model.jnt_bodyid[joint]),
                angle: place(ProprioceptionComponent::Angles)?,
                velocity: place(ProprioceptionComponent::Velocities),
                range: model.jnt_range[joint],
            })
        };
        let drives: Option<Vec<DrivenJoint>> = env.blueprint().actuation().actuators().iter().map(drive).collect();
        let drives =
            drives.ok_or_else(|| PolicyError::Other("watching needs to feel all joints that it moves".into()))?;
        for hand in 0..HANDS {
            let moves = |limb: DrivenPart| drives.iter().any(|drive| drive.limb == limb);
            if !moves(DrivenPart::Arm(hand)) || !moves(DrivenPart::Wrist(hand)) {
                return Err(PolicyError::Other(
                    "watching moves arms and wrists: set act_arms: true, act_hands: true".into(),
                ));
            }
        }
        Ok(Self {
            drives,
            space: env.action_space().clone(),
            kind: env.config().actuation_model,
        })
    }

    /// Returns whether an environment has the same body.
    pub(super) fn fits(&self, env: &Env) -> bool {
        let model = env.model();
        self.space.len() == env.action_space().len()
            && env.blueprint().actuation().actuators().len() == self.drives.len()
            && {
                let actuators = env.blueprint().actuation().actuators();
                let ranges = actuators.iter().map(|&a| model.jnt_range.get(model.actuator_trnid[a]));
                ranges
                    .zip(&self.drives)
                    .all(|(range, drive)| range == Some(&drive.range))
            }
    }

    /// Returns the limb of each number of a posture.
    pub(super) fn limbs(&self) -> impl Iterator<Item = DrivenPart> {
        self.drives.iter().map(|drive| drive.limb)
    }

    /// Draws a posture; limbs that do not bring hands before eyes are in the middle of their ranges.
    pub(super) fn random(&self, rng: &mut NumpyRng) -> Vec<f64> {
        let angle = |drive: &DrivenJoint| {
            let [low, high] = drive.range;
            match drive.limb {
                DrivenPart::Other => low.max(0.0_f64.min(high)),
                _ => rng.uniform_in(low, high),
            }
        };
        self.drives.iter().map(angle).collect()
    }

    /// Returns an angle shifted by `share` of half the range of a joint.
    pub(super) fn vary(&self, joint: usize, angle: f64, share: f64) -> f64 {
        let [low, high] = self.drives[joint].range;
        (angle + 0.5 * (high - low) * share).clamp(low, high)
    }

    /// Iterates over the angles of the joints that turn the eyes: those of the neck, and their own.
    pub(super) fn gaze<'a>(&'a self, env: &'a Env) -> impl Iterator<Item = f64> + 'a {
        let felt = env.observation().proprioception;
        let turning = self.drives.iter().filter(|drive| drive.limb == DrivenPart::Head);
        turning.map(move |drive| felt.get(drive.angle).copied().unwrap_or_default())
    }

    /// Writes the action that takes or holds a posture, and moves the wrist of a hand.
    pub(super) fn drive(&self, env: &Env, posture: &[f64], hand: Option<usize>, time: f64, action: &mut Vec<f32>) {
        let felt = env.observation().proprioception;
        let number = |place: usize| felt.get(place).copied().unwrap_or_default();
        let swing = SWING * pxfm::f_sin(std::f64::consts::TAU * RATE * time);
        let n = self.drives.len();
        action.clear();
        action.resize(self.space.len(), 0.0);
        for (k, (drive, &goal)) in self.drives.iter().zip(posture).enumerate() {
            let moved = matches!(drive.limb, DrivenPart::Wrist(own) if Some(own) == hand);
            let goal = if moved { goal + swing } else { goal };
            let off = STIFFNESS * (goal - number(drive.angle));
            let effort = off - DAMPING * drive.velocity.map_or(0.0, number);
            match self.kind {
                ActuationModel::Positional => action[k] = self.space.clip(k, goal as f32),
                // each muscle pulls its own way
                ActuationModel::Muscle if k + n < action.len() => {
                    action[k] = self.space.clip(k, effort.max(0.0) as f32);
                    action[k + n] = self.space.clip(k + n, (-effort).max(0.0) as f32);
                }
                _ => action[k] = self.space.clip(k, effort as f32),
            }
        }
    }
}
