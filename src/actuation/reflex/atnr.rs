//! The asymmetric tonic neck reflex: when the head is turned, the arm and leg on the face's side stretch and the others bend.

use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop, follow, ramp};
use crate::actuation::ActuationError;
use crate::config::Config;
use crate::mimo::reflexes::{ATNR, ATNR_ARM_AGES, ATNR_ARM_GAINS, ATNR_EFFORT, ATNR_TIMES, at_age};
use crate::model::Model;
use crate::physics::State;

struct Atnr {
    /// The index in `qpos` of the neck's angle, positive to the left.
    neck: usize,
    /// Elbows and knees, left and right; both stretch in the positive direction.
    limbs: [[Motor; 2]; 2],
    /// The shares of elbows and knees in the effort.
    shares: [f64; 2],
}

/// Builds the loop.
///
/// # Errors
/// MIMo has no neck, or no motors of arms or legs.
pub(super) fn build(config: &Config, motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let neck = motors.model.joint("robot:head_swivel");
    Ok(Built {
        inner: Box::new(Atnr {
            neck: motors.model.jnt_qposadr[neck.ok_or_else(|| motors.missing("the joint robot:head_swivel"))?],
            limbs: [motors.pair("elbow")?, motors.pair("knee")?],
            shares: [at_age(&ATNR_ARM_AGES, &ATNR_ARM_GAINS, config.age), 1.0],
        }),
        inside: 0.0,
    })
}

impl ReflexLoop for Atnr {
    fn channels(&self) -> usize {
        1
    }

    fn memory(&self) -> usize {
        2
    }

    /// Writes the angle of the neck, rad.
    fn sense(&self, _model: &Model, state: &State, stimulus: &mut [f64]) {
        stimulus[0] = state.qpos[self.neck];
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        let [threshold, width] = ATNR;
        let mut most: f64 = 0.0;
        for (face, level) in input.memory.iter_mut().enumerate() {
            let turned = if face == 0 {
                input.stimulus[0]
            } else {
                -input.stimulus[0]
            };
            follow(level, ramp(turned, threshold, width), ATNR_TIMES, input.h);
            let effort = *level * input.gain * ATNR_EFFORT;
            for (limb, share) in self.limbs.iter().zip(self.shares) {
                limb[face].push(effort * share, commands);
                limb[1 - face].push(-effort * share, commands);
            }
            most = most.max(*level * input.gain);
        }
        most
    }
}
