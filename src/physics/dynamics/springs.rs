//! Parameters of springs and servos that follow from their rest configuration and the inertia at `qpos0`.

use super::stages::{com_pos, kinematics};
use super::tendons;
use super::transmission::moment;
use crate::math::MINVAL;
use crate::model::Arrays;
use crate::state::State;
use crate::topology::Topology;

/// Returns the bias of an actuator, with the damping that follows from its damping ratio.
///
/// That of a servo with gain `k` on a mass `m` is `2 ratio sqrt(k m)`; the mass is that of the joints at `qpos0`, seen through the
/// gear.
pub(super) fn bias(model: &Arrays, topology: &Topology, s: &State, actuator: usize, dof_m0: &[f64]) -> [f64; 10] {
    let (k, mut bias) = (model.actuator_gainprm[actuator][0], model.actuator_biasprm[actuator]);
    let [_, stiffness, ratio, ..] = bias;
    if k != -stiffness || ratio <= 0.0 {
        return bias;
    }
    let gear = model.actuator_gear[actuator];
    let mut mass = 0.0;
    moment(model, topology, s, (actuator, gear), |d, arm| {
        let square = arm * arm;
        if square > MINVAL {
            mass += dof_m0[d] / square;
        }
    });
    bias[2] = -(ratio * 2.0 * (k * mass).sqrt());
    bias
}

/// Returns stiffness of the joints and damping of the degrees of freedom: as given, or those for which an isolated joint has the time constant and
/// the damping ratio of its `springdamper`.
pub(super) fn springs(model: &Arrays, dof_invweight0: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut stiffness, mut damping) = (model.jnt_stiffness.clone(), model.dof_damping.clone());
    for (j, &[timeconst, ratio]) in model.jnt_springdamper.iter().enumerate() {
        if timeconst <= 0.0 || ratio <= 0.0 {
            continue;
        }
        let dofs = model.jnt_dofadr[j]..model.jnt_dofadr[j] + model.jnt_type[j].nv();
        let weight: f64 = dof_invweight0[dofs.clone()].iter().sum();
        let inertia = dofs.len() as f64 / weight.max(MINVAL);
        stiffness[j] = inertia / (timeconst * timeconst * ratio * ratio).max(MINVAL);
        damping[dofs].fill(2.0 * inertia / timeconst.max(MINVAL));
    }
    (stiffness, damping)
}

/// Returns the lengths between which each tendon's spring is slack: as given, or else that in the springs' rest configuration.
pub(super) fn slack(model: &Arrays, topology: &Topology) -> Vec<[f64; 2]> {
    const AT_REST: [f64; 2] = [-1.0; 2];
    let mut lengths = model.tendon_lengthspring.clone();
    if lengths.contains(&AT_REST) {
        let mut s = State::new(model, topology);
        s.qpos.clone_from(&model.qpos_spring);
        kinematics(model, &mut s);
        com_pos(model, &mut s);
        tendons(model, topology, &mut s);
        let found = lengths.iter_mut().zip(&s.ten_length);
        let at_rest = found.filter(|(length, _)| **length == AT_REST);
        at_rest.for_each(|(length, &found)| *length = [found; 2]);
    }
    lengths
}
