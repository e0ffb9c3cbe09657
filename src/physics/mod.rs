//! `Model` + `State` -> next `State`.
//!
//! [`SoftEngine`] is MuJoCo's soft-constraint formulation in joint space. With the feature `rapier`, `RapierEngine` lets
//! Rapier's own pipeline solve the same model, as multibodies, and `RapierScene` mirrors a state for its queries.

mod batch;
mod compile;
mod constraint;
#[cfg(feature = "internals")]
pub mod contact;
#[cfg(not(feature = "internals"))]
pub(crate) mod contact;
mod dynamics;
mod engine;
mod free_body;
mod length_range;
mod params;
mod patterns;
#[cfg(feature = "rapier")]
pub mod rapier;
mod ray;
mod shared;
mod soft;
mod spatial;
mod state;
mod strings;
mod table;
mod tiles;
mod topology;
mod vectorize;
#[cfg(feature = "internals")]
pub mod world;
#[cfg(not(feature = "internals"))]
pub(crate) mod world;

pub use batch::{Batch, BatchError, BatchPart};
pub use compile::compile;
pub use contact::Quirks;
internals!(use constraint::{ConstraintType, EfcRow});
internals!(use dynamics::once::{com_pos, kinematics});
internals!(use dynamics::{cameras, once::rne_post_constraint});
pub use engine::{Engine, EngineError};
internals!(use engine::{Probe, Stage});
pub use free_body::FreeBody;
pub use params::Params;
#[cfg(feature = "rapier")]
internals!(use rapier::{RapierEngine, RapierError, RapierModel, RapierOptions, RapierScene});
pub use shared::Shared;
pub use soft::{SoftEngine, SoftOptions};
internals!(use soft::SoftModel);
pub use state::{Contact, State};
pub(crate) use table::Row;
internals!(use topology::Topology);
pub(crate) use vectorize::vectorize;

/// Distance that counts as infinite; coordinates and velocities beyond it count as divergence (MuJoCo's `mjMAXVAL`).
const MAXVAL: f64 = 1e10;
