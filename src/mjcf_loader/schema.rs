//! Checks a tree against the tables of elements and attributes, and turns attribute text into values.

use super::error::{ErrorKind, LoadError};
use super::tables::EXCLUSIVE;
use super::xml::Tree;
use super::{MAX_REAL, MAX_TEXT_BYTES};

/// Bounds on a number.
#[derive(Clone, Copy)]
pub(super) enum Sign {
    Any,
    NonNegative,
    Positive,
    Unit,
}

/// What an attribute holds.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Text,
    Flag,
    Word(&'static [&'static str]),
    Int { min: i64, max: i64 },
    Reals { min: usize, max: usize, sign: Sign },
}

/// An attribute.
pub(super) struct Attr {
    pub name: &'static str,
    pub kind: Kind,
    pub required: bool,
}

/// An element: groups of attributes and the elements it may hold.
pub(super) struct Spec {
    pub name: &'static str,
    pub attrs: &'static [&'static [Attr]],
    pub children: &'static [&'static Spec],
}

/// The value of an attribute.
pub(super) enum Value {
    Text(String),
    Flag(bool),
    Word(usize),
    Int(i64),
    Reals(Vec<f64>),
}

/// A checked element. The getters give nothing when the attribute is absent.
pub(super) struct Element {
    pub at: usize,
    pub name: &'static str,
    values: Vec<(&'static str, Value)>,
    pub children: Vec<Element>,
}

impl Element {
    fn value(&self, name: &str) -> Option<&Value> {
        self.values
            .iter()
            .find(|(other, _)| *other == name)
            .map(|(_, value)| value)
    }

