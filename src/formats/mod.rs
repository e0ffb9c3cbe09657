//! File formats that other programs share: those of the engine, JPEG pictures, pickles and Motion-JPEG videos.

pub mod avi;
pub mod jpeg;
pub mod pickle;

pub use mjcf_sim::formats::*;
