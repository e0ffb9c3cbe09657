//! Velocities, bias forces and passive forces.

use super::flex::flex_forces;
use super::fluid::{gravity_compensation, medium};
use super::transmission;
use crate::math::{Vec3, quat_at, quat_normalize, rotation_between};
use crate::model::{JointType, Model};
use crate::spatial::*;
use crate::state::State;
use crate::topology::Topology;

/// Computes `cvel` and `cdof_dot` from `qvel`.
#[doc(alias = "mj_comVel")]
#[inline(always)]
pub fn com_vel(model: &Model, s: &mut State) {
    s.cvel[0] = [0.0; 6];
    for b in 1..model.nbody() {
        let mut v = s.cvel[model.body_parentid[b]];
        for j in model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b] {
            let d = model.jnt_dofadr[j];
            let count = model.jnt_type[j].nv();
            if count > 1 {
                // the axes of translation stand still; those of rotation turn with what is before all three
                let turning = d + count - 3;
                for k in d..turning {
                    s.cdof_dot[k] = [0.0; 6];
                    axpy6(&mut v, s.qvel[k], &s.cdof[k]);
                }
                for k in turning..turning + 3 {
                    s.cdof_dot[k] = cross_motion(&v, &s.cdof[k]);
                }
                for k in turning..turning + 3 {
                    axpy6(&mut v, s.qvel[k], &s.cdof[k]);
                }
            } else {
                s.cdof_dot[d] = cross_motion(&v, &s.cdof[d]);
                axpy6(&mut v, s.qvel[d], &s.cdof[d]);
            }
        }
        s.cvel[b] = v;
    }
}

/// The working memory of the recursive Newton-Euler pass.
#[derive(Clone, Debug, Default)]
pub struct BiasScratch {
    acc: Vec<Spatial>,
    force: Vec<Spatial>,
    /// Wrench on each body (nbody) due to its velocity: `cvel x I cvel`.
    pub gyroscopic: Vec<Spatial>,
    /// Elastic forces on the vertices of a flex, N.
    flex: Vec<Vec3>,
}

impl BiasScratch {
    /// Recomputes the buffers of the velocity stage for a state after that stage.
    pub fn of(s: &State) -> Self {
        Self {
            gyroscopic: s.cinert.iter().zip(&s.cvel).map(|(i, v)| turning(i, v)).collect(),
            ..Self::default()
        }
    }
}

/// Returns the wrench due to a velocity.
#[inline(always)]
fn turning(cinert: &Inertia, cvel: &Spatial) -> Spatial {
    cross_force(cvel, &inertia_mul(cinert, cvel))
}

/// Computes the lengths of actuators and their rates: `actuator_length, actuator_velocity`.
#[inline(always)]
fn lengths(model: &Model, topology: &Topology, s: &mut State) {
    // as in MuJoCo, which leaves the rates of the lengths out with the forces
    let acting = model.opt.flags.actuation;
    for i in 0..model.nu() {
        let gear = transmission::gear(s, i);
        s.actuator_length[i] = transmission::length(model, topology, s, i, gear);
        s.actuator_velocity[i] = if acting {
            transmission::velocity(model, topology, s, i, gear)
        } else {
            0.0
        };
    }
}

