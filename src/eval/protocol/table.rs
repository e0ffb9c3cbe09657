//! Results as a page of Markdown.

use std::fmt::Write as _;

use super::{ProtocolMeasure, ProtocolResult, ProtocolRow, PublishedRow};
use crate::eval::ConfidenceInterval;
use crate::text::quoted;

/// Columns of a table of measures, so that its rows fit on a screen.
const WIDTH: usize = 4;
/// Longest line of text, characters.
const LINE: usize = 150;

impl ProtocolResult {
    /// Returns the results as a page of Markdown: published numbers with ours beside them, then all measures.
    pub fn to_markdown(&self) -> String {
        let (protocol, plan) = (&self.protocol, &self.plan);
        let mut out = format!("# {}\n\n", plain(&protocol.title));
        wrap(&mut out, &protocol.about);
        out.push('\n');
        let (trials, seconds) = self.extent();
        let commit = self
            .commit
            .as_deref()
            .map_or(String::new(), |commit| format!(", commit {commit}"));
        let mut made = format!(
            "Seeds: {}. Trials: {trials}, of {seconds:.1} s each. This is {} of the protocol's length. Cells have the mean over seeds; with several \
             seeds the brackets have the interval that holds 95 % of the means of samples drawn from them with replacement. Babybench {}{commit}.",
            plan.seeds, plan.length, self.babybench
        );
        if !plan.keys.is_empty() {
            let keys = plan.keys.trim().replace('\n', ", ");
            made.push_str(&format!(" Changed keys: `{}`.", plain(&keys)));
        }
        wrap(&mut out, &made);
        self.beside(&mut out);
        self.measures(&mut out);
        self.legend(&mut out);
        out
    }

    /// Returns the number of trials of a run and their length, s.
    fn extent(&self) -> (u32, f64) {
        let (protocol, plan) = (&self.protocol, &self.plan);
        let seconds = protocol
            .phases
            .iter()
            .map(|phase| plan.seconds(protocol, phase.seconds))
            .sum();
        (plan.trials(protocol), seconds)
    }

    /// Appends the published statements as a list, and the table of their numbers with ours beside them.
    fn beside(&self, out: &mut String) {
        out.push_str("\n## Beside published numbers\n\n");
        let published = &self.protocol.published;
        for (k, row) in published.iter().enumerate() {
            let ages = match row.ages {
                Some([from, to]) if from == to => format!(", {from} months"),
                Some([from, to]) => format!(", {from} to {to} months"),
                None => String::new(),
            };
            let measured = if row.measure.is_none() {
                " Not measured here."
            } else {
                ""
            };
            let (says, source) = (capital(&plain(&row.says)), plain(&row.source));
            let line = format!(
                "{}. {says}{ages}: {} ({}; {source}).{measured}",
                k + 1,
                row.text(),
                row.mark
            );
            wrap(out, &line);
        }
        out.push('\n');
        let marks = PublishedRow::MARKS.map(|(mark, meaning)| format!("({mark}) {meaning}"));
        let about = format!(
            "{}. A difference is ours less the published number, or less the nearer end of a range; 0 is within it. It judges nothing: MIMo is a \
             model, and policies are not infants.",
            marks.join(", ")
        );
        wrap(out, &about);
        out.push_str("\n| | measure | published | policy | ours | differs by |\n|--:|---|---|---|---|---|\n");
        for found in &self.comparisons {
            let row = &found.published;
            let Some(measure) = self.place(row) else {
                continue;
            };
            let decimals = self.decimals(row);
            let ours = match &found.ours {
                Some(interval) => format!("{} {}", text(interval, decimals), row.unit)
                    .trim_end()
                    .to_string(),
                None => found.missing.clone(),
            };
            let differs = found
                .difference
                .map_or(String::new(), |difference| difference.text(&row.unit, decimals));
            let number = published.iter().position(|other| other == row).unwrap_or(0) + 1;
            // writing to a string cannot fail
            let _ = writeln!(
                out,
                "| {number} | {} | {} | `{}` | {ours} | {differs} |",
                plain(&measure),
                row.text(),
                plain(&found.policy),
            );
        }
    }

    /// Returns the measure of a published row, with its condition and its phase if there are several; `None` if it has no measure.
    fn place(&self, row: &PublishedRow) -> Option<String> {
        let (conditions, phases) = (&self.protocol.conditions, &self.protocol.phases);
        let measure = self.protocol.measure(row.measure.as_deref()?)?;
        let mut places = vec![measure.label.clone()];
        places.extend(row.condition.clone().filter(|_| conditions.len() > 1));
        places.extend(row.phase.clone().filter(|_| phases.len() > 1));
        Some(places.join(", "))
    }

