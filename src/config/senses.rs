//! Settings of maturing senses: delays and eyes.

use super::choices::DelayUnit;
use super::latencies::{Latency, latency};
use super::table::{Config, Delays, EyeOptions};

/// Length of a physics step of BabyBench's scenes, ms, in which delays are counted.
const PHYSICS_STEP_MS: f64 = 5.0;

impl Delays {
    /// Returns a delay in steps of the environment, rounded to the nearest, half a step up.
    pub fn steps(&self, delay: f64, frame_skip: u32) -> usize {
        match self.unit {
            DelayUnit::Steps => rounded(delay),
            DelayUnit::Ms => rounded(delay / Self::step_ms(frame_skip)),
        }
    }

    /// Returns the length of a step of the environment, ms.
    pub fn step_ms(frame_skip: u32) -> f64 {
        PHYSICS_STEP_MS * f64::from(frame_skip)
    }
}

fn rounded(steps: f64) -> usize {
    // the cast saturates, so no delay overflows
    (steps + 0.5) as usize
}

impl Config {
    /// Returns the sizes of the images of the left and the right eye: width and height, pixels.
    pub fn eye_sizes(&self) -> [[usize; 2]; 2] {
        let EyeOptions { width, height, .. } = self.eyes;
        let left = [self.eyes.width_left, self.eyes.height_left];
        let right = [self.eyes.width_right, self.eyes.height_right];
        let own = [left, right];
        // width and height fall back one by one: the eye's own, that of both eyes, the square
        own.map(|[w, h]| [w.or(width), h.or(height)].map(|side| side.unwrap_or(self.vision_resolution) as usize))
    }

    /// Returns the delay of a sense, in steps of the environment: its own, or that of MIMo's age, or that of all senses.
    pub(crate) fn sense_delay(&self, own: Option<f64>, of_age: &Latency) -> usize {
        match (own, self.age) {
            // latencies are measured in milliseconds, and the keys may have another unit
            (None, Some(age)) if self.delays.by_age => rounded(latency(of_age, age) / Delays::step_ms(self.frame_skip)),
            _ => self.delays.steps(own.unwrap_or(self.delays.sensory), self.frame_skip),
        }
    }

    /// Iterates over the senses' own rates, Hz, by key.
    pub(crate) fn rates(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let rates = [("vision_rate", self.vision_rate), ("touch_rate", self.touch_rate)];
        rates.into_iter().filter_map(|(key, rate)| Some((key, rate?)))
    }
}

impl EyeOptions {
    /// Age of the eyes' acuity for a MIMo without an age, months.
    pub const DEFAULT_AGE: f64 = 18.0;

    /// Returns the ages of the left and the right eye's acuity, months, for MIMo at a given age; `None` for sharp eyes.
    pub fn ages(&self, age: Option<f64>) -> [Option<f64>; 2] {
        let common = self.acuity.then(|| age.unwrap_or(Self::DEFAULT_AGE));
        [self.acuity_left.or(common), self.acuity_right.or(common)]
    }

    /// Returns the vertical fields of view of the left and the right eye, degrees; `None` for that of the camera in the scene.
    pub fn fields(&self) -> [Option<f64>; 2] {
        [self.fovy_left, self.fovy_right].map(|own| own.or(self.fovy))
    }

    /// Returns the strengths of the foveation of the left and the right eye; 0 for none.
    pub fn strengths(&self) -> [f64; 2] {
        [self.foveation_left, self.foveation_right].map(|own| own.unwrap_or(self.foveation))
    }
}
