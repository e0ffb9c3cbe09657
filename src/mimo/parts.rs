//! The parts that MIMo's bodies belong to.

use crate::config::Part;
use crate::mimo::body_kind;
use crate::model::{JointType, Model};

/// Prefix of the names of MIMo's own joints.
pub(crate) const JOINT_PREFIX: &str = "robot:";

/// MIMo's own joints: the hinges named `robot:...`, in id order. The free joint and objects are not among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MimoJoints {
    /// Joint ids.
    pub joint: Vec<usize>,
    /// Indices in `qpos`.
    pub qpos: Vec<usize>,
    /// Indices in `qvel`.
    pub dof: Vec<usize>,
}

impl MimoJoints {
    /// Finds MIMo's joints in `model`.
    pub fn new(model: &Model) -> Self {
        let own = |j: &usize| model.jnt_name[*j].starts_with(JOINT_PREFIX) && model.jnt_type[*j] != JointType::Free;
        let joint: Vec<usize> = (0..model.njnt()).filter(own).collect();
        Self {
            qpos: joint.iter().map(|&j| model.jnt_qposadr[j]).collect(),
            dof: joint.iter().map(|&j| model.jnt_dofadr[j]).collect(),
            joint,
        }
    }

    /// Returns the number of joints: 47 for version 1, 91 for version 2.
    pub fn len(&self) -> usize {
        self.joint.len()
    }

    /// Returns whether there are no joints.
    pub fn is_empty(&self) -> bool {
        self.joint.is_empty()
    }
}

/// Returns the part that one of MIMo's joints belongs to: that of the body it moves. `None` for joints that are not
/// MIMo's or do not exist.
pub fn joint_part(model: &Model, joint: usize) -> Option<Part> {
    if !model.jnt_name.get(joint)?.starts_with(JOINT_PREFIX) {
        return None;
    }
    let body = model.body_name[model.jnt_bodyid[joint]].as_str();
    Some(body_kind(body).map_or(Part::Fingers, |kind| kind.part))
}
