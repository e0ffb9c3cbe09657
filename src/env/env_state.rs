//! The state of an environment, most of which environments of a vector share.
//!
//! Most of a [`State`] is what every step computes anew: poses, inertias, contacts, constraint rows. If hundreds of environments took turns
//! with a whole state each, every turn would load another one into the caches, though programs rarely read it. An environment of a vector
//! therefore keeps only what decides how the run goes on, and works in a scratch state during a step or reset. A program that reads the rest
//! gets it computed once more, with the same bits, by the call that computed it and from what that call began with ([`LastEngineCall`]).
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

use std::sync::OnceLock;

use crate::env::engines::Engines;
use crate::physics::State;

/// What the last call of an engine began with, as far as the call, or a task after it, has changed it.
#[derive(Clone, Debug, Default)]
pub(in crate::env) struct LastEngineCall {
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
pub(in crate::env) enum EngineCall {
    /// There was none.
    #[default]
    None,
    Forward,
    Step,
}

impl LastEngineCall {
    /// Notes what a call begins with.
    pub fn note(&mut self, call: EngineCall, state: &State) {
        (self.call, self.time, self.step) = (call, state.time, state.step);
        self.qpos.clone_from(&state.qpos);
        self.qvel.clone_from(&state.qvel);
        self.act.clone_from(&state.act);
        self.qacc_warmstart.clone_from(&state.qacc_warmstart);
    }

    /// Makes the call once more. A state that is as the call left it then has the same computed quantities.
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
    /// A step, which goes on from the state.
    Step,
    /// A reset, which overwrites it.
    Reset,
}

/// The state of an environment.
pub(in crate::env) struct EnvState {
    /// The state: all of it in [`StateStorage::Whole`], what decides how the run goes on in [`StateStorage::Split`], nothing in
    /// [`StateStorage::Working`].
    kept: Box<State>,
    storage: StateStorage,
    /// Whether episodes begin in [`StateStorage::Split`].
    shares: bool,
    last_call: LastEngineCall,
}

/// Where the parts of a state are.
enum StateStorage {
    /// The environment keeps all of it.
    Whole,
    /// The environment keeps what decides how the run goes on. A program that reads the rest finds it here, computed again.
    Split(OnceLock<Box<State>>),
    /// A step or reset works in this scratch state.
    Working(Box<State>),
}

impl std::fmt::Debug for EnvState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.dynamic().fmt(f)
    }
}

impl EnvState {
    pub fn new(state: State) -> Self {
        Self {
            kept: state.into(),
            storage: StateStorage::Whole,
            shares: false,
            last_call: LastEngineCall::default(),
        }
    }

    /// Returns a copy, with a whole state.
    pub fn copy(&self, engines: &Engines) -> Self {
        match &self.storage {
            // computed for the copy alone, as the original may never be read
            StateStorage::Split(read) if read.get().is_none() => Self::new(*self.computed_again(engines)),
            _ => Self::new(self.get(engines).clone()),
        }
    }

    /// Returns the state.
    pub fn get(&self, engines: &Engines) -> &State {
        match &self.storage {
            StateStorage::Whole => &self.kept,
            StateStorage::Split(read) => read.get_or_init(|| self.computed_again(engines)),
            StateStorage::Working(scratch) => scratch,
        }
    }

    /// Returns the state, of which only what decides how the run goes on may be there.
    pub fn dynamic(&self) -> &State {
        match &self.storage {
            StateStorage::Whole | StateStorage::Split(_) => &self.kept,
            StateStorage::Working(scratch) => scratch,
        }
    }

    /// Returns the state, to change it, and where calls of engines are to be noted, if they are. Between steps the environment then keeps
    /// all of it until its next episode, as a program may change anything.
    pub fn parts(&mut self, engines: &Engines) -> (&mut State, Option<&mut LastEngineCall>) {
        self.keep_all(engines);
        match &mut self.storage {
            StateStorage::Working(scratch) => (scratch, Some(&mut self.last_call)),
            StateStorage::Whole | StateStorage::Split(_) => (&mut self.kept, None),
        }
    }

    /// Goes from [`StateStorage::Split`] to [`StateStorage::Whole`].
    fn keep_all(&mut self, engines: &Engines) {
        if let StateStorage::Split(read) = &mut self.storage {
            let read = read.take();
            self.kept = read.unwrap_or_else(|| self.computed_again(engines));
            self.storage = StateStorage::Whole;
        }
    }

    /// Lets steps and resets work in scratch states from now on. What is computed is dropped.
    pub fn share(&mut self) {
        self.kept.drop_computed();
        self.storage = StateStorage::Split(OnceLock::new());
        self.shares = true;
    }

    /// Returns whether steps and resets may work in scratch states.
    pub fn shares(&self) -> bool {
        self.shares
    }

    /// Takes a scratch state for a step or reset that begins with a call of an engine, if the environment shares. The computed part of the
    /// scratch state is unspecified.
    pub fn begin(&mut self, work: ScratchUse, engines: &Engines) {
        match (&self.storage, work) {
            (StateStorage::Split(read), ScratchUse::Step) if read.get().is_some() => self.keep_all(engines),
            (StateStorage::Split(_) | StateStorage::Whole, ScratchUse::Reset) if self.shares => self.share(),
            _ => {}
        }
        if let StateStorage::Split(_) = self.storage {
            let mut scratch = engines.take_state();
            scratch.swap_dynamic(&mut self.kept);
            self.storage = StateStorage::Working(scratch);
        }
    }

    /// Gives the scratch state back, if there is one.
    pub fn end(&mut self, engines: &Engines) {
        if let StateStorage::Working(scratch) = &mut self.storage {
            scratch.swap_dynamic(&mut self.kept);
            if let StateStorage::Working(scratch) =
                std::mem::replace(&mut self.storage, StateStorage::Split(OnceLock::new()))
            {
                engines.put_state(scratch);
            }
        }
    }

    fn computed_again(&self, engines: &Engines) -> Box<State> {
        let dynamic = self.dynamic();
        let mut state = engines.reader().new_state();
        state.copy_dynamic_from(dynamic);
        self.last_call.repeat(engines, &mut state);
        state.copy_dynamic_from(dynamic);
        state.into()
    }

    /// Returns the name of a computed quantity of the scratch state that a reader would get with other bits after the work, if there is one.
    /// It computes all of them once more.
    pub fn unshareable(&self, engines: &Engines) -> Option<&'static str> {
        match &self.storage {
            StateStorage::Working(scratch) => difference(scratch, &self.computed_again(engines)),
            StateStorage::Whole | StateStorage::Split(_) => None,
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
