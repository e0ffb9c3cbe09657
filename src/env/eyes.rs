//! What the eyes see beyond the observation: distances, geoms, grey; and the eyes of many environments, drawn together.

use crate::env::{Env, EnvError};
use crate::physics::State;
use crate::render::ImageBuffers;
use crate::sensors::{EyeImages, Vision};

#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
use {
    crate::render::{RenderRequest, SharedGpu, draw_on},
    std::sync::Arc,
};

impl Env {
    /// Draws what both eyes see in grey: left and right, (H, W) bytes from the top, by the weights 0.2989, 0.5870, 0.1140.
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; pictures that do not have H W values.
    pub fn eye_gray(&mut self, eyes: [&mut [u8]; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.gray(state, eyes)?)
    }

    /// Draws how far away is what both eyes see: left and right, (H, W) distances from the camera's plane from the top, m;
    /// infinite where nothing is.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let (mut left, mut right) = (vec![0.0; 64 * 64], vec![0.0; 64 * 64]);
    /// env.eye_depth([&mut left, &mut right])?;
    /// let mut geoms = [vec![0; 64 * 64], vec![0; 64 * 64]];
    /// env.eye_segmentation(geoms.each_mut().map(|v| &mut v[..]))?;
    /// assert!(left.iter().zip(&geoms[0]).all(|(distance, &geom)| distance.is_finite() || geom == -1));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; pictures that do not have H W values.
    pub fn eye_depth(&mut self, eyes: [&mut [f32]; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.depth(state, eyes)?)
    }

    /// Draws which geoms both eyes see: left and right, (H, W) ids from the top; -1 where none is.
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; pictures that do not have H W values.
    pub fn eye_segmentation(&mut self, eyes: [&mut [i32]; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.segmentation(state, eyes)?)
    }

    /// Draws several images of what both eyes see, left and right, those for which there are buffers. On the CPU all images
    /// of an eye come from one pass, each with the bytes that it has alone. They are what is before the eyes, without the
    /// transforms of the observation.
    ///
    /// ```
    /// use babybench::render::ImageBuffers;
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let (mut depth, mut geoms) = ([vec![0.0; 64 * 64], vec![0.0; 64 * 64]], [vec![0; 64 * 64], vec![0; 64 * 64]]);
    /// let [left, right] = &mut depth;
    /// let [left_geoms, right_geoms] = &mut geoms;
    /// env.eye_buffers([
    ///     ImageBuffers { depth: Some(left), segmentation: Some(left_geoms), ..ImageBuffers::default() },
    ///     ImageBuffers { depth: Some(right), segmentation: Some(right_geoms), ..ImageBuffers::default() },
    /// ])?;
    /// assert!(depth[0].iter().zip(&geoms[0]).all(|(distance, &geom)| distance.is_finite() || geom == -1));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; images of another size.
    pub fn eye_buffers(&mut self, eyes: [ImageBuffers<'_>; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.draw(state, eyes)?)
    }

    fn sight(&mut self) -> Result<(&mut Vision, &State), EnvError> {
        let vision = self.senses.vision.as_mut().ok_or(EnvError::NoVision)?;
        self.physics.check_shape()?;
        Ok((vision, &self.physics.state))
    }

    /// Sets by how many threads the eyes are drawn: with 2, a thread of its own draws the right eye, to the same bytes. It
    /// takes the place of [`Config::vision_threads`](crate::Config::vision_threads); see
    /// [`Renderer::set_threads`](crate::render::Renderer::set_threads). Without eyes nothing happens.
    pub fn set_vision_threads(&mut self, threads: usize) {
        if let Some(vision) = &mut self.senses.vision {
            vision.set_threads(threads);
        }
    }

    /// Returns by how many threads the eyes are drawn: 1 or 2.
    pub fn vision_threads(&self) -> usize {
        self.senses
            .vision
            .as_ref()
            .map_or(1, |vision| vision.renderer().threads())
    }

    /// Sets whether resets and steps leave the eyes' images as they are, for [`Env::draw_eyes`] to draw, once for each.
    pub fn defer_vision(&mut self, deferred: bool) {
        self.senses.vision_deferred = deferred;
    }

    /// Returns whether [`Env::draw_eyes`] draws the eyes' images, not each step.
    pub fn vision_is_deferred(&self) -> bool {
        self.senses.vision_deferred
    }

    /// Draws what the eyes of many environments see into their observations, and transforms it. With `renderer: wgpu`, all environments of a
    /// blueprint are drawn in one submission and one transfer; by the CPU, one environment after the other.
    ///
    /// ```
    /// use babybench::{Blueprint, Config, Env};
    ///
    /// let blueprint = Blueprint::new(Config { touch_active: false, ..Config::default() })?; // renderer: wgpu for a GPU
    /// let mut environments: Vec<Env> = (0..2).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
    /// let mut action = Vec::new();
    /// for (seed, env) in environments.iter_mut().enumerate() {
    ///     env.defer_vision(true);
    ///     env.reset(Some(seed as u64))?;
    ///     env.sample_action(&mut action);
    ///     env.step(&action)?;
    /// }
    /// Env::draw_eyes(&mut environments)?;
    /// assert!(environments[1].observation().eye_left.is_some_and(|image| image.iter().any(|&v| v > 0)));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// As the renderers.
    pub fn draw_eyes<'e>(environments: impl IntoIterator<Item = &'e mut Env>) -> Result<(), EnvError> {
        #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
        let mut on_gpus: Vec<&mut Env> = Vec::new();
        for env in environments {
            let state = &env.physics.state;
            let Some(vision) = &mut env.senses.vision else { continue };
            env.physics.check_shape()?;
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            if vision.renderer().shared_gpu().is_some() {
                on_gpus.push(env);
                continue;
            }
            vision.draw(state, env.senses.eyes.each_mut().map(EyeImages::buffers))?;
            env.senses.transform_eyes(&mut env.rng);
        }
        #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
        draw_on_gpus(&mut on_gpus)?;
        Ok(())
    }
}

/// Draws what the eyes of environments see that GPUs draw, in one submission for each.
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
fn draw_on_gpus(environments: &mut [&mut Env]) -> Result<(), EnvError> {
    let mut batches: Vec<Batch> = Vec::new();
    for env in &mut *environments {
        let state = &env.physics.state;
        let Some(vision) = &env.senses.vision else { continue };
        let Some(gpu) = vision.renderer().shared_gpu() else {
            continue;
        };
        let known = batches.iter().position(|b| Arc::ptr_eq(&b.gpu, gpu));
        let index = known.unwrap_or(batches.len());
        if known.is_none() {
            batches.push(Batch::new(gpu.clone()));
        }
        batches[index].requests.extend(vision.requests(state));
        let eyes = env.senses.eyes.each_mut().map(EyeImages::buffers);
        batches[index].images.extend(eyes);
    }
    for batch in batches {
        draw_on(&batch.gpu, &batch.requests, batch.images)?;
    }
    for env in environments {
        env.senses.transform_eyes(&mut env.rng);
    }
    Ok(())
}

/// The pictures that one GPU draws.
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
struct Batch<'e> {
    gpu: SharedGpu,
    requests: Vec<RenderRequest<'e>>,
    images: Vec<ImageBuffers<'e>>,
}

#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
impl Batch<'_> {
    fn new(gpu: SharedGpu) -> Self {
        Self {
            gpu,
            requests: Vec::new(),
            images: Vec::new(),
        }
    }
}
