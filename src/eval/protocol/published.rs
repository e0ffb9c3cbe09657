//! Published numbers.

use serde::{Deserialize, Serialize};

use super::{Condition, Phase};

/// A published statement about infants, with its number if one was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PublishedRow {
    /// The statement.
    pub says: String,
    /// The measure beside it; none if nothing here measures it.
    pub measure: Option<String>,
    /// The condition in which it is measured.
    pub condition: Option<String>,
    /// The phase in which it is measured.
    pub phase: Option<String>,
    /// The youngest and the oldest infants, months.
    pub ages: Option<[f64; 2]>,
    /// The number.
    pub value: Option<f64>,
    /// The lower end of a range.
    pub low: Option<f64>,
    /// The upper end of a range.
    pub high: Option<f64>,
    /// Standard deviation over infants.
    pub sd: Option<f64>,
    /// The unit; empty for ratios.
    pub unit: String,
    /// The publication, and how it was read.
    pub source: String,
    /// How sure the number is: see [`PublishedRow::MARKS`].
    pub mark: String,
}

impl PublishedRow {
    /// The marks and their meaning.
    pub const MARKS: [(&'static str, &'static str); 5] = [
        ("r", "read in the source"),
        ("s", "seen in an abstract or a summary"),
        ("m", "measured with this simulator"),
        ("h", "worked out from others"),
        ("u", "unsourced"),
    ];

    /// Fills in the first condition and the first phase where the row names none.
    pub(super) fn place(&mut self, phases: &[Phase], conditions: &[Condition]) {
        if self.measure.is_some() {
            let first = phases.first().map(|phase| phase.name.clone());
            self.phase = self.phase.take().or(first);
            let first = conditions.first().map(|condition| condition.name.clone());
            self.condition = self.condition.take().or(first);
        }
    }

    /// Returns the number as tables show it: `6 +- 1.1 months`, `0.23 to 0.33 s`, `at most 40`, or `not found`.
    pub fn text(&self) -> String {
        let number = match (self.value, self.low, self.high) {
            (Some(value), ..) => match self.sd {
                Some(sd) => format!("{value} +- {sd}"),
                None => value.to_string(),
            },
            (_, Some(low), Some(high)) => format!("{low} to {high}"),
            (_, Some(low), None) => format!("at least {low}"),
            (_, None, Some(high)) => format!("at most {high}"),
            (None, None, None) => return "not found".to_string(),
        };
        format!("{number} {}", self.unit).trim_end().to_string()
    }

    /// Returns the ends of the range of the number; both are the number if it is one. `None` if it was not found.
    pub fn range(&self) -> Option<[f64; 2]> {
        if let Some(value) = self.value {
            return Some([value; 2]);
        }
        (self.low.is_some() || self.high.is_some()).then(|| {
            [
                self.low.unwrap_or(f64::NEG_INFINITY),
                self.high.unwrap_or(f64::INFINITY),
            ]
        })
    }

    /// Returns whether infants of an age were observed.
    pub fn observed_at(&self, age: f64) -> bool {
        self.ages.is_none_or(|[from, to]| (from..=to).contains(&age))
    }
}
