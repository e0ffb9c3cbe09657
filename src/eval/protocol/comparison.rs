//! Ours beside published numbers: how far they differ.

use serde::{Deserialize, Serialize};

use super::table::rounded;
use super::{MeasureRule, Protocol, ProtocolPlan, ProtocolRow, ProtocolRun, PublishedRow};
use crate::eval::ConfidenceInterval;

/// A published row beside the number of a policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The published row.
    pub published: PublishedRow,
    /// The policy.
    pub policy: String,
    /// The mean over runs at the ages of the row, with its interval.
    pub ours: Option<ConfidenceInterval>,
    /// How far it is from the published number or range.
    pub difference: Option<Difference>,
    /// Why MIMo's value is missing; empty if there is one.
    pub missing: String,
}

/// The distance of a number from a published one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Ours less the published number, or less the nearer end of its range; 0 within the range.
    pub absolute: f64,
    /// The same over that number, if it is above 0.
    pub relative: Option<f64>,
    /// The same in standard deviations over infants, if they were published.
    pub deviations: Option<f64>,
}

impl Difference {
    /// Computes the distance; `None` if the number was not found.
    pub fn of(ours: f64, published: &PublishedRow) -> Option<Self> {
        let [low, high] = published.range()?;
        let nearest = ours.clamp(low, high);
        let absolute = ours - nearest;
        Some(Self {
            absolute,
            relative: (nearest > 0.0 && absolute != 0.0).then(|| absolute / nearest),
            deviations: published.sd.filter(|sd| *sd > 0.0).map(|sd| absolute / sd),
        })
    }

    /// Returns the distance as tables show it: `+0.5 months (+14 %)`.
    pub fn text(&self, unit: &str, decimals: usize) -> String {
        if self.absolute == 0.0 {
            return format!("0 {unit}").trim_end().to_string();
        }
        let mut more = Vec::new();
        more.extend(self.relative.map(|share| format!("{:+.0} %", 100.0 * share)));
        more.extend(self.deviations.map(|sd| format!("{sd:+.1} SD")));
        let absolute = format!("{} {unit}", rounded(format!("{:+.decimals$}", self.absolute)));
        if more.is_empty() {
            absolute.trim_end().to_string()
        } else {
            format!("{} ({})", absolute.trim_end(), more.join(", "))
        }
    }
}

/// Compares every published row with the rows of every policy.
pub(super) fn compare(
    protocol: &Protocol,
    plan: &ProtocolPlan,
    rows: &[ProtocolRow],
    runs: &[ProtocolRun],
) -> Vec<Comparison> {
    let mut out = Vec::new();
    for published in &protocol.published {
        for policy in &plan.policies {
            let found = if whole(protocol, plan, published) {
                ours(protocol, published, policy, rows, runs)
            } else {
                Err("needs the whole length")
            };
            let (ours, missing) = match found {
                Ok(interval) => (Some(interval), String::new()),
                Err(reason) => (None, reason.to_string()),
            };
            out.push(Comparison {
                difference: ours.and_then(|ours| Difference::of(ours.mean, published)),
                published: published.clone(),
                policy: policy.clone(),
                ours,
                missing,
            });
        }
    }
    out
}

/// Returns whether the phases were long enough for the measure of a row: the time until something happens is not that of a shorter phase.
fn whole(protocol: &Protocol, plan: &ProtocolPlan, published: &PublishedRow) -> bool {
    let measure = published.measure.as_deref().and_then(|name| protocol.measure(name));
    let waits = measure.is_some_and(|measure| matches!(measure.rule, MeasureRule::Reached { .. }));
    !waits
        || protocol
            .phases
            .iter()
            .all(|phase| plan.seconds(protocol, phase.seconds) == phase.seconds)
}

/// Returns the number beside a published row, or the reason why there is none.
fn ours(
    protocol: &Protocol,
    published: &PublishedRow,
    policy: &str,
    rows: &[ProtocolRow],
    runs: &[ProtocolRun],
) -> Result<ConfidenceInterval, &'static str> {
    let (Some(name), Some(condition), Some(phase)) = (&published.measure, &published.condition, &published.phase)
    else {
        return Err("not measured");
    };
    if protocol
        .measure(name)
        .is_some_and(|measure| matches!(measure.rule, MeasureRule::Age { .. }))
    {
        let row = rows
            .iter()
            .find(|row| row.age.is_none() && row.policy == policy && row.condition == *condition);
        let interval = row.and_then(|row| row.metrics.get(name).copied());
        return interval.ok_or("not reached between the ages of the run");
    }
    let mut at_ages = runs
        .iter()
        .filter(|run| run.policy == policy && published.observed_at(run.age))
        .peekable();
    if at_ages.peek().is_none() {
        return Err("no run at these ages");
    }
    let values: Vec<f64> = at_ages.filter_map(|run| run.value(condition, phase, name)).collect();
    ConfidenceInterval::of(&values).ok_or("undefined in these runs")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(value: Option<f64>, low: Option<f64>, high: Option<f64>) -> PublishedRow {
        PublishedRow {
            says: "test".to_string(),
            measure: None,
            condition: None,
            phase: None,
            ages: None,
            value,
            low,
            high,
            sd: value.map(|_| 2.0),
            unit: "s".to_string(),
            source: "none".to_string(),
            mark: "u".to_string(),
        }
    }

    #[test]
    fn numbers_differ_by_their_distance_from_the_nearer_end() {
        let of = |ours, row: &PublishedRow| Difference::of(ours, row).expect("a number").text("s", 1);
        assert_eq!(of(5.0, &row(Some(4.0), None, None)), "+1.0 s (+25 %, +0.5 SD)");
        let range = row(None, Some(2.0), Some(4.0));
        assert_eq!(of(1.0, &range), "-1.0 s (-50 %)");
        assert_eq!(of(3.0, &range), "0 s");
        assert_eq!(of(5.0, &row(None, Some(0.0), None)), "0 s");
        assert_eq!(of(-0.5, &row(None, Some(0.0), None)), "-0.5 s");
        assert_eq!(Difference::of(1.0, &row(None, None, None)), None);
        assert_eq!(row(None, None, None).text(), "not found");
        assert_eq!(range.text(), "2 to 4 s");
        assert_eq!(row(Some(4.0), None, None).text(), "4 +- 2 s");
    }
}
