//! The stretch reflex: a muscle that is stretched pulls back. The answer of its antagonist, which in newborns is half as strong, is left
//! out: in a torque motor it would only weaken the answer.

use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop, ramp};
use crate::actuation::ActuationError;
use crate::config::Config;
use crate::mimo::reflexes::{STRETCH, STRETCH_AGES, STRETCH_SHARES, at_age};
use crate::model::Model;
use crate::physics::State;

/// The motors of a limb that have it. Those of hands move too little mass for a delayed answer.
const LIMBS: [&str; 9] = [
    "shoulder_horizontal",
    "shoulder_abduction",
    "shoulder_internal",
    "elbow",
    "hip_flex",
    "hip_abduction",
    "hip_rotation",
    "knee",
    "foot_flexion",
];

struct Stretch {
    motors: Vec<Motor>,
    /// Share of a motor's strength at the fastest stretch.
    share: f64,
}

/// Builds the loop for the limbs that are actuated.
///
/// # Errors
/// MIMo has no motors of limbs.
pub(super) fn build(config: &Config, motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let names = ["left", "right"]
        .into_iter()
        .flat_map(|side| LIMBS.map(|limb| format!("{side}_{limb}")));
    let found: Vec<Motor> = names.filter_map(|name| motors.find(&name)).collect();
    if found.is_empty() {
        return Err(motors.missing("a motor of arms or legs"));
    }
    let share = at_age(&STRETCH_AGES, &STRETCH_SHARES, config.age);
    Ok(Built {
        inner: Box::new(Stretch { motors: found, share }),
        // velocities are those at the end of a physics step, when the next is driven
        inside: -1000.0 * motors.model.opt.timestep,
    })
}

impl ReflexLoop for Stretch {
    fn channels(&self) -> usize {
        self.motors.len()
    }

    fn memory(&self) -> usize {
        0
    }

    /// Writes the velocities of the joints, rad/s.
    fn sense(&self, _model: &Model, state: &State, stimulus: &mut [f64]) {
        for (motor, out) in self.motors.iter().zip(stimulus) {
            *out = state.qvel[motor.dof];
        }
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        let [threshold, width] = STRETCH;
        let mut most: f64 = 0.0;
        for (motor, velocity) in self.motors.iter().zip(input.stimulus) {
            let level = ramp(velocity.abs(), threshold, width) * input.gain;
            if level > 0.0 {
                motor.push(-velocity.signum() * level * self.share, commands);
            }
            most = most.max(level);
        }
        most
    }
}
