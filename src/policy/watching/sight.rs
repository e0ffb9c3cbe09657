//! Detection of pixels of both eyes that move with a hand.

use super::limbs::HANDS;
use crate::env::Env;
use crate::policy::PolicyError;

/// Number of eyes.
const EYES: usize = 2;
/// Change of a pixel's brightness that counts as movement, of 255, in the mean over the pictures of a movement.
const LEAST: f32 = 8.0;
/// Factor by which a pixel must change more with this hand than with the other. A shaking head moves the whole picture with either hand.
const CLEAR: f32 = 2.0;
/// Rotation of the head or of an eye, rad, that halves the result, because it moves everything in the pictures.
const TURN: f64 = 0.01;
/// Share of a picture that must move for a hand to be visible.
const AREA: f32 = 0.01;
/// Widths of the middle of a picture, in half heights of the picture: the fovea, and the area near it with its weight.
const FOVEA: f32 = 0.25;
const NEAR: [f32; 2] = [0.7, 0.1];
/// Time between two pictures that are compared, s.
const APART: f64 = 0.03;

/// The observations of a trial.
#[derive(Clone, Debug)]
pub(super) struct ImageChanges {
    /// For each hand, eye and pixel, the sum of the changes while that hand moved.
    changes: Vec<f32>,
    /// The pictures with which the next ones are compared, in shades of grey.
    last: Vec<f32>,
    /// The weight of each pixel by its distance from the middle of its picture, 0 to 1, by eye.
    weights: [Vec<f32>; EYES],
    /// Number of pictures compared for each hand.
    counts: [u32; HANDS],
    /// For each hand the least and the greatest angle of the joints that turn the eyes, rad.
    gaze: [Vec<[f64; 2]>; HANDS],
    /// Steps between pictures that are compared, and those since the last.
    every: u32,
    since: u32,
}

impl ImageChanges {
    /// Reserves the pictures of an environment.
    pub(super) fn new(env: &Env) -> Result<Self, PolicyError> {
        let seen = env.observation();
        if seen.eye_left.is_none() || seen.eye_right.is_none() {
            return Err(PolicyError::Other(
                "watching learns by sight in every step: set vision_active: true, and vision_lazy: false".into(),
            ));
        }
        let bell = |squares: f32, width: f32| pxfm::f_expf(-squares / (2.0 * width * width));
        let weights = env.config().eye_sizes().map(|[width, height]| {
            let square =
                |k: usize, side: usize| ((k as f32 - 0.5 * (side as f32 - 1.0)) / (0.5 * height as f32)).powi(2);
            let weight = |k: usize| {
                let squares = square(k / width, height) + square(k % width, width);
                let [near, part] = NEAR;
                (1.0 - part) * bell(squares, FOVEA) + part * bell(squares, near)
            };
            (0..width * height).map(weight).collect::<Vec<_>>()
        });
        let pixels = weights.iter().map(Vec::len).sum();
        Ok(Self {
            changes: vec![0.0; HANDS * pixels],
            last: Vec::with_capacity(pixels),
            weights,
            counts: [0; HANDS],
            gaze: [Vec::new(), Vec::new()],
            every: ((APART / env.blueprint().dt()).round() as u32).max(1),
            since: 0,
        })
    }

    /// Clears the observations.
    pub(super) fn forget(&mut self) {
        self.changes.fill(0.0);
        self.counts = [0; HANDS];
        self.gaze.iter_mut().for_each(Vec::clear);
        self.last.clear();
        self.since = 0;
    }

    /// Keeps the current pictures for a comparison.
    pub(super) fn look(&mut self, env: &Env) {
        self.since = 0;
        self.last.clear();
        self.last.extend(shades(env));
    }

    /// Records the changes while a hand moves, and the rotation of the eyes.
    pub(super) fn see(&mut self, env: &Env, hand: usize, gaze: impl Iterator<Item = f64>) {
        let turned = &mut self.gaze[hand];
        for (k, angle) in gaze.enumerate() {
            match turned.get_mut(k) {
                Some([low, high]) => (*low, *high) = (low.min(angle), high.max(angle)),
                None => turned.push([angle, angle]),
            }
        }
        self.since += 1;
        if self.since < self.every {
            return;
        }
        self.since = 0;
        let pictures = self.last.len();
        let changes = self.changes.iter_mut().skip(hand * pictures);
        for ((change, last), now) in changes.zip(&mut self.last).zip(shades(env)) {
            *change += (now - *last).abs();
            *last = now;
        }
        self.counts[hand] += 1;
    }

    /// Returns, for each hand, the share of the pixels moving only with that hand that lies in the middle of the eyes, 0 to 1.
    pub(super) fn found(&self) -> [f64; HANDS] {
        let pictures: usize = self.weights.iter().map(Vec::len).sum();
        let mean = |hand: usize, k: usize| self.changes[hand * pictures + k] / self.counts[hand].max(1) as f32;
        std::array::from_fn(|hand| {
            let eye = |eye: usize| {
                let (mut inside, mut all) = (0.0_f32, 0.0_f32);
                let first: usize = self.weights[..eye].iter().map(Vec::len).sum();
                for (k, weight) in self.weights[eye].iter().enumerate() {
                    let at = first + k;
                    if mean(hand, at) > LEAST + CLEAR * mean(1 - hand, at) {
                        inside += weight;
                        all += 1.0;
                    }
                }
                // a hand covers an area; a smaller region may be something else
                f64::from(inside / all.max(AREA * self.weights[eye].len() as f32))
            };
            let turned = self.gaze[hand].iter().map(|[low, high]| high - low).fold(0.0, f64::max);
            let eyes: [f64; EYES] = std::array::from_fn(eye);
            let worse = eyes.into_iter().fold(f64::INFINITY, f64::min);
            let mean = eyes.into_iter().sum::<f64>() / EYES as f64;
            // one eye alone is worth half
            0.5 * (mean + worse) / (1.0 + (turned / TURN).powi(2))
        })
    }
}

/// Iterates over the pictures of both eyes in shades of grey, 0 to 255.
fn shades(env: &Env) -> impl Iterator<Item = f32> {
    let seen = env.observation();
    let eyes = [seen.eye_left, seen.eye_right].map(Option::unwrap_or_default);
    let grey = |c: &[u8]| c.iter().map(|&v| f32::from(v)).sum::<f32>() / 3.0;
    eyes.into_iter().flat_map(|eye| eye.chunks_exact(3)).map(grey)
}
