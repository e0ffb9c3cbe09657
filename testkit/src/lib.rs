//! Shared by the tests of all packages.
//!
//! - [`harness`] runs tests that need something beyond the repository, and reports those that cannot run as ignored, with
//!   the reason.
//! - [`yardsticks`] finds what tests compare with, and fetches it where it can.
//! - [`adapters`] says what tests may demand of a graphics adapter.
//! - [`mutation`] damages text and bytes, for tests of what untrusted input does.
//!
//! Nothing here knows a type of the library, so that its unit tests can use all of it.

pub mod adapters;
pub mod harness;
pub mod mutation;
pub mod yardsticks;

pub use fastrand::Rng;
