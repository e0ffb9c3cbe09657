//! Joint-space dynamics: kinematics, inertia, bias and passive forces, actuation, integration.
//!
//! Each function computes one group of quantities of [`crate::State`] from the ones before it, in the order in
//! which [`crate::SoftEngine`] calls them.

mod activation;
mod actuation;
mod applied;
mod articulated;
mod constants;
mod derivative;
mod ellipsoid;
mod flex;
mod fluid;
mod inertia;
mod integrate;
mod kinematics;
mod muscle;
mod post_constraint;
mod sensor;
mod springs;
pub mod stages;
mod tendon;
mod transmission;
mod tree_matrix;
mod velocity;
mod wrap;

pub use actuation::fwd_actuation;
pub use articulated::{Articulated, Damping, Four};
pub use constants::{MAX_WEIGHT, constants};
pub use flex::flexes;
pub use inertia::mul_m;
pub use inertia::{CompositeInertia, crb};
pub use integrate::{Integrator, RungeKutta};
pub use kinematics::{cameras, com_pos, kinematics};
pub use post_constraint::rne_post_constraint;
pub use sensor::{SensorScratch, sensors};
pub use tendon::tendons;
pub use transmission::dense_moment;
pub use transmission::transmissions;
pub use velocity::{BiasScratch, fwd_velocity};
