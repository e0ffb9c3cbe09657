//! Results as a figure for a paper: a panel for each measure, over age, or over phases if there are several.

use std::fmt::Write as _;

use super::{MeasureRule, ProtocolMeasure, ProtocolResult, ProtocolRow};
use crate::eval::ConfidenceInterval;

/// Width and height of a panel, and its margins: left, top, right, bottom, pixels.
const PANEL: [f64; 2] = [340.0, 250.0];
const MARGIN: [f64; 4] = [58.0, 30.0, 14.0, 44.0];
/// Panels in a row, and the height of a line of the legend.
const COLUMNS: usize = 2;
const LINE: f64 = 18.0;
/// Colours that people with any colour vision can tell apart (Okabe and Ito, 2008).
const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// A line of the figure: a policy, a condition, and with several phases an age.
struct Series<'r> {
    label: String,
    /// Place of each row on the axis, and the row.
    rows: Vec<(f64, &'r ProtocolRow)>,
}

/// The axis that all panels share.
struct Axis {
    name: &'static str,
    ticks: Vec<(f64, String)>,
    ends: [f64; 2],
}

impl ProtocolResult {
    /// Draws the measures that the protocol shows in its figure as an SVG document: means with intervals over seeds, and published numbers in
    /// grey.
    pub fn to_svg(&self) -> String {
        let phased = self.protocol.phases.len() > 1;
        let (axis, series) = (self.axis(phased), self.series(phased));
        let shown: Vec<&ProtocolMeasure> = self.protocol.measures.iter().filter(|measure| measure.figure).collect();
        let rows = shown.len().div_ceil(COLUMNS).max(1);
        let size = [
            PANEL[0] * shown.len().clamp(1, COLUMNS) as f64,
            PANEL[1] * rows as f64 + LINE * (series.len() + 1) as f64 + 10.0,
        ];
        // writing to a string cannot fail
        let mut out = String::new();
        let _ = write!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\">\n<title>{}</title>\n\
             <style>text{{font:12px Helvetica,Arial,sans-serif;fill:#1d2430}}.tick{{fill:#5c6675}}.grid{{stroke:#e2e3e6}}\
             .band{{fill:#5c6675;fill-opacity:.18}}.level{{stroke:#5c6675;stroke-dasharray:5 4}}</style>\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n",
            escaped(&self.protocol.title),
            w = size[0],
            h = size[1]
        );
        for (k, measure) in shown.iter().enumerate() {
            let corner = [PANEL[0] * (k % COLUMNS) as f64, PANEL[1] * (k / COLUMNS) as f64];
            let _ = writeln!(out, "<g transform=\"translate({} {})\">", corner[0], corner[1]);
            self.panel(&mut out, measure, &axis, &series, phased);
            out.push_str("</g>\n");
        }
        legend(&mut out, &series, PANEL[1] * rows as f64);
        out.push_str("</svg>\n");
        out
    }

    fn axis(&self, phased: bool) -> Axis {
        if phased {
            let phases = self.protocol.phases.iter().enumerate();
            return Axis {
                name: "phase",
                ticks: phases.map(|(k, phase)| (k as f64, phase.name.clone())).collect(),
                ends: [-0.5, self.protocol.phases.len() as f64 - 0.5],
            };
        }
        let mut ages = self.plan.ages(&self.protocol).to_vec();
        ages.sort_by(f64::total_cmp);
        let [first, last] = [ages.first(), ages.last()].map(|age| age.copied().unwrap_or(0.0));
        let free = 0.06 * (last - first).max(1.0);
        let mut ticks: Vec<(f64, String)> = Vec::new();
        for age in ages {
            // labels of neighbouring ages must not overlap
            if ticks.last().is_none_or(|(before, _)| age - before >= free) {
                ticks.push((age, age.to_string()));
            }
        }
        Axis {
            name: "age, months",
            ticks,
            ends: [first - free, last + free],
        }
    }

    /// Returns the lines, in the order of the table.
    fn series(&self, phased: bool) -> Vec<Series<'_>> {
        let mut out: Vec<Series<'_>> = Vec::new();
        for row in &self.rows {
            let Some(age) = row.age else {
                continue;
            };
            let mut label = row.policy.clone();
            if self.protocol.conditions.len() > 1 {
                label.push_str(&format!(", {}", row.condition));
            }
            let mut at = age;
            if phased {
                label.push_str(&format!(", {age} months"));
                let place = self.protocol.phases.iter().position(|phase| phase.name == row.phase);
                at = place.unwrap_or(0) as f64;
            }
            match out.iter_mut().find(|series| series.label == label) {
                Some(series) => series.rows.push((at, row)),
                None => out.push(Series {
                    label,
                    rows: vec![(at, row)],
                }),
            }
        }
        out.iter_mut()
            .for_each(|series| series.rows.sort_by(|a, b| a.0.total_cmp(&b.0)));
        out
    }

    /// Returns the published numbers of a measure: where they are on the axis, and their range. Ages at which it crosses a level are bands of
    /// the whole height.
    fn published(&self, measure: &ProtocolMeasure, axis: &Axis, phased: bool) -> Vec<([f64; 2], [f64; 2])> {
        let mut out = Vec::new();
        for row in &self.protocol.published {
            let Some((range, found)) = row.range().zip(row.measure.as_deref()) else {
                continue;
            };
            let place = row.phase.as_deref().filter(|_| phased);
            let place = place.and_then(|name| self.protocol.phases.iter().position(|phase| phase.name == name));
            let of = |rule: &MeasureRule| matches!(rule, MeasureRule::Age { of, .. } if *of == measure.name);
            let ([from, to], range) = if self.protocol.measure(found).is_some_and(|other| of(&other.rule)) {
                // an age at which the measure crosses a level
                (range, [f64::NEG_INFINITY, f64::INFINITY])
            } else if found == measure.name {
                let ages = match (place, row.ages) {
                    (Some(place), _) => [place as f64 - 0.5, place as f64 + 0.5],
                    (None, Some(ages)) => ages,
                    (None, None) => axis.ends,
                };
                (ages, range)
            } else {
                continue;
            };
            let (from, to) = (from.max(axis.ends[0]), to.min(axis.ends[1]));
            if from <= to {
                out.push(([from, to], range));
            }
        }
        out
    }

    fn panel(&self, out: &mut String, measure: &ProtocolMeasure, axis: &Axis, series: &[Series<'_>], phased: bool) {
        let found = |row: &ProtocolRow| row.metrics.get(&measure.name).copied();
        let published = self.published(measure, axis, phased);
        let intervals = series
            .iter()
            .flat_map(|line| line.rows.iter().filter_map(|(_, row)| found(row)));
        let values = intervals.flat_map(|i| [i.low, i.high]);
        let ends = published
            .iter()
            .flat_map(|(_, range)| *range)
            .filter(|end| end.is_finite());
        let plot = Plot::new(axis.ends, values.chain(ends));
        plot.frame(out, measure, axis);
        for (ages, range) in &published {
            plot.published(out, *ages, *range);
        }
        for (k, line) in series.iter().enumerate() {
            let points = line.rows.iter().filter_map(|(at, row)| Some((*at, found(row)?)));
            plot.line(out, COLOURS[k % COLOURS.len()], &points.collect::<Vec<_>>());
        }
    }
}

