//! Exponents of the spectra of the limbs' velocities.

use std::f64::consts::TAU;

use super::filmed::film;
use super::paths::BodyPaths;
use super::{LIMBS, MovementFrame, MovementOptions, Values, mean, velocities};
use crate::math::Vec3;
use crate::spaces::{NumpyRng, fourier};

/// Above this deviation from the line, in natural logarithms, a spectrum has no exponent; the spectrum of a wave, for example, is not a line.
const OFF: f64 = 2.0;
/// The smallest number of frequencies for fitting a line.
const FEWEST: usize = 4;
/// The shortest window of short records, frames.
const SHORTEST: usize = 16;

/// Measures exponents and speeds. Returns the window that was used, frames.
pub(super) fn measure(body: &BodyPaths, options: &MovementOptions, values: &mut Values) -> usize {
    let paths = match options.frame {
        MovementFrame::World => &body.world,
        MovementFrame::Hip => &body.hip,
    };
    let mut rng = NumpyRng::seed(options.seed);
    let (mut window, mut exponents) = (options.window, Vec::new());
    for (name, path) in LIMBS.iter().zip(paths) {
        let seen = film(path, body.dt, options.fps, options.jitter / 1000.0, &mut rng);
        let velocity = velocities(&seen, 1.0 / options.fps);
        window = options.window.min(largest(velocity.len()));
        let exponent = exponent(&velocity, options.fps, window, options.band);
        values.put(format!("{name}_exponent"), exponent);
        exponents.extend(exponent);
        let speed = mean(velocity.iter().map(|v| crate::math::norm(*v)));
        values.put(format!("{name}_speed"), speed);
    }
    values.put("exponent", mean(exponents));
    window
}

/// Returns the largest power of two that is not above a number.
fn largest(n: usize) -> usize {
    n.checked_ilog2().map_or(0, |bits| 1 << bits)
}

/// Returns minus the slope of the logarithm of the power over that of the frequency, in a band; `None` if the power is 0 or does not follow a line.
pub(super) fn exponent(velocity: &[Vec3], rate: f64, window: usize, band: [f64; 2]) -> Option<f64> {
    if window < SHORTEST || velocity.len() < window {
        return None;
    }
    let power = welch(velocity, window);
    let mut points = Vec::new();
    for (k, &power) in power.iter().enumerate().skip(1) {
        let frequency = k as f64 * rate / window as f64;
        if frequency >= band[0] && frequency <= band[1] {
            if power <= 0.0 {
                return None;
            }
            points.push([pxfm::f_log(frequency), pxfm::f_log(power)]);
        }
    }
    if points.len() < FEWEST {
        return None;
    }
    let n = points.len() as f64;
    let [x, y] = points.iter().fold([0.0; 2], |s, p| [s[0] + p[0] / n, s[1] + p[1] / n]);
    let (mut xx, mut xy) = (0.0, 0.0);
    for p in &points {
        xx += (p[0] - x) * (p[0] - x);
        xy += (p[0] - x) * (p[1] - y);
    }
    let slope = xy / xx;
    let off = points
        .iter()
        .map(|p| p[1] - y - slope * (p[0] - x))
        .map(|r| r * r)
        .sum::<f64>()
        / n;
    (off.sqrt() < OFF).then_some(-slope)
}

/// Returns the power by frequency, summed over the coordinates, in an arbitrary unit: the mean over windows that overlap by half, each with its mean
/// removed and weighted by a Hann window (P. D. Welch, 1967).
fn welch(velocity: &[Vec3], window: usize) -> Vec<f64> {
    let hann: Vec<f64> = (0..window)
        .map(|t| 0.5 - 0.5 * pxfm::f_cos(TAU * t as f64 / window as f64))
        .collect();
    let mut power = vec![0.0; window / 2 + 1];
    for first in (0..=velocity.len() - window).step_by(window / 2) {
        let part = &velocity[first..first + window];
        for k in 0..3 {
            let middle = part.iter().map(|v| v[k]).sum::<f64>() / window as f64;
            let series: Vec<f64> = part.iter().zip(&hann).map(|(v, w)| (v[k] - middle) * w).collect();
            for (power, [re, im]) in power.iter_mut().zip(fourier(&series)) {
                *power += re * re + im * im;
            }
        }
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spaces::ColoredNoise;

    fn noise(exponent: f64, len: usize) -> Vec<Vec3> {
        let mut noise = ColoredNoise::new(exponent, 3, 5);
        (0..len)
            .map(|_| {
                let v = noise.next_values();
                [f64::from(v[0]), f64::from(v[1]), f64::from(v[2])]
            })
            .collect()
    }

    #[test]
    fn noise_of_a_known_exponent_is_measured_in_three_bands() {
        for beta in [0.0, 0.5, 0.69, 0.88, 1.0, 1.5, 2.0] {
            let velocity = noise(beta, 1 << 16);
            // up to a quarter of the rate, where the noise is exact
            for band in [[0.1, 5.0], [0.2, 6.0], [1.0, 6.0]] {
                let found = exponent(&velocity, 25.0, 1024, band).expect("noise has an exponent");
                println!("exponent {beta}: measured {found:.3} in {band:?} Hz");
                assert!((found - beta).abs() < 0.05, "{beta}: {found} in {band:?}");
            }
        }
    }

    #[test]
    fn waves_and_rest_have_no_exponent() {
        let wave: Vec<Vec3> = (0..4096)
            .map(|t| [pxfm::f_sin(0.37 * f64::from(t)), 0.0, 0.0])
            .collect();
        assert_eq!(exponent(&wave, 25.0, 1024, [0.1, 5.0]), None);
        assert_eq!(exponent(&[[0.0; 3]; 4096], 25.0, 1024, [0.1, 5.0]), None);
        assert_eq!(exponent(&noise(1.0, 100), 25.0, 1024, [0.1, 5.0]), None, "too short");
    }

    #[test]
    fn errors_of_a_camera_lower_the_exponent() {
        let step = 0.04;
        let mut place = [0.0; 3];
        let path: Vec<Vec3> = noise(0.88, 1 << 15)
            .into_iter()
            .map(|v| {
                place = std::array::from_fn(|k| place[k] + 0.05 * v[k] * step);
                place
            })
            .collect();
        let seen = |jitter: f64| {
            let frames = film(&path, step, 25.0, jitter, &mut NumpyRng::seed(1));
            exponent(&velocities(&frames, step), 25.0, 1024, [0.1, 5.0]).expect("it moves")
        };
        let [clean, blurred] = [seen(0.0), seen(0.002)];
        println!("without errors {clean:.3}, with 2 mm {blurred:.3}");
        assert!(
            (clean - 0.88).abs() < 0.05 && blurred < clean - 0.1,
            "{clean} {blurred}"
        );
    }
}
