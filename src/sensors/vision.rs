//! Vision: images from the two eyes.

use std::sync::Arc;

use crate::model::Model;
use crate::physics::State;
use crate::render::{Poses, RenderError, RenderRequest, Renderer, View, Visual};

/// Names of the cameras in the eyes, left and right, which are also the keys of the observation.
pub const EYES: [&str; 2] = ["eye_left", "eye_right"];

impl<'a> From<&'a State> for Poses<'a> {
    /// Returns the poses at the start of the last physics step.
    fn from(s: &'a State) -> Self {
        Self {
            geom_xpos: &s.geom_xpos,
            geom_xmat: &s.geom_xmat,
            site_xpos: &s.site_xpos,
            site_xmat: &s.site_xmat,
            cam_xpos: &s.cam_xpos,
            cam_xmat: &s.cam_xmat,
            xpos: &s.xpos,
            xmat: &s.xmat,
            subtree_com: &s.subtree_com,
        }
    }
}

/// The two eyes: images of (resolution, resolution, 3) bytes each, red, green and blue, rows from the top.
#[derive(Debug)]
pub struct Vision {
    renderer: Renderer,
    eyes: [usize; 2],
    resolution: usize,
}

impl Vision {
    /// Creates the eyes of `model`, its cameras [`EYES`], drawn on the CPU; `None` if it has no eyes. `visual` is the
    /// look of the same model.
    pub fn new(model: &Model, visual: Arc<Visual>, resolution: usize) -> Option<Self> {
        Self::with_renderer(model, Renderer::cpu(visual), resolution)
    }

    /// Creates the eyes of `model`, drawn by any renderer of its look.
    pub fn with_renderer(model: &Model, renderer: Renderer, resolution: usize) -> Option<Self> {
        Some(Self {
            renderer,
            eyes: [model.camera(EYES[0])?, model.camera(EYES[1])?],
            resolution,
        })
    }

    /// Returns the shape of an image: rows, columns, colours.
    pub fn shape(&self) -> [usize; 3] {
        [self.resolution, self.resolution, 3]
    }

    /// Returns the number of bytes of an image.
    pub fn len(&self) -> usize {
        self.shape().into_iter().fold(1, usize::saturating_mul)
    }

    /// Returns whether the images have no pixels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the look of the scene.
    pub fn visual(&self) -> &Arc<Visual> {
        self.renderer.visual()
    }

    /// Returns the renderer that draws the images.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Draws both images, left and right, of length [`Self::len`] each. Poses are those of the start of the last physics
    /// step, as in the reference.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn observe(&mut self, s: &State, eyes: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.rgb(&requests, eyes)
    }

    /// Draws both images in grey: a byte for each pixel, (resolution, resolution).
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn gray(&mut self, s: &State, eyes: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.gray(&requests, eyes)
    }

    /// Draws for both eyes the distance of what each pixel shows from the camera's plane, m, (resolution, resolution);
    /// infinite where nothing is.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn depth(&mut self, s: &State, eyes: [&mut [f32]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.depth(&requests, eyes)
    }

    /// Draws for both eyes the id of the geom that each pixel shows, (resolution, resolution); -1 where none is.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn segmentation(&mut self, s: &State, eyes: [&mut [i32]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.segmentation(&requests, eyes)
    }

    /// Returns the images that [`Self::observe`] draws, left and right.
    pub fn requests<'a>(&self, s: &'a State) -> [RenderRequest<'a>; 2] {
        self.eyes.map(|camera| RenderRequest {
            poses: Poses::from(s),
            view: View {
                camera,
                width: self.resolution,
                height: self.resolution,
            },
        })
    }
}
