//! Moves the frame of a free body to its centre of mass and along its principal axes, if the document requests it.

use super::context::Context;
use crate::document::{AutoBool, TypedDocument};
use crate::math::{Quat, Vec3, add, quat_mul, quat_rotate, sub};
use crate::model::{Arrays, JointType};

/// Aligns a body of the document that has just been compiled as `id`; a body with others in it stays as it is, as in MuJoCo.
pub(super) fn align(context: &Context, document: &TypedDocument, body: usize, id: usize, arrays: &mut Arrays) {
    let [joint] = document.bodies[body].joints.as_slice() else {
        return;
    };
    let asked = match joint.align {
        AutoBool::Yes => true,
        AutoBool::No => false,
        AutoBool::Auto => context.compiler(joint.at).alignfree,
    };
    // bodies are listed depth first, so a child would be the next one
    let leaf = document.bodies.get(body + 1).is_none_or(|next| next.parent != body);
    if joint.kind != JointType::Free || !asked || !leaf {
        return;
    }
    let (ipos, iquat) = (arrays.body_ipos[id], arrays.body_iquat[id]);
    (arrays.body_ipos[id], arrays.body_iquat[id]) = ([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
    let (pos, quat) = (arrays.body_pos[id], arrays.body_quat[id]);
    let (pos, quat) = (add(pos, quat_rotate(quat, ipos)), quat_mul(quat, iquat));
    (arrays.body_pos[id], arrays.body_quat[id]) = (pos, quat);
    let pose = pos.into_iter().chain(quat);
    for coordinates in [&mut arrays.qpos0, &mut arrays.qpos_spring] {
        // the free joint of this body is the last that was compiled
        let from = coordinates.len() - 7;
        coordinates.truncate(from);
        coordinates.extend(pose.clone());
    }
    let back = [iquat[0], -iquat[1], -iquat[2], -iquat[3]];
    let seen = |pos: &mut Vec3| *pos = quat_rotate(back, sub(*pos, ipos));
    let turned = |quat: &mut Quat| *quat = quat_mul(back, *quat);
    let geoms = arrays.body_geomadr[id]..;
    arrays.geom_pos[geoms.clone()].iter_mut().for_each(seen);
    arrays.geom_quat[geoms].iter_mut().for_each(turned);
    let here = |bodies: &[usize]| bodies.iter().take_while(|&&body| body < id).count();
    let sites = here(&arrays.site_bodyid);
    arrays.site_pos[sites..].iter_mut().for_each(seen);
    arrays.site_quat[sites..].iter_mut().for_each(turned);
    let cameras = here(&arrays.cam_bodyid);
    arrays.cam_pos[cameras..].iter_mut().for_each(seen);
    arrays.cam_quat[cameras..].iter_mut().for_each(turned);
    for light in arrays.lights.iter_mut().filter(|light| light.bodyid == id) {
        seen(&mut light.pos);
        light.dir = quat_rotate(back, light.dir);
    }
}
