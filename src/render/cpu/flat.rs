//! Lookups in two-dimensional textures, in 8-bit arithmetic: four channels in one integer.

use wide::f32x4;

use super::lanes::four;
use super::sample::{Coordinates, MipLevels, across, numbers, upward, whole};
use crate::render::texture::{Face, Level};

/// The channels of a texel, 16 bits for each: red, blue, green, opacity.
type Channels = u64;

/// Weights are parts of this.
const ONE: u64 = 256;
/// Half of [`ONE`] in every channel.
const HALF: Channels = 0x0080_0080_0080_0080;
/// The bits of a byte in every channel.
const BYTES: Channels = 0x00ff_00ff_00ff_00ff;

/// Looks up those pixels of a block that are `wanted`; 0..255.
pub fn colours(face: &Face, [s, t, _]: &Coordinates, wanted: [bool; 4]) -> [f32x4; 4] {
    let (width, height) = (face[0].width as f32, face[0].height as f32);
    let length = |change: fn(f32x4) -> f32x4| {
        let (s, t) = (change(*s) * width, change(*t) * height);
        (s * s + t * t).to_array()[0]
    };
    let squared = length(across).max(length(upward));
    let detail = MipLevels::new(f32x4::splat(squared), face.len());
    let (level, share) = (detail.level[0], detail.blend[0]);
    let mut out = at_level(&face[level], *s, *t, wanted);
    if share > 0.0 {
        let weight = (share * ONE as f32) as u64;
        let next = at_level(&face[level + 1], *s, *t, wanted);
        for k in 0..4 {
            out[k] = blend(out[k], next[k], weight);
        }
    }
    four(|k| numbers(joined(out[k])))
}

/// Spreads the bytes of a texel.
#[inline(always)]
fn spread(texel: [u8; 4]) -> Channels {
    let v = u64::from(u32::from_le_bytes(texel));
    v & 0x00ff_00ff | (v & 0xff00_ff00) << 24
}

/// Joins the bytes of a texel, the inverse of [`spread`].
#[inline(always)]
fn joined(v: Channels) -> [u8; 4] {
    ((v | v >> 24) as u32).to_le_bytes()
}

/// Blends bytes with a weight of 0..256.
#[inline(always)]
fn blend(a: Channels, b: Channels, weight: u64) -> Channels {
    (a * (ONE - weight) + b * weight + HALF) >> 8 & BYTES
}

/// Coordinates along one axis of an image that repeats.
struct RepeatedAxis {
    /// Index of the texel before.
    before: f32x4,
    /// Index of the texel after.
    after: f32x4,
    /// Weights of the texels after, 0..256.
    weight: [i32; 4],
}

impl RepeatedAxis {
    #[inline(always)]
    fn new(at: f32x4, size: f32) -> Self {
        let n = f32x4::splat(size);
        let at = (at - whole(at)) * n - 0.5;
        let low = whole(at);
        // NaN coordinates give an arbitrary texel
        let index = |v: f32x4| v.max(f32x4::ZERO).fast_min(n - 1.0);
        let (before, after) = (low, low + 1.0);
        let weight = whole((at - low) * ONE as f32 + 0.5).max(f32x4::ZERO);
        Self {
            before: index(before.simd_lt(f32x4::ZERO).select(n - 1.0, before)),
            after: index(after.simd_ge(n).select(f32x4::ZERO, after)),
            weight: weight.fast_min(f32x4::splat(ONE as f32)).fast_trunc_int().to_array(),
        }
    }
}

#[inline(always)]
fn at_level(level: &Level, s: f32x4, t: f32x4, wanted: [bool; 4]) -> [Channels; 4] {
    let width = level.width as f32;
    let (x, y) = (RepeatedAxis::new(s, width), RepeatedAxis::new(t, level.height as f32));
    // textures are small enough for exact indices
    let place = |row: f32x4, column: f32x4| (row + column).fast_trunc_int().to_array();
    let (upper, lower) = (y.before * width, y.after * width);
    let places = [
        place(upper, x.before),
        place(upper, x.after),
        place(lower, x.before),
        place(lower, x.after),
    ];
    let mut out = [0; 4];
    for k in 0..4 {
        if wanted[k] {
            let [a, b, c, d] = four(|i| spread(level.pixels[places[i][k] as usize]));
            let (wx, wy) = (x.weight[k] as u64, y.weight[k] as u64);
            out[k] = blend(blend(a, b, wx), blend(c, d, wx), wy);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_blend_like_bytes() {
        let (a, b) = ([255, 0, 7, 128], [255, 255, 200, 3]);
        assert_eq!(joined(spread(a)), a);
        for weight in 0..=256u32 {
            let found = joined(blend(spread(a), spread(b), u64::from(weight)));
            for k in 0..4 {
                let exact = (u32::from(a[k]) * (256 - weight) + u32::from(b[k]) * weight + 128) / 256;
                assert_eq!(u32::from(found[k]), exact, "{weight}");
            }
        }
    }
}
