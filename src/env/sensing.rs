//! Access to the senses of an environment.

use std::ops::Deref;

use super::{Env, EnvError, Senses};
use crate::physics::State;
use crate::render::ImageBuffers;
use crate::sensors::transform::{Sense, Transform};
use crate::sensors::{Pain, Proprioception, SkinValues, Touch, TouchPool, Vestibular, Vision};

impl Senses {
    /// Returns proprioception: names and ranges of its values.
    pub fn proprioception(&self) -> &Proprioception {
        &self.proprioception
    }

    /// Returns the sense of touch, if it is active: sensor positions, active sensors, contacts and sums of forces, as last sampled and
    /// before all transforms.
    pub fn touch(&self) -> Option<&Touch> {
        self.touch.as_ref()
    }

    /// Returns touch as observed, with the list of nonzero sensors, if it is active and known: see [`Env::restore`](crate::Env::restore).
    pub fn touch_observed(&self) -> Option<&SkinValues> {
        self.touch_values().filter(|_| self.known)
    }

    /// Returns the bodies that pooled touch covers, if it is active.
    pub fn touch_pool(&self) -> Option<&TouchPool> {
        self.pool.as_ref()
    }

    /// Returns the sense of pain, if it is active.
    pub fn pain(&self) -> Option<&Pain> {
        self.pain.as_ref()
    }

    /// Returns pain as observed, if it is active and known: see [`Env::restore`](crate::Env::restore).
    pub fn pain_observed(&self) -> Option<&SkinValues> {
        self.pain_values().filter(|_| self.known)
    }

    /// Returns the vestibular sense, if it is active.
    pub fn vestibular(&self) -> Option<&Vestibular> {
        self.vestibular.as_deref()
    }

    /// Returns the sense of vision, if it is active. [`Vision::requests`] describes the eyes' view of a state, for any renderer.
    pub fn vision(&self) -> Option<&Vision> {
        self.vision.as_ref()
    }

    /// Returns the number of threads that draw the eyes: 1 or 2.
    pub fn vision_threads(&self) -> usize {
        self.vision.as_ref().map_or(1, |vision| vision.renderer().threads())
    }

    /// Returns how often the eyes were drawn for observations, counting both eyes together. With [`Config::vision_lazy`](crate::Config::vision_lazy)
    /// it counts only requests.
    pub fn pictures_drawn(&self) -> u64 {
        self.drawn
    }

    /// Returns whether the eyes are drawn on request ([`SensesMut::look`]): the configuration sets
    /// [`vision_lazy`](crate::Config::vision_lazy), and no later picture depends on each, through noise, a delay, a rate or a transform
    /// that a program added.
    pub fn vision_is_lazy(&self) -> bool {
        self.is_lazy()
    }

    /// Returns the number of observations. Two calls with the same result belong to the same moment.
    pub fn moment(&self) -> u64 {
        self.moment
    }

    /// Returns whether [`draw_eyes`](crate::env::draw_eyes) draws the eyes' images instead of each step.
    pub fn vision_is_deferred(&self) -> bool {
        self.vision_deferred
    }

    /// Iterates over the observed senses, each with its transforms in order.
    pub fn transforms(&self) -> impl Iterator<Item = (Sense, impl Iterator<Item = &dyn Transform>)> {
        let on = Sense::ALL.into_iter().filter(|&sense| self.is_on(sense));
        on.map(|sense| (sense, self.pipeline.of(sense)))
    }
}

/// Mutable access to the senses of an environment and to their current view: [`Env::senses_mut`](crate::Env::senses_mut).
#[derive(Debug)]
pub struct SensesMut<'a> {
    pub(super) env: &'a mut Env,
}

impl Deref for SensesMut<'_> {
    type Target = Senses;

    fn deref(&self) -> &Senses {
        &self.env.senses
    }
}

impl<'a> SensesMut<'a> {
    /// Returns the eyes and the state that they see.
    fn sight(&mut self) -> Result<(&mut Vision, &State), EnvError> {
        let vision = self.env.senses.vision.as_mut().ok_or(EnvError::NoVision)?;
        self.env.physics.check_shape()?;
        Ok((vision, self.env.physics.state()))
    }

    /// Draws gray images of both eyes: left and right, (H, W) bytes from the top, with the weights 0.2989, 0.5870, 0.1140.
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; buffers that do not have H W values.
    pub fn eye_gray(&mut self, eyes: [&mut [u8]; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.gray(state, eyes)?)
    }

    /// Draws depth images of both eyes: left and right, (H, W) distances from the camera's plane from the top, m; infinite for the
    /// background.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let (mut left, mut right) = (vec![0.0; 64 * 64], vec![0.0; 64 * 64]);
    /// env.senses_mut().eye_depth([&mut left, &mut right])?;
    /// let mut geoms = [vec![0; 64 * 64], vec![0; 64 * 64]];
    /// env.senses_mut().eye_segmentation(geoms.each_mut().map(|v| &mut v[..]))?;
    /// assert!(left.iter().zip(&geoms[0]).all(|(distance, &geom)| distance.is_finite() || geom == -1));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; buffers that do not have H W values.
    pub fn eye_depth(&mut self, eyes: [&mut [f32]; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.depth(state, eyes)?)
    }

    /// Draws segmentation images of both eyes: left and right, (H, W) geom ids from the top; -1 for the background.
    ///
    /// # Errors
    /// [`EnvError::NoVision`]; buffers that do not have H W values.
    pub fn eye_segmentation(&mut self, eyes: [&mut [i32]; 2]) -> Result<(), EnvError> {
        let (vision, state) = self.sight()?;
        Ok(vision.segmentation(state, eyes)?)
    }

    /// Draws several kinds of images of both eyes, left and right: those with a buffer. On the CPU all images of an eye come from one
    /// pass, each with the bits that it has alone. The transforms of the observation are not applied.
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
    /// env.senses_mut().eye_buffers([
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

    /// Sets the number of threads that draw the eyes. With 2, another thread draws the right eye, with the same bytes. This overrides
    /// [`Config::vision_threads`](crate::Config::vision_threads); see [`Renderer::set_threads`](crate::render::Renderer::set_threads).
    /// Without eyes it has no effect.
    pub fn set_vision_threads(&mut self, threads: usize) {
        if let Some(vision) = &mut self.env.senses.vision {
            vision.set_threads(threads);
        }
    }

    /// Sets whether resets and steps skip the eyes' images. [`draw_eyes`](crate::env::draw_eyes) then draws them, once for each reset or step.
    pub fn defer_vision(&mut self, deferred: bool) {
        self.env.senses.vision_deferred = deferred;
    }

    /// Adds a transform of a sense after the existing ones. The configuration's transforms are, in this order: acuity and foveation of the eyes,
    /// noise, delay.
    ///
    /// Random numbers are drawn in each reset and step after the observation is computed, sense by sense in the order of [`Sense::ALL`]
    /// and transform by transform, from the generator that also draws actions.
    ///
    /// # Errors
    /// [`EnvError::SenseOff`].
    pub fn add_transform(&mut self, sense: Sense, transform: Box<dyn Transform>) -> Result<(), EnvError> {
        if !self.env.senses.is_on(sense) {
            return Err(EnvError::SenseOff { sense });
        }
        self.env.senses.add_transform(sense, transform);
        Ok(())
    }

    /// Returns the sense of pain, if it is active, to change the softness and sensitivity of bodies.
    pub fn pain_mut(self) -> Option<&'a mut Pain> {
        self.env.senses.pain.as_mut()
    }
}
