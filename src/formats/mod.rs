//! File formats that other programs share: those of the engine, pickles and Motion-JPEG videos.

pub mod avi;
pub mod pickle;

pub use mjcf_sim::formats::*;
