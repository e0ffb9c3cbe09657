//! Two opposing muscles per actuator.

mod params;

use super::{Actuation, ActuationError, MotorCommand, named};
use crate::config::Compat;
use crate::mimo::{MimoBodies, MimoJoints};
use crate::model::Model;
use crate::physics::State;
use crate::spaces::BoxSpace;

pub use params::MuscleParams;

/// Time constant of activation, s.
const TAU: f64 = 0.01;
/// Factor by which the damping of MIMo's joints is divided.
const DAMPING_DIVISOR: f64 = 20.0;

/// Returns the activation after a time step of `h` seconds towards `target`: `a' = (target - a) / 10 ms`, one Euler step, kept in [0, 1].
#[inline]
fn activate(act: f64, target: f64, h: f64) -> f64 {
    (act + h * (target - act) / TAU).clamp(0.0, 1.0)
}

/// Drives each joint by two opposing muscles: an action is the excitation, in [0, 1], of muscle 1 of every actuator,
/// then of muscle 2.
///
/// Before each physics step the activations ([`State::act`]) move towards the excitations ([`State::actuator_target`]),
/// and their forces ([`State::muscle_force`]) and torques ([`State::muscle_torque`]) follow. Muscles replace the
/// springs of MIMo's joints: stiffness is 0, damping a twentieth, and the motors' force limits are off. Excitation 0 is
/// not torque 0, because stretched muscles pull passively.
///
/// A reset sets all activations to 0. The torques, and the forces that are observed, are then the passive ones at the
/// start of the episode. Under `compat: reference` the forces are those of the scene's `qpos0`, and nothing pulls until
/// the next step or start action: controls are 0, torques those of the last step.
#[derive(Clone, Debug)]
pub struct MuscleModel {
    space: BoxSpace,
    actuators: Vec<usize>,
    params: Vec<MuscleParams>,
    joints: Vec<JointAddress>,
    compat: Compat,
}

/// The addresses of the joint of an actuator.
#[derive(Clone, Copy, Debug)]
struct JointAddress {
    qposadr: usize,
    dofadr: usize,
}

impl MuscleModel {
    /// Builds the actuation for the motors of MIMo in `model`, whose user data are the muscles' parameters.
    ///
    /// # Errors
    /// As [`MuscleParams::of_actuator`].
    pub fn new(model: &Model, compat: Compat) -> Result<Self, ActuationError> {
        let actuators = MimoBodies::of(model).actuators();
        let n = actuators.len();
        let params: Vec<MuscleParams> = actuators
            .iter()
            .map(|&i| MuscleParams::of_actuator(model, i))
            .collect::<Result<_, _>>()?;
        let joint = |&i: &usize| {
            let j = model.actuator_trnid[i];
            JointAddress {
                qposadr: model.jnt_qposadr[j],
                dofadr: model.jnt_dofadr[j],
            }
        };
        Ok(Self {
            space: BoxSpace::new(vec![0.0; 2 * n], vec![1.0; 2 * n]),
            params,
            joints: actuators.iter().map(joint).collect(),
            actuators,
            compat,
        })
    }

    /// Returns geometry and strength of the muscles of each actuator.
    pub fn params(&self) -> &[MuscleParams] {
        &self.params
    }

    /// Reserves the muscles' values in a state that was not prepared.
    fn make_room(&self, state: &mut State) {
        let n = self.params.len();
        for values in [&mut state.act, &mut state.actuator_target, &mut state.muscle_force] {
            values.resize(2 * n, 0.0);
        }
        // one for each actuator of the scene; those that are not MIMo's have no muscles, and the control 0
        let all = state.ctrl.len();
        state.muscle_torque.resize(all, 0.0);
    }

    /// Computes `muscle_force` from `qpos, qvel, act`.
    fn update_forces(&self, state: &mut State) {
        let n = self.params.len();
        let (force1, force2) = state.muscle_force.split_at_mut(n);
        let (act1, act2) = state.act.split_at(n);
        for (i, (p, joint)) in self.params.iter().zip(&self.joints).enumerate() {
            let (angle, velocity) = (state.qpos[joint.qposadr], state.qvel[joint.dofadr]);
            [force1[i], force2[i]] = p.forces(angle, velocity, [act1[i], act2[i]]);
        }
    }

    /// Computes `muscle_torque` from `muscle_force`.
    fn update_torques(&self, state: &mut State) {
        let (force1, force2) = state.muscle_force.split_at(self.params.len());
        for (k, (&i, p)) in self.actuators.iter().zip(&self.params).enumerate() {
            state.muscle_torque[i] = p.torque([force1[k], force2[k]]);
        }
    }

    /// Makes one physics step of activation, then updates forces and torques.
    fn update(&self, model: &Model, state: &mut State) {
        self.make_room(state);
        for (a, &target) in state.act.iter_mut().zip(&state.actuator_target) {
            *a = activate(*a, target, model.opt.timestep);
        }
        self.update_forces(state);
        self.update_torques(state);
        // controls scale the muscles' torques, which apply in full
        self.set_controls(state, 1.0);
    }

