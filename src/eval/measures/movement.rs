//! Smoothness and symmetry of movements.

/// Below this speed, rad/s, a joint does not move.
const STILL: f64 = 1e-3;

/// Returns minus the logarithm of dimensionless jerk, mean over the joints that move: of velocities v over a time D, in steps of `dt`,
/// -ln(D^3 / v_peak^2 * sum of (second difference of v / dt^2)^2 * dt).
///
/// S. Balasubramanian et al., "A robust and sensitive metric for quantifying movement smoothness", 2012.
pub(super) fn smoothness(velocities: &[Vec<f64>], dt: f64) -> Option<f64> {
    let of = |v: &Vec<f64>| {
        let peak = v.iter().fold(0.0_f64, |peak, v| peak.max(v.abs()));
        if v.len() < 3 || peak < STILL {
            return None;
        }
        let jerk: f64 = v
            .windows(3)
            .map(|w| (w[2] - 2.0 * w[1] + w[0]) / (dt * dt))
            .map(|j| j * j * dt)
            .sum();
        let time = v.len() as f64 * dt;
        (jerk > 0.0).then(|| -pxfm::f_log(time * time * time / (peak * peak) * jerk))
    };
    mean(velocities.iter().filter_map(of))
}

/// Returns the correlation of the velocities of right and left joints, as the mean over the pairs in which both move.
pub(super) fn symmetry<'v>(pairs: impl Iterator<Item = (&'v [f64], &'v [f64])>) -> Option<f64> {
    mean(pairs.filter_map(|(right, left)| {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (rr, ll) = (product(right, right), product(left, left));
        let least = STILL * STILL * right.len() as f64;
        (rr > least && ll > least).then(|| product(right, left) / (rr * ll).sqrt())
    }))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (n, sum) = values.fold((0_usize, 0.0), |(n, sum), v| (n + 1, sum + v));
    (n > 0).then(|| sum / n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirror_images_are_symmetric_and_opposites_are_not() {
        let wave: Vec<f64> = (0..1000).map(|t| pxfm::f_sin(0.05 * f64::from(t))).collect();
        let turned: Vec<f64> = wave.iter().map(|v| -3.0 * v).collect();
        let still = vec![0.0; 1000];
        let of = |a: &[f64], b: &[f64]| symmetry([(a, b)].into_iter());
        assert!(of(&wave, &wave).is_some_and(|s| (s - 1.0).abs() < 1e-12));
        assert!(of(&wave, &turned).is_some_and(|s| (s + 1.0).abs() < 1e-12));
        assert_eq!(of(&wave, &still), None);
    }

    #[test]
    fn slow_waves_are_smoother_than_fast_ones_and_speed_does_not_matter() {
        let wave =
            |rate: f64, size: f64| -> Vec<f64> { (0..1000).map(|t| size * pxfm::f_sin(rate * f64::from(t))).collect() };
        let of = |v: Vec<f64>| smoothness(&[v], 0.005).expect("it moves");
        assert!(of(wave(0.02, 1.0)) > of(wave(0.1, 1.0)) + 5.0);
        assert!((of(wave(0.02, 1.0)) - of(wave(0.02, 7.0))).abs() < 0.01);
        assert_eq!(smoothness(&[vec![0.0; 100]], 0.005), None);
    }
}
