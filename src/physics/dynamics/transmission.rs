//! What actuators act on: their lengths, and how these change with the coordinates.

use crate::model::{Arrays, Model, TrnType};
use crate::physics::state::State;
use crate::physics::topology::Topology;

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
pub(super) fn length(model: &Model, s: &State, actuator: usize) -> f64 {
    let id = model.actuator_trnid[actuator];
    match model.actuator_trntype[actuator] {
        TrnType::Joint | TrnType::JointInParent => s.qpos[model.jnt_qposadr[id]],
        TrnType::Tendon => s.ten_length[id],
    }
}

/// Returns the rate of [`length`].
#[inline(always)]
pub(super) fn velocity(model: &Model, topology: &Topology, s: &State, actuator: usize) -> f64 {
    let moment = moment(model, topology, s, actuator);
    moment.map(|(d, arm)| arm * s.qvel[d]).sum()
}

/// Iterates over the degrees of freedom that an actuator acts on, with the derivative of [`length`] by each.
#[inline(always)]
pub(super) fn moment<'a>(
    model: &Arrays,
    topology: &'a Topology,
    s: &'a State,
    actuator: usize,
) -> impl Iterator<Item = (usize, f64)> + use<'a> {
    let id = model.actuator_trnid[actuator];
    let (joint, dofs, arms): (_, &[u32], &[f64]) = match model.actuator_trntype[actuator] {
        TrnType::Joint | TrnType::JointInParent => (Some(model.jnt_dofadr[id]), &[], &[]),
        TrnType::Tendon => (None, topology.tendons.row(id), &s.ten_j[topology.tendons.range(id)]),
    };
    let joint = joint.into_iter().map(|d| (d, 1.0));
    joint.chain(dofs.iter().zip(arms).map(|(&d, &arm)| (d as usize, arm)))
}
