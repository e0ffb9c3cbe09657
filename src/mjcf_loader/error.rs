//! Errors with their place.

use crate::text::{quoted, suggestion};
use std::fmt;
use std::path::Path;

use crate::assets::AssetError;

/// A location in a document: file, line, column and element.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Location {
    /// Path of the document in the asset source.
    pub file: String,
    /// Line, from 1; 0 when the error concerns the whole file.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Element names from the root of that file, joined by `/`; may be empty.
    pub element: String,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if self.line > 0 {
            write!(f, ":{}:{}", self.line, self.column)?;
        }
        if !self.element.is_empty() {
            write!(f, ": {}", quoted(&self.element))?;
        }
        Ok(())
    }
}

/// An element that has a rule but no reader. Rules and readers are in different files: without this error, such an element would load and have no
/// effect.
pub(super) const UNREAD: &str =
    "the library allows this element but does not read it: please report this as a bug, and remove it until then";

/// An error of a document, with its location.
///
/// Prints as `arm.xml:12:5: mujoco/worldbody/body/geom: unknown attribute "foo"`.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {kind}")]
pub struct LoadError {
    /// The place in the document.
    pub place: Box<Location>,
    /// Description of the fault.
    pub kind: ErrorKind,
}

impl LoadError {
    /// Names the file relative to the location of `folder`, in which the asset source looks for files, for users who gave the path of a file.
    #[must_use]
    pub fn in_folder(mut self, folder: &Path) -> Self {
        self.place.file = folder.join(&self.place.file).display().to_string();
        self
    }

    pub(super) fn in_file(file: &str, kind: impl Into<ErrorKind>) -> Self {
        let place = Location {
            file: file.to_owned(),
            ..Location::default()
        };
        LoadError {
            place: Box::new(place),
            kind: kind.into(),
        }
    }
}

/// Returns the text for a count of `min` to `max`.
fn span(min: usize, max: usize) -> String {
    if min == max {
        min.to_string()
    } else {
        format!("{min} to {max}")
    }
}

