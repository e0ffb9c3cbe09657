//! Stepping: an upright infant whose soles carry weight bends and stretches his legs in turn. Two half-centres share a cycle; each bends its leg in
//! its own half and stretches it in the other.

use super::contacts::{Watched, side};
use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop, follow, ramp};
use crate::actuation::ActuationError;
use crate::mimo::reflexes;
use crate::model::Model;
use crate::physics::State;

/// Angles of hip and knee of the leg that swings and of the one that stands, rad. Our choice.
const SWING: [f64; 2] = [-1.0, -1.2];
const STANCE: [f64; 2] = [0.0, -0.1];

struct Stepping {
    watched: Watched,
    /// Hips and knees, left and right.
    legs: [[Motor; 2]; 2],
    trunk: usize,
    /// MIMo's weight, N.
    weight: f64,
}

/// Builds the loop.
///
/// # Errors
/// MIMo has no trunk, or no motors of legs.
pub(super) fn build(motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let model = motors.model;
    let body = |name: &str| {
        model
            .body(name)
            .ok_or_else(|| motors.missing(&format!("the body {name}")))
    };
    let [x, y, z] = model.opt.gravity;
    let sole = |body: &str| {
        side(body)
            .filter(|(_, name)| ["foot", "toes", "big_toe"].contains(name))
            .map(|(side, _)| side)
    };
    Ok(Built {
        inner: Box::new(Stepping {
            watched: Watched::new(model, sole),
            legs: [motors.pair("hip_flex")?, motors.pair("knee")?],
            trunk: body("upper_body")?,
            weight: model.body_subtreemass[body(crate::mimo::ROOT)?] * (x * x + y * y + z * z).sqrt(),
        }),
        inside: 0.0,
    })
}

impl ReflexLoop for Stepping {
    fn channels(&self) -> usize {
        1
    }

    fn memory(&self) -> usize {
        2
    }

    /// Writes the share of the weight that the soles carry while the trunk is upright.
    fn sense(&self, model: &Model, state: &State, stimulus: &mut [f64]) {
        let mut load = 0.0;
        self.watched
            .each(model, state, |pressed| load += pressed.world[2].max(0.0));
        // the last of a rotation matrix is the cosine of the tilt
        let upright = state.xmat[self.trunk][8] > reflexes::UPRIGHT;
        stimulus[0] = if upright && self.weight > 0.0 {
            load / self.weight
        } else {
            0.0
        };
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        let [threshold, width] = reflexes::STEPPING;
        let [level, phase] = input.memory else { return 0.0 };
        follow(
            level,
            ramp(input.stimulus[0], threshold, width),
            reflexes::STEPPING_TIMES,
            input.h,
        );
        if *level < 0.01 {
            // the next walk begins with the same leg
            *phase = 0.0;
            return 0.0;
        }
        *phase = (*phase + input.h / reflexes::STEP_CYCLE).fract();
        let swinging = usize::from(*phase >= 0.5);
        let effort = (*level * input.gain).min(1.0);
        for (joint, pair) in self.legs.iter().enumerate() {
            for (side, motor) in pair.iter().enumerate() {
                let angle = if side == swinging { SWING[joint] } else { STANCE[joint] };
                motor.pull(input.state, angle, effort * reflexes::STEPPING_EFFORT, commands);
                motor.suppress(effort, commands);
            }
        }
        effort
    }
}
