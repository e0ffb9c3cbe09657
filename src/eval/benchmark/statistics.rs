//! Means over seeds and their intervals.

use serde::{Deserialize, Serialize};

use crate::spaces::NumpyRng;

/// Number of samples that are drawn with replacement.
const SAMPLES: usize = 10_000;

/// A mean over runs, with the interval that holds 95 % of the means of samples drawn from them with replacement (B. Efron, "Bootstrap
/// methods: another look at the jackknife", 1979; percentiles).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConfidenceInterval {
    /// The mean.
    pub mean: f64,
    /// The lower end: 2.5 % of the samples have a smaller mean.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// Number of runs.
    pub runs: usize,
}

impl ConfidenceInterval {
    /// Computes mean and interval, the same for the same values in the same order; `None` without values.
    ///
    /// ```
    /// use babybench::eval::ConfidenceInterval;
    ///
    /// let interval = ConfidenceInterval::of(&[1.0, 2.0, 3.0, 4.0, 5.0]).expect("values");
    /// assert_eq!(interval.mean, 3.0);
    /// assert!((1.6..2.0).contains(&interval.low) && (4.0..4.4).contains(&interval.high));
    /// ```
    pub fn of(values: &[f64]) -> Option<Self> {
        let n = values.len();
        if n == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / n as f64;
        let mut rng = NumpyRng::seed(0);
        let mut sample = || (0..n).map(|_| values[rng.below(n)]).sum::<f64>() / n as f64;
        let mut means: Vec<f64> = (0..SAMPLES).map(|_| sample()).collect();
        means.sort_by(f64::total_cmp);
        let at = |share: f64| means[((SAMPLES - 1) as f64 * share).round() as usize];
        Some(Self {
            mean,
            low: at(0.025),
            high: at(0.975),
            runs: n,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_value_is_its_own_interval() {
        let only = ConfidenceInterval::of(&[0.25]).expect("a value");
        assert_eq!((only.mean, only.low, only.high, only.runs), (0.25, 0.25, 0.25, 1));
        assert_eq!(ConfidenceInterval::of(&[]), None);
    }
}
