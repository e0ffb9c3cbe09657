//! Reflexes of infants: closed loops from senses to motors, between the action and the actuators.
//!
//! A loop reads a stimulus after each physics step and, after its delay, adds torques to what the action commands. The order of a physics
//! step is: stimuli of the past, commands, actuators, engine, stimuli of the present. Loops read nothing else of the computed part of a
//! state, so that states may share it in turn.
//!
//! The table of reflexes, with ages and sources, is `mimo::reflexes`; each reflex is described in the file of its name.

mod atnr;
mod contacts;
mod grasp;
mod moro;
mod motors;
mod rooting;
mod stepping;
mod stretch;
mod tables;
mod vor;

use std::sync::Arc;

use super::Actuation;
use crate::config::Reflex;
use crate::model::Model;
use crate::physics::State;
use crate::spaces::NumpyRng;

pub(crate) use tables::ReflexTables;

/// The command of the reflexes to an actuator in a physics step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorCommand {
    /// Torque on the joint, N m, in addition to that of the action.
    pub torque: f64,
    /// The share of the action's command that is suppressed, 0 to 1. At 1 the torque also replaces the springs of servos and the pull of stretched
    /// muscles.
    pub suppress: f64,
}

/// How strongly a reflex must act to be counted in the information.
const ACTIVE: f64 = 0.1;

/// A reflex as a loop from a stimulus to motors.
trait ReflexLoop: Send + Sync {
    /// Returns how many numbers the stimulus has.
    fn channels(&self) -> usize;

    /// Returns how many numbers the loop remembers besides delayed stimuli.
    fn memory(&self) -> usize;

    /// Writes the stimulus in a state after a physics step.
    fn sense(&self, model: &Model, state: &State, stimulus: &mut [f64]);

    /// Commands motors for the next physics step. Returns how strongly the reflex acts, 0 to 1.
    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64;
}

/// A loop and its delay, ms.
struct Built {
    inner: Box<dyn ReflexLoop>,
    /// Part of the delay that passes in the loop itself, ms.
    inside: f64,
}

/// The input of a loop.
struct LoopInput<'a> {
    /// The state before the physics step; only its positions, velocities and parameters are known.
    state: &'a State,
    /// The stimulus after the delay.
    stimulus: &'a [f64],
    memory: &'a mut [f64],
    /// 0 is none, 1 is full.
    gain: f64,
    /// Duration of a physics step, s.
    h: f64,
    rng: &'a mut NumpyRng,
}

impl LoopInput<'_> {
    /// Moves each remembered level towards the stimulus above a threshold, in widths, with the time constants `[rising, falling]`, s.
    fn follow_stimuli(&mut self, [threshold, width]: [f64; 2], times: [f64; 2]) {
        for (level, stimulus) in self.memory.iter_mut().zip(self.stimulus) {
            follow(level, ramp(*stimulus, threshold, width), times, self.h);
        }
    }
}

/// The reflexes of an environment: their shared tables and their memory.
#[derive(Clone)]
pub(crate) struct Reflexes {
    tables: Arc<ReflexTables>,
    /// The number of physics steps since the start of the episode; then, for each loop, how strongly it acts, the number of steps in
    /// which it did, delayed stimuli, and its own memory.
    memory: Vec<f64>,
    /// The action that reaches the actuators.
    action: Vec<f32>,
    commands: Vec<MotorCommand>,
}

impl Reflexes {
    /// Creates the reflexes with an empty memory.
    pub fn new(tables: Arc<ReflexTables>, actuation: &dyn Actuation) -> Self {
        Self {
            memory: vec![0.0; tables.memory()],
            action: vec![0.0; actuation.action_space().len()],
            commands: vec![MotorCommand::default(); actuation.actuators().len()],
            tables,
        }
    }

    /// Switches to the tables of a changed model, in which the same reflexes use the same memory.
    pub fn use_tables(&mut self, tables: &Arc<ReflexTables>) {
        self.tables.clone_from(tables);
    }

