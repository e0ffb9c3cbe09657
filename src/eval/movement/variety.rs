//! Variety of movements: entropy, dimensions, space.

use super::paths::BodyPaths;
use super::{LIMBS, MovementOptions, Values, mean, velocities};
use crate::math::norm;

/// Bins of equal probability of a normal distribution: their upper ends, in deviations.
const BINS: [f64; 15] = [
    -1.534_120_544_352_546_5,
    -1.150_349_380_376_008,
    -0.887_146_559_018_876,
    -0.674_489_750_196_081_7,
    -0.488_776_411_114_669_5,
    -0.318_639_363_964_375_14,
    -0.157_310_684_610_170_7,
    0.0,
    0.157_310_684_610_170_7,
    0.318_639_363_964_375_14,
    0.488_776_411_114_669_5,
    0.674_489_750_196_081_7,
    0.887_146_559_018_876,
    1.150_349_380_376_008,
    1.534_120_544_352_546_5,
];
/// Time between samples of joint velocities, s.
const SAMPLE: f64 = 0.04;
/// Below this deviation, rad/s, a joint does not move.
const STILL: f64 = 1e-3;
/// Length of the patterns of sample entropy, and their tolerance in deviations.
const PATTERN: usize = 2;
const TOLERANCE: f64 = 0.2;
/// Maximum number of samples for sample entropy, from the start: its time grows with their square.
const SAMPLES: usize = 4096;

pub(super) fn measure(body: &BodyPaths, options: &MovementOptions, values: &mut Values) {
    let every = (SAMPLE / body.dt).round().max(1.0) as usize;
    let sampled: Vec<Vec<f64>> = body
        .velocity
        .iter()
        .map(|v| v.iter().step_by(every).copied().collect())
        .collect();
    values.put("entropy", mean(sampled.iter().filter_map(|v| entropy(v))));
    values.put("dimensions", dimensions(&sampled));
    let mut speeds = Vec::new();
    for (name, path) in LIMBS.iter().zip(&body.hip) {
        let every = (1.0 / (options.fps * body.dt)).round().max(1.0) as usize;
        let places: Vec<_> = path.iter().step_by(every).copied().collect();
        let speed: Vec<f64> = velocities(&places, every as f64 * body.dt)
            .into_iter()
            .map(norm)
            .collect();
        let found = sample_entropy(&speed[..speed.len().min(SAMPLES)]);
        values.put(format!("{name}_sample_entropy"), found);
        speeds.extend(found);
    }
    values.put("sample_entropy", mean(speeds));
    for (limb, side) in [(0, 1.0), (1, -1.0)] {
        // the right hand crosses to where left is positive
        let crossed = body.hip[limb]
            .iter()
            .filter(|place| side * body.left * place[1] > 0.0)
            .count();
        let share = (body.len() > 0).then(|| crossed as f64 / body.len() as f64);
        values.put(format!("{}_across", LIMBS[limb]), share);
    }
}

/// Returns the entropy of a series in bins that are equally probable for a normal distribution of its mean and deviation, bits: 4 for
/// such a series, less for others; `None` if it does not move.
fn entropy(series: &[f64]) -> Option<f64> {
    let (middle, deviation) = moments(series)?;
    let mut counts = [0_usize; BINS.len() + 1];
    for v in series {
        counts[BINS.partition_point(|end| (v - middle) / deviation > *end)] += 1;
    }
    let share = |count: usize| count as f64 / series.len() as f64;
    let bits = |p: f64| if p > 0.0 { -p * pxfm::f_log2(p) } else { 0.0 };
    Some(counts.into_iter().map(|count| bits(share(count))).sum())
}

fn moments(series: &[f64]) -> Option<(f64, f64)> {
    let middle = mean(series.iter().copied())?;
    let deviation = mean(series.iter().map(|v| (v - middle) * (v - middle)))?.sqrt();
    (deviation > STILL).then_some((middle, deviation))
}

/// Returns the participation ratio of the covariance of series: (sum of its eigenvalues)^2 over the sum of their squares, 1 to the number
/// of series; `None` if nothing moves.
fn dimensions(series: &[Vec<f64>]) -> Option<f64> {
    let centred: Vec<Vec<f64>> = series
        .iter()
        .filter_map(|v| {
            let middle = mean(v.iter().copied())?;
            Some(v.iter().map(|x| x - middle).collect())
        })
        .collect();
    // the sums of eigenvalues and of their squares are the trace and the squares of all elements
    let (mut trace, mut squares) = (0.0, 0.0);
    for (i, a) in centred.iter().enumerate() {
        for (j, b) in centred.iter().enumerate().skip(i) {
            let c = a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>() / a.len() as f64;
            if i == j {
                trace += c;
            }
            squares += if i == j { c * c } else { 2.0 * c * c };
        }
    }
    (trace > STILL * STILL).then(|| trace * trace / squares)
}

/// Returns the sample entropy: minus the logarithm of the share of pairs of patterns of two samples, within 0.2 deviations of each other,
/// that also agree in a third sample (J. S. Richman and J. R. Moorman, 2000); `None` without such pairs.
fn sample_entropy(series: &[f64]) -> Option<f64> {
    let middle = mean(series.iter().copied())?;
    let deviation = mean(series.iter().map(|v| (v - middle) * (v - middle)))?.sqrt();
    let near = TOLERANCE * deviation;
    if deviation <= 0.0 || series.len() < PATTERN + 2 {
        return None;
    }
    let (mut pairs, mut longer) = (0_u64, 0_u64);
    let patterns = series.len() - PATTERN;
    for i in 0..patterns {
        for j in i + 1..patterns {
            if (0..PATTERN).all(|k| (series[i + k] - series[j + k]).abs() <= near) {
                pairs += 1;
                longer += u64::from((series[i + PATTERN] - series[j + PATTERN]).abs() <= near);
            }
        }
    }
    (pairs > 0 && longer > 0).then(|| -pxfm::f_log(longer as f64 / pairs as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spaces::NumpyRng;

    fn normal(seed: u64, n: usize) -> Vec<f64> {
        let mut rng = NumpyRng::seed(seed);
        (0..n).map(|_| rng.normal()).collect()
    }

    #[test]
    fn normal_noise_has_four_bits_and_two_values_one() {
        let found = entropy(&normal(1, 20_000)).expect("it moves");
        assert!((found - 4.0).abs() < 0.01, "{found}");
        let two: Vec<f64> = (0..1000).map(|t| f64::from(t % 2)).collect();
        assert_eq!(entropy(&two), Some(1.0));
        assert_eq!(entropy(&[1.0; 100]), None);
    }

    #[test]
    fn independent_joints_have_as_many_dimensions_and_copies_one() {
        let joints: Vec<Vec<f64>> = (0..5).map(|k| normal(k, 20_000)).collect();
        assert!((dimensions(&joints).expect("they move") - 5.0).abs() < 0.02);
        assert!((dimensions(&vec![joints[0].clone(); 5]).expect("they move") - 1.0).abs() < 1e-9);
        assert_eq!(dimensions(&[vec![0.0; 10]]), None);
    }

    #[test]
    fn noise_surprises_more_than_a_wave() {
        // of independent normal samples: minus the logarithm of the probability that two are within 0.2 deviations
        let noise = sample_entropy(&normal(4, 3000)).expect("it has pairs");
        assert!((noise - 2.185).abs() < 0.1, "{noise}");
        let wave: Vec<f64> = (0..3000).map(|t| pxfm::f_sin(0.05 * f64::from(t))).collect();
        assert!(sample_entropy(&wave).expect("it has pairs") < 0.3);
    }
}
