//! Identifiers of elements in a program.

use std::fmt;

/// An element of a [`Document`](super::Document). It stays the same element when others are added or removed around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ElementId(pub(super) usize);

impl ElementId {
    /// Returns a number that identifies the element in its document.
    #[must_use]
    pub fn index(self) -> usize {
        self.0
    }
}

impl fmt::Display for ElementId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "element {}", self.0)
    }
}
