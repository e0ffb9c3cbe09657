//! A protocol as text.

use std::fmt::Write as _;

use super::table::wrap;
use super::{MeasureRule, Protocol};

impl Protocol {
    /// Describes the protocol: scene, ages, phases, conditions, measures and published numbers with their sources.
    pub fn to_text(&self) -> String {
        let mut out = format!("{}: {}\n\n", self.name, self.title);
        wrap(&mut out, &self.about);
        let ages: Vec<String> = self.ages.iter().map(f64::to_string).collect();
        // writing to a string cannot fail
        let _ = writeln!(
            out,
            "\nages, months: {}\ntrials: {}\nconfiguration:",
            ages.join(", "),
            self.trials
        );
        for line in self.keys.lines() {
            let _ = writeln!(out, "  {line}");
        }
        out.push_str("\nphases:\n");
        for phase in &self.phases {
            let parts = match phase.parts {
                1 => String::new(),
                parts => format!(", in {parts} parts"),
            };
            let _ = writeln!(out, "  {:<24} {} s{parts}: {}", phase.name, phase.seconds, phase.about);
        }
        out.push_str("\nconditions:\n");
        for condition in &self.conditions {
            let about = match condition.about.as_str() {
                "" => "the policy moves everything",
                about => about,
            };
            let _ = writeln!(out, "  {:<24} {about}", condition.name);
        }
        out.push_str("\nmeasures:\n");
        for measure in &self.measures {
            let across = match measure.rule {
                MeasureRule::Age { .. } => " (needs several ages)",
                _ => "",
            };
            let _ = writeln!(
                out,
                "  {:<24} {:<12} {}{across}",
                measure.name, measure.unit, measure.meaning
            );
        }
        self.show_published(&mut out);
        out
    }

    fn show_published(&self, out: &mut String) {
        out.push_str("\npublished:\n");
        for row in &self.published {
            let ages = match row.ages {
                Some([from, to]) if from == to => format!("{from} months: "),
                Some([from, to]) => format!("{from} to {to} months: "),
                None => String::new(),
            };
            let measure = match &row.measure {
                Some(measure) => format!("beside `{measure}`"),
                None => "not measured here".to_string(),
            };
            let _ = writeln!(
                out,
                "  {ages}{}: {} ({}), {measure}\n    {}",
                row.says,
                row.text(),
                row.mark,
                row.source
            );
        }
    }
}
