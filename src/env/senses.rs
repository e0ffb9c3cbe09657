//! The senses of an environment and their observations.

use std::sync::Arc;

use super::blueprint::SharedTables;
use super::clock::Clock;
use super::pipeline::Pipeline;
use super::task::TaskSizes;
use super::{Blueprint, EnvError, Observation, missing_camera};
use crate::actuation::{Actuation, Reflexes};
use crate::config::VisionOutput;
use crate::model::Model;
use crate::physics::State;
use crate::render::View;
use crate::sensors::touch::POOLED;
use crate::sensors::transform::{Sense, Signal, Transform};
use crate::sensors::{
    EYES, EyeImages, ObservationEntry, Pain, Proprioception, SkinValues, Touch, TouchPool, Vestibular, Vision,
};
use crate::spaces::{NumpyRng, Values};

/// The images of eyes that have no picture yet.
static NO_IMAGES: [EyeImages; 2] = [EyeImages::NONE, EyeImages::NONE];

/// The state of the picture of the last observation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PictureStatus {
    /// Drawn, in the observation.
    Drawn,
    /// Not drawn yet.
    Waiting,
    /// The scene moved on before the picture was drawn.
    Gone,
}

/// The active senses of an environment, with their last observations: [`Env::senses`](crate::Env::senses).
#[derive(Clone)]
pub struct Senses {
    pub(super) proprioception: Arc<Proprioception>,
    pub(super) touch: Option<Touch>,
    pub(super) vision: Option<Vision>,
    pub(super) vestibular: Option<Arc<Vestibular>>,
    pub(super) pool: Option<TouchPool>,
    pub(super) pain: Option<Pain>,
    /// The numbers of each sense; `None` for senses that are off, and for skins and eyes.
    numbers: [Option<Vec<f64>>; Sense::ALL.len()],
    pub(super) eyes: [EyeImages; 2],
    pub(super) pipeline: Pipeline,
    /// The clocks of the eyes and of the skin, if they do not sample in every step.
    pub(super) clocks: [Option<Clock>; 2],
    /// Touch and pain after their transforms, if they have any.
    touch_values: SkinValues,
    pain_values: SkinValues,
    /// Whether [`super::draw_eyes`] draws the eyes instead of each step.
    pub(super) vision_deferred: bool,
    /// Whether pictures are drawn on request.
    pub(super) vision_lazy: bool,
    pub(super) picture: PictureStatus,
    /// Whether the next step is likely to draw the eyes. It affects when a thread wakes, but no bits.
    draws_next: bool,
    /// Number of times the eyes were drawn.
    pub(super) drawn: u64,
    /// Number of observations.
    pub(super) moment: u64,
    /// Whether touch, pain and images belong to the same moment as the rest. A restored snapshot does not hold them.
    pub(super) known: bool,
}

impl std::fmt::Debug for Senses {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let on = Sense::ALL.into_iter().filter(|&sense| self.is_on(sense));
        f.debug_set().entries(on).finish()
    }
}

/// Makes the eyes, if they are active.
fn vision(blueprint: &Blueprint) -> Result<Option<Vision>, EnvError> {
    let config = blueprint.config();
    if !config.vision_active {
        return Ok(None);
    }
    let mut renderer = blueprint.eyes_renderer()?;
    renderer.set_threads(config.vision_threads as usize);
    let eyes = Vision::with_renderer(blueprint.model(), renderer, config.eye_sizes());
    Ok(Some(eyes.ok_or_else(|| missing_camera(EYES[0], "vision_active"))?))
}

