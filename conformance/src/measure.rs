//! Measures of distance.

use serde::{Deserialize, Deserializer, Serialize};

/// Reads a number from JSON. JSON has no numbers that are not finite: they are written as `null` and read as NaN.
pub fn or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// Median, 90th percentile and maximum of a set of errors.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Summary {
    /// Number of errors.
    pub n: usize,
    /// Median.
    #[serde(deserialize_with = "or_nan")]
    pub p50: f64,
    /// 90th percentile.
    #[serde(deserialize_with = "or_nan")]
    pub p90: f64,
    /// Maximum.
    #[serde(deserialize_with = "or_nan")]
    pub max: f64,
}

impl Summary {
    /// Summarises `values`; NaN counts as infinite.
    pub fn new(values: impl IntoIterator<Item = f64>) -> Self {
        let mut v: Vec<f64> = values
            .into_iter()
            .map(|x| if x.is_nan() { f64::INFINITY } else { x })
            .collect();
        v.sort_by(f64::total_cmp);
        let at = |q: f64| {
            v.get(((v.len() as f64 * q).ceil() as usize).saturating_sub(1))
                .copied()
                .unwrap_or(0.0)
        };
        Self {
            n: v.len(),
            p50: at(0.5),
            p90: at(0.9),
            max: v.last().copied().unwrap_or(0.0),
        }
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "p50 {:8.1e}  p90 {:8.1e}  max {:8.1e}", self.p50, self.p90, self.max)
    }
}

/// Returns the largest absolute difference.
pub fn max_abs(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut max = 0.0_f64;
    for (x, y) in a.iter().zip(b) {
        let d = (x - y).abs();
        max = if d.is_nan() { f64::INFINITY } else { max.max(d) };
    }
    max
}

/// Returns the largest absolute difference, relative to the largest absolute value of `b`; 0 when all agree.
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let d = max_abs(a, b);
    if d == 0.0 { 0.0 } else { d / scale }
}

/// Returns the largest absolute difference after a step, relative to the largest change of `b` since `before`.
pub fn relative_to_change(a: &[f64], b: &[f64], before: &[f64]) -> f64 {
    max_abs(a, b) / max_abs(b, before)
}

/// Returns the root mean square difference.
pub fn rms(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    (a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>() / a.len().max(1) as f64).sqrt()
}

/// Returns whether `BB_TOL_SCALE=0` asks tests to print residuals instead of judging them.
pub fn only_print() -> bool {
    std::env::var("BB_TOL_SCALE").is_ok_and(|v| v == "0")
}

/// Returns row `k` of a table of `n` columns.
pub fn row(table: &[f64], k: usize, n: usize) -> &[f64] {
    &table[k * n..(k + 1) * n]
}

/// Returns the values at `indices`.
pub fn pick(values: &[f64], indices: &[usize]) -> Vec<f64> {
    indices.iter().map(|&k| values[k]).collect()
}

/// Returns the largest of the differences, each relative to its own value of `b`.
pub fn relative_each(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |max, (x, y)| max.max(relative(&[*x], &[*y])))
}

/// Formats named figures as a line.
pub fn line(figures: &[(&str, f64)]) -> String {
    figures
        .iter()
        .map(|(name, value)| format!("{name} {value:.1e}"))
        .collect::<Vec<String>>()
        .join("  ")
}

/// Counts the values that agree bit for bit, 0 and -0 counting as equal.
pub fn identical(a: &[f64], b: &[f64]) -> usize {
    a.iter().zip(b).filter(|(x, y)| x == y).count()
}
