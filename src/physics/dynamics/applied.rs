//! Forces and torques that a caller applies to bodies.

use crate::math::*;
use crate::model::Model;
use crate::spatial::*;
use crate::state::State;

/// Iterates over the bodies on which [`State::xfrc_applied`] acts: body, force, torque. The world does not move.
pub(super) fn applied(s: &State) -> impl Iterator<Item = (usize, Vec3, Vec3)> {
    let acting = s.xfrc_applied.iter().enumerate().skip(1);
    acting
        .filter(|(_, wrench)| **wrench != [0.0; 6])
        .map(|(body, w)| (body, [w[0], w[1], w[2]], [w[3], w[4], w[5]]))
}

/// Adds the generalised forces of [`State::xfrc_applied`] to `qfrc_smooth`: the transposed Jacobian of each body's centre of
/// mass, in the order of operations of MuJoCo's `mj_xfrcAccumulate`.
#[doc(alias = "mj_xfrcAccumulate")]
pub fn xfrc_accumulate(model: &Model, s: &mut State) {
    let mut smooth = std::mem::take(&mut s.qfrc_smooth);
    for (body, force, torque) in applied(s) {
        let wrench = (body, force, torque, s.xipos[body]);
        add_force(model, &s.cdof, &s.subtree_com, wrench, &mut smooth);
    }
    s.qfrc_smooth = smooth;
}

/// Adds the generalised forces of a force and a torque on a body that act at a point, all in the world frame, to `qfrc` (nv)
/// (MuJoCo's `mj_applyFT`).
#[doc(alias = "mj_applyFT")]
pub(super) fn add_force(
    model: &Model,
    cdof: &[Spatial],
    subtree_com: &[Vec3],
    (body, force, torque, point): (usize, Vec3, Vec3, Vec3),
    qfrc: &mut [f64],
) {
    let offset = sub(point, subtree_com[model.body_rootid[body]]);
    let mut b = body;
    while b > 0 {
        for d in model.body_dofadr[b]..model.body_dofadr[b] + model.body_dofnum[b] {
            let velocity = velocity_at(&cdof[d], offset);
            qfrc[d] += dot(velocity, force);
            qfrc[d] += dot(angular(&cdof[d]), torque);
        }
        b = model.body_parentid[b];
    }
}
