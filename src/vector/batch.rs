//! The results of a step of a vector.

use super::Infos;
use crate::env::{EnvError, Observation};

/// The results of a step, a reset or [`VectorEnv::recv`](super::VectorEnv::recv): arrays with a row for each environment.
/// They belong to the vector and change with the next call.
#[derive(Clone, Copy, Debug)]
pub struct VectorStep<'a> {
    /// The environment of each row (rows).
    pub ids: &'a [usize],
    /// Observations: every sense is an array of rows, (rows, len).
    pub observation: Observation<'a>,
    /// Rewards (rows); 0 for BabyBench's behaviors, which have no extrinsic reward.
    pub rewards: &'a [f64],
    /// Whether the task has succeeded or failed (rows); false for BabyBench's behaviors.
    pub terminated: &'a [bool],
    /// Whether the episode has reached `max_episode_steps`, or has diverged (rows).
    pub truncated: &'a [bool],
    /// Information.
    pub infos: Infos<'a>,
    /// The ends of the episodes that ended in this step, with [`AutoresetMode::SameStep`](super::AutoresetMode).
    pub finals: Option<EpisodeEndRows<'a>>,
    /// The environments that could not continue, usually because the simulation diverged, in ascending order. Their rows hold the previous
    /// observation, and `truncated` is set. The mode decides when they are reset.
    pub failures: &'a [EnvFailure],
}

impl<'a> VectorStep<'a> {
    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Returns whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Returns the observation of a row, if there is one.
    pub fn row(&self, row: usize) -> Option<Observation<'a>> {
        (row < self.len()).then(|| self.observation.row(row, self.len()))
    }
}

/// The ends of episodes, in the rows of the environments whose episode ended.
#[derive(Clone, Copy, Debug)]
pub struct EpisodeEndRows<'a> {
    /// Whether each row holds the end of an episode (rows).
    pub ended: &'a [bool],
    /// The last observations; every sense is an array of rows, (rows, len).
    pub observation: Observation<'a>,
    /// The last information.
    pub infos: Infos<'a>,
}

impl<'a> EpisodeEndRows<'a> {
    /// Returns the last observation of a row's episode, if the row exists and the episode has ended.
    pub fn row(&self, row: usize) -> Option<Observation<'a>> {
        let ended = self.ended.get(row).copied().unwrap_or(false);
        ended.then(|| self.observation.row(row, self.ended.len()))
    }
}

/// An environment that could not continue.
#[derive(Debug)]
pub struct EnvFailure {
    /// The environment.
    pub env: usize,
    /// The reason.
    pub error: EnvError,
}
