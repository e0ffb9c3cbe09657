//! The composed frame of an evaluation: the room on the left, what the behavior is about at the upper right, the view
//! from above at the lower right.

use crate::model::{CameraId, Model};
use crate::render::{Poses, Renderer, View, Visual, luma};

use super::VideoError;

/// Width of the frame, pixels.
pub const FRAME_WIDTH: usize = 720;
/// Height of the frame, pixels.
pub const FRAME_HEIGHT: usize = 480;
/// Side of the panels on the right.
const PANEL: usize = FRAME_HEIGHT / 2;

/// What the panel at the upper right shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panel<'a> {
    /// The camera `side2`.
    Side,
    /// Both eyes in one picture: the left in red, the right in green and blue.
    Binocular,
    /// A picture of 240 x 240 pixels made elsewhere, such as that of the skin: red, green, blue, rows from the top.
    Picture(&'a [u8]),
}

/// Paints frames.
#[derive(Debug)]
pub struct FramePainter {
    renderer: Renderer,
    corner: CameraId,
    top: CameraId,
    side: CameraId,
    eyes: Option<[CameraId; 2]>,
    picture: Vec<u8>,
    other: Vec<u8>,
}

impl FramePainter {
    /// For the scene of `model`.
    ///
    /// # Errors
    /// The scene lacks one of the cameras `corner`, `top`, `side2`.
    pub fn new(model: &Model) -> Result<Self, VideoError> {
        let camera = |name: &'static str| model.camera(name).ok_or(VideoError::Camera(name));
        let len = 3 * FRAME_HEIGHT * FRAME_HEIGHT;
        Ok(Self {
            renderer: Renderer::new(),
            corner: camera("corner")?,
            top: camera("top")?,
            side: camera("side2")?,
            eyes: model
                .camera("eye_left")
                .zip(model.camera("eye_right"))
                .map(<[_; 2]>::from),
            picture: vec![0; len],
            other: vec![0; len],
        })
    }

    /// Paints a frame of [`FRAME_WIDTH`] by [`FRAME_HEIGHT`] pixels: red, green, blue, rows from the top.
    ///
    /// # Errors
    /// A picture or buffer of wrong size, a binocular panel for a model without eyes.
    pub fn paint(&mut self, visual: &Visual, poses: &Poses, panel: Panel, out: &mut [u8]) -> Result<(), VideoError> {
        let expected = 3 * FRAME_WIDTH * FRAME_HEIGHT;
        if out.len() != expected {
            let found = out.len();
            return Err(VideoError::Frame { found, expected });
        }
        self.draw(visual, poses, self.corner)?;
        let rows = self.picture.chunks_exact(3 * FRAME_HEIGHT);
        for (line, row) in out.chunks_exact_mut(3 * FRAME_WIDTH).zip(rows) {
            line[..3 * FRAME_HEIGHT].copy_from_slice(row);
        }
        match panel {
            Panel::Side => self.draw(visual, poses, self.side)?,
            Panel::Binocular => self.binocular(visual, poses)?,
            Panel::Picture(rgb) => {
                let expected = 3 * PANEL * PANEL;
                if rgb.len() != expected {
                    let found = rgb.len();
                    return Err(VideoError::Frame { found, expected });
                }
                let lines = out.chunks_exact_mut(3 * FRAME_WIDTH);
                for (line, row) in lines.zip(rgb.chunks_exact(3 * PANEL)) {
                    line[3 * FRAME_HEIGHT..].copy_from_slice(row);
                }
            }
        }
        if !matches!(panel, Panel::Picture(_)) {
            self.place(out, 0);
        }
        self.draw(visual, poses, self.top)?;
        self.place(out, PANEL);
        Ok(())
    }

    fn draw(&mut self, visual: &Visual, poses: &Poses, camera: CameraId) -> Result<(), VideoError> {
        let view = View {
            camera,
            width: FRAME_HEIGHT,
            height: FRAME_HEIGHT,
        };
        Ok(self.renderer.rgb(visual, poses, &view, &mut self.picture)?)
    }

    fn binocular(&mut self, visual: &Visual, poses: &Poses) -> Result<(), VideoError> {
        let [left, right] = self.eyes.ok_or(VideoError::Camera("eye_left"))?;
        self.draw(visual, poses, left)?;
        std::mem::swap(&mut self.picture, &mut self.other);
        self.draw(visual, poses, right)?;
        for (right, left) in self.picture.chunks_exact_mut(3).zip(self.other.chunks_exact(3)) {
            let cyan = luma([right[0], right[1], right[2]]);
            right.copy_from_slice(&[luma([left[0], left[1], left[2]]), cyan, cyan]);
        }
        Ok(())
    }

    /// Puts every second pixel of every second row of the picture on the right, from row `top`.
    fn place(&self, out: &mut [u8], top: usize) {
        let lines = out.chunks_exact_mut(3 * FRAME_WIDTH).skip(top).take(PANEL);
        for (line, row) in lines.zip(self.picture.chunks_exact(3 * FRAME_HEIGHT).step_by(2)) {
            let pixels = line[3 * FRAME_HEIGHT..].chunks_exact_mut(3);
            for (to, from) in pixels.zip(row.chunks_exact(3).step_by(2)) {
                to.copy_from_slice(from);
            }
        }
    }
}
