//! Body accelerations and internal wrenches after the constraint solver, which accelerometers and torque sensors read.

use super::BiasScratch;
use super::applied::applied;
use crate::constraint::{ConstraintType, connected_points, weld_points};
use crate::math::*;
use crate::model::{EqualityKind, Model};
use crate::spatial::*;
use crate::state::State;

/// Computes `cacc, cfrc_ext, cfrc_int` from `qacc`, the constraint forces and the buffers of the velocity stage (recursive Newton-Euler with
/// known joint accelerations).
///
/// `cfrc_ext` holds contacts, connections, welds and the forces that a caller applies to bodies. Joint limits, friction loss, springs and
/// actuators act inside joints and so show in `cfrc_int`. With `double_weld_torque` the rotational rows of a weld count as a torque, as MuJoCo 3.3.0 has it,
/// although their Jacobian is about half the angular one: the wrench is then about twice the true one.
#[doc(alias = "mj_rnePostConstraint")]
#[inline(always)]
pub fn rne_post_constraint(model: &Model, s: &mut State, bias: &BiasScratch, double_weld_torque: bool) {
    let nb = model.nbody();
    s.cfrc_ext.fill([0.0; 6]);
    let mut ext = std::mem::take(&mut s.cfrc_ext);
    for (body, force, torque) in applied(s) {
        let offset = sub(s.xipos[body], s.subtree_com[model.body_rootid[body]]);
        ext[body] = wrench_from(torque, force, offset);
    }
    s.cfrc_ext = ext;
    // contacts that are no constraint, because they are in the gap or rows are switched off, have no force
    for i in 0..s.contact.len() {
        let c = &s.contact[i];
        if c.efc_address.is_none() {
            continue;
        }
        let force = mat_t_vec(&c.frame, [c.force[0], c.force[1], c.force[2]]);
        let torque = mat_t_vec(&c.frame, [c.force[3], c.force[4], c.force[5]]);
        let (pos, geom) = (c.pos, c.geom);
        for (g, sign) in [(geom[0], -1.0), (geom[1], 1.0)] {
            apply(model, s, model.geom_bodyid[g], torque, force, pos, sign);
        }
    }
    apply_equalities(model, s, double_weld_torque);
    let g = s.params.gravity;
    // gravity as an acceleration of the world: accelerometers at rest then read 9.81 m/s^2 upwards
    s.cacc[0] = [0.0, 0.0, 0.0, -g[0], -g[1], -g[2]];
    s.cfrc_int[0] = [0.0; 6];
    let (cacc, cfrc_int) = (&mut s.cacc[..nb], &mut s.cfrc_int[..nb]);
    let (cinert, gyroscopic, cfrc_ext) = (&s.cinert[..nb], &bias.gyroscopic[..nb], &s.cfrc_ext[..nb]);
    for b in 1..nb {
        let mut a = cacc[model.body_parentid[b]];
        for d in model.body_dofadr[b]..model.body_dofadr[b] + model.body_dofnum[b] {
            axpy6(&mut a, s.qvel[d], &s.cdof_dot[d]);
            axpy6(&mut a, s.qacc[d], &s.cdof[d]);
        }
        cacc[b] = a;
        let mut f = inertia_mul(&cinert[b], &a);
        axpy6(&mut f, 1.0, &gyroscopic[b]);
        axpy6(&mut f, -1.0, &cfrc_ext[b]);
        cfrc_int[b] = f;
    }
    for b in (1..nb).rev() {
        let f = cfrc_int[b];
        axpy6(&mut cfrc_int[model.body_parentid[b]], 1.0, &f);
    }
}

/// Adds the wrenches of connections and welds to `cfrc_ext`.
fn apply_equalities(model: &Model, s: &mut State, double_weld_torque: bool) {
    for k in 0..s.efc.blocks.len() {
        let block = s.efc.blocks[k];
        if block.kind != ConstraintType::Equality {
            continue;
        }
        if let EqualityKind::Connect { body1, body2, .. } = model.eq_kind[block.id]
            && let Some([point1, point2]) = connected_points(model, s, block.id)
        {
            let force = std::array::from_fn(|r| s.efc.force[block.row + r]);
            apply(model, s, body1, [0.0; 3], force, point1, 1.0);
            apply(model, s, body2, [0.0; 3], force, point2, -1.0);
        }
        let EqualityKind::Weld { body1, body2, .. } = model.eq_kind[block.id] else {
            continue;
        };
        let Some(weld) = weld_points(model, s, block.id) else {
            continue;
        };
        let f: [f64; 6] = std::array::from_fn(|r| s.efc.force[block.row + r]);
        let force = [f[0], f[1], f[2]];
        let rows = [f[3], f[4], f[5]];
        let torque = if double_weld_torque {
            rows
        } else {
            weld.torque_of_rows(rows)
        };
        apply(model, s, body1, torque, force, weld.point1, 1.0);
        apply(model, s, body2, torque, force, weld.point2, -1.0);
    }
}

/// Adds `sign` times a wrench at a point to `cfrc_ext`.
#[inline(always)]
fn apply(model: &Model, s: &mut State, body: usize, torque: Vec3, force: Vec3, point: Vec3, sign: f64) {
    // nothing reads the wrench on the world
    if body > 0 {
        let offset = sub(point, s.subtree_com[model.body_rootid[body]]);
        axpy6(&mut s.cfrc_ext[body], sign, &wrench_from(torque, force, offset));
    }
}
