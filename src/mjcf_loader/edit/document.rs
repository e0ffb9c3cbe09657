//! The tree of elements, and operations on single elements.

use std::fmt;

use super::element_id::ElementId;
use super::error::EditError;
use crate::assets::directory;
use crate::attribute::Attr;
use crate::elements::MUJOCO;
use crate::limits::Limits;
use crate::schema::{DEFAULT, Rule};
use crate::text::nearest;

/// An element with its attributes as text.
#[derive(Clone)]
pub(super) struct ElementNode {
    pub rule: &'static Rule,
    /// Whether it is in a default class.
    pub in_class: bool,
    pub parent: Option<usize>,
    pub children: Vec<usize>,
    pub attributes: Vec<(&'static str, String)>,
    pub removed: bool,
}

impl ElementNode {
    pub fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(other, _)| *other == name);
        found.map(|(_, text)| text.as_str())
    }

    /// Returns the attribute of the tables that has a name.
    pub fn attr(&self, name: &str) -> Option<&'static Attr> {
        let in_class = self.in_class && self.rule.name != DEFAULT;
        self.rule
            .attributes()
            .find(|attr| attr.name == name && !(in_class && attr.own))
    }

    /// Sets an attribute that the tables have, without a check.
    pub fn put(&mut self, name: &'static str, text: String) {
        match self.attributes.iter_mut().find(|(other, _)| *other == name) {
            Some((_, value)) => *value = text,
            None => self.attributes.push((name, text)),
        }
    }
}

/// An MJCF document as a tree of elements that can be edited. See the [module](super).
#[derive(Clone)]
pub struct Document {
    pub(super) nodes: Vec<ElementNode>,
    pub(super) path: String,
    pub(super) limits: Limits,
}

impl fmt::Debug for Document {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let elements = self.nodes.iter().filter(|node| !node.removed).count();
        f.debug_struct("Document")
            .field("path", &self.path)
            .field("elements", &elements)
            .finish_non_exhaustive()
    }
}

impl Default for Document {
    fn default() -> Self {
        Self::new()
    }
}

pub(super) const ROOT: usize = 0;

impl Document {
    /// Returns a document with an empty world, which looks for files from the root of its source.
    #[must_use]
    pub fn new() -> Self {
        Self::empty("model.xml".to_owned(), Limits::default())
    }

    pub(super) fn empty(path: String, limits: Limits) -> Self {
        let root = ElementNode {
            rule: &MUJOCO,
            in_class: false,
            parent: None,
            children: Vec::new(),
            attributes: Vec::new(),
            removed: false,
        };
        let mut document = Self {
            nodes: vec![root],
            path,
            limits,
        };
        document.world_or_new();
        document
    }

    /// Returns the element of the whole document, `<mujoco>`.
    pub fn root(&self) -> ElementId {
        ElementId(ROOT)
    }

    /// Returns `<worldbody>`, the first if there are several.
    pub fn world(&self) -> ElementId {
        let world = |at: &&usize| self.nodes[**at].rule.name == "worldbody";
        ElementId(self.nodes[ROOT].children.iter().find(world).copied().unwrap_or(ROOT))
    }

    pub(super) fn world_or_new(&mut self) {
        if self.world().0 == ROOT
            && let Some(rule) = MUJOCO.children.iter().find(|rule| rule.name == "worldbody")
        {
            self.push(ROOT, rule, usize::MAX);
        }
    }

    /// Returns the section of the document with this name, for instance `actuator`: the last one if there are several, or a new one.
    ///
    /// # Errors
    /// [`EditError::UnknownElement`]: MJCF has no such section.
    pub fn section(&mut self, name: &str) -> Result<ElementId, EditError> {
        let named = |at: &&usize| self.nodes[**at].rule.name == name;
        match self.nodes[ROOT].children.iter().rev().find(named) {
            Some(&at) => Ok(ElementId(at)),
            None => self.add(ElementId(ROOT), name),
        }
    }

    /// Returns the path of the document in its source. Files that it names are looked up from the folder of this path.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Returns whether an element is in the document.
    pub fn contains(&self, id: ElementId) -> bool {
        self.nodes.get(id.0).is_some_and(|node| !node.removed)
    }

    pub(super) fn node(&self, id: ElementId) -> Result<&ElementNode, EditError> {
        let node = self.nodes.get(id.0).filter(|node| !node.removed);
        node.ok_or(EditError::NoElement(id))
    }

