//! Checksums of what environments compute, to compare runs, builds and machines.

use super::{Env, Observation};
use crate::spaces::Values;

/// A checksum of numbers by their bits: FNV-1a on 64-bit words.
///
/// The same seed and actions give the same checksum on every processor, in any number of threads and in WebAssembly.
///
/// ```
/// use babybench::env::Checksum;
/// use babybench::{Config, Env};
///
/// let config = Config { vision_active: false, ..Config::default() };
/// let (mut one, mut other) = (Env::new(config.clone())?, Env::new(config)?);
/// one.reset(Some(7))?;
/// other.reset(Some(7))?;
/// assert_eq!(Checksum::of(&one), Checksum::of(&other));
/// # Ok::<(), babybench::EnvError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Checksum(pub u64);

impl Default for Checksum {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Checksum {
    /// Computes the checksum of an environment: positions, velocities and all senses.
    pub fn of(env: &Env) -> Self {
        let mut sum = Self::default();
        let state = env.state();
        state.qpos.iter().chain(&state.qvel).for_each(|v| sum.add(v.to_bits()));
        sum.add_observation(&env.observation());
        sum
    }

    /// Adds a word.
    pub fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x0100_0000_01b3);
    }

    /// Adds every entry of an observation, in the order of the table of entries, so that a new sense is part of every checksum.
    pub fn add_observation(&mut self, observation: &Observation<'_>) {
        observation.entries().for_each(|(_, values)| self.add_values(values));
    }

    /// Adds numbers, each as a word.
    pub fn add_values(&mut self, values: Values<'_>) {
        match values {
            Values::F64(values) => values.iter().for_each(|v| self.add(v.to_bits())),
            Values::F32(values) => values.iter().for_each(|v| self.add(u64::from(v.to_bits()))),
            Values::U8(values) => self.add_bytes(values),
            Values::I32(values) => values.iter().for_each(|v| self.add(u64::from(v.cast_unsigned()))),
        }
    }

    /// Adds bytes, each as a word.
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&v| self.add(u64::from(v)));
    }
}

/// Writes 16 hexadecimal digits.
impl std::fmt::Display for Checksum {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}
