//! The way from the senses to the observation: the transforms of each sense, in order.

use crate::config::{Compat, Config, Delays};
use crate::model::Model;
use crate::sensors::EYES;
use crate::sensors::transform::{Acuity, AcuityOptions, Delay, Foveation, Noise, Sense, Signal, Transform};
use crate::spaces::NumpyRng;

/// A transform, and whether the configuration asked for it.
#[derive(Clone)]
struct Stage {
    transform: Box<dyn Transform>,
    configured: bool,
}

/// The transforms of all senses.
#[derive(Clone, Default)]
pub(super) struct Pipeline {
    /// By sense, in the order of [`Sense::ALL`].
    chains: [Vec<Stage>; Sense::ALL.len()],
}

impl Pipeline {
    /// Sets up the transforms that a configuration asks for, of a sense whose signals have the size of `like`: acuity,
    /// foveation, noise, delay.
    pub fn configure(&mut self, model: &Model, config: &Config, sense: Sense, like: &Signal<'_>) {
        let mut add = |transform: Box<dyn Transform>| {
            let configured = true;
            self.chains[sense as usize].push(Stage { transform, configured });
        };
        if let &Signal::Eye { height, width, .. } = like {
            let eye = usize::from(sense == Sense::EyeRight);
            optics(model, config, eye, [height, width])
                .into_iter()
                .for_each(&mut add);
        }
        let (deviation, delay) = sense.noise_and_delay(config);
        if deviation > 0.0 {
            let noise = Noise::new(deviation);
            let magnitudes = matches!(like, Signal::Skin(values) if values.width() == 1);
            add(Box::new(if magnitudes { noise.of_magnitudes() } else { noise }));
        }
        let steps = effective(config, config.delays.of(delay));
        if steps > 0 {
            add(Box::new(Delay::new(steps, Delays::step_ms(config.frame_skip), like)));
        }
    }

    /// Returns whether a sense has transforms.
    pub fn changes(&self, sense: Sense) -> bool {
        !self.chains[sense as usize].is_empty()
    }

    /// Returns the transforms of a sense.
    pub fn of(&self, sense: Sense) -> impl Iterator<Item = &dyn Transform> {
        self.chains[sense as usize].iter().map(|stage| &*stage.transform)
    }

    /// Transforms what a sense reports.
    pub fn apply(&mut self, sense: Sense, mut signal: Signal<'_>, rng: &mut NumpyRng) {
        for stage in &mut self.chains[sense as usize] {
            stage.transform.apply(signal.reborrow(), rng);
        }
    }

    /// Appends a transform.
    pub fn add(&mut self, sense: Sense, transform: Box<dyn Transform>) {
        let configured = false;
        self.chains[sense as usize].push(Stage { transform, configured });
    }

    /// Takes over the transforms that were added to another, which the configuration did not ask for.
    pub fn take_added(&mut self, other: &mut Self) {
        for (own, others) in self.chains.iter_mut().zip(&mut other.chains) {
            let (configured, added) = std::mem::take(others).into_iter().partition(|stage| stage.configured);
            *others = configured;
            let added: Vec<Stage> = added;
            own.extend(added);
        }
    }

    /// Forgets the last episode.
    pub fn reset(&mut self) {
        self.stages_mut().for_each(|stage| stage.transform.reset());
    }

    /// Appends what the transforms remember.
    pub fn save(&self, out: &mut Vec<u8>) {
        let mut memory = Vec::new();
        for stage in self.chains.iter().flatten() {
            memory.clear();
            stage.transform.save(&mut memory);
            out.extend_from_slice(&(memory.len() as u64).to_le_bytes());
            out.extend_from_slice(&memory);
        }
    }

    /// Takes over what the same transforms saved, from the front of `bytes`; `false` if it is something else.
    pub fn load(&mut self, bytes: &mut &[u8]) -> bool {
        self.stages_mut().all(|stage| {
            let part = take_part(bytes);
            part.is_some_and(|part| stage.transform.load(part))
        })
    }

    /// Returns the memory of all transforms, bytes.
    pub fn memory(&self) -> usize {
        let stages = self.chains.iter().flatten();
        stages.map(|stage| stage.transform.memory()).sum()
    }

    fn stages_mut(&mut self) -> impl Iterator<Item = &mut Stage> {
        self.chains.iter_mut().flatten()
    }
}

/// Returns what a configuration's eye, 0 for the left and 1 for the right, makes of each image by itself: acuity, foveation.
pub(super) fn optics(
    model: &Model,
    config: &Config,
    eye: usize,
    [height, width]: [usize; 2],
) -> Vec<Box<dyn Transform>> {
    let mut transforms: Vec<Box<dyn Transform>> = Vec::new();
    if let (Some(age), Some(camera)) = (config.eyes.ages(config.age)[eye], model.camera(EYES[eye])) {
        let reference = config.compat == Compat::Reference;
        let fovy = model.cam_fovy[camera];
        let options = AcuityOptions { age, fovy, reference };
        transforms.push(Box::new(Acuity::new(options, height, width)));
    }
    let strength = config.eyes.strengths()[eye];
    if strength > 0.0 {
        transforms.push(Box::new(Foveation::new(strength, height, width)));
    }
    transforms
}

/// Takes a part behind its length from the front of bytes.
pub(super) fn take_part<'b>(bytes: &mut &'b [u8]) -> Option<&'b [u8]> {
    let (length, rest) = bytes.split_first_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let (part, rest) = rest.split_at_checked(length)?;
    *bytes = rest;
    Some(part)
}

/// Returns how many steps later something comes that a configuration delays. The code that `compat: reference` follows
/// takes the new value out of its list one step early.
pub(super) fn effective(config: &Config, delay: f64) -> usize {
    let steps = config.delays.steps(delay, config.frame_skip);
    match config.compat {
        Compat::Api => steps,
        Compat::Reference => steps.saturating_sub(1),
    }
}
