//! The records that a document keeps about attached models: their keyframes, references that were not copied, and the amount copied.

use std::collections::BTreeMap;

use super::error::{ErrorKind, LoadError};
use super::xml::Tree;

/// A kind of element that others refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ElementKind {
    Body,
    Joint,
    Geom,
    Site,
    Camera,
    Tendon,
    Actuator,
}

/// A keyframe of an attached model, with its name in the document. Its values are stored with the joints, actuators and bodies to which they belong;
/// all others are those of `qpos0`.
#[derive(Clone)]
pub(super) struct AttachedKeyframe {
    pub at: usize,
    pub name: String,
    pub time: f64,
}

/// The values of one element in keyframes, by the keyframe's name: `qpos` and `qvel` of a joint, `act` and `ctrl` of an actuator, `mpos`
/// and `mquat` of a mocap body.
pub(super) type KeyframeValues = BTreeMap<String, [Vec<f64>; 2]>;

/// A reference to an element that `<attach>` did not copy, so the element with the reference was not copied either.
pub(super) struct MissingReference {
    pub at: usize,
    pub thing: ElementKind,
    pub name: String,
}

/// The amount of work done for `<attach>`, which the limits bound: a few bytes of text may request another copy of a whole model.
#[derive(Clone, Copy, Default)]
pub(super) struct CopyCount {
    pub elements: usize,
    /// Numbers of assets.
    pub numbers: usize,
    /// Numbers in keyframes.
    pub said: usize,
}

impl CopyCount {
    /// Adds the numbers in a document's keyframes.
    ///
    /// # Errors
    /// As [`CopyCount::add`].
    pub(super) fn add_keys(&mut self, said: usize, at: usize, tree: &Tree) -> Result<(), LoadError> {
        let others = Self {
            said,
            ..Self::default()
        };
        self.add(others, at, tree)
    }

    /// Adds others for the element at a place.
    ///
    /// # Errors
    /// It is more than the limits allow.
    pub(super) fn add(&mut self, others: Self, at: usize, tree: &Tree) -> Result<(), LoadError> {
        self.elements += others.elements;
        self.numbers += others.numbers;
        self.said += others.said;
        let limits = &tree.limits;
        for (what, found, limit) in [
            ("elements of attached models", self.elements, limits.elements),
            (
                "numbers in assets of attached models",
                self.numbers,
                limits.mesh_elements,
            ),
            ("numbers in keyframes", self.said, limits.key_numbers),
        ] {
            if found > limit {
                return Err(tree.error(at, ErrorKind::TooMuch { what, limit }));
            }
        }
        Ok(())
    }
}
