//! Actuators that a protocol moves instead of the policy.

use super::Control;
use crate::config::ActuationModel;
use crate::env::{Env, EnvError};
use crate::model::Model;

/// A control with its places in a model.
#[derive(Debug)]
pub(super) struct BoundControl {
    /// Place in the action.
    place: usize,
    /// Number of actuators of MIMo; muscles have two numbers each.
    actuators: usize,
    angles: Vec<usize>,
    gain: f64,
}

/// Finds joints and returns their places in `qpos`.
pub(super) fn angles(model: &Model, joints: &[String]) -> Result<Vec<usize>, EnvError> {
    let find = |name: &String| {
        let joint = model.joint(name).ok_or_else(|| missing("joint", name))?;
        Ok(model.jnt_qposadr[joint])
    };
    joints.iter().map(find).collect()
}

/// Returns the error about an element that a protocol needs.
pub(super) fn missing(what: &'static str, name: &str) -> EnvError {
    EnvError::Missing {
        what,
        name: name.to_string(),
        purpose: "the protocol",
    }
}

impl BoundControl {
    /// Finds the actuator and the joints of a control.
    pub fn of(env: &Env, control: &Control) -> Result<Self, EnvError> {
        let (model, blueprint) = (env.model(), env.blueprint());
        let actuators = blueprint.actuation().actuators();
        let named = |&k: &usize| model.actuator_name[k] == control.actuator;
        let place = actuators.iter().position(named);
        Ok(Self {
            place: place.ok_or_else(|| missing("actuator", &control.actuator))?,
            actuators: actuators.len(),
            angles: angles(model, &control.joints)?,
            gain: control.gain,
        })
    }

    /// Writes its numbers into an action: a share of the torque, of a muscle's activity, or of a servo's range.
    pub fn apply(&self, env: &Env, action: &mut [f32]) {
        let sum: f64 = self.angles.iter().map(|&q| env.state().qpos[q]).sum();
        let share = (-self.gain * sum).clamp(-1.0, 1.0);
        let Some(place) = action.get_mut(self.place) else {
            return;
        };
        match env.config().actuation_model {
            ActuationModel::SpringDamper => *place = share as f32,
            ActuationModel::Positional => {
                let space = env.action_space();
                let end = if share < 0.0 { space.low() } else { space.high() };
                *place = end[self.place] * share.abs() as f32;
            }
            ActuationModel::Muscle => {
                *place = (-share).max(0.0) as f32;
                if let Some(other) = action.get_mut(self.actuators + self.place) {
                    *other = share.max(0.0) as f32;
                }
            }
        }
    }
}
