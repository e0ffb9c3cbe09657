//! Seeded motion: what is done to a scene at each step.

use babybench::Model;
use fastrand::Rng;

/// The way MIMo is moved, and the start of the episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Controls 0.
    Passive,
    /// New random controls at each step.
    Random,
    /// Random controls held for ten steps, which moves more.
    Hold,
    /// A sine for each actuator, of random frequency and phase.
    Sine,
    /// Controls 0 for long before the first state.
    Rest,
    /// As `Hold`, and objects start with random velocities, so that they topple and fly.
    Topple,
}

impl Motion {
    /// All.
    pub const ALL: [Self; 6] = [
        Self::Passive,
        Self::Random,
        Self::Hold,
        Self::Sine,
        Self::Rest,
        Self::Topple,
    ];

    /// Returns the name of the motion, for display.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passive => "passive",
            Self::Random => "random",
            Self::Hold => "held random",
            Self::Sine => "sine",
            Self::Rest => "rest",
            Self::Topple => "topple",
        }
    }
}

/// Controls of an episode.
pub struct Drive {
    motion: Motion,
    range: Vec<[f64; 2]>,
    waves: Vec<[f64; 2]>,
    rng: Rng,
}

impl Drive {
    /// Creates a drive for a model; the seed decides everything random.
    pub fn new(model: &Model, motion: Motion, seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let range = model.actuator_ctrlrange.clone();
        let waves = range
            .iter()
            .map(|_| [0.02 + 0.2 * rng.f64(), std::f64::consts::TAU * rng.f64()])
            .collect();
        Self {
            motion,
            range,
            waves,
            rng,
        }
    }

    /// Returns the random number generator, for other random choices of the episode.
    pub fn rng(&mut self) -> &mut Rng {
        &mut self.rng
    }

    /// Sets the controls of step `k`.
    pub fn set(&mut self, k: usize, ctrl: &mut [f64]) {
        match self.motion {
            Motion::Passive | Motion::Rest => ctrl.fill(0.0),
            Motion::Hold | Motion::Topple if !k.is_multiple_of(10) => {}
            Motion::Random | Motion::Hold | Motion::Topple => {
                for (c, [low, high]) in ctrl.iter_mut().zip(&self.range) {
                    *c = low + (high - low) * self.rng.f64();
                }
            }
            Motion::Sine => {
                for ((c, [low, high]), [speed, phase]) in ctrl.iter_mut().zip(&self.range).zip(&self.waves) {
                    *c = low + (high - low) * (0.5 + 0.5 * (speed * k as f64 + phase).sin());
                }
            }
        }
    }
}
