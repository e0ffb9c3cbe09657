//! Vision: what the two eyes see.

use std::sync::Arc;

use crate::model::{CameraId, Model};
use crate::physics::State;
use crate::render::{Poses, RenderError, Renderer, View, Visual};

/// Names of the cameras in the eyes, left and right, which are the keys of the observation.
pub const EYES: [&str; 2] = ["eye_left", "eye_right"];

impl<'a> From<&'a State> for Poses<'a> {
    /// Where everything was at the start of the last physics step.
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
        }
    }
}

/// The pictures of both eyes: (resolution, resolution, 3) bytes each, red, green and blue, rows from the top.
#[derive(Debug)]
pub struct Vision {
    visual: Arc<Visual>,
    renderer: Renderer,
    eyes: [CameraId; 2],
    resolution: usize,
}

impl Vision {
    /// Through the cameras [`EYES`] of `model`, or nothing if it has no eyes. `visual` is that of the model.
    pub fn new(model: &Model, visual: Arc<Visual>, resolution: usize) -> Option<Self> {
        Some(Self {
            visual,
            renderer: Renderer::new(),
            eyes: [model.camera(EYES[0])?, model.camera(EYES[1])?],
            resolution,
        })
    }

    /// Shape of a picture: rows, columns, colours.
    pub fn shape(&self) -> [usize; 3] {
        [self.resolution, self.resolution, 3]
    }

    /// Bytes of a picture.
    pub fn len(&self) -> usize {
        self.shape().iter().product()
    }

    /// Whether the pictures have no pixels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The look of the scene.
    pub fn visual(&self) -> &Arc<Visual> {
        &self.visual
    }

    /// Draws both pictures, left and right, of length [`Self::len`] each. Poses are those of the start of the last physics
    /// step, as in the reference.
    ///
    /// # Errors
    /// Pictures of wrong length.
    pub fn observe(&mut self, s: &State, [left, right]: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let poses = Poses::from(s);
        for (camera, out) in self.eyes.into_iter().zip([left, right]) {
            let view = View {
                camera,
                width: self.resolution,
                height: self.resolution,
            };
            self.renderer.rgb(&self.visual, &poses, &view, out)?;
        }
        Ok(())
    }
}
