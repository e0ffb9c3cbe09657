//! The eyes of many environments, drawn together.

use std::sync::Arc;

use super::senses::PictureStatus;
use super::{Env, EnvError, Observation, Senses, SensesMut};
use crate::physics::State;
use crate::render::{ImageBuffers, RenderRequest, SharedGpu, draw_on};
use crate::sensors::EyeImages;
use crate::sensors::transform::Sense;
use crate::spaces::NumpyRng;

impl Senses {
    /// Draws what the eyes see, if they sample now, and transforms it.
    pub(super) fn observe_eyes(&mut self, state: &State, rng: &mut NumpyRng) -> Result<(), EnvError> {
        let looks = self.eyes_look();
        let Some(vision) = &mut self.vision else { return Ok(()) };
        if looks {
            vision.draw(state, self.eyes.each_mut().map(EyeImages::buffers))?;
        }
        self.take_picture(rng);
        Ok(())
    }

    /// Transforms the images that have just been drawn.
    pub(super) fn take_picture(&mut self, rng: &mut NumpyRng) {
        self.drawn += u64::from(self.eyes_look());
        self.picture = PictureStatus::Drawn;
        for sense in Sense::EYES {
            self.transform(sense, rng);
        }
    }

    /// Returns whether the eyes are drawn on request. Pictures that later ones depend on are always drawn.
    pub(super) fn is_lazy(&self) -> bool {
        self.vision_lazy && self.vision.is_some() && Sense::EYES.iter().all(|&eye| self.pipeline.is_independent(eye))
    }

    /// Returns whether there is a picture to draw for programs that draw the eyes themselves.
    pub(super) fn wants_drawing(&self) -> bool {
        self.picture == PictureStatus::Waiting || !self.is_lazy()
    }
}

impl<'a> SensesMut<'a> {
    /// Draws the picture of the last observation, if it has not been drawn yet ([`Config::vision_lazy`](crate::Config::vision_lazy)), and
    /// returns the whole observation. The picture has the same bits as without `vision_lazy`, even after other requests. Until
    /// then the observation has no images, and if a step comes first the picture is lost. Otherwise nothing is drawn.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let config = Config { touch_active: false, vision_lazy: true, ..Config::default() };
    /// let mut env = Env::new(config)?;
    /// env.reset(Some(0))?;
    /// let action = vec![0.2; env.action_space().len()];
    /// for _ in 0..9 {
    ///     assert!(env.step(&action)?.observation.eye_left.is_none());
    /// }
    /// assert!(env.senses_mut().look()?.eye_left.is_some());
    /// assert_eq!(env.senses().pictures_drawn(), 1);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// As the renderer.
    pub fn look(self) -> Result<Observation<'a>, EnvError> {
        let env = self.env;
        if env.senses.picture == PictureStatus::Waiting {
            draw_eyes([&mut *env])?;
        }
        Ok(env.observation())
    }
}

/// Draws the eyes of many environments into their observations, and transforms the images. With `renderer: wgpu`, all environments of a
/// blueprint are drawn in one submission and one transfer. On the CPU they are drawn one after the other. Environments with
/// [`Config::vision_lazy`](crate::Config::vision_lazy) whose eyes have already been drawn are left unchanged.
///
/// ```
/// use babybench::env::draw_eyes;
/// use babybench::{Blueprint, Config, Env};
///
/// let blueprint = Blueprint::new(Config { touch_active: false, ..Config::default() })?; // renderer: wgpu for a GPU
/// let mut environments: Vec<Env> = (0..2).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
/// let mut action = Vec::new();
/// for (seed, env) in environments.iter_mut().enumerate() {
///     env.senses_mut().defer_vision(true);
///     env.reset(Some(seed as u64))?;
///     env.sample_action(&mut action);
///     env.step(&action)?;
/// }
/// draw_eyes(&mut environments)?;
/// assert!(environments[1].observation().eye_left.is_some_and(|image| image.iter().any(|&v| v > 0)));
/// # Ok::<(), babybench::EnvError>(())
/// ```
///
/// # Errors
/// As the renderers.
pub fn draw_eyes<'e>(environments: impl IntoIterator<Item = &'e mut Env>) -> Result<(), EnvError> {
    let mut on_gpus: Vec<&mut Env> = Vec::new();
    for env in environments {
        let Some(vision) = env.senses.vision.as_ref().filter(|_| env.senses.wants_drawing()) else {
            continue;
        };
        env.physics.check_shape()?;
        if vision.renderer().shared_gpu().is_some() {
            on_gpus.push(env);
            continue;
        }
        // one after the other on the CPU, which keeps the order of random numbers of each environment
        env.senses.observe_eyes(env.physics.state(), &mut env.rng)?;
    }
    draw_on_gpus(&mut on_gpus)?;
    Ok(())
}

/// Draws the eyes of the environments with a GPU renderer, in one submission for each GPU.
fn draw_on_gpus(environments: &mut [&mut Env]) -> Result<(), EnvError> {
    let mut batches: Vec<GpuBatch> = Vec::new();
    for env in environments.iter_mut().filter(|env| env.senses.eyes_look()) {
        let state = env.physics.state();
        let Some(vision) = &env.senses.vision else { continue };
        let Some(gpu) = vision.renderer().shared_gpu() else {
            continue;
        };
        // environments of several blueprints may be drawn in one call
        let known = batches.iter().position(|b| Arc::ptr_eq(&b.gpu, gpu));
        let index = known.unwrap_or(batches.len());
        if known.is_none() {
            batches.push(GpuBatch::new(gpu.clone()));
        }
        batches[index].requests.extend(vision.requests(state));
        let eyes = env.senses.eyes.each_mut().map(EyeImages::buffers);
        batches[index].images.extend(eyes);
    }
    for batch in batches {
        draw_on(&batch.gpu, &batch.requests, batch.images)?;
    }
    for env in environments {
        // also if the eyes did not look, because delays advance in every step
        env.senses.take_picture(&mut env.rng);
    }
    Ok(())
}

/// The pictures drawn by one GPU.
struct GpuBatch<'e> {
    gpu: SharedGpu,
    requests: Vec<RenderRequest<'e>>,
    images: Vec<ImageBuffers<'e>>,
}

impl GpuBatch<'_> {
    fn new(gpu: SharedGpu) -> Self {
        Self {
            gpu,
            requests: Vec::new(),
            images: Vec::new(),
        }
    }
}
