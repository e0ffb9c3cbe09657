//! Attributes: their allowed values, how text becomes a value, and how a value reaches a field of the typed document.

mod store;

use super::error::ErrorKind;
use crate::limits::Limits;
pub(super) use store::{AttributeField, FieldVisitor};

/// Bounds on a number.
#[derive(Clone, Copy)]
pub(super) enum Sign {
    Any,
    NonNegative,
    Positive,
    Unit,
}

/// The value of an attribute.
#[derive(Clone, Copy)]
pub(super) enum AttributeKind {
    Text,
    Flag,
    Word(&'static [&'static str]),
    Int {
        min: i64,
        max: i64,
    },
    Reals {
        min: usize,
        max: usize,
        sign: Sign,
    },
    /// Lower and upper bound. Either may be infinite.
    Range,
    /// Four numbers that are not all zero.
    Quat,
    /// Three letters that name the axes of Euler angles.
    EulerSeq,
    /// Numbers for programs, up to the limits.
    User,
    /// The length of such data; -1 for that of the longest.
    UserCount,
    /// Numbers of a keyframe for a state. The compiler checks their count.
    State,
    /// Numbers of a keyframe for the poses of mocap bodies. The compiler checks their count.
    Poses,
    /// Numbers of a mesh, up to the limits.
    Data,
    /// Whole numbers of a mesh, up to the limits.
    Indices,
    /// Two whole numbers.
    Ints,
    /// Text that is never copied; its length is limited only by that of a document.
    LongText,
    /// A number of bytes, with a letter for its unit, or -1.
    Memory,
    /// Groups of actuators from 0 to 30, as bits.
    Groups,
}

pub(super) const TEXT: AttributeKind = AttributeKind::Text;
pub(super) const FLAG: AttributeKind = AttributeKind::Flag;
pub(super) const INTS: AttributeKind = AttributeKind::Ints;
pub(super) const RANGE: AttributeKind = AttributeKind::Range;
pub(super) const fn int(min: i64, max: i64) -> AttributeKind {
    AttributeKind::Int { min, max }
}
pub(super) const fn real(sign: Sign) -> AttributeKind {
    reals(1, sign)
}
/// Returns the kind of an attribute of exactly `n` values.
pub(super) const fn reals(n: usize, sign: Sign) -> AttributeKind {
    AttributeKind::Reals { min: n, max: n, sign }
}
/// Returns the kind of an attribute of between `min` and `max` values; the others keep their defaults.
pub(super) const fn some(min: usize, max: usize, sign: Sign) -> AttributeKind {
    AttributeKind::Reals { min, max, sign }
}

impl AttributeKind {
    /// Returns the kind itself. The column of kinds in a table may also hold [`Keywords`], which have the same method.
    pub const fn kind(self) -> AttributeKind {
        self
    }

    pub fn visit(self, field: &mut impl AttributeField, visit: FieldVisitor) {
        visit(field);
    }

    /// Returns whether values are lists of numbers. An empty list counts as not given.
    pub const fn is_numbers(self) -> bool {
        match self {
            AttributeKind::Reals { .. }
            | AttributeKind::Range
            | AttributeKind::Quat
            | AttributeKind::User
            | AttributeKind::State
            | AttributeKind::Poses
            | AttributeKind::Data => true,
            AttributeKind::Indices | AttributeKind::Ints => true,
            AttributeKind::Text
            | AttributeKind::LongText
            | AttributeKind::Flag
            | AttributeKind::Word(_)
            | AttributeKind::Int { .. }
            | AttributeKind::EulerSeq => false,
            AttributeKind::UserCount | AttributeKind::Groups | AttributeKind::Memory => false,
        }
    }
}

/// The keywords of an attribute, each with its value.
#[derive(Clone, Copy)]
pub(super) struct Keywords<T: 'static> {
    pub names: &'static [&'static str],
    pub values: &'static [T],
}

/// Pairs words with values: `words! { "fixed" => false, "targetbody" => true }`.
macro_rules! words {
    ($($name:literal => $value:expr),* $(,)?) => {
        $crate::attribute::Keywords { names: &[$($name),*], values: &[$($value),*] }
    };
}
pub(super) use words;