/// A fault of a document.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A file cannot be read from the source.
    #[error(transparent)]
    Asset(#[from] AssetError),
    /// The file is neither UTF-8 nor declared as Latin-1.
    #[error("not UTF-8 text, nor does it begin with <?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>")]
    NotUtf8,
    /// The text breaks the rules of XML.
    #[error("malformed XML: {}", quoted(.0))]
    Xml(String),
    /// Legal XML that is not allowed in MJCF: entities, text outside the root, processing instructions in it.
    #[error("{0} is not allowed; remove it")]
    Forbidden(&'static str),
    /// A limit on untrusted input.
    #[error("more than {limit} {what}")]
    TooMuch {
        /// The kind of item that exceeds the limit.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The root of the main document is not `mujoco`.
    #[error("the root element is \"{}\", not \"mujoco\"", quoted(.0))]
    WrongRoot(String),
    /// A file is included twice, or includes itself.
    #[error("file \"{}\" is already included", quoted(.0))]
    RepeatedInclude(String),
    /// A model that includes itself.
    #[error("the model of file \"{}\" cannot be a part of itself", quoted(.0))]
    ModelInItself(String),
    /// An element that is unknown, unsupported or in the wrong place.
    #[error("unknown element \"{}\"{}", quoted(.name), suggestion(*.nearest))]
    UnknownElement {
        /// The name found.
        name: String,
        /// The name of the allowed element that was probably meant.
        nearest: Option<&'static str>,
    },
    /// An element that MuJoCo added after 3.3.0.
    #[error("element \"{}\" was added after MuJoCo 3.3.0, the version supported here: remove it", quoted(.0))]
    LaterElement(String),
    /// A plugin of MuJoCo.
    #[error("plugin \"{}\" is a program of MuJoCo's own, which is not run here: {what}", quoted(.name))]
    Plugin {
        /// The plugin; empty where the element names an instance of one.
        name: String,
        /// Advice.
        what: &'static str,
    },
    /// An element of a part of the language that is not supported.
    #[error("element \"{}\": {what}", quoted(.name))]
    UnsupportedElement {
        /// The element.
        name: String,
        /// Explanation and advice.
        what: &'static str,
    },
    /// An element that may be here only once.
    #[error("element \"{}\" is given twice", quoted(.0))]
    RepeatedElement(&'static str),
    /// An attribute that is unknown or unsupported.
    #[error("unknown attribute \"{}\"{}", quoted(.name), suggestion(*.nearest))]
    UnknownAttribute {
        /// The name found.
        name: String,
        /// The attribute of the element that was probably meant.
        nearest: Option<&'static str>,
    },
    /// An attribute that MuJoCo added after 3.3.0, with a value that has an effect.
    #[error("attribute \"{}\" was added after MuJoCo 3.3.0, the version supported here: remove it", quoted(.0))]
    LaterAttribute(String),
    /// An attribute given twice.
    #[error("attribute \"{}\" is given twice", quoted(.0))]
    DuplicateAttribute(String),
    /// A required attribute is missing.
    #[error("attribute \"{0}\" is required")]
    MissingAttribute(&'static str),
    /// An element has more user data than `<size>` allows.
    #[error("user has {count} values, more than {attribute} in <size>")]
    UserExcess {
        /// The attribute of `<size>`.
        attribute: &'static str,
        /// The number of values found.
        count: usize,
    },
    /// Attributes that contradict each other.
    #[error("attributes \"{0}\" and \"{1}\" are mutually exclusive")]
    Conflict(&'static str, &'static str),
    /// A word that is not one of those allowed here.
    #[error("{attribute}=\"{}\": not one of {}", quoted(.text), .allowed.join(", "))]
    BadWord {
        /// The attribute.
        attribute: &'static str,
        /// The value found.
        text: String,
        /// The values allowed.
        allowed: &'static [&'static str],
    },
    /// A value that is not a finite number.
    #[error("{attribute}: \"{}\" is not a finite number", quoted(.text))]
    BadNumber {
        /// The attribute.
        attribute: &'static str,
        /// The offending word.
        text: String,
    },
    /// A number that is not zero but too near it for its digits to be kept.
    #[error("{attribute}: \"{}\" is too small to represent; write 0", quoted(.text))]
    TooSmall {
        /// The attribute.
        attribute: &'static str,
        /// The offending word.
        text: String,
    },
    /// A number that is out of bounds.
    #[error("{attribute}: {value} must be {want}")]
    OutOfRange {
        /// The attribute.
        attribute: &'static str,
        /// The number.
        value: f64,
        /// The values allowed.
        want: &'static str,
    },
    /// A size of a shape that is zero, negative or missing.
    #[error("size: {value} must be positive (number {number} of {count} for a {shape})")]
    BadSize {
        /// The shape, in the words of MJCF.
        shape: &'static str,
        /// Position of the number in `size`, from 1.
        number: usize,
        /// Count of the numbers that the shape has.
        count: usize,
        /// The number; 0 where it is missing.
        value: f64,
    },
    /// A whole number that is out of bounds.
    #[error("{attribute}: {value} must be from {min} to {max}")]
    OutOfBounds {
        /// The attribute.
        attribute: &'static str,
        /// The number.
        value: i64,
        /// Smallest number.
        min: i64,
        /// Largest number.
        max: i64,
    },
    /// A number above [`crate::Limits::real`] in magnitude.
    #[error("{attribute}: {value} must be at most {limit:e} in magnitude")]
    TooGreat {
        /// The attribute.
        attribute: &'static str,
        /// The number.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// Too few or too many values.
    #[error("{attribute}: {found} value{}, expected {}", if *.found == 1 { "" } else { "s" }, span(*.min, *.max))]
    WrongCount {
        /// The attribute.
        attribute: &'static str,
        /// The number of values found.
        found: usize,
        /// Fewest.
        min: usize,
        /// Most.
        max: usize,
    },
    /// A mesh, a height field or a picture that cannot be read.
    #[error("{}{message}", .file.as_ref().map(|file| format!("file \"{}\": ", quoted(file))).unwrap_or_default())]
    Mesh {
        /// The file; `None` for data in the document itself.
        file: Option<String>,
        /// Description of the fault.
        message: String,
    },
    /// A default class that was not declared.
    #[error("unknown default class \"{}\"{}", quoted(.name), suggestion(.nearest.as_deref()))]
    UnknownClass {
        /// The name found.
        name: String,
        /// The class that was probably meant.
        nearest: Option<String>,
    },
    /// A default class declared twice.
    #[error("default class \"{}\" is declared twice", quoted(.0))]
    DuplicateClass(String),
    /// Two elements of a kind with the same name.
    #[error("{kind} name \"{}\" is used twice", quoted(.name))]
    DuplicateName {
        /// Kind of element.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A name that no element has.
    #[error("{attribute}: there is no {kind} \"{}\"{}", quoted(.name), suggestion(.nearest.as_deref()))]
    UnknownName {
        /// The attribute that refers.
        attribute: &'static str,
        /// Kind of element.
        kind: &'static str,
        /// The name.
        name: String,
        /// The name of an element of that kind that was probably meant.
        nearest: Option<String>,
    },
    /// Valid syntax for an invalid model.
    #[error("{0}")]
    Invalid(&'static str),
}
