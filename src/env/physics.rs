//! The physics of an environment: its state, the engines that advance it, and the parameters that a reset restores.
//!
//! Every step recomputes most of a [`State`]: poses, inertias, contacts, constraint rows. If hundreds of environments took turns with a
//! whole state each, every turn would load another one into the caches, though programs rarely read it. An environment of a vector therefore
//! keeps only its dynamic state, which determines the rest of the run, and works in a scratch state during a step or reset. If a program
//! reads the rest, the last engine call is repeated from the same start ([`LastEngineCall`]), with the same bits.
//!
//! Transitions of [`StateStorage`]:
//!
//! ```text
//!            share (a new environment)        begin                       end
//!   Whole ---------------------------> Split -------> Working (a step) -------> Split
//!                                      Split          read: computes the rest and keeps it until the next step
//!   Whole <--------------------------- Split          change by a program: its computed quantities become the environment's own
//!   Whole <--------------------------- Split          begin of a step, if a program has read it: it is likely to read it again
//!   Whole ---------------------------> Working        begin of a reset, which overwrites the state
//! ```

use std::sync::{Arc, OnceLock};

use super::EnvError;
use super::engines::{EngineSource, Engines};
use crate::mimo::{LockReport, LockTarget, lock, lock_of, unlock};
use crate::model::Model;
use crate::physics::{Engine, EngineError, Params, Shared, State};

/// The fields that the last engine call, or a task after it, has changed, with their values before the call.
#[derive(Clone, Debug, Default)]
pub(crate) struct LastEngineCall {
    call: EngineCall,
    time: f64,
    step: u64,
    qpos: Vec<f64>,
    qvel: Vec<f64>,
    act: Vec<f64>,
    qacc_warmstart: Vec<f64>,
}

/// A call of an engine.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum EngineCall {
    /// No call yet.
    #[default]
    None,
    Forward,
    Step,
}

impl LastEngineCall {
    /// Records the inputs of a call.
    pub fn note(&mut self, call: EngineCall, state: &State) {
        (self.call, self.time, self.step) = (call, state.time, state.step);
        self.qpos.clone_from(&state.qpos);
        self.qvel.clone_from(&state.qvel);
        self.act.clone_from(&state.act);
        self.qacc_warmstart.clone_from(&state.qacc_warmstart);
    }

    /// Repeats the call. If the state has not changed since the call, its computed quantities come out the same.
    fn repeat(&self, engines: &Engines, state: &mut State) {
        if let EngineCall::None = self.call {
            return;
        }
        (state.time, state.step) = (self.time, self.step);
        state.qpos.clone_from(&self.qpos);
        state.qvel.clone_from(&self.qvel);
        state.act.clone_from(&self.act);
        state.qacc_warmstart.clone_from(&self.qacc_warmstart);
        // a scene that diverged diverges again, which the first call reported
        let _ = engines.lend(|engine| match self.call {
            EngineCall::Step => engine.step(state),
            EngineCall::None | EngineCall::Forward => engine.forward(state),
        });
    }
}

/// The work for which an environment of a vector gets a scratch state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ScratchUse {
    /// A step, which continues from the state.
    Step,
    /// A reset, which overwrites it.
    Reset,
}

/// The state of a scene and the engines that advance it.
pub(crate) struct Physics {
    /// The engines that all environments of the blueprint share.
    engines: Arc<Engines>,
    /// The environment's own engine, created on a program's request.
    own: Option<Box<dyn Engine>>,
    /// All of the state in [`StateStorage::Whole`], its dynamic part in [`StateStorage::Split`], nothing in [`StateStorage::Working`].
    kept: Box<State>,
    storage: StateStorage,
    /// Whether episodes begin in [`StateStorage::Split`].
    shares: bool,
    last_call: LastEngineCall,
    /// Parameters after a reset: the blueprint's, with the changes by locks and unlocks.
    pub base: Shared<Params>,
}

/// The storage of a state's parts.
enum StateStorage {
    /// The environment keeps all of it.
    Whole,
    /// The environment keeps the dynamic state. The rest is recomputed into this cell when a program reads it.
    Split(OnceLock<Box<State>>),
    /// A step or reset works in this scratch state.
    Working(Box<State>),
}

