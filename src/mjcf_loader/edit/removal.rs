//! Removal of elements and of the elements that refer to them.

use super::document::{Document, ElementNode, ROOT};
use super::element_id::ElementId;
use super::error::EditError;
use super::kinds::{Kind, loses_meaning, references};

impl Document {
    /// Removes an element with its contents, and everything that refers to them by name, such as the sensor of a removed site or the actuator of a
    /// joint. Returns the elements that were removed because they referred to others.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::Needed`]: the root and the world stay.
    pub fn remove(&mut self, id: ElementId) -> Result<Vec<ElementId>, EditError> {
        let mut gone = self.take_out(id)?;
        let mut referring = Vec::new();
        while let Some((kind, name)) = gone.pop() {
            // another element may have the name as well, until the document is compiled
            if self.find(kind, &name).is_some() {
                continue;
            }
            for at in 0..self.nodes.len() {
                let node = &self.nodes[at];
                let refers =
                    |node: &ElementNode| references(node).any(|(other, _, text)| other == kind && text == name);
                if node.removed || !loses_meaning(self, at) || !refers(node) {
                    continue;
                }
                // a tendon is removed with an element of its path, and a skin with a bone
                let whole = match self.kind_at(at) {
                    Some(_) => at,
                    None => self.nodes[at].parent.unwrap_or(at),
                };
                referring.push(ElementId(whole));
                gone.extend(self.take_out(ElementId(whole))?);
            }
        }
        Ok(referring)
    }

    /// Removes an element with its contents. References to them by name stay, and are errors when the document is compiled, unless another element
    /// gets the name.
    ///
    /// # Errors
    /// As [`Document::remove`].
    pub fn remove_alone(&mut self, id: ElementId) -> Result<(), EditError> {
        self.take_out(id).map(drop)
    }

    /// Removes an element from the tree; returns its name and those of its contents.
    fn take_out(&mut self, id: ElementId) -> Result<Vec<(Kind, String)>, EditError> {
        let node = self.node(id)?;
        let at = id.0;
        if at == ROOT || id == self.world() {
            return Err(EditError::Needed(node.rule.name));
        }
        if let Some(parent) = self.nodes[at].parent {
            self.nodes[parent].children.retain(|child| *child != at);
        }
        let mut names = Vec::new();
        let mut open = vec![at];
        while let Some(at) = open.pop() {
            let node = &mut self.nodes[at];
            // marked instead of deleted, because ids are indices into this list
            node.removed = true;
            open.extend(&node.children);
            let name = self.nodes[at].attribute("name").unwrap_or_default().to_owned();
            if let (Some(kind), false) = (self.kind_at(at), name.is_empty()) {
                names.push((kind, name));
            }
        }
        Ok(names)
    }
}
