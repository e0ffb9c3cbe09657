//! The renderer in pure Rust, with a visibility buffer: rasterisation finds the triangle that each sample shows, and only
//! then are the visible triangles lit and shaded, each once per pixel (Burns and Hunt, "The Visibility Buffer: A
//! Cache-Friendly Approach to Deferred Shading", Journal of Computer Graphics Techniques 2, 2013).
//!
//! The way of an image through the files: `frame` culls and sorts drawables, `facing` culls back faces, `project` and
//! `triangles` with `clip` transform them, `group` and `small` set triangles up, `raster` fills the `target`, `visible` numbers
//! and `light` lights what is visible, `lit_plane` planes, `shade` with `plane`, `sample`, `flat` and `cube` colours it.

mod camera;
mod clip;
mod cube;
mod facing;
mod flat;
mod frame;
mod group;
mod lanes;
mod light;
mod lit_plane;
mod pixels;
mod plane;
mod project;
mod raster;
mod sample;
mod sampling;
mod shade;
mod sky;
mod small;
mod target;
mod texels;
mod triangles;
mod visible;

#[cfg(feature = "wgpu")]
pub(super) use camera::{Vec3f, ViewCamera, dot};
use frame::{Frame, Targets};
#[cfg(feature = "wgpu")]
pub(super) use light::{PlacedLight, place as place_lights};
use pixels::Pixels;
use shade::Shader;

use crate::RenderError;
use crate::drawable::Element;
use crate::scenery::Scenery;
use crate::view::{ImageBuffers, Poses, View, fits};

/// A renderer on the CPU. It keeps its buffers, so that drawing allocates nothing once the largest image has been
/// drawn.
///
/// Everything is single-precision and integer arithmetic in a fixed order: the same poses give the same bytes everywhere.
#[doc(alias("mjr_render", "mjrContext"))]
#[derive(Debug, Default)]
pub struct CpuRenderer {
    frame: Frame,
    shader: Shader,
    /// Working memory for gray images.
    colours: Vec<u8>,
    passes: u64,
}

impl CpuRenderer {
    /// Creates a renderer; its buffers grow with the images it draws.
    pub fn new() -> Self {
        Self::default()
    }

    /// Draws images of one view in one pass, those for which there are buffers. Each is the same as if it were drawn
    /// alone.
    ///
    /// # Errors
    /// Fails if the camera does not exist, the size is not allowed, or poses or a buffer have the wrong length.
    pub fn draw(
        &mut self,
        scenery: &Scenery,
        poses: &Poses,
        view: &View,
        images: ImageBuffers<'_>,
    ) -> Result<(), RenderError> {
        // checked before anything is drawn, so that a buffer of a wrong length costs nothing and the others do not change
        images.check(view)?;
        self.passes += 1;
        let ImageBuffers {
            rgb,
            gray,
            depth,
            segmentation,
        } = images;
        let frame = &mut self.frame;
        // depth and segmentation are of the centre of a pixel, colours of four samples around it: one pass over the
        // geometry fills both
        let targets = Targets {
            colour: rgb.is_some() || gray.is_some(),
            centre: depth.is_some() || segmentation.is_some(),
        };
        let eye = frame.begin(scenery, poses, view, targets)?;
        frame.draw_opaque(scenery, poses, &eye);
        if let Some(out) = depth {
            // before transparent drawables are added: depth does not show them, segmentation does
            frame.distances(out);
        }
        frame.draw_transparent(scenery, poses, &eye, segmentation.is_some());
        if let Some(out) = segmentation {
            frame.elements(out, |index| match scenery.drawables[index].element {
                Element::Geom(geom) => geom as i32,
                Element::Site(_) | Element::Tendon { .. } => -1,
                Element::FlexEdge { .. } | Element::Flex(_) | Element::Skin(_) => -1,
            });
        }
        if targets.colour {
            // gray is computed from the rounded bytes of the colour, so that it is the same whether one or both are requested
            let colours = match rgb {
                Some(out) => out,
                None => {
                    self.colours.resize(view.rgb_len(), 0);
                    &mut self.colours[..]
                }
            };
            self.shader
                .resolve(frame, scenery, poses, &eye, Pixels::All, &mut *colours);
            for (gray, pixel) in gray.into_iter().flatten().zip(colours.as_chunks().0) {
                *gray = luma(*pixel);
            }
        }
        Ok(())
    }

    /// Returns the number of passes over a scene's geometry so far.
    pub fn passes(&self) -> u64 {
        self.passes
    }

    /// Draws an image: red, green, blue of each pixel, rows from the top.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::draw`].
    pub fn rgb(&mut self, scenery: &Scenery, poses: &Poses, view: &View, out: &mut [u8]) -> Result<(), RenderError> {
        self.draw(scenery, poses, view, ImageBuffers::rgb(out))
    }

    /// Draws every second pixel of every second row of an image, the first ones included: the same pixels as those of [`CpuRenderer::rgb`], at a
    /// lower cost.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn rgb_halved(
        &mut self,
        scenery: &Scenery,
        poses: &Poses,
        view: &View,
        out: &mut [u8],
    ) -> Result<(), RenderError> {
        // the whole image is rasterised: an image of half the size would have different samples
        let half = View {
            width: view.width.div_ceil(2),
            height: view.height.div_ceil(2),
            ..*view
        };
        fits(out.len(), half.rgb_len())?;
        let targets = Targets {
            colour: true,
            centre: false,
        };
        self.passes += 1;
        let frame = &mut self.frame;
        let eye = frame.begin(scenery, poses, view, targets)?;
        frame.draw_opaque(scenery, poses, &eye);
        frame.draw_transparent(scenery, poses, &eye, false);
        self.shader.resolve(frame, scenery, poses, &eye, Pixels::Second, out);
        Ok(())
    }

    /// Draws a gray image: one byte for each pixel, rows from the top, with the weights 0.2989, 0.5870, 0.1140. `rgb` is
    /// working space of [`View::rgb_len`] bytes and holds the colours afterwards.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn gray(
        &mut self,
        scenery: &Scenery,
        poses: &Poses,
        view: &View,
        rgb: &mut [u8],
        out: &mut [u8],
    ) -> Result<(), RenderError> {
        let images = ImageBuffers {
            rgb: Some(rgb),
            ..ImageBuffers::gray(out)
        };
        self.draw(scenery, poses, view, images)
    }

    /// Draws depth: the distance (m) from the camera's plane to the surface at the centre of each pixel, rows from the top;
    /// infinity where there is none. Transparent drawables are left out.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn depth(&mut self, scenery: &Scenery, poses: &Poses, view: &View, out: &mut [f32]) -> Result<(), RenderError> {
        self.draw(scenery, poses, view, ImageBuffers::depth(out))
    }

    /// Draws geom ids: the geom at the centre of each pixel, rows from the top; -1 where there is none. Sites and
    /// tendons occlude geoms behind them, and so do transparent geoms.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn segmentation(
        &mut self,
        scenery: &Scenery,
        poses: &Poses,
        view: &View,
        out: &mut [i32],
    ) -> Result<(), RenderError> {
        self.draw(scenery, poses, view, ImageBuffers::segmentation(out))
    }
}

/// Returns the brightness of a colour, as `rgb2gray` computes it.
pub fn luma([r, g, b]: [u8; 3]) -> u8 {
    (0.2989 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b)) as u8
}