/// The scales of a panel.
struct Plot {
    x: [f64; 2],
    y: [f64; 2],
}

impl Plot {
    /// Makes room for values, and for 0.
    fn new(x: [f64; 2], values: impl Iterator<Item = f64>) -> Self {
        let [low, high] = values.fold([0.0_f64; 2], |[low, high], v| [low.min(v), high.max(v)]);
        let span = if high > low { high - low } else { 1.0 };
        let y = [
            if low < 0.0 { low - 0.06 * span } else { 0.0 },
            low.max(high.max(low + span)) + 0.06 * span,
        ];
        Self { x, y }
    }

    fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let [left, top, right, bottom] = MARGIN;
        let share = |value: f64, [from, to]: [f64; 2]| (value - from) / (to - from);
        [
            left + share(x, self.x) * (PANEL[0] - left - right),
            PANEL[1] - bottom - share(y.clamp(self.y[0], self.y[1]), self.y) * (PANEL[1] - top - bottom),
        ]
    }

    /// Draws the frame, the title and the ticks.
    fn frame(&self, out: &mut String, measure: &ProtocolMeasure, axis: &Axis) {
        let unit = match measure.unit.as_str() {
            "" => String::new(),
            unit => format!(", {unit}"),
        };
        let title = escaped(&format!("{}{unit}", measure.label));
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"18\" font-weight=\"bold\">{title}</text>",
            MARGIN[0]
        );
        for value in ticks(self.y) {
            let ([left, y], [right, _]) = (self.place(self.x[0], value), self.place(self.x[1], value));
            let _ = writeln!(out, "<path class=\"grid\" d=\"M{left:.1} {y:.1}H{right:.1}\"/>");
            let (x, y) = (left - 6.0, y + 4.0);
            // what is left of 0 after sums of fractions would have digits
            let text = format!("{value:.6}");
            let text = text.trim_end_matches('0').trim_end_matches('.');
            let text = if text == "-0" { "0" } else { text };
            let _ = writeln!(
                out,
                "<text class=\"tick\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{text}</text>"
            );
        }
        let [_, floor] = self.place(self.x[0], self.y[0]);
        for (at, name) in &axis.ticks {
            let ([x, _], y) = (self.place(*at, self.y[0]), floor + 16.0);
            let name = escaped(name);
            let _ = writeln!(
                out,
                "<text class=\"tick\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{name}</text>"
            );
        }
        let (x, y) = (0.5 * (MARGIN[0] + PANEL[0] - MARGIN[2]), floor + 34.0);
        let _ = writeln!(
            out,
            "<text class=\"tick\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{}</text>",
            axis.name
        );
    }

    /// Draws a published number as a dashed line, or its range as a band.
    fn published(&self, out: &mut String, [from, to]: [f64; 2], [low, high]: [f64; 2]) {
        // a single age has no width
        let wide = 0.02 * (self.x[1] - self.x[0]);
        let (from, to) = if to - from < wide {
            (from - 0.5 * wide, to + 0.5 * wide)
        } else {
            (from, to)
        };
        let ([left, bottom], [right, top]) = (self.place(from, low), self.place(to, high));
        if low < high {
            let (w, h) = (right - left, bottom - top);
            let _ = writeln!(
                out,
                "<rect class=\"band\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"{w:.1}\" height=\"{h:.1}\"/>"
            );
        } else {
            let _ = writeln!(out, "<path class=\"level\" d=\"M{left:.1} {top:.1}H{right:.1}\"/>");
        }
    }

    /// Draws means, joined by a line, with intervals.
    fn line(&self, out: &mut String, colour: &str, points: &[(f64, ConfidenceInterval)]) {
        let place = |(x, i): &(f64, ConfidenceInterval)| {
            let [x, y] = self.place(*x, i.mean);
            format!("{x:.1},{y:.1}")
        };
        let path: Vec<String> = points.iter().map(place).collect();
        if points.len() > 1 {
            let path = path.join(" ");
            let _ = writeln!(
                out,
                "<polyline points=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"/>"
            );
        }
        for (at, interval) in points {
            let ([x, y], [_, low], [_, high]) = (
                self.place(*at, interval.mean),
                self.place(*at, interval.low),
                self.place(*at, interval.high),
            );
            if interval.low < interval.high {
                let _ = writeln!(
                    out,
                    "<path d=\"M{x:.1} {low:.1}V{high:.1}\" stroke=\"{colour}\" stroke-width=\"1.5\"/>"
                );
            }
            let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>");
        }
    }
}

