//! Settings of `compiler`, which decide the meaning of a document's numbers.

use super::document::Document;
use super::error::{EditError, SettingsConflict};
use crate::document::Compiler;
use crate::table::Table;

/// Settings by which elements are compiled. The others count for the whole model.
const OF_ELEMENTS: [&str; 8] = [
    "eulerseq",
    "autolimits",
    "inertiafromgeom",
    "inertiagrouprange",
    "balanceinertia",
    "boundmass",
    "boundinertia",
    "alignfree",
];

impl Document {
    /// Returns a setting of `compiler`, if it is given; the last one counts.
    pub(super) fn compiler(&self, name: &str) -> Option<&str> {
        let sections = self.nodes[0].children.iter().map(|&at| &self.nodes[at]);
        let sections = sections.filter(|node| node.rule.name == "compiler");
        sections.filter_map(|node| node.attribute(name)).next_back()
    }

    fn compiler_or_default(&self, name: &str) -> String {
        self.compiler(name)
            .map_or_else(|| Compiler::default_of(name), str::to_owned)
    }

    /// Returns whether angles are in degrees.
    pub(super) fn in_degrees(&self) -> bool {
        self.compiler("angle") != Some("radian")
    }

    /// Checks that elements of another document mean the same here. Units of angles are converted and may differ.
    pub(super) fn check_settings(&self, other: &Document) -> Result<(), EditError> {
        for attribute in OF_ELEMENTS {
            let (own, theirs) = (
                self.compiler_or_default(attribute),
                other.compiler_or_default(attribute),
            );
            if own != theirs {
                let settings = SettingsConflict {
                    attribute,
                    own,
                    other: theirs,
                };
                return Err(EditError::Settings(Box::new(settings)));
            }
        }
        Ok(())
    }
}
