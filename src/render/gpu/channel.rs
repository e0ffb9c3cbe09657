//! The kinds of images: colour, brightness, depth, geom ids.

use super::pipelines::Output;
use crate::luma;

/// A kind of image: [`Rgb`], [`Gray`], [`Depth`] or [`Segmentation`].
pub trait Channel: sealed::Channel {}

pub(super) mod sealed {
    use super::Output;

    /// The conversion from the device's output to values.
    pub trait Channel: std::fmt::Debug + Send + Sync + 'static {
        /// Type of one value.
        type Value: Copy + Default + std::fmt::Debug + PartialEq + Send + Sync + 'static;
        /// Number of values per pixel.
        const PER_PIXEL: usize;
        #[doc(hidden)]
        const OUTPUT: Output;
        #[doc(hidden)]
        fn unpack(row: &[u8], out: &mut [Self::Value]);
    }
}

/// Images in colour: red, green, blue of each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb;

/// Gray images: brightness with the weights 0.2989, 0.5870, 0.1140.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gray;

/// Depth: the distance (m) from the camera's plane to the surface at the centre of each pixel; infinity where there is
/// nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth;

/// Geom ids: the geom at the centre of each pixel; -1 where there is none. Sites occlude geoms behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segmentation;

impl sealed::Channel for Rgb {
    type Value = u8;
    const PER_PIXEL: usize = 3;
    const OUTPUT: Output = Output::Colour;

    fn unpack(row: &[u8], out: &mut [u8]) {
        for (rgb, pixel) in out.as_chunks_mut().0.iter_mut().zip(row.as_chunks().0) {
            let [r, g, b, _]: [u8; 4] = *pixel;
            *rgb = [r, g, b];
        }
    }
}

impl sealed::Channel for Gray {
    type Value = u8;
    const PER_PIXEL: usize = 1;
    const OUTPUT: Output = Output::Colour;

    fn unpack(row: &[u8], out: &mut [u8]) {
        for (gray, &[r, g, b, _]) in out.iter_mut().zip(row.as_chunks().0) {
            *gray = luma([r, g, b]);
        }
    }
}

impl sealed::Channel for Depth {
    type Value = f32;
    const PER_PIXEL: usize = 1;
    const OUTPUT: Output = Output::Measure;

    fn unpack(row: &[u8], out: &mut [f32]) {
        for (depth, &[a, b, c, d, ..]) in out.iter_mut().zip(row.as_chunks::<8>().0) {
            *depth = 1.0 / f32::from_le_bytes([a, b, c, d]);
        }
    }
}

impl sealed::Channel for Segmentation {
    type Value = i32;
    const PER_PIXEL: usize = 1;
    const OUTPUT: Output = Output::Measure;

    fn unpack(row: &[u8], out: &mut [i32]) {
        for (id, &[.., a, b, c, d]) in out.iter_mut().zip(row.as_chunks::<8>().0) {
            *id = i32::from_le_bytes([a, b, c, d]).wrapping_sub(1);
        }
    }
}

impl Channel for Rgb {}
impl Channel for Gray {}
impl Channel for Depth {}
impl Channel for Segmentation {}
