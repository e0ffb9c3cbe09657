//! Requests for images: camera, size, poses.

use crate::math::{Mat3, Vec3, add_scaled, cross};
use crate::model::Model;
use crate::{MAX_SIZE, RenderError};
use mjcf_sim_physics::State;

/// A camera and the size of an image from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Camera of the model, by id, or [`View::FREE`].
    pub camera: usize,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
}

impl View {
    /// The camera that [`Poses::free`] places, with the field of view of [`Scenery::fovy`](crate::Scenery::fovy).
    pub const FREE: usize = usize::MAX;

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

/// A camera that looks at a point from anywhere, like MuJoCo's `mjvCamera`: the one that users move.
///
/// ```
/// use mjcf_sim::render::FreeCamera;
///
/// let camera = FreeCamera { lookat: [0.0, 0.0, 0.3], distance: 1.5, azimuth: 90.0, elevation: -90.0 };
/// let (position, _orientation) = camera.pose()?;
/// assert!((position[2] - 1.8).abs() < 1e-12); // straight above the point
/// # Ok::<(), mjcf_sim::render::RenderError>(())
/// ```
#[doc(alias("mjvCamera", "mjCAMERA_FREE"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeCamera {
    /// Point at the centre of the image, world, m.
    pub lookat: Vec3,
    /// Distance from it, m.
    pub distance: f64,
    /// Direction of view about the vertical axis, degrees: 0 looks along x, 90 along y.
    pub azimuth: f64,
    /// Direction of view above the horizon, degrees: -90 looks straight down.
    pub elevation: f64,
}

impl FreeCamera {
    /// Returns the initial camera of MuJoCo's viewer: it looks at the centre of the model from 1.5 times its extent, in the model's direction, by
    /// default along y and downwards.
    #[doc(alias = "mjv_defaultFreeCamera")]
    pub fn of(model: &Model) -> Self {
        Self {
            lookat: model.stat.center,
            distance: 1.5 * model.stat.extent,
            azimuth: model.vis.azimuth,
            elevation: model.vis.elevation,
        }
    }

    /// Returns position (m) and orientation in the world.
    ///
    /// # Errors
    /// Fails if a number is not finite.
    pub fn pose(&self) -> Result<(Vec3, Mat3), RenderError> {
        let [x, y, z] = self.lookat;
        if ![x, y, z, self.distance, self.azimuth, self.elevation]
            .iter()
            .all(|v| v.is_finite())
        {
            return Err(RenderError::FreeCamera);
        }
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        let (ca, sa) = (pxfm::f_cos(azimuth), pxfm::f_sin(azimuth));
        let (ce, se) = (pxfm::f_cos(elevation), pxfm::f_sin(elevation));
        let forward = [ce * ca, ce * sa, se];
        let up = [-se * ca, -se * sa, ce];
        let right = cross(forward, up);
        let [r, u, f] = [right, up, forward];
        let mat = [r[0], u[0], -f[0], r[1], u[1], -f[1], r[2], u[2], -f[2]];
        Ok((add_scaled(self.lookat, forward, -self.distance), mat))
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
    /// Sizes of the geoms, m, which a program may change: [`Params::geom_size`](mjcf_sim_physics::Params::geom_size).
    pub geom_size: &'a [Vec3],
    /// Positions of the sites.
    pub site_xpos: &'a [Vec3],
    /// Orientations of the sites.
    pub site_xmat: &'a [Mat3],
    /// First point of each tendon in `wrap_xpos`.
    pub ten_wrapadr: &'a [usize],
    /// Number of points of each tendon; 0 for fixed ones.
    pub ten_wrapnum: &'a [usize],
    /// Points that spatial tendons run through.
    pub wrap_xpos: &'a [Vec3],
    /// The geom that each of these points is on, -1 for a site, -2 for a pulley.
    pub wrap_obj: &'a [i32],
    /// Positions of the cameras.
    pub cam_xpos: &'a [Vec3],
    /// Orientations of the cameras.
    pub cam_xmat: &'a [Mat3],
    /// Position and orientation of the free camera, if there is one: [`FreeCamera::pose`].
    pub free: Option<(Vec3, Mat3)>,
    /// Positions of the bodies, which carry the lights.
    pub xpos: &'a [Vec3],
    /// Orientations of the bodies.
    pub xmat: &'a [Mat3],
    /// Centres of mass of the bodies with those below them, which some lights follow.
    pub subtree_com: &'a [Vec3],
    /// Positions of the vertices of flexes.
    pub flexvert_xpos: &'a [Vec3],
}

impl<'a> From<&'a State> for Poses<'a> {
    /// Returns the poses at the start of the last physics step.
    fn from(s: &'a State) -> Self {
        Self {
            geom_xpos: &s.geom_xpos,
            geom_xmat: &s.geom_xmat,
            geom_size: &s.params.geom_size,
            site_xpos: &s.site_xpos,
            site_xmat: &s.site_xmat,
            ten_wrapadr: &s.ten_wrapadr,
            ten_wrapnum: &s.ten_wrapnum,
            wrap_xpos: &s.wrap_xpos,
            wrap_obj: &s.wrap_obj,
            cam_xpos: &s.cam_xpos,
            cam_xmat: &s.cam_xmat,
            free: None,
            xpos: &s.xpos,
            xmat: &s.xmat,
            subtree_com: &s.subtree_com,
            flexvert_xpos: &s.flexvert_xpos,
        }
    }
}

