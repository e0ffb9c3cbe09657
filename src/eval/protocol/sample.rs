//! What was measured in a part of a phase.

use std::collections::{BTreeMap, BTreeSet};

/// The measures of a part of a phase of a trial.
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    /// The trial, from 0.
    pub trial: u32,
    /// The phase, by its place.
    pub phase: usize,
    /// Simulated time, s.
    pub seconds: f64,
    /// Measures by name. Undefined ones are left out.
    pub values: BTreeMap<String, f64>,
    /// Bodies of MIMo that his hands touched.
    pub areas: BTreeSet<String>,
}

impl Sample {
    /// Keeps a measure, unless it is undefined.
    pub fn put(&mut self, name: &str, value: impl Into<Option<f64>>) {
        if let Some(value) = value.into().filter(|value| value.is_finite()) {
            self.values.insert(name.to_string(), value);
        }
    }
}
