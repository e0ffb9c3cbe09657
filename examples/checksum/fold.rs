//! The bits of an environment, folded into a number.

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

    /// Folds all senses.
    pub fn observation(&mut self, seen: &Observation<'_>) {
        let dense = [seen.proprioception, seen.vestibular.unwrap_or_default()];
        dense.concat().iter().for_each(|v| self.fold(v.to_bits()));
        let touch = seen.touch.unwrap_or_default().iter();
        touch.for_each(|v| self.fold(u64::from(v.to_bits())));
        let pooled = seen.touch_pooled.unwrap_or_default().iter();
        pooled.for_each(|v| self.fold(v.to_bits()));
        let pain = seen.pain.unwrap_or_default().iter();
        pain.for_each(|v| self.fold(u64::from(v.to_bits())));
        let eyes = [seen.eye_left, seen.eye_right].map(Option::unwrap_or_default);
        let gray = [seen.eye_left_gray, seen.eye_right_gray].map(Option::unwrap_or_default);
        eyes.into_iter().chain(gray).for_each(|image| self.bytes(image));
        self.depth(&[seen.eye_left_depth, seen.eye_right_depth].map(Option::unwrap_or_default));
        self.segmentation(&[seen.eye_left_segmentation, seen.eye_right_segmentation].map(Option::unwrap_or_default));
        let goals = [seen.achieved_goal, seen.desired_goal].map(Option::unwrap_or_default);
        goals.concat().iter().for_each(|v| self.fold(v.to_bits()));
    }

    /// Folds bytes, each as a word.
    pub fn bytes(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&v| self.fold(u64::from(v)));
    }

    /// Folds images of distances.
    pub fn depth(&mut self, images: &[&[f32]]) {
        let pixels = images.iter().copied().flatten();
        pixels.for_each(|v| self.fold(u64::from(v.to_bits())));
    }

    /// Folds images of geoms.
    pub fn segmentation(&mut self, images: &[&[i32]]) {
        let pixels = images.iter().copied().flatten();
        pixels.for_each(|v| self.fold(u64::from(v.cast_unsigned())));
    }
}
