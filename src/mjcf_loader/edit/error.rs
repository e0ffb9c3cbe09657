//! Errors of editing a document.

use std::fmt;

use super::element_id::ElementId;
use crate::error::{ErrorKind, LoadError};
use crate::text::{quoted, suggestion};

/// An edit that is refused. The document is as it was before.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The element is not allowed in the other.
    #[error("<{parent}> cannot hold <{}>{}", quoted(.name), suggestion(*.nearest))]
    UnknownElement {
        /// The element around it.
        parent: &'static str,
        /// The requested name.
        name: String,
        /// A name that may have been meant.
        nearest: Option<&'static str>,
    },
    /// The element does not have the attribute.
    #[error("<{element}> has no attribute \"{}\"{}", quoted(.name), suggestion(*.nearest))]
    UnknownAttribute {
        /// The element.
        element: &'static str,
        /// The requested attribute.
        name: String,
        /// A name that may have been meant.
        nearest: Option<&'static str>,
    },
    /// The attribute does not accept the value.
    #[error("<{element}>: {kind}")]
    Value {
        /// The element.
        element: &'static str,
        /// Description of the fault.
        kind: ErrorKind,
    },
    /// The element is not in the document, or was removed.
    #[error("{0} is not in this document: it was removed, or belongs to another document")]
    NoElement(ElementId),
    /// Every document needs the element.
    #[error("<{0}> cannot be removed: a document needs it")]
    Needed(&'static str),
    /// No element of this kind has the name.
    #[error("there is no {kind} \"{}\"", quoted(.name))]
    UnknownName {
        /// Kind of element.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// Two elements of a kind have the same name.
    #[error("{kind} name \"{}\" is used twice: attach with another prefix or suffix", quoted(.name))]
    DuplicateName {
        /// Kind of element.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// The element cannot be attached.
    #[error("cannot attach: {0}")]
    Unattachable(&'static str),
    /// The documents have different settings of `compiler` that would change the meaning of numbers.
    #[error("cannot attach: compiler has {0}: use the same value in both documents")]
    Settings(Box<SettingsConflict>),
    /// The default class does not exist.
    #[error("unknown default class \"{}\"", quoted(.0))]
    UnknownClass(String),
    /// The attribute has no default, so a class cannot undo the setting of the other document's main class.
    #[error(
        "cannot attach: the main default class gives <{element}> {attribute}, which the attached elements would get: give them a value for it"
    )]
    Inherited {
        /// The element.
        element: &'static str,
        /// The attribute.
        attribute: &'static str,
    },
    /// The document cannot be read or compiled.
    #[error(transparent)]
    Load(#[from] LoadError),
}

/// A setting of `compiler` that differs between two documents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SettingsConflict {
    /// The attribute.
    pub attribute: &'static str,
    /// Its value in the document to which the other is attached.
    pub own: String,
    /// Its value in the attached document.
    pub other: String,
}

impl fmt::Display for SettingsConflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { attribute, own, other } = self;
        write!(
            f,
            "{attribute}=\"{own}\" here, and {attribute}=\"{other}\" where the attached body is from"
        )
    }
}
