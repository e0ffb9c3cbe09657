//! Mip levels and texels of a block of 2 x 2 pixels, with the arithmetic of Mesa's llvmpipe.

use wide::bytemuck::cast;
use wide::{f32x4, i32x4, u32x4, u64x2};

use super::lanes::four;
use super::light::Vec3x4;
use crate::texture::MipLevel;
use crate::texture::SETTLED;

/// The mip levels to blend at each pixel of a block, and their blend weights.
#[derive(Clone, Copy, Debug)]
pub struct MipBlend {
    pub level: i32x4,
    pub blend: f32x4,
}

impl MipBlend {
    /// Finds the mip levels from the squared number of texels per pixel. The logarithm is linear between powers of two,
    /// as in llvmpipe; magnified textures use the first level.
    #[inline(always)]
    pub fn new(squared: f32x4, levels: usize) -> Self {
        // the exponent is the whole part of the binary logarithm, and the mantissa minus 1 a straight line between
        // powers of two: llvmpipe's fast logarithm. Half of it, as lengths are squared.
        let bits: i32x4 = cast(squared);
        let exponent = f32x4::from_i32x4((bits >> 23 & i32x4::splat(255)) - i32x4::splat(127));
        let mantissa: f32x4 = cast(bits & i32x4::splat(0x007f_ffff) | i32x4::splat(0x3f80_0000));
        let level = 0.5 * (exponent + mantissa - f32x4::ONE);
        // never NaN
        let level = level.fast_max(f32x4::ZERO).fast_min(f32x4::splat(whole(levels) - 1.0));
        let first = level.fast_trunc_int();
        Self {
            level: first,
            blend: level - f32x4::from_i32x4(first),
        }
    }

    /// Returns whether the whole block has one level.
    #[inline(always)]
    pub fn same(&self) -> bool {
        let first = i32x4::splat(self.level.to_array()[0]);
        self.level.simd_eq(first).to_bitmask() == 15
    }

    /// Returns whether any pixel lies between two levels.
    #[inline(always)]
    pub fn blends(&self) -> bool {
        self.blend.simd_ne(f32x4::ZERO).to_bitmask() != 0
    }
}

/// Converts a number of texels or levels.
#[inline(always)]
pub fn whole(count: usize) -> f32 {
    // one instruction, where the conversion of unsigned 64 bits needs a branch
    count as i32 as f32
}

/// Texture coordinates of a block of 2 x 2 pixels, the lower two first.
pub type Coordinates = [f32x4; 3];

/// Returns the differences between the columns of a block, at each pixel.
#[inline(always)]
pub fn across(v: f32x4) -> f32x4 {
    // both pixels of a row have the difference between them, as `dFdx` of a quad has
    let v = v.to_array();
    f32x4::new([v[1], v[1], v[3], v[3]]) - f32x4::new([v[0], v[0], v[2], v[2]])
}

/// Returns the differences between the rows of a block, at each pixel.
#[inline(always)]
pub fn upward(v: f32x4) -> f32x4 {
    let v = v.to_array();
    f32x4::new([v[2], v[3], v[2], v[3]]) - f32x4::new([v[0], v[1], v[0], v[1]])
}

/// Gathers one texel for each pixel of a block.
#[inline(always)]
pub fn gather(level: &MipLevel, places: [i32; 4]) -> u32x4 {
    u32x4::new(four(|k| u32::from_le_bytes(level.pixels[places[k] as usize])))
}

/// Gathers four texels for each pixel of a block, given the index of the upper left one: upper left, upper right, lower left and lower right.
#[inline(always)]
pub fn gather_squares(level: &MipLevel, places: [i32; 4]) -> [u32x4; 4] {
    // 32 bits, so that no sum below needs a check that it does not overflow
    let width = level.width as u32 as usize;
    // two loads and one check of bounds for four texels
    let square = |k: usize| -> [u64; 2] {
        let at = places[k] as u32 as usize;
        let texels = &level.pixels[at..at + width + 2];
        let pair = |at: usize| cast([u32::from_le_bytes(texels[at]), u32::from_le_bytes(texels[at + 1])]);
        [pair(0), pair(width)]
    };
    let squares = four(square);
    // vectors from the start, so that compilers see the shuffles
    let two = |row: usize, k: usize| -> [u32; 4] {
        cast::<_, u32x4>(u64x2::new([squares[k][row], squares[k + 1][row]])).to_array()
    };
    let left = |a: [u32; 4], b: [u32; 4]| u32x4::new([a[0], a[2], b[0], b[2]]);
    let right = |a: [u32; 4], b: [u32; 4]| u32x4::new([a[1], a[3], b[1], b[3]]);
    let (upper, lower) = ([two(0, 0), two(0, 2)], [two(1, 0), two(1, 2)]);
    [
        left(upper[0], upper[1]),
        right(upper[0], upper[1]),
        left(lower[0], lower[1]),
        right(lower[0], lower[1]),
    ]
}

/// Returns whether all of these texels are [`SETTLED`].
#[inline(always)]
pub fn are_settled(texels: u32x4) -> bool {
    // the mark is stored in the byte of opacity, which textures here do not use: it costs no memory access
    let marks = texels & u32x4::splat(0xff00_0000);
    marks.simd_eq(u32x4::splat(u32::from(SETTLED) << 24)).to_bitmask() == 15
}

/// Returns red, green and blue of texels; 0..255.
#[inline(always)]
pub fn channels(texels: u32x4) -> Vec3x4 {
    let texels: i32x4 = cast(texels);
    let byte = |v: i32x4| f32x4::from_i32x4(v & i32x4::splat(255));
    [byte(texels), byte(texels >> 8), byte(texels >> 16)]
}

/// Rounds down to integers (floor), for numbers within +-2^22.
#[inline(always)]
pub fn floor(x: f32x4) -> f32x4 {
    // adding 1.5 * 2^23 rounds to the nearest integer
    let nearest = (x + 12_582_912.0) - 12_582_912.0;
    nearest - (nearest.simd_gt(x) & f32x4::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_follow_the_logarithm() {
        let of = |texels: f32| {
            let detail = MipBlend::new(f32x4::splat(texels * texels), 8);
            (detail.level.to_array()[0], detail.blend.to_array()[0])
        };
        assert_eq!(of(0.1), (0, 0.0));
        assert_eq!(of(4.0), (2, 0.0));
        assert_eq!(of(2.0 * std::f32::consts::SQRT_2).0, 1);
        assert!((of(2.0 * std::f32::consts::SQRT_2).1 - 0.5).abs() < 1e-5);
        assert_eq!(of(1e9), (7, 0.0));
        assert_eq!(of(f32::NAN), (7, 0.0));
    }
}
