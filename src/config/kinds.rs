//! The values of keys: their types, their notation, their bounds.

use super::schedule::AgeSchedule;
use crate::text;

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyValue {
    /// `true` or `false`.
    Bool(bool),
    /// An integer.
    Whole(u64),
    /// A number.
    Number(f64),
    /// One of a few names.
    Choice(&'static str),
    /// Some of a few names.
    List(Vec<&'static str>),
    /// Any text.
    Text(String),
    /// No value: the key is not used.
    None,
}

impl KeyValue {
    /// Writes the value as YAML.
    pub fn to_yaml(&self) -> String {
        match self {
            Self::Bool(on) => on.to_string(),
            Self::Whole(number) => number.to_string(),
            // `Debug` writes 2.0, where `Display` writes 2, which YAML reads as an integer
            Self::Number(number) => format!("{number:?}"),
            Self::Choice(name) => (*name).to_string(),
            Self::List(names) => format!("[{}]", names.join(", ")),
            Self::Text(text) => quoted(text),
            Self::None => NONE.to_string(),
        }
    }
}

/// The word for a key that is not used.
const NONE: &str = "none";
/// Greatest length of a document in a configuration, bytes.
const MAX_DOCUMENT: usize = 1 << 20;
/// YAML's words for no value.
const NULL: [&str; 5] = ["", "~", "null", "Null", "NULL"];

/// The values that a key accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyKind {
    /// `true` or `false`.
    Bool,
    /// An integer in a closed range.
    Whole {
        /// Smallest value.
        min: u64,
        /// Largest value.
        max: u64,
    },
    /// A finite number: 0, or at least the given one.
    ZeroOrAtLeast(f64),
    /// A number in a closed range.
    Number {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A number in a closed range, or none.
    NoneOr {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// An integer in a closed range, or none.
    NoneOrWhole {
        /// Smallest value.
        min: u64,
        /// Largest value.
        max: u64,
    },
    /// One of the given names.
    Choice(&'static [&'static str]),
    /// One of the given names, or the path of a file.
    ChoiceOrFile {
        /// The names.
        names: &'static [&'static str],
        /// The ending of the path.
        ending: &'static str,
    },
    /// A list of one or more of the given names, each once.
    List(&'static [&'static str]),
    /// None, one of the given names, or a list of them, each once.
    NoneOrList(&'static [&'static str]),
    /// None, or ages over steps, as a mapping or as text such as `0: 1, 500000: 6`: [`AgeSchedule`].
    NoneOrAges {
        /// Greatest age, months.
        max: f64,
    },
    /// Text of at least one character, without control characters.
    Text,
    /// Text of any number of lines, or of none, up to 1 MiB.
    Document,
}

/// A reason why a value does not fit its key.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ValueFault {
    Missing,
    WrongType,
    OutOfRange { nearest: Option<&'static str> },
}

const OUT_OF_RANGE: ValueFault = ValueFault::OutOfRange { nearest: None };

impl KeyKind {
    /// Describes in words what is allowed.
    pub fn expected(&self) -> String {
        match self {
            Self::Bool => "true or false".to_string(),
            Self::Whole { min, max } => format!("a whole number from {min} to {max}"),
            Self::ZeroOrAtLeast(least) => format!("0 or a finite number of at least {least}"),
            Self::Number { min, max } => format!("a number from {min} to {max}"),
            Self::NoneOr { min, max } => format!("none or a number from {min} to {max}"),
            Self::NoneOrWhole { min, max } => format!("none or a whole number from {min} to {max}"),
            Self::Choice(names) => format!("one of {}", names.join(", ")),
            Self::ChoiceOrFile { names, ending } => {
                format!(
                    "one of {}, or the path of a file that ends in {ending}",
                    names.join(", ")
                )
            }
            Self::List(names) => format!("a list in brackets of one or more of {}, each once", names.join(", ")),
            Self::NoneOrList(names) => {
                format!("none, or a list in brackets of some of {}, each once", names.join(", "))
            }
            Self::NoneOrAges { max } => {
                format!("none, or ages to {max} months by rising steps from 0, as in {{0: 1, 500000: 6}}")
            }
            Self::Document => "text of up to 1 MiB, of any number of lines".to_string(),
            Self::Text => {
                "text, at least one character and no control characters (in quotes if it looks like a number, a \
                           boolean or null)"
                    .to_string()
            }
        }
    }

