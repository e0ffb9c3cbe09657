//! The supported MJCF, as a list for readers.

use super::attribute::{Attr, AttributeKind, Sign};
use super::elements::MUJOCO;
use super::schema::{DEFAULT, Rule};

/// An element that the loader understands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ElementInfo {
    /// Its path, for instance `worldbody/body/geom`. An element that is allowed in several places is listed once.
    pub path: String,
    /// Its attributes, in the order of its table.
    pub attributes: Vec<AttributeInfo>,
}

/// An attribute that the loader understands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AttributeInfo {
    /// Its name.
    pub name: &'static str,
    /// Values allowed, for instance `3 numbers`.
    pub values: String,
    /// Default, as a document would write it; empty for none.
    pub default: String,
    /// Whether the element must have it.
    pub required: bool,
    /// Whether a default class may give it.
    pub in_default: bool,
    /// Meaning, and whether it is ignored.
    pub meaning: &'static str,
}

/// Lists the elements and attributes that the loader understands; everything else in a document is an error.
///
/// ```
/// use mjcf_sim::mjcf_loader::elements;
/// let camera = elements().into_iter().find(|e| e.path == "worldbody/body/camera").unwrap();
/// let fovy = camera.attributes.iter().find(|a| a.name == "fovy").unwrap();
/// assert_eq!((fovy.values.as_str(), fovy.default.as_str()), ("1 number, positive", "45"));
/// ```
#[must_use]
pub fn elements() -> Vec<ElementInfo> {
    let mut found: Vec<(&'static Rule, ElementInfo)> = Vec::new();
    list(&MUJOCO, "", &mut found);
    found.into_iter().map(|(_, element)| element).collect()
}

/// Lists an element and those in it, each once. Default classes hold elements of other sections, which are listed there.
fn list(rule: &'static Rule, above: &str, found: &mut Vec<(&'static Rule, ElementInfo)>) {
    if found.iter().any(|(other, _)| std::ptr::eq(*other, rule)) {
        return;
    }
    let path = match above {
        "" | "mujoco" => rule.name.to_owned(),
        _ => format!("{above}/{}", rule.name),
    };
    // elements with defaults may name the class of these
    let classes = rule.attributes().any(|attr| attr.own && attr.name == "class");
    let mut attributes: Vec<AttributeInfo> = Vec::new();
    for attr in rule.attributes() {
        if attributes.iter().all(|other| other.name != attr.name) {
            attributes.push(info(attr, classes));
        }
    }
    let element = ElementInfo {
        path: path.clone(),
        attributes,
    };
    found.push((rule, element));
    if rule.name != DEFAULT {
        rule.children.iter().for_each(|child| list(child, &path, found));
    }
}

fn info(attr: &Attr, classes: bool) -> AttributeInfo {
    AttributeInfo {
        name: attr.name,
        values: values(attr.kind),
        default: match attr.kind {
            _ if attr.required => String::new(),
            AttributeKind::Groups => String::new(), // none by default, and what is stored are bits
            _ => (attr.default)(attr.name),
        },
        required: attr.required,
        in_default: classes && !attr.own,
        meaning: attr.meaning,
    }
}

/// Describes a kind of value in words.
fn values(kind: AttributeKind) -> String {
    match kind {
        AttributeKind::Text | AttributeKind::LongText => "text".to_owned(),
        AttributeKind::Flag => "false, true".to_owned(),
        AttributeKind::Word(words) => words.join(", "),
        AttributeKind::Int { min, max: i64::MAX } => format!("whole number from {min}"),
        AttributeKind::Int { min, max } => format!("whole number, {min} to {max}"),
        AttributeKind::Range => "2 numbers or infinities".to_owned(),
        AttributeKind::Quat => "4 numbers, not all 0".to_owned(),
        AttributeKind::User | AttributeKind::State | AttributeKind::Poses | AttributeKind::Data => "numbers".to_owned(),
        AttributeKind::Indices => "whole numbers".to_owned(),
        AttributeKind::Ints => "2 whole numbers".to_owned(),
        AttributeKind::Memory => "whole number, with a letter of KMGTPE behind, or -1".to_owned(),
        AttributeKind::Groups => "whole numbers, 0 to 30".to_owned(),
        AttributeKind::UserCount => "whole number from -1".to_owned(),
        AttributeKind::EulerSeq => "three letters of xyzXYZ".to_owned(),
        AttributeKind::Reals { min, max, sign } => {
            let count = match (min, max) {
                (1, 1) => "1 number".to_owned(),
                _ if min == max => format!("{max} numbers"),
                _ => format!("{min} to {max} numbers"),
            };
            let sign = match sign {
                Sign::Any => "",
                Sign::NonNegative => ", at least 0",
                Sign::Positive => ", positive",
                Sign::Unit => ", 0 to 1",
            };
            count + sign
        }
    }
}
