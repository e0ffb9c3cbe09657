//! The motors that reflexes command.

use super::MotorCommand;
use crate::actuation::{Actuation, ActuationError};
use crate::config::Reflex;
use crate::mimo::MimoBodies;
use crate::model::{Model, SensorType};
use crate::physics::State;

/// Distance from its target at which a motor pulls with all its strength, rad. Our choice.
const REACH: f64 = 0.5;
/// Time by which a motor looks ahead, s: damping over stiffness. Our choice.
const AHEAD: f64 = 0.05;

/// A motor of MIMo on a joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motor {
    /// Its index among the commands.
    index: usize,
    pub joint: usize,
    pub qpos: usize,
    pub dof: usize,
    /// Greatest torque in the negative and in the positive direction, N m.
    strength: [f64; 2],
    /// Torque over the distance from a target, N m/rad.
    stiffness: f64,
    /// Angles of its joint, rad.
    pub range: [f64; 2],
}

impl Motor {
    /// Adds a share of its strength, from -1 to 1.
    pub fn push(&self, share: f64, commands: &mut [MotorCommand]) {
        commands[self.index].torque += share * self.strength[usize::from(share > 0.0)];
    }

    /// Adds a torque, N m.
    pub fn add(&self, torque: f64, commands: &mut [MotorCommand]) {
        commands[self.index].torque += torque;
    }

    /// Suppresses a share of the action.
    pub fn suppress(&self, share: f64, commands: &mut [MotorCommand]) {
        let command = &mut commands[self.index];
        command.suppress = command.suppress.max(share);
    }

    /// Pulls the joint to an angle, rad, with at most a share of its strength.
    pub fn pull(&self, state: &State, angle: f64, share: f64, commands: &mut [MotorCommand]) {
        let ahead = state.qpos[self.qpos] + AHEAD * state.qvel[self.dof];
        let torque = self.stiffness * (angle - ahead);
        let [negative, positive] = self.strength.map(|most| most * share);
        self.add(torque.max(-negative).min(positive), commands);
    }
}

/// The motors of a scene, for a reflex to search.
pub(super) struct Motors<'m> {
    pub model: &'m Model,
    actuation: &'m dyn Actuation,
    strength: Vec<[f64; 2]>,
    reflex: Reflex,
}

impl<'m> Motors<'m> {
    /// Lists the motors for a reflex.
    pub fn of(model: &'m Model, actuation: &'m dyn Actuation, reflex: Reflex) -> Self {
        Self {
            model,
            actuation,
            strength: actuation.strength(model),
            reflex,
        }
    }

    /// Returns the error for a part that MIMo does not have.
    pub fn missing(&self, what: &str) -> ActuationError {
        ActuationError::Reflex {
            reflex: self.reflex.name(),
            missing: what.to_string(),
        }
    }

    /// Finds a motor by the name of its actuator without `act:`.
    pub fn find(&self, name: &str) -> Option<Motor> {
        let actuator = self.model.actuator(&format!("act:{name}"))?;
        let index = self.actuation.actuators().iter().position(|&i| i == actuator)?;
        let joint = self.model.actuator_joint(actuator)?;
        let strength = self.strength[index];
        Some(Motor {
            index,
            joint,
            qpos: self.model.jnt_qposadr[joint],
            dof: self.model.jnt_dofadr[joint],
            strength,
            stiffness: strength[0].max(strength[1]) / REACH,
            range: self.model.jnt_range[joint],
        })
    }

    /// Finds a motor that the reflex needs.
    ///
    /// # Errors
    /// There is none.
    pub fn need(&self, name: &str) -> Result<Motor, ActuationError> {
        self.find(name)
            .ok_or_else(|| self.missing(&format!("the motor act:{name}")))
    }

    /// Finds the motors of the left and of the right side.
    ///
    /// # Errors
    /// There is none.
    pub fn pair(&self, name: &str) -> Result<[Motor; 2], ActuationError> {
        Ok([
            self.need(&format!("left_{name}"))?,
            self.need(&format!("right_{name}"))?,
        ])
    }

    /// Finds the first value of MIMo's sensor of a kind, and its site.
    ///
    /// # Errors
    /// There is none.
    pub fn sensor(&self, kind: SensorType, name: &str) -> Result<(usize, usize), ActuationError> {
        let own = MimoBodies::of(self.model).sensors();
        let found = own.into_iter().find(|&i| self.model.sensor_type[i] == kind);
        let placed = found.and_then(|i| Some((self.model.sensor_adr[i], self.model.sensor_objid[i]?)));
        placed.ok_or_else(|| self.missing(name))
    }
}
