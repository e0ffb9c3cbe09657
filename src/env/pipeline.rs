//! Pipelines from the senses to the observation: the transforms of each sense, in order.

use crate::config::{Compat, Config, Delays};
use crate::model::Model;
use crate::sensors::EYES;
use crate::sensors::transform::{Acuity, AcuityOptions, Delay, Foveation, Noise, SampleHold, Sense, Signal, Transform};
use crate::spaces::NumpyRng;

/// A transform, and whether it comes from the configuration.
#[derive(Clone)]
struct ConfiguredTransform {
    transform: Box<dyn Transform>,
    configured: bool,
}

impl ConfiguredTransform {
    /// Returns a transform that the configuration requests.
    fn configured(transform: Box<dyn Transform>) -> Self {
        let configured = true;
        Self { transform, configured }
    }
}

/// The transforms of a sense.
#[derive(Clone, Default)]
struct TransformChain {
    stages: Vec<ConfiguredTransform>,
    /// The number of leading stages that depend on the current values only: acuity, foveation.
    optics: usize,
    /// For a sense with its own rate: its last sample, after the leading stages. Later stages (a delay, and those that a program added) run in every
    /// step.
    hold: Option<(usize, SampleHold)>,
}

/// The transforms of all senses.
#[derive(Clone, Default)]
pub(super) struct Pipeline {
    /// By sense, in the order of [`Sense::ALL`].
    chains: [TransformChain; Sense::ALL.len()],
    /// Whether each sense has transforms. It is read several times in every step, and is mostly false.
    changes: [bool; Sense::ALL.len()],
}

impl Pipeline {
    /// Sets up the transforms of a configuration for a sense whose signals have the size of `like`: acuity, foveation, noise, delay.
    pub fn configure(&mut self, model: &Model, config: &Config, sense: Sense, like: &Signal<'_>) {
        let chain = &mut self.chains[sense as usize];
        if let (&Signal::Eye { height, width, .. }, Some(eye)) = (like, sense.eye()) {
            let optics = optics(model, config, eye, [width, height]);
            chain.optics = optics.len();
            chain
                .stages
                .extend(optics.into_iter().map(ConfiguredTransform::configured));
        }
        let deviation = sense.noise(config);
        if deviation > 0.0 {
            let noise = Noise::new(deviation);
            let magnitudes = matches!(like, Signal::Skin(values) if values.width() == 1);
            // a normal force cannot be negative
            let noise = if magnitudes { noise.of_magnitudes() } else { noise };
            chain.stages.push(ConfiguredTransform::configured(Box::new(noise)));
        }
        if sense.rate(config).is_some() {
            chain.hold = Some((chain.stages.len(), SampleHold::new(like)));
        }
        let steps = effective(config, sense.delay(config));
        if steps > 0 {
            let delay = Delay::new(steps, Delays::step_ms(config.frame_skip), like);
            chain.stages.push(ConfiguredTransform::configured(Box::new(delay)));
        }
        self.note_changes();
    }

    fn note_changes(&mut self) {
        let changes = |chain: &TransformChain| !chain.stages.is_empty() || chain.hold.is_some();
        self.changes = self.chains.each_ref().map(changes);
    }

    /// Returns whether a sense has transforms.
    pub fn changes(&self, sense: Sense) -> bool {
        self.changes[sense as usize]
    }

    /// Returns whether the values of a sense in a step can be skipped without changing later ones: no transform remembers them or draws
    /// random numbers for them.
    pub fn is_independent(&self, sense: Sense) -> bool {
        let chain = &self.chains[sense as usize];
        chain.stages.len() == chain.optics && chain.hold.is_none()
    }

    /// Returns the transforms of a sense.
    pub fn of(&self, sense: Sense) -> impl Iterator<Item = &dyn Transform> {
        self.chains[sense as usize].stages.iter().map(|stage| &*stage.transform)
    }

