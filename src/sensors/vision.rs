//! Vision: images from the two eyes.

use std::sync::Arc;

use crate::config::{VisionOutput, VisionOutputs};
pub use crate::mimo::EYES;
use crate::model::Model;
use crate::physics::State;
use crate::render::{ImageBuffers, Poses, RenderError, RenderRequest, Renderer, Scenery, View};
use crate::spaces::Values;

/// Images of one eye, or of several one after the other, each with rows from the top; those that are not observed are
/// empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EyeImages {
    /// Red, green and blue, (H, W, 3).
    pub rgb: Vec<u8>,
    /// Brightness, (H, W).
    pub gray: Vec<u8>,
    /// Distance from the camera's plane, m, (H, W).
    pub depth: Vec<f32>,
    /// Ids of geoms, (H, W).
    pub segmentation: Vec<i32>,
}

impl EyeImages {
    /// Images without pixels.
    pub(crate) const NONE: Self = Self {
        rgb: Vec::new(),
        gray: Vec::new(),
        depth: Vec::new(),
        segmentation: Vec::new(),
    };

    /// Reserves images of `pixels` pixels each.
    pub fn new(outputs: VisionOutputs, pixels: usize) -> Self {
        let len = |output| if outputs.contains(output) { pixels } else { 0 };
        Self {
            rgb: vec![0; 3 * len(VisionOutput::Rgb)],
            gray: vec![0; len(VisionOutput::Gray)],
            depth: vec![0.0; len(VisionOutput::Depth)],
            segmentation: vec![0; len(VisionOutput::Segmentation)],
        }
    }

    /// Returns one of the images, if it is observed.
    pub fn image(&self, output: VisionOutput) -> Option<Values<'_>> {
        let pixels: Values<'_> = match output {
            VisionOutput::Rgb => self.rgb[..].into(),
            VisionOutput::Gray => self.gray[..].into(),
            VisionOutput::Depth => self.depth[..].into(),
            VisionOutput::Segmentation => self.segmentation[..].into(),
        };
        (!pixels.is_empty()).then_some(pixels)
    }

    /// Returns the memory of the images that are observed, for a renderer.
    pub fn buffers(&mut self) -> ImageBuffers<'_> {
        fn wanted<T>(values: &mut [T]) -> Option<&mut [T]> {
            (!values.is_empty()).then_some(values)
        }
        ImageBuffers {
            rgb: wanted(&mut self.rgb),
            gray: wanted(&mut self.gray),
            depth: wanted(&mut self.depth),
            segmentation: wanted(&mut self.segmentation),
        }
    }

    /// Copies images of the same sizes.
    pub fn copy_from(&mut self, other: &Self) {
        self.rgb.clone_from(&other.rgb);
        self.gray.clone_from(&other.gray);
        self.depth.clone_from(&other.depth);
        self.segmentation.clone_from(&other.segmentation);
    }

    /// Returns the memory that the images take, bytes.
    pub fn bytes(&self) -> usize {
        self.rgb.len() + self.gray.len() + 4 * (self.depth.len() + self.segmentation.len())
    }
}

/// The two eyes: images of (height, width, 3) bytes each, red, green and blue, rows from the top.
#[derive(Clone, Debug)]
pub struct Vision {
    renderer: Renderer,
    views: [View; 2],
}

impl Vision {
    /// Creates the eyes of `model`, its cameras [`EYES`], drawn on the CPU; `None` if it has no eyes. `scenery` is the
    /// look of the same model, and `sizes` are width and height of the left and the right image, pixels.
    pub fn new(model: &Model, scenery: Arc<Scenery>, sizes: [[usize; 2]; 2]) -> Option<Self> {
        Self::with_renderer(model, Renderer::cpu(scenery), sizes)
    }

    /// Creates the eyes of `model`, drawn by any renderer of its look.
    pub fn with_renderer(model: &Model, renderer: Renderer, sizes: [[usize; 2]; 2]) -> Option<Self> {
        let view = |eye: usize| {
            let [width, height] = sizes[eye];
            let camera = model.camera(EYES[eye])?;
            Some(View { camera, width, height })
        };
        Some(Self {
            renderer,
            views: [view(0)?, view(1)?],
        })
    }

    /// Returns the cameras of the left and the right eye, and the sizes of their images.
    pub fn views(&self) -> [View; 2] {
        self.views
    }

    /// Returns the look of the scene.
    pub fn scenery(&self) -> &Arc<Scenery> {
        self.renderer.scenery()
    }

    /// Returns the renderer that draws the images.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Sets whether a separate thread draws the right eye: see [`Renderer::set_threads`].
    pub fn set_threads(&mut self, threads: usize) {
        self.renderer.set_threads(threads);
    }

    /// Draws both images, left and right, of [`View::rgb_len`] bytes each. Poses are those at the start of the last physics step, as in the
    /// reference.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn observe(&mut self, s: &State, eyes: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.rgb(&requests, eyes)
    }

    /// Draws images of both eyes, left and right, those for which there are buffers, in one pass for each eye.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn draw(&mut self, s: &State, eyes: [ImageBuffers<'_>; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.draw(&requests, eyes)
    }

    /// Draws both gray images: a byte for each pixel, (height, width).
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn gray(&mut self, s: &State, eyes: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.gray(&requests, eyes)
    }

    /// Draws for both eyes the distance of the surface at each pixel from the camera's plane, m, (height, width);
    /// infinite where there is nothing.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn depth(&mut self, s: &State, eyes: [&mut [f32]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.depth(&requests, eyes)
    }

    /// Draws for both eyes the id of the geom that each pixel shows, (height, width); -1 where there is none.
    ///
    /// # Errors
    /// Fails if a buffer has the wrong length.
    pub fn segmentation(&mut self, s: &State, eyes: [&mut [i32]; 2]) -> Result<(), RenderError> {
        let requests = self.requests(s);
        self.renderer.segmentation(&requests, eyes)
    }

    /// Returns the images that [`Self::observe`] draws, left and right.
    pub fn requests<'a>(&self, s: &'a State) -> [RenderRequest<'a>; 2] {
        self.views.map(|view| RenderRequest {
            poses: Poses::from(s),
            view,
        })
    }
}
