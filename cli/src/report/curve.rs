//! Learning curves over episodes.

use std::fmt::Write as _;

use maud::{Markup, html};

use super::run::Baseline;
use super::svg::download;
use babybench::env::Info;
use babybench::eval::Score;

/// Size of the drawing and its margins: left, top, right, bottom.
const SIZE: [f64; 2] = [640.0, 260.0];
const MARGIN: [f64; 4] = [44.0, 26.0, 12.0, 34.0];
/// Maximum number of points of a line, and of dots.
const MAX_POINTS: usize = 500;

/// A line of the chart.
struct CurveLine {
    class: &'static str,
    label: String,
    values: Vec<f64>,
}

/// The quantity drawn over the episodes.
struct CurveChart {
    unit: &'static str,
    lines: Vec<CurveLine>,
    /// One value per episode.
    dots: Vec<f64>,
    /// A target height, with its name.
    goal: Option<(f64, String)>,
    /// Ends of the axis of values.
    bottom: f64,
    top: f64,
    /// The meaning of a dot.
    dot: &'static str,
}

impl CurveChart {
    /// Reserves values.
    fn include(&mut self, values: &[f64]) {
        for v in values {
            self.top = self.top.max(1.1 * v);
            self.bottom = self.bottom.min(1.1 * v);
        }
    }
}

/// The meaning of a dot for behaviors of both hands.
const BOTH_HANDS: &str = "each episode alone, mean of both hands";

/// Draws the learning curve of the records that count, if there are any and they have a score.
///
/// `reachable` is the number of parts that a hand can touch; `baseline` is another training to compare with.
pub(super) fn curve(records: &[Info], baseline: Option<&Baseline>, reachable: usize) -> Option<Markup> {
    let touch = records.first()?.behavior.touches().is_some();
    let regard = records.first()?.behavior.regards().is_some();
    let task = records.first()?.behavior.task().is_some();
    let mut chart = match (touch, regard, task) {
        (true, ..) => touches(records, reachable),
        (_, true, _) => regards(records),
        (.., true) => returns(records),
        _ => return None,
    };
    if let Some(Baseline { name, records: other }) = baseline {
        let other = &other[..other.len().min(records.len())];
        let alone = match (touch, task) {
            (true, _) => touched_alone,
            (_, true) => return_alone,
            _ => seen_alone,
        };
        let values = smooth(&other.iter().map(alone).collect::<Vec<f64>>());
        chart.include(&values);
        chart
            .lines
            .push(line("base", format!("{name}: moving mean of single episodes"), values));
    }
    Some(draw(&chart, records.len()))
}

/// Returns the number of parts touched in an episode, averaged over both hands.
fn touched_alone(record: &Info) -> f64 {
    let touches = record.behavior.touches();
    touches.map_or(0.0, |t| 0.5 * (t[0].len() + t[1].len()) as f64)
}

/// Returns the share of an episode's steps with a hand in view, averaged over both hands, %.
fn seen_alone(record: &Info) -> f64 {
    100.0 * Score::of_episode(record, record.steps).unwrap_or(0.0)
}

/// Charts the number of different parts touched so far by each hand, and by both hands in each single episode.
fn touches(records: &[Info], reachable: usize) -> CurveChart {
    let so_far = |hand: usize| {
        let mut seen: Vec<usize> = Vec::new();
        let each = records.iter().map(|r| {
            let parts = r.behavior.touches().map_or(&[][..], |t| t[hand]);
            let new = |g: &&usize| !seen.contains(*g);
            let new: Vec<usize> = parts.iter().filter(new).copied().collect();
            seen.extend(new);
            seen.len() as f64
        });
        each.collect::<Vec<f64>>()
    };
    let dots: Vec<f64> = records.iter().map(touched_alone).collect();
    CurveChart {
        unit: "parts",
        lines: vec![
            line("right", "right hand, so far", so_far(0)),
            line("left", "left hand, so far", so_far(1)),
            line("both", "moving mean of single episodes", smooth(&dots)),
        ],
        dots,
        goal: Some((reachable as f64, format!("{reachable} can be reached"))),
        bottom: 0.0,
        top: reachable as f64 * 1.05,
        dot: BOTH_HANDS,
    }
}

