//! Sample positions in pixels, and the rows they form.

use std::marker::PhantomData;

use wide::i32x4;

/// Unit of sample positions in a pixel, 1/256 pixels; edge functions need no finer steps.
pub const GRAIN: i32 = 32;
/// Binary logarithm of [`GRAIN`].
pub const GRAIN_BITS: u32 = GRAIN.trailing_zeros();
/// The sample positions of a pixel.
pub trait Sampling {
    /// Positions from the lower left corner, to the right and upward, in units of [`GRAIN`].
    const PLACES: [[i32; 4]; 2];
    /// Positions to the right, pixels.
    const X: [f32; 4];
    /// Positions upward, pixels.
    const Y: [f32; 4];
    /// Number of rows of samples in a pixel, equally far apart; each has one horizontal position, in the order of
    /// `PLACES`.
    const ROWS: usize;

    /// Computes `dx y - dy x` at the sample positions.
    fn steps(dx: i32, dy: i32) -> i32x4;
}

/// Four samples per pixel, for images in colour.
pub struct FourSamples;
/// All samples at the centre of the pixel, for depth and segmentation.
pub struct PixelCentre;

impl Sampling for FourSamples {
    const PLACES: [[i32; 4]; 2] = [[3, 7, 1, 5], [1, 3, 5, 7]];
    const X: [f32; 4] = [0.375, 0.875, 0.125, 0.625];
    const Y: [f32; 4] = [0.125, 0.375, 0.625, 0.875];
    const ROWS: usize = 4;

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
    const PLACES: [[i32; 4]; 2] = [[4; 4]; 2];
    const X: [f32; 4] = [0.5; 4];
    const Y: [f32; 4] = [0.5; 4];
    const ROWS: usize = 1;

    #[inline(always)]
    fn steps(dx: i32, dy: i32) -> i32x4 {
        i32x4::splat(4 * (dx - dy))
    }
}

/// Rows of samples, counted from the lower edge of the image.
pub struct Rows<S> {
    pub first: i32,
    pub last: i32,
    sampling: PhantomData<S>,
}

impl<S: Sampling> Rows<S> {
    const SPACING: i32 = 256 / S::ROWS as i32;

    /// Returns the rows of samples within a range of heights, 1/256 pixels.
    #[inline(always)]
    pub fn within([low, high]: [i32; 2]) -> Self {
        let below = |y: i32| y.div_euclid(Self::SPACING);
        Self {
            first: below(low + (Self::SPACING / 2 - 1)),
            last: below(high - Self::SPACING / 2),
            sampling: PhantomData,
        }
    }

    /// Returns the height of a row, 1/256 pixels.
    #[inline(always)]
    pub fn height(row: i32) -> i32 {
        row * Self::SPACING + Self::SPACING / 2
    }

    /// Returns the index of a row within its pixel.
    #[inline(always)]
    pub fn index(row: i32) -> usize {
        row as usize % S::ROWS
    }

    /// Returns the horizontal position of a row's samples within their pixels, 1/256 pixels.
    #[inline(always)]
    pub fn place(row: i32) -> i32 {
        S::PLACES[0][Self::index(row)] * GRAIN
    }

    /// Returns one bit for each sample of the row in a pixel.
    #[inline(always)]
    pub fn samples(row: i32) -> u32 {
        15 >> (4 - 4 / S::ROWS) << Self::index(row)
    }
}