impl<T: Copy + PartialEq> Keywords<T> {
    pub const fn kind(self) -> AttributeKind {
        AttributeKind::Word(self.names)
    }

    pub fn visit(self, field: &mut impl KeywordField<T>, visit: FieldVisitor) {
        visit(&mut KeywordBinding { words: self, field });
    }
}

/// A field together with the keywords of its values.
struct KeywordBinding<'a, T: 'static, W> {
    words: Keywords<T>,
    field: &'a mut W,
}

impl<T: Copy + PartialEq, W: KeywordField<T>> AttributeField for KeywordBinding<'_, T, W> {
    fn store(&mut self, value: &Value) {
        if let Value::Word(index) = value
            && let Some(value) = self.words.values.get(*index)
        {
            self.field.set_word(*value);
        }
    }

    fn show(&self) -> String {
        let mut pairs = self.words.names.iter().zip(self.words.values);
        let Some(field) = self.field.word() else {
            return String::new();
        };
        pairs
            .find(|(_, value)| **value == field)
            .map(|(name, _)| (*name).to_owned())
            .unwrap_or_default()
    }
}

/// A field that a keyword sets.
pub(super) trait KeywordField<T> {
    fn set_word(&mut self, value: T);

    /// Returns the value, or `None` if none was given.
    fn word(&self) -> Option<T>;
}

impl<T: Copy> KeywordField<T> for T {
    fn set_word(&mut self, value: T) {
        *self = value;
    }

    fn word(&self) -> Option<T> {
        Some(*self)
    }
}

impl<T: Copy> KeywordField<T> for Option<T> {
    fn set_word(&mut self, value: T) {
        *self = Some(value);
    }

    fn word(&self) -> Option<T> {
        *self
    }
}

/// Groups of attributes that exclude each other: an element may have one attribute of a group.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Alternatives {
    Orientation,
    Inertia,
    Transmission,
    First,
    Second,
}

impl Alternatives {
    pub const ALL: [Alternatives; 5] = [
        Alternatives::Orientation,
        Alternatives::Inertia,
        Alternatives::Transmission,
        Alternatives::First,
        Alternatives::Second,
    ];
}

/// The groups of attributes of a table.
pub(super) type Groups = &'static [&'static [Attr]];

/// An attribute: one line of a table.
#[derive(Clone, Copy)]
pub(super) struct Attr {
    pub name: &'static str,
    pub kind: AttributeKind,
    /// Meaning, for display.
    pub meaning: &'static str,
    /// Writes the default of the attribute with this name as a document would; empty if there is none. One function serves a whole
    /// table, to avoid a function for each attribute.
    pub default: fn(&str) -> String,
    /// Whether the element must have it.
    pub required: bool,
    /// Whether it belongs only to the element and has no place in a default class.
    pub own: bool,
    pub rivals: Option<Alternatives>,
}

impl Attr {
    pub const fn new(
        name: &'static str,
        kind: AttributeKind,
        meaning: &'static str,
        default: fn(&str) -> String,
    ) -> Attr {
        Attr {
            name,
            kind,
            meaning,
            default,
            required: false,
            own: false,
            rivals: None,
        }
    }

    pub const fn own(self) -> Attr {
        Attr { own: true, ..self }
    }

    pub const fn required(self) -> Attr {
        Attr {
            required: true,
            own: true,
            ..self
        }
    }

    pub const fn orientation(self) -> Attr {
        Attr {
            rivals: Some(Alternatives::Orientation),
            ..self
        }
    }

    pub const fn inertia(self) -> Attr {
        Attr {
            rivals: Some(Alternatives::Inertia),
            ..self
        }
    }

    pub const fn transmission(self) -> Attr {
        Attr {
            rivals: Some(Alternatives::Transmission),
            ..self
        }
    }

    pub const fn first(self) -> Attr {
        Attr {
            rivals: Some(Alternatives::First),
            ..self
        }
    }

    pub const fn second(self) -> Attr {
        Attr {
            rivals: Some(Alternatives::Second),
            ..self
        }
    }