/// Charts the share of the steps with a hand in view, for each hand as a moving mean, and for both in each episode.
fn regards(records: &[Info]) -> CurveChart {
    let share = |r: &Info, pairs: [usize; 2]| {
        let counts = r.behavior.regards().unwrap_or_default();
        let seen: f64 = pairs.iter().map(|&k| counts[k] as f64).sum();
        100.0 * seen / (2.0 * r.steps.max(1) as f64)
    };
    let of = |pairs: [usize; 2]| smooth(&records.iter().map(|r| share(r, pairs)).collect::<Vec<f64>>());
    let dots: Vec<f64> = records.iter().map(seen_alone).collect();
    let lines = vec![
        line("right", "right hand", of([0, 2])),
        line("left", "left hand", of([1, 3])),
        line("both", "mean", smooth(&dots)),
    ];
    let most = lines
        .iter()
        .flat_map(|l| &l.values)
        .chain(&dots)
        .fold(0.0, |m: f64, v| m.max(*v));
    CurveChart {
        unit: "% of steps",
        lines,
        dots,
        goal: None,
        bottom: 0.0,
        top: (most * 1.1).max(1.0),
        dot: BOTH_HANDS,
    }
}

/// Returns the return of an episode.
fn return_alone(record: &Info) -> f64 {
    record.behavior.task().map_or(0.0, |info| info.episode_return)
}

/// Charts the return of each episode and the share of successes. The upper end of the axis is 100 % of successes.
fn returns(records: &[Info]) -> CurveChart {
    let dots: Vec<f64> = records.iter().map(return_alone).collect();
    let success = |r: &Info| r.behavior.task().is_some_and(|info| info.outcome.is_success);
    let successes: Vec<f64> = records.iter().map(|r| f64::from(u8::from(success(r)))).collect();
    let share = 100.0 * successes.iter().sum::<f64>() / records.len().max(1) as f64;
    let mut chart = CurveChart {
        unit: "return",
        lines: vec![line("both", "moving mean of single episodes", smooth(&dots))],
        bottom: 0.0,
        top: 1e-3,
        goal: None,
        dot: "each episode alone",
        dots: Vec::new(),
    };
    chart.include(&dots);
    let top = chart.top;
    let label = format!("successes, moving mean; the upper end is 100 % ({share:.1} % in all)");
    let values = smooth(&successes).iter().map(|v| v * top).collect();
    chart.lines.push(line("right", label, values));
    CurveChart { dots, ..chart }
}

fn line(class: &'static str, label: impl Into<String>, values: Vec<f64>) -> CurveLine {
    let label = label.into();
    CurveLine { class, label, values }
}

/// Returns moving means over the last tenth of the values so far, at least over five.
fn smooth(values: &[f64]) -> Vec<f64> {
    let window = (values.len() / 10).max(5);
    let mut sum = 0.0;
    let mean = |(k, v): (usize, &f64)| {
        sum += v;
        if k >= window {
            sum -= values[k - window];
        }
        sum / (k + 1).min(window) as f64
    };
    values.iter().enumerate().map(mean).collect()
}

/// Returns the distance between the marks of an axis: 1, 2 or 5 times a power of ten, about `n` of them.
fn step(top: f64, n: f64) -> f64 {
    let rough = (top / n).max(f64::MIN_POSITIVE);
    let power = pxfm::f_pow(10.0, pxfm::f_log10(rough).floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|k| k * power)
        .into_iter()
        .find(|s| *s >= rough * 0.999)
        .unwrap_or(rough)
}

fn marks(top: f64, n: f64) -> impl Iterator<Item = f64> {
    let step = step(top, n);
    (0..)
        .map(move |k| f64::from(k) * step)
        .take_while(move |v| *v <= top * 1.0001)
        .take(50)
}

/// Returns the marks of an axis that may reach below 0.
fn marks_between(bottom: f64, top: f64) -> Vec<f64> {
    let step = step(top - bottom, 5.0);
    let mut all: Vec<f64> = (1..50)
        .map(|k| -f64::from(k) * step)
        .take_while(|v| *v >= bottom)
        .collect();
    all.extend((0..50).map(|k| f64::from(k) * step).take_while(|v| *v <= top * 1.0001));
    all
}