    /// Returns whether a key may have no value.
    pub(super) fn allows_none(&self) -> bool {
        matches!(
            self,
            Self::NoneOr { .. } | Self::NoneOrWhole { .. } | Self::NoneOrList(_) | Self::NoneOrAges { .. }
        )
    }

    /// Parses a YAML scalar. `plain` is false for quoted text, which is always text.
    pub(super) fn parse(&self, text: &str, plain: bool) -> Result<KeyValue, ValueFault> {
        // `none` in quotes means none as well: these keys have no other words
        if self.allows_none() && (text == NONE || plain && NULL.contains(&text)) {
            return Ok(KeyValue::None);
        }
        if plain && NULL.contains(&text) {
            return Err(ValueFault::Missing);
        }
        let value = match self {
            Self::Bool if plain => KeyValue::Bool(boolean(text).ok_or(ValueFault::WrongType)?),
            Self::Whole { .. } | Self::NoneOrWhole { .. } if plain => KeyValue::Whole(whole(text)?),
            Self::ZeroOrAtLeast(_) | Self::Number { .. } | Self::NoneOr { .. } if plain => {
                KeyValue::Number(number(text)?)
            }
            Self::Bool | Self::Whole { .. } | Self::ZeroOrAtLeast(_) | Self::List(_) => {
                return Err(ValueFault::WrongType);
            }
            Self::Number { .. } | Self::NoneOr { .. } | Self::NoneOrWhole { .. } => return Err(ValueFault::WrongType),
            Self::NoneOrAges { .. } if text.contains(':') => {
                let schedule = AgeSchedule::parse(text).ok_or(OUT_OF_RANGE)?;
                KeyValue::Text(schedule.to_string())
            }
            Self::NoneOrAges { .. } => return Err(ValueFault::WrongType),
            Self::Choice(names) => KeyValue::Choice(named(text, names)?),
            Self::NoneOrList(names) => KeyValue::List(vec![named(text, names)?]),
            // by the ending alone: whether the file exists is known when the scene is made, with the caller's assets
            Self::ChoiceOrFile { ending, .. } if text.ends_with(ending) => KeyValue::Text(text.to_string()),
            Self::ChoiceOrFile { names, .. } => KeyValue::Choice(named(text, names)?),
            Self::Text | Self::Document
                // PyYAML reads `save_dir: 1` as a number and `off` as false, so that the kit would see another value
                if plain && (boolean(text).is_some() || number(text) != Err(ValueFault::WrongType)) =>
            {
                return Err(ValueFault::WrongType);
            }
            Self::Text | Self::Document => KeyValue::Text(text.to_string()),
        };
        self.check(&value).map(|()| value)
    }

    /// Parses the next name of a list, after those in `list`.
    pub(super) fn parse_item(&self, text: &str, list: &mut Vec<&'static str>) -> Result<(), ValueFault> {
        let (Self::List(names) | Self::NoneOrList(names)) = self else {
            return Err(ValueFault::WrongType);
        };
        let name = named(text, names)?;
        // an output that is named twice would be twice in the memory of the observation, under one key
        if list.contains(&name) {
            return Err(OUT_OF_RANGE);
        }
        list.push(name);
        Ok(())
    }

