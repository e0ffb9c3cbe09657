//! The table of a benchmark.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::{Benchmark, ConfidenceInterval, RunResult};
use crate::eval::Measures;

/// A row of the table: the runs of a configuration, an age and a policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BenchmarkRow {
    /// The file of the configuration, without its ending.
    pub config: String,
    /// The behavior.
    pub behavior: String,
    /// The age of MIMo's body, months.
    pub age: Option<f64>,
    /// The policy.
    pub policy: String,
    /// The mean of each metric, by its name.
    pub metrics: BTreeMap<String, ConfidenceInterval>,
}

/// A quantity that is measured in a run.
#[derive(Clone, Copy, Debug)]
pub struct Metric {
    /// Its name in files.
    pub name: &'static str,
    /// Its heading in tables.
    pub heading: &'static str,
    /// Number of decimals that tables show.
    pub decimals: usize,
}

const fn metric(name: &'static str, heading: &'static str, decimals: usize) -> Metric {
    Metric {
        name,
        heading,
        decimals,
    }
}

impl Metric {
    /// Every metric except the scores after given numbers of steps, in the order of tables.
    pub const ALL: [Self; 15] = [
        metric("score", "score", 3),
        metric("parts_per_episode", "parts per episode", 1),
        metric("evaluated_score", "score, evaluated", 3),
        metric("evaluated_parts", "parts per episode, evaluated", 1),
        metric("mean_return", "return", 2),
        metric("successes", "successes", 2),
        metric("touches_per_minute", "touches per minute", 1),
        metric("touch_duration", "duration, s", 2),
        metric("touch_share", "time touching", 3),
        metric("hand_to_hand", "hand to hand", 3),
        metric("double_touch", "double touch", 3),
        metric("handedness", "handedness", 2),
        metric("smoothness", "smoothness", 1),
        metric("symmetry", "symmetry", 2),
        metric("hands_seen", "hands seen", 3),
    ];

    /// Returns the value of the metric in a run, if it has one.
    fn of(&self, run: &RunResult) -> Option<f64> {
        let measures = run.measures.as_ref();
        let number = |m: &Measures| m.right_hand.per_minute + m.left_hand.per_minute;
        match self.name {
            "score" => run.score,
            "parts_per_episode" => run.parts_per_episode,
            "evaluated_score" => run.evaluated_score,
            "evaluated_parts" => run.evaluated_parts,
            "mean_return" => run.mean_return,
            "successes" => run.successes,
            "touches_per_minute" => measures.map(number),
            "touch_duration" => measures.filter(|m| number(m) > 0.0).map(|m| {
                let time = |hand: &crate::eval::HandMeasures| hand.per_minute * hand.duration;
                (time(&m.right_hand) + time(&m.left_hand)) / number(m)
            }),
            "touch_share" => measures.map(|m| 0.5 * (m.right_hand.share + m.left_hand.share)),
            "hand_to_hand" => measures.map(|m| m.hand_to_hand),
            "double_touch" => measures.map(|m| m.double_touch),
            "handedness" => measures.map(|m| m.handedness),
            "smoothness" => measures.and_then(|m| m.smoothness),
            "symmetry" => measures.and_then(|m| m.symmetry),
            "hands_seen" => measures
                .and_then(|m| m.hands_seen)
                .map(|seen| seen.to_array().iter().sum::<f64>() / 4.0),
            _ => None,
        }
    }
}

/// Groups the runs that differ only in their seeds.
pub(super) fn rows(runs: &[RunResult]) -> Vec<BenchmarkRow> {
    let same = |a: &RunResult, b: &RunResult| (&a.config, a.age, &a.policy) == (&b.config, b.age, &b.policy);
    runs.chunk_by(|a, b| same(a, b))
        .filter_map(|group| group.first().map(|first| row(first, group)))
        .collect()
}

fn row(first: &RunResult, group: &[RunResult]) -> BenchmarkRow {
    let mut metrics = BTreeMap::new();
    for metric in Metric::ALL {
        let values: Vec<f64> = group.iter().filter_map(|run| metric.of(run)).collect();
        metrics.extend(ConfidenceInterval::of(&values).map(|interval| (metric.name.to_string(), interval)));
    }
    for &mark in first.score_at.keys() {
        let values: Vec<f64> = group
            .iter()
            .filter_map(|run| run.score_at.get(&mark).copied())
            .collect();
        metrics.extend(ConfidenceInterval::of(&values).map(|interval| (format!("score_at_{mark}"), interval)));
    }
    BenchmarkRow {
        config: first.config.clone(),
        behavior: first.behavior.clone(),
        age: first.age,
        policy: first.policy.clone(),
        metrics,
    }
}

