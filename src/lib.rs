//! BabyBench in pure Rust.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod math;
pub mod model;

pub use model::Model;
