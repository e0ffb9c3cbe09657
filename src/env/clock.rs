//! Clocks of senses that sample less often than the environment steps.

/// The clock of a sense with its own rate. The sense samples at the start of an episode, and then whenever its rate calls for
/// one more sample. A sample is late by less than a step, and the average rate is exact.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    /// Samples per step, at most 1.
    per_step: f64,
    /// The phase of the first sample after the initial one, from 0 to 1.
    phase: f64,
    /// Steps since the start of the episode.
    steps: u64,
    /// Steps since the last sample.
    age: u64,
}

impl Clock {
    /// Creates the clock of a sense that samples `rate` times a second in an environment whose steps take `dt` s.
    pub fn new(rate: f64, dt: f64) -> Self {
        Self {
            per_step: (rate * dt).min(1.0),
            phase: 0.0,
            steps: 0,
            age: 0,
        }
    }

    /// Starts an episode with a sample. Environments with different phases, from 0 to 1, sample in different steps, which spreads the
    /// work of many.
    pub fn reset(&mut self, phase: f64) {
        (self.phase, self.steps, self.age) = (phase, 0, 0);
    }

    /// Advances by a step.
    pub fn advance(&mut self) {
        self.steps += 1;
        self.age = if self.is_due_at(self.steps) { 0 } else { self.age + 1 };
    }

    /// Returns whether the sense samples in the current step.
    pub fn is_due(&self) -> bool {
        self.age == 0
    }

    /// Returns whether the sense will sample in the next step.
    pub fn will_be_due(&self) -> bool {
        self.is_due_at(self.steps + 1)
    }

    fn is_due_at(&self, step: u64) -> bool {
        let looks = |step: u64| (step as f64 * self.per_step + self.phase).floor();
        // from the count of steps, not from a sum of periods, whose rounding would add up over an episode
        looks(step) > looks(step - 1)
    }

    /// Returns the number of steps since the last sample.
    pub fn age(&self) -> u64 {
        self.age
    }

    /// Appends the clock's state, for a snapshot.
    pub fn save(&self, out: &mut Vec<u8>) {
        for word in [self.phase.to_bits(), self.steps, self.age] {
            out.extend_from_slice(&word.to_le_bytes());
        }
    }

    /// Restores what [`Clock::save`] wrote; `false` if the bytes do not fit.
    pub fn load(&mut self, bytes: &[u8]) -> bool {
        let (words, rest) = bytes.as_chunks::<8>();
        let &[phase, steps, age] = words else { return false };
        let (phase, [steps, age]) = (f64::from_le_bytes(phase), [steps, age].map(u64::from_le_bytes));
        // no run is that long, and counting from there cannot overflow
        if !rest.is_empty() || !(0.0..1.0).contains(&phase) || steps > 1 << 62 || age > steps {
            return false;
        }
        (self.phase, self.steps, self.age) = (phase, steps, age);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lists the steps, among the first hundred at 200 steps a second, in which a clock of 30 samples a second samples.
    fn looks(phase: f64) -> Vec<u64> {
        let mut clock = Clock::new(30.0, 0.005);
        clock.reset(phase);
        assert!(clock.is_due());
        let mut due = |step: u64| {
            let foretold = clock.will_be_due();
            clock.advance();
            assert_eq!(clock.is_due(), foretold);
            clock.is_due().then_some(step)
        };
        (1..=100).filter_map(&mut due).collect()
    }

    #[test]
    fn the_rate_holds_on_average_whatever_the_phase() {
        assert_eq!(looks(0.0), [7, 14, 20, 27, 34, 40, 47, 54, 60, 67, 74, 80, 87, 94, 100]);
        for phase in [0.1, 0.5, 0.99] {
            assert!((14..=16).contains(&looks(phase).len()), "{phase}");
        }
        assert_ne!(looks(0.0), looks(0.5));
    }

    #[test]
    fn a_rate_beyond_the_steps_looks_in_each() {
        let mut clock = Clock::new(1000.0, 0.005);
        clock.reset(0.7);
        for _ in 0..1000 {
            clock.advance();
            assert!(clock.is_due());
        }
    }

    #[test]
    fn it_goes_on_from_what_it_saved() {
        let mut clock = Clock::new(30.0, 0.01);
        clock.reset(0.3);
        (0..5).for_each(|_| clock.advance());
        let (mut bytes, mut other) = (Vec::new(), Clock::new(30.0, 0.01));
        clock.save(&mut bytes);
        assert!(other.load(&bytes) && !other.load(&bytes[1..]) && !other.load(&[0xff; 24]));
        for _ in 0..50 {
            clock.advance();
            other.advance();
            assert_eq!((clock.is_due(), clock.age()), (other.is_due(), other.age()));
        }
    }
}
