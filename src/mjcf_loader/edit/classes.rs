//! Default classes of a document that is attached to another.

use super::attach::Naming;
use super::document::{Document, ElementNode};
use super::error::EditError;
use super::values::MAIN;
use crate::schema::{DEFAULT, Rule};

/// The attributes of an orientation. Setting one is enough to reset the others.
const ORIENTATIONS: [&str; 5] = ["quat", "axisangle", "xyaxes", "zaxis", "euler"];

fn rule_of(from: &Rule, name: &str) -> Option<&'static Rule> {
    from.children.iter().copied().find(|rule| rule.name == name)
}

impl Document {
    /// Returns whether any default class sets an attribute.
    fn has_classes(&self) -> bool {
        self.all_main().any(|at| !self.nodes[at].children.is_empty())
    }

    /// Copies the default classes of another document as one class within the main one, so that attached elements keep their values.
    /// Returns whether there are any, so that those elements need to name them.
    pub(super) fn adopt_classes(&mut self, from: &Document, naming: Naming) -> Result<bool, EditError> {
        if !self.has_classes() && !from.has_classes() {
            return Ok(false);
        }
        let name = naming.apply(MAIN);
        if name == MAIN {
            return Err(EditError::Unattachable(
                "both documents have a main default class, and one of them says something: attach with a prefix or a suffix",
            ));
        }
        let before = self.find(super::Kind::Class, &name);
        let top = self.section(DEFAULT)?.0;
        let Some(rule) = rule_of(self.nodes[top].rule, DEFAULT) else {
            return Ok(false);
        };
        let new = self.push(top, rule, usize::MAX);
        self.nodes[new].put("class", name.clone());
        for section in from.all_main().collect::<Vec<_>>() {
            for &child in &from.nodes[section].children {
                if from.nodes[child].rule.name == DEFAULT {
                    self.copy(from, child, new, naming, true);
                } else {
                    self.merge(&from.nodes[child], new);
                }
            }
        }
        self.turn_back(new)?;
        match before {
            // the same document was attached under the same names before
            Some(old) if self.written(old.0) == self.written(new) => self.remove_alone(super::ElementId(new))?,
            Some(_) => {
                return Err(EditError::DuplicateName {
                    kind: "default class",
                    name,
                });
            }
            None => {}
        }
        Ok(true)
    }

    /// Adds the attributes of an element to that of the same name in a class.
    fn merge(&mut self, element: &ElementNode, class: usize) {
        let named = |at: &&usize| std::ptr::eq(self.nodes[**at].rule, element.rule);
        let at = match self.nodes[class].children.iter().find(named) {
            Some(&at) => at,
            None => self.push(class, element.rule, usize::MAX),
        };
        for (name, text) in &element.attributes {
            self.nodes[at].put(name, text.clone());
        }
    }

    /// Sets MJCF's defaults in a class for everything that the main class sets and this class does not, because it does not derive from the main
    /// class.
    fn turn_back(&mut self, class: usize) -> Result<(), EditError> {
        let said: Vec<usize> = self.all_main().flat_map(|at| self.nodes[at].children.clone()).collect();
        for at in said {
            let node = self.nodes[at].clone();
            if node.rule.name == DEFAULT {
                continue;
            }
            let actuator = node.attr("ctrlrange").is_some();
            // actuators of all kinds share their defaults
            let element = if actuator { "general" } else { node.rule.name };
            let Some(rule) = rule_of(self.nodes[class].rule, element) else {
                continue;
            };
            let mut own = self.nodes[class].children.iter();
            let at = match own.find(|&&at| std::ptr::eq(self.nodes[at].rule, rule)) {
                Some(&at) => at,
                // first in the class, so that its elements for single kinds of actuators take precedence
                None => self.push(class, rule, if actuator { 0 } else { usize::MAX }),
            };
            let all: Vec<&'static str> = if actuator {
                let shared = rule.attributes().filter(|attr| !attr.own);
                shared.map(|attr| attr.name).collect()
            } else {
                node.attributes.iter().map(|(name, _)| *name).collect()
            };
            for name in all {
                let needed = !actuator || node.attribute(name).is_some();
                self.turn_attribute_back(at, name, needed)?;
            }
        }
        Ok(())
    }

    fn turn_attribute_back(&mut self, at: usize, name: &'static str, needed: bool) -> Result<(), EditError> {
        let node = &mut self.nodes[at];
        let turns = ORIENTATIONS.contains(&name);
        if node.attribute(name).is_some() || turns && ORIENTATIONS.iter().any(|name| node.attribute(name).is_some()) {
            return Ok(());
        }
        let default = match node.attr(name) {
            _ if turns => "1 0 0 0".to_owned(),
            Some(attr) => (attr.default)(name),
            None => String::new(),
        };
        if !default.is_empty() {
            node.put(if turns { "quat" } else { name }, default);
            return Ok(());
        }
        if needed {
            let (element, attribute) = (node.rule.name, name);
            return Err(EditError::Inherited { element, attribute });
        }
        Ok(())
    }
}