impl std::fmt::Debug for Physics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Physics")
            .field("state", self.dynamic())
            .finish_non_exhaustive()
    }
}

/// A copy has a whole state. It shares the engines, whose memory does not influence later steps.
impl Clone for Physics {
    fn clone(&self) -> Self {
        let kept = match &self.storage {
            // computed for the copy alone, because the original may never be read
            StateStorage::Split(read) if read.get().is_none() => self.computed_again(),
            _ => self.state().clone().into(),
        };
        Self {
            engines: self.engines.clone(),
            own: None,
            kept,
            storage: StateStorage::Whole,
            shares: false,
            last_call: LastEngineCall::default(),
            base: self.base.clone(),
        }
    }
}

impl Physics {
    /// Starts with a state, whose parameters are those after a reset.
    pub fn new(engines: Arc<Engines>, state: State) -> Self {
        Self {
            engines,
            own: None,
            base: state.params.clone(),
            kept: state.into(),
            storage: StateStorage::Whole,
            shares: false,
            last_call: LastEngineCall::default(),
        }
    }

    /// Returns the state.
    pub fn state(&self) -> &State {
        match &self.storage {
            StateStorage::Whole => &self.kept,
            StateStorage::Split(read) => read.get_or_init(|| self.computed_again()),
            StateStorage::Working(scratch) => scratch,
        }
    }

    /// Returns the state. Only its dynamic part is valid in every kind of storage.
    pub fn dynamic(&self) -> &State {
        match &self.storage {
            StateStorage::Whole | StateStorage::Split(_) => &self.kept,
            StateStorage::Working(scratch) => scratch,
        }
    }

    /// Returns the state, to change it.
    pub fn state_mut(&mut self) -> &mut State {
        self.parts().1
    }

    /// Returns the source of engines for steps, the state that they advance, the record of their calls, if there is one, and the
    /// parameters of a reset. Between steps the environment then keeps all of the state until its next episode, because a program may
    /// change anything.
    pub fn parts(
        &mut self,
    ) -> (
        EngineSource<'_>,
        &mut State,
        Option<&mut LastEngineCall>,
        &mut Shared<Params>,
    ) {
        self.keep_all();
        let source = match &mut self.own {
            Some(own) => EngineSource::Own(&mut **own),
            None => EngineSource::Shared(&self.engines),
        };
        match &mut self.storage {
            StateStorage::Working(scratch) => (source, scratch, Some(&mut self.last_call), &mut self.base),
            // a whole state is never recomputed, so its calls need no record
            StateStorage::Whole | StateStorage::Split(_) => (source, &mut self.kept, None, &mut self.base),
        }
    }

    /// Switches from [`StateStorage::Split`] to [`StateStorage::Whole`].
    fn keep_all(&mut self) {
        if let StateStorage::Split(read) = &mut self.storage {
            let read = read.take();
            self.kept = read.unwrap_or_else(|| self.computed_again());
            self.storage = StateStorage::Whole;
        }
    }

    /// From now on, steps and resets work in scratch states. Drops the computed quantities.
    pub fn share(&mut self) {
        self.kept.drop_computed();
        self.storage = StateStorage::Split(OnceLock::new());
        self.shares = true;
    }

    /// Returns whether steps and resets may work in scratch states.
    pub fn shares(&self) -> bool {
        self.shares
    }

    /// Takes a scratch state for a step or reset that begins with a call of an engine, if the environment shares memory. The computed part of the
    /// scratch state is unspecified.
    pub fn begin(&mut self, work: ScratchUse) {
        match (&self.storage, work) {
            // a program that has read the state may read it after every step, and recomputing costs a physics step each time
            (StateStorage::Split(read), ScratchUse::Step) if read.get().is_some() => self.keep_all(),
            (StateStorage::Split(_) | StateStorage::Whole, ScratchUse::Reset) if self.shares => self.share(),
            _ => {}
        }
        if let StateStorage::Split(_) = self.storage {
            let mut scratch = self.engines.take_state();
            scratch.swap_dynamic(&mut self.kept);
            self.storage = StateStorage::Working(scratch);
        }
    }

