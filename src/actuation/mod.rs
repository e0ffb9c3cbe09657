//! From actions to joint torques.
//!
//! | model | action, per actuator | observed, per actuator | in the scene |
//! |---|---|---|---|
//! | [`SpringDamperModel`] | 1: torque over gear | control, torque | motors |
//! | [`MuscleModel`] | 2: excitations in [0, 1] | 2 activities, 2 forces | the same motors, joints without springs |
//! | [`PositionalModel`] | 1: angle, rad | angle | position servos |
//!
//! Actions drive the actuators on MIMo's joints; those of other bodies in a scene are left at the control 0, unless `act_others`.
//!
//! Models work without an environment: [`Actuation::prepare`] a state once, then call [`Actuation::set_action`] before the first physics
//! step of an action and [`Actuation::substep`] before each further one. A model has no memory: activations, targets and forces are in
//! the [`State`].

pub mod curves;
mod error;
mod extra_actuators;
mod muscle;
mod positional;
mod reflex;
mod spring_damper;

use crate::config::{ActuationModel, Config};
use crate::model::Model;
use crate::physics::State;
use crate::spaces::BoxSpace;

pub use error::ActuationError;
pub use muscle::{MuscleModel, MuscleParams};
pub use positional::PositionalModel;
pub use reflex::MotorCommand;
pub(crate) use reflex::{ReflexTables, Reflexes};
pub use spring_damper::SpringDamperModel;

/// Turns actions into controls of a scene's actuators. The functions depend on model and state alone.
pub trait Actuation: Send + Sync {
    /// Returns the bounds of an action.
    fn action_space(&self) -> &BoxSpace;

    /// Returns the actuators that an action drives, by id: those on MIMo's joints. An action has a number for each, or several blocks of
    /// such numbers. The controls of other actuators stay 0, except for [`Actuation::extra_actuators`].
    fn actuators(&self) -> &[usize];

    /// Returns the actuators of other bodies that an action drives, by id: each by one of the last numbers. Empty unless `act_others` is set.
    fn extra_actuators(&self) -> &[usize] {
        &[]
    }

    /// Returns the names of the components of an action: actuator and quantity.
    fn action_names(&self, model: &Model) -> Vec<String>;

    /// Sets the parameters of a state as the actuation needs them, and reserves its own values there. Called once, on a new state. The
    /// actuators are then at rest.
    fn prepare(&self, model: &Model, state: &mut State);

    /// Takes an action, clipped to the space, for the next environment step. `action` has the length of the space.
    fn set_action(&self, model: &Model, state: &mut State, action: &[f32]);

    /// Updates the actuators before each physics step of an environment step but the first.
    fn substep(&self, model: &Model, state: &mut State);

    /// Drives MIMo's actuators for a physics step by an action of the length of the space and by the commands of reflexes, one for
    /// each of [`Actuation::actuators`]. With reflexes it replaces [`Actuation::set_action`] and [`Actuation::substep`].
    fn drive(&self, model: &Model, state: &mut State, action: &[f32], commands: &[MotorCommand]);

    /// Returns the greatest torque of each of [`Actuation::actuators`] on its joint, in the negative and in the positive direction, N m.
    fn strength(&self, model: &Model) -> Vec<[f64; 2]>;

    /// Resets the actuators; called at each reset of the scene.
    fn reset(&self, model: &Model, state: &mut State);

    /// Returns the number of values that [`Actuation::observe`] writes.
    fn observation_len(&self) -> usize;

    /// Returns the names of the values that [`Actuation::observe`] writes.
    fn observation_names(&self, model: &Model) -> Vec<String>;

    /// Writes the state of the actuators for proprioception.
    fn observe(&self, model: &Model, state: &State, out: &mut [f64]);

    /// Returns the metabolic cost of the current controls, in 0..1.
    fn cost(&self, model: &Model, state: &State) -> f64;
}

/// Sets the controls of actuators, by id, to numbers of an action, clipped to the bounds of the space starting with its dimension `first`.
pub(crate) fn set_controls(ctrl: &mut [f64], space: &BoxSpace, actuators: &[usize], first: usize, action: &[f32]) {
    for (k, (&i, &value)) in actuators.iter().zip(action).enumerate() {
        ctrl[i] = f64::from(space.clip(first + k, value));
    }
}

/// Builds the actuation model of a configuration.
///
/// # Errors
/// Actuators of `model` that the actuation model cannot drive, illegal parameters of muscles.
pub fn build(model: &Model, config: &Config) -> Result<Box<dyn Actuation>, ActuationError> {
    let mimo: Box<dyn Actuation> = match config.actuation_model {
        ActuationModel::SpringDamper => Box::new(SpringDamperModel::new(model, config.compat)),
        ActuationModel::Muscle => Box::new(MuscleModel::new(model, config.compat)?),
        ActuationModel::Positional => Box::new(PositionalModel::new(model, config.compat)?),
    };
    // without extra actuators it is the model itself, so MIMo's own path does not change
    let extra = config.act_others && mimo.actuators().len() < model.nu();
    Ok(if extra {
        Box::new(extra_actuators::WithExtraActuators::new(mimo, model))
    } else {
        mimo
    })
}

/// Returns the names of some actuators, each with an ending.
fn named(model: &Model, actuators: &[usize], ending: &str) -> Vec<String> {
    let names = actuators.iter().map(|&i| &model.actuator_name[i]);
    names.map(|n| format!("{n}{ending}")).collect()
}

/// Removes the muscles' values from a state and resets the activations of its actuators.
fn clear_muscles(model: &Model, state: &mut State) {
    for values in [&mut state.act, &mut state.muscle_force, &mut state.muscle_torque] {
        values.clear();
    }
    state.act.resize(model.na, 0.0);
}
