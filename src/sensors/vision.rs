//! Vision: what the two eyes see.

use std::sync::Arc;

use crate::model::{CameraId, Model};
use crate::physics::State;
use crate::render::{Painter, Poses, RenderError, Shot, View, Visual};

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
    painter: Painter,
    eyes: [CameraId; 2],
    resolution: usize,
}

impl Vision {
    /// Through the cameras [`EYES`] of `model`, or nothing if it has no eyes. `visual` is that of the model.
    pub fn new(model: &Model, visual: Arc<Visual>, resolution: usize) -> Option<Self> {
        Self::with_painter(model, Painter::cpu(visual), resolution)
    }

    /// As [`Self::new`], by any renderer of the model's look.
    pub fn with_painter(model: &Model, painter: Painter, resolution: usize) -> Option<Self> {
        Some(Self {
            painter,
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
        self.shape().into_iter().fold(1, usize::saturating_mul)
    }

    /// Whether the pictures have no pixels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The look of the scene.
    pub fn visual(&self) -> &Arc<Visual> {
        self.painter.visual()
    }

    /// What draws the pictures.
    pub fn painter(&self) -> &Painter {
        &self.painter
    }

    /// Draws both pictures, left and right, of length [`Self::len`] each. Poses are those of the start of the last physics
    /// step, as in the reference.
    ///
    /// # Errors
    /// Pictures of wrong length.
    pub fn observe(&mut self, s: &State, eyes: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let shots = self.shots(s);
        self.painter.rgb(&shots, eyes)
    }

    /// Draws both pictures in grey: a byte for each pixel, (resolution, resolution).
    ///
    /// # Errors
    /// Pictures of wrong length.
    pub fn gray(&mut self, s: &State, eyes: [&mut [u8]; 2]) -> Result<(), RenderError> {
        let shots = self.shots(s);
        self.painter.gray(&shots, eyes)
    }

    /// Draws for both eyes the distance of what each pixel shows from the camera's plane, m, (resolution, resolution); infinite
    /// where nothing is.
    ///
    /// # Errors
    /// Pictures of wrong length.
    pub fn depth(&mut self, s: &State, eyes: [&mut [f32]; 2]) -> Result<(), RenderError> {
        let shots = self.shots(s);
        self.painter.depth(&shots, eyes)
    }

    /// Draws for both eyes the id of the geom that each pixel shows, (resolution, resolution); -1 where none is.
    ///
    /// # Errors
    /// Pictures of wrong length.
    pub fn segmentation(&mut self, s: &State, eyes: [&mut [i32]; 2]) -> Result<(), RenderError> {
        let shots = self.shots(s);
        self.painter.segmentation(&shots, eyes)
    }

    /// What [`Self::observe`] draws, left and right.
    pub fn shots<'a>(&self, s: &'a State) -> [Shot<'a>; 2] {
        self.eyes.map(|camera| Shot {
            poses: Poses::from(s),
            view: View {
                camera,
                width: self.resolution,
                height: self.resolution,
            },
        })
    }
}
