//! The composed frame of an evaluation: the room on the left, the behavior's subject at the upper right, the view
//! from above at the lower right.

use crate::env::room_camera;
use crate::math::{Mat3, Vec3, add};
use crate::model::Model;
use crate::render::{CpuRenderer, Poses, RenderError, Scenery, View, luma};

/// An error in composing a frame.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// A picture has the wrong size.
    #[error("the frame has {found} bytes, but those of the video have {expected}")]
    Size {
        /// Bytes found.
        found: usize,
        /// Bytes needed.
        expected: usize,
    },
    /// A frame cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The scene lacks a camera that the frame shows.
    #[error("the scene has no camera named {0:?}, which the frame shows")]
    Camera(&'static str),
}

/// Width of the frame, pixels.
pub const FRAME_WIDTH: usize = 720;
/// Height of the frame, pixels.
pub const FRAME_HEIGHT: usize = 480;
/// Side of the panels on the right.
const PANEL: usize = FRAME_HEIGHT / 2;

/// The content of the panel at the upper right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panel<'a> {
    /// The camera `side2`.
    Side,
    /// Both eyes in one picture: the left in red, the right in green and blue.
    Binocular,
    /// A picture of 240 x 240 pixels from elsewhere, such as that of the skin: red, green, blue, rows from the top.
    Picture(&'a [u8]),
}

/// The viewpoint of a picture.
#[derive(Clone, Copy, Debug)]
enum Viewpoint {
    /// A camera of the scene.
    Camera(usize),
    /// In front of MIMo's hip, for rooms without the camera: offset (m) and orientation.
    Free(Vec3, Mat3),
}

/// Composes the frames of evaluation videos.
#[derive(Debug)]
pub struct FrameComposer {
    renderer: CpuRenderer,
    corner: Viewpoint,
    top: Viewpoint,
    side: Viewpoint,
    eyes: Option<[usize; 2]>,
    hip: usize,
    picture: Vec<u8>,
    half: Vec<u8>,
    other: Vec<u8>,
}

impl FrameComposer {
    /// Creates a composer for the scene of `model`. If it has no cameras `corner`, `top` and `side2`, like scenes of tasks, other cameras
    /// follow MIMo.
    ///
    /// # Errors
    /// The scene lacks such a camera, and MIMo.
    pub fn new(model: &Model) -> Result<Self, FrameError> {
        let origin = vec![[0.0; 3]; model.nbody()];
        let camera = |name: &'static str| match (model.camera(name), room_camera(model, &origin, name)) {
            (Some(camera), _) => Ok(Viewpoint::Camera(camera)),
            (None, Some(free)) => free
                .pose()
                .map(|(offset, mat)| Viewpoint::Free(offset, mat))
                .map_err(FrameError::from),
            (None, None) => Err(FrameError::Camera(name)),
        };
        Ok(Self {
            renderer: CpuRenderer::new(),
            corner: camera("corner")?,
            top: camera("top")?,
            side: camera("side2")?,
            eyes: model
                .camera("eye_left")
                .zip(model.camera("eye_right"))
                .map(<[_; 2]>::from),
            hip: model.body("hip").unwrap_or_default(),
            picture: vec![0; 3 * FRAME_HEIGHT * FRAME_HEIGHT],
            half: vec![0; 3 * PANEL * PANEL],
            other: vec![0; 3 * PANEL * PANEL],
        })
    }

    /// Composes a frame of [`FRAME_WIDTH`] by [`FRAME_HEIGHT`] pixels: red, green, blue, rows from the top.
    ///
    /// # Errors
    /// A picture or buffer of wrong size, a binocular panel for a model without eyes.
    pub fn compose(
        &mut self,
        scenery: &Scenery,
        poses: &Poses,
        panel: Panel,
        out: &mut [u8],
    ) -> Result<(), FrameError> {
        let expected = 3 * FRAME_WIDTH * FRAME_HEIGHT;
        if out.len() != expected {
            let found = out.len();
            return Err(FrameError::Size { found, expected });
        }
        self.draw(scenery, poses, self.corner)?;
        let rows = self.picture.chunks_exact(3 * FRAME_HEIGHT);
        for (line, row) in out.chunks_exact_mut(3 * FRAME_WIDTH).zip(rows) {
            line[..3 * FRAME_HEIGHT].copy_from_slice(row);
        }
        match panel {
            Panel::Side => self.half(scenery, poses, self.side)?,
            Panel::Binocular => self.binocular(scenery, poses)?,
            Panel::Picture(rgb) => {
                let expected = 3 * PANEL * PANEL;
                if rgb.len() != expected {
                    let found = rgb.len();
                    return Err(FrameError::Size { found, expected });
                }
                place(rgb, out, 0);
            }
        }
        if !matches!(panel, Panel::Picture(_)) {
            place(&self.half, out, 0);
        }
        self.half(scenery, poses, self.top)?;
        place(&self.half, out, PANEL);
        Ok(())
    }

    fn draw(&mut self, scenery: &Scenery, poses: &Poses, from: Viewpoint) -> Result<(), FrameError> {
        let (poses, camera) = self.stand(poses, from);
        Ok(self.renderer.rgb(scenery, &poses, &view(camera), &mut self.picture)?)
    }

    /// Draws a panel of half the size: every second pixel of every second row.
    fn half(&mut self, scenery: &Scenery, poses: &Poses, from: Viewpoint) -> Result<(), FrameError> {
        let (poses, camera) = self.stand(poses, from);
        Ok(self
            .renderer
            .rgb_halved(scenery, &poses, &view(camera), &mut self.half)?)
    }

    /// Returns the poses and the camera of a spot.
    fn stand<'p>(&self, poses: &Poses<'p>, from: Viewpoint) -> (Poses<'p>, usize) {
        let mut poses = *poses;
        match from {
            Viewpoint::Camera(camera) => (poses, camera),
            Viewpoint::Free(offset, mat) => {
                let hip = poses.xpos.get(self.hip).copied().unwrap_or_default();
                poses.free = Some((add(hip, offset), mat));
                (poses, View::FREE)
            }
        }
    }

    fn binocular(&mut self, scenery: &Scenery, poses: &Poses) -> Result<(), FrameError> {
        let [left, right] = self.eyes.ok_or(FrameError::Camera("eye_left"))?;
        self.half(scenery, poses, Viewpoint::Camera(left))?;
        std::mem::swap(&mut self.half, &mut self.other);
        self.half(scenery, poses, Viewpoint::Camera(right))?;
        for (right, left) in self.half.chunks_exact_mut(3).zip(self.other.chunks_exact(3)) {
            let cyan = luma([right[0], right[1], right[2]]);
            right.copy_from_slice(&[luma([left[0], left[1], left[2]]), cyan, cyan]);
        }
        Ok(())
    }
}

fn view(camera: usize) -> View {
    View {
        camera,
        width: FRAME_HEIGHT,
        height: FRAME_HEIGHT,
    }
}

/// Writes a panel on the right, from row `top`.
fn place(panel: &[u8], out: &mut [u8], top: usize) {
    let lines = out.chunks_exact_mut(3 * FRAME_WIDTH).skip(top);
    for (line, row) in lines.zip(panel.chunks_exact(3 * PANEL)) {
        line[3 * FRAME_HEIGHT..].copy_from_slice(row);
    }
}
