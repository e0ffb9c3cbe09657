//! Checks of a motion.

use super::{Motion, MotionError};
use crate::limits::Limits;
use crate::math::{MINVAL, quat_normalize};
use crate::text::quoted;

/// The largest angle accepted in rad: two turns.
const LARGEST: f64 = 4.0 * std::f64::consts::PI; // larger numbers are most likely degrees
/// The largest distance of the root from the origin, m.
const FAR: f64 = 1000.0;
/// The highest rate, Hz. A thousand frames per physics step would be a mistake.
const HIGHEST: f64 = 200_000.0;

impl Motion {
    /// Checks everything, and normalises the quaternions of the root.
    pub(super) fn check(&mut self, limits: &Limits) -> Result<(), MotionError> {
        self.check_sizes(limits)?;
        let joints = self.names.len();
        for (k, &value) in self.angles.iter().enumerate() {
            if !value.is_finite() || value.abs() > LARGEST {
                return Err(MotionError::Number {
                    frame: k / joints.max(1),
                    name: quoted(&self.names[k % joints.max(1)]),
                    value,
                    expected: "expected an angle in rad, at most two turns (tables and archives in degrees need --degrees)",
                });
            }
        }
        for (frame, (pos, quat)) in self.root.iter_mut().flatten().enumerate() {
            let number = |name: &str, value: f64, expected| MotionError::Number {
                frame,
                name: name.to_string(),
                value,
                expected,
            };
            if let Some(&value) = pos.iter().find(|x| !x.is_finite() || x.abs() > FAR) {
                return Err(number("root_pos", value, "expected a position in m, within 1000 m"));
            }
            let squares: f64 = quat.iter().map(|x| x * x).sum();
            // negated, so that NaN is refused, too
            if !(squares > MINVAL && squares < 1e6) {
                return Err(number("root_quat", quat[0], "expected a unit quaternion, w first"));
            }
            *quat = quat_normalize(*quat);
        }
        Ok(())
    }

    /// Checks lengths, names and the rate.
    fn check_sizes(&self, limits: &Limits) -> Result<(), MotionError> {
        let unfit = |reason: String| Err(MotionError::Unfit(reason));
        let (joints, numbers, frames) = (self.names.len(), self.angles.len(), self.frames());
        if frames == 0 {
            return unfit("the motion has no frames".to_string());
        }
        if numbers != frames * joints {
            return unfit(format!(
                "{numbers} angles are not a whole number of rows of {joints} joints"
            ));
        }
        if let Some(root) = self.root.as_ref().filter(|root| root.len() != frames) {
            return unfit(format!(
                "there are {} poses of the root for {frames} frames",
                root.len()
            ));
        }
        let room = numbers + 7 * self.root.as_ref().map_or(0, Vec::len);
        if room > limits.motion_numbers {
            return unfit(format!(
                "the motion has {room} numbers; the limit motion_numbers is {}",
                limits.motion_numbers
            ));
        }
        let mut names: Vec<&String> = self.names.iter().collect();
        names.sort();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return unfit(format!("{} appears twice among the names of joints", quoted(pair[0])));
        }
        let rate = self.rate;
        if !(rate > 0.0 && rate <= HIGHEST) {
            return unfit(format!(
                "the rate is {rate} Hz; expected more than 0 and at most {HIGHEST}"
            ));
        }
        let seconds = self.seconds();
        if seconds > limits.motion_seconds {
            return unfit(format!(
                "the motion lasts {seconds} s; the limit motion_seconds is {}",
                limits.motion_seconds
            ));
        }
        Ok(())
    }
}
