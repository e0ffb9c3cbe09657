//! How senses mature: delays, noise, acuity, foveation, pain.

use super::choices::DelayUnit;

/// Length of a physics step of BabyBench's scenes, ms, in which delays are counted.
const PHYSICS_STEP_MS: f64 = 5.0;

/// Delays of senses and actions, in [`Delays::unit`]; 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Delays {
    /// Unit of all delays.
    pub unit: DelayUnit,
    /// Delay of all senses that have none of their own.
    pub sensory: f64,
    /// Delay of actions.
    pub motor: f64,
    /// Delay of proprioception.
    pub proprioception: Option<f64>,
    /// Delay of touch, pooled touch and pain.
    pub touch: Option<f64>,
    /// Delay of balance.
    pub vestibular: Option<f64>,
    /// Delay of the eyes.
    pub vision: Option<f64>,
}

impl Delays {
    /// Returns a delay in steps of the environment, rounded to the nearest, half a step up.
    pub fn steps(&self, delay: f64, frame_skip: u32) -> usize {
        let steps = match self.unit {
            DelayUnit::Steps => delay,
            DelayUnit::Ms => delay / Self::step_ms(frame_skip),
        };
        (steps + 0.5) as usize
    }

    /// Returns the length of a step of the environment, ms.
    pub fn step_ms(frame_skip: u32) -> f64 {
        PHYSICS_STEP_MS * f64::from(frame_skip)
    }

    /// Returns the delay of a sense that has one of its own, or that of all senses.
    pub fn of(&self, own: Option<f64>) -> f64 {
        own.unwrap_or(self.sensory)
    }
}

/// Standard deviations of the noise of senses; 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseLevels {
    /// On every number of proprioception, in its unit.
    pub proprioception: f64,
    /// On touch sensors that feel something, N.
    pub touch: f64,
    /// On balance, m/s^2 and rad/s.
    pub vestibular: f64,
    /// On the bytes of images in colour and grey.
    pub vision: f64,
}

/// How sharp the eyes see, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EyeOptions {
    /// Whether eyes have the acuity of MIMo's age, or of 18 months if he has none.
    pub acuity: bool,
    /// Age of the acuity of the left eye, months, instead.
    pub acuity_left: Option<f64>,
    /// Age of the acuity of the right eye, months, instead.
    pub acuity_right: Option<f64>,
    /// Strength of the foveation of both eyes; 0 is none.
    pub foveation: f64,
    /// Strength of the foveation of the left eye, instead.
    pub foveation_left: Option<f64>,
    /// Strength of the foveation of the right eye, instead.
    pub foveation_right: Option<f64>,
}

impl EyeOptions {
    /// Age of the acuity of eyes of a MIMo without age, months.
    pub const DEFAULT_AGE: f64 = 18.0;

    /// Returns the ages of the acuity of the left and the right eye, months, of a MIMo of some age; `None` for sharp eyes.
    pub fn ages(&self, age: Option<f64>) -> [Option<f64>; 2] {
        let common = self.acuity.then(|| age.unwrap_or(Self::DEFAULT_AGE));
        [self.acuity_left.or(common), self.acuity_right.or(common)]
    }

    /// Returns the strengths of the foveation of the left and the right eye; 0 for none.
    pub fn strengths(&self) -> [f64; 2] {
        [self.foveation_left, self.foveation_right].map(|own| own.unwrap_or(self.foveation))
    }
}

/// The sense of pain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PainOptions {
    /// Force on a sensor from which on it hurts, N.
    pub threshold: f64,
    /// Pain for each newton beyond.
    pub slope: f64,
    /// Greatest pain of a sensor.
    pub limit: Option<f64>,
    /// Share of the pain of the last step that stays, 0 to 1.
    pub decay_old: f64,
    /// Factor on the new pain, 0 to 1.
    pub decay_new: f64,
}

impl Default for PainOptions {
    fn default() -> Self {
        Self {
            threshold: 20.0,
            slope: 0.1,
            limit: None,
            decay_old: 0.0,
            decay_new: 1.0,
        }
    }
}
