//! The model as a Rapier scene, and the contacts in it.
//!
//! Rapier holds every body and geom, with its pose written back each step, so ray casts, shape queries and debug
//! rendering work on the live scene. Contacts for the solver come from a sweep over the same geoms with the contact
//! routines of [`crate::physics::contact`] on world poses; the same routines are behind Rapier's query-dispatcher
//! interface, so Rapier's own collision pipeline finds the same contacts on demand.

mod dispatcher;
#[cfg(not(feature = "rapier"))]
mod others;
mod pairs;
mod scene;
mod sweep;

pub use dispatcher::ContactDispatcher;
pub use pairs::{ContactRules, Pair, PairTable};
pub use scene::{RapierScene, SceneContact};
#[cfg(feature = "rapier")]
pub(crate) use scene::{collider_order, geom_pose, pose, shape};
pub(crate) use sweep::Sweep;
