//! The invariants of `ARCHITECTURE.md`, by number. The fourth, that a step
//! allocates nothing, is in `allocation.rs`; contacts and the live scene are in `scene.rs`.

mod bits;
mod doors;
mod errors;
mod life_cycle;
mod mechanics;
mod model;
mod sensors;
mod source;
mod statements;
mod types;
