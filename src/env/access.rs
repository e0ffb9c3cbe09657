//! Access to the parts of an environment: spaces, configuration, model, state, senses.

use std::sync::Arc;

use super::{Blueprint, Env, Goal, Info, Senses, SensesMut};
use crate::actuation::Reflexes;
use crate::config::{Config, Reflex};
use crate::model::Model;
use crate::physics::State;
use crate::sensors::ObservationEntry;
use crate::spaces::{BoxSpace, ObservationSpace, Values};

impl Env {
    /// Returns the bounds of actions.
    pub fn action_space(&self) -> &BoxSpace {
        self.blueprint.actuation().action_space()
    }

    /// Returns the reflexes that act on MIMo, in the order of the entry `reflexes` of the observation.
    pub fn reflexes(&self) -> impl Iterator<Item = Reflex> {
        let tables = self.blueprint.tables().reflexes.as_ref();
        tables.into_iter().flat_map(|tables| tables.reflexes())
    }

    /// Returns keys, shapes, types and bounds of the observation.
    pub fn observation_space(&self) -> Vec<ObservationSpace> {
        let space = |(entry, values): (&'static ObservationEntry, Values<'_>)| ObservationSpace {
            key: entry.key,
            shape: self.senses.shape(entry, values.len()),
            dtype: entry.dtype,
            low: entry.low,
            high: entry.high,
        };
        // images have an entry, drawn or not
        self.with_goals(self.senses.observation_with(true))
            .entries()
            .map(space)
            .collect()
    }

    /// Returns the information of the last step.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// Returns the goals and terms of the last step, from which reward, success and failure follow.
    pub fn goal(&self) -> Goal<'_> {
        self.goals.row()
    }

    /// Returns the configuration.
    pub fn config(&self) -> &Config {
        self.blueprint.config()
    }

    /// Returns the blueprint that this environment was made from.
    pub fn blueprint(&self) -> &Blueprint {
        &self.blueprint
    }

    /// Returns the compiled scene.
    pub fn model(&self) -> &Arc<Model> {
        self.blueprint.model()
    }

    /// Returns the state of the scene.
    ///
    /// An environment of a [`VectorEnv`](crate::VectorEnv) stores only what decides how the run continues. The first call recomputes the
    /// derived quantities of the last step, which takes as long as a physics step. The environment then keeps them, as a single
    /// environment does, until its next episode.
    pub fn state(&self) -> &State {
        self.physics.state()
    }

    /// Returns the state of the scene, to change positions, velocities, warm start, applied forces or parameters. The next step or
    /// [`refresh`](crate::env::ManualControl::refresh) updates derived quantities and the observation.
    pub fn state_mut(&mut self) -> &mut State {
        self.physics.state_mut()
    }

    /// Returns the senses: their description, and their last values.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// Returns the senses, to change them or to draw the current view of the eyes.
    pub fn senses_mut(&mut self) -> SensesMut<'_> {
        SensesMut { env: self }
    }

    /// Returns how many numbers the generator of random choices has drawn since it was seeded.
    #[cfg(all(feature = "eval", feature = "npz"))]
    pub(crate) fn drawn(&self) -> u64 {
        self.rng.drawn()
    }

    /// Returns the memory of delays and other transforms, bytes.
    pub(crate) fn transform_memory(&self) -> usize {
        let reflexes = self.reflexes.as_ref().map_or(0, Reflexes::bytes);
        self.senses.pipeline.memory() + self.action_delay.memory() + reflexes
    }
}
