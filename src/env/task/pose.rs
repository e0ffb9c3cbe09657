//! Initial poses, as tables of joint angles.

use crate::env::EnvError;
use crate::mimo::JOINT_PREFIX;
use crate::model::{JointType, Model};

/// Angles of joints by name, without `robot:`, rad.
pub(super) type Angles = [(&'static str, f64)];

/// Writes joint angles into positions (nq). A joint of the table that the scene lacks is an error.
pub(super) fn set_angles(
    model: &Model,
    angles: &Angles,
    qpos: &mut [f64],
    purpose: &'static str,
) -> Result<(), EnvError> {
    for &(name, angle) in angles {
        qpos[address(model, &own_joint(name), purpose)?] = angle;
    }
    Ok(())
}

/// Returns the full name of one of MIMo's own joints.
pub(super) fn own_joint(name: &str) -> String {
    format!("{JOINT_PREFIX}{name}")
}

/// Returns the index in `qpos` of a joint that a task needs.
pub(super) fn address(model: &Model, name: &str, purpose: &'static str) -> Result<usize, EnvError> {
    let missing = || EnvError::Missing {
        what: "joint",
        name: name.to_string(),
        purpose,
    };
    Ok(model.jnt_qposadr[model.joint(name).ok_or_else(missing)?])
}

/// Returns the index in `qpos` of the free joint of a body that a task needs.
pub(super) fn free_address(model: &Model, body: usize, purpose: &'static str) -> Result<usize, EnvError> {
    let joint = model.body_jntadr[body];
    let free = model.body_jntnum[body] > 0 && model.jnt_type[joint] == JointType::Free;
    if free {
        Ok(model.jnt_qposadr[joint])
    } else {
        Err(EnvError::Missing {
            what: "free joint",
            name: model.body_name[body].clone(),
            purpose,
        })
    }
}
