//! `Model` + `State` -> next `State`.
//!
//! [`SoftEngine`] is MuJoCo's soft-constraint formulation in joint space. With the feature `rapier`, `RapierEngine` lets
//! Rapier's own pipeline solve the same model, as multibodies, and `RapierScene` mirrors a state for its queries.

mod compile;
mod constraint;
pub mod contact;
mod dynamics;
mod engine;
mod free_body;
mod params;
#[cfg(feature = "rapier")]
pub mod rapier;
mod soft;
mod spatial;
mod state;
mod table;
mod tiles;
mod topology;
mod vectorize;
pub mod world;

pub use compile::compile;
pub use constraint::{ConstraintType, EfcRow};
pub use dynamics::{cameras, kinematics};
pub use engine::{Engine, EngineError, Probe, Stage};
pub use free_body::FreeBody;
pub use params::Params;
#[cfg(feature = "rapier")]
pub use rapier::{RapierEngine, RapierError, RapierModel, RapierOptions, RapierScene};
pub use soft::{SoftEngine, SoftModel, SoftOptions};
pub use state::{Contact, State};
pub(crate) use table::Row;
pub use topology::Topology;
pub(crate) use vectorize::vectorize;

/// Distance that counts as infinite; coordinates and velocities beyond it count as divergence (MuJoCo's `mjMAXVAL`).
const MAXVAL: f64 = 1e10;
