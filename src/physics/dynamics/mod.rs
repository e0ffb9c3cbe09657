//! Joint-space dynamics: kinematics, inertia, bias and passive forces, actuation, integration.
//!
//! Each function computes one group of quantities of [`crate::physics::State`] from the ones before it, in the order in
//! which [`crate::physics::SoftEngine`] calls them.

mod actuation;
mod articulated;
mod constants;
mod inertia;
mod integrate;
mod kinematics;
mod post_constraint;
mod velocity;

pub use actuation::fwd_actuation;
pub use articulated::{Articulated, Damping};
pub use constants::set_const;
pub use inertia::{crb, mul_m};
pub use integrate::{Integrator, integrate_pos};
pub use kinematics::{cameras, com_pos, kinematics};
pub use post_constraint::rne_post_constraint;
pub use velocity::{BiasScratch, com_vel, fwd_velocity};
