//! `Model` + `State` -> next `State`.
//!
//! [`SoftEngine`] is MuJoCo's soft-constraint formulation in joint space, on a scene that lives in Rapier.
//! [`RapierEngine`] lets Rapier's own pipeline solve the same model, as multibodies.

pub mod constraint;
pub mod contact;
pub mod dynamics;
mod engine;
pub mod rapier;
mod soft;
pub mod spatial;
mod state;
pub mod tiles;
mod topology;
pub mod world;

pub use dynamics::set_const;
pub use engine::{Engine, EngineError, Probe, Stage};
pub use rapier::{RapierEngine, RapierError, RapierModel, RapierOptions};
pub use soft::{SoftEngine, SoftOptions};
pub use state::{Contact, Params, State};
pub use topology::Topology;
