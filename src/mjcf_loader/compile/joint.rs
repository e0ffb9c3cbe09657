//! Compiles joints and their degrees of freedom.

use std::f64::consts::PI;

use super::context::{Context, UserDataSize};
use super::geometry::{EPS, normalize};
use crate::document::{AutoBool, Body};
use crate::error::LoadError;
use crate::joint::Joint;
use crate::math::{QUAT_ID, Vec3};
use crate::model::{Arrays, JointType};

/// Compiles the joints of a body. `last` is the last degree of freedom that moves its parent. Returns the last one that moves the body itself.
pub(super) fn compile_joints(
    context: &Context,
    body: &Body,
    id: usize,
    mut last: Option<usize>,
    user: &UserDataSize,
    arrays: &mut Arrays,
) -> Result<Option<usize>, LoadError> {
    arrays.body_jntadr.push(arrays.jnt_name.len());
    arrays.body_dofadr.push(arrays.nv);
    for joint in &body.joints {
        compile_joint(context, joint, body, id, &mut last, arrays)?;
        let user = user.of(context, joint.at, &joint.user)?;
        arrays.jnt_user.push(user);
    }
    arrays.body_jntnum.push(body.joints.len());
    arrays.body_dofnum.push(arrays.nv - arrays.body_dofadr[id]);
    if arrays.body_dofnum[id] > 6 {
        return Err(context.invalid(body.at, "a body can have at most 6 degrees of freedom"));
    }
    let limit = context.tree.limits.dofs;
    context.within(body.at, "degrees of freedom", limit, arrays.nv)?;
    Ok(last)
}

/// The place of a joint in its body.
struct JointFrame {
    pos: Vec3,
    axis: Vec3,
    limited: bool,
}

impl JointFrame {
    /// Checks that the joint can be in the body, and returns where: free and ball joints have no axis of their own, and a free joint is
    /// at the origin.
    fn of(context: &Context, joint: &Joint, body: &Body, [body_id, parent]: [usize; 2]) -> Result<Self, LoadError> {
        let invalid = |message| Err(context.invalid(joint.at, message));
        let limited = || context.limited(joint.at, "range", joint.limited, joint.range);
        let z = [0.0, 0.0, 1.0];
        match joint.kind {
            JointType::Free => {
                if body_id == 0 || parent != 0 {
                    return invalid("a free joint can only be in a child of the world");
                }
                if body.joints.len() > 1 {
                    return invalid("a free joint must be the only joint of its body");
                }
                let (pos, limited) = ([0.0; 3], false);
                Ok(Self { pos, axis: z, limited })
            }
            JointType::Ball => {
                let pos = context.point(joint.within, joint.pos);
                // any upper end will do: beyond a half turn nothing reaches it
                let limited = joint.limited == AutoBool::Yes || limited()?;
                if limited && joint.range[0] != 0.0 {
                    return invalid("the range of a ball joint must begin at 0");
                }
                Ok(Self { pos, axis: z, limited })
            }
            JointType::Slide | JointType::Hinge => {
                let mut axis = joint.axis;
                if normalize(&mut axis) < EPS {
                    return invalid("the axis is too short");
                }
                Ok(Self {
                    pos: context.point(joint.within, joint.pos),
                    axis: context.direction(joint.within, axis),
                    limited: limited()?,
                })
            }
        }
    }
}

fn compile_joint(
    context: &Context,
    joint: &Joint,
    body: &Body,
    body_id: usize,
    dof: &mut Option<usize>,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let id = arrays.jnt_name.len();
    let before = &arrays.jnt_type[arrays.body_jntadr[body_id]..];
    if joint.kind != JointType::Slide && before.contains(&JointType::Ball) {
        return Err(context.invalid(
            joint.at,
            "a ball joint cannot be followed by a rotation in the same body",
        ));
    }
    let turns = matches!(joint.kind, JointType::Hinge | JointType::Ball) && context.compiler(joint.at).degree;
    // MuJoCo converts the angles of orientations in another order, with another last bit
    let angle = |value: f64| if turns { value * (PI / 180.0) } else { value };
    let JointFrame { pos, axis, limited } =
        JointFrame::of(context, joint, body, [body_id, arrays.body_parentid[body_id]])?;
    arrays.jnt_name.push(joint.name.clone());
    arrays.jnt_type.push(joint.kind);
    arrays.jnt_bodyid.push(body_id);
    arrays.jnt_qposadr.push(arrays.nq);
    arrays.jnt_dofadr.push(arrays.nv);
    arrays.jnt_pos.push(pos);
    arrays.jnt_axis.push(axis);
    arrays.jnt_limited.push(limited);
    // A range that does not limit stays as written.
    arrays
        .jnt_range
        .push(if limited { joint.range.map(angle) } else { joint.range });
    arrays.jnt_margin.push(joint.margin);
    // the force on other joints is not limited, even if the attributes say so
    let actfrclimited = joint.kind.nv() == 1
        && context.limited(
            joint.at,
            "actuatorfrcrange",
            joint.actuatorfrclimited,
            joint.actuatorfrcrange,
        )?;
    arrays.jnt_actfrclimited.push(actfrclimited);
    arrays.jnt_actgravcomp.push(joint.actuatorgravcomp);
    arrays.jnt_actfrcrange.push(joint.actuatorfrcrange);
    let spring = joint.springdamper;
    if spring != [0.0; 2] && spring.contains(&0.0) {
        return Err(context.invalid(joint.at, "both numbers of springdamper must be positive"));
    }
    arrays.jnt_springdamper.push(spring);
    arrays.jnt_stiffness.push(joint.stiffness);
    arrays.jnt_solref.push(joint.solref_limit);
    arrays.jnt_solimp.push(joint.solimp_limit);
    arrays.jnt_group.push(joint.group);
    reference(joint, body_id, angle, arrays);
    push_dofs(joint, body_id, id, dof, arrays);
    arrays.nq += joint.kind.nq();
    Ok(())
}

/// Adds the coordinates of a joint at `qpos0`, and where its spring is at rest.
fn reference(joint: &Joint, body: usize, angle: impl Fn(f64) -> f64, arrays: &mut Arrays) {
    match joint.kind {
        JointType::Free => {
            let pose = arrays.body_pos[body].into_iter().chain(arrays.body_quat[body]);
            arrays.qpos0.extend(pose.clone());
            arrays.qpos_spring.extend(pose);
        }
        JointType::Ball => {
            arrays.qpos0.extend(QUAT_ID);
            arrays.qpos_spring.extend(QUAT_ID);
        }
        JointType::Slide | JointType::Hinge => {
            arrays.qpos0.push(angle(joint.reference));
            arrays.qpos_spring.push(angle(joint.springref));
        }
    }
}

/// Adds the degrees of freedom of a joint. `last` is the last one that moves its body so far.
fn push_dofs(joint: &Joint, body: usize, id: usize, last: &mut Option<usize>, arrays: &mut Arrays) {
    for _ in 0..joint.kind.nv() {
        arrays.dof_bodyid.push(body);
        arrays.dof_jntid.push(id);
        arrays.dof_parentid.push(*last);
        arrays.dof_armature.push(joint.armature);
        arrays.dof_damping.push(joint.damping);
        arrays.dof_frictionloss.push(joint.frictionloss);
        arrays.dof_solref.push(joint.solref_friction);
        arrays.dof_solimp.push(joint.solimp_friction);
        *last = Some(arrays.nv);
        arrays.nv += 1;
    }
}
