//! MIMo's senses: plain functions from [`crate::Model`] and [`crate::physics::State`] to observations.
//!
//! Positions and velocities are the current ones. Everything else in the state describes the start of the last physics step, so torques,
//! accelerations, contacts and images lag by one step, as in the reference.

mod pain;
mod proprioception;
mod sense;
pub mod touch;
pub mod transform;
mod vestibular;
mod vision;

pub use pain::Pain;
pub use proprioception::limit_activation;
pub use proprioception::{Proprioception, ProprioceptionComponent, ProprioceptionEntry};
pub use sense::ObservationEntry;
pub(crate) use sense::observation_entries;
pub use touch::TouchPool;
pub use touch::{SkinLayout, SkinValues, Touch};
pub use vestibular::Vestibular;
pub use vision::{EYES, EyeImages, Vision};
