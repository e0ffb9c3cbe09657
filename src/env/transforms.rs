//! The transforms of the senses of an environment.

use crate::env::{Env, EnvError};
use crate::sensors::transform::{Sense, Transform};
use crate::sensors::{Pain, SkinValues, TouchPool};

impl Env {
    /// Adds a transform of a sense, behind those that there are. Those of the configuration are, in this order: acuity and
    /// foveation of the eyes, noise, delay.
    ///
    /// Random numbers are drawn in each reset and step after the observation is computed, sense by sense in the order of
    /// [`Sense::ALL`] and transform by transform, from the generator that draws actions, too.
    ///
    /// # Errors
    /// [`EnvError::SenseOff`].
    pub fn add_transform(&mut self, sense: Sense, transform: Box<dyn Transform>) -> Result<(), EnvError> {
        if !self.senses.is_on(sense) {
            return Err(EnvError::SenseOff { sense });
        }
        self.senses.add_transform(sense, transform);
        Ok(())
    }

    /// Iterates over the senses that are observed, each with its transforms in their order.
    pub fn pipeline(&self) -> impl Iterator<Item = (Sense, impl Iterator<Item = &dyn Transform>)> {
        let on = Sense::ALL.into_iter().filter(|&sense| self.senses.is_on(sense));
        on.map(|sense| (sense, self.senses.pipeline.of(sense)))
    }

    /// Returns how many steps pass until an action reaches the actuators.
    pub fn motor_delay(&self) -> usize {
        self.motor.steps()
    }

    /// Returns touch as it is observed, with the list of sensors that are not zero, if it is active. What the skin feels
    /// before all transforms is in [`Env::touch`].
    pub fn touch_observed(&self) -> Option<&SkinValues> {
        self.senses.touch_observed()
    }

    /// Returns pain as it is observed, if it is active.
    pub fn pain_observed(&self) -> Option<&SkinValues> {
        self.senses.pain_observed()
    }

    /// Returns the sense of pain, if it is active.
    pub fn pain(&self) -> Option<&Pain> {
        self.senses.pain.as_ref()
    }

    /// Returns the sense of pain, if it is active, to change how soft and how sensitive bodies are.
    pub fn pain_mut(&mut self) -> Option<&mut Pain> {
        self.senses.pain.as_mut()
    }

    /// Returns which bodies pooled touch is of, if it is active.
    pub fn touch_pool(&self) -> Option<&TouchPool> {
        self.senses.pool.as_ref()
    }

    /// Returns the memory that delays and other transforms take, bytes.
    pub fn transform_memory(&self) -> usize {
        self.senses.pipeline.memory() + self.motor.memory()
    }
}
