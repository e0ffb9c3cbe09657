//! Poses of bodies, joints, geoms, sites and cameras, and the quantities about the centre of mass.
//!
//! The order of operations is MuJoCo's, so that geom poses agree to the last bit wherever sine and cosine do: contact
//! geometry is discontinuous in them.

use crate::math::*;
use crate::model::{Arrays, CamLight, JointType, Model, SameFrame};
use crate::spatial::spatial;
use crate::state::State;

/// Computes `xpos, xquat, xmat, xipos, ximat, xanchor, xaxis, geom_*, site_*` from `qpos`. Elements that never move are placed in the first call for
/// a state.
#[doc(alias = "mj_kinematics")]
#[inline(always)]
pub fn kinematics(model: &Arrays, s: &mut State) {
    // geoms and sites have the order of their bodies
    let (mut geom, mut site) = (0, 0);
    for b in 0..model.nbody() {
        let first = (geom, site);
        geom += model.body_geomnum[b];
        while model.site_bodyid.get(site) == Some(&b) {
            site += 1;
        }
        if s.fixed_placed && !model.moves(b) {
            continue;
        }
        if b > 0 {
            body(model, s, b);
        }
        // borrowed field by field, so that the poses can be written at the same time
        let frame = BodyFrames {
            pos: &s.xpos[b],
            quat: &s.xquat[b],
            mat: &s.xmat[b],
            ipos: &s.xipos[b],
            imat: &s.ximat[b],
        };
        let (geom_xpos, geom_xmat) = (&mut s.geom_xpos[..], &mut s.geom_xmat[..]);
        for g in first.0..geom {
            let (p, q) = (model.geom_pos[g], model.geom_quat[g]);
            (geom_xpos[g], geom_xmat[g]) = frame.carry(p, q, model.geom_sameframe[g]);
        }
        let (site_xpos, site_xmat) = (&mut s.site_xpos[..], &mut s.site_xmat[..]);
        for i in first.1..site {
            let (p, q) = (model.site_pos[i], model.site_quat[i]);
            (site_xpos[i], site_xmat[i]) = frame.carry(p, q, model.site_sameframe[i]);
        }
    }
    s.fixed_placed = true;
}

/// Places a body and its joints; its parent must be placed already.
#[inline(always)]
fn body(model: &Arrays, s: &mut State, b: usize) {
    let (mut pos, mut quat);
    let joints = model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b];
    let mut turned = true;
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
            turned = model.body_quat[b] != QUAT_ID;
            quat = if turned {
                quat_mul(s.xquat[p], model.body_quat[b])
            } else {
                s.xquat[p]
            };
            turned |= !joints.is_empty();
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
    s.xpos[b] = pos;
    (s.xquat[b], s.xmat[b]) = if turned {
        quat = quat_normalize(quat);
        (quat, quat_to_mat(quat))
    } else {
        (quat, s.xmat[model.body_parentid[b]])
    };
    let (p, q) = (model.body_ipos[b], model.body_iquat[b]);
    (s.xipos[b], s.ximat[b]) = local_to_global(s, b, p, q, model.body_sameframe[b]);
}

/// The frame of a body, and that of its principal axes.
struct BodyFrames<'a> {
    pos: &'a Vec3,
    quat: &'a Quat,
    mat: &'a Mat3,
    ipos: &'a Vec3,
    imat: &'a Mat3,
}

impl BodyFrames<'_> {
    /// Returns the world pose of an element fixed in the body. A frame that is already known is copied.
    #[inline(always)]
    fn carry(&self, pos: Vec3, quat: Quat, same: SameFrame) -> (Vec3, Mat3) {
        let world_pos = match same {
            SameFrame::Body => *self.pos,
            SameFrame::Inertia => *self.ipos,
            _ => add(mat_vec(self.mat, pos), *self.pos),
        };
        let world_mat = match same {
            SameFrame::Body | SameFrame::BodyRot => *self.mat,
            SameFrame::Inertia | SameFrame::InertiaRot => *self.imat,
            SameFrame::None => quat_to_mat(quat_mul(*self.quat, quat)),
        };
        (world_pos, world_mat)
    }
}

/// Returns the world pose of an element fixed in a body. A frame that is already known is copied.
#[doc(alias = "mj_local2Global")]
#[inline(always)]
pub(super) fn local_to_global(s: &State, body: usize, pos: Vec3, quat: Quat, same: SameFrame) -> (Vec3, Mat3) {
    let frame = BodyFrames {
        pos: &s.xpos[body],
        quat: &s.xquat[body],
        mat: &s.xmat[body],
        ipos: &s.xipos[body],
        imat: &s.ximat[body],
    };
    frame.carry(pos, quat, same)
}

/// Computes `cam_xpos, cam_xmat` from body poses and centres of mass. A camera that aims at something has its -z axis towards it and its x axis
/// horizontal.
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
#[doc(alias = "mj_comPos")]
#[inline(always)]
pub fn com_pos(model: &Arrays, s: &mut State) {
    let nb = model.nbody();
    let (com, xipos, params) = (&mut s.subtree_com[..nb], &s.xipos[..nb], &*s.params);
    com.fill([0.0; 3]);
    for b in (0..nb).rev() {
        let weighted = add_scaled(com[b], xipos[b], params.body_mass[b]);
        if b > 0 {
            let p = model.body_parentid[b];
            com[p] = add(com[p], weighted);
        }
        let mass = params.body_subtreemass[b];
        com[b] = if mass < MINVAL {
            xipos[b]
        } else {
            scale(weighted, 1.0 / mass)
        };
    }
    let bodies = xipos
        .iter()
        .zip(&s.ximat)
        .zip(&params.body_inertia)
        .zip(&params.body_mass);
    let all = bodies.zip(&model.body_rootid).zip(&mut s.cinert);
    for (((((xipos, r), i), &m), &root), cinert) in all.skip(1) {
        // frames and sites of robots are bodies without mass
        if m == 0.0 && *i == [0.0; 3] {
            *cinert = [0.0; 10];
            continue;
        }
        let d = sub(*xipos, com[root]);
        let rotated = |a: usize, c: usize| {
            r[3 * a] * i[0] * r[3 * c] + r[3 * a + 1] * i[1] * r[3 * c + 1] + r[3 * a + 2] * i[2] * r[3 * c + 2]
        };
        *cinert = [
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