impl BenchmarkRow {
    /// Returns a metric as tables show it: the mean, then the 95 % interval.
    pub fn text(&self, metric: &str, decimals: usize) -> Option<String> {
        let ConfidenceInterval { mean, low, high, .. } = *self.metrics.get(metric)?;
        Some(format!("{mean:.decimals$} ({low:.decimals$} to {high:.decimals$})"))
    }
}

impl Benchmark {
    /// Returns names, headings and decimals of the columns that any row has: scores after numbers of steps, then all metrics.
    pub fn columns(&self) -> Vec<(String, String, usize)> {
        let has = |name: &str| self.rows.iter().any(|row| row.metrics.contains_key(name));
        let marks: std::collections::BTreeSet<u64> =
            self.runs.iter().flat_map(|run| run.score_at.keys().copied()).collect();
        let marks = marks
            .into_iter()
            .map(|mark| (format!("score_at_{mark}"), format!("score at {mark} steps"), 3));
        let metrics = Metric::ALL
            .iter()
            .map(|m| (m.name.to_string(), m.heading.to_string(), m.decimals));
        marks.chain(metrics).filter(|(name, ..)| has(name)).collect()
    }

    /// Returns the table as a page of Markdown, a section for each configuration.
    pub fn to_markdown(&self) -> String {
        let plan = &self.plan;
        let mut out = format!("# {}\n\n", self.name);
        // writing to a string cannot fail
        let _ = writeln!(
            out,
            "{} seeds, {} steps each. Measures are of the first {} episodes of a run. Each cell has the mean over seeds, and in brackets the interval that\n\
             holds 95 % of the means of samples drawn from the seeds with replacement. Babybench {}.\n",
            plan.seeds, plan.steps, plan.record, self.babybench
        );
        let columns = self.columns();
        for group in self.rows.chunk_by(|a, b| a.config == b.config) {
            section(&mut out, group, &columns);
        }
        let names = |list: &[String]| list.join(", ");
        let ages = plan
            .ages
            .iter()
            .map(|age| age.map_or("none".to_string(), |age| age.to_string()));
        let ages = ages.collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            out,
            "Made by `babybench benchmark` from this plan:\n\n```yaml\nname: {}\nconfigs: [{}]\nages: [{ages}]\npolicies: [{}]\nseeds: {}\n\
             steps: {}\nrecord: {}\n{}```",
            plan.name,
            names(&plan.configs),
            names(&plan.policies),
            plan.seeds,
            plan.steps,
            plan.record,
            match plan.evaluate {
                0 => String::new(),
                episodes => format!("evaluate: {episodes}\n"),
            }
        );
        out
    }
}

/// Appends the section of a configuration: tables with a line for each policy and age.
fn section(out: &mut String, group: &[BenchmarkRow], columns: &[(String, String, usize)]) {
    // columns of a table, so that its rows fit on a screen
    const WIDTH: usize = 5;
    let Some(first) = group.first() else {
        return;
    };
    let _ = writeln!(out, "## {} ({})\n", first.behavior.replace('_', " "), first.config);
    let shown: Vec<_> = columns
        .iter()
        .filter(|(name, ..)| group.iter().any(|row| row.metrics.contains_key(name)))
        .collect();
    shown.chunks(WIDTH).for_each(|shown| table(out, group, shown));
}

/// Appends a table with the given columns.
fn table(out: &mut String, group: &[BenchmarkRow], shown: &[&(String, String, usize)]) {
    let ages = group.iter().any(|row| row.age.is_some());
    let _ = write!(out, "| policy |{}", if ages { " age, months |" } else { "" });
    for (_, heading, _) in shown {
        let _ = write!(out, " {heading} |");
    }
    let _ = writeln!(out, "\n|---|{}", "--:|".repeat(shown.len() + usize::from(ages)));
    for row in group {
        let _ = write!(out, "| `{}` |", row.policy.replace('|', "\\|"));
        if ages {
            let _ = write!(
                out,
                " {} |",
                row.age.map_or("original".to_string(), |age| age.to_string())
            );
        }
        for (name, _, decimals) in shown {
            let _ = write!(out, " {} |", row.text(name, *decimals).unwrap_or_default());
        }
        out.push('\n');
    }
    out.push('\n');
}