impl Senses {
    pub(super) fn new(blueprint: &Blueprint, sizes: TaskSizes) -> Result<Self, EnvError> {
        let (config, model) = (blueprint.config(), blueprint.model());
        let SharedTables {
            proprioception,
            vestibular,
            reflexes,
            ..
        } = blueprint.tables().clone();
        let vision = vision(blueprint)?;
        let views = vision.as_ref().map(Vision::views);
        let images = |eye: usize| EyeImages::new(config.vision_outputs, views.map_or(0, |views| views[eye].pixels()));
        let skin = blueprint.skin();
        let pool = skin.filter(|_| config.touch_pooled).map(|skin| TouchPool::new(skin));
        let pain = skin.filter(|_| config.pain_active);
        let pain = pain.map(|skin| Pain::new(model, skin.clone(), config));
        let touch = skin.map(|skin| Touch::configured(skin.clone(), config));
        // space only where touch is transformed: without transforms the felt values themselves are observed
        let empty =
            |felt: Option<&SkinValues>| felt.map_or(SkinValues::new(0, 1), |v| SkinValues::new(v.sensors(), v.width()));
        let numbers = Sense::ALL.map(|sense| match sense {
            Sense::Proprioception => Some(proprioception.len() + sizes.observation),
            Sense::TouchPooled => pool.as_ref().map(TouchPool::len),
            Sense::Vestibular => vestibular.as_ref().map(|v| v.len()),
            Sense::Reflexes => reflexes.as_ref().filter(|_| config.reflexes.observed).map(|r| r.len()),
            Sense::Touch | Sense::Pain | Sense::EyeLeft | Sense::EyeRight => None,
        });
        let mut senses = Self {
            numbers: numbers.map(|len| len.map(|len| vec![0.0; len])),
            eyes: [0, 1].map(images),
            vision_deferred: false,
            vision_lazy: config.vision_lazy,
            picture: PictureStatus::Drawn,
            draws_next: false,
            drawn: 0,
            moment: 0,
            known: true,
            pipeline: Pipeline::default(),
            clocks: [config.vision_rate, config.touch_rate].map(|rate| Some(Clock::new(rate?, blueprint.dt()))),
            touch_values: empty(touch.as_ref().map(Touch::felt)),
            pain_values: empty(pain.as_ref().map(Pain::felt)),
            touch,
            proprioception,
            vision,
            vestibular,
            pool,
            pain,
        };
        for sense in Sense::ALL {
            if !senses.is_on(sense) {
                continue;
            }
            // taken out for the call, because a signal borrows all other senses
            let mut pipeline = std::mem::take(&mut senses.pipeline);
            pipeline.configure(model, config, sense, &senses.signal(sense));
            senses.pipeline = pipeline;
        }
        senses.make_room();
        Ok(senses)
    }

    /// Switches to the tables of a changed model.
    pub(super) fn use_tables(&mut self, tables: &SharedTables) {
        self.proprioception.clone_from(&tables.proprioception);
        self.vestibular.clone_from(&tables.vestibular);
    }

    /// Points the same eyes at the scene of a blueprint.
    #[cfg(feature = "rapier")]
    pub(super) fn use_eyes(&mut self, blueprint: &Blueprint) -> Result<(), EnvError> {
        self.vision = vision(blueprint)?;
        Ok(())
    }

    /// Returns whether a sense is observed.
    pub(super) fn is_on(&self, sense: Sense) -> bool {
        match sense {
            Sense::Touch => self.touch.is_some(),
            Sense::Pain => self.pain.is_some(),
            Sense::EyeLeft | Sense::EyeRight => self.vision.is_some(),
            sense => self.numbers[sense as usize].is_some(),
        }
    }

    /// Returns the numbers of a sense; `None` if it is off or reports something else.
    pub(super) fn numbers(&self, sense: Sense) -> &[f64] {
        self.numbers[sense as usize].as_deref().unwrap_or_default()
    }

