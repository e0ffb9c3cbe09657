//! What every physics engine does.

use std::sync::Arc;

use thiserror::Error;

use crate::model::Model;
use crate::physics::state::State;

/// Advances a [`State`] of a [`Model`].
pub trait Engine {
    /// The scene.
    fn model(&self) -> &Arc<Model>;

    /// A state at `qpos0`, at rest, of which nothing has been computed.
    fn new_state(&self) -> State;

    /// Computes everything that follows from `qpos`, `qvel` and `ctrl`, without advancing.
    fn forward(&mut self, state: &mut State) -> Result<(), EngineError>;

    /// Advances by one time step. The computed quantities stay those of the start of the step.
    fn step(&mut self, state: &mut State) -> Result<(), EngineError>;
}

/// A part of the work of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Poses and inertia.
    Kinematics,
    /// Writing poses to the scene in Rapier.
    Scene,
    /// Contacts.
    Collision,
    /// Constraint rows.
    Constraints,
    /// Velocities, bias, passive and actuator forces.
    Forces,
    /// Newton's method.
    Solver,
    /// Accelerations and internal wrenches for sensors.
    Wrenches,
    /// Integration.
    Integration,
    /// Observations and information.
    Senses,
}

impl Stage {
    /// All stages, in the order of a step.
    pub const ALL: [Self; 9] = [
        Self::Kinematics,
        Self::Scene,
        Self::Collision,
        Self::Constraints,
        Self::Forces,
        Self::Solver,
        Self::Wrenches,
        Self::Integration,
        Self::Senses,
    ];

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kinematics => "kinematics",
            Self::Scene => "scene",
            Self::Collision => "collision",
            Self::Constraints => "constraints",
            Self::Forces => "forces",
            Self::Solver => "solver",
            Self::Wrenches => "wrenches",
            Self::Integration => "integration",
            Self::Senses => "senses",
        }
    }
}

/// Called when a stage begins, and with `None` when a step is done; for timing, as the library has no clock.
pub type Probe = Box<dyn FnMut(Option<Stage>) + Send>;

/// Why a state could not be advanced.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EngineError {
    /// A vector of the state does not fit the model.
    #[error("state.{what} has {found} values but the model needs {expected}: build states with Engine::new_state")]
    Shape {
        /// Field.
        what: &'static str,
        /// Length found.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// A number given to the engine is not finite.
    #[error("state.{what}[{index}] is {value}: only finite numbers can be simulated")]
    NotFinite {
        /// Field.
        what: &'static str,
        /// Position in the field.
        index: usize,
        /// The number.
        value: f64,
    },
    /// The simulation diverged.
    #[error(
        "the simulation diverged in step {step} at joint {joint:?} ({what} = {value:e}): reset the environment, and use \
         smaller actions, forces or time steps"
    )]
    Diverged {
        /// Steps done before.
        step: u64,
        /// Joint whose coordinate is out of bounds.
        joint: String,
        /// Quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}
