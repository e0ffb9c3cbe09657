//! Checks a tree against the supported elements and attributes.

use super::attribute::{Alternatives, Attr, Value};
use super::error::{ErrorKind, LoadError};
use super::later::{self, LaterAttribute};
use super::xml::{Node, Tree};
use crate::text::nearest;

/// The content allowed in an element: the attributes of its tables, and child elements.
pub(super) struct Rule {
    pub name: &'static str,
    pub tables: &'static [&'static [&'static [Attr]]],
    pub children: &'static [&'static Rule],
}

impl Rule {
    pub fn attributes(&self) -> impl Iterator<Item = &'static Attr> + use<> {
        self.tables
            .iter()
            .flat_map(|table| table.iter())
            .flat_map(|group| group.iter())
    }
}

/// The name of the sections of default classes. Attributes that an element must give itself are not allowed in them.
pub(super) const DEFAULT: &str = "default";

/// A checked element.
pub(super) struct Element {
    pub at: usize,
    pub name: &'static str,
    values: Vec<(&'static str, Value)>,
    pub children: Vec<Element>,
}

impl Element {
    /// Makes an element of a document that is edited, without children.
    pub fn of(name: &'static str, values: Vec<(&'static str, Value)>) -> Self {
        Self {
            at: 0,
            name,
            values,
            children: Vec::new(),
        }
    }

    /// Makes an element without attributes and children.
    #[cfg(test)]
    pub fn bare(rule: &'static Rule) -> Self {
        Self {
            at: 0,
            name: rule.name,
            values: Vec::new(),
            children: Vec::new(),
        }
    }

    /// Returns the attributes with their values, in the order of the text.
    pub fn values(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.values.iter().map(|(name, value)| (*name, value))
    }

    /// Returns an attribute as text, if it is given.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.values().find_map(|(other, value)| match value {
            Value::Text(text) if other == name => Some(text.as_str()),
            _ => None,
        })
    }
}

/// Checks an element and everything below it. Recursion is bounded by the depth limit of the parser.
pub(super) fn check(tree: &Tree, root: usize, rule: &'static Rule) -> Result<Element, LoadError> {
    check_below(tree, root, rule, false)
}

/// Checks an element and everything below it; `class` is true for the elements of a default class.
fn check_below(tree: &Tree, at: usize, rule: &'static Rule, class: bool) -> Result<Element, LoadError> {
    let mut element = check_one(tree, at, rule, class && rule.name != DEFAULT)?;
    for &child in &tree.nodes[at].children {
        let child_rule = child_rule(tree, child, rule)?;
        if once(rule.name, child_rule.name) && element.children.iter().any(|c| c.name == child_rule.name) {
            return Err(tree.error(child, ErrorKind::RepeatedElement(child_rule.name)));
        }
        let class = class || rule.name == DEFAULT;
        element.children.push(check_below(tree, child, child_rule, class)?);
    }
    Ok(element)
}

/// Returns whether an element may contain another only once.
fn once(parent: &str, child: &str) -> bool {
    match parent {
        "visual" | "option" | "compiler" => true,
        DEFAULT => child != DEFAULT,
        "body" => child == "inertial",
        "composite" => child != "joint",
        "flex" => true,
        "flexcomp" => child != "pin",
        _ => false,
    }
}

/// Returns the error for an element of 3.3.0 that is not supported, with advice.
fn unsupported(node: &Node) -> Option<ErrorKind> {
    let name = match node.name.as_str() {
        "plugin" => node.attribute("plugin").unwrap_or_default().to_owned(),
        _ => return None,
    };
    let what = match name.as_str() {
        "mujoco.pid" => "write actuators of position, and of intvelocity for the integral",
        "mujoco.elasticity.cable" => "give the joints of the cable stiffness and damping, or leave it out",
        "mujoco.sensor.touch_grid" => "write touch sensors on sites",
        "mujoco.elasticity.membrane" | "mujoco.elasticity.shell" => {
            "write <elasticity> in the flex, which has no bending"
        }
        sdf if sdf.starts_with("mujoco.sdf.") => "write the shape as a mesh or of other shapes",
        _ => "remove it",
    };
    Some(ErrorKind::Plugin { name, what })
}

