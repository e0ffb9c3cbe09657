//! The constants of infants, with where each comes from.

use std::fmt::{self, Display, Formatter};

use super::growth::constants;
use crate::spaces::{INFANT_EXPONENT, INFANT_WEEKS};

/// How sure a constant is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mark {
    /// Read in the source itself.
    Read,
    /// Measured or calibrated with this simulator.
    Measured,
    /// Taken from an abstract or from a secondary source.
    Seen,
    /// Nobody's measurement: general knowledge, or a design of this project.
    Unsourced,
}

impl Display for Mark {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Read => "(r)",
            Self::Measured => "(m)",
            Self::Seen => "(s)",
            Self::Unsourced => "(u)",
        })
    }
}

/// A constant of infants.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcedConstant {
    /// What it is.
    pub name: String,
    /// Its values: one, or one for each of `ages`.
    pub values: Vec<f64>,
    /// Ages of the values, months; empty for one value.
    pub ages: Vec<f64>,
    /// Unit of the values; 1 for ratios.
    pub unit: &'static str,
    /// The source, or what it is calibrated on.
    pub source: &'static str,
    /// How sure it is.
    pub mark: Mark,
}

impl SourcedConstant {
    /// Lists all constants of infants' strength, proportions and noise.
    pub fn all() -> Vec<Self> {
        let mut all = constants();
        let single = |name: &str, value: f64, unit| Self {
            name: name.to_string(),
            values: vec![value],
            ages: Vec::new(),
            unit,
            source: "arXiv 2606.16590 (ICDL 2026): wrists and ankles of four infants of 8 to 30 weeks, on video",
            mark: Mark::Seen,
        };
        all.push(single("exponent of movements, at birth", INFANT_EXPONENT[0], "1"));
        all.push(single("exponent of movements, rise", INFANT_EXPONENT[1], "1/week"));
        all.push(single("exponent of movements, first age", INFANT_WEEKS[0], "weeks"));
        all.push(single("exponent of movements, last age", INFANT_WEEKS[1], "weeks"));
        all
    }
}
