//! From actions to joint torques.
//!
//! | model | action, per actuator | observed, per actuator | of the scene |
//! |---|---|---|---|
//! | [`SpringDamper`] | 1: torque over gear | control, torque | motors |
//! | [`Muscle`] | 2: excitations in [0, 1] | 2 activities, 2 forces | the same motors, joints without springs |
//! | [`Positional`] | 1: angle, rad | angle | position servos |
//!
//! Models work without an environment: [`Actuation::prepare`] the parameters once, then [`Actuation::set_action`] before
//! the first physics step of an action and [`Actuation::substep`] before each further one.

pub mod curves;
mod error;
mod muscle;
mod positional;
mod spring_damper;

use crate::config::{ActuationModel, Config};
use crate::env::BoxSpace;
use crate::model::Model;
use crate::physics::{Params, State};

pub use error::ActuationError;
pub use muscle::{Muscle, MuscleParams};
pub use positional::Positional;
pub use spring_damper::SpringDamper;

/// An actuation model: turns actions into controls of the model's actuators.
pub trait Actuation: Send + Sync {
    /// Bounds of an action.
    fn action_space(&self) -> &BoxSpace;

    /// Names of the components of an action: the actuator, and what of it.
    fn action_names(&self, model: &Model) -> Vec<String>;

    /// Changes the parameters of the scene to what the model needs. Called once, on the model's own values.
    fn prepare(&self, _model: &Model, _params: &mut Params) {}

    /// Takes an action, clipped to the space, for the next environment step. `action` has the length of the space.
    fn set_action(&mut self, model: &Model, state: &mut State, action: &[f32]);

    /// Called before each physics step of an environment step but the first.
    fn substep(&mut self, model: &Model, state: &mut State);

    /// Forgets the past; called at each reset.
    fn reset(&mut self, model: &Model, state: &mut State);

    /// Number of values that [`Actuation::observe`] writes.
    fn observation_len(&self) -> usize;

    /// Names of the values that [`Actuation::observe`] writes.
    fn observation_names(&self, model: &Model) -> Vec<String>;

    /// Writes the state of the actuators for proprioception.
    fn observe(&self, model: &Model, state: &State, out: &mut [f64]);

    /// Metabolic cost of the current controls, in 0..1.
    fn cost(&self, model: &Model, state: &State) -> f64;

    /// Activities of the muscles, in the order of the action; empty for models without.
    fn activity(&self) -> &[f64] {
        &[]
    }

    /// Sets the activities; values out of [0, 1] are clipped, and what `activity` has beyond [`Actuation::activity`] is
    /// ignored.
    fn set_activity(&mut self, _activity: &[f64]) {}

    /// Everything the model remembers from step to step, as numbers.
    fn memory(&self) -> Vec<&[f64]> {
        Vec::new()
    }

    /// What [`Actuation::memory`] returns, to write it.
    fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        Vec::new()
    }
}

/// The actuation model of a configuration.
///
/// # Errors
/// Actuators of `model` that the actuation model cannot drive, illegal parameters of muscles.
pub fn build(model: &Model, config: &Config) -> Result<Box<dyn Actuation>, ActuationError> {
    Ok(match config.actuation_model {
        ActuationModel::SpringDamper => Box::new(SpringDamper::new(model, config.compat)),
        ActuationModel::Muscle => Box::new(Muscle::new(model, config.compat)?),
        ActuationModel::Positional => Box::new(Positional::new(model, config.compat)?),
    })
}

/// A name for each actuator, with an ending.
fn named(model: &Model, ending: &str) -> Vec<String> {
    let names = model.actuator_name.iter();
    names.map(|n| format!("{n}{ending}")).collect()
}
