//! The place in the document at which elements are inserted, and their default class.

use super::Classes;
use crate::error::LoadError;
use crate::schema::Element;

/// The body, and the frame in it, into which new elements are inserted.
#[derive(Clone, Copy)]
pub(super) struct Insertion {
    pub body: usize,
    pub within: Option<usize>,
}

impl Insertion {
    /// The world itself.
    pub const WORLD: Self = Insertion { body: 0, within: None };
}

/// Checks that a default class for children exists.
pub(super) fn known(e: &Element, class: &str, classes: &Classes) -> Result<(), LoadError> {
    if classes.by_name.contains_key(class) {
        Ok(())
    } else {
        Err(classes.unknown(e, class))
    }
}
