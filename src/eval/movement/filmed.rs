//! The part of a path that a camera captures: frames at its rate, with errors.

use crate::math::Vec3;
use crate::spaces::NumpyRng;

/// Returns a path at the frames of a camera, interpolated linearly between steps, with an error of `jitter` m in each coordinate.
pub(super) fn film(path: &[Vec3], dt: f64, fps: f64, jitter: f64, rng: &mut NumpyRng) -> Vec<Vec3> {
    let Some(last) = path.len().checked_sub(1) else {
        return Vec::new();
    };
    let frames = (last as f64 * dt * fps).floor() as usize + 1;
    (0..frames)
        .map(|frame| {
            let at = (frame as f64 / (fps * dt)).min(last as f64);
            let before = at.floor() as usize;
            let after = (before + 1).min(last);
            let part = at - before as f64;
            std::array::from_fn(|k| {
                let place = path[before][k] + part * (path[after][k] - path[before][k]);
                if jitter > 0.0 {
                    place + jitter * rng.normal()
                } else {
                    place
                }
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_lie_between_steps() {
        let path: Vec<Vec3> = (0..11).map(|t| [f64::from(t), 0.0, -f64::from(t)]).collect();
        let mut rng = NumpyRng::seed(0);
        let frames = film(&path, 0.1, 4.0, 0.0, &mut rng);
        assert_eq!(frames.len(), 5);
        for (k, frame) in frames.iter().enumerate() {
            let x = 2.5 * k as f64;
            assert!((frame[0] - x).abs() < 1e-12 && (frame[2] + x).abs() < 1e-12);
        }
        assert_eq!(rng.drawn(), 0, "without errors nothing is drawn");
        assert!(film(&[], 0.1, 4.0, 0.0, &mut rng).is_empty());
    }

    #[test]
    fn errors_have_the_deviation_that_is_asked_for() {
        let path = vec![[0.0; 3]; 40_001];
        let frames = film(&path, 0.01, 100.0, 0.002, &mut NumpyRng::seed(3));
        let square: f64 = frames.as_flattened().iter().map(|x| x * x).sum();
        let deviation = (square / (3.0 * frames.len() as f64)).sqrt();
        assert!((deviation / 0.002 - 1.0).abs() < 0.01, "{deviation}");
    }
}
