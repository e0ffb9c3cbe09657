//! A benchmark as one page.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::months;
use super::svg::download;
use babybench::eval::{Benchmark, BenchmarkRow, ConfidenceInterval};
use babybench::text::quoted;

const STYLE: &str = include_str!("style.css");
/// Width and height of a chart row, pixels, and the width for names on its left.
const ROW: [f64; 3] = [640.0, 26.0, 210.0];

/// Returns a benchmark as one page that needs no other file: a chart of each measure with its intervals, and the table.
///
/// # Examples
/// See `babybench benchmark`, which writes `benchmark.html` with it.
pub fn benchmark_page(benchmark: &Benchmark) -> String {
    let columns = benchmark.columns();
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                // the page runs nothing and fetches nothing, whatever the plan contains
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (quoted(&benchmark.name)) " – BabyBench benchmark" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    p.over { "BabyBench benchmark" }
                    h1 { (quoted(&benchmark.name)) }
                    p.under {
                        (benchmark.plan.seeds) " seeds · " (benchmark.plan.steps) " steps each · bars are intervals of 95 % (bootstrap over seeds)"
                    }
                }
                main {
                    @for group in benchmark.rows.chunk_by(|a, b| a.config == b.config) {
                        @if let Some(first) = group.first() { (section(first, group, &columns)) }
                    }
                }
                footer { "Written by babybench " (benchmark.babybench) " on " (benchmark.platform) }
            }
        }
    };
    markup.into_string()
}

/// Draws the charts and the table of a configuration.
fn section(first: &BenchmarkRow, group: &[BenchmarkRow], columns: &[(String, String, usize)]) -> Markup {
    let shown = || {
        columns
            .iter()
            .filter(|(name, ..)| group.iter().any(|row| row.metrics.contains_key(name)))
    };
    html! {
        section {
            h2 { (quoted(&first.behavior.replace('_', " "))) " (" (quoted(&first.config)) ")" }
            @for (name, heading, decimals) in shown() {
                @let drawing = chart(group, name, *decimals);
                @let size = [ROW[0], height(group)];
                @let file = format!("{}-{name}", first.config);
                figure.chart { (drawing) figcaption { b { (heading) } " " (download(&drawing, size, &[], &file)) } }
            }
            div.scroll { table {
                thead { tr { th { "policy" } @for (_, heading, _) in shown() { th.number { (heading) } } } }
                @for row in group {
                    tr {
                        td { (label(row)) }
                        @for (name, _, decimals) in shown() { td.number { (row.text(name, *decimals).unwrap_or_default()) } }
                    }
                }
            } }
        }
    }
}

fn label(row: &BenchmarkRow) -> String {
    let policy = quoted(&row.policy);
    match row.age {
        Some(age) => format!("{policy}, {}", months(age)),
        None => policy,
    }
}

/// Returns the height of a chart.
fn height(group: &[BenchmarkRow]) -> f64 {
    ROW[1] * group.len() as f64 + 6.0
}

/// Draws means with their intervals, a line for each row.
fn chart(group: &[BenchmarkRow], name: &str, decimals: usize) -> Markup {
    let [width, height, left] = ROW;
    let found = || group.iter().filter_map(|row| row.metrics.get(name));
    let low = found().fold(0.0_f64, |low, i: &ConfidenceInterval| low.min(i.low));
    let high = found().fold(0.0_f64, |high, i| high.max(i.high));
    let span = if high > low { high - low } else { 1.0 };
    let at = |value: f64| left + (value - low) / span * (width - left - 70.0);
    let total = self::height(group);
    html! {
        svg viewBox=(format!("0 0 {width} {total}")) role="img" aria-label=(name) {
            line.grid x1=(format!("{:.1}", at(0.0))) x2=(format!("{:.1}", at(0.0))) y1="0" y2=(format!("{total}")) {}
            @for (k, row) in group.iter().enumerate() {
                @let y = height * (k as f64 + 0.5) + 3.0;
                text.tick x=(format!("{}", left - 8.0)) y=(format!("{:.1}", y + 4.0)) text-anchor="end" { (label(row)) }
                @if let Some(i) = row.metrics.get(name) {
                    line.line x1=(format!("{:.1}", at(i.low))) x2=(format!("{:.1}", at(i.high))) y1=(format!("{y:.1}")) y2=(format!("{y:.1}")) {}
                    g.right { circle cx=(format!("{:.1}", at(i.mean))) cy=(format!("{y:.1}")) r="5" {} }
                    text.tick x=(format!("{:.1}", at(i.high) + 8.0)) y=(format!("{:.1}", y + 4.0)) { (format!("{:.decimals$}", i.mean)) }
                }
            }
        }
    }
}
