//! Noise added to senses.

use super::{Signal, Transform};
use crate::spaces::NumpyRng;

/// Gaussian noise, independent for each value. It is added
/// - to every number of a vector, in its unit, in the vector's order,
/// - to the values of the touch sensors that feel something, in the order in which contacts reached them,
/// - to the bytes of colour and gray images, row by row, rounded and clipped to 0 and 255; not to distances and ids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    deviation: f64,
    /// Least value of a touch sensor, N.
    least: f32,
}

impl Noise {
    /// Creates noise of a standard deviation.
    pub fn new(deviation: f64) -> Self {
        Self {
            deviation,
            least: f32::NEG_INFINITY,
        }
    }

    /// Keeps touch from falling below zero, because normal forces are never negative.
    pub fn of_magnitudes(self) -> Self {
        Self { least: 0.0, ..self }
    }

    /// Returns the standard deviation.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }
}

impl Transform for Noise {
    fn describe(&self) -> String {
        format!("noise of standard deviation {}", self.deviation)
    }

    fn apply(&mut self, signal: Signal<'_>, rng: &mut NumpyRng) {
        let Self { deviation, least } = *self;
        match signal {
            Signal::Numbers(values) => values.iter_mut().for_each(|v| *v += deviation * rng.normal()),
            Signal::Skin(values) => values.for_each_touched(|sensor| {
                for v in sensor {
                    *v = ((f64::from(*v) + deviation * rng.normal()) as f32).max(least);
                }
            }),
            Signal::Eye { images, .. } => {
                for v in images.rgb.iter_mut().chain(&mut images.gray) {
                    // conversion rounds towards zero and clips
                    *v = (f64::from(*v) + deviation * rng.normal() + 0.5) as u8;
                }
            }
        }
    }
}
