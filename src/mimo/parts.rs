//! Which body belongs to which part.

use crate::config::Part;
use crate::model::{JointId, JointType, Model};

/// Bodies of the parts, without their `left_` and `right_`. A body that is not listed is a finger.
const BODIES: [(&str, Part); 13] = [
    ("hip", Part::Body),
    ("lower_body", Part::Body),
    ("upper_body", Part::Body),
    ("head", Part::Head),
    ("eye", Part::Eyes),
    ("upper_arm", Part::Arms),
    ("lower_arm", Part::Arms),
    ("hand", Part::Hands),
    ("upper_leg", Part::Legs),
    ("lower_leg", Part::Legs),
    ("foot", Part::Feet),
    ("toes", Part::Feet),
    ("big_toe", Part::Feet),
];

/// Prefix of the names of MIMo's own joints.
const JOINT_PREFIX: &str = "robot:";

/// MIMo's own joints: the hinges named `robot:...`, in id order. The free joint and objects are not among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MimoJoints {
    /// Joint ids.
    pub joint: Vec<usize>,
    /// Coordinates in `qpos`.
    pub qpos: Vec<usize>,
    /// Coordinates in `qvel`.
    pub dof: Vec<usize>,
}

impl MimoJoints {
    /// Of `model`.
    pub fn new(model: &Model) -> Self {
        let own = |j: &usize| model.jnt_name[*j].starts_with(JOINT_PREFIX) && model.jnt_type[*j] != JointType::Free;
        let joint: Vec<usize> = (0..model.njnt()).filter(own).collect();
        Self {
            qpos: joint.iter().map(|&j| model.jnt_qposadr[j]).collect(),
            dof: joint.iter().map(|&j| model.jnt_dofadr[j]).collect(),
            joint,
        }
    }

    /// Number of joints: 47 for version 1, 91 for version 2.
    pub fn len(&self) -> usize {
        self.joint.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.joint.is_empty()
    }
}

/// The part that one of MIMo's joints belongs to: that of the body it moves. `None` for joints that are not MIMo's or
/// do not exist.
pub fn joint_part(model: &Model, joint: JointId) -> Option<Part> {
    if !model.jnt_name.get(joint.0)?.starts_with(JOINT_PREFIX) {
        return None;
    }
    let body = model.body_name[model.jnt_bodyid[joint.0]].as_str();
    let plain = body
        .strip_prefix("left_")
        .or_else(|| body.strip_prefix("right_"))
        .unwrap_or(body);
    let listed = BODIES.iter().find(|b| b.0 == plain);
    Some(listed.map_or(Part::Fingers, |b| b.1))
}