fn draw(chart: &CurveChart, episodes: usize) -> Markup {
    let [left, top, right, bottom] = MARGIN;
    let inner = [SIZE[0] - left - right, SIZE[1] - top - bottom];
    let last = episodes.max(2) as f64;
    let x = |episode: f64| left + (episode - 1.0) / (last - 1.0) * inner[0];
    let y = |value: f64| top + (1.0 - (value - chart.bottom) / (chart.top - chart.bottom)) * inner[1];
    let stride = episodes.div_ceil(MAX_POINTS).max(1);
    let chosen = || (0..episodes).filter(move |k| k % stride == 0 || k + 1 == episodes);
    let path = |line: &CurveLine| {
        let mut d = String::new();
        for (n, k) in chosen().filter(|&k| k < line.values.len()).enumerate() {
            let letter = if n == 0 { 'M' } else { 'L' };
            // writing to a string cannot fail
            let _ = write!(d, "{letter}{:.1} {:.1}", x(k as f64 + 1.0), y(line.values[k]));
        }
        d
    };
    let whole = |v: &f64| *v >= 1.0 && v.fract() == 0.0;
    let drawing = html! {
        svg viewBox=(format!("0 0 {} {}", SIZE[0], SIZE[1])) role="img" aria-label="learning curve over episodes" {
            @for v in marks_between(chart.bottom, chart.top) {
                line class="grid" x1=(left) x2=(SIZE[0] - right) y1=(format!("{:.1}", y(v))) y2=(format!("{:.1}", y(v))) {}
                text class="tick" x=(left - 6.0) y=(format!("{:.1}", y(v) + 4.0)) text-anchor="end" { (tidy(v)) }
            }
            @for v in marks(last, 6.0).filter(whole) {
                // centred under the right edge, a number of four figures would be cut off
                @let anchor = if x(v) > SIZE[0] - right - 10.0 { "end" } else { "middle" };
                text class="tick" x=(format!("{:.1}", x(v))) y=(SIZE[1] - bottom + 16.0) text-anchor=(anchor) { (v) }
            }
            text class="tick" x=(left + 0.5 * inner[0]) y=(SIZE[1] - 2.0) text-anchor="middle" { "episode" }
            text class="tick" x=(left) y="13" { (chart.unit) }
            @if let Some((height, text)) = &chart.goal {
                line class="goal" x1=(left) x2=(SIZE[0] - right) y1=(format!("{:.1}", y(*height)))
                    y2=(format!("{:.1}", y(*height))) {}
                text class="tick" x=(SIZE[0] - right - 4.0) y=(format!("{:.1}", y(*height) - 5.0)) text-anchor="end" { (text) }
            }
            @for k in chosen() {
                circle class="dot" cx=(format!("{:.1}", x(k as f64 + 1.0))) cy=(format!("{:.1}", y(chart.dots[k]))) r="2" {}
            }
            @for line in &chart.lines {
                path class=(format!("line {}", line.class)) d=(path(line)) {}
            }
        }
    };
    let mut legend: Vec<(&str, &str)> = chart.lines.iter().map(|line| (line.class, &*line.label)).collect();
    legend.push(("dots", chart.dot));
    html! {
        (drawing)
        p.legend {
            @for line in &chart.lines { span.key.(line.class) { (line.label) } }
            span.key.dots { (chart.dot) }
            (download(&drawing, SIZE, &legend, "learning-curve"))
        }
    }
}

/// Formats a number of an axis.
fn tidy(v: f64) -> String {
    format!("{:.3}", v)
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_round_marks() {
        for (top, expected) in [(31.0, 10.0), (1.0, 0.2), (4.7, 1.0), (100.0, 20.0), (0.03, 0.01)] {
            assert!((step(top, 5.0) - expected).abs() < 1e-12, "{top}: {}", step(top, 5.0));
        }
        assert_eq!(tidy(0.2), "0.2");
        assert_eq!(tidy(40.0), "40");
    }

    #[test]
    fn means_follow_the_last_values() {
        let values: Vec<f64> = (0..20).map(f64::from).collect();
        let smooth = smooth(&values);
        assert_eq!(smooth[0], 0.0);
        assert_eq!(smooth[4], 2.0);
        assert_eq!(smooth[19], 17.0);
    }
}
