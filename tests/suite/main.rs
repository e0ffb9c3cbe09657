//! The tests that need nothing but the repository, in one program: each one more would link the whole library anew.
//!
//! Tests that need something else are in `tests/yardsticks`, those that count for a whole process in programs of their own.

#[path = "../common/allocations.rs"]
mod allocations;
#[path = "../common/mod.rs"]
mod common;

mod actuation;
mod additions;
mod batch;
mod blanket;
mod caregiver;
mod composed;
mod configurations;
mod differences;
mod eyes_at_once;
mod growing;
#[cfg(feature = "rapier")]
mod infant;
#[cfg(feature = "eval")]
mod invariants;
#[cfg(all(feature = "eval", feature = "npz"))]
mod json;
#[cfg(all(feature = "eval", feature = "npz"))]
mod logs;
mod milestones;
mod mimo3;
mod model_change;
#[cfg(all(feature = "eval", feature = "npz"))]
mod motion;
mod own_tasks;
mod parts;
mod plain_models;
#[cfg(feature = "eval")]
mod policies;
mod populations;
#[cfg(all(feature = "eval", feature = "npz"))]
mod protocols;
mod public_models;
#[cfg(feature = "rapier")]
mod rapier_engine;
#[cfg(all(feature = "eval", feature = "npz"))]
mod record;
mod reflexes;
#[cfg(all(feature = "eval", feature = "npz"))]
mod regards;
mod render;
#[cfg(feature = "eval")]
mod resume;
mod rooms;
#[cfg(feature = "rapier")]
mod scene;
#[cfg(feature = "eval")]
mod scene_file;
mod second_infant;
mod senses;
mod snapshot;
mod spatial_tendons;
mod tasks;
mod touch;
mod vector;
