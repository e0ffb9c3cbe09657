//! The errors of configurations, each with its position.

use std::fmt;

use crate::text::quoted;

/// A position in a file; lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Line and column in characters; `None` where no single position is at fault.
    pub position: Option<(u32, u32)>,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.position {
            Some((line, column)) => write!(f, "{}:{line}:{column}", self.file),
            None => f.write_str(&self.file),
        }
    }
}

/// A value that another one excludes: key, value, and why.
pub(super) type Conflict = (&'static str, String, String);

/// A reason why a configuration was refused. Every message names the location, the key, the value and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// The file could not be read.
    #[error("{file}: {source}")]
    Read {
        /// Name of the file.
        file: String,
        /// Error of the file system.
        source: std::io::Error,
    },
    /// The file is not UTF-8.
    #[error("{location}: this is not UTF-8 text; save the file as UTF-8")]
    Encoding {
        /// Position of the first byte at fault.
        location: Location,
    },
    /// The text is longer than [`crate::Limits::config_bytes`].
    #[error("{location}: the configuration has more than {limit} bytes; a configuration needs a few thousand")]
    TooLarge {
        /// Name of the file.
        location: Location,
        /// Greatest number of bytes accepted.
        limit: usize,
    },
    /// The text is not YAML.
    #[error("{location}: {}", quoted(.message))]
    Syntax {
        /// Position at which parsing stopped.
        location: Location,
        /// Message of the parser.
        message: String,
    },
    /// The text uses a feature of YAML that configurations do not need.
    #[error("{location}: {what}: a configuration is one flat list of `key: value` lines")]
    Unsupported {
        /// Position of the feature.
        location: Location,
        /// Name of the feature.
        what: String,
    },
    /// The key is unknown.
    #[error("{location}: unknown key `{}`{}", quoted(.key), hint(.nearest))]
    UnknownKey {
        /// Position of the key.
        location: Location,
        /// Key as written.
        key: String,
        /// Known key nearest to it, if one is near.
        nearest: Option<&'static str>,
    },
    /// The key was given twice.
    #[error("{location}: `{key}` was already given in line {first_line}; keep one of the two")]
    DuplicateKey {
        /// Position of the second occurrence.
        location: Location,
        /// Name of the key.
        key: &'static str,
        /// Line of the first occurrence.
        first_line: u32,
    },
    /// The key has no value, or null.
    #[error("{location}: `{key}` needs a value: {expected}; leave the line out for the default")]
    MissingValue {
        /// Position where the value should be.
        location: Location,
        /// Name of the key.
        key: &'static str,
        /// Description of what is allowed.
        expected: String,
    },
    /// The value has the wrong type.
    #[error("{location}: `{key}` is {}, expected {expected}", quoted(.value))]
    WrongType {
        /// Position of the value.
        location: Location,
        /// Name of the key.
        key: &'static str,
        /// Value as written.
        value: String,
        /// Description of what is allowed.
        expected: String,
    },
    /// The value has the right type but is not allowed.
    #[error("{location}: `{key}` is {}, expected {expected}{}", quoted(.value), hint(.nearest))]
    OutOfRange {
        /// Position of the value.
        location: Location,
        /// Name of the key.
        key: &'static str,
        /// Value as written.
        value: String,
        /// Description of what is allowed.
        expected: String,
        /// Allowed name nearest to the value, if one is near.
        nearest: Option<&'static str>,
    },
    /// The value contradicts that of another key.
    #[error("{location}: `{key}` is {}, but {reason}", quoted(.value))]
    Conflict {
        /// Position of the value.
        location: Location,
        /// Name of the key.
        key: &'static str,
        /// Value of the key.
        value: String,
        /// Explanation of the contradiction and its remedy.
        reason: String,
    },
}

impl ConfigError {
    /// Returns the line and column of the fault, counted from 1, where one position is at fault.
    pub fn position(&self) -> Option<(u32, u32)> {
        match self {
            Self::Read { .. } => None,
            Self::Encoding { location }
            | Self::TooLarge { location, .. }
            | Self::Syntax { location, .. }
            | Self::Unsupported { location, .. }
            | Self::UnknownKey { location, .. }
            | Self::DuplicateKey { location, .. }
            | Self::MissingValue { location, .. }
            | Self::WrongType { location, .. }
            | Self::OutOfRange { location, .. }
            | Self::Conflict { location, .. } => location.position,
        }
    }

    /// Returns the key at fault, as written.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::UnknownKey { key, .. } => Some(key),
            Self::DuplicateKey { key, .. }
            | Self::MissingValue { key, .. }
            | Self::WrongType { key, .. }
            | Self::OutOfRange { key, .. }
            | Self::Conflict { key, .. } => Some(key),
            Self::Read { .. }
            | Self::Encoding { .. }
            | Self::TooLarge { .. }
            | Self::Syntax { .. }
            | Self::Unsupported { .. } => None,
        }
    }
}

/// Prepares text from a file for an error message: escaped and shortened.
pub(super) fn shown(text: &str) -> String {
    const MOST: usize = 60;
    let mut out: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    if text.chars().nth(MOST).is_some() {
        out.push_str("...");
    }
    out
}

fn hint(nearest: &Option<&'static str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}
