//! What an environment consists of: spaces, configuration, model, state, engine, senses, pictures.

use std::sync::Arc;

use crate::actuation::Actuation;
use crate::config::Config;
use crate::env::senses::vector;
use crate::env::task::rewards;
use crate::env::{Blueprint, Env, EnvError, Goal, GoalError, Info, PerEyeAndHand, Task, check_vector};
use crate::model::Model;
use crate::physics::{Engine, State};
use crate::render::RenderRequest;
use crate::sensors::{EyeImages, Proprioception, Touch, Vestibular, Vision};
use crate::spaces::{BoxSpace, ObservationSpace};

impl Env {
    /// Returns the bounds of actions.
    pub fn action_space(&self) -> &BoxSpace {
        self.actuation.action_space()
    }

    /// Returns keys, shapes, types and bounds of the observation.
    pub fn observation_space(&self) -> Vec<ObservationSpace> {
        let mut spaces = self.senses.spaces();
        for key in ["achieved_goal", "desired_goal"] {
            if !self.goals.desired.is_empty() {
                spaces.push(vector(key, self.goals.desired.len()));
            }
        }
        spaces
    }

    /// Returns the information of the last step.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// Returns how far each hand was off the axis of each eye in the last step, rad, in the order of
    /// [`EYE_HAND_PAIRS`](crate::env::EYE_HAND_PAIRS), if the behavior is `hand_regard`. Less than 15 degrees
    /// count.
    pub fn gaze_angles(&self) -> Option<PerEyeAndHand<f64>> {
        self.physics.check_shape().ok()?;
        let mut now = Info::default();
        self.task.describe(Some(&self.physics.state), &mut now);
        now.details.gaze_angles
    }

    /// Returns the task.
    pub fn task(&self) -> &dyn Task {
        &*self.task
    }

    /// Returns what reward, success and failure of the last step follow from.
    pub fn goal(&self) -> Goal<'_> {
        self.goals.row()
    }

    /// Sets the desired goal; reward and outcome are computed anew.
    ///
    /// # Errors
    /// A wrong length, numbers that are not finite; nothing is changed then.
    pub fn set_goal(&mut self, desired: &[f64]) -> Result<(), EnvError> {
        check_vector("desired_goal", desired, self.goals.desired.len())?;
        self.physics.check_shape()?;
        self.goals.desired.copy_from_slice(desired);
        self.judge();
        Ok(())
    }

    /// Computes what each row of goals would have earned: Gymnasium-Robotics' `compute_reward`, for as many rows as `out` has, with
    /// the desired goals of a program's choice. `terms` ([`Goal::terms`]) are those of the steps in which the goals were achieved. For
    /// the goals of a step it is the reward of the step, to the bit.
    ///
    /// ```
    /// use babybench::config::{Behavior, Config};
    /// use babybench::{Env, env::Goal};
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
    /// Arrays that do not have a row of the task's length for each reward.
    pub fn compute_reward(&self, goals: Goal<'_>, out: &mut [f64]) -> Result<(), GoalError> {
        rewards(&*self.task, goals, out)
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
    pub fn state(&self) -> &State {
        &self.physics.state
    }

    /// Returns the state of the scene, to change positions, velocities, warm start, applied forces or parameters. Quantities that
    /// follow from them are brought up to date by the next step.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.physics.state
    }

    /// Returns the physics engine.
    pub fn engine(&self) -> &dyn Engine {
        &*self.physics.engine
    }

    /// Returns the physics engine, to advance copies of the state with it.
    pub fn engine_mut(&mut self) -> &mut dyn Engine {
        &mut *self.physics.engine
    }

    /// Returns the proprioceptive sense: names and ranges of its values.
    pub fn proprioception(&self) -> &Proprioception {
        &self.senses.proprioception
    }

    /// Returns the sense of touch, if it is active: sensor positions, active sensors, contacts and sums of forces.
    pub fn touch(&self) -> Option<&Touch> {
        self.senses.touch.as_ref()
    }

    /// Returns the images of both eyes, left and right.
    pub(crate) fn eye_images(&self) -> &[EyeImages; 2] {
        &self.senses.eyes
    }

    /// Returns the sense of vision, if it is active.
    pub fn vision(&self) -> Option<&Vision> {
        self.senses.vision.as_ref()
    }

    /// Returns what the eyes see of the present state, left and right, to be drawn by any renderer, if vision is active.
    pub fn eyes(&self) -> Option<[RenderRequest<'_>; 2]> {
        self.physics.check_shape().ok()?;
        self.senses.vision.as_ref().map(|v| v.requests(&self.physics.state))
    }

    /// Returns the vestibular sense, if it is active.
    pub fn vestibular(&self) -> Option<&Vestibular> {
        self.senses.vestibular.as_ref()
    }

    /// Returns the actuation model.
    pub fn actuation(&self) -> &dyn Actuation {
        &*self.actuation
    }
}
