//! Changes to MIMo: locks, age and face.

use super::{Blueprint, Env, EnvError};
use crate::config::FacialExpression;
use crate::mimo::{LockReport, LockTarget};

/// MIMo in an environment, to change him: [`Env::mimo_mut`].
#[derive(Debug)]
pub struct MimoMut<'a> {
    env: &'a mut Env,
}

impl MimoMut<'_> {
    /// Locks a joint, or all joints of a part, at an angle in rad, from the next step. Locks outlast resets. Locks from the configuration can also be
    /// moved and removed.
    ///
    /// ```
    /// use babybench::config::Part;
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// env.mimo_mut().lock(Part::Head, 0.0)?;
    /// let elbow = env.mimo_mut().lock("robot:right_elbow", -1.2)?;
    /// assert!(elbow.held.is_empty() && elbow.beyond_limits.is_empty());
    /// env.mimo_mut().unlock(Part::Head)?;
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// A joint that does not exist or cannot be locked, or an angle that is not finite. Joints that the scene holds are listed in the
    /// report and are not errors.
    pub fn lock<'a>(&mut self, target: impl Into<LockTarget<'a>>, angle: f64) -> Result<LockReport, EnvError> {
        self.env.physics.lock(self.env.blueprint.model(), target.into(), angle)
    }

    /// Unlocks a joint, or all joints of a part, from the next step, also in later episodes.
    ///
    /// # Errors
    /// A joint that does not exist or cannot be locked.
    pub fn unlock<'a>(&mut self, target: impl Into<LockTarget<'a>>) -> Result<LockReport, EnvError> {
        self.env.physics.unlock(self.env.blueprint.model(), target.into())
    }

    /// Changes MIMo's age, in months, between two episodes; `None` gives him the original proportions. The next call must be a reset. Locks,
    /// the generator of random choices, added transforms and the probe remain. Names and ids are the same at every age.
    ///
    /// # Errors
    /// Those of [`Blueprint::with_age`](crate::Blueprint::with_age); [`EnvError::Schedule`] if MIMo grows by a schedule. They change
    /// nothing.
    pub fn set_age(&mut self, age: Option<f64>) -> Result<(), EnvError> {
        let grown = self.env.grown(age)?;
        self.env.become_grown(grown);
        Ok(())
    }

    /// Makes MIMo another infant of his population (`body_random`), between two episodes: see
    /// [`Blueprint::with_body_number`](crate::Blueprint::with_body_number). The next call must be a reset. As with a
    /// change of age, names and ids remain.
    ///
    /// # Errors
    /// As [`Blueprint::with_body_number`](crate::Blueprint::with_body_number). They change nothing.
    pub fn set_body_number(&mut self, number: u64) -> Result<(), EnvError> {
        let other = self.env.blueprint.with_body_number(number)?.env()?;
        self.env.become_grown(other);
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
    /// env.mimo_mut().swap_facial_expression(FacialExpression::Happy)?;
    /// assert_eq!(env.config().facial_expression, FacialExpression::Happy);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Blueprint::with_facial_expression`](crate::Blueprint::with_facial_expression), which change nothing.
    pub fn swap_facial_expression(&mut self, face: FacialExpression) -> Result<(), EnvError> {
        let env = &mut *self.env;
        if env.config().facial_expression == face {
            return Ok(());
        }
        let other = env.blueprint.with_facial_expression(face)?;
        env.become_painted(&other)
    }
}

impl Env {
    /// Returns MIMo, to lock his joints and to change his age and face.
    pub fn mimo_mut(&mut self) -> MimoMut<'_> {
        MimoMut { env: self }
    }

    /// Makes an environment of the same configuration at another age.
    pub(crate) fn grown(&self, age: Option<f64>) -> Result<Self, EnvError> {
        if self.grows() {
            return Err(EnvError::Schedule { what: "age" });
        }
        self.blueprint.with_age(age)?.env()
    }

    /// Becomes an environment of a blueprint that differs only in its pictures. Environments of a blueprint share its pictures, so other pictures
    /// need another environment.
    pub(super) fn become_painted(&mut self, blueprint: &Blueprint) -> Result<(), EnvError> {
        let other = blueprint.env()?;
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

    /// Becomes an environment of another age. Returns the previous one.
    pub(crate) fn become_grown(&mut self, mut grown: Self) -> Self {
        let (old, new) = (&self.physics.base, &mut grown.physics.base);
        // only what differs, because parameters are shared until they are written
        if (&new.eq_active, &new.eq_offset) != (&old.eq_active, &old.eq_offset) {
            new.eq_active.clone_from(&old.eq_active);
            new.eq_offset.clone_from(&old.eq_offset);
        }
        // random choices continue as if nothing had happened
        std::mem::swap(&mut grown.rng, &mut self.rng);
        grown.by_hand().set_probe(self.probe.take());
        if self.shares() {
            grown.share();
        }
        grown.episode.accumulate = self.episode.accumulate;
        grown.episode.earlier_steps = self.lifetime_steps();
        grown.senses.vision_deferred = self.senses.vision_deferred;
        grown.senses_mut().set_vision_threads(self.senses.vision_threads());
        grown.senses.take_added(&mut self.senses);
        std::mem::replace(self, grown)
    }
}