fn child_rule(tree: &Tree, child: usize, rule: &'static Rule) -> Result<&'static Rule, LoadError> {
    let name = &tree.nodes[child].name;
    let found = rule.children.iter().find(|rule| rule.name == name);
    found.copied().ok_or_else(|| {
        if let Some(kind) = unsupported(&tree.nodes[child]) {
            return tree.error(child, kind);
        }
        let kind = if later::element(rule.name, name) {
            ErrorKind::LaterElement(name.clone())
        } else {
            ErrorKind::UnknownElement {
                name: name.clone(),
                nearest: nearest(name, rule.children.iter().map(|child| child.name)),
            }
        };
        tree.error(child, kind)
    })
}

/// Returns the attribute that a name in a node stands for, with its value; `None` if it belongs to a later version and changes nothing.
fn meant<'a>(
    node: &Node,
    rule: &'static Rule,
    class: bool,
    name: &str,
    text: &'a str,
) -> Result<Option<(&'static Attr, &'a str)>, ErrorKind> {
    let find = |name: &str| rule.attributes().find(|attr| attr.name == name && !(class && attr.own));
    if let Some(attr) = find(name) {
        return Ok(Some((attr, text)));
    }
    let unknown = || ErrorKind::UnknownAttribute {
        name: name.to_owned(),
        nearest: nearest(
            name,
            rule.attributes()
                .filter(|attr| !(class && attr.own))
                .map(|attr| attr.name),
        ),
    };
    let has = |attribute: &str| rule.attributes().any(|attr| attr.name == attribute);
    match later::attribute(rule.name, has, name, text) {
        Some(LaterAttribute::Nothing) => Ok(None),
        Some(LaterAttribute::As(other, _)) if node.attributes.iter().any(|(given, _)| given == other) => {
            Err(ErrorKind::DuplicateAttribute(other.to_owned()))
        }
        Some(LaterAttribute::As(other, text)) => match find(other) {
            Some(attr) => Ok(Some((attr, text))),
            None => Err(unknown()),
        },
        Some(LaterAttribute::Refused) => Err(ErrorKind::LaterAttribute(name.to_owned())),
        // MuJoCo reads these where it reads bodies, and looks for the attributes that it knows only
        None if ["frame", "replicate"].contains(&rule.name) => Ok(None),
        None => Err(unknown()),
    }
}

/// Checks an element without its children. It is separate from `check_below` so that the recursion needs little stack.
#[inline(never)]
fn check_one(tree: &Tree, at: usize, rule: &'static Rule, class: bool) -> Result<Element, LoadError> {
    let node = &tree.nodes[at];
    let attributes = || rule.attributes().filter(|attr| !(class && attr.own));
    let mut values = Vec::with_capacity(node.attributes.len());
    let mut rivals = Vec::new();
    for (name, text) in &node.attributes {
        let Some((attr, text)) = meant(node, rule, class, name, text).map_err(|kind| tree.error(at, kind))? else {
            continue;
        };
        // as in MuJoCo, an empty list of numbers counts as not given
        if attr.kind.is_numbers() && text.trim_ascii().is_empty() {
            continue;
        }
        values.push((
            attr.name,
            attr.parse(text, &tree.limits).map_err(|kind| tree.error(at, kind))?,
        ));
        rivals.extend(attr.rivals.map(|rivals| (rivals, attr.name)));
    }
    for group in Alternatives::ALL {
        let mut given = rivals.iter().filter(|(rivals, _)| *rivals == group);
        if let (Some((_, first)), Some((_, second))) = (given.next(), given.next()) {
            return Err(tree.error(at, ErrorKind::Conflict(first, second)));
        }
    }
    let given = |name: &str| values.iter().any(|(other, _)| *other == name);
    let missing = attributes().find(|attr| attr.required && !given(attr.name));
    match missing {
        Some(attr) => Err(tree.error(at, ErrorKind::MissingAttribute(attr.name))),
        None => Ok(Element {
            at,
            name: rule.name,
            values,
            children: Vec::with_capacity(node.children.len()),
        }),
    }
}
