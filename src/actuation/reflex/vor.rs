//! The vestibulo-ocular reflex: the eyes turn against the head.
//!
//! The canals are a high pass on the head's angular velocity. The velocity that each joint of an eye needs to turn against it follows from
//! the axes of the eye's three joints. The torque is what the eye's own inertia, damper and spring take at that velocity, with a small
//! correction: a proportional loop alone would saturate at a gain of 0.6.

use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop};
use crate::actuation::ActuationError;
use crate::config::{Config, ReflexVor};
use crate::math::{Vec3, cross, dot, mat_vec};
use crate::mimo::reflexes::{CANAL_AGES, CANAL_TIMES, at_age};
use crate::model::{Model, SensorType};
use crate::physics::State;

/// Share of an eye's momentum that the correction restores in a physics step. Our choice.
const CORRECTION: f64 = 0.25;
/// Velocity at which the torque overcomes half of the friction, rad/s. Our choice.
const SLIDING: f64 = 0.05;
/// Velocity of an eye at which the reflex is reported to act fully, rad/s. Our choice.
const FULL: f64 = 1.0;
/// Joints of both eyes.
const JOINTS: usize = 6;
/// Remembered for each joint: the last stimulus, the high pass, the last desired velocity.
const KEPT: usize = 3;

struct Vor {
    eyes: [[Motor; 3]; 2],
    /// Place of the gyroscope's values, and its site.
    gyro: (usize, usize),
    /// Inertia and dry friction of each joint.
    inertia: [f64; JOINTS],
    friction: [f64; JOINTS],
    /// Time constant of the canals, s.
    canal: f64,
    replaces: bool,
}

/// Builds the loop.
///
/// # Errors
/// MIMo has no eye muscles or no gyroscope.
pub(super) fn build(config: &Config, motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let eye = |side: &str| -> Result<[Motor; 3], ActuationError> {
        Ok([
            motors.need(&format!("{side}_eye_horizontal"))?,
            motors.need(&format!("{side}_eye_vertical"))?,
            motors.need(&format!("{side}_eye_torsional"))?,
        ])
    };
    let eyes = [eye("left")?, eye("right")?];
    let of = |values: &[f64]| std::array::from_fn(|k| values[eyes[k / 3][k % 3].dof]);
    Ok(Built {
        inner: Box::new(Vor {
            gyro: motors.sensor(SensorType::Gyro, "a gyroscope in the head")?,
            inertia: of(&motors.model.dof_m0),
            friction: of(&motors.model.dof_frictionloss),
            canal: at_age(&CANAL_AGES, &CANAL_TIMES, config.age),
            replaces: config.reflexes.vor == ReflexVor::Replace,
            eyes,
        }),
        inside: 0.0,
    })
}

/// Returns the velocities about three axes that together are the angular velocity `w`; `None` if the axes lie in a plane.
fn about(axes: [Vec3; 3], w: Vec3) -> Option<Vec3> {
    let [a, b, c] = axes;
    let volume = dot(a, cross(b, c));
    (volume.abs() > 1e-6).then(|| [dot(w, cross(b, c)), dot(a, cross(w, c)), dot(a, cross(b, w))].map(|v| v / volume))
}

impl ReflexLoop for Vor {
    fn channels(&self) -> usize {
        JOINTS
    }

    fn memory(&self) -> usize {
        KEPT * JOINTS
    }

    /// Writes the velocities of the eyes' joints that would turn them with the head, rad/s.
    fn sense(&self, _model: &Model, state: &State, stimulus: &mut [f64]) {
        let (at, site) = self.gyro;
        let felt = [0, 1, 2].map(|k| state.sensordata[at + k]);
        let head = mat_vec(&state.site_xmat[site], felt);
        for (eye, out) in self.eyes.iter().zip(stimulus.chunks_exact_mut(3)) {
            let axes = [0, 1, 2].map(|k| state.xaxis[eye[k].joint]);
            out.copy_from_slice(&about(axes, head).unwrap_or([0.0; 3]));
        }
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        let (state, h) = (input.state, input.h);
        let keep = self.canal / (self.canal + h);
        let mut fastest: f64 = 0.0;
        let kept = input.memory.chunks_exact_mut(KEPT);
        for (k, (motor, kept)) in self.eyes.iter().flatten().zip(kept).enumerate() {
            let turning = input.stimulus[k];
            let canal = keep * (kept[1] + turning - kept[0]);
            let wanted = -input.gain * canal;
            let acceleration = (wanted - kept[2]) / h;
            kept.copy_from_slice(&[turning, canal, wanted]);
            let (angle, velocity) = (state.qpos[motor.qpos], state.qvel[motor.dof]);
            // the springs of eyes rest straight ahead
            let spring = state.params.jnt_stiffness[motor.joint] * angle;
            let mut torque = self.inertia[k] * acceleration
                + state.params.dof_damping[motor.dof] * wanted
                + self.friction[k] * wanted / (wanted.abs() + SLIDING);
            // with an action of their own, the eyes may move differently than with the reflex alone
            if self.replaces {
                torque += spring + self.inertia[k] * CORRECTION / h * (wanted - velocity);
                motor.suppress(1.0, commands);
            }
            motor.add(torque, commands);
            fastest = fastest.max(wanted.abs());
        }
        fastest / FULL
    }
}
