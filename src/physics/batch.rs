//! Many states of one model, stepped together.

use std::sync::Arc;

use thiserror::Error;

use crate::engine::Engine;
use crate::error::EngineError;
use crate::model::Model;
use crate::soft::{SoftEngine, SoftModel, SoftOptions};
use crate::state::State;

/// An error in stepping one state of a batch. That state is left as after its failed step. All other states were stepped.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("state {index} of the batch: {source}")]
pub struct BatchError {
    /// Index of the state, of the first one if there are several.
    pub index: usize,
    /// The error of its step.
    pub source: EngineError,
}

/// Many states of one model that are stepped together, for searches and controllers (MPPI, the cross-entropy method, tree search).
///
/// One engine steps all of them, and stays in the cache of its core. `mjcf_sim::rollout_on` steps them on threads, each with its own
/// engine. Each state gets the bits that it would get alone, for any number of states and threads. After a first [`Batch::rollout`]
/// nothing is allocated.
///
/// ```
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::physics::{Batch, SoftOptions, compile};
///
/// let text = "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1' pos='1 0 0'/></body></worldbody>
///   <actuator><motor joint='hinge'/></actuator></mujoco>";
/// let model = compile(mjcf_sim::mjcf_loader::load_str(text, "arm.xml", &MemoryAssets::new())?)?;
/// let mut batch = Batch::new(model.into(), SoftOptions::default(), 64);
///
/// // where does the arm end that is driven with -1 to 1 Nm for 50 steps, from here?
/// let here = batch.states()[0].clone();
/// batch.fork(&here);
/// batch.rollout(50, |index, _step, state| state.ctrl[0] = index as f64 / 31.5 - 1.0)?;
/// let best = (0..64).max_by(|&a, &b| batch.states()[a].qpos[0].total_cmp(&batch.states()[b].qpos[0]));
/// assert_eq!(best, Some(63));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Batch {
    shared: SoftModel,
    engines: Vec<SoftEngine>,
    states: Vec<State>,
}

impl Batch {
    /// Makes `count` states at `qpos0`, at rest.
    pub fn new(model: Arc<Model>, options: SoftOptions, count: usize) -> Self {
        let shared = SoftModel::new(model, options);
        let engine = shared.engine();
        Self {
            states: (0..count).map(|_| engine.new_state()).collect(),
            engines: vec![engine],
            shared,
        }
    }

    /// Returns the model.
    pub fn model(&self) -> &Arc<Model> {
        self.engines[0].model()
    }

    /// Returns the states.
    pub fn states(&self) -> &[State] {
        &self.states
    }

    /// Returns the states, to change their dynamic fields.
    pub fn states_mut(&mut self) -> &mut [State] {
        &mut self.states
    }

    /// Sets the dynamic fields of all states to those of another state of this model: time, positions, velocities, activations, controls, forces, warm start
    /// and parameters. Computed quantities stay those of the last step until the next one.
    pub fn fork(&mut self, from: &State) {
        for state in &mut self.states {
            state.copy_dynamic_from(from);
        }
    }

    /// Sets the dynamic fields of one state of the batch to those of another, for resampling.
    pub fn copy(&mut self, from: usize, to: usize) {
        if let Ok([from, to]) = self.states.get_disjoint_mut([from, to]) {
            to.copy_dynamic_from(from);
        }
    }

    /// Steps every state once.
    ///
    /// # Errors
    /// As [`Batch::rollout`].
    pub fn step(&mut self) -> Result<(), BatchError> {
        self.rollout(1, |_, _, _| {})
    }

    /// Steps every state `steps` times. Before each step of a state `control` is called with its index, the number of the step, and the state.
    /// Afterwards, sensors, contacts and poses are those at the start of the last step; [`Engine::forward`](crate::Engine::forward) computes those at
    /// its end.
    ///
    /// # Errors
    /// The first state that could not be stepped, which `control` has made unfit or which diverges; the others were stepped to the end.
    pub fn rollout(&mut self, steps: usize, control: impl FnMut(usize, usize, &mut State)) -> Result<(), BatchError> {
        self.split(1)
            .next()
            .map_or(Ok(()), |mut all| all.rollout(steps, control))
    }

    /// Splits the batch into at most `parts` runs of consecutive states, of nearly equal length, each with its own engine, for the caller's threads.
    /// A batch without states has no parts. `mjcf_sim::rollout_on` starts threads itself.
    pub fn split(&mut self, parts: usize) -> impl Iterator<Item = BatchPart<'_>> {
        let parts = parts.clamp(1, self.states.len().max(1));
        let missing = parts.saturating_sub(self.engines.len());
        self.engines.extend((0..missing).map(|_| self.shared.engine()));
        let size = self.states.len().div_ceil(parts).max(1);
        let runs = self.engines.iter_mut().zip(self.states.chunks_mut(size));
        runs.enumerate().map(move |(k, (engine, states))| BatchPart {
            engine,
            first: k * size,
            states,
        })
    }
}

/// Consecutive states of a [`Batch`], with an engine, for a thread.
#[derive(Debug)]
pub struct BatchPart<'a> {
    engine: &'a mut SoftEngine,
    first: usize,
    states: &'a mut [State],
}

impl BatchPart<'_> {
    /// Steps the states of this part, as [`Batch::rollout`] steps all; indices are those of the batch.
    ///
    /// # Errors
    /// As [`Batch::rollout`].
    pub fn rollout(
        &mut self,
        steps: usize,
        mut control: impl FnMut(usize, usize, &mut State),
    ) -> Result<(), BatchError> {
        let mut failed = None;
        for (offset, state) in self.states.iter_mut().enumerate() {
            let index = self.first + offset;
            // all steps of a state before the next one: it stays in the cache
            let result = (0..steps).try_for_each(|step| {
                control(index, step, state);
                self.engine.step(state)
            });
            if let (Err(source), None) = (result, &failed) {
                failed = Some(BatchError { index, source });
            }
        }
        failed.map_or(Ok(()), Err)
    }
}
