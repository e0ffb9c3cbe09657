//! Access to the parts of an environment: spaces, configuration, model, state, engine, senses.

use std::sync::Arc;

use crate::actuation::Actuation;
use crate::config::Config;
use crate::env::task::rewards;
use crate::env::{Blueprint, Env, EnvError, Goal, GoalError, Info, Senses, SensesMut, Task, check_vector};
use crate::model::Model;
use crate::physics::{Engine, State};
use crate::sensors::ObservationEntry;
#[cfg(all(feature = "eval", feature = "npz"))]
use crate::spaces::NumpyRng;
use crate::spaces::{BoxSpace, ObservationSpace, Values};

impl Env {
    /// Returns the bounds of actions.
    pub fn action_space(&self) -> &BoxSpace {
        self.actuation.action_space()
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

    /// Returns the task.
    pub fn task(&self) -> &dyn Task {
        &*self.task
    }

    /// Returns the goals and terms of the last step, from which reward, success and failure follow.
    pub fn goal(&self) -> Goal<'_> {
        self.goals.row()
    }

    /// Sets the desired goal and recomputes reward and outcome.
    ///
    /// # Errors
    /// A wrong length or numbers that are not finite, which change nothing.
    pub fn set_goal(&mut self, desired: &[f64]) -> Result<(), EnvError> {
        check_vector("desired_goal", desired, self.goals.desired.len())?;
        self.physics.check_shape()?;
        self.goals.desired.copy_from_slice(desired);
        self.judge();
        Ok(())
    }

    /// Computes the reward of each row of goals, like Gymnasium-Robotics' `compute_reward`, for as many rows as `out` has, with desired
    /// goals of the program's choice. `terms` ([`Goal::terms`]) are those of the steps in which the goals were achieved. For the goals of
    /// a step it is the reward of that step, to the bit.
    ///
    /// ```
    /// use babybench::config::Behavior;
    /// use babybench::{Env, env::Goal};
    /// use babybench::Config;
    ///
    /// let mut env = Env::new(Config::of(Behavior::Standup))?;
    /// env.reset(Some(0))?;
    /// let reward = env.step(&vec![0.5; env.action_space().len()])?.reward;
    /// let mut found = [0.0];
    /// env.compute_reward(env.goal(), &mut found)?;
    /// assert_eq!(found, [reward]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Arrays without a row of the task's length for each reward.
    pub fn compute_reward(&self, goals: Goal<'_>, out: &mut [f64]) -> Result<(), GoalError> {
        rewards(&*self.task, self.blueprint.task_sizes(), goals, out)
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
    /// [`Env::refresh`] updates derived quantities and the observation.
    pub fn state_mut(&mut self) -> &mut State {
        self.physics.state_mut()
    }

    /// Returns a physics engine that tells what follows from the model. [`Blueprint::engine`] makes one that advances copies of the state.
    pub fn engine(&self) -> &dyn Engine {
        self.physics.reader()
    }

    /// Returns the senses: what they consist of, and what they felt last.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// Returns the senses, to change them or to draw the current view of the eyes.
    pub fn senses_mut(&mut self) -> SensesMut<'_> {
        SensesMut {
            senses: &mut self.senses,
            physics: &self.physics,
        }
    }

    /// Returns how many numbers the generator of random choices has drawn since it was seeded.
    #[cfg(all(feature = "eval", feature = "npz"))]
    pub(crate) fn drawn(&self) -> u64 {
        self.rng.drawn()
    }

    /// Moves the generator of random choices to its position after `drawn` numbers.
    #[cfg(all(feature = "eval", feature = "npz"))]
    pub fn draw_from(&mut self, drawn: u64) {
        self.rng = NumpyRng::at(self.rng.seed_value(), drawn);
    }

    /// Returns the memory of delays and other transforms, bytes.
    pub(crate) fn transform_memory(&self) -> usize {
        self.senses.pipeline.memory() + self.action_delay.memory()
    }

    /// Returns the actuation model.
    pub fn actuation(&self) -> &dyn Actuation {
        &*self.actuation
    }
}
