//! What can be wrong with a configuration, and where.

use std::fmt;

/// Where in a file something stands; lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The name given by whoever reads the file.
    pub file: String,
    /// Line and column in characters; `None` where no one position is at fault.
    pub position: Option<(u32, u32)>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.position {
            Some((line, column)) => write!(f, "{}:{line}:{column}", self.file),
            None => f.write_str(&self.file),
        }
    }
}

/// Why a configuration was refused. Every message names the place, the key, the value and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// The file could not be read.
    #[error("{file}: {source}")]
    Read {
        /// The file.
        file: String,
        /// What the file system answered.
        source: std::io::Error,
    },
    /// The file is not UTF-8.
    #[error("{place}: this is not UTF-8 text; save the file as UTF-8")]
    Encoding {
        /// The first byte at fault.
        place: Place,
    },
    /// The text is longer than [`super::MAX_BYTES`].
    #[error("{place}: the configuration has more than {limit} bytes; a configuration needs a few thousand")]
    TooLarge {
        /// The file.
        place: Place,
        /// The most bytes accepted.
        limit: usize,
    },
    /// The text is not YAML.
    #[error("{place}: {message}")]
    Syntax {
        /// Where the parser gave up.
        place: Place,
        /// What it says.
        message: String,
    },
    /// YAML, but none that a configuration has a use for.
    #[error("{place}: {what}: a configuration is one flat list of `key: value` lines")]
    Unsupported {
        /// Where it stands.
        place: Place,
        /// What it is.
        what: String,
    },
    /// No such key.
    #[error("{place}: unknown key `{key}`{}", hint(.nearest))]
    UnknownKey {
        /// Where the key stands.
        place: Place,
        /// The key as written.
        key: String,
        /// The known key nearest to it, if one is near.
        nearest: Option<&'static str>,
    },
    /// The key was given before.
    #[error("{place}: `{key}` was already given in line {first_line}; keep one of the two")]
    DuplicateKey {
        /// Where it stands the second time.
        place: Place,
        /// The key.
        key: &'static str,
        /// The line where it stands first.
        first_line: u32,
    },
    /// The key has no value, or null.
    #[error("{place}: `{key}` needs a value: {expected}; leave the line out for the default")]
    MissingValue {
        /// Where the value should stand.
        place: Place,
        /// The key.
        key: &'static str,
        /// What is allowed.
        expected: String,
    },
    /// The value is of another type.
    #[error("{place}: `{key}` is {value}, expected {expected}")]
    WrongType {
        /// Where the value stands.
        place: Place,
        /// The key.
        key: &'static str,
        /// The value as written.
        value: String,
        /// What is allowed.
        expected: String,
    },
    /// The value is of the right type but not allowed.
    #[error("{place}: `{key}` is {value}, expected {expected}{}", hint(.nearest))]
    OutOfRange {
        /// Where the value stands.
        place: Place,
        /// The key.
        key: &'static str,
        /// The value as written.
        value: String,
        /// What is allowed.
        expected: String,
        /// The allowed name nearest to the value, if one is near.
        nearest: Option<&'static str>,
    },
    /// The value is not allowed together with the value of another key.
    #[error("{place}: `{key}` is {value}, but {reason}")]
    Conflict {
        /// Where the value stands.
        place: Place,
        /// The key.
        key: &'static str,
        /// Its value.
        value: String,
        /// What it contradicts and what to do.
        reason: String,
    },
}

impl ConfigError {
    /// Line and column of the fault, counted from 1, where one position is at fault.
    pub fn position(&self) -> Option<(u32, u32)> {
        match self {
            Self::Read { .. } => None,
            Self::Encoding { place }
            | Self::TooLarge { place, .. }
            | Self::Syntax { place, .. }
            | Self::Unsupported { place, .. }
            | Self::UnknownKey { place, .. }
            | Self::DuplicateKey { place, .. }
            | Self::MissingValue { place, .. }
            | Self::WrongType { place, .. }
            | Self::OutOfRange { place, .. }
            | Self::Conflict { place, .. } => place.position,
        }
    }

    /// The key at fault, as written.
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

/// Text of a file as an error message may show it: escaped and cut short.
pub(super) fn shown(text: &str) -> String {
    const MOST: usize = 60;
    let mut out: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    if text.chars().nth(MOST).is_some() {
        out.push_str("...");
    }
    out
}

/// The known name nearest to `text`, if so near that it was probably meant.
pub(super) fn nearest(text: &str, known: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    const LONGEST: usize = 64; // the distance costs the product of the lengths
    if text.len() > LONGEST {
        return None;
    }
    let text = text.to_lowercase();
    known
        .map(|name| (strsim::damerau_levenshtein(&text, name), name))
        .filter(|(distance, name)| *distance <= 1 + name.len() / 4)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

fn hint(nearest: &Option<&'static str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}
