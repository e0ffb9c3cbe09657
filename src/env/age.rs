//! Growing between two episodes, and making faces in the middle of one.

use crate::config::FacialExpression;
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

    /// Lets MIMo make another face, at any moment; the next step has the same bits as without. Images that the eyes observe are drawn
    /// anew.
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
    /// As [`Blueprint::with_facial_expression`](crate::Blueprint::with_facial_expression); nothing is changed then.
    pub fn swap_facial_expression(&mut self, face: FacialExpression) -> Result<(), EnvError> {
        if self.config().facial_expression == face {
            return Ok(());
        }
        let other = self.blueprint.with_facial_expression(face)?.env()?;
        let (snapshot, ready, details) = (self.snapshot(), self.ready(), self.info.details.clone());
        let mut before = self.become_grown(other);
        // nothing but the pictures is another's, so that its own snapshot fits
        self.restore(&snapshot)?;
        if ready {
            self.by_hand().resume(&snapshot)?;
            self.info.details = details;
            // a step feels the contacts that it ends with, not those of the state that it leaves
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

    /// Turns into an environment of another age. Returns what it was.
    pub(crate) fn become_grown(&mut self, mut grown: Self) -> Self {
        let (old, new) = (&self.physics.base, &mut grown.physics.base);
        // only what differs, as parameters are shared until they are written to
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
