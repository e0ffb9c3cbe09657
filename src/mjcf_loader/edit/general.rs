//! Actuators of all kinds as `general` ones.

use super::document::{Document, ElementNode};
use super::element_id::ElementId;
use super::error::EditError;
use super::kinds::Kind;
use super::values::MAIN;
use crate::actuator::Actuator;
use crate::elements::MUJOCO;
use crate::error::ErrorKind;
use crate::schema::{DEFAULT, Element};
use crate::table::Table;

impl Document {
    /// Turns an actuator of another kind, such as `position`, into an equivalent `general` one that writes out all values. MuJoCo keeps only such
    /// actuators once a document is read.
    ///
    /// # Errors
    /// [`EditError::NoElement`]; [`EditError::UnknownClass`]; [`EditError::Value`]: its attributes contradict each other, or
    /// `inheritrange` says its range, which a `general` actuator cannot have.
    pub fn generalize(&mut self, id: ElementId) -> Result<(), EditError> {
        let element = self.element(id)?;
        if self.kind_at(id.0) != Some(Kind::Actuator) || element == "general" {
            return Ok(());
        }
        let mut actuator = self.class_actuator(id.0)?;
        self.drive(&mut actuator, &self.nodes[id.0])?;
        if actuator.inheritrange > 0.0 {
            let kind = ErrorKind::Invalid(
                "inheritrange is for servos, and cannot be written otherwise: give the range itself",
            );
            return Err(EditError::Value { element, kind });
        }
        let mut sections = MUJOCO.children.iter().filter(|rule| rule.name == "actuator");
        let general = sections
            .next()
            .and_then(|section| section.children.iter().find(|rule| rule.name == "general"));
        let Some(general) = general else {
            return Ok(());
        };
        let node = &mut self.nodes[id.0];
        node.rule = general;
        let given = std::mem::take(&mut node.attributes);
        node.attributes = given
            .into_iter()
            .filter(|(name, _)| node.attr(name).is_some())
            .collect();
        for attr in general.attributes().filter(|attr| !attr.own) {
            let shown = show(&mut actuator, attr.name);
            // slider-cranks alone may say how long the rod is
            let of_crank = attr.name != "cranklength" || node.attribute("cranksite").is_some();
            if of_crank && !shown.is_empty() {
                node.put(attr.name, shown);
            }
        }
        Ok(())
    }

    /// Returns an actuator with the values of the class of an element.
    fn class_actuator(&self, at: usize) -> Result<Actuator, EditError> {
        let mut actuator = Actuator::initial();
        let name = self.class_name_at(at);
        let mut chain = Vec::new();
        match self.find(Kind::Class, name) {
            Some(id) => {
                let mut up = Some(id.0);
                while let Some(class) = up.filter(|&class| self.nodes[class].rule.name == DEFAULT) {
                    chain.push(class);
                    up = self.nodes[class].parent;
                }
            }
            None if name == MAIN => {}
            None => return Err(EditError::UnknownClass(name.to_owned())),
        }
        // the main class may be in several sections
        chain.pop();
        chain.extend(self.all_main().collect::<Vec<_>>().into_iter().rev());
        for class in chain.into_iter().rev() {
            for &child in &self.nodes[class].children {
                let node = &self.nodes[child];
                if node.attr("ctrlrange").is_some() || node.rule.name == "adhesion" {
                    self.drive(&mut actuator, node)?;
                }
            }
        }
        Ok(actuator)
    }

    fn drive(&self, actuator: &mut Actuator, node: &ElementNode) -> Result<(), EditError> {
        let element = node.rule.name;
        let wrong = |kind| EditError::Value { element, kind };
        let mut values = Vec::new();
        for (name, text) in &node.attributes {
            if let Some(attr) = node.attr(name) {
                values.push((attr.name, attr.parse(text, &self.limits).map_err(wrong)?));
            }
        }
        let read = Element::of(element, values);
        actuator.drive(&read).map_err(|what| wrong(ErrorKind::Invalid(what)))
    }
}

/// Returns the value of an attribute as a document would write it.
fn show(actuator: &mut Actuator, name: &str) -> String {
    let mut shown = String::new();
    let mut visit = |field: &mut dyn crate::attribute::AttributeField| shown = field.show();
    let _ = actuator.field(name, &mut visit)
        || actuator.control.field(name, &mut visit)
        || actuator.activation.field(name, &mut visit)
        || actuator.law.field(name, &mut visit)
        || actuator.target.field(name, &mut visit);
    shown
}