    /// Clears the memory, at the start of a reset.
    pub fn clear(&mut self) {
        self.memory.fill(0.0);
        self.action.fill(0.0);
    }

    /// Takes an action of the length of the action space for the next physics steps.
    pub fn take_action(&mut self, action: &[f32]) {
        self.action.copy_from_slice(action);
    }

    /// Drives the actuators for a physics step.
    pub fn drive(&mut self, model: &Model, state: &mut State, actuation: &dyn Actuation, rng: &mut NumpyRng) {
        self.commands.fill(MotorCommand::default());
        let (steps, memory) = self.memory.split_at_mut(1);
        let commands = &mut self.commands;
        self.tables.each(steps[0] as usize, memory, |placed, memory| {
            let mut input = LoopInput {
                state: &*state,
                stimulus: memory.stimulus,
                memory: memory.own,
                gain: placed.gain,
                h: model.opt.timestep,
                rng: &mut *rng,
            };
            memory.counts[0] = placed.inner.act(&mut input, commands).clamp(0.0, 1.0);
            memory.counts[1] += f64::from(u8::from(memory.counts[0] > ACTIVE));
        });
        actuation.drive(model, state, &self.action, &self.commands);
    }

    /// Senses a state after a physics step.
    pub fn sense(&mut self, model: &Model, state: &State) {
        let (steps, memory) = self.memory.split_at_mut(1);
        self.tables.each(steps[0] as usize, memory, |placed, memory| {
            placed.inner.sense(model, state, memory.stimulus);
        });
        steps[0] += 1.0;
    }

    /// Writes how strongly each reflex acts, 0 to 1.
    pub fn observe(&self, out: &mut [f64]) {
        let mut rest = &self.memory[1..];
        for (placed, out) in self.tables.loops().iter().zip(out) {
            *out = rest[0];
            rest = &rest[placed.memory()..];
        }
    }

    /// Returns the share of an episode's physics steps in which a reflex acted; `None` without that reflex.
    pub fn share(&self, reflex: Reflex) -> Option<f64> {
        let mut rest = &self.memory[1..];
        for placed in self.tables.loops() {
            if placed.reflex == reflex {
                return Some(rest[1] / self.memory[0].max(1.0));
            }
            rest = &rest[placed.memory()..];
        }
        None
    }

    /// Appends memory and action to a snapshot.
    pub fn save(&self, out: &mut Vec<u8>) {
        out.extend(self.memory.iter().flat_map(|v| v.to_le_bytes()));
        out.extend(self.action.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// Restores what was saved; `false`, with nothing changed, if the data do not fit.
    pub fn load(&mut self, bytes: &[u8]) -> bool {
        if bytes.len() != 8 * self.memory.len() + 4 * self.action.len() {
            return false;
        }
        let (memory, action) = bytes.split_at(8 * self.memory.len());
        let memory = memory.as_chunks::<8>().0.iter().map(|v| f64::from_le_bytes(*v));
        let action = action.as_chunks::<4>().0.iter().map(|v| f32::from_le_bytes(*v));
        // the first number becomes an index
        let counted = memory.clone().next().is_some_and(|steps| (0.0..1e15).contains(&steps));
        if !counted || !memory.clone().all(f64::is_finite) || !action.clone().all(f32::is_finite) {
            return false;
        }
        self.memory.iter_mut().zip(memory).for_each(|(to, from)| *to = from);
        self.action.iter_mut().zip(action).for_each(|(to, from)| *to = from);
        true
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        8 * self.memory.len() + 4 * self.action.len()
    }
}

/// Moves a level towards a target, with the time constants `[rising, falling]`, s.
fn follow(level: &mut f64, target: f64, [rise, fall]: [f64; 2], h: f64) {
    let constant = if target > *level { rise } else { fall };
    *level += (target - *level) * (h / constant).min(1.0);
}

/// Returns how far a number is above a threshold, in widths, from 0 to 1.
fn ramp(x: f64, threshold: f64, width: f64) -> f64 {
    ((x - threshold) / width).clamp(0.0, 1.0)
}
