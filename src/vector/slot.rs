//! A slot of the vector: an environment, its next command, and the outcome.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::layout::RowLayout;
use super::rows::VectorRows;
use super::{AutoresetMode, make};
use crate::env::{BehaviorInfo, Env, EnvError, Info, Observation, PerHand, ScratchUse, draw_eyes};
use crate::threads::Job;

/// The next command of an environment.
#[derive(Clone, Copy, Debug)]
pub(super) enum Command {
    /// Apply [`Slot::action`], or start the next episode if the mode says so.
    Step,
    /// Start an episode, with or without a seed.
    Reset(Option<u64>),
    /// Draw the eyes, if their picture has not been drawn yet.
    Look,
}

/// An environment that moves between the vector and the threads.
pub(super) struct Slot {
    pub index: usize,
    pub env: Env,
    pub order: Command,
    pub action: Vec<f32>,
    pub mode: AutoresetMode,
    /// The number of the last call of `send` that named the environment.
    pub named: u64,
    /// Whether the environment has been reset.
    pub started: bool,
    pub reward: f64,
    pub terminated: bool,
    pub truncated: bool,
    /// Whether [`Slot::last`] belongs to an episode that ended in the last step.
    pub ended: bool,
    pub last: Option<LastEpisode>,
    /// The error of the last step or reset.
    pub failure: Option<EnvError>,
    /// The message of the panic that broke the environment.
    pub panicked: Option<String>,
}

impl Job for Slot {
    fn run(&mut self) {
        if let Err(payload) = catch_unwind(AssertUnwindSafe(|| self.perform())) {
            self.panicked = Some(message(&*payload));
        }
    }
}

impl Slot {
    pub fn new(index: usize, env: Env, mode: AutoresetMode) -> Self {
        let action = Vec::with_capacity(env.action_space().len());
        let last = (mode == AutoresetMode::SameStep).then(|| LastEpisode::new(&env));
        Self {
            index,
            env,
            order: Command::Reset(None),
            action,
            mode,
            named: 0,
            started: false,
            reward: 0.0,
            terminated: false,
            truncated: false,
            ended: false,
            last,
            failure: None,
            panicked: None,
        }
    }

    /// Returns whether the episode is over, in which case a step is a reset or an error.
    pub fn over(&self) -> bool {
        !self.env.ready() || self.env.over()
    }

    /// Returns whether a step is valid.
    pub fn can_step(&self) -> bool {
        let resets = self.started && self.mode != AutoresetMode::Disabled;
        self.panicked.is_none() && (self.env.ready() || resets)
    }

    fn perform(&mut self) {
        if !matches!(self.order, Command::Look) {
            // reading leaves the results of the last step unchanged
            (self.reward, self.terminated, self.truncated) = (0.0, false, false);
            (self.ended, self.failure) = (false, None);
        }
        match self.order {
            Command::Reset(seed) => {
                if let Err(e) = self.revive() {
                    self.failure = Some(e);
                } else {
                    self.reset(seed);
                }
            }
            Command::Step if self.mode != AutoresetMode::Disabled && self.over() => self.reset(None),
            Command::Step => self.step(),
            Command::Look => self.failure = self.env.senses_mut().look().err(),
        }
    }

    /// Steps the environment in the thread's memory, which is still in the caches from the previous environment.
    fn step(&mut self) {
        let mut env = self.env.work(ScratchUse::Step);
        match env.step(&self.action) {
            Ok(step) => (self.reward, self.terminated, self.truncated) = (step.reward, step.terminated, step.truncated),
            Err(e) => {
                self.failure = Some(e);
                self.truncated = true;
            }
        }
        if self.mode == AutoresetMode::SameStep && (self.terminated || self.truncated) {
            if let Err(e) = draw_last(&mut env) {
                self.failure.get_or_insert(e);
            }
            if let Some(last) = &mut self.last {
                last.keep(&env);
                self.ended = true;
            }
            drop(env);
            self.reset(None);
        }
    }

    /// Resets the environment in the thread's memory.
    fn reset(&mut self, seed: Option<u64>) {
        self.started = true;
        // before the environment works in the memory of the thread, which is that of a body
        if let Err(e) = self.env.grow() {
            self.failure.get_or_insert(e);
            self.env.by_hand().end_episode();
            return;
        }
        let copy = self.env.before_reset();
        let mut env = self.env.work(ScratchUse::Reset);
        let reset = env.reset(seed).map(drop).and_then(|()| env.check_reset(copy, seed));
        if let Err(e) = reset {
            self.failure.get_or_insert(e);
        }
    }

    /// Rebuilds an environment after a panic, because its state may be inconsistent.
    fn revive(&mut self) -> Result<(), EnvError> {
        if self.panicked.is_some() {
            let deferred = self.env.senses().vision_is_deferred();
            let life = self.env.lifetime_steps();
            self.env = make(self.env.blueprint())?;
            self.env.set_earlier_steps(life);
            self.env.senses_mut().defer_vision(deferred);
            self.panicked = None;
        }
        Ok(())
    }
}

/// Draws the environment's last view, if that has not been done yet, while other environments are still running.
fn draw_last(env: &mut Env) -> Result<(), EnvError> {
    let senses = env.senses();
    let waits = senses.vision_is_deferred() || senses.vision_is_lazy();
    if waits && env.ready() { draw_eyes([env]) } else { Ok(()) }
}

/// The end of an episode.
pub(super) struct LastEpisode {
    pub info: Info,
    /// The observation, in a row.
    rows: VectorRows,
    pub terms: Vec<f64>,
}

impl LastEpisode {
    fn new(env: &Env) -> Self {
        let mut last = Self {
            info: Info::default(),
            rows: VectorRows::new(1, RowLayout::new([env])),
            terms: vec![0.0; env.goal().terms.len()],
        };
        last.keep(env);
        last
    }

    fn keep(&mut self, env: &Env) {
        self.rows.buffers().write(0, env);
        self.terms.copy_from_slice(env.goal().terms);
        copy_info(env.info(), &mut self.info);
    }

    /// Returns the last observation.
    pub fn observation(&self) -> Observation<'_> {
        self.rows.observation(1, true)
    }
}

/// Copies information into an allocation with the original's capacity.
fn copy_info(from: &Info, to: &mut Info) {
    to.steps = from.steps;
    match (&from.behavior, &mut to.behavior) {
        (BehaviorInfo::SelfTouch { touches }, BehaviorInfo::SelfTouch { touches: copies }) => {
            copy_lists(touches, copies);
        }
        (BehaviorInfo::SelfTouch { touches }, behavior) => {
            let mut copies = PerHand::default();
            copy_lists(touches, &mut copies);
            *behavior = BehaviorInfo::SelfTouch { touches: copies };
        }
        (other, behavior) => *behavior = other.clone(),
    }
    to.details.gaze_angles = from.details.gaze_angles;
    to.details.vision_age = from.details.vision_age;
    to.details.age = from.details.age;
    to.details.reflexes = from.details.reflexes;
    to.details.regards = from.details.regards;
    match &from.details.touched_parts {
        Some(parts) => copy_lists(parts, to.details.touched_parts.get_or_insert_default()),
        None => to.details.touched_parts = None,
    }
}

fn copy_lists<T: Clone>(from: &PerHand<Vec<T>>, to: &mut PerHand<Vec<T>>) {
    for (from, to) in from.each_ref().into_iter().zip(to.each_mut()) {
        to.clear();
        to.reserve(from.capacity());
        to.extend_from_slice(from);
    }
}

/// Returns the message of a panic.
fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no message").to_string()
}