    /// Checks that a value of the right type is allowed.
    pub(super) fn check(&self, value: &KeyValue) -> Result<(), ValueFault> {
        let fits = match (self, value) {
            (Self::Bool, KeyValue::Bool(_)) => true,
            (Self::Whole { min, max } | Self::NoneOrWhole { min, max }, KeyValue::Whole(number)) => {
                (min..=max).contains(&number)
            }
            (Self::ZeroOrAtLeast(least), KeyValue::Number(number)) => {
                number.is_finite() && (*number == 0.0 || number >= least)
            }
            (_, KeyValue::None) if self.allows_none() => true,
            (Self::NoneOrAges { max }, KeyValue::Text(text)) => {
                let schedule = AgeSchedule::parse(text);
                schedule.is_some_and(|schedule| schedule.points().iter().all(|(_, age)| age <= max))
            }
            (Self::Number { min, max } | Self::NoneOr { min, max }, KeyValue::Number(number)) => {
                (min..=max).contains(&number)
            }
            (Self::Choice(names), KeyValue::Choice(name)) => names.contains(name),
            (Self::List(names) | Self::NoneOrList(names), KeyValue::List(list)) => {
                let once = |(at, name): (usize, &&str)| names.contains(name) && !list[..at].contains(name);
                !list.is_empty() && list.iter().enumerate().all(once)
            }
            (Self::ChoiceOrFile { names, .. }, KeyValue::Choice(name)) => names.contains(name),
            (Self::ChoiceOrFile { ending, .. }, KeyValue::Text(path)) => {
                path.ends_with(ending) && !path.chars().any(char::is_control)
            }
            (Self::Text, KeyValue::Text(text)) => !text.is_empty() && !text.chars().any(char::is_control),
            (Self::Document, KeyValue::Text(text)) => {
                let strange = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
                text.len() <= MAX_DOCUMENT && !text.chars().any(strange)
            }
            _ => return Err(ValueFault::WrongType),
        };
        if fits { Ok(()) } else { Err(OUT_OF_RANGE) }
    }
}

/// Finds one of some names.
fn named(text: &str, names: &[&'static str]) -> Result<&'static str, ValueFault> {
    let nearest = || text::nearest(text, names.iter().copied());
    let found = names.iter().find(|name| **name == text).copied();
    found.ok_or_else(|| ValueFault::OutOfRange { nearest: nearest() })
}

/// Parses YAML 1.1's words for true and false, which PyYAML reads; `y` and `n` are text to it and so here.
fn boolean(text: &str) -> Option<bool> {
    match text {
        "true" | "True" | "TRUE" | "yes" | "Yes" | "YES" | "on" | "On" | "ON" => Some(true),
        "false" | "False" | "FALSE" | "no" | "No" | "NO" | "off" | "Off" | "OFF" => Some(false),
        _ => None,
    }
}

/// Parses decimal digits with an optional sign and `_` between digits. A leading zero is refused: YAML 1.1 and 1.2 read
/// it as different numbers.
fn whole(text: &str) -> Result<u64, ValueFault> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let decimal = digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.bytes().all(|b| b.is_ascii_digit() || b == b'_')
        && (digits.len() == 1 || !digits.starts_with('0'));
    if !decimal {
        return Err(ValueFault::WrongType);
    }
    let number = digits.replace('_', "").parse().map_err(|_| OUT_OF_RANGE)?;
    // -0 is a whole number to PyYAML
    if text.starts_with('-') && number != 0 {
        Err(OUT_OF_RANGE)
    } else {
        Ok(number)
    }
}

/// Parses an integer, or digits with a point or an exponent.
fn number(text: &str) -> Result<f64, ValueFault> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    if matches!(unsigned, ".inf" | ".Inf" | ".INF" | ".nan" | ".NaN" | ".NAN") {
        return Err(OUT_OF_RANGE);
    }
    let float = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && unsigned.bytes().all(|b| b.is_ascii_digit() || b"._eE+-".contains(&b))
        && unsigned.bytes().any(|b| b".eE".contains(&b));
    if !float && whole(text) == Err(ValueFault::WrongType) {
        return Err(ValueFault::WrongType);
    }
    let number: f64 = text.replace('_', "").parse().map_err(|_| ValueFault::WrongType)?;
    Ok(number + 0.0) // -0 becomes 0
}

/// Writes text in YAML's double quotes, with everything unusual escaped.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            ' '..='~' => out.push(c),
            // names of folders stay legible in any script; marks, spaces and the like are escaped, as they may be invisible
            _ if c.is_alphanumeric() => out.push(c),
            _ => out.push_str(&format!("\\U{:08X}", u32::from(c))),
        }
    }
    out.push('"');
    out
}
