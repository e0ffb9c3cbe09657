//! The list of all constants of infants.

use super::growth::constants;
use super::sources::{Mark, SourcedConstant};
use super::{individual, preterm, reflexes, standards};
use crate::spaces::{INFANT_EXPONENT, INFANT_WEEKS};

impl SourcedConstant {
    /// Lists all constants of infants' strength, proportions, noise, reflexes and growth.
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
        all.extend(reflexes::constants());
        all.extend(standards::constants());
        all.extend(preterm::constants());
        all.extend(individual::constants());
        all
    }
}
