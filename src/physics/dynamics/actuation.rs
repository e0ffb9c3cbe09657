//! From controls to joint forces and unconstrained acceleration.

use crate::model::{BiasType, Model};
use crate::physics::dynamics::applied::xfrc_accumulate;
use crate::physics::dynamics::articulated::{Articulated, Damping};
use crate::physics::state::State;

/// Computes `actuator_force, qfrc_actuator, qfrc_smooth, qacc_smooth`.
///
/// An actuator gives `clamp(gain ctrl + bias)`, times its gear on the joint; its length and velocity are gear times
/// those of the joint. Where muscles take its place, `clamp(gain ctrl torque)` acts on the joint itself. Controls out
/// of range are clamped. `bodies` must be up to date.
#[inline(always)]
pub fn fwd_actuation(model: &Model, bodies: &mut Articulated, s: &mut State) {
    s.qfrc_actuator.fill(0.0);
    for i in 0..model.nu() {
        let j = model.actuator_trnid[i];
        let (d, q) = (model.jnt_dofadr[j], model.jnt_qposadr[j]);
        let muscle = s.muscle_torque.get(i).copied();
        let gear = if muscle.is_some() {
            1.0
        } else {
            s.params.actuator_gear[i]
        };
        let mut ctrl = s.ctrl[i];
        if model.actuator_ctrllimited[i] {
            let [lo, hi] = model.actuator_ctrlrange[i];
            ctrl = ctrl.max(lo).min(hi);
        }
        let mut force = model.actuator_gainprm[i][0] * ctrl;
        if model.actuator_biastype[i] == BiasType::Affine {
            let p = model.actuator_biasprm[i];
            force += p[0] + p[1] * (gear * s.qpos[q]) + p[2] * (gear * s.qvel[d]);
        }
        if let Some(torque) = muscle {
            force *= torque;
        }
        if s.params.actuator_forcelimited[i] {
            let [lo, hi] = model.actuator_forcerange[i];
            force = force.max(lo).min(hi);
        }
        s.actuator_force[i] = force;
        s.qfrc_actuator[d] += gear * force;
    }
    for d in 0..model.nv {
        s.qfrc_smooth[d] = s.qfrc_passive[d] - s.qfrc_bias[d] + s.qfrc_applied[d] + s.qfrc_actuator[d];
    }
    xfrc_accumulate(model, s);
    let mut acc = std::mem::take(&mut s.qacc_smooth);
    bodies.solve(model, s, Damping::Without, &s.qfrc_smooth, &mut acc);
    s.qacc_smooth = acc;
}
