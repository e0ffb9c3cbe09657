//! `Model` + `State` -> next `State`.
//!
//! [`SoftEngine`] is MuJoCo's soft-constraint formulation in joint space, on a scene that lives in Rapier.
//! [`RapierEngine`] lets Rapier's own pipeline solve the same model, as multibodies.

mod compile;
mod constraint;
pub mod contact;
mod dynamics;
mod engine;
mod params;
pub mod rapier;
mod soft;
mod spatial;
mod state;
mod tiles;
mod topology;
pub mod world;

pub use compile::compile;
pub use constraint::{ConstraintType, EfcRow};
pub use dynamics::{cameras, kinematics};
pub use engine::{Engine, EngineError, Probe, Stage};
pub use params::Params;
pub use rapier::{RapierEngine, RapierError, RapierModel, RapierOptions};
pub use soft::{SoftEngine, SoftModel, SoftOptions};
pub use state::{Contact, State};
pub use topology::Topology;
