//! Changes of age between two episodes, and of the face at any time.

use crate::config::FacialExpression;
use crate::env::{Env, EnvError};

impl Env {
    /// Changes MIMo's age, in months, between two episodes; `None` gives him the original proportions. The next call is a reset. Locks,
    /// the generator of random choices, added transforms and the probe remain. Names and ids are the same at every age.
    ///
    /// # Errors
    /// Those of [`Blueprint::with_age`](crate::Blueprint::with_age), which change nothing.
    pub fn set_age(&mut self, age: Option<f64>) -> Result<(), EnvError> {
        let grown = self.grown(age)?;
        self.become_grown(grown);
        Ok(())
    }

    /// Changes MIMo's face at any time. The next step has the same bits as without the change. Images of the eyes are redrawn.
    ///
    /// ```
    /// use babybench::config::FacialExpression;
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// env.swap_facial_expression(FacialExpression::Happy)?;
    /// assert_eq!(env.config().facial_expression, FacialExpression::Happy);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Blueprint::with_facial_expression`](crate::Blueprint::with_facial_expression), which change nothing.
    pub fn swap_facial_expression(&mut self, face: FacialExpression) -> Result<(), EnvError> {
        if self.config().facial_expression == face {
            return Ok(());
        }
        let other = self.blueprint.with_facial_expression(face)?.env()?;
        let (snapshot, ready, details) = (self.snapshot(), self.ready(), self.info.details.clone());
        let mut before = self.become_grown(other);
        // only pictures differ, so the environment's own snapshot fits
        self.restore(&snapshot)?;
        if ready {
            self.by_hand().resume(&snapshot)?;
            self.info.details = details;
            // a step senses the contacts of its last physics step, not those of its final state
            if before.senses.known {
                self.senses.take_felt(&mut before.senses);
            }
        }
        Ok(())
    }

    /// Makes an environment of the same configuration at another age.
    pub(crate) fn grown(&self, age: Option<f64>) -> Result<Self, EnvError> {
        self.blueprint.with_age(age)?.env()
    }

    /// Becomes an environment of another age. Returns the previous one.
    pub(crate) fn become_grown(&mut self, mut grown: Self) -> Self {
        let (old, new) = (&self.physics.base, &mut grown.physics.base);
        // only what differs, because parameters are shared until they are written
        if (&new.eq_active, &new.eq_offset) != (&old.eq_active, &old.eq_offset) {
            new.eq_active.clone_from(&old.eq_active);
            new.eq_offset.clone_from(&old.eq_offset);
        }
        std::mem::swap(&mut grown.rng, &mut self.rng);
        grown.set_probe(self.probe.take());
        if self.shares() {
            grown.share();
        }
        grown.episode.accumulate = self.episode.accumulate;
        grown.senses.vision_deferred = self.senses.vision_deferred;
        grown.senses_mut().set_vision_threads(self.senses.vision_threads());
        grown.senses.take_added(&mut self.senses);
        std::mem::replace(self, grown)
    }
}
