//! From controls to joint forces and unconstrained acceleration.

use super::applied::xfrc_accumulate;
use super::articulated::{Articulated, Damping};
use super::{activation, muscle, transmission};
use crate::model::{BiasType, GainType, Model};
use crate::state::State;
use crate::topology::Topology;

/// Computes `act_dot, actuator_force, qfrc_actuator, qfrc_smooth, qacc_smooth`.
///
/// An actuator gives `clamp(gain ctrl + bias)`, times its gear on the joint or the tendon; its length and velocity are gear times
/// those of the joint or the tendon. What all actuators together do to a joint may be limited. Where it has an activation, that takes the place of the control. Where muscles of an actuation model take its place, `clamp(gain ctrl torque)` acts on the joint itself. Controls out
/// of range are clamped. `bodies` must be up to date.
#[doc(alias = "mj_fwdActuation")]
#[inline(always)]
pub fn fwd_actuation(model: &Model, topology: &Topology, bodies: &mut Articulated, s: &mut State) {
    let mut forces = std::mem::take(&mut s.qfrc_actuator);
    forces.fill(0.0);
    let acting = if model.opt.flags.actuation { model.nu() } else { 0 };
    s.actuator_force[acting..].fill(0.0);
    for i in 0..acting {
        // muscles take the place of motors; a servo among them remains a servo
        let muscle = s.muscle_torque.get(i).copied();
        let muscle = muscle.filter(|_| model.actuator_biastype[i] == BiasType::None);
        let gear = if muscle.is_some() {
            1.0
        } else {
            s.params.actuator_gear[i]
        };
        let mut ctrl = s.ctrl[i];
        if model.actuator_ctrllimited[i] && model.opt.flags.clampctrl {
            let [lo, hi] = model.actuator_ctrlrange[i];
            ctrl = ctrl.max(lo).min(hi);
        }
        if let Some(k) = model.actuator_actadr[i] {
            s.act_dot[k] = activation::rate(model, i, s.act[k], ctrl);
            ctrl = activation::acting(model, i, s.act[k], s.act_dot[k]);
        }
        let motion = motion(model, topology, s, i, gear);
        // a disabled actuator still has the least force of its range, as in MuJoCo
        let mut force = if model.actuator_disabled(i) {
            0.0
        } else {
            gain_and_bias(model, i, ctrl, motion)
        };
        if let Some(torque) = muscle {
            force *= torque;
        }
        if s.params.actuator_forcelimited[i] {
            let [lo, hi] = model.actuator_forcerange[i];
            force = force.max(lo).min(hi);
        }
        s.actuator_force[i] = force;
        transmission::moment(model, topology, s, (i, gear), |d, arm| forces[d] += arm * force);
    }
    s.qfrc_actuator = forces;
    // as in MuJoCo, without actuators nothing compensates gravity, and there is no force that is too small, either
    if acting > 0 {
        limit_joint_forces(model, s);
    }
    for d in 0..model.nv {
        s.qfrc_smooth[d] = s.qfrc_passive[d] - s.qfrc_bias[d] + s.qfrc_applied[d] + s.qfrc_actuator[d];
    }
    xfrc_accumulate(model, s);
    let mut acc = std::mem::take(&mut s.qacc_smooth);
    bodies.solve(s, Damping::Without, &s.qfrc_smooth, &mut acc);
    s.qacc_smooth = acc;
}

/// Returns the length of an actuator with this gear, and its rate, which the velocity stage has computed if its gear was the same.
#[inline(always)]
fn motion(model: &Model, topology: &Topology, s: &State, i: usize, gear: f64) -> [f64; 2] {
    if gear == transmission::gear(s, i) {
        return [s.actuator_length[i], s.actuator_velocity[i]];
    }
    [
        transmission::length(model, topology, s, i, gear),
        transmission::velocity(model, topology, s, i, gear),
    ]
}

/// Adds gravity compensation that counts as actuator force, and limits the sum on each joint.
#[inline(always)]
fn limit_joint_forces(model: &Model, s: &mut State) {
    for d in 0..model.nv {
        if model.jnt_actgravcomp[model.dof_jntid[d]] {
            s.qfrc_actuator[d] += s.qfrc_gravcomp[d];
        }
    }
    for (j, &[low, high]) in model.jnt_actfrcrange.iter().enumerate() {
        if model.jnt_actfrclimited[j] {
            let force = &mut s.qfrc_actuator[model.jnt_dofadr[j]];
            *force = force.max(low).min(high);
        }
    }
}

/// Returns the force of an actuator from its control or activation, its length and its velocity.
#[inline(always)]
fn gain_and_bias(model: &Model, i: usize, ctrl: f64, [length, velocity]: [f64; 2]) -> f64 {
    let affine = |p: &[f64; 10]| p[0] + p[1] * length + p[2] * velocity;
    let gain = match model.actuator_gaintype[i] {
        GainType::Fixed => model.actuator_gainprm[i][0],
        GainType::Affine => affine(&model.actuator_gainprm[i]),
        GainType::Muscle => muscle::gain(model, i, length, velocity),
    };
    let force = gain * ctrl;
    match model.actuator_biastype[i] {
        BiasType::None => force,
        BiasType::Affine => force + affine(&model.actuator_biasprm[i]),
        BiasType::Muscle => force + muscle::bias(model, i, length),
    }
}
