//! Two opposing muscles per actuator.

use crate::actuation::curves::{force_length, force_velocity, passive};
use crate::actuation::{Actuation, ActuationError, named};
use crate::config::Compat;
use crate::env::BoxSpace;
use crate::mimo::MimoJoints;
use crate::model::{BiasType, Model};
use crate::physics::{Params, State};

/// Lengths of a muscle, in optimal lengths, at the two ends of its joint's range.
const LENGTH_RANGE: [f64; 2] = [0.75, 1.05];
/// Time constant of activation, s.
const TAU: f64 = 0.01;
/// What the reference adds to numerators and denominators.
const EPSILON: f64 = 1e-10;
/// Factor by which the damping of MIMo's joints is divided.
const DAMPING_DIVISOR: f64 = 20.0;

/// Geometry and strength of the two muscles of one actuator, after Wochner et al. 2022.
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
    /// From the joint's range and spring reference (rad). Nothing is checked.
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

    /// Of an actuator: its user data are `vmax`, and the isometric maximum of muscle 1 and of muscle 2.
    ///
    /// # Errors
    /// An actuator that is not a motor, a number that is not allowed.
    pub fn of_actuator(model: &Model, actuator: usize) -> Result<Self, ActuationError> {
        let name = || model.actuator_name[actuator].clone();
        if model.actuator_biastype[actuator] != BiasType::None {
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

    /// Lengths of both muscles at an angle (rad), in optimal lengths.
    #[inline]
    pub fn lengths(&self, angle: f64) -> [f64; 2] {
        let phi = angle - self.springref;
        [0, 1].map(|k| phi * self.moment[k] + self.lce_ref[k])
    }

    /// Forces of both muscles, relative to their isometric maxima, at an angle (rad) and velocity (rad/s) of the joint:
    /// `FL(length) FV(velocity) activity + FP(length)`.
    #[inline]
    pub fn forces(&self, angle: f64, velocity: f64, activity: [f64; 2]) -> [f64; 2] {
        let length = self.lengths(angle);
        [0, 1].map(|k| {
            let speed = force_velocity(velocity * self.moment[k], self.vmax);
            force_length(length[k]) * speed * activity[k] + passive(length[k])
        })
    }

    /// Torque of relative forces on the joint, N m.
    #[inline]
    pub fn torque(&self, forces: [f64; 2]) -> f64 {
        -(self.moment[0] * forces[0] * self.fmax[0] + self.moment[1] * forces[1] * self.fmax[1])
    }
}

/// Activity after a time step of `h` seconds in which the muscle was told to reach `target`: `a' = (target - a) / 10 ms`,
/// one Euler step, kept in [0, 1].
#[inline]
fn activate(activity: f64, target: f64, h: f64) -> f64 {
    (activity + h * (target - activity) / TAU).clamp(0.0, 1.0)
}

/// The muscle model: an action is the excitation, in [0, 1], of muscle 1 of every actuator, then of muscle 2.
///
/// Before each physics step the activities move towards the excitations, and the torque of both muscles becomes the
/// actuator's gear, at control 1. Muscles replace the springs of MIMo's joints: stiffness is 0, damping a twentieth, and
/// the motors' force limits are off. Excitation 0 is not torque 0, as stretched muscles pull passively.
///
/// A reset sets all activities to 0. The torques, and the forces that are observed, are then the passive ones at the start
/// of the episode. Under `compat: reference` the forces are those of the scene's `qpos0`, and nothing pulls until the next
/// step or start action: controls are 0, gears those of the last step.
#[derive(Clone, Debug)]
pub struct Muscle {
    space: BoxSpace,
    params: Vec<MuscleParams>,
    /// Coordinate of each actuator's joint in `qpos` and in `qvel`.
    address: Vec<(usize, usize)>,
    /// Activities (2 nu), 0..1.
    activity: Vec<f64>,
    /// Excitations (2 nu), 0..1.
    target: Vec<f64>,
    /// Forces (2 nu), relative to the isometric maximum.
    force: Vec<f64>,
    /// Torques (nu), N m.
    torque: Vec<f64>,
    compat: Compat,
}

impl Muscle {
    /// For the motors of `model`, whose user data are the muscles' parameters.
    ///
    /// # Errors
    /// As [`MuscleParams::of_actuator`].
    pub fn new(model: &Model, compat: Compat) -> Result<Self, ActuationError> {
        let n = model.nu();
        let params: Vec<MuscleParams> = (0..n)
            .map(|i| MuscleParams::of_actuator(model, i))
            .collect::<Result<_, _>>()?;
        let address = |&j: &usize| (model.jnt_qposadr[j], model.jnt_dofadr[j]);
        let mut muscle = Self {
            space: BoxSpace::new(vec![0.0; 2 * n], vec![1.0; 2 * n]),
            params,
            address: model.actuator_trnid.iter().map(address).collect(),
            activity: vec![0.0; 2 * n],
            target: vec![0.0; 2 * n],
            force: vec![0.0; 2 * n],
            torque: vec![0.0; n],
            compat,
        };
        muscle.contract(&model.qpos0, &vec![0.0; model.nv]);
        muscle.turn();
        Ok(muscle)
    }

    /// Geometry and strength of the muscles of each actuator.
    pub fn params(&self) -> &[MuscleParams] {
        &self.params
    }

    /// Forces of muscle 1 of every actuator, then of muscle 2, relative to their isometric maxima.
    pub fn forces(&self) -> &[f64] {
        &self.force
    }

    /// Torques on the joints, N m.
    pub fn torques(&self) -> &[f64] {
        &self.torque
    }

    /// Forces at the present activities.
    fn contract(&mut self, qpos: &[f64], qvel: &[f64]) {
        let n = self.params.len();
        let (force1, force2) = self.force.split_at_mut(n);
        let (activity1, activity2) = self.activity.split_at(n);
        for (i, (p, &(q, d))) in self.params.iter().zip(&self.address).enumerate() {
            [force1[i], force2[i]] = p.forces(qpos[q], qvel[d], [activity1[i], activity2[i]]);
        }
    }

    /// Torques of the present forces.
    fn turn(&mut self) {
        let (force1, force2) = self.force.split_at(self.params.len());
        for (i, (t, p)) in self.torque.iter_mut().zip(&self.params).enumerate() {
            *t = p.torque([force1[i], force2[i]]);
        }
    }

    /// One physics step of activation, then forces and torques.
    fn update(&mut self, model: &Model, state: &mut State) {
        for (a, &t) in self.activity.iter_mut().zip(&self.target) {
            *a = activate(*a, t, model.opt.timestep);
        }
        self.contract(&state.qpos, &state.qvel);
        self.turn();
        self.apply(state);
    }

    fn apply(&self, state: &mut State) {
        state.params.actuator_gear.copy_from_slice(&self.torque);
        state.ctrl.fill(1.0);
    }
}

impl Actuation for Muscle {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        [named(model, " muscle 1"), named(model, " muscle 2")].concat()
    }

    fn prepare(&self, model: &Model, params: &mut Params) {
        let joints = MimoJoints::new(model);
        for (&j, &d) in joints.joint.iter().zip(&joints.dof) {
            params.jnt_stiffness[j] = 0.0;
            params.dof_damping[d] /= DAMPING_DIVISOR;
        }
        params.actuator_forcelimited.fill(false);
    }

    fn set_action(&mut self, model: &Model, state: &mut State, action: &[f32]) {
        for (i, (t, &a)) in self.target.iter_mut().zip(action).enumerate() {
            *t = f64::from(self.space.clip(i, a));
        }
        self.update(model, state);
    }

    fn substep(&mut self, model: &Model, state: &mut State) {
        self.update(model, state);
    }

    fn reset(&mut self, _model: &Model, state: &mut State) {
        self.activity.fill(0.0);
        self.target.fill(0.0);
        self.contract(&state.qpos, &state.qvel);
        if self.compat == Compat::Api {
            self.turn();
        }
        self.apply(state);
        if self.compat == Compat::Reference {
            state.ctrl.fill(0.0);
        }
    }

    fn observation_len(&self) -> usize {
        2 * self.activity.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        let endings = [
            " muscle 1 activity",
            " muscle 2 activity",
            " muscle 1 force",
            " muscle 2 force",
        ];
        endings.map(|ending| named(model, ending)).concat()
    }

    /// Activities, 0..1, then forces of muscle 1 of every actuator and of muscle 2, each in single precision times its
    /// isometric maximum.
    fn observe(&self, _model: &Model, _state: &State, out: &mut [f64]) {
        let n = self.params.len();
        for (v, a) in out.iter_mut().zip(&self.activity) {
            *v = *a;
        }
        for (k, (v, f)) in out.iter_mut().skip(2 * n).zip(&self.force).enumerate() {
            *v = f64::from(*f as f32) * self.params[k % n].fmax[k / n];
        }
    }

    /// `sum |a^2 F| / (2n sum F)` over the activities `a` and isometric maxima `F` of the `2n` muscles.
    fn cost(&self, _model: &Model, _state: &State) -> f64 {
        let n = self.params.len();
        let (mut spent, mut total) = (0.0, 0.0);
        for (k, a) in self.activity.iter().enumerate() {
            let fmax = self.params[k % n].fmax[k / n];
            spent += (a * a * fmax).abs();
            total += fmax;
        }
        if total == 0.0 {
            0.0
        } else {
            spent / (self.activity.len() as f64 * total)
        }
    }

    fn activity(&self) -> &[f64] {
        &self.activity
    }

    fn set_activity(&mut self, activity: &[f64]) {
        for (a, &new) in self.activity.iter_mut().zip(activity) {
            *a = new.clamp(0.0, 1.0);
        }
    }

    fn memory(&self) -> Vec<&[f64]> {
        vec![&self.activity, &self.target, &self.force, &self.torque]
    }

    fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        vec![&mut self.activity, &mut self.target, &mut self.force, &mut self.torque]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The right elbow of MIMo v1.
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

    /// Recorded from the reference to 12 digits, which the formulas in exact arithmetic continue to 16.
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

    #[test]
    fn activation_halves_the_gap() {
        let mut a = 0.0;
        for expect in [0.5, 0.75, 0.875, 0.9375, 0.96875] {
            a = activate(a, 1.0, 0.005);
            assert_eq!(a, expect);
        }
        assert_eq!(activate(0.1, 0.0, 0.02), 0.0);
    }
}