    /// Iterates over the numbers of every sense, in the order of [`Sense::ALL`], for writing.
    pub(super) fn numbers_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.numbers.iter_mut().filter_map(Option::as_deref_mut)
    }

    /// Adds a transform to a sense that is on.
    pub(super) fn add_transform(&mut self, sense: Sense, transform: Box<dyn Transform>) {
        self.pipeline.add(sense, transform);
        // the transform would apply to a picture of a moment before it was added
        self.forget_picture();
        self.make_room();
    }

    /// Adopts the transforms that were added to other senses of the same kinds.
    pub(super) fn take_added(&mut self, other: &mut Self) {
        self.pipeline.take_added(&mut other.pipeline);
        self.make_room();
    }

    /// Adopts the last touch of other senses of the same body.
    pub(super) fn take_felt(&mut self, other: &mut Self) {
        // swapped instead of copied: the other senses are dropped next
        std::mem::swap(&mut self.touch, &mut other.touch);
        std::mem::swap(&mut self.pain, &mut other.pain);
        std::mem::swap(&mut self.touch_values, &mut other.touch_values);
        std::mem::swap(&mut self.pain_values, &mut other.pain_values);
        let pooled = Sense::TouchPooled as usize;
        std::mem::swap(&mut self.numbers[pooled], &mut other.numbers[pooled]);
    }

    /// Reserves buffers for touch and pain after their transforms, if they have any.
    fn make_room(&mut self) {
        let like = |felt: Option<&SkinValues>, changed| match felt {
            Some(felt) if changed => {
                let mut values = SkinValues::new(felt.sensors(), felt.width());
                values.copy_from(felt);
                values
            }
            _ => SkinValues::new(0, 1),
        };
        let changed = [Sense::Touch, Sense::Pain].map(|sense| self.pipeline.changes(sense));
        self.touch_values = like(self.touch.as_ref().map(Touch::felt), changed[0]);
        self.pain_values = like(self.pain.as_ref().map(Pain::felt), changed[1]);
    }

    /// Returns the values of a sense, to be transformed.
    fn signal(&mut self, sense: Sense) -> Signal<'_> {
        let views = self.vision.as_ref().map(Vision::views);
        if let (Some(eye), Some(views)) = (sense.eye(), views) {
            let View { width, height, .. } = views[eye];
            let images = &mut self.eyes[eye];
            return Signal::Eye { images, height, width };
        }
        match sense {
            Sense::Touch => Signal::Skin(&mut self.touch_values),
            Sense::Pain => Signal::Skin(&mut self.pain_values),
            sense => Signal::Numbers(numbers_of(&mut self.numbers, sense)),
        }
    }

    /// Transforms the values of a sense.
    pub(super) fn transform(&mut self, sense: Sense, rng: &mut NumpyRng) {
        if self.pipeline.changes(sense) {
            let mut pipeline = std::mem::take(&mut self.pipeline);
            let looked = self.looks(sense);
            pipeline.apply(sense, self.signal(sense), looked, rng);
            self.pipeline = pipeline;
        }
    }

    /// Returns the clock of a sense that does not sample in every step.
    fn clock(&self, sense: Sense) -> Option<&Clock> {
        match sense {
            Sense::EyeLeft | Sense::EyeRight => self.clocks[0].as_ref(),
            Sense::Touch | Sense::TouchPooled | Sense::Pain => self.clocks[1].as_ref(),
            Sense::Proprioception | Sense::Vestibular | Sense::Reflexes => None,
        }
    }

    /// Returns whether a sense samples in the current step.
    fn looks(&self, sense: Sense) -> bool {
        self.clock(sense).is_none_or(Clock::is_due)
    }

    /// Returns whether the eyes sample in the current step.
    pub(super) fn eyes_look(&self) -> bool {
        self.looks(Sense::EyeLeft)
    }

    /// Returns the age of the eyes' pictures, in steps and without delays, if they have their own rate.
    pub(super) fn vision_age(&self) -> Option<u64> {
        self.clock(Sense::EyeLeft).map(Clock::age)
    }

    /// Advances by a step.
    pub(super) fn advance(&mut self) {
        self.clocks.iter_mut().flatten().for_each(Clock::advance);
    }

    /// Clears the memory of the last episode. The phase, from 0 to 1, decides in which steps senses with their own rates sample.
    pub(super) fn reset(&mut self, phase: f64) {
        for clock in self.clocks.iter_mut().flatten() {
            clock.reset(phase);
        }
        if let Some(pain) = &mut self.pain {
            pain.reset();
        }
        self.pipeline.reset();
    }

    /// Observes a state: each sense, then its transforms. `append` writes what the task adds to proprioception.
    pub(super) fn observe(
        &mut self,
        model: &Model,
        state: &State,
        actuation: &dyn Actuation,
        append: impl FnOnce(&mut [f64]),
        reflexes: Option<&Reflexes>,
        rng: &mut NumpyRng,
    ) -> Result<(), EnvError> {
        let proprioception = numbers_of(&mut self.numbers, Sense::Proprioception);
        let (own, appended) = proprioception.split_at_mut(self.proprioception.len());
        self.proprioception.observe(model, state, actuation, own);
        append(appended);
        self.transform(Sense::Proprioception, rng);
        self.observe_skin(model, state, rng);
        if let Some(v) = &self.vestibular {
            v.observe(state, numbers_of(&mut self.numbers, Sense::Vestibular));
            self.transform(Sense::Vestibular, rng);
        }
        if let Some(reflexes) = reflexes {
            reflexes.observe(numbers_of(&mut self.numbers, Sense::Reflexes));
        }
        self.moment += 1;
        let lazy = self.is_lazy();
        self.draws_next = !lazy && self.clocks[0].as_ref().is_none_or(Clock::will_be_due);
        self.picture = if lazy {
            PictureStatus::Waiting
        } else {
            PictureStatus::Drawn
        };
        // last of all senses, so that their noise has the same numbers whether pictures are drawn or not
        if !lazy && !self.vision_deferred {
            self.observe_eyes(state, rng)?;
        }
        self.known = true;
        Ok(())
    }

    /// Observes touch and its derived senses, if the skin samples now, and transforms them.
    fn observe_skin(&mut self, model: &Model, state: &State, rng: &mut NumpyRng) {
        if self.looks(Sense::Touch) {
            self.feel(model, state);
        }
        for sense in [Sense::Touch, Sense::TouchPooled, Sense::Pain] {
            self.transform(sense, rng);
        }
    }

    /// Samples the skin.
    fn feel(&mut self, model: &Model, state: &State) {
        let Some(touch) = &mut self.touch else { return };
        // pooled touch and pain follow from it, so they are computed whenever the skin samples, and never without it
        touch.observe(model, state);
        if self.pipeline.changes(Sense::Touch) {
            self.touch_values.copy_from(touch.felt());
        }
        if let Some(pool) = &self.pool {
            pool.observe(touch, numbers_of(&mut self.numbers, Sense::TouchPooled));
        }
        if let Some(pain) = &mut self.pain {
            pain.observe(model, touch);
            if self.pipeline.changes(Sense::Pain) {
                self.pain_values.copy_from(pain.felt());
            }
        }
    }

    /// Begins a step, which discards a picture that was not requested. If both eyes are drawn next, it wakes the thread that draws the
    /// second one.
    pub(super) fn begin_step(&mut self) {
        self.forget_picture();
        if let (Some(vision), true) = (&self.vision, self.draws_next) {
            vision.renderer().prepare();
        }
    }

    /// Drops a picture that was not requested, because the scene that it would show moves on.
    pub(super) fn forget_picture(&mut self) {
        if self.picture == PictureStatus::Waiting {
            self.picture = PictureStatus::Gone;
        }
    }

    /// Returns touch as last observed, if it is active.
    pub(super) fn touch_values(&self) -> Option<&SkinValues> {
        if self.pipeline.changes(Sense::Touch) {
            Some(&self.touch_values)
        } else {
            self.touch.as_ref().map(Touch::felt)
        }
    }

    /// Returns pain as last observed, if it is active.
    pub(super) fn pain_values(&self) -> Option<&SkinValues> {
        if self.pipeline.changes(Sense::Pain) {
            Some(&self.pain_values)
        } else {
            self.pain.as_ref().map(Pain::felt)
        }
    }

    /// Returns the last observation, without images that have not been drawn.
    pub(super) fn observation(&self) -> Observation<'_> {
        self.observation_with(self.picture == PictureStatus::Drawn)
    }

    /// Returns the last observation, whose images may be missing or older.
    pub(super) fn observation_with(&self, images: bool) -> Observation<'_> {
        let eyes = if self.known && images { &self.eyes } else { &NO_IMAGES };
        Observation::from_fn(|entry| match (entry.sense?, entry.image) {
            (sense, Some(image)) => eyes[sense.eye()?].image(image),
            (Sense::Touch, None) => self.touch_observed().map(|felt| felt.values().into()),
            (Sense::Pain, None) => self.pain_observed().map(|felt| felt.values().into()),
            (sense, None) => self.numbers[sense as usize].as_deref().map(Values::from),
        })
    }

    /// Returns the shape of an entry of `len` numbers.
    pub(super) fn shape(&self, entry: &ObservationEntry, len: usize) -> Vec<usize> {
        let views = self.vision.as_ref().map(Vision::views);
        let view = entry
            .sense
            .and_then(Sense::eye)
            .zip(views)
            .map(|(eye, views)| views[eye]);
        match (view, entry.image) {
            (Some(View { width, height, .. }), Some(VisionOutput::Rgb)) => vec![height, width, 3],
            (Some(View { width, height, .. }), Some(_)) => vec![height, width],
            _ if entry.sense == Some(Sense::TouchPooled) => vec![len / POOLED, POOLED],
            _ => vec![len],
        }
    }
}

/// Returns the buffer for the numbers of a sense, which is empty if the sense has none.
fn numbers_of(numbers: &mut [Option<Vec<f64>>], sense: Sense) -> &mut [f64] {
    numbers[sense as usize].as_deref_mut().unwrap_or_default()
}
