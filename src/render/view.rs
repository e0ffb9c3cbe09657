//! Requests for images: camera, size, poses.

use crate::math::{Mat3, Vec3};
use crate::render::{MAX_SIZE, RenderError};

/// A camera and the size of an image from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Camera of the model, by id.
    pub camera: usize,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
}

impl View {
    /// Returns the number of pixels; it saturates for sizes that [`View::check`] refuses.
    pub fn pixels(&self) -> usize {
        self.width.saturating_mul(self.height)
    }

    /// Checks the size.
    ///
    /// # Errors
    /// Fails if the width or height is 0 or above [`MAX_SIZE`].
    pub fn check(&self) -> Result<(), RenderError> {
        let fine = 1..=MAX_SIZE;
        if fine.contains(&self.width) && fine.contains(&self.height) {
            Ok(())
        } else {
            Err(RenderError::Size {
                width: self.width,
                height: self.height,
            })
        }
    }

    /// Returns the length of a buffer for red, green and blue.
    pub fn rgb_len(&self) -> usize {
        self.pixels().saturating_mul(3)
    }
}

/// Poses of everything in the world, indexed as in the model: positions in m, row-major matrices with the local axes as
/// columns. Cameras look along their -z.
#[derive(Clone, Copy, Debug)]
pub struct Poses<'a> {
    /// Positions of the geoms.
    pub geom_xpos: &'a [Vec3],
    /// Orientations of the geoms.
    pub geom_xmat: &'a [Mat3],
    /// Positions of the sites.
    pub site_xpos: &'a [Vec3],
    /// Orientations of the sites.
    pub site_xmat: &'a [Mat3],
    /// Positions of the cameras.
    pub cam_xpos: &'a [Vec3],
    /// Orientations of the cameras.
    pub cam_xmat: &'a [Mat3],
    /// Positions of the bodies, which carry the lights.
    pub xpos: &'a [Vec3],
    /// Orientations of the bodies.
    pub xmat: &'a [Mat3],
    /// Centres of mass of the bodies with those below them, which some lights follow.
    pub subtree_com: &'a [Vec3],
}

/// A request for an image: poses of an environment, and the view.
#[derive(Clone, Copy, Debug)]
pub struct RenderRequest<'a> {
    /// Poses of everything at the time of the image.
    pub poses: Poses<'a>,
    /// Camera and size.
    pub view: View,
}
