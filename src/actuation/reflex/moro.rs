//! The Moro reflex: when the head drops, the arms spread and stretch, then close. Once started, it runs to its end.

use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop};
use crate::actuation::ActuationError;
use crate::config::Config;
use crate::mimo::reflexes::{
    MORO_CLOSE, MORO_EFFORT, MORO_LATE, MORO_NOTICE, MORO_PAUSE, MORO_SPREAD, MORO_TILT, MORO_WEIGHT,
};
use crate::model::{Model, SensorType};
use crate::physics::State;

/// Angles of shoulder (horizontal, abduction) and elbow with the arms spread, and in the embrace, rad.
const SPREAD: [f64; 3] = [-0.3, 1.4, 0.0];
const EMBRACE: [f64; 3] = [1.4, 0.7, -1.2];
/// Remembered: how long the head has been light, s; the course's time, s, from 1 on, 0 for none; the delays of the left and the right
/// arm, s.
const KEPT: usize = 4;

struct Moro {
    /// The place of the accelerometer's values.
    accelerometer: usize,
    /// The degree of freedom of the neck that tilts the head, positive forwards.
    tilt: usize,
    /// Shoulders and elbow, left and right.
    arms: [[Motor; 2]; 3],
    /// Weight of the head below which it drops, m/s^2.
    light: f64,
    /// Time after which a drop is noticed, s.
    notice: f64,
}

/// Builds the loop.
///
/// # Errors
/// MIMo has no accelerometer, neck or motors of arms.
pub(super) fn build(config: &Config, motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let model = motors.model;
    let tilt = model
        .joint("robot:head_tilt")
        .ok_or_else(|| motors.missing("the joint robot:head_tilt"))?;
    let [x, y, z] = model.opt.gravity;
    let notice = config.reflex_delays.moro.map_or(MORO_NOTICE, |ms| ms.min(MORO_NOTICE));
    Ok(Built {
        inner: Box::new(Moro {
            accelerometer: motors
                .sensor(SensorType::Accelerometer, "an accelerometer in the head")?
                .0,
            tilt: model.jnt_dofadr[tilt],
            arms: [
                motors.pair("shoulder_horizontal")?,
                motors.pair("shoulder_abduction")?,
                motors.pair("elbow")?,
            ],
            light: MORO_WEIGHT * (x * x + y * y + z * z).sqrt(),
            notice: notice / 1000.0,
        }),
        inside: notice,
    })
}

impl ReflexLoop for Moro {
    fn channels(&self) -> usize {
        2
    }

    fn memory(&self) -> usize {
        KEPT
    }

    /// Writes whether the head is light, and how fast it tilts backwards, rad/s.
    fn sense(&self, _model: &Model, state: &State, stimulus: &mut [f64]) {
        let [x, y, z] = [0, 1, 2].map(|k| state.sensordata[self.accelerometer + k]);
        let light = x * x + y * y + z * z < self.light * self.light;
        stimulus.copy_from_slice(&[f64::from(u8::from(light)), -state.qvel[self.tilt]]);
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        let h = input.h;
        let [light, course, ..] = input.memory else { return 0.0 };
        *light = if input.stimulus[0] == 0.0 { 0.0 } else { *light + h };
        // half a step: sums of steps are not exact
        let drops = *light > self.notice - h / 2.0 || input.stimulus[1] > MORO_TILT;
        let whole = MORO_SPREAD + MORO_CLOSE;
        if *course > 0.0 {
            *course += h;
            if *course > 1.0 + whole + MORO_PAUSE {
                *course = 0.0;
            }
        } else if drops {
            *course = 1.0;
            let [share, late] = MORO_LATE;
            let left_is_late = input.rng.uniform() < share;
            input.memory[2] = if left_is_late { late } else { 0.0 };
            input.memory[3] = late - input.memory[2];
        }
        let course = input.memory[1];
        if course == 0.0 {
            return 0.0;
        }
        let mut acts = false;
        for side in 0..2 {
            let time = course - 1.0 - input.memory[2 + side] + h / 2.0;
            let angles = if time < 0.0 || time > whole {
                continue;
            } else if time < MORO_SPREAD {
                SPREAD
            } else {
                EMBRACE
            };
            acts = true;
            for (motor, angle) in self.arms.iter().zip(angles) {
                motor[side].pull(input.state, angle, MORO_EFFORT * input.gain.min(1.0), commands);
            }
        }
        if acts { input.gain } else { 0.0 }
    }
}
