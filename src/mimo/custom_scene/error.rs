//! Faults of a custom scene.

use thiserror::Error;

use crate::config::Scene;
use crate::mjcf_loader::Location;
use crate::text::quoted;

/// A fault of a custom scene, with its remedy.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum CustomSceneError {
    /// The document cannot be read.
    #[error(
        "`scene` is {}: {reason}; `scene` is one of {}, or the path of an MJCF document, which starts at the folder of the \
         configuration file, or else at the working directory",
        quoted(.path), Scene::NAMES.join(", ")
    )]
    NoDocument {
        /// Its path.
        path: String,
        /// Description of the fault.
        reason: String,
    },
    /// The document has the name of a file of the library.
    #[error("`scene` is {}: the library has a file called {name} itself, which documents include by that name; rename yours", quoted(.path))]
    Shadowed {
        /// Its path.
        path: String,
        /// Its name.
        name: String,
    },
    /// There is text between the elements that are added to a scene.
    #[error(
        "scene_extra:{line}:{column}: {} stands where no element is, and adds nothing: scene_extra is MJCF itself, as in <geom size=\".1\"/>, \
         not the name of a file; a document of one's own is the key `scene`",
        quoted(.text)
    )]
    Stray {
        /// Line of the text, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The text.
        text: String,
    },
    /// The document lacks a part of MIMo.
    #[error("{}: <include file=\"{file}\"/> is missing {place}: it has {what}", quoted(.path))]
    Lacks {
        /// Path of the document.
        path: String,
        /// The include that it needs.
        file: &'static str,
        /// Where.
        place: &'static str,
        /// The contents of that file.
        what: &'static str,
    },
    /// An element is not allowed in a custom scene, or not in this form.
    #[error("{place}: {reason}")]
    At {
        /// Place of the element.
        place: Box<Location>,
        /// Description of the fault, and its remedy.
        reason: String,
    },
    /// The document changes MIMo.
    #[error(
        "{}: this makes another MIMo: {part} has {field} {found} instead of {expected}; a <default> without a class, or a \
         <compiler>, reaches him: put <include file=\"mimo_settings.xml\"/> before it, or give your elements a class of their own",
        quoted(.path)
    )]
    Changed {
        /// Path of the document.
        path: String,
        /// The changed element: its kind and name.
        part: String,
        /// The number, by the name of MuJoCo's array.
        field: &'static str,
        /// Its value.
        found: String,
        /// The library's value.
        expected: String,
    },
}