/// Memory for images of one view, each with rows from the top; those that are `None` are not drawn.
#[derive(Debug, Default)]
pub struct ImageBuffers<'a> {
    /// Red, green and blue, (H, W, 3).
    pub rgb: Option<&'a mut [u8]>,
    /// Brightness by the weights 0.2989, 0.5870, 0.1140, (H, W).
    pub gray: Option<&'a mut [u8]>,
    /// Distance (m) from the camera's plane to the surface at the centre of each pixel, (H, W); infinite where there is
    /// nothing. Transparent drawables are left out.
    pub depth: Option<&'a mut [f32]>,
    /// The id of the geom at the centre of each pixel, (H, W); -1 where there is none. Sites and tendons occlude geoms
    /// behind them, and so do transparent geoms.
    pub segmentation: Option<&'a mut [i32]>,
}

impl<'a> ImageBuffers<'a> {
    /// Requests an image in colour alone.
    pub fn rgb(out: &'a mut [u8]) -> Self {
        let rgb = Some(out);
        Self { rgb, ..Self::default() }
    }

    /// Requests a gray image alone.
    pub fn gray(out: &'a mut [u8]) -> Self {
        let gray = Some(out);
        Self {
            gray,
            ..Self::default()
        }
    }

    /// Requests depth alone.
    pub fn depth(out: &'a mut [f32]) -> Self {
        let depth = Some(out);
        Self {
            depth,
            ..Self::default()
        }
    }

    /// Requests geom ids alone.
    pub fn segmentation(out: &'a mut [i32]) -> Self {
        let segmentation = Some(out);
        Self {
            segmentation,
            ..Self::default()
        }
    }

    /// Checks the lengths.
    pub(super) fn check(&self, view: &View) -> Result<(), RenderError> {
        let lengths = [
            (self.rgb.as_ref().map(|v| v.len()), view.rgb_len()),
            (self.gray.as_ref().map(|v| v.len()), view.pixels()),
            (self.depth.as_ref().map(|v| v.len()), view.pixels()),
            (self.segmentation.as_ref().map(|v| v.len()), view.pixels()),
        ];
        for (found, expected) in lengths {
            fits(found.unwrap_or(expected), expected)?;
        }
        Ok(())
    }
}

/// Checks the length of a buffer.
pub(super) fn fits(found: usize, expected: usize) -> Result<(), RenderError> {
    if found == expected {
        Ok(())
    } else {
        Err(RenderError::Buffer { found, expected })
    }
}

impl Poses<'_> {
    /// Returns position and orientation of a camera.
    pub(super) fn camera(&self, camera: usize) -> Option<(Vec3, Mat3)> {
        match camera {
            View::FREE => self.free,
            id => self.cam_xpos.get(id).copied().zip(self.cam_xmat.get(id).copied()),
        }
    }
}

/// A request for an image: poses of an environment, and the view.
#[derive(Clone, Copy, Debug)]
pub struct RenderRequest<'a> {
    /// Poses of everything at the time of the image.
    pub poses: Poses<'a>,
    /// Camera and size.
    pub view: View,
}
