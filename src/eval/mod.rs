//! Recordings of runs, and their replay.

#[cfg(feature = "npz")]
mod replay;

#[cfg(feature = "npz")]
pub use replay::{Recording, Replay, ReplayError, replay};
