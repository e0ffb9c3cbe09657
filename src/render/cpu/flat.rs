//! Bilinear lookups in two-dimensional textures, in llvmpipe's 8-bit arithmetic.

use wide::bytemuck::cast;
use wide::{f32x4, i32x4, u16x8, u32x4};

use super::lanes::{at_least, integers};
use super::light::Vec3x4;
use super::texels::{Coordinates, MipBlend, across, are_settled, channels, floor, gather, upward};
use crate::texture::{MipChain, MipLevel};

/// Denominator of the weights.
const ONE: u16 = 256;

/// The channels of four texels, 16 bits for each: red and blue, green and mark.
type Channels = [u16x8; 2];

/// Looks up the pixels of a block: red, green, blue; 0..255.
pub fn colours(face: &MipChain, [s, t, _]: &Coordinates) -> Vec3x4 {
    let (width, height) = (face[0].width as f32, face[0].height as f32);
    let length = |change: fn(f32x4) -> f32x4| {
        let (s, t) = (change(*s) * width, change(*t) * height);
        // llvmpipe takes the differences of the first pixel for the whole block
        (s * s + t * t).to_array()[0]
    };
    let squared = length(across).max(length(upward));
    let detail = MipBlend::new(f32x4::splat(squared), face.len());
    // all lanes are the same here
    let (level, share) = (detail.level.to_array()[0] as usize, detail.blend.to_array()[0]);
    let spots = FlatTexels::new(&face[level], *s, *t);
    let first = gather(spots.level, spots.places(spots.y.before, spots.x.before));
    // a texel around which there is one colour, here and in the next level, needs neither neighbours nor blending
    if face[level].has_one_colour() || are_settled(first) {
        return channels(first);
    }
    let mut out = spots.colours(first);
    if share > 0.0 {
        let spots = FlatTexels::new(&face[level + 1], *s, *t);
        let first = gather(spots.level, spots.places(spots.y.before, spots.x.before));
        out = lerp(out, spots.colours(first), u16x8::splat((share * f32::from(ONE)) as u16));
    }
    // 16-bit lanes: two channels of each texel fit into a 32-bit lane, and products of bytes and weights do not
    // overflow
    let [red_blue, green] = out.map(cast::<_, i32x4>);
    let low = i32x4::splat(0xffff);
    [red_blue & low, green & low, red_blue >> 16].map(f32x4::from_i32x4)
}

/// Spreads the bytes of texels.
#[inline(always)]
fn spread(texels: u32x4) -> Channels {
    let bytes = u32x4::splat(0x00ff_00ff);
    [cast(texels & bytes), cast(texels >> 8 & bytes)]
}

/// Lerps between bytes with weights of 0..256.
#[inline(always)]
fn lerp(a: Channels, b: Channels, weight: u16x8) -> Channels {
    // the sum of both products is at most 255 * 256, which 16 bits hold without a sign
    let rest = u16x8::splat(ONE) - weight;
    let one = |k: usize| (a[k] * rest + b[k] * weight + u16x8::splat(ONE / 2)) >> 8;
    [one(0), one(1)]
}

/// Coordinates along one axis of an image that wraps around (OpenGL's `GL_REPEAT`).
struct RepeatedAxis {
    /// Index of the texel before.
    before: f32x4,
    /// Index of the texel after.
    after: f32x4,
    /// Places between the two, 0..1.
    between: f32x4,
}

impl RepeatedAxis {
    #[inline(always)]
    fn new(at: f32x4, size: f32) -> Self {
        let n = f32x4::splat(size);
        // texels are sampled at their centres, half a texel in
        let at = (at - floor(at)) * n - 0.5;
        let low = floor(at);
        // NaN coordinates give an arbitrary texel
        let index = |v: f32x4| at_least(v, f32x4::ZERO).fast_min(n - 1.0);
        let (before, after) = (low, low + 1.0);
        Self {
            before: index(before.simd_lt(f32x4::ZERO).select(n - 1.0, before)),
            after: index(after.simd_ge(n).select(f32x4::ZERO, after)),
            between: at - low,
        }
    }

    /// Returns the weights of the texels after, 0..256, for two channels each.
    #[inline(always)]
    fn weight(&self) -> u16x8 {
        let one = f32::from(ONE);
        let weight = at_least(floor(self.between * one + 0.5), f32x4::ZERO);
        let weight = integers(weight.fast_min(f32x4::splat(one)));
        cast(weight | weight << 16)
    }
}

/// The texels of one mip level that the pixels of a block sample.
struct FlatTexels<'a> {
    level: &'a MipLevel,
    x: RepeatedAxis,
    y: RepeatedAxis,
}

impl<'a> FlatTexels<'a> {
    #[inline(always)]
    fn new(level: &'a MipLevel, s: f32x4, t: f32x4) -> Self {
        Self {
            level,
            x: RepeatedAxis::new(s, level.width as f32),
            y: RepeatedAxis::new(t, level.height as f32),
        }
    }

    /// Returns the indices of the texels at the crossings of a row and a column.
    #[inline(always)]
    fn places(&self, row: f32x4, column: f32x4) -> [i32; 4] {
        // textures are small enough for exact indices
        integers(row * self.level.width as f32 + column).to_array()
    }

    /// Looks up bilinearly; `first` are the texels before.
    #[inline(always)]
    fn colours(&self, first: u32x4) -> Channels {
        let (x, y) = (&self.x, &self.y);
        let at = |row: f32x4, column: f32x4| spread(gather(self.level, self.places(row, column)));
        let upper = lerp(spread(first), at(y.before, x.after), x.weight());
        let lower = lerp(at(y.after, x.before), at(y.after, x.after), x.weight());
        lerp(upper, lower, y.weight())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_blend_like_bytes() {
        let (a, b) = ([255, 0, 7, 128], [255, 255, 200, 3]);
        let of = |v: [u8; 4]| spread(u32x4::splat(u32::from_le_bytes(v)));
        for weight in 0..=256u16 {
            let [even, odd] = lerp(of(a), of(b), u16x8::splat(weight)).map(|v| v.to_array());
            for k in 0..4 {
                let found = [even[k / 2], odd[k / 2]][k % 2];
                let exact =
                    (u32::from(a[k]) * (256 - u32::from(weight)) + u32::from(b[k]) * u32::from(weight) + 128) / 256;
                assert_eq!(u32::from(found), exact, "{weight}");
            }
        }
    }
}