    /// Returns the name of an element in MJCF, for instance `geom`.
    ///
    /// # Errors
    /// [`EditError::NoElement`]
    pub fn element(&self, id: ElementId) -> Result<&'static str, EditError> {
        self.node(id).map(|node| node.rule.name)
    }

    /// Returns the parent of an element; `None` for the root.
    ///
    /// # Errors
    /// [`EditError::NoElement`]
    pub fn parent(&self, id: ElementId) -> Result<Option<ElementId>, EditError> {
        self.node(id).map(|node| node.parent.map(ElementId))
    }

    /// Returns the children of an element, in order.
    ///
    /// # Errors
    /// [`EditError::NoElement`]
    pub fn children(&self, id: ElementId) -> Result<Vec<ElementId>, EditError> {
        self.node(id)
            .map(|node| node.children.iter().copied().map(ElementId).collect())
    }

    /// Returns the given attributes, with their text.
    ///
    /// # Errors
    /// [`EditError::NoElement`]
    pub fn attributes(&self, id: ElementId) -> Result<impl Iterator<Item = (&'static str, &str)>, EditError> {
        self.node(id)
            .map(|node| node.attributes.iter().map(|(name, text)| (*name, text.as_str())))
    }

    /// Returns the text of an attribute, if it is given. [`Document::value`] also follows default classes.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownAttribute`]: the element cannot have it.
    pub fn attribute(&self, id: ElementId, name: &str) -> Result<Option<&str>, EditError> {
        let node = self.node(id)?;
        attr_of(node, name)?;
        Ok(node.attribute(name))
    }

    /// Sets an attribute. Attributes that exclude it are dropped: setting `quat` drops `euler`.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownAttribute`]; [`EditError::Value`]: the attribute cannot have the value.
    pub fn set(&mut self, id: ElementId, name: &str, value: &str) -> Result<(), EditError> {
        let node = self.node(id)?;
        let (attr, element) = (attr_of(node, name)?, node.rule.name);
        let wrong = |kind| EditError::Value { element, kind };
        attr.parse(value, &self.limits).map_err(wrong)?;
        let rule = node.rule;
        let node = &mut self.nodes[id.0];
        if let Some(rivals) = attr.rivals {
            let rival = |name: &str| {
                rule.attributes()
                    .any(|other| other.name == name && name != attr.name && other.rivals == Some(rivals))
            };
            node.attributes.retain(|(name, _)| !rival(name));
        }
        node.put(attr.name, value.to_owned());
        Ok(())
    }

    /// Removes an attribute, so the default applies again.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownAttribute`]
    pub fn unset(&mut self, id: ElementId, name: &str) -> Result<(), EditError> {
        attr_of(self.node(id)?, name)?;
        self.nodes[id.0].attributes.retain(|(other, _)| *other != name);
        Ok(())
    }

    /// Appends an element to another.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownElement`]: it cannot stand there.
    pub fn add(&mut self, parent: ElementId, element: &str) -> Result<ElementId, EditError> {
        self.insert(parent, element, usize::MAX)
    }

    /// Adds an element before the child at `index` of another element.
    ///
    /// # Errors
    /// As [`Document::add`].
    pub fn insert(&mut self, parent: ElementId, element: &str, index: usize) -> Result<ElementId, EditError> {
        let rule = self.node(parent)?.rule;
        let found = rule.children.iter().find(|child| child.name == element);
        let Some(found) = found else {
            return Err(EditError::UnknownElement {
                parent: rule.name,
                name: element.to_owned(),
                nearest: nearest(element, rule.children.iter().map(|child| child.name)),
            });
        };
        Ok(ElementId(self.push(parent.0, found, index)))
    }

    /// Moves an element with its contents to the end of another parent.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownElement`]: it cannot stand there; [`EditError::Needed`]: it would be in itself.
    pub fn move_to(&mut self, id: ElementId, parent: ElementId) -> Result<(), EditError> {
        let element = self.node(id)?.rule;
        let above = self.node(parent)?.rule;
        if !above.children.iter().any(|child| std::ptr::eq(*child, element)) {
            return Err(EditError::UnknownElement {
                parent: above.name,
                name: element.name.to_owned(),
                nearest: None,
            });
        }
        let mut up = Some(parent.0);
        while let Some(at) = up {
            if at == id.0 {
                return Err(EditError::Needed(element.name));
            }
            up = self.nodes[at].parent;
        }
        if let Some(before) = self.nodes[id.0].parent {
            self.nodes[before].children.retain(|child| *child != id.0);
        }
        self.nodes[id.0].parent = Some(parent.0);
        self.nodes[parent.0].children.push(id.0);
        Ok(())
    }

    pub(super) fn push(&mut self, parent: usize, rule: &'static Rule, index: usize) -> usize {
        let above = &self.nodes[parent];
        let new = ElementNode {
            rule,
            in_class: above.in_class || above.rule.name == DEFAULT || rule.name == DEFAULT,
            parent: Some(parent),
            children: Vec::new(),
            attributes: Vec::new(),
            removed: false,
        };
        let at = self.nodes.len();
        self.nodes.push(new);
        let children = &mut self.nodes[parent].children;
        children.insert(index.min(children.len()), at);
        at
    }

    /// Returns the folder of the document.
    pub(super) fn folder(&self) -> &str {
        directory(&self.path)
    }
}

pub(super) fn attr_of(node: &ElementNode, name: &str) -> Result<&'static Attr, EditError> {
    node.attr(name).ok_or_else(|| EditError::UnknownAttribute {
        element: node.rule.name,
        name: name.to_owned(),
        nearest: nearest(name, node.rule.attributes().map(|attr| attr.name)),
    })
}
