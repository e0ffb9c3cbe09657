//! Values with default classes applied.

use super::document::{Document, attr_of};
use super::element_id::ElementId;
use super::error::EditError;
use super::kinds::Kind;
use crate::schema::DEFAULT;

/// The class at the top of the defaults.
pub(super) const MAIN: &str = "main";

impl Document {
    /// Returns the value of an attribute as a document would write it: the element's own, else that of its default class, else MJCF's
    /// default, which is empty if MJCF has none.
    ///
    /// Attributes of actuators other than `general` that stand for several of it, such as `kp`, are not followed through classes; see
    /// [`Document::generalize`].
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownAttribute`]; [`EditError::UnknownClass`]
    pub fn value(&self, id: ElementId, name: &str) -> Result<String, EditError> {
        let node = self.node(id)?;
        let attr = attr_of(node, name)?;
        let several = matches!(attr.kind, crate::attribute::AttributeKind::Reals { min, max, .. } if min < max);
        match node.attribute(name) {
            // numbers that are not given keep the values of the class
            // except for springlength: a single one stands for both lengths
            Some(text) if several && name != "springlength" => {
                let given = text.split_ascii_whitespace().count();
                let rest = self.value_of_class(id, name)?;
                let rest = rest.split_ascii_whitespace().skip(given);
                Ok(text.split_ascii_whitespace().chain(rest).collect::<Vec<_>>().join(" "))
            }
            Some(text) => Ok(text.to_owned()),
            None => self.value_of_class(id, name),
        }
    }

    /// Returns the value of an attribute that is not given in the element.
    fn value_of_class(&self, id: ElementId, name: &str) -> Result<String, EditError> {
        let node = self.node(id)?;
        let attr = attr_of(node, name)?;
        let default = || (attr.default)(attr.name);
        if attr.own || node.attr("class").is_none() && !node.in_class {
            return Ok(default());
        }
        // elements of a class follow the class around that
        let (class, element) = if node.in_class {
            (self.class_around(id.0), self.element(id)?)
        } else {
            (Some(self.class_at(id.0)?), self.element_in_classes(id.0))
        };
        let found = class.and_then(|class| self.inherited(class, element, name));
        Ok(found.unwrap_or_else(default))
    }

    /// Returns the name of the class whose defaults an element has: its own, or that of the bodies and frames around it.
    ///
    /// # Errors
    /// [`EditError::NoElement`]
    pub fn class_of(&self, id: ElementId) -> Result<String, EditError> {
        self.node(id).map(|_| self.class_name_at(id.0).to_owned())
    }

    pub(super) fn class_name_at(&self, at: usize) -> &str {
        if let Some(class) = self.nodes[at].attribute("class") {
            return class;
        }
        self.childclass_around(self.nodes[at].parent).unwrap_or(MAIN)
    }

    /// Returns the class for the contents of a body or a frame, from it or those around it.
    pub(super) fn childclass_around(&self, at: Option<usize>) -> Option<&str> {
        let mut up = at;
        while let Some(at) = up {
            if let Some(class) = self.nodes[at].attribute("childclass") {
                return Some(class);
            }
            up = self.nodes[at].parent;
        }
        None
    }

    /// Returns the section of an element's class; `None` inside if the document has no defaults at all.
    fn class_at(&self, at: usize) -> Result<usize, EditError> {
        let name = self.class_name_at(at);
        match self.find(Kind::Class, name) {
            Some(id) => Ok(id.0),
            None if name == MAIN => Ok(usize::MAX),
            None => Err(EditError::UnknownClass(name.to_owned())),
        }
    }

    /// Returns the class from which a class is derived, for an element of the latter.
    fn class_around(&self, at: usize) -> Option<usize> {
        self.nodes[at].parent.and_then(|class| self.nodes[class].parent)
    }

    /// Returns the name under which classes give defaults for an element.
    pub(super) fn element_in_classes(&self, at: usize) -> &'static str {
        match self.kind_at(at) {
            Some(kind @ (Kind::Equality | Kind::Tendon)) => kind.name(),
            _ => self.nodes[at].rule.name,
        }
    }

    /// Returns the value that a class, or one of its ancestors, gives for an attribute of an element.
    pub(super) fn inherited(&self, class: usize, element: &str, name: &str) -> Option<String> {
        let mut up = Some(class);
        while let Some(at) = up {
            let node = self.nodes.get(at)?;
            if node.rule.name != DEFAULT {
                return None;
            }
            let top = node.parent == Some(0);
            // the main class may be in several sections; the last one counts
            let sections: Vec<usize> = if top { self.all_main().collect() } else { vec![at] };
            let given = sections
                .iter()
                .flat_map(|&at| &self.nodes[at].children)
                .filter(|&&at| self.nodes[at].rule.name == element)
                .filter_map(|&at| self.nodes[at].attribute(name))
                .next_back();
            if let Some(text) = given {
                return Some(text.to_owned());
            }
            up = node.parent;
        }
        None
    }

    /// Returns the sections of the main class.
    pub(super) fn all_main(&self) -> impl Iterator<Item = usize> {
        let children = self.nodes[0].children.iter().copied();
        children.filter(|&at| self.nodes[at].rule.name == DEFAULT)
    }
}
