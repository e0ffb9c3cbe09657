//! Sample positions in pixels.

use wide::i32x4;

/// Unit of sample positions in a pixel, 1/256 pixels; edge functions need no finer steps.
pub const GRAIN: i32 = 32;
/// Binary logarithm of [`GRAIN`].
pub const GRAIN_BITS: u32 = GRAIN.trailing_zeros();
/// The sample positions of a pixel.
pub trait Sampling {
    /// Positions from the lower left corner, to the right and upward, 1/256 pixels: multiples of [`GRAIN`].
    const PLACES: [[i32; 4]; 2];
    /// Positions to the right, pixels.
    const X: [f32; 4];
    /// Positions upward, pixels.
    const Y: [f32; 4];

    /// Computes `dx y - dy x` at the sample positions.
    fn steps(dx: i32, dy: i32) -> i32x4;
}

/// Four samples per pixel, for images in colour.
pub struct FourSamples;
/// All samples at the centre of the pixel, for depth and segmentation.
pub struct PixelCentre;

impl Sampling for FourSamples {
    // llvmpipe's pattern of four: no two samples in one row or column, so that nearly horizontal and vertical edges
    // have four steps
    const PLACES: [[i32; 4]; 2] = [[96, 224, 32, 160], [32, 96, 160, 224]];
    const X: [f32; 4] = [0.375, 0.875, 0.125, 0.625];
    const Y: [f32; 4] = [0.125, 0.375, 0.625, 0.875];

    #[inline(always)]
    fn steps(dx: i32, dy: i32) -> i32x4 {
        // sums are cheaper than products of vectors
        let (dx2, dy2) = (dx + dx, dy + dy);
        let (dx3, dy3) = (dx + dx2, dy + dy2);
        let (dx5, dy5) = (dx3 + dx2, dy3 + dy2);
        i32x4::new([dx - dy3, dx3 - (dy5 + dy2), dx5 - dy, dx5 + dx2 - dy5])
    }
}

impl Sampling for PixelCentre {
    const PLACES: [[i32; 4]; 2] = [[128; 4]; 2];
    const X: [f32; 4] = [0.5; 4];
    const Y: [f32; 4] = [0.5; 4];

    #[inline(always)]
    fn steps(dx: i32, dy: i32) -> i32x4 {
        i32x4::splat(4 * (dx - dy))
    }
}