    /// Sets the controls of MIMo's actuators.
    fn set_controls(&self, state: &mut State, ctrl: f64) {
        for &i in &self.actuators {
            state.ctrl[i] = ctrl;
        }
    }
}

impl Actuation for MuscleModel {
    fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    fn actuators(&self) -> &[usize] {
        &self.actuators
    }

    fn action_names(&self, model: &Model) -> Vec<String> {
        let block = |ending| named(model, &self.actuators, ending);
        [" muscle 1", " muscle 2"].map(block).concat()
    }

    fn prepare(&self, model: &Model, state: &mut State) {
        let joints = MimoJoints::new(model);
        let params = &mut state.params;
        for (&j, &d) in joints.joint.iter().zip(&joints.dof) {
            params.jnt_stiffness[j] = 0.0;
            params.dof_damping[d] /= DAMPING_DIVISOR;
        }
        // the motors' limits do not apply to muscles, whose limits are in the isometric maxima
        for &i in &self.actuators {
            params.actuator_forcelimited[i] = false;
        }
        self.make_room(state);
        state.act.fill(0.0);
        state.actuator_target.fill(0.0);
        self.update_forces(state);
        self.update_torques(state);
    }

    fn set_action(&self, model: &Model, state: &mut State, action: &[f32]) {
        self.make_room(state);
        for (i, (t, &a)) in state.actuator_target.iter_mut().zip(action).enumerate() {
            *t = f64::from(self.space.clip(i, a));
        }
        self.update(model, state);
    }

    fn substep(&self, model: &Model, state: &mut State) {
        self.update(model, state);
    }

    fn drive(&self, model: &Model, state: &mut State, action: &[f32], commands: &[MotorCommand]) {
        self.make_room(state);
        let n = self.params.len();
        let gain = TAU / model.opt.timestep;
        for (k, (command, joint)) in commands.iter().zip(&self.joints).enumerate() {
            let (angle, velocity) = (state.qpos[joint.qposadr], state.qvel[joint.dofadr]);
            let reflex = self.params[k].activities(angle, velocity, command);
            for (at, reflex) in [k, n + k].into_iter().zip(reflex) {
                let own = f64::from(self.space.clip(at, action[at])) + reflex;
                // where the action is suppressed, the excitation that gives the required activation at once
                let exact = state.act[at] + gain * (reflex - state.act[at]);
                let target = own * (1.0 - command.suppress) + exact * command.suppress;
                state.actuator_target[at] = target.clamp(0.0, 1.0);
            }
        }
        self.update(model, state);
    }

    fn strength(&self, _model: &Model) -> Vec<[f64; 2]> {
        let torques = |p: &MuscleParams| [0, 1].map(|muscle| p.moment[muscle].abs() * p.fmax[muscle]);
        self.params.iter().map(torques).collect()
    }

    fn reset(&self, _model: &Model, state: &mut State) {
        self.make_room(state);
        state.act.fill(0.0);
        state.actuator_target.fill(0.0);
        self.update_forces(state);
        // in the Python code a reset clears the controls, and torques stay those of the last step
        let pulls = self.compat == Compat::Api;
        if pulls {
            self.update_torques(state);
        }
        state.ctrl.fill(0.0);
        if pulls {
            self.set_controls(state, 1.0);
        }
    }

    fn observation_len(&self) -> usize {
        4 * self.params.len()
    }

    fn observation_names(&self, model: &Model) -> Vec<String> {
        let endings = [
            " muscle 1 activity",
            " muscle 2 activity",
            " muscle 1 force",
            " muscle 2 force",
        ];
        endings.map(|ending| named(model, &self.actuators, ending)).concat()
    }

    /// Writes activations, 0..1, then forces of muscle 1 of every actuator and of muscle 2, each in single precision
    /// times its isometric maximum.
    fn observe(&self, _model: &Model, state: &State, out: &mut [f64]) {
        let n = self.params.len();
        for (v, a) in out.iter_mut().zip(&state.act) {
            *v = *a;
        }
        for (k, (v, f)) in out.iter_mut().skip(2 * n).zip(&state.muscle_force).enumerate() {
            *v = f64::from(*f as f32) * self.params[k % n].fmax[k / n];
        }
    }

    /// Returns `sum |a^2 F| / (2n sum F)` over the activations `a` and isometric maxima `F` of the `2n` muscles.
    fn cost(&self, _model: &Model, state: &State) -> f64 {
        let n = self.params.len();
        let (mut spent, mut total) = (0.0, 0.0);
        for (k, a) in state.act.iter().enumerate() {
            let fmax = self.params[k % n].fmax[k / n];
            spent += (a * a * fmax).abs();
            total += fmax;
        }
        if total == 0.0 {
            0.0
        } else {
            spent / (state.act.len() as f64 * total)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
