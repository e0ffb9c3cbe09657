//! Energies of a model.

use crate::math::*;
use crate::model::{JointType, Model};
use crate::spatial::*;
use crate::state::State;

/// Returns the potential energy of gravity and of the springs of joints and tendons, J.
#[doc(alias = "mj_energyPos")]
pub(super) fn potential(model: &Model, s: &State) -> f64 {
    let weights = (1..model.nbody()).map(|b| s.params.body_mass[b] * dot(s.params.gravity, s.xipos[b]));
    let mut energy = -weights.sum::<f64>();
    if !model.opt.flags.passive {
        return energy;
    }
    for j in 0..model.njnt() {
        let (k, q) = (s.params.jnt_stiffness[j], model.jnt_qposadr[j]);
        let scalars = match model.jnt_type[j] {
            JointType::Free => 3,
            JointType::Ball => 0,
            JointType::Slide | JointType::Hinge => 1,
        };
        let mut place = [0.0; 3];
        place[..scalars].copy_from_slice(&s.qpos[q..q + scalars]);
        if model.jnt_type[j] == JointType::Free && k != 0.0 {
            // MuJoCo 3.3.0 takes the first four coordinates for the quaternion that it normalises
            place.copy_from_slice(&quat_normalize(quat_at(&s.qpos, q))[..3]);
        }
        let squares =
            (0..scalars).map(|i| (place[i] - model.qpos_spring[q + i]) * (place[i] - model.qpos_spring[q + i]));
        energy += 0.5 * k * squares.sum::<f64>();
        if let Some(at) = model.jnt_type[j].quat(q) {
            let turn = rotation_between(quat_at(&model.qpos_spring, at), quat_normalize(quat_at(&s.qpos, at)));
            energy += 0.5 * k * dot(turn, turn);
        }
    }
    for (t, &[shortest, longest]) in model.tendon_lengthspring.iter().enumerate() {
        let length = s.ten_length[t];
        let stretched = (length - longest).max(0.0) + (shortest - length).max(0.0);
        energy += 0.5 * model.tendon_stiffness[t] * stretched * stretched;
    }
    // as in MuJoCo, which leaves out that of elasticity
    for flex in model.flexes.iter().filter(|flex| !flex.rigid) {
        for (k, rest) in flex
            .edge_length0
            .iter()
            .enumerate()
            .filter(|(k, _)| !flex.edge_rigid[*k])
        {
            let stretched = rest - s.flexedge_length[flex.edgeadr + k];
            energy += 0.5 * flex.edgestiffness * stretched * stretched;
        }
    }
    energy
}

/// Returns the kinetic energy, J, including that of the motors' rotors.
#[doc(alias = "mj_energyVel")]
pub(super) fn kinetic(model: &Model, s: &State) -> f64 {
    let bodies = (1..model.nbody()).map(|b| dot6(&s.cvel[b], &inertia_mul(&s.cinert[b], &s.cvel[b])));
    let rotors = s
        .qvel
        .iter()
        .zip(&model.dof_armature)
        .map(|(v, armature)| armature * v * v);
    0.5 * (bodies.sum::<f64>() + rotors.sum::<f64>())
}
