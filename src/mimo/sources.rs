//! A constant of infants, with its source.

use std::fmt::{self, Display, Formatter};

/// The certainty of a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mark {
    /// Read in the source itself.
    Read,
    /// Measured or calibrated with this simulator.
    Measured,
    /// Taken from an abstract or from a secondary source.
    Seen,
    /// Not measured: general knowledge, or a choice of this project.
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
    /// The source, or the data for its calibration.
    pub source: &'static str,
    /// Its certainty.
    pub mark: Mark,
}