/// Computes `cvel, cdof_dot, qfrc_bias, qfrc_passive`, lengths of actuators and their rates: springs `-k (q - springref)`, dampers `-d v`, and the recursive
/// Newton-Euler algorithm at zero joint acceleration.
#[doc(alias("mj_fwdVelocity", "mj_passive", "mj_rne"))]
#[inline(always)]
pub fn fwd_velocity(model: &Model, topology: &Topology, s: &mut State, scratch: &mut BiasScratch) {
    lengths(model, topology, s);
    com_vel(model, s);
    let nb = model.nbody();
    scratch.acc.resize(nb, [0.0; 6]);
    scratch.force.resize(nb, [0.0; 6]);
    scratch.gyroscopic.resize(nb, [0.0; 6]);
    let g = s.params.gravity;
    scratch.acc[0] = [0.0, 0.0, 0.0, -g[0], -g[1], -g[2]];
    scratch.force[0] = [0.0; 6];
    let (acc, force) = (&mut scratch.acc[..nb], &mut scratch.force[..nb]);
    let (cinert, cvel, gyroscopic) = (&s.cinert[..nb], &s.cvel[..nb], &mut scratch.gyroscopic[..nb]);
    for b in 1..nb {
        // what no joint moves has no velocity, and its weight is borne by the world
        if topology.body_last_dof[b].is_none() {
            acc[b] = acc[0];
            continue;
        }
        let mut a = acc[model.body_parentid[b]];
        for d in model.body_dofadr[b]..model.body_dofadr[b] + model.body_dofnum[b] {
            axpy6(&mut a, s.qvel[d], &s.cdof_dot[d]);
        }
        acc[b] = a;
        if cinert[b] == [0.0; 10] {
            (gyroscopic[b], force[b]) = ([0.0; 6], [0.0; 6]);
            continue;
        }
        let mut f = inertia_mul(&cinert[b], &a);
        let turning = turning(&cinert[b], &cvel[b]);
        axpy6(&mut f, 1.0, &turning);
        gyroscopic[b] = turning;
        force[b] = f;
    }
    for b in (1..nb).rev() {
        let p = model.body_parentid[b];
        if p > 0 {
            let f = force[b];
            axpy6(&mut force[p], 1.0, &f);
        }
    }
    for d in 0..model.nv {
        s.qfrc_bias[d] = dot6(&s.cdof[d], &scratch.force[model.dof_bodyid[d]]);
    }
    if model.opt.flags.passive {
        passive(model, topology, s, &mut scratch.flex);
    } else {
        s.qfrc_passive.fill(0.0);
        s.qfrc_gravcomp.fill(0.0);
    }
}

/// Computes `qfrc_passive`: springs and dampers of joints, flexes and tendons, elasticity of flexes, compensated gravity, the medium.
#[inline(always)]
fn passive(model: &Model, topology: &Topology, s: &mut State, flex: &mut Vec<Vec3>) {
    let params = &*s.params;
    for d in 0..model.nv {
        s.qfrc_passive[d] = -params.dof_damping[d] * s.qvel[d];
    }
    for j in 0..model.njnt() {
        let k = params.jnt_stiffness[j];
        if k == 0.0 {
            continue;
        }
        let (q, d) = (model.jnt_qposadr[j], model.jnt_dofadr[j]);
        let kind = model.jnt_type[j];
        let scalars = match kind {
            JointType::Free => 3,
            JointType::Ball => 0,
            JointType::Slide | JointType::Hinge => 1,
        };
        for i in 0..scalars {
            s.qfrc_passive[d + i] -= k * (s.qpos[q + i] - model.qpos_spring[q + i]);
        }
        if let Some(at) = kind.quat(q) {
            let turn = rotation_between(quat_at(&model.qpos_spring, at), quat_normalize(quat_at(&s.qpos, at)));
            for i in 0..3 {
                s.qfrc_passive[d + scalars + i] -= k * turn[i];
            }
        }
    }
    if !model.flexes.is_empty() {
        flex_forces(model, topology, s, flex);
    }
    for t in 0..model.ntendon() {
        pull(model, topology, s, t);
    }
    gravity_compensation(model, s);
    medium(model, s);
}

/// Adds the force of a tendon's spring and damper to `qfrc_passive`.
#[inline(always)]
fn pull(model: &Model, topology: &Topology, s: &mut State, tendon: usize) {
    let (stiffness, damping) = (model.tendon_stiffness[tendon], model.tendon_damping[tendon]);
    if stiffness == 0.0 && damping == 0.0 {
        return;
    }
    let (length, [shortest, longest]) = (s.ten_length[tendon], model.tendon_lengthspring[tendon]);
    let mut force = 0.0;
    if length > longest {
        force = stiffness * (longest - length);
    } else if length < shortest {
        force = stiffness * (shortest - length);
    }
    force -= damping * s.ten_velocity[tendon];
    let row = topology.tendons.range(tendon);
    for (&d, arm) in topology.tendons.row(tendon).iter().zip(&s.ten_j[row]) {
        s.qfrc_passive[d as usize] += arm * force;
    }
}