    /// Transforms the values of a sense. Without a sample in this step, they are those of the last sample.
    pub fn apply(&mut self, sense: Sense, mut signal: Signal<'_>, looked: bool, rng: &mut NumpyRng) {
        let TransformChain { stages, hold, .. } = &mut self.chains[sense as usize];
        let mut apply = |stages: &mut [ConfiguredTransform], signal: &mut Signal<'_>| {
            for stage in stages {
                stage.transform.apply(signal.reborrow(), rng);
            }
        };
        match hold {
            None => apply(stages, &mut signal),
            // noise belongs to a sample and is held with it; delays advance in every step
            Some((at, hold)) => {
                let (of_looks, of_steps) = stages.split_at_mut(*at);
                if looked {
                    apply(of_looks, &mut signal);
                    hold.keep(&signal);
                } else {
                    hold.show(&mut signal);
                }
                apply(of_steps, &mut signal);
            }
        }
    }

    /// Appends a transform.
    pub fn add(&mut self, sense: Sense, transform: Box<dyn Transform>) {
        let configured = false;
        self.chains[sense as usize]
            .stages
            .push(ConfiguredTransform { transform, configured });
        self.note_changes();
    }

    /// Adopts the transforms that a program added to another pipeline.
    pub fn take_added(&mut self, other: &mut Self) {
        for (own, others) in self.chains.iter_mut().zip(&mut other.chains) {
            let stages = std::mem::take(&mut others.stages);
            let (configured, added) = stages.into_iter().partition(|stage| stage.configured);
            // those of the configuration stay, as the new senses have their own
            others.stages = configured;
            let added: Vec<ConfiguredTransform> = added;
            own.stages.extend(added);
        }
        self.note_changes();
        other.note_changes();
    }

    /// Clears the memory of the last episode.
    pub fn reset(&mut self) {
        self.stages_mut().for_each(|stage| stage.transform.reset());
    }

    /// Appends the memory of the transforms.
    pub fn save(&self, out: &mut Vec<u8>) {
        let mut memory = Vec::new();
        for chain in &self.chains {
            for stage in &chain.stages {
                stage.transform.save(&mut memory);
                append_part(out, &mut memory);
            }
            if let Some((_, hold)) = &chain.hold {
                hold.save(&mut memory);
                append_part(out, &mut memory);
            }
        }
    }

    /// Restores what the same transforms saved, from the front of `bytes`; `false` if the data do not fit.
    pub fn load(&mut self, bytes: &mut &[u8]) -> bool {
        self.chains.iter_mut().all(|TransformChain { stages, hold, .. }| {
            // lengths come from the snapshot, which may be damaged, so each transform checks its own part
            let loaded = stages
                .iter_mut()
                .all(|stage| take_part(bytes).is_some_and(|part| stage.transform.load(part)));
            let held = hold
                .as_mut()
                .is_none_or(|(_, hold)| take_part(bytes).is_some_and(|part| hold.load(part)));
            loaded && held
        })
    }

    /// Returns the memory of all transforms, bytes.
    pub fn memory(&self) -> usize {
        let of_chain = |chain: &TransformChain| {
            let stages = chain.stages.iter().map(|stage| stage.transform.memory());
            stages.sum::<usize>() + chain.hold.as_ref().map_or(0, |(_, hold)| hold.memory())
        };
        self.chains.iter().map(of_chain).sum()
    }

    fn stages_mut(&mut self) -> impl Iterator<Item = &mut ConfiguredTransform> {
        self.chains.iter_mut().flat_map(|chain| &mut chain.stages)
    }
}

/// Returns the transforms that a configuration applies to each image of an eye (0 left, 1 right) of a given width and height, independently of other
/// images: acuity, foveation.
pub(super) fn optics(
    model: &Model,
    config: &Config,
    eye: usize,
    [width, height]: [usize; 2],
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

/// Appends a part to bytes, after its length.
pub(super) fn append_part(out: &mut Vec<u8>, part: &mut Vec<u8>) {
    out.extend_from_slice(&(part.len() as u64).to_le_bytes());
    // leaves `part` empty for the next one
    out.append(part);
}

/// Splits a part, which follows its length, from the front of bytes.
pub(super) fn take_part<'b>(bytes: &mut &'b [u8]) -> Option<&'b [u8]> {
    let (length, rest) = bytes.split_first_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let (part, rest) = rest.split_at_checked(length)?;
    *bytes = rest;
    Some(part)
}

/// Returns the effective delay of a configured number of steps. The code that `compat: reference` follows takes the new value out of its
/// list one step early.
pub(super) fn effective(config: &Config, steps: usize) -> usize {
    match config.compat {
        Compat::Api => steps,
        Compat::Reference => steps.saturating_sub(1),
    }
}
