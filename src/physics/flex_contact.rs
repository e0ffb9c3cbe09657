//! Contacts of flexes.

use crate::state::Contact;

/// One side of a contact of a flex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactSide {
    /// A geom, by id.
    Geom(usize),
    /// A vertex of a flex.
    Vertex {
        /// The flex, by id.
        flex: usize,
        /// The vertex in the flex.
        vertex: usize,
    },
    /// An element of a flex.
    Element {
        /// The flex, by id.
        flex: usize,
        /// The element in the flex.
        element: usize,
    },
}

/// A detected contact of which at least one side is a flex.
#[doc(alias = "mjContact")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexContact {
    /// The sides, the first of which the normal points away from. MuJoCo's `geom`, `flex`, `elem` and `vert`.
    pub sides: [ContactSide; 2],
    /// Everything else. Its `geom` has no meaning.
    pub contact: Contact,
    /// Number of contacts of geoms, [`State::contact`](crate::State::contact), that come before it in MuJoCo's list, in which contacts of geoms
    /// and flexes are mixed.
    pub after: usize,
}

impl FlexContact {
    /// Returns the geoms of both sides.
    pub fn geoms(&self) -> [Option<usize>; 2] {
        self.sides.map(|side| match side {
            ContactSide::Geom(geom) => Some(geom),
            _ => None,
        })
    }
}