    pub fn text(&self, name: &str) -> Option<&str> {
        match self.value(name) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    pub fn reals(&self, name: &str) -> Option<&[f64]> {
        match self.value(name) {
            Some(Value::Reals(values)) => Some(values),
            _ => None,
        }
    }

    pub fn array<const N: usize>(&self, name: &str) -> Option<[f64; N]> {
        self.reals(name)?.try_into().ok()
    }

    /// Sets the leading entries that the attribute gives; the others keep their defaults.
    pub fn fill(&self, name: &str, into: &mut [f64]) {
        for (to, from) in into.iter_mut().zip(self.reals(name).unwrap_or_default()) {
            *to = *from;
        }
    }

    pub fn set_real(&self, name: &str, into: &mut f64) {
        self.fill(name, std::slice::from_mut(into));
    }

    pub fn set_flag(&self, name: &str, into: &mut bool) {
        if let Some(Value::Flag(value)) = self.value(name) {
            *into = *value;
        }
    }

    pub fn set_text(&self, name: &str, into: &mut String) {
        if let Some(text) = self.text(name) {
            text.clone_into(into);
        }
    }

    pub fn set_optional_text(&self, name: &str, into: &mut Option<String>) {
        if let Some(text) = self.text(name) {
            *into = Some(text.to_owned());
        }
    }

    /// Sets from the word's place in the table of values that belongs to the attribute.
    pub fn set_word<T: Copy>(&self, name: &str, table: &[T], into: &mut T) {
        if let Some(Value::Word(index)) = self.value(name)
            && let Some(value) = table.get(*index)
        {
            *into = *value;
        }
    }

    pub fn set_int<T: TryFrom<i64>>(&self, name: &str, into: &mut T) {
        if let Some(Value::Int(value)) = self.value(name)
            && let Ok(value) = T::try_from(*value)
        {
            *into = value;
        }
    }
}

/// Also where `fromto` or another orientation takes its place.
pub(super) const ZERO_QUAT: &str = "a zero quaternion is not an orientation";

/// Checks an element and all below it. Recursion is bounded by the depth limit of the parser.
pub(super) fn check(tree: &Tree, at: usize, spec: &'static Spec) -> Result<Element, LoadError> {
    let mut element = check_one(tree, at, spec)?;
    for &child in &tree.nodes[at].children {
        let child_spec = child_spec(tree, child, spec)?;
        if once(spec.name, child_spec.name) && element.children.iter().any(|c| c.name == child_spec.name) {
            return Err(tree.error(child, ErrorKind::RepeatedElement(child_spec.name)));
        }
        element.children.push(check(tree, child, child_spec)?);
    }
    Ok(element)
}

/// Whether an element may hold another once only.
fn once(parent: &str, child: &str) -> bool {
    match parent {
        "visual" => true,
        "default" => child != "default",
        "body" => child == "inertial",
        _ => false,
    }
}

fn child_spec(tree: &Tree, child: usize, spec: &'static Spec) -> Result<&'static Spec, LoadError> {
    let name = &tree.nodes[child].name;
    let found = spec.children.iter().find(|spec| spec.name == name);
    found
        .copied()
        .ok_or_else(|| tree.error(child, ErrorKind::UnknownElement(name.clone())))
}

/// Checks an element without its children. Apart from `check`, whose frames pile up.
#[inline(never)]
fn check_one(tree: &Tree, at: usize, spec: &'static Spec) -> Result<Element, LoadError> {
    let node = &tree.nodes[at];
    let attrs = || spec.attrs.iter().flat_map(|group| group.iter());
    let mut values = Vec::with_capacity(node.attributes.len());
    for (name, text) in &node.attributes {
        let found = attrs().find(|attr| attr.name == name);
        let attr = found.ok_or_else(|| tree.error(at, ErrorKind::UnknownAttribute(name.clone())))?;
        values.push((attr.name, parse(attr, text).map_err(|kind| tree.error(at, kind))?));
    }
    for group in EXCLUSIVE {
        let mut given = values.iter().map(|(name, _)| *name).filter(|name| group.contains(name));
        if let (Some(first), Some(second)) = (given.next(), given.next()) {
            return Err(tree.error(at, ErrorKind::Conflict(first, second)));
        }
    }
    let missing = attrs().find(|attr| attr.required && !values.iter().any(|(name, _)| *name == attr.name));
    match missing {
        Some(attr) => Err(tree.error(at, ErrorKind::MissingAttribute(attr.name))),
        None => Ok(Element {
            at,
            name: spec.name,
            values,
            children: Vec::with_capacity(node.children.len()),
        }),
    }
}

fn parse(attr: &Attr, text: &str) -> Result<Value, ErrorKind> {
    let attribute = attr.name;
    match attr.kind {
        Kind::Text if text.len() > MAX_TEXT_BYTES => Err(ErrorKind::TooMuch {
            what: "bytes in a name or path",
            limit: MAX_TEXT_BYTES,
        }),
        Kind::Text => Ok(Value::Text(text.to_owned())),
        Kind::Flag => Ok(Value::Flag(word(attribute, text, &["false", "true"])? == 1)),
        Kind::Word(allowed) => Ok(Value::Word(word(attribute, text, allowed)?)),
        Kind::Int { min, max } => {
            let bad = || ErrorKind::BadNumber {
                attribute,
                text: excerpt(text),
            };
            let value: i64 = text.trim().parse().map_err(|_| bad())?;
            if value < min || value > max {
                let want = if value < min && min == 0 {
                    "at least 0"
                } else {
                    "within the limits of the loader"
                };
                return Err(ErrorKind::OutOfRange {
                    attribute,
                    value: value as f64,
                    want,
                });
            }
            Ok(Value::Int(value))
        }
        Kind::Reals { min, max, sign } => {
            let found = text.split_ascii_whitespace().count();
            if found < min || found > max {
                return Err(ErrorKind::WrongCount {
                    attribute,
                    found,
                    min,
                    max,
                });
            }
            let values: Result<Vec<f64>, ErrorKind> = text
                .split_ascii_whitespace()
                .map(|word| real(attribute, word, sign))
                .collect();
            let values = values?;
            if attribute == "quat" && values.iter().all(|&v| v == 0.0) {
                return Err(ErrorKind::Invalid(ZERO_QUAT));
            }
            Ok(Value::Reals(values))
        }
    }
}

/// The beginning of a text, for messages.
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

fn real(attribute: &'static str, text: &str, sign: Sign) -> Result<f64, ErrorKind> {
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
    if value.abs() > MAX_REAL {
        return Err(ErrorKind::OutOfRange {
            attribute,
            value,
            want: "at most 1e30 in magnitude",
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
