//! Poses of bodies, joints, geoms, sites and cameras, and the quantities about the centre of mass.
//!
//! The order of operations is MuJoCo's, so that geom poses agree to the last bit wherever sine and cosine do: contact
//! geometry is discontinuous in them.

use crate::math::*;
use crate::model::{Arrays, CamLight, JointType, Model, SameFrame};
use crate::physics::spatial::spatial;
use crate::physics::state::State;

/// Computes `xpos, xquat, xmat, xipos, ximat, xanchor, xaxis, geom_*, site_*` from `qpos`.
#[doc(alias = "mj_kinematics")]
#[inline(always)]
pub fn kinematics(model: &Arrays, s: &mut State) {
    for b in 1..model.nbody() {
        let (mut pos, mut quat);
        let joints = model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b];
        if joints.len() == 1 && model.jnt_type[joints.start] == JointType::Free {
            let j = joints.start;
            let q = &s.qpos[model.jnt_qposadr[j]..];
            pos = [q[0], q[1], q[2]];
            quat = quat_normalize([q[3], q[4], q[5], q[6]]);
            s.xanchor[j] = pos;
            s.xaxis[j] = model.jnt_axis[j];
        } else {
            let p = model.body_parentid[b];
            if p == 0 {
                (pos, quat) = match model.body_mocapid[b] {
                    Some(k) => (s.mocap_pos[k], quat_normalize(s.mocap_quat[k])),
                    None => (model.body_pos[b], model.body_quat[b]),
                };
            } else {
                pos = add(mat_vec(&s.xmat[p], model.body_pos[b]), s.xpos[p]);
                quat = quat_mul(s.xquat[p], model.body_quat[b]);
            }
            for j in joints {
                let (jpos, jaxis) = (model.jnt_pos[j], model.jnt_axis[j]);
                let axis = quat_rotate(quat, jaxis);
                let anchor = add(quat_rotate(quat, jpos), pos);
                let adr = model.jnt_qposadr[j];
                let displacement = s.qpos[adr] - model.qpos0[adr];
                match model.jnt_type[j] {
                    JointType::Slide => pos = add_scaled(pos, axis, displacement),
                    kind => {
                        let turn = match kind {
                            JointType::Ball => quat_normalize(quat_at(&s.qpos, adr)),
                            _ => axis_angle_to_quat(jaxis, displacement),
                        };
                        quat = quat_mul(quat, turn);
                        pos = sub(anchor, quat_rotate(quat, jpos));
                    }
                }
                s.xanchor[j] = anchor;
                s.xaxis[j] = axis;
            }
        }
        quat = quat_normalize(quat);
        s.xpos[b] = pos;
        s.xquat[b] = quat;
        s.xmat[b] = quat_to_mat(quat);
        let (p, q) = (model.body_ipos[b], model.body_iquat[b]);
        (s.xipos[b], s.ximat[b]) = local_to_global(s, b, p, q, model.body_sameframe[b]);
    }
    for g in 0..model.ngeom() {
        let (b, p, q) = (model.geom_bodyid[g], model.geom_pos[g], model.geom_quat[g]);
        (s.geom_xpos[g], s.geom_xmat[g]) = local_to_global(s, b, p, q, model.geom_sameframe[g]);
    }
    for i in 0..model.nsite() {
        let (b, p, q) = (model.site_bodyid[i], model.site_pos[i], model.site_quat[i]);
        (s.site_xpos[i], s.site_xmat[i]) = local_to_global(s, b, p, q, model.site_sameframe[i]);
    }
}

/// Returns the world pose of something fixed in a body. A frame that is known already is copied.
#[inline(always)]
pub(super) fn local_to_global(s: &State, body: usize, pos: Vec3, quat: Quat, same: SameFrame) -> (Vec3, Mat3) {
    let world_pos = match same {
        SameFrame::Body => s.xpos[body],
        SameFrame::Inertia => s.xipos[body],
        _ => add(mat_vec(&s.xmat[body], pos), s.xpos[body]),
    };
    let world_mat = match same {
        SameFrame::Body | SameFrame::BodyRot => s.xmat[body],
        SameFrame::Inertia | SameFrame::InertiaRot => s.ximat[body],
        SameFrame::None => quat_to_mat(quat_mul(s.xquat[body], quat)),
    };
    (world_pos, world_mat)
}

