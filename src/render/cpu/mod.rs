//! The renderer in pure Rust: it finds the triangle that each sample shows, then the colours of what is seen.

mod camera;
mod clip;
mod flat;
mod frame;
mod light;
mod plane;
mod raster;
mod sample;
mod sampling;
mod shade;
mod target;

#[cfg(feature = "wgpu")]
pub(super) use camera::{Eye, V3, dot, single};
#[cfg(feature = "wgpu")]
pub(super) use frame::pose;
use frame::{Frame, Transparency};
#[cfg(feature = "wgpu")]
pub(super) use light::{PlacedLight, place as place_lights};
use sampling::{FourSamples, PixelCentre};
use shade::{Pixels, Shader};

use crate::render::RenderError;
use crate::render::view::{Poses, View};
use crate::render::visual::{Element, Visual};

/// A renderer on the CPU. It keeps its buffers, so that drawing allocates nothing once the largest image has been
/// drawn.
///
/// Everything is single-precision and integer arithmetic in a fixed order: the same poses give the same bytes everywhere.
#[derive(Debug, Default)]
pub struct CpuRenderer {
    frame: Frame,
    shader: Shader,
}

impl CpuRenderer {
    /// Creates a renderer; its buffers grow with the images it draws.
    pub fn new() -> Self {
        Self::default()
    }

    /// Draws an image: red, green, blue of each pixel, rows from the top.
    ///
    /// # Errors
    /// Fails if the camera does not exist, the size is not allowed, or poses or the buffer have the wrong length.
    pub fn rgb(&mut self, visual: &Visual, poses: &Poses, view: &View, out: &mut [u8]) -> Result<(), RenderError> {
        fits(out.len(), view.rgb_len())?;
        let eye = self
            .frame
            .draw::<FourSamples>(visual, poses, view, Transparency::Blended)?;
        self.shader
            .resolve(&mut self.frame, visual, poses, &eye, (Pixels::All, out));
        Ok(())
    }

    /// Draws every second pixel of every second row of an image, the first ones included: the same as those of
    /// [`CpuRenderer::rgb`], for less.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn rgb_halved(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        out: &mut [u8],
    ) -> Result<(), RenderError> {
        let half = View {
            width: view.width.div_ceil(2),
            height: view.height.div_ceil(2),
            ..*view
        };
        fits(out.len(), half.rgb_len())?;
        let eye = self
            .frame
            .draw::<FourSamples>(visual, poses, view, Transparency::Blended)?;
        self.shader
            .resolve(&mut self.frame, visual, poses, &eye, (Pixels::Second, out));
        Ok(())
    }

    /// Draws a grey image: one byte for each pixel, rows from the top, by the weights 0.2989, 0.5870, 0.1140. `rgb` is
    /// working space of [`View::rgb_len`] bytes and holds the colours afterwards.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn gray(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        rgb: &mut [u8],
        out: &mut [u8],
    ) -> Result<(), RenderError> {
        fits(out.len(), view.pixels())?;
        self.rgb(visual, poses, view, rgb)?;
        for (gray, pixel) in out.iter_mut().zip(rgb.chunks_exact(3)) {
            *gray = luma([pixel[0], pixel[1], pixel[2]]);
        }
        Ok(())
    }

    /// Draws depth: the distance (m) from the camera's plane to what the middle of each pixel shows, rows from the top;
    /// infinity where a pixel shows nothing. Transparent things are not drawn.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn depth(&mut self, visual: &Visual, poses: &Poses, view: &View, out: &mut [f32]) -> Result<(), RenderError> {
        fits(out.len(), view.pixels())?;
        self.frame
            .draw::<PixelCentre>(visual, poses, view, Transparency::Hidden)?;
        for (row, line) in out.chunks_exact_mut(view.width).rev().enumerate() {
            for (column, v) in line.iter_mut().enumerate() {
                *v = self.frame.distance(column, row);
            }
        }
        Ok(())
    }

    /// Draws geom ids: the geom that the middle of each pixel shows, rows from the top; -1 where it shows none. Sites
    /// hide what is behind them, and so do transparent geoms.
    ///
    /// # Errors
    /// Fails like [`CpuRenderer::rgb`].
    pub fn segmentation(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        out: &mut [i32],
    ) -> Result<(), RenderError> {
        fits(out.len(), view.pixels())?;
        self.frame
            .draw::<PixelCentre>(visual, poses, view, Transparency::Opaque)?;
        let target = &self.frame.target;
        for (row, line) in out.chunks_exact_mut(view.width).rev().enumerate() {
            for (v, id) in line.iter_mut().zip(&target.ids[row * view.width..]) {
                let drawable = target
                    .records
                    .get(id[0] as usize)
                    .map(|r| &visual.drawables[r.draw as usize]);
                *v = match drawable.map(|d| d.element) {
                    Some(Element::Geom(g)) => g as i32,
                    _ => -1,
                };
            }
        }
        Ok(())
    }
}

/// Returns the brightness of a colour, as `rgb2gray` computes it.
pub(crate) fn luma([r, g, b]: [u8; 3]) -> u8 {
    (0.2989 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b)) as u8
}

fn fits(found: usize, expected: usize) -> Result<(), RenderError> {
    if found == expected {
        Ok(())
    } else {
        Err(RenderError::Buffer { found, expected })
    }
}
