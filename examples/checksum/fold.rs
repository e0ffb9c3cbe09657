//! The bits of an environment, folded into a number.

use babybench::spaces::Values;
use babybench::{Env, Observation};

/// Folds positions, velocities and all senses.
pub fn bits(env: &Env) -> u64 {
    let mut hash = Hash::new();
    let state = env.state();
    state
        .qpos
        .iter()
        .chain(&state.qvel)
        .for_each(|v| hash.fold(v.to_bits()));
    hash.observation(&env.observation());
    hash.0
}

/// FNV-1a on 64-bit words.
pub struct Hash(pub u64);

impl Hash {
    /// Starts with nothing.
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Folds a word.
    pub fn fold(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x0100_0000_01b3);
    }

    /// Folds every entry of an observation, in the order of the table of entries, so that a new sense is part of every checksum.
    pub fn observation(&mut self, seen: &Observation<'_>) {
        seen.entries().for_each(|(_, values)| self.values(values));
    }

    /// Folds numbers, each as a word.
    pub fn values(&mut self, values: Values<'_>) {
        match values {
            Values::F64(values) => values.iter().for_each(|v| self.fold(v.to_bits())),
            Values::F32(values) => values.iter().for_each(|v| self.fold(u64::from(v.to_bits()))),
            Values::U8(values) => self.bytes(values),
            Values::I32(values) => values.iter().for_each(|v| self.fold(u64::from(v.cast_unsigned()))),
        }
    }

    /// Folds bytes, each as a word.
    pub fn bytes(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&v| self.fold(u64::from(v)));
    }
}
