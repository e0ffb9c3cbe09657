//! Physics: advances the `State` of a `Model`.
//!
//! [`SoftEngine`] is MuJoCo's soft-constraint formulation in joint space. The crate mjcf-sim-rapier has a
//! second engine, Rapier's own pipeline, and a mirror of a state for ray casts and shape queries.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod batch;
mod body_simple;
pub mod collision;
mod compile;
pub mod constraint;
pub mod contact;
mod detected;
pub mod dynamics;
pub mod engine;
mod error;
mod free_body;
mod length_range;
pub mod params;
mod ray;
mod shared;
pub mod soft;
pub mod spatial;
pub mod state;
mod table;
pub mod tiles;
pub mod topology;
mod vectorize;

pub use batch::{Batch, BatchError, BatchPart};
pub use compile::compile;
pub use constraint::{ConstraintType, EfcRow};
pub use contact::Quirks;
pub use detected::{Contact, ContactSide, FlexContact};
pub use dynamics::stages::{com_pos, kinematics};
pub use dynamics::{cameras, stages::rne_post_constraint};
pub use engine::{Engine, Probe, Stage};
pub use error::EngineError;
pub use free_body::FreeBody;
pub use params::Params;
pub use ray::{RayHit, ray};
pub use shared::Shared;
pub use soft::SoftModel;
pub use soft::{SoftEngine, SoftOptions};
pub use state::State;
pub use table::Row;
pub use topology::Topology;
pub use vectorize::vectorize;

// Paths of other files of this crate begin with `crate` for these, too.
use mjcf_sim_loader as mjcf_loader;
#[cfg(test)]
use mjcf_sim_model::assets;
use mjcf_sim_model::{limits, math, model};

/// Distance that counts as infinite; coordinates and velocities beyond it count as divergence (MuJoCo's `mjMAXVAL`).
const MAXVAL: f64 = 1e10;
