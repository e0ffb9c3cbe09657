//! The state of an environment, which in a vector is whole only while a thread works on it.
//!
//! Most of a [`State`] is what every step computes anew: poses, inertias, contacts, constraint rows. Hundreds of environments that take
//! turns would each drag theirs through the caches, though hardly anybody ever looks. An environment of a vector therefore borrows that
//! part for the time of a step or reset, and keeps what decides how the run goes on. Whoever wants to read the rest gets it computed once
//! more, to the same bits, by the call that computed it, from what that began with ([`Origin`]).

use std::sync::OnceLock;

use crate::env::engines::Engines;
use crate::physics::State;

/// What the last call of an engine began with, as far as the call, or a task after it, has changed it.
#[derive(Clone, Debug, Default)]
pub(in crate::env) struct Origin {
    call: Call,
    time: f64,
    step: u64,
    qpos: Vec<f64>,
    qvel: Vec<f64>,
    act: Vec<f64>,
    qacc_warmstart: Vec<f64>,
}

/// A call of an engine.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::env) enum Call {
    /// There was none.
    #[default]
    None,
    Forward,
    Step,
}

impl Origin {
    /// Notes what a call begins with.
    pub fn note(&mut self, call: Call, state: &State) {
        (self.call, self.time, self.step) = (call, state.time, state.step);
        self.qpos.clone_from(&state.qpos);
        self.qvel.clone_from(&state.qvel);
        self.act.clone_from(&state.act);
        self.qacc_warmstart.clone_from(&state.qacc_warmstart);
    }

    /// Makes the call once more. A state that is as it was left then has the same quantities computed after it.
    fn call_again(&self, engines: &Engines, state: &mut State) {
        if let Call::None = self.call {
            return;
        }
        (state.time, state.step) = (self.time, self.step);
        state.qpos.clone_from(&self.qpos);
        state.qvel.clone_from(&self.qvel);
        state.act.clone_from(&self.act);
        state.qacc_warmstart.clone_from(&self.qacc_warmstart);
        // if the scene diverged it does so again, and whoever made the call was told
        let _ = engines.lend(|engine| match self.call {
            Call::Step => engine.step(state),
            Call::None | Call::Forward => engine.forward(state),
        });
    }
}

/// The state of an environment.
pub(in crate::env) struct Held {
    own: Box<State>,
    /// The state that steps work in at the moment, if they borrow; what decides how the run goes on is then in it.
    borrowed: Option<Box<State>>,
    /// Whether steps borrow at the moment: `own` then has no room for what is computed.
    borrows: bool,
    /// Whether episodes begin with that.
    may_borrow: bool,
    /// The whole state, for a reader between steps that borrow.
    read: OnceLock<Box<State>>,
    origin: Origin,
}

impl std::fmt::Debug for Held {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.dynamic().fmt(f)
    }
}

impl Held {
    pub fn new(state: State) -> Self {
        Self {
            own: state.into(),
            borrowed: None,
            borrows: false,
            may_borrow: false,
            read: OnceLock::new(),
            origin: Origin::default(),
        }
    }

    /// Returns a copy, with a state of its own.
    pub fn copy(&self, engines: &Engines) -> Self {
        if self.borrows && self.borrowed.is_none() && self.read.get().is_none() {
            // nobody reads this one: it goes on borrowing
            return Self::new(*self.computed_again(engines));
        }
        Self::new(self.get(engines).clone())
    }

    /// Returns the state.
    pub fn get(&self, engines: &Engines) -> &State {
        match &self.borrowed {
            Some(state) => state,
            None if self.borrows => self.read.get_or_init(|| self.computed_again(engines)),
            None => &self.own,
        }
    }

    /// Returns the state, of which only what decides how the run goes on may be there.
    pub fn dynamic(&self) -> &State {
        self.borrowed.as_ref().unwrap_or(&self.own)
    }

    /// Returns the state, to change it, and where calls of engines are to be noted, if they are. Between steps that borrow it means the
    /// end of borrowing in this episode: what a program changes may be anything.
    pub fn parts(&mut self, engines: &Engines) -> (&mut State, Option<&mut Origin>) {
        if self.borrowed.is_none() {
            self.own_all(engines);
        }
        match &mut self.borrowed {
            Some(state) => (state, Some(&mut self.origin)),
            None => (&mut self.own, None),
        }
    }

    /// Goes on with a whole state of its own.
    fn own_all(&mut self, engines: &Engines) {
        if self.borrows {
            self.own = self.read.take().unwrap_or_else(|| self.computed_again(engines));
            self.borrows = false;
        }
    }

    /// Lets steps borrow from now on: for a state of which nothing is computed yet.
    pub fn start_borrowing(&mut self) {
        self.own.drop_computed();
        (self.borrows, self.may_borrow) = (true, true);
    }

    /// Returns whether steps borrow, if nobody has looked into the state since the episode began.
    pub fn may_borrow(&self) -> bool {
        self.may_borrow
    }

    /// Borrows the room for what is computed, if steps do: for work that begins with a call of an engine, or makes none.
    ///
    /// Somebody who has read the state is likely to read it again: the environment then keeps what it has until the episode ends.
    pub fn borrow(&mut self, engines: &Engines) {
        if self.read.get().is_some() {
            self.own_all(engines);
        }
        if self.borrows {
            let mut state = engines.take_state();
            state.swap_dynamic(&mut self.own);
            self.borrowed = Some(state);
        }
    }

    /// Borrows, even where somebody has looked into the state: for a reset, after which nothing is as it was.
    pub fn borrow_for_reset(&mut self, engines: &Engines) {
        if self.may_borrow && self.borrowed.is_none() {
            self.read.take();
            self.start_borrowing();
            self.borrow(engines);
        }
    }

    /// Gives back what it has borrowed.
    pub fn give_back(&mut self, engines: &Engines) {
        if let Some(mut state) = self.borrowed.take() {
            state.swap_dynamic(&mut self.own);
            engines.put_state(state);
        }
    }

    fn computed_again(&self, engines: &Engines) -> Box<State> {
        let mut state = engines.reader().new_state();
        state.copy_dynamic_from(&self.own);
        self.origin.call_again(engines, &mut state);
        state.copy_dynamic_from(&self.own);
        state.into()
    }
}
