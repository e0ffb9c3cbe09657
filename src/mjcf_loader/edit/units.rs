//! Angles in radians instead of degrees.

use std::f64::consts::PI;

use super::document::Document;
use super::element_id::ElementId;
use super::error::EditError;
use super::kinds::Kind;

/// Converts the angles of an orientation as the compiler does.
fn of_frames(value: f64) -> f64 {
    value / 180.0 * PI
}

/// Converts an angle of a joint as the compiler does, whose last bit may differ.
fn of_joints(value: f64) -> f64 {
    value * (PI / 180.0)
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_ascii_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect()
}

fn text(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

impl Document {
    /// Writes all angles in radians. The document compiles to the same model.
    ///
    /// # Errors
    /// [`EditError::UnknownClass`]: an element names a default class that does not exist.
    pub fn to_radians(&mut self) -> Result<(), EditError> {
        if !self.in_degrees() {
            return Ok(());
        }
        let mut joints = Vec::new();
        for id in self.all(Kind::Joint) {
            if self.nodes[id.0].rule.name == "joint" && self.turns(id)? {
                for name in ["range", "ref", "springref"] {
                    joints.push((id.0, name, self.in_radians(id, name)?));
                }
            }
        }
        // those of default classes, for joints that are added later
        for at in 0..self.nodes.len() {
            let node = &self.nodes[at];
            if node.in_class && node.rule.name == "joint" && self.turns(ElementId(at))? {
                for name in ["range", "ref", "springref"] {
                    if let Some(given) = self.nodes[at].attribute(name) {
                        let given = numbers(given).into_iter().map(of_joints).collect::<Vec<_>>();
                        joints.push((at, name, Some(text(&given))));
                    }
                }
            }
        }
        for (at, name, value) in joints {
            if let Some(value) = value {
                self.nodes[at].put(name, value);
            }
        }
        for node in &mut self.nodes {
            if let Some(angles) = node.attribute("euler") {
                let angles: Vec<f64> = numbers(angles).into_iter().map(of_frames).collect();
                node.put("euler", text(&angles));
            }
            if let Some(axisangle) = node.attribute("axisangle") {
                let mut axisangle = numbers(axisangle);
                axisangle
                    .iter_mut()
                    .skip(3)
                    .for_each(|angle| *angle = of_frames(*angle));
                node.put("axisangle", text(&axisangle));
            }
        }
        let compiler = self.section("compiler")?;
        self.set(compiler, "angle", "radian")
    }

    fn turns(&self, joint: ElementId) -> Result<bool, EditError> {
        Ok(matches!(self.value(joint, "type")?.as_str(), "hinge" | "ball"))
    }

    /// Returns an angle of a joint in radians; `None` for 0 and for a range without effect, which have no unit.
    fn in_radians(&self, joint: ElementId, name: &str) -> Result<Option<String>, EditError> {
        let given = numbers(&self.value(joint, name)?);
        if given.iter().all(|value| *value == 0.0) {
            return Ok(None);
        }
        if name == "range" {
            let limited = self.value(joint, "limited")?;
            let proper = given.len() == 2 && given[0] < given[1];
            let auto = limited == "auto" && self.compiler("autolimits") != Some("false");
            if !(limited == "true" || auto && proper) {
                return Ok(None);
            }
        }
        let turned: Vec<f64> = given.into_iter().map(of_joints).collect();
        Ok(Some(text(&turned)))
    }
}
