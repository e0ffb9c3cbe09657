//! What actuators act on: their lengths, and how these change with the coordinates.

use crate::model::{Arrays, Model, TrnType};
use crate::physics::dynamics::tendon_length;
use crate::physics::state::State;

/// Returns the gear by which an actuator's length follows from what it acts on. Muscles of an actuation model act on joints themselves.
pub(super) fn gear(s: &State, actuator: usize) -> f64 {
    if s.muscle_torque.is_empty() {
        s.params.actuator_gear[actuator]
    } else {
        1.0
    }
}

/// Returns the coordinate of a joint or the length of a tendon that an actuator acts on, without its gear.
#[inline(always)]
pub(super) fn length(model: &Model, qpos: &[f64], actuator: usize) -> f64 {
    let id = model.actuator_trnid[actuator];
    match model.actuator_trntype[actuator] {
        TrnType::Joint | TrnType::JointInParent => qpos[model.jnt_qposadr[id]],
        TrnType::Tendon => tendon_length(model, qpos, id),
    }
}

/// Returns the rate of [`length`].
#[inline(always)]
pub(super) fn velocity(model: &Model, qvel: &[f64], actuator: usize) -> f64 {
    moment(model, actuator).map(|(d, arm)| arm * qvel[d]).sum()
}

/// Iterates over the degrees of freedom that an actuator acts on, with the derivative of [`length`] by each.
#[inline(always)]
pub(super) fn moment(model: &Arrays, actuator: usize) -> impl Iterator<Item = (usize, f64)> {
    let id = model.actuator_trnid[actuator];
    let (joint, wrap): (_, &[(usize, f64)]) = match model.actuator_trntype[actuator] {
        TrnType::Joint | TrnType::JointInParent => (Some(model.jnt_dofadr[id]), &[]),
        TrnType::Tendon => (None, &model.tendon_wrap[id]),
    };
    let joint = joint.into_iter().map(|d| (d, 1.0));
    joint.chain(wrap.iter().map(|&(j, coef)| (model.jnt_dofadr[j], coef)))
}
