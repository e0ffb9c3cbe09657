//! A table of the comparisons: how often each was made, how far the sides were apart, and where they differed.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::measured::Measured;
use super::node::Node;
use super::reduce::Finding;
use super::state::Recipe;

/// Number of findings kept for each quantity.
const KEPT: usize = 5;

/// A quantity over all documents.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Quantity {
    compared: usize,
    worst: f64,
    limit: f64,
    differ: usize,
}

/// Counts, worst errors and findings.
#[derive(Default, Serialize, Deserialize)]
pub struct Tally {
    counts: BTreeMap<String, usize>,
    quantities: BTreeMap<String, Quantity>,
    findings: Vec<Finding>,
}

impl Tally {
    /// Counts one more.
    pub fn count(&mut self, what: &str) {
        self.count_many(what, 1);
    }

    /// Counts some more.
    pub fn count_many(&mut self, what: &str, n: usize) {
        *self.counts.entry(what.to_owned()).or_default() += n;
    }

    /// Returns a count.
    pub fn counted(&self, what: &str) -> usize {
        self.counts.get(what).copied().unwrap_or(0)
    }

    /// Adds a quantity of a document, and of a state of it.
    pub fn add(&mut self, measured: &Measured, document: &Node, recipe: Option<Recipe>) {
        let quantity = self.quantities.entry(measured.quantity.to_owned()).or_default();
        quantity.compared += 1;
        quantity.worst = quantity.worst.max(measured.error);
        quantity.limit = quantity.limit.max(measured.limit);
        if measured.agrees() {
            return;
        }
        quantity.differ += 1;
        if quantity.differ <= KEPT {
            self.findings.push(Finding {
                document: document.clone(),
                recipe,
                quantity: measured.quantity.to_owned(),
                error: measured.error,
                place: measured.place.clone(),
            });
        }
    }

    /// Merges tallies.
    pub fn of(parts: impl IntoIterator<Item = Self>) -> Self {
        let mut all = Self::default();
        parts.into_iter().for_each(|part| all.append(part));
        all
    }

    /// Adds another tally.
    pub fn append(&mut self, other: Self) {
        other.counts.into_iter().for_each(|(what, n)| self.count_many(&what, n));
        for (name, part) in other.quantities {
            let all = self.quantities.entry(name).or_default();
            all.compared += part.compared;
            all.differ += part.differ;
            all.worst = all.worst.max(part.worst);
            all.limit = all.limit.max(part.limit);
        }
        self.findings.extend(other.findings);
    }

    /// Returns the findings, some of each quantity, the worst first.
    pub fn findings(&self) -> Vec<&Finding> {
        let mut all: Vec<&Finding> = self.findings.iter().collect();
        all.sort_by(|a, b| b.error.total_cmp(&a.error));
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        all.retain(|finding| {
            let n = seen.entry(&finding.quantity).or_default();
            *n += 1;
            *n <= KEPT
        });
        all
    }

    /// Returns how often the sides differed.
    pub fn differences(&self) -> usize {
        self.quantities.values().map(|quantity| quantity.differ).sum()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| what | number |\n|---|--:|")?;
        for (what, n) in &self.counts {
            writeln!(f, "| {what} | {n} |")?;
        }
        writeln!(
            f,
            "\n| quantity | compared | worst | limit | differ |\n|---|--:|--:|--:|--:|"
        )?;
        for (name, q) in &self.quantities {
            writeln!(
                f,
                "| {name} | {} | {:.1e} | {:.0e} | {} |",
                q.compared, q.worst, q.limit, q.differ
            )?;
        }
        Ok(())
    }
}
