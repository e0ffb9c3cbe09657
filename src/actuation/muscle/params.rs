//! Geometry and strength of the muscles of an actuator.

use crate::actuation::curves::{force_length, force_velocity, passive};
use crate::actuation::{ActuationError, MotorCommand};
use crate::model::{BiasType, DynType, GainType, Model};

/// Lengths of a muscle, in optimal lengths, at the two ends of its joint's range.
const LENGTH_RANGE: [f64; 2] = [0.75, 1.05];
/// A number that is added to numerators and denominators, as in the reference.
const EPSILON: f64 = 1e-10;
/// The geometry and strength of the two muscles of one actuator, after Wochner et al. 2022.
///
/// A muscle's length is linear in the joint's angle. Muscle 1 pulls the joint to negative angles and is long at large
/// ones, muscle 2 is its mirror image. The force curves are in [`crate::actuation::curves`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MuscleParams {
    /// Change of length with the angle, 1/rad: positive for muscle 1, negative for muscle 2.
    pub moment: [f64; 2],
    /// Lengths at the angle `springref`.
    pub lce_ref: [f64; 2],
    /// Angle at which the muscles have their reference lengths, rad.
    pub springref: f64,
    /// Fastest shortening, optimal lengths per second.
    pub vmax: f64,
    /// Isometric maximum of muscles 1 and 2, times `moment` a torque in N m.
    pub fmax: [f64; 2],
}

impl MuscleParams {
    /// Derives the parameters from the joint's range and spring reference (rad). Nothing is checked.
    pub fn new(range: [f64; 2], springref: f64, vmax: f64, fmax: [f64; 2]) -> Self {
        let phi = range.map(|angle| angle - springref);
        let [shortest, longest] = LENGTH_RANGE;
        let moment = [
            (longest - shortest + EPSILON) / (phi[1] - phi[0] + EPSILON),
            (longest - shortest + EPSILON) / (phi[0] - phi[1] - EPSILON),
        ];
        Self {
            lce_ref: [shortest - moment[0] * phi[0], shortest - moment[1] * phi[1]],
            moment,
            springref,
            vmax,
            fmax,
        }
    }

    /// Reads the parameters of an actuator: its user data are `vmax`, and the isometric maximum of muscle 1 and of
    /// muscle 2.
    ///
    /// # Errors
    /// An actuator that is not a motor, a number that is not allowed.
    pub fn of_actuator(model: &Model, actuator: usize) -> Result<Self, ActuationError> {
        let name = || model.actuator_name[actuator].clone();
        let motor = model.actuator_biastype[actuator] == BiasType::None
            && model.actuator_gaintype[actuator] == GainType::Fixed
            && model.actuator_dyntype[actuator] == DynType::None;
        if !motor {
            return Err(ActuationError::Kind {
                actuator: name(),
                model: "muscle",
                needs: "motor",
            });
        }
        let check = |what, value: f64, fits: bool, allowed| {
            if value.is_finite() && fits {
                Ok(value)
            } else {
                Err(ActuationError::Parameter {
                    actuator: name(),
                    what,
                    value,
                    allowed,
                })
            }
        };
        let user = |k: usize| model.actuator_user[actuator].get(k).copied().unwrap_or(f64::NAN);
        let [vmax, negative, positive] = [0, 1, 2].map(user);
        check("vmax, user[0],", vmax, vmax > 0.0, "finite and above 0")?;
        let not_negative = "finite and not negative";
        check(
            "the force of muscle 1, user[1],",
            negative,
            negative >= 0.0,
            not_negative,
        )?;
        check(
            "the force of muscle 2, user[2],",
            positive,
            positive >= 0.0,
            not_negative,
        )?;
        let joint = model.actuator_trnid[actuator];
        let range @ [lo, hi] = model.jnt_range[joint];
        let limited = model.jnt_limited[joint];
        check(
            "the width of its joint's range",
            hi - lo,
            limited && hi > lo,
            "finite, limited and above 0",
        )?;
        let springref = model.qpos_spring[model.jnt_qposadr[joint]];
        check("the springref of its joint", springref, true, "finite")?;
        Ok(Self::new(range, springref, vmax, [negative, positive]))
    }

    /// Returns the lengths of both muscles at an angle (rad), in optimal lengths.
    #[inline]
    pub fn lengths(&self, angle: f64) -> [f64; 2] {
        let phi = angle - self.springref;
        [0, 1].map(|k| phi * self.moment[k] + self.lce_ref[k])
    }