    /// Returns the scratch state to the pool, if there is one.
    pub fn end(&mut self) {
        if let StateStorage::Working(scratch) = &mut self.storage {
            scratch.swap_dynamic(&mut self.kept);
            if let StateStorage::Working(scratch) =
                std::mem::replace(&mut self.storage, StateStorage::Split(OnceLock::new()))
            {
                self.engines.put_state(scratch);
            }
        }
    }

    fn computed_again(&self) -> Box<State> {
        let dynamic = self.dynamic();
        let mut state = self.engines.reader().new_state();
        state.copy_dynamic_from(dynamic);
        self.last_call.repeat(&self.engines, &mut state);
        // again, because the call has advanced the state and a task may have moved it afterwards
        state.copy_dynamic_from(dynamic);
        state.into()
    }

    /// Recomputes all computed quantities. Returns the name of one that differs from the scratch state, if any: a reader would get other
    /// bits after the work.
    pub fn unshareable(&self) -> Option<&'static str> {
        match &self.storage {
            StateStorage::Working(scratch) => difference(scratch, &self.computed_again()),
            StateStorage::Whole | StateStorage::Split(_) => None,
        }
    }

    /// Returns an engine that answers questions about the model.
    pub fn reader(&self) -> &dyn Engine {
        self.own.as_deref().unwrap_or_else(|| self.engines.reader())
    }

    /// Returns the environment's own engine, with which it steps from now on.
    pub fn own_engine(&mut self) -> &mut dyn Engine {
        self.keep_all();
        &mut **self.own.get_or_insert_with(|| self.engines.make())
    }

    /// Switches to the engines of another model of the same sizes.
    pub fn use_engines(&mut self, engines: &Arc<Engines>) {
        // the new engines would compute quantities that differ from those stored
        self.keep_all();
        self.engines = engines.clone();
        if let Some(own) = &mut self.own {
            *own = self.engines.make();
        }
    }

    /// Computes everything that follows from the state.
    pub fn forward(&mut self) -> Result<(), EngineError> {
        let (mut engine, state, last_call, _) = self.parts();
        if let Some(last_call) = last_call {
            last_call.note(EngineCall::Forward, state);
        }
        engine.lend(|engine| engine.forward(state))
    }

    /// Checks that the vectors of the state, which programs may change, still fit the model.
    pub fn check_shape(&self) -> Result<(), EngineError> {
        self.reader().check_shape(self.state())
    }

    /// Locks joints now and for later episodes.
    pub fn lock(&mut self, model: &Model, target: LockTarget<'_>, angle: f64) -> Result<LockReport, EnvError> {
        self.check_shape()?;
        let report = lock(model, &mut self.state_mut().params, target, angle)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    /// Unlocks joints now and for later episodes.
    pub fn unlock(&mut self, model: &Model, target: LockTarget<'_>) -> Result<LockReport, EnvError> {
        self.check_shape()?;
        let report = unlock(model, &mut self.state_mut().params, target)?;
        self.keep_locks(model, &report);
        Ok(report)
    }

    fn keep_locks(&mut self, model: &Model, report: &LockReport) {
        let now = self.dynamic().params.clone();
        // only the locks, because a reset undoes other changes of the parameters
        for e in report.changed.iter().filter_map(|&j| lock_of(model, j)) {
            self.base.eq_active[e] = now.eq_active[e];
            self.base.eq_offset[e] = now.eq_offset[e];
        }
    }
}

/// Returns the first quantity that differs between two states.
fn difference(left: &State, right: &State) -> Option<&'static str> {
    macro_rules! compare {
        ($($field:ident)*) => {
            $(if left.$field != right.$field {
                return Some(stringify!($field));
            })*
        };
    }
    compare!(xpos xmat xipos ximat geom_xpos geom_xmat site_xpos site_xmat cam_xpos cam_xmat subtree_com xanchor xaxis cinert);
    compare!(ten_length actuator_length cvel ten_velocity actuator_velocity qfrc_bias qfrc_passive qfrc_gravcomp);
    compare!(act_dot actuator_force qfrc_actuator qfrc_smooth qacc_smooth contact qfrc_constraint qacc);
    compare!(cacc cfrc_ext cfrc_int sensordata);
    None
}
