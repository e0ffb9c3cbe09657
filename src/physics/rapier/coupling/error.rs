//! The errors of couplings.

use mjcf_sim_loader::LoadError;
use mjcf_sim_loader::edit::EditError;
use mjcf_sim_physics::EngineError;
use rapier3d_f64::geometry::ColliderHandle;
use thiserror::Error;

/// An error in coupling a model with a Rapier world.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CouplingError {
    /// The model was compiled without slots, or with different ones.
    #[error("the model has no body {name:?}: add CouplingOptions::slots to its document, with the same options")]
    NoSlots {
        /// Name of the missing body.
        name: String,
    },
    /// The time step of the world is not positive.
    #[error("the world's time step is {dt} s: it must be finite and > 0")]
    TimeStep {
        /// Time step, s.
        dt: f64,
    },
    /// The time step of the world is not a multiple of the model's.
    #[error(
        "the world's time step, {dt} s, is not {steps} time steps of the model, {timestep} s each: change one of them"
    )]
    Steps {
        /// Time step of the world, s.
        dt: f64,
        /// Time step of the model, s.
        timestep: f64,
        /// Steps of the model in a step of the world.
        steps: u32,
    },
    /// An option is out of range.
    #[error("{what} is {value}: it must be finite and > 0")]
    Option {
        /// Name of the option.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A pose or gravity is not finite.
    #[error("{what} has a number that is not finite")]
    NotFinite {
        /// Vector at fault.
        what: &'static str,
    },
    /// There are more neighbors than slots.
    #[error("more than {slots} {what} are near the model: raise CouplingOptions::{option}, or lower near")]
    TooManyNeighbors {
        /// Kind of neighbors.
        what: &'static str,
        /// Number of slots.
        slots: usize,
        /// Option that sets the number.
        option: &'static str,
    },
    /// A collider near the model has a shape that the model cannot have.
    #[error("the collider {collider:?} near the model is {shape}: {why}; or exclude it with CouplingOptions::groups")]
    Shape {
        /// The collider.
        collider: ColliderHandle,
        /// Its shape.
        shape: &'static str,
        /// What to do.
        why: &'static str,
    },
    /// A shape has numbers that a geom cannot have, such as a size of 0.
    #[error("the collider {collider:?} near the model does not fit an MJCF geom: {error}")]
    Geom {
        /// The collider.
        collider: ColliderHandle,
        /// The loader's error.
        error: Box<LoadError>,
    },
    /// The document of a model does not compile.
    #[error(transparent)]
    Load(#[from] Box<LoadError>),
    /// The document of a model does not accept slots, or does not compile with them.
    #[error(transparent)]
    Edit(#[from] Box<EditError>),
    /// The bytes are not a snapshot.
    #[error("these bytes are not a snapshot of a coupling")]
    NotASnapshot,
    /// The snapshot was taken from a coupling with different slots.
    #[error("the snapshot was taken with different slots: couple the same document with the same options")]
    OtherSlots,
    /// A step of the model failed.
    #[error(transparent)]
    Engine(#[from] EngineError),
}
