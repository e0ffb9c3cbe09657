//! The parts that MIMo's bodies belong to.

use super::body_kind;
use super::version::SECOND_PREFIX;
use crate::config::Part;
use crate::model::{JointType, Model, ObjType};

/// Prefix of the names of MIMo's own joints.
pub const JOINT_PREFIX: &str = "robot:";

/// The body that carries all of MIMo's others.
pub(crate) const ROOT: &str = "hip";

/// MIMo's bodies in a scene: his hip and everything below it. The names of other bodies do not matter.
///
/// In a model without a hip, only names identify his parts, and every body counts as his.
///
/// ```
/// use babybench::mimo::{MimoBodies, build_model, embedded};
/// use babybench::{Config, config::Scene};
///
/// let config = Config { scene: Scene::Cubes, ..Config::default() };
/// let model = build_model(&config, &embedded())?;
/// let mimo = MimoBodies::of(&model);
/// assert!(model.body("left_hand").is_some_and(|body| mimo.contains(body)));
/// assert!(model.body("red_sphere").is_some_and(|body| !mimo.contains(body)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MimoBodies<'m> {
    model: &'m Model,
    root: Option<usize>,
    /// The prefix of the infant's names.
    prefix: &'static str,
}

impl<'m> MimoBodies<'m> {
    /// Finds MIMo in `model`.
    pub fn of(model: &'m Model) -> Self {
        Self {
            root: model.body(ROOT),
            model,
            prefix: "",
        }
    }

    /// Finds the second infant in `model`; `None` if there is none.
    pub fn second(model: &'m Model) -> Option<Self> {
        let root = model.body(&format!("{SECOND_PREFIX}{ROOT}"))?;
        Some(Self {
            root: Some(root),
            model,
            prefix: SECOND_PREFIX,
        })
    }

    /// Returns the infant's own joints.
    pub fn joints(&self) -> MimoJoints {
        let model = self.model;
        let named = |name: &str| {
            name.strip_prefix(self.prefix)
                .is_some_and(|name| name.starts_with(JOINT_PREFIX))
        };
        let own = |&j: &usize| {
            named(&model.jnt_name[j])
                && matches!(model.jnt_type[j], JointType::Slide | JointType::Hinge)
                && self.contains(model.jnt_bodyid[j])
        };
        let joint: Vec<usize> = (0..model.njnt()).filter(own).collect();
        MimoJoints {
            qpos: joint.iter().map(|&j| model.jnt_qposadr[j]).collect(),
            dof: joint.iter().map(|&j| model.jnt_dofadr[j]).collect(),
            joint,
        }
    }

    /// Returns whether a body, by id, is MIMo's.
    pub fn contains(&self, body: usize) -> bool {
        self.root.is_none_or(|root| self.model.in_subtree(body, root))
    }

    /// Lists the actuators on MIMo's joints, by id.
    pub fn actuators(&self) -> Vec<usize> {
        let model = self.model;
        let joint = |i: usize| model.actuator_joint(i);
        let own = |&i: &usize| joint(i).is_some_and(|j| self.contains(model.jnt_bodyid[j]));
        (0..model.nu()).filter(own).collect()
    }

    /// Lists the sensors on MIMo's sites, by id.
    pub fn sensors(&self) -> Vec<usize> {
        let model = self.model;
        let own = |&i: &usize| match (model.sensor_objtype[i], model.sensor_objid[i]) {
            (ObjType::Site, Some(site)) => self.contains(model.site_bodyid[site]),
            _ => false,
        };
        (0..model.nsensor()).filter(own).collect()
    }
}

/// MIMo's own joints: the hinges of his bodies that are named `robot:...`, in id order. The free joint and objects are not among
/// them.
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
        MimoBodies::of(model).joints()
    }

    /// Returns the number of joints: 47 for v1, 91 for v2, and two more for MIMo 3.
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
    let carrier = *model.jnt_bodyid.get(joint)?;
    if !model.jnt_name[joint].starts_with(JOINT_PREFIX) || !MimoBodies::of(model).contains(carrier) {
        return None;
    }
    let body = model.body_name[carrier].as_str();
    Some(body_kind(body).map_or(Part::Fingers, |kind| kind.part))
}
