//! One environment of a vector.

use super::slot::Slot;
use super::{VectorEnv, VectorError, of};
use crate::config::FacialExpression;
use crate::env::{Env, Info, Observation, Snapshot, space_difference};
use crate::mimo::{LockReport, LockTarget};
use crate::spaces::{BoxSpace, ObservationSpace};

impl VectorEnv {
    /// Returns an environment.
    ///
    /// # Errors
    /// [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn env(&self, env: usize) -> Result<&Env, VectorError> {
        Ok(&self.slot(env)?.env)
    }

    /// Returns an environment, to change its state. The rows of the vector show the results of direct calls only after the next step.
    ///
    /// # Errors
    /// [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn env_mut(&mut self, env: usize) -> Result<&mut Env, VectorError> {
        Ok(&mut self.slot_mut(env)?.env)
    }

    /// Returns the information at the end of an environment's last episode, with names and lists in order, if it ended in the last step
    /// and the mode is [`AutoresetMode::SameStep`](super::AutoresetMode).
    ///
    /// # Errors
    /// [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn final_info(&self, env: usize) -> Result<Option<&Info>, VectorError> {
        let slot = self.slot(env)?;
        let last = slot.last.as_ref().filter(|_| slot.ended);
        Ok(last.map(|last| &last.info))
    }

    /// Locks a joint, or all joints of a part, of one environment: see [`MimoMut::lock`](crate::env::MimoMut::lock).
    ///
    /// # Errors
    /// As [`MimoMut::lock`](crate::env::MimoMut::lock); [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn lock<'a>(
        &mut self,
        env: usize,
        target: impl Into<LockTarget<'a>>,
        angle: f64,
    ) -> Result<LockReport, VectorError> {
        self.env_mut(env)?.mimo_mut().lock(target, angle).map_err(of(env))
    }

    /// Unlocks a joint, or all joints of a part, of one environment: see [`MimoMut::unlock`](crate::env::MimoMut::unlock).
    ///
    /// # Errors
    /// As [`MimoMut::unlock`](crate::env::MimoMut::unlock); [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn unlock<'a>(&mut self, env: usize, target: impl Into<LockTarget<'a>>) -> Result<LockReport, VectorError> {
        self.env_mut(env)?.mimo_mut().unlock(target).map_err(of(env))
    }

    /// Takes a snapshot of one environment: see [`Env::snapshot`].
    ///
    /// # Errors
    /// [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn snapshot(&self, env: usize) -> Result<Snapshot, VectorError> {
        Ok(self.env(env)?.snapshot())
    }

    /// Restores a snapshot in one environment, of itself or of another with the same configuration: see [`Env::restore`].
    ///
    /// # Errors
    /// As [`Env::restore`]; [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn restore(&mut self, env: usize, snapshot: &Snapshot) -> Result<(), VectorError> {
        let restored = self.env_mut(env)?.restore(snapshot);
        restored.map_err(|e| of(env)(e.into()))
    }

    /// Changes the age of one environment's MIMo between two episodes: see [`MimoMut::set_age`](crate::env::MimoMut::set_age). With
    /// [`Config::touch_grows`](crate::Config::touch_grows) the spaces are the same at every age.
    ///
    /// # Errors
    /// As [`MimoMut::set_age`](crate::env::MimoMut::set_age); [`VectorError::Grown`] if the spaces would differ; [`VectorError::Unknown`],
    /// [`VectorError::InFlight`]. They change nothing.
    pub fn set_age(&mut self, env: usize, age: Option<f64>) -> Result<(), VectorError> {
        let grown = self.env(env)?.grown(age).map_err(of(env))?;
        match space_difference(&self.action_space, &self.observation_space, &grown) {
            Some((what, expected, found)) => Err(VectorError::Grown {
                env,
                what,
                expected,
                found,
            }),
            None => {
                self.env_mut(env)?.become_grown(grown);
                Ok(())
            }
        }
    }

    /// Changes the face of one environment's MIMo: see [`MimoMut::swap_facial_expression`](crate::env::MimoMut::swap_facial_expression).
    ///
    /// # Errors
    /// As [`MimoMut::swap_facial_expression`](crate::env::MimoMut::swap_facial_expression); [`VectorError::Unknown`],
    /// [`VectorError::InFlight`].
    pub fn swap_facial_expression(&mut self, env: usize, face: FacialExpression) -> Result<(), VectorError> {
        let swapped = self.env_mut(env)?.mimo_mut().swap_facial_expression(face);
        swapped.map_err(of(env))
    }

    /// Moves the scene of one environment to positions and velocities in the middle of an episode: see
    /// [`ManualControl::set_state`](crate::env::ManualControl::set_state).
    ///
    /// # Errors
    /// As [`ManualControl::set_state`](crate::env::ManualControl::set_state); [`VectorError::Unknown`], [`VectorError::InFlight`].
    pub fn set_state(&mut self, env: usize, qpos: &[f64], qvel: &[f64]) -> Result<Observation<'_>, VectorError> {
        self.env_mut(env)?.by_hand().set_state(qpos, qvel).map_err(of(env))
    }

    /// Returns the bounds of the actions of one environment.
    pub fn single_action_space(&self) -> &BoxSpace {
        &self.action_space
    }

    /// Returns keys, shapes, types and bounds of the observation of one environment.
    pub fn single_observation_space(&self) -> &[ObservationSpace] {
        &self.observation_space
    }

    fn slot(&self, env: usize) -> Result<&Slot, VectorError> {
        let envs = self.len();
        let place = self.slots.get(env).ok_or(VectorError::Unknown { env, envs })?;
        place.as_deref().ok_or(VectorError::InFlight { env })
    }

    fn slot_mut(&mut self, env: usize) -> Result<&mut Slot, VectorError> {
        let envs = self.len();
        let place = self.slots.get_mut(env).ok_or(VectorError::Unknown { env, envs })?;
        place.as_deref_mut().ok_or(VectorError::InFlight { env })
    }
}
