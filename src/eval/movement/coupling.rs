//! Coupling of joints: correlation of their velocities at a lag, and steadiness of their relative phase.

use std::collections::BTreeMap;

use super::Values;
use super::paths::BodyPaths;

/// Longest lag, s.
const LONGEST: f64 = 0.5;
/// Below this root mean square of the velocity, rad/s, a joint does not move.
const STILL: f64 = 1e-3;

/// Pairs within a limb, without the side.
const WITHIN: [[&str; 2]; 4] = [
    ["hip1", "knee"],
    ["knee", "foot1"],
    ["hip1", "foot1"],
    ["shoulder_ad_ab", "elbow"],
];
/// Joints whose two sides are compared.
const BETWEEN: [&str; 4] = ["hip1", "knee", "shoulder_ad_ab", "elbow"];

/// The coupling of two series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coupling {
    /// Correlation at no lag, -1 to 1.
    pub correlation: f64,
    /// The correlation of the largest magnitude within the longest lag, and that lag, s: positive where the first leads.
    pub peak: f64,
    pub lag: f64,
    /// Length of the mean of the unit vectors of the relative phase: 1 where it never changes.
    pub phase_locking: f64,
}

pub(super) fn measure(body: &BodyPaths, values: &mut Values) {
    let mut put = |name: String, first: Option<usize>, second: Option<usize>| {
        if let Some(found) = first.zip(second).and_then(|(a, b)| coupling(body, a, b)) {
            values.put(format!("{name}_correlation"), found.correlation);
            values.put(format!("{name}_peak"), found.peak);
            values.put(format!("{name}_lag"), found.lag);
            values.put(format!("{name}_phase_locking"), found.phase_locking);
        }
    };
    for [first, second] in WITHIN {
        for side in ["right", "left"] {
            let joint = |name: &str| body.joint(&format!("{side}_{name}"));
            put(
                format!("{side}_{}_{}", plain(first), plain(second)),
                joint(first),
                joint(second),
            );
        }
    }
    for joint in BETWEEN {
        let side = |side: &str| body.joint(&format!("{side}_{joint}"));
        put(format!("right_left_{}", plain(joint)), side("right"), side("left"));
    }
}

/// Returns the name of a joint in a measure.
fn plain(joint: &str) -> &str {
    let names = BTreeMap::from([("hip1", "hip"), ("foot1", "ankle"), ("shoulder_ad_ab", "shoulder")]);
    names.get(joint).copied().unwrap_or(joint)
}

/// Measures two joints; `None` if one of them does not move.
fn coupling(body: &BodyPaths, first: usize, second: usize) -> Option<Coupling> {
    let (a, b) = (centred(&body.velocity[first])?, centred(&body.velocity[second])?);
    let steps = (LONGEST / body.dt).floor() as usize;
    let product = |lag: usize, a: &[f64], b: &[f64]| a.iter().zip(b.iter().skip(lag)).map(|(x, y)| x * y).sum::<f64>();
    let correlation = product(0, &a, &b);
    let (mut peak, mut at) = (correlation, 0.0);
    for lag in 1..=steps.min(a.len().saturating_sub(1)) {
        for (found, sign) in [(product(lag, &a, &b), 1.0), (product(lag, &b, &a), -1.0)] {
            if found.abs() > peak.abs() {
                (peak, at) = (found, sign * lag as f64 * body.dt);
            }
        }
    }
    Some(Coupling {
        correlation,
        peak,
        lag: at,
        phase_locking: phase_locking(body, first, second)?,
    })
}

/// Returns a series minus its mean, normalized to length 1; `None` if it does not move.
fn centred(series: &[f64]) -> Option<Vec<f64>> {
    let n = series.len() as f64;
    let middle = super::mean(series.iter().copied())?;
    let square: f64 = series.iter().map(|v| (v - middle) * (v - middle)).sum();
    (square > STILL * STILL * n).then(|| series.iter().map(|v| (v - middle) / square.sqrt()).collect())
}

/// Returns the length of the mean of the unit vectors of the relative phase, with phases in the plane of standardized angle and velocity.
fn phase_locking(body: &BodyPaths, first: usize, second: usize) -> Option<f64> {
    let part = |joint: usize| Some((centred(&body.angle[joint])?, centred(&body.velocity[joint])?));
    let ((x1, v1), (x2, v2)) = (part(first)?, part(second)?);
    let (mut along, mut across, mut n) = (0.0, 0.0, 0.0);
    for t in 0..x1.len() {
        // a unit vector (cos, sin) of each phase; velocity lags the angle by a quarter turn, so it is taken with a minus sign
        let unit = |x: f64, v: f64| {
            let length = (x * x + v * v).sqrt();
            (length > 0.0).then(|| [x / length, -v / length])
        };
        if let (Some([c1, s1]), Some([c2, s2])) = (unit(x1[t], v1[t]), unit(x2[t], v2[t])) {
            along += c1 * c2 + s1 * s2;
            across += s1 * c2 - c1 * s2;
            n += 1.0;
        }
    }
    (n > 0.0).then(|| (along * along + across * across).sqrt() / n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spaces::NumpyRng;

    fn body(series: [Vec<f64>; 2], angles: [Vec<f64>; 2]) -> BodyPaths {
        BodyPaths {
            dt: 0.01,
            joints: vec!["right_hip1".into(), "right_knee".into()],
            velocity: series.into(),
            angle: angles.into(),
            ..BodyPaths::default()
        }
    }

    #[test]
    fn a_lag_is_found_to_a_step() {
        let mut rng = NumpyRng::seed(2);
        let noise: Vec<f64> = (0..5000).map(|_| rng.normal()).collect();
        let late: Vec<f64> = (0..5000)
            .map(|t: usize| if t < 10 { 0.0 } else { -2.0 * noise[t - 10] })
            .collect();
        let mut values = Values::default();
        measure(&body([noise.clone(), late.clone()], [noise, late]), &mut values);
        assert!((values.0["right_hip_knee_lag"] - 0.1).abs() < 1e-12, "{values:?}");
        assert!(values.0["right_hip_knee_peak"] < -0.99);
        assert!(values.0["right_hip_knee_correlation"].abs() < 0.05);
    }

    #[test]
    fn phases_are_locked_or_free() {
        let wave = |rate: f64| -> [Vec<f64>; 2] {
            let at = |t: i32| rate * 0.01 * f64::from(t);
            [
                (0..6000).map(|t| pxfm::f_sin(at(t))).collect(),
                (0..6000).map(|t| rate * pxfm::f_cos(at(t))).collect(),
            ]
        };
        let of = |a: f64, b: f64| {
            let ([x, v], [y, w]) = (wave(a), wave(b));
            let mut values = Values::default();
            measure(&body([v, w], [x, y]), &mut values);
            values.0["right_hip_knee_phase_locking"]
        };
        assert!(of(5.0, 5.0) > 0.999);
        assert!(of(5.0, 7.3) < 0.1);
    }

    #[test]
    fn joints_at_rest_have_no_coupling() {
        let mut values = Values::default();
        measure(
            &body([vec![0.0; 100], vec![1.0; 100]], [vec![0.0; 100], vec![1.0; 100]]),
            &mut values,
        );
        assert!(values.0.is_empty());
    }
}