    fn decimals(&self, row: &PublishedRow) -> usize {
        let measure = row.measure.as_deref().and_then(|name| self.protocol.measure(name));
        measure.map_or(2, |measure| measure.decimals)
    }

    /// Appends the tables of all measures, a section for each condition and phase.
    fn measures(&self, out: &mut String) {
        let protocol = &self.protocol;
        for condition in &protocol.conditions {
            for phase in &protocol.phases {
                let rows: Vec<&ProtocolRow> = self.rows_of(&condition.name, &phase.name).collect();
                let _ = write!(
                    out,
                    "\n## All measures: {}, {}\n\n",
                    plain(&condition.name),
                    plain(&phase.name)
                );
                let about = [&condition.about, &phase.about].map(|text| text.as_str());
                let about: Vec<&str> = about.into_iter().filter(|text| !text.is_empty()).collect();
                if !about.is_empty() {
                    wrap(out, &format!("{}.", capital(&about.join("; "))));
                    out.push('\n');
                }
                let has = |measure: &&ProtocolMeasure| rows.iter().any(|row| row.metrics.contains_key(&measure.name));
                let shown: Vec<&ProtocolMeasure> = protocol.measures.iter().filter(has).collect();
                if shown.is_empty() {
                    out.push_str("No measure is defined in these runs.\n");
                }
                for (k, shown) in shown.chunks(WIDTH).enumerate() {
                    if k > 0 {
                        out.push('\n');
                    }
                    table(out, &rows, shown);
                }
            }
        }
    }

    /// Appends the meanings of the measures.
    fn legend(&self, out: &mut String) {
        out.push_str("\n## Meanings\n\n");
        for measure in &self.protocol.measures {
            let unit = match measure.unit.as_str() {
                "" => String::new(),
                unit => format!(", {unit}"),
            };
            let line = format!(
                "- **{}** (`{}`{unit}): {}",
                plain(&measure.label),
                plain(&measure.name),
                plain(&measure.meaning)
            );
            wrap(out, &line);
        }
    }
}

/// Appends a table with the given measures.
fn table(out: &mut String, rows: &[&ProtocolRow], shown: &[&ProtocolMeasure]) {
    out.push_str("| policy | months |");
    for measure in shown {
        let unit = match measure.unit.as_str() {
            "" => String::new(),
            unit => format!(", {unit}"),
        };
        let _ = write!(out, " {}{unit} |", plain(&measure.label));
    }
    let _ = writeln!(out, "\n|---|--:|{}", "--:|".repeat(shown.len()));
    for row in rows {
        if shown.iter().all(|measure| !row.metrics.contains_key(&measure.name)) {
            continue;
        }
        let age = row.age.map_or("all".to_string(), |age| age.to_string());
        let _ = write!(out, "| `{}` | {age} |", plain(&row.policy));
        for measure in shown {
            let cell = row
                .metrics
                .get(&measure.name)
                .map(|interval| text(interval, measure.decimals));
            let _ = write!(out, " {} |", cell.unwrap_or_default());
        }
        out.push('\n');
    }
}

/// Returns a mean, with its interval if it is of several runs.
pub(super) fn text(interval: &ConfidenceInterval, decimals: usize) -> String {
    let ConfidenceInterval { mean, low, high, runs } = *interval;
    let round = |value: f64| rounded(format!("{value:.decimals$}"));
    match runs {
        1 => round(mean),
        _ => format!("{} ({} to {})", round(mean), round(low), round(high)),
    }
}

/// Removes the sign that rounding leaves before a 0.
pub(super) fn rounded(text: String) -> String {
    match text.strip_prefix(['-', '+']) {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_string(),
        _ => text,
    }
}

/// Returns foreign text for a cell of a table.
fn plain(text: &str) -> String {
    quoted(text).replace('|', "\\|")
}

/// Returns a text with a capital letter at its start.
fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(chars).collect())
}

/// Appends a paragraph, or an item of a list, in lines of limited length.
pub(super) fn wrap(out: &mut String, text: &str) {
    let indent = match text.split_once(' ') {
        Some((mark, _))
            if mark == "-" || mark.ends_with('.') && mark.len() < 4 && mark.as_bytes()[0].is_ascii_digit() =>
        {
            " ".repeat(mark.len() + 1)
        }
        _ => String::new(),
    };
    let mut width = 0;
    for word in text.split_whitespace() {
        let len = word.chars().count();
        if width > 0 && width + 1 + len > LINE {
            out.push('\n');
            out.push_str(&indent);
            width = indent.len();
        } else if width > 0 {
            out.push(' ');
            width += 1;
        }
        out.push_str(word);
        width += len;
    }
    out.push('\n');
}
