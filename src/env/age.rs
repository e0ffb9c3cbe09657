//! Growing between two episodes.

use crate::env::{Env, EnvError};

impl Env {
    /// Lets MIMo grow, between two episodes, to an age in months; `None` gives him the original proportions. The next call is
    /// a reset. Locks, the generator of random choices, transforms that were added and the probe stay; names and ids are
    /// the same at every age.
    ///
    /// # Errors
    /// As [`Blueprint::with_age`](crate::Blueprint::with_age); nothing is changed then.
    pub fn set_age(&mut self, age: Option<f64>) -> Result<(), EnvError> {
        let grown = self.grown(age)?;
        self.become_grown(grown);
        Ok(())
    }

    /// Makes an environment of the same configuration at another age.
    pub(crate) fn grown(&self, age: Option<f64>) -> Result<Self, EnvError> {
        self.blueprint.with_age(age)?.env()
    }

    /// Turns into an environment of another age.
    pub(crate) fn become_grown(&mut self, mut grown: Self) {
        let (old, new) = (&self.physics.base, &mut grown.physics.base);
        new.eq_active.clone_from(&old.eq_active);
        new.eq_offset.clone_from(&old.eq_offset);
        std::mem::swap(&mut grown.rng, &mut self.rng);
        grown.set_probe(self.probe.take());
        grown.episode.accumulate = self.episode.accumulate;
        grown.senses.vision_deferred = self.senses.vision_deferred;
        grown.senses_mut().set_vision_threads(self.senses.vision_threads());
        grown.senses.take_added(&mut self.senses);
        *self = grown;
    }
}
