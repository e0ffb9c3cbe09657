//! The course of an episode: its start, its counters, its end.

use super::outcome::clear;
use super::task::StagedTask;
use super::{Env, EnvError, Observation};
use crate::config::Compat;
use crate::spaces::NumpyRng;

/// The progress of an episode.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Episode {
    /// Number of steps done.
    pub steps: u64,
    /// Number of steps of all earlier episodes.
    pub earlier_steps: u64,
    /// Whether a step may follow: the environment was reset and has not diverged since.
    pub ready: bool,
    /// Whether information continues from episode to episode.
    pub accumulate: bool,
    /// Reward of the last step.
    pub reward: f64,
    /// Whether the last step ended the episode in success or failure.
    pub terminated: bool,
}

impl Env {
    /// Starts an episode as the task defines it. For `self_touch` and `hand_regard` it is the settled state, then ten physics steps with
    /// random actions. The information of a reset is empty.
    ///
    /// Under `compat: api` a seed reseeds every random choice. Under `compat: reference` it is ignored, because the start actions come
    /// from the generator of the action space: see
    /// [`seed_action_space`](crate::env::ManualControl::seed_action_space).
    ///
    /// # Errors
    /// The simulation diverged; errors of another age by [`Config::age_schedule`](crate::Config::age_schedule).
    pub fn reset(&mut self, seed: Option<u64>) -> Result<Observation<'_>, EnvError> {
        if let (Some(seed), Compat::Api) = (seed, self.config().compat) {
            self.rng = NumpyRng::seed(seed);
        }
        self.grow()?;
        self.end_episode();
        let StagedTask { mut scene, task, .. } = self.play();
        task.reset(&mut scene)?;
        self.begin_episode()?;
        // here, too: a reset of an environment of a vector works in a scratch state
        self.check_shared()?;
        Ok(self.observation())
    }

    /// Returns whether a step may follow: the environment was reset and has not diverged since.
    pub(crate) fn ready(&self) -> bool {
        self.episode.ready
    }

    pub(super) fn end_episode(&mut self) -> u64 {
        self.episode.ready = false;
        self.senses.forget_picture();
        let steps = std::mem::take(&mut self.episode.steps);
        self.episode.earlier_steps += steps;
        steps
    }

    pub(super) fn begin_episode(&mut self) -> Result<(), EnvError> {
        self.episode.steps = 0;
        self.info.steps = 0;
        // success and return are those of one episode, even if a program accumulates counters
        if !self.episode.accumulate || self.info.behavior.task().is_some() {
            self.task.forget();
            clear(&*self.task, &mut self.info);
        }
        let StagedTask {
            mut scene, task, goals, ..
        } = self.play();
        // before the senses, because the desired goal is part of the first observation
        task.begin(&mut scene, &mut goals.desired);
        // after the start actions of the reset, which under `compat: reference` have passed through it
        self.action_delay.rest();
        self.senses.reset(self.phase());
        self.date_body();
        self.episode.ready = true;
        self.sense()?;
        // for the achieved goal of the first observation; the reward that comes with it is dropped
        self.judge();
        (self.episode.reward, self.episode.terminated) = (0.0, false);
        Ok(())
    }

    /// Returns the phase at which senses with their own rates start an episode: a number from 0 to 1 derived from the generator
    /// without drawing from it, so that environments with different seeds sample in different steps.
    pub(super) fn phase(&self) -> f64 {
        // of a copy: switching a sense's rate on changes no random choice
        let word = self.rng.clone().word();
        (word >> 11) as f64 / (1_u64 << 53) as f64
    }
}
