//! The delay between an action and the actuators, and the noise of the motors.

use crate::config::{ActuationModel, Compat, Config};
use crate::sensors::transform::DelayLine;
use crate::spaces::{BoxSpace, ColoredNoise, NumpyRng};

/// Passes actions to the actuators, immediately or after a delay, unchanged or with noise that grows with them.
#[derive(Clone, Debug)]
pub(crate) struct ActionDelay {
    line: Option<DelayLine>,
    /// The action that reaches the actuators before the first one of an episode.
    rest: Vec<f32>,
    compat: Compat,
    /// Standard deviation of the noise, as a share of each number.
    deviation: f64,
    /// Exponent of its colour; `None` for white noise.
    color: Option<f64>,
    /// The coloured noise of an episode, from its first action on.
    colored: Option<ColoredNoise>,
    noisy: Vec<f32>,
}

/// Bytes of a coloured noise in a snapshot: whether there is one, its seed and its step.
const COLORED: usize = 17;

impl ActionDelay {
    /// Creates the delay of a configuration, by a number of steps.
    pub fn new(config: &Config, space: &BoxSpace, steps: usize) -> Self {
        let centred = config.actuation_model == ActuationModel::Positional;
        let bounds = space.low().iter().zip(space.high());
        Self {
            line: (steps > 0).then(|| DelayLine::new(steps, space.len())),
            // 0 may be outside the limits of a joint, the middle of its range is not
            rest: bounds
                .map(|(low, high)| if centred { low + (high - low) / 2.0 } else { 0.0 })
                .collect(),
            compat: config.compat,
            deviation: config.noise.motor,
            color: config.noise.motor_color,
            colored: None,
            // reserved here, because a step allocates nothing
            noisy: Vec::with_capacity(if config.noise.motor > 0.0 { space.len() } else { 0 }),
        }
    }

    /// Returns the delay, steps.
    pub fn steps(&self) -> usize {
        self.line.as_ref().map_or(0, DelayLine::steps)
    }

    /// Returns the action that reaches the actuators when `action` is given.
    pub fn pass<'a>(&'a mut self, action: &'a [f32], rng: &mut NumpyRng) -> &'a [f32] {
        let action = match &mut self.line {
            // delayed first: the noise is that of the motor, at the end of the nerve
            Some(line) => line.pass(action),
            None => action,
        };
        // without noise no random number is drawn, so episodes do not change
        if self.deviation == 0.0 {
            return action;
        }
        self.noisy.clear();
        if let Some(exponent) = self.color {
            let len = action.len();
            // one draw for an episode: the whole series follows from it, so a snapshot needs only its seed and step
            let colored = self
                .colored
                .get_or_insert_with(|| ColoredNoise::new(exponent, len, rng.word()));
            let each = action.iter().zip(colored.next_values());
            let noisy = |(&a, &n): (&f32, &f32)| (f64::from(a) * (1.0 + self.deviation * f64::from(n))) as f32;
            self.noisy.extend(each.map(noisy));
            return &self.noisy;
        }
        let noisy = |&a: &f32| (f64::from(a) * (1.0 + self.deviation * rng.normal())) as f32;
        self.noisy.extend(action.iter().map(noisy));
        &self.noisy
    }

    /// Returns the action that reaches the actuators when `action` is given in a reset: without delay, except in the code that
    /// `compat: reference` follows.
    pub fn pass_in_reset<'a>(&'a mut self, action: &'a [f32], rng: &mut NumpyRng) -> &'a [f32] {
        match self.compat {
            Compat::Api => action,
            Compat::Reference => self.pass(action, rng),
        }
    }

    /// Forgets the last episode, at the start of a reset.
    pub fn clear(&mut self) {
        if let Some(line) = &mut self.line {
            line.clear();
        }
        self.colored = None;
    }

    /// Fills the delay at the end of a reset.
    pub fn rest(&mut self) {
        // under `compat: reference` the first action that passes fills the line, even if it is one of the reset
        if let (Some(line), Compat::Api) = (&mut self.line, self.compat) {
            line.fill(&self.rest);
        }
    }

    pub fn save(&self, out: &mut Vec<u8>) {
        if let Some(line) = &self.line {
            line.save(out);
        }
        if self.color.is_some() {
            // always of the same length, so that `load` finds it at the end
            let [seed, step] = self.colored.as_ref().map_or([0; 2], ColoredNoise::position);
            out.push(u8::from(self.colored.is_some()));
            out.extend([seed, step].into_iter().flat_map(u64::to_le_bytes));
        }
    }

    /// Restores what was saved; `false` if the data do not fit.
    pub fn load(&mut self, bytes: &[u8]) -> bool {
        let mut bytes = bytes;
        if let Some(exponent) = self.color {
            let Some((line, colored)) = bytes.split_last_chunk::<COLORED>() else {
                return false;
            };
            let word = |at: usize| std::array::from_fn(|k| colored[at + k]);
            let [seed, step] = [1, 9].map(|at| u64::from_le_bytes(word(at)));
            self.colored = (colored[0] != 0).then(|| ColoredNoise::at(exponent, self.rest.len(), seed, step));
            bytes = line;
        }
        match &mut self.line {
            Some(line) => line.load(bytes),
            None => bytes.is_empty(),
        }
    }

    /// Returns the memory of the delay, bytes.
    pub fn memory(&self) -> usize {
        4 * self.steps() * self.rest.len() + self.colored.as_ref().map_or(0, ColoredNoise::memory)
    }
}
