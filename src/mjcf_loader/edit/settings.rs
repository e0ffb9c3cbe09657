//! Settings of `compiler`, which decide what the numbers of a document mean.

use std::fmt;

use super::document::Document;
use super::error::EditError;
use crate::document::Compiler;
use crate::table::Table;

/// A setting of `compiler` that differs between two documents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The attribute.
    pub attribute: &'static str,
    /// Its value in the document that the other is attached to.
    pub own: String,
    /// Its value in the document that is attached.
    pub other: String,
}

impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { attribute, own, other } = self;
        write!(
            f,
            "{attribute}=\"{own}\" here, and {attribute}=\"{other}\" where the attached body is from"
        )
    }
}

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
    /// Returns a setting of `compiler`, if it is given; the last counts.
    pub(super) fn compiler(&self, name: &str) -> Option<&str> {
        let sections = self.nodes[0].children.iter().map(|&at| &self.nodes[at]);
        let sections = sections.filter(|node| node.rule.name == "compiler");
        sections.filter_map(|node| node.attribute(name)).next_back()
    }

    fn compiler_or_default(&self, name: &str) -> String {
        self.compiler(name)
            .map_or_else(|| Compiler::default_of(name), str::to_owned)
    }

    /// Tells whether angles are in degrees.
    pub(super) fn in_degrees(&self) -> bool {
        self.compiler("angle") != Some("radian")
    }

    /// Checks that elements of another document mean the same here. Units of angles are converted, and need not be alike.
    pub(super) fn check_settings(&self, other: &Document) -> Result<(), EditError> {
        for attribute in OF_ELEMENTS {
            let (own, theirs) = (
                self.compiler_or_default(attribute),
                other.compiler_or_default(attribute),
            );
            if own != theirs {
                let settings = Settings {
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
