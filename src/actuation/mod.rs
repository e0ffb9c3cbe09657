//! From actions to joint torques.

mod spring_damper;

use crate::config::{ActuationModel, Config};
use crate::env::BoxSpace;
use crate::model::Model;
use crate::physics::State;

pub use spring_damper::SpringDamper;

/// An actuation model: turns actions into controls of the model's actuators.
pub trait Actuation: Send {
    /// Bounds of an action.
    fn action_space(&self) -> &BoxSpace;

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
}

/// The actuation model of a configuration, or `None` when it is not available.
pub fn build(model: &Model, config: &Config) -> Option<Box<dyn Actuation>> {
    match config.actuation_model {
        ActuationModel::SpringDamper => Some(Box::new(SpringDamper::new(model, config.compat))),
        ActuationModel::Muscle | ActuationModel::Positional => None,
    }
}

/// Names of the actuation models that [`build`] can make.
pub const AVAILABLE: &[&str] = &["spring_damper"];
