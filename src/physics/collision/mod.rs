//! Collision detection: the geoms that may touch, and those that do.
//!
//! A sweep over the boxes of all geoms finds the pairs that may touch; the routines of [`crate::contact`] work
//! on world poses, as contact geometry is discontinuous in their last bits.

mod boxes;
mod broad;
mod flexes;
mod pairs;
mod sweep;
mod trees;

use crate::contact::{ContactOptions, Quirks};
use crate::model::Model;

pub use flexes::FlexSweep;
pub use pairs::{ContactRules, GeomPair, PairTable};
pub use sweep::Sweep;
pub use sweep::placed;

/// Returns the options of the contact routines for a model, with the given peculiarities.
pub fn contact_options(model: &Model, quirks: Quirks) -> ContactOptions {
    ContactOptions {
        ccd_tolerance: model.opt.ccd_tolerance,
        ccd_iterations: model.opt.ccd_iterations,
        nativeccd: model.opt.flags.nativeccd,
        multiccd: model.opt.flags.multiccd,
        quirks,
    }
}
