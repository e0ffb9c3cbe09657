//! Motors that follow angles.

use super::MotionError;
use crate::config::ActuationModel;
use crate::env::Env;

/// The rate at which an error of an angle vanishes, 1/s: critically damped, in about 0.1 s.
const PACE: f64 = 40.0;

/// Actions that bring joints to angles.
///
/// A motor gives `m0 (w^2 (q* - q) + 2 w (v* - v)) + bias - passive`, over its gear and within its bounds: `m0` is the inertia of the
/// joint at `qpos0`, `w` the rate, and bias and passive are the current forces. A servo gets the angle as its target.
pub(super) struct Tracker {
    actuators: Vec<TrackedActuator>,
    servos: bool,
    action: Vec<f32>,
}

/// An actuator on a joint.
struct TrackedActuator {
    qpos: usize,
    dof: usize,
    gear: f64,
    inertia: f64,
}

impl Tracker {
    /// Reads the actuators of an environment.
    ///
    /// # Errors
    /// Muscles.
    pub fn new(env: &Env) -> Result<Self, MotionError> {
        let (model, actuation) = (env.model(), env.blueprint().actuation());
        let servos = match env.config().actuation_model {
            ActuationModel::SpringDamper => false,
            ActuationModel::Positional => true,
            ActuationModel::Muscle => return Err(MotionError::Muscles),
        };
        let pull = |&id: &usize| {
            let joint = model.actuator_joint(id)?;
            let dof = model.jnt_dofadr[joint];
            Some(TrackedActuator {
                qpos: model.jnt_qposadr[joint],
                dof,
                gear: model.actuator_gear[id],
                inertia: model.dof_m0[dof],
            })
        };
        Ok(Self {
            actuators: actuation.actuators().iter().filter_map(pull).collect(),
            servos,
            action: vec![0.0; env.action_space().len()],
        })
    }

    /// Returns the action towards positions and velocities. Other actuators get 0.
    pub fn action(&mut self, env: &Env, qpos: &[f64], qvel: &[f64]) -> &[f32] {
        let state = env.state();
        for (action, pull) in self.action.iter_mut().zip(&self.actuators) {
            if self.servos {
                *action = qpos[pull.qpos] as f32;
                continue;
            }
            let (off, slow) = (
                qpos[pull.qpos] - state.qpos[pull.qpos],
                qvel[pull.dof] - state.qvel[pull.dof],
            );
            let wanted = pull.inertia * (PACE * PACE * off + 2.0 * PACE * slow);
            let against = state.qfrc_bias[pull.dof] - state.qfrc_passive[pull.dof];
            let control = (wanted + against) / pull.gear;
            // a motor without gear moves nothing
            *action = if control.is_finite() { control as f32 } else { 0.0 };
        }
        &self.action
    }
}
