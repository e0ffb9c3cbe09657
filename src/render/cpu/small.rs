//! Small triangles: which samples they may cover.

use wide::{f32x4, i32x4};

use super::lanes::integers;
use super::sampling::Sampling;

/// Triangles below this extent are small, 1/256 pixels: they contain at most one sample of each kind.
pub const PIXEL: i32 = 256;

/// The samples that a small triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct CoveredSamples {
    /// The lower left of the triangle's extent, 1/256 pixels.
    pub corner: [i32; 2],
    /// One bit for each kind of sample.
    pub samples: u32,
}

impl CoveredSamples {
    /// Returns the pixel in which a sample lies.
    #[inline(always)]
    pub fn pixel<S: Sampling>(&self, sample: usize) -> [i32; 2] {
        let along = |k: usize| {
            let from = self.corner[k];
            (from + ((S::PLACES[k][sample] - from) & (PIXEL - 1))) >> 8
        };
        [along(0), along(1)]
    }
}

/// Four quadrilaterals, each of two triangles, by their corners a, b, c, d: [a, b, d] and [b, c, d]. Corners are x and y,
/// whole numbers of 1/256 pixels.
pub struct Quads(pub [[f32x4; 2]; 4]);

impl Quads {
    /// Returns one bit for each quadrilateral, for its first and its second triangle; the others certainly show their back.
    #[inline(always)]
    pub fn front(&self) -> [u32; 2] {
        let [a, b, c, d] = &self.0;
        // rounding may make products equal, but does not change their order
        let front = |p: &[f32x4; 2], q: &[f32x4; 2], r: &[f32x4; 2]| {
            let (left, right) = ((q[0] - p[0]) * (r[1] - p[1]), (q[1] - p[1]) * (r[0] - p[0]));
            left.simd_ge(right).to_bitmask()
        };
        [front(a, b, d), front(b, c, d)]
    }

    /// Returns one bit for each quadrilateral that may cover a sample; the others certainly lie between the samples.
    #[inline(always)]
    pub fn hit<S: Sampling>(&self) -> u32 {
        let [a, b, c, d] = &self.0;
        let range = |k: usize| {
            let low = a[k].fast_min(b[k]).fast_min(c[k].fast_min(d[k]));
            let high = a[k].fast_max(b[k]).fast_max(c[k].fast_max(d[k]));
            (integers(low), integers(high - low))
        };
        let (x, y) = (range(0), range(1));
        let beyond = |(low, reach): (i32x4, i32x4), place: i32| -> i32x4 {
            // the first sample at or after the lower left, modulo a pixel: beyond the upper right there is none in
            // between
            ((i32x4::splat(place) - low) & i32x4::splat(PIXEL - 1)).simd_gt(reach)
        };
        let mut missed = !i32x4::ZERO;
        for k in 0..4 {
            missed &= beyond(x, S::PLACES[0][k]) | beyond(y, S::PLACES[1][k]);
        }
        15 & !missed.to_bitmask()
    }
}