/// Returns round values within ends, three to seven of them.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let wanted = (high - low) / 5.0;
    let mut step = 1.0;
    // powers of ten by products, which are the same everywhere; numbers have no more of them
    for _ in 0..300 {
        if step > wanted {
            step /= 10.0;
        } else if step * 10.0 <= wanted {
            step *= 10.0;
        }
    }
    let step = [5.0, 2.0]
        .into_iter()
        .map(|factor| factor * step)
        .find(|step| *step <= wanted)
        .unwrap_or(step);
    let first = (low / step).ceil() as i64;
    (first..first + 20)
        .map(|k| k as f64 * step)
        .take_while(|value| *value <= high)
        .collect()
}

/// Draws the legend below the panels.
fn legend(out: &mut String, series: &[Series<'_>], top: f64) {
    for (k, line) in series.iter().enumerate() {
        let (y, colour) = (top + LINE * (k as f64 + 0.5), COLOURS[k % COLOURS.len()]);
        let _ = writeln!(
            out,
            "<circle cx=\"{}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"/>",
            MARGIN[0]
        );
        let (x, y) = (MARGIN[0] + 12.0, y + 4.0);
        let _ = writeln!(out, "<text x=\"{x}\" y=\"{y:.1}\">{}</text>", escaped(&line.label));
    }
    let y = top + LINE * (series.len() as f64 + 0.5);
    let _ = writeln!(
        out,
        "<rect class=\"band\" x=\"{}\" y=\"{:.1}\" width=\"12\" height=\"8\"/>",
        MARGIN[0] - 6.0,
        y - 4.0
    );
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{:.1}\">infants, published</text>",
        MARGIN[0] + 12.0,
        y + 4.0
    );
}

/// Returns a text for an XML document.
fn escaped(text: &str) -> String {
    let text = crate::text::quoted(text);
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(ticks([0.0, 1.06]), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        for ends in [[0.0, 0.003], [-5.0, 70.0], [0.0, 1e9], [-1e-3, 1e-3]] {
            let found = ticks(ends);
            assert!((3..=13).contains(&found.len()), "{ends:?}: {found:?}");
        }
    }
}