    /// Returns the forces of both muscles, relative to their isometric maxima, at an angle (rad) and velocity (rad/s)
    /// of the joint: `FL(length) FV(velocity) activity + FP(length)`.
    #[inline]
    pub fn forces(&self, angle: f64, velocity: f64, activity: [f64; 2]) -> [f64; 2] {
        let length = self.lengths(angle);
        [0, 1].map(|k| {
            let speed = force_velocity(velocity * self.moment[k], self.vmax);
            force_length(length[k]) * speed * activity[k] + passive(length[k])
        })
    }

    /// Returns the activities, 0..1, that add the torque of a reflex at an angle (rad) and velocity (rad/s) of the joint. Where the action is
    /// suppressed, the torque also replaces the pull of the stretched muscles.
    #[inline]
    pub(crate) fn activities(&self, angle: f64, velocity: f64, command: &MotorCommand) -> [f64; 2] {
        let length = self.lengths(angle);
        let at_rest = self.torque(length.map(passive));
        let torque = command.torque - command.suppress * at_rest;
        // muscle 1 pulls to negative angles
        let muscle = usize::from(torque > 0.0);
        let speed = force_velocity(velocity * self.moment[muscle], self.vmax);
        let most = (self.moment[muscle] * self.fmax[muscle] * force_length(length[muscle]) * speed).abs();
        let mut activities = [0.0; 2];
        activities[muscle] = if most > 0.0 {
            (torque.abs() / most).min(1.0)
        } else {
            0.0
        };
        activities
    }

    /// Returns the torque of relative forces on the joint, N m.
    #[inline]
    pub fn torque(&self, forces: [f64; 2]) -> f64 {
        -(self.moment[0] * forces[0] * self.fmax[0] + self.moment[1] * forces[1] * self.fmax[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuation::muscle::activate;

    /// Returns the parameters of the right elbow of MIMo v1.
    fn elbow() -> MuscleParams {
        let range = [-146f64.to_radians(), 5f64.to_radians()];
        MuscleParams::new(range, -20f64.to_radians(), 1.566, [35.43, 27.04])
    }

    fn close(a: f64, b: f64, what: &str) {
        assert!((a - b).abs() <= 1e-12, "{what}: {a} is not {b}");
    }

    #[test]
    fn geometry_of_the_elbow() {
        let p = elbow();
        close(p.moment[0], 0.113_832_674_562_927_59, "moment");
        assert_eq!(p.moment[0], -p.moment[1]);
        close(p.lce_ref[0], 1.000_331_125_901_759_8, "lce_1_ref");
        close(p.lce_ref[1], 0.799_668_874_186_857_1, "lce_2_ref");
    }

    /// The figures are the reference's to 12 digits, continued to 16 by the formulas in exact arithmetic.
    #[test]
    fn worked_cases_of_the_elbow() {
        // angle, velocity, activities before, excitations, forces, torque
        let cases = [
            (
                (0.0, 0.0),
                [0.0, 0.0],
                [1.0, 0.0],
                [0.496_315_029_707_061, 0.0],
                -2.001_684_006_927_329_3,
            ),
            (
                (0.0, 0.0),
                [0.0, 0.0],
                [0.0, 1.0],
                [0.000_774_203_056_737_4, 0.340_856_923_109_440_3],
                1.046_047_284_739_560_4,
            ),
            (
                (-1.0, 0.5),
                [0.3, 0.1],
                [1.0, 0.2],
                [0.665_109_231_178_804_5, 0.126_334_598_407_554_9],
                -2.293_584_111_773_304,
            ),
            (
                (-2.5, -3.0),
                [1.0, 1.0],
                [1.0, 1.0],
                [0.407_318_284_961_052_9, 1.187_850_981_315_947_6],
                2.013_495_535_226_999,
            ),
            (
                (0.08, 4.0),
                [0.5, 0.5],
                [0.0, 0.0],
                [0.297_401_237_071_010_3, 0.081_659_194_864_950_3],
                -0.948_096_546_490_998_7,
            ),
        ];
        let p = elbow();
        for ((q, v), before, target, expect, torque) in cases {
            let activity = [0, 1].map(|k| activate(before[k], target[k], 0.005));
            let forces = p.forces(q, v, activity);
            close(forces[0], expect[0], "force 1");
            close(forces[1], expect[1], "force 2");
            close(p.torque(forces), torque, "torque");
        }
        let [l1, l2] = p.lengths(-1.0);
        close(l1, 0.926_233_550_688_317_8, "length 1");
        close(l2, 0.873_766_449_400_299, "length 2");
    }
}
