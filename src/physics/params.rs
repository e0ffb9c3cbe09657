//! Parameters of a scene that a program may change while it runs.

use crate::model::{Arrays, EqualityKind};

/// The parameters that a program may change while the scene runs; copied from the model at construction.
#[derive(Debug, PartialEq)]
pub struct Params {
    /// Which equality constraints hold (neq).
    pub eq_active: Vec<bool>,
    /// Constant term of each joint equality (neq), rad; unused for welds.
    pub eq_offset: Vec<f64>,
    /// Joint stiffness (njnt), N m/rad.
    pub jnt_stiffness: Vec<f64>,
    /// Damping (nv), N m s/rad.
    pub dof_damping: Vec<f64>,
    /// Actuator gear (nu).
    pub actuator_gear: Vec<f64>,
    /// Whether the actuator force is limited (nu).
    pub actuator_forcelimited: Vec<bool>,
}

impl Clone for Params {
    fn clone(&self) -> Self {
        Self {
            eq_active: self.eq_active.clone(),
            eq_offset: self.eq_offset.clone(),
            jnt_stiffness: self.jnt_stiffness.clone(),
            dof_damping: self.dof_damping.clone(),
            actuator_gear: self.actuator_gear.clone(),
            actuator_forcelimited: self.actuator_forcelimited.clone(),
        }
    }

    /// Keeps the memory, so that a reset does not allocate.
    fn clone_from(&mut self, other: &Self) {
        self.eq_active.clone_from(&other.eq_active);
        self.eq_offset.clone_from(&other.eq_offset);
        self.jnt_stiffness.clone_from(&other.jnt_stiffness);
        self.dof_damping.clone_from(&other.dof_damping);
        self.actuator_gear.clone_from(&other.actuator_gear);
        self.actuator_forcelimited.clone_from(&other.actuator_forcelimited);
    }
}

impl Params {
    /// Returns the model's own values.
    pub fn new(model: &Arrays) -> Self {
        let offset = |k: &EqualityKind| match k {
            EqualityKind::Joint { polycoef, .. } => polycoef[0],
            EqualityKind::Weld { .. } => 0.0,
        };
        Self {
            eq_active: model.eq_active0.clone(),
            eq_offset: model.eq_kind.iter().map(offset).collect(),
            jnt_stiffness: model.jnt_stiffness.clone(),
            dof_damping: model.dof_damping.clone(),
            actuator_gear: model.actuator_gear.clone(),
            actuator_forcelimited: model.actuator_forcelimited.clone(),
        }
    }
}
