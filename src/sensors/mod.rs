//! MIMo's senses: plain functions from [`crate::Model`] and [`crate::physics::State`] to observations.
//!
//! Positions and velocities are read as they are; everything else in the state describes the start of the last physics
//! step, so torques, accelerations, contacts and images lag by one step, as in the reference.

mod proprioception;
pub mod touch;
mod vestibular;
mod vision;

pub use proprioception::{Component, Entry, Proprioception, limit_activation};
pub use touch::{SkinLayout, Touch};
pub use vestibular::Vestibular;
pub use vision::{EYES, EYES_DEPTH, EYES_GRAY, EYES_SEGMENTATION, EyeImages, Vision};