    /// Reads the text of the attribute.
    pub fn parse(&self, text: &str, limits: &Limits) -> Result<Value, ErrorKind> {
        let attribute = self.name;
        match self.kind {
            AttributeKind::Text if text.len() > limits.text_bytes => Err(ErrorKind::TooMuch {
                what: "bytes in a name or path",
                limit: limits.text_bytes,
            }),
            AttributeKind::Text | AttributeKind::LongText => Ok(Value::Text(text.to_owned())),
            AttributeKind::Memory if is_memory(text) => Ok(Value::Text(text.to_owned())),
            AttributeKind::Memory => Err(ErrorKind::BadNumber {
                attribute,
                text: excerpt(text),
            }),
            AttributeKind::Flag => Ok(Value::Flag(word(attribute, text, &["false", "true"])? == 1)),
            AttributeKind::Word(allowed) => Ok(Value::Word(word(attribute, text, allowed)?)),
            AttributeKind::Int { min, max } => whole(attribute, text, min, max).map(Value::Int),
            AttributeKind::UserCount => {
                whole(attribute, text, -1, i64::try_from(limits.user).unwrap_or(i64::MAX)).map(Value::Int)
            }
            AttributeKind::User => numbers(attribute, text, 0, limits.user, Sign::Any, limits.real).map(Value::Reals),
            AttributeKind::State => {
                numbers(attribute, text, 0, limits.state(), Sign::Any, limits.real).map(Value::Reals)
            }
            AttributeKind::Poses => {
                numbers(attribute, text, 0, 4 * limits.bodies, Sign::Any, limits.real).map(Value::Reals)
            }
            AttributeKind::Data => {
                numbers(attribute, text, 0, limits.mesh_numbers, Sign::Any, limits.real).map(Value::Reals)
            }
            AttributeKind::Indices => {
                each(attribute, text, 0, limits.mesh_numbers, |word| integer(attribute, word)).map(Value::Reals)
            }
            AttributeKind::Ints => each(attribute, text, 2, 2, |word| integer(attribute, word)).map(Value::Reals),
            AttributeKind::Groups => {
                let each = |word: &str| whole(attribute, word, 0, 30).map(|group| 1 << group);
                let mut bits = text.split_ascii_whitespace().map(each);
                bits.try_fold(0, |all, bit| bit.map(|bit: i64| all | bit))
                    .map(Value::Int)
            }
            AttributeKind::Reals { min, max, sign } => {
                numbers(attribute, text, min, max, sign, limits.real).map(Value::Reals)
            }
            AttributeKind::Range => {
                each(attribute, text, 2, 2, |word| bound(attribute, word, limits.real)).map(Value::Reals)
            }
            AttributeKind::Quat => match numbers(attribute, text, 4, 4, Sign::Any, limits.real)? {
                zero if zero.iter().all(|&v| v == 0.0) => Err(ErrorKind::Invalid(ZERO_QUAT)),
                quat => Ok(Value::Reals(quat)),
            },
            AttributeKind::EulerSeq => {
                let letters: Option<[u8; 3]> = text.as_bytes().try_into().ok();
                letters
                    .filter(|letters| letters.iter().all(|letter| b"xyzXYZ".contains(letter)))
                    .map(Value::Letters)
                    .ok_or(ErrorKind::Invalid("eulerseq must be three letters of xyzXYZ"))
            }
        }
    }
}

/// The value of an attribute.
pub(super) enum Value {
    Text(String),
    Flag(bool),
    /// The index of the word.
    Word(usize),
    Int(i64),
    Reals(Vec<f64>),
    Letters([u8; 3]),
}

/// Also used where `fromto` or another orientation replaces the quaternion.
pub(super) const ZERO_QUAT: &str = "a zero quaternion is not an orientation";

fn whole(attribute: &'static str, text: &str, min: i64, max: i64) -> Result<i64, ErrorKind> {
    let value: i64 = text.trim().parse().map_err(|_| ErrorKind::BadNumber {
        attribute,
        text: excerpt(text),
    })?;
    if value >= min && value <= max {
        return Ok(value);
    }
    Err(ErrorKind::OutOfBounds {
        attribute,
        value,
        min,
        max,
    })
}

