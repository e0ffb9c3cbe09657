//! Tables that the reflexes of all environments of a configuration share.

use super::motors::Motors;
use super::{Built, ReflexLoop, atnr, grasp, moro, rooting, stepping, stretch, vor};
use crate::actuation::{Actuation, ActuationError};
use crate::config::{Config, Reflex};
use crate::mimo::reflexes;
use crate::model::Model;

/// A loop with its gain, its delay and its place in the memory.
pub(super) struct PlacedLoop {
    pub reflex: Reflex,
    pub inner: Box<dyn ReflexLoop>,
    pub gain: f64,
    /// Physics steps from the one that is sensed to the one that is driven, at least 1.
    pub delay: usize,
}

/// The memory of a loop.
pub(super) struct LoopMemory<'a> {
    /// How strongly it acts, and the number of steps in which it did.
    pub counts: &'a mut [f64],
    /// The stimulus of this physics step. Until it is sensed, it is the oldest delayed stimulus.
    pub stimulus: &'a mut [f64],
    pub own: &'a mut [f64],
}

impl PlacedLoop {
    /// Returns the length of its memory.
    pub fn memory(&self) -> usize {
        2 + self.delay * self.inner.channels() + self.inner.memory()
    }

    /// Takes its memory in physics step `now` from the front of `rest`.
    fn split<'a>(&self, now: usize, rest: &mut &'a mut [f64]) -> LoopMemory<'a> {
        let (mine, others) = std::mem::take(rest).split_at_mut(self.memory());
        *rest = others;
        let (counts, mine) = mine.split_at_mut(2);
        let channels = self.inner.channels();
        let (line, own) = mine.split_at_mut(self.delay * channels);
        let at = now % self.delay * channels;
        let stimulus = &mut line[at..at + channels];
        LoopMemory { counts, stimulus, own }
    }
}

/// The loops of a configuration.
pub(crate) struct ReflexTables {
    loops: Vec<PlacedLoop>,
}

impl ReflexTables {
    /// Finds what the reflexes of a configuration need in a model; `None` without reflexes.
    ///
    /// # Errors
    /// Motors and sensors that the scene does not have.
    pub fn new(config: &Config, model: &Model, actuation: &dyn Actuation) -> Result<Option<Self>, ActuationError> {
        let set = config.reflexes.set;
        if set.is_empty() {
            return Ok(None);
        }
        let mut loops = Vec::new();
        for &reflex in Reflex::ALL {
            match build(reflex, config, &Motors::of(model, actuation, reflex)) {
                Ok(built) if set.contains(reflex) || set.follows_age() => {
                    loops.push(place(reflex, built, config, model))
                }
                Err(missing) if set.contains(reflex) => return Err(missing),
                // without a list, MIMo has the reflexes for which he has motors; one that his age has lost stays with a gain of 0, so
                // that observations have the same length at every age
                _ => {}
            }
        }
        Ok(Some(Self { loops }))
    }

    /// Calls `work` for each loop that has a gain, with its memory in physics step `now`.
    pub(super) fn each(&self, now: usize, mut memory: &mut [f64], mut work: impl FnMut(&PlacedLoop, LoopMemory<'_>)) {
        for placed in &self.loops {
            let own = placed.split(now, &mut memory);
            if placed.gain != 0.0 {
                work(placed, own);
            }
        }
    }

    /// Returns the loops, in the order of [`Reflex::ALL`].
    pub(super) fn loops(&self) -> &[PlacedLoop] {
        &self.loops
    }

    /// Returns the number of reflexes.
    pub fn len(&self) -> usize {
        self.loops.len()
    }

    /// Returns the reflexes, in order.
    pub fn reflexes(&self) -> impl Iterator<Item = Reflex> {
        self.loops.iter().map(|placed| placed.reflex)
    }

    /// Returns the length of the memory of all loops.
    pub(super) fn memory(&self) -> usize {
        1 + self.loops.iter().map(PlacedLoop::memory).sum::<usize>()
    }
}

/// The age of the original proportions, months.
const ORIGINAL: f64 = 18.0;

/// Gives a loop its gain and its delay.
fn place(reflex: Reflex, built: Built, config: &Config, model: &Model) -> PlacedLoop {
    let index = reflex as usize;
    let gains = own_gains(config);
    // a list names what is wanted at the original proportions, too
    let age = config.age.or(config.reflexes.set.follows_age().then_some(ORIGINAL));
    let ms = own_delays(config)[index].unwrap_or(reflexes::of(reflex).delay) - built.inside;
    PlacedLoop {
        reflex,
        inner: built.inner,
        gain: gains[index].unwrap_or_else(|| reflexes::gain(reflex, age)) * config.reflexes.gain,
        delay: ((ms / (1000.0 * model.opt.timestep)).round() as usize).max(1),
    }
}

/// Returns the gains that a configuration has instead of those of the age, in the order of [`Reflex::ALL`].
fn own_gains(config: &Config) -> [Option<f64>; Reflex::ALL.len()] {
    let g = &config.reflex_gains;
    [
        g.palmar_grasp,
        g.plantar_grasp,
        g.rooting,
        g.moro,
        g.atnr,
        g.stepping,
        g.vor,
        g.stretch,
    ]
}

/// Returns the delays that a configuration has instead of the reflexes' own, ms, in the order of [`Reflex::ALL`].
fn own_delays(config: &Config) -> [Option<f64>; Reflex::ALL.len()] {
    let d = &config.reflex_delays;
    [
        d.palmar_grasp,
        d.plantar_grasp,
        d.rooting,
        d.moro,
        d.atnr,
        d.stepping,
        d.vor,
        d.stretch,
    ]
}

/// Builds the loop of a reflex.
fn build(reflex: Reflex, config: &Config, motors: &Motors<'_>) -> Result<Built, ActuationError> {
    match reflex {
        Reflex::PalmarGrasp => grasp::palmar(motors),
        Reflex::PlantarGrasp => grasp::plantar(motors),
        Reflex::Rooting => rooting::build(motors),
        Reflex::Stepping => stepping::build(motors),
        Reflex::Moro => moro::build(config, motors),
        Reflex::Atnr => atnr::build(config, motors),
        Reflex::Vor => vor::build(config, motors),
        Reflex::Stretch => stretch::build(config, motors),
    }
}