/// Computes `cam_xpos, cam_xmat` from body poses and centres of mass. A camera that aims at something has its -z towards it
/// and its x axis horizontal.
#[doc(alias = "mj_camlight")]
#[inline(always)]
pub fn cameras(model: &Model, s: &mut State) {
    for c in 0..model.ncam() {
        let (b, p, q) = (model.cam_bodyid[c], model.cam_pos[c], model.cam_quat[c]);
        let fixed = |s: &State| local_to_global(s, b, p, q, SameFrame::None);
        (s.cam_xpos[c], s.cam_xmat[c]) = match (model.cam_mode[c], model.cam_targetbodyid[c]) {
            (CamLight::Track, _) => (add(s.xpos[b], model.cam_pos0[c]), model.cam_mat0[c]),
            (CamLight::TrackCom, _) => (add(s.subtree_com[b], model.cam_poscom0[c]), model.cam_mat0[c]),
            (CamLight::TargetBody, Some(target)) => aimed(fixed(s).0, s.xpos[target]),
            (CamLight::TargetBodyCom, Some(target)) => aimed(fixed(s).0, s.subtree_com[target]),
            _ => fixed(s),
        };
    }
}

/// Returns a pose at a position, with -z towards a target and the x axis horizontal.
#[inline(always)]
fn aimed(pos: Vec3, target: Vec3) -> (Vec3, Mat3) {
    let z = unit(sub(pos, target)).0;
    let x = unit(cross([0.0, 0.0, 1.0], z)).0;
    let y = unit(cross(z, x)).0;
    (pos, [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]])
}

/// Computes `subtree_com, cinert, cdof` from poses.
#[inline(always)]
pub fn com_pos(model: &Arrays, s: &mut State) {
    let nb = model.nbody();
    s.subtree_com.fill([0.0; 3]);
    for b in (0..nb).rev() {
        let com = add_scaled(s.subtree_com[b], s.xipos[b], s.params.body_mass[b]);
        if b > 0 {
            let p = model.body_parentid[b];
            s.subtree_com[p] = add(s.subtree_com[p], com);
        }
        let mass = s.params.body_subtreemass[b];
        s.subtree_com[b] = if mass < MINVAL {
            s.xipos[b]
        } else {
            scale(com, 1.0 / mass)
        };
    }
    for b in 1..nb {
        let d = sub(s.xipos[b], s.subtree_com[model.body_rootid[b]]);
        let (r, i, m) = (&s.ximat[b], s.params.body_inertia[b], s.params.body_mass[b]);
        let rotated = |a: usize, c: usize| {
            r[3 * a] * i[0] * r[3 * c] + r[3 * a + 1] * i[1] * r[3 * c + 1] + r[3 * a + 2] * i[2] * r[3 * c + 2]
        };
        s.cinert[b] = [
            rotated(0, 0) + m * (d[1] * d[1] + d[2] * d[2]),
            rotated(1, 1) + m * (d[0] * d[0] + d[2] * d[2]),
            rotated(2, 2) + m * (d[0] * d[0] + d[1] * d[1]),
            rotated(0, 1) - m * d[0] * d[1],
            rotated(0, 2) - m * d[0] * d[2],
            rotated(1, 2) - m * d[1] * d[2],
            m * d[0],
            m * d[1],
            m * d[2],
            m,
        ];
    }
    for j in 0..model.njnt() {
        let b = model.jnt_bodyid[j];
        let to_com = sub(s.subtree_com[model.body_rootid[b]], s.xanchor[j]);
        let d = model.jnt_dofadr[j];
        match model.jnt_type[j] {
            JointType::Free => {
                for k in 0..3 {
                    s.cdof[d + k] = [0.0; 6];
                    s.cdof[d + k][3 + k] = 1.0;
                    let axis = column(&s.xmat[b], k);
                    s.cdof[d + 3 + k] = spatial(axis, cross(axis, to_com));
                }
            }
            JointType::Ball => {
                for k in 0..3 {
                    let axis = column(&s.xmat[b], k);
                    s.cdof[d + k] = spatial(axis, cross(axis, to_com));
                }
            }
            JointType::Hinge => s.cdof[d] = spatial(s.xaxis[j], cross(s.xaxis[j], to_com)),
            JointType::Slide => s.cdof[d] = spatial([0.0; 3], s.xaxis[j]),
        }
    }
}