/// Reads a whole number of a list: only digits, as in MuJoCo.
fn integer(attribute: &'static str, text: &str) -> Result<f64, ErrorKind> {
    let (min, max) = (i64::from(i32::MIN), i64::from(i32::MAX));
    whole(attribute, text, min, max).map(|value| value as f64)
}

/// Returns whether a text is a number of bytes as MuJoCo reads it: digits and a letter for 2^10 to 2^60, or -1 for its own choice.
fn is_memory(text: &str) -> bool {
    let text = text.trim_ascii();
    let units = ['k', 'm', 'g', 't', 'p', 'e'];
    let unit = |end: char| units.iter().position(|unit| *unit == end.to_ascii_lowercase());
    let (digits, shift) = match text.chars().next_back().and_then(unit) {
        Some(place) => (&text[..text.len() - 1], 10 * (place as u32 + 1)),
        None => (text, 0),
    };
    let bytes = digits.parse::<u64>().ok().filter(|_| !digits.starts_with('+'));
    text == "-1" || bytes.is_some_and(|bytes| bytes.leading_zeros() >= shift || bytes == 0)
}

fn numbers(
    attribute: &'static str,
    text: &str,
    min: usize,
    max: usize,
    sign: Sign,
    limit: f64,
) -> Result<Vec<f64>, ErrorKind> {
    each(attribute, text, min, max, |word| number(attribute, word, sign, limit))
}

/// Reads between `min` and `max` words of a text.
fn each(
    attribute: &'static str,
    text: &str,
    min: usize,
    max: usize,
    read: impl Fn(&str) -> Result<f64, ErrorKind>,
) -> Result<Vec<f64>, ErrorKind> {
    // as in MuJoCo, vertical tabs are spaces, too
    let space = |c: char| c.is_ascii_whitespace() || c == '\u{b}';
    let words = text.split(space).filter(|word| !word.is_empty());
    let found = words.clone().count();
    if found < min || found > max {
        return Err(ErrorKind::WrongCount {
            attribute,
            found,
            min,
            max,
        });
    }
    words.map(read).collect()
}

/// Returns the beginning of a text, for messages.
fn excerpt(text: &str) -> String {
    text.chars().take(60).collect()
}

fn word(attribute: &'static str, text: &str, allowed: &'static [&'static str]) -> Result<usize, ErrorKind> {
    let found = allowed.iter().position(|word| *word == text);
    found.ok_or_else(|| ErrorKind::BadWord {
        attribute,
        text: excerpt(text),
        allowed,
    })
}

/// Reads a number or an infinity. MuJoCo accepts an infinity by name, but not digits that amount to one.
fn bound(attribute: &'static str, text: &str, limit: f64) -> Result<f64, ErrorKind> {
    match text.parse::<f64>() {
        Ok(value) if value.is_infinite() && !text.contains(|c: char| c.is_ascii_digit()) => Ok(value),
        _ => number(attribute, text, Sign::Any, limit),
    }
}

fn number(attribute: &'static str, text: &str, sign: Sign, limit: f64) -> Result<f64, ErrorKind> {
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    let value = value.ok_or_else(|| ErrorKind::BadNumber {
        attribute,
        text: excerpt(text),
    })?;
    // digits of the mantissa that are lost, as in 1e-320 and 1e-400
    let digits = text.split(['e', 'E']).next().unwrap_or_default();
    if value.is_subnormal() || value == 0.0 && digits.contains(|c: char| ('1'..='9').contains(&c)) {
        return Err(ErrorKind::TooSmall {
            attribute,
            text: excerpt(text),
        });
    }
    if value.abs() > limit {
        return Err(ErrorKind::TooGreat {
            attribute,
            value,
            limit,
        });
    }
    let (allowed, want) = match sign {
        Sign::Any => (true, ""),
        Sign::NonNegative => (value >= 0.0, "at least 0"),
        Sign::Positive => (value > 0.0, "positive"),
        Sign::Unit => ((0.0..=1.0).contains(&value), "between 0 and 1"),
    };
    if allowed {
        Ok(value)
    } else {
        Err(ErrorKind::OutOfRange { attribute, value, want })
    }
}
