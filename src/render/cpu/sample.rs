//! Texture lookups as in Mesa's llvmpipe: bilinear in two mip levels, with one level of detail per 2 x 2 pixels.

use std::ops::Neg;

use wide::f32x4;

use crate::render::texture::{Face, Level, Texture};

/// The mip levels to blend at each pixel of a block, and their blend weights.
#[derive(Clone, Copy, Debug)]
struct MipLevels {
    level: [usize; 4],
    blend: [f32; 4],
}

impl MipLevels {
    /// Finds the mip levels from the squared number of texels per pixel. The logarithm is linear between powers of two,
    /// as in llvmpipe; magnified textures use the first level.
    fn new(squared: f32x4, levels: usize) -> Self {
        let bits = squared.to_array().map(f32::to_bits);
        let exponent = f32x4::new(bits.map(|b| ((b >> 23 & 255) as i32 - 127) as f32));
        let mantissa = f32x4::new(bits.map(|b| f32::from_bits(b & 0x007f_ffff | 0x3f80_0000)));
        let level = 0.5 * (exponent + mantissa - f32x4::ONE);
        // never NaN
        let level = level.fast_max(f32x4::ZERO).fast_min(f32x4::splat(levels as f32 - 1.0));
        let whole = level.fast_trunc_int();
        Self {
            level: whole.to_array().map(|l| l as usize),
            blend: (level - f32x4::from_i32x4(whole)).to_array(),
        }
    }

    fn blends(&self) -> bool {
        self.blend != [0.0; 4]
    }
}

/// Texture coordinates of a block of 2 x 2 pixels, the lower two first.
pub type Coordinates = [f32x4; 3];

impl Texture {
    /// Returns the colours (red, green, blue, opacity; 0..1) at those pixels of a block that are `wanted`. Flat
    /// textures have one level of detail for the whole block, cube maps one for each pixel.
    pub fn sample(&self, at: &Coordinates, wanted: [bool; 4]) -> [f32x4; 4] {
        let colours = match self {
            Texture::Flat(face) => flat(face, at, wanted),
            Texture::Cube(faces) => CubePoints::new(faces, at).colours(faces, wanted),
        };
        colours.map(|c| c * f32x4::splat(1.0 / 255.0))
    }
}

/// Returns the differences between the columns of a block, at each pixel.
#[inline(always)]
fn across(v: f32x4) -> f32x4 {
    let v = v.to_array();
    let (low, high) = (v[1] - v[0], v[3] - v[2]);
    f32x4::new([low, low, high, high])
}

/// Returns the differences between the rows of a block, at each pixel.
#[inline(always)]
fn upward(v: f32x4) -> f32x4 {
    let v = v.to_array();
    let (left, right) = (v[2] - v[0], v[3] - v[1]);
    f32x4::new([left, right, left, right])
}

/// The points of a cube map at which the pixels of a block look.
struct CubePoints {
    side: [u8; 4],
    u: f32x4,
    v: f32x4,
    detail: MipLevels,
}

impl CubePoints {
    #[inline(always)]
    fn new(faces: &[Face; 6], at: &Coordinates) -> Self {
        let side = sides_of(at);
        if side == [side[0]; 4] {
            Self::on(faces, side[0], at)
        } else {
            Self::apart(faces, side, at)
        }
    }

    /// Locates pixels that lie on several sides: each as if the whole block were on its side.
    #[cold]
    fn apart(faces: &[Face; 6], side: [u8; 4], at: &Coordinates) -> Self {
        let own = side.map(|side| Self::on(faces, side, at));
        let each = |value: &dyn Fn(&Self) -> [f32; 4]| {
            let mut out = [0.0; 4];
            for k in 0..4 {
                out[k] = value(&own[k])[k];
            }
            out
        };
        let mut level = [0; 4];
        for k in 0..4 {
            level[k] = own[k].detail.level[k];
        }
        Self {
            side,
            u: f32x4::new(each(&|p| p.u.to_array())),
            v: f32x4::new(each(&|p| p.v.to_array())),
            detail: MipLevels {
                level,
                blend: each(&|p| p.detail.blend),
            },
        }
    }

    /// Locates pixels as if all of them were on one side.
    #[inline(always)]
    fn on(faces: &[Face; 6], side: u8, at: &Coordinates) -> Self {
        let (sc, tc, ma) = components(side, *at);
        // a zero direction has no side; any colour will do
        let least = f32x4::splat(f32::MIN_POSITIVE);
        let inverse = f32x4::ONE / ma.simd_gt(least).select(ma, least);
        let half = 0.5 * inverse;
        let scale = half * f32x4::splat(faces[0][0].width as f32);
        let length = |change: fn(f32x4) -> f32x4| {
            let shift = change(ma) * inverse;
            let s = (change(sc) - shift * sc) * scale;
            let t = (change(tc) - shift * tc) * scale;
            s * s + t * t
        };
        let (right, up) = (length(across), length(upward));
        Self {
            side: [side; 4],
            u: sc * half + 0.5,
            v: tc * half + 0.5,
            detail: MipLevels::new(right.simd_gt(up).select(right, up), faces[0].len()),
        }
    }

    #[inline(always)]
    fn colours(&self, faces: &[Face; 6], wanted: [bool; 4]) -> [f32x4; 4] {
        let mut colours = self.at_level(faces, self.detail.level, wanted);
        if self.detail.blends() {
            let last = faces[0].len() - 1;
            let next = self.at_level(faces, self.detail.level.map(|l| (l + 1).min(last)), wanted);
            for k in 0..4 {
                colours[k] += f32x4::splat(self.detail.blend[k]) * (next[k] - colours[k]);
            }
        }
        colours
    }

    /// Looks up bilinearly in one mip level for each pixel, across the edges of the cube where needed; 0..255.
    #[inline(always)]
    fn at_level(&self, faces: &[Face; 6], level: [usize; 4], wanted: [bool; 4]) -> [f32x4; 4] {
        let mut size = [0.0; 4];
        for k in 0..4 {
            size[k] = faces[usize::from(self.side[k])][level[k]].width as f32;
        }
        let size = f32x4::new(size);
        let (x, y) = (self.u * size - 0.5, self.v * size - 0.5);
        let (left, top) = (whole(x), whole(y));
        let (wx, wy) = ((x - left).to_array(), (y - top).to_array());
        let index = |v: f32x4| {
            let v = v.max(f32x4::splat(-1.0)).fast_min(size - 1.0);
            v.fast_trunc_int().to_array()
        };
        let (left, top) = (index(left), index(top));
        let mut out = [f32x4::ZERO; 4];
        for k in (0..4).filter(|&k| wanted[k]) {
            let image = &faces[usize::from(self.side[k])][level[k]];
            let n = image.width;
            let last = n as u32 - 1;
            let [a, b, c, d] = if (left[k] as u32) < last && (top[k] as u32) < last {
                let i = top[k] as usize * n + left[k] as usize;
                let block = &image.pixels[i..i + n + 2];
                [block[0], block[1], block[n], block[n + 1]]
            } else {
                across_edges(faces, self.side[k], level[k], left[k], top[k])
            };
            let [a, b, c, d] = [numbers(a), numbers(b), numbers(c), numbers(d)];
            let wx = f32x4::splat(wx[k]);
            let (upper, lower) = (a + wx * (b - a), c + wx * (d - c));
            out[k] = upper + f32x4::splat(wy[k]) * (lower - upper);
        }
        out
    }
}

/// Converts bytes to numbers.
#[inline(always)]
fn numbers(v: [u8; 4]) -> f32x4 {
    let mut out = [0.0; 4];
    for k in 0..4 {
        out[k] = f32::from(v[k]);
    }
    f32x4::new(out)
}

/// Rounds down to integers, for numbers within +-2^22.
#[inline(always)]
fn whole(x: f32x4) -> f32x4 {
    // adding 1.5 * 2^23 rounds to the nearest integer
    let nearest = (x + 12_582_912.0) - 12_582_912.0;
    nearest - (nearest.simd_gt(x) & f32x4::ONE)
}

/// Blends bytes with a weight of 0..256, in integers.
#[inline(always)]
fn blend(a: f32x4, b: f32x4, weight: f32) -> f32x4 {
    let sum = a * (256.0 - weight) + b * weight + 128.0;
    f32x4::from_i32x4((sum * (1.0 / 256.0)).fast_trunc_int())
}

/// Looks up in a two-dimensional texture, in 8-bit arithmetic.
fn flat(face: &Face, [s, t, _]: &Coordinates, wanted: [bool; 4]) -> [f32x4; 4] {
    let length = |change: fn(f32x4) -> f32x4| {
        let s = change(*s) * f32x4::splat(face[0].width as f32);
        let t = change(*t) * f32x4::splat(face[0].height as f32);
        (s * s + t * t).to_array()[0]
    };
    let squared = length(across).max(length(upward));
    let detail = MipLevels::new(f32x4::splat(squared), face.len());
    let (level, share) = (detail.level[0], detail.blend[0]);
    let mut out = flat_level(&face[level], *s, *t, wanted);
    if share > 0.0 {
        let weight = (share * 256.0).trunc();
        let next = flat_level(&face[level + 1], *s, *t, wanted);
        for k in 0..4 {
            out[k] = blend(out[k], next[k], weight);
        }
    }
    out
}

/// Coordinates along one axis of an image that repeats.
struct RepeatedAxis {
    /// Indices of the texels before and after.
    texels: [[usize; 4]; 2],
    /// Weights of the texels after, 0..256.
    weight: [f32; 4],
}

impl RepeatedAxis {
    #[inline(always)]
    fn new(at: f32x4, size: usize) -> Self {
        let n = f32x4::splat(size as f32);
        let at = (at - whole(at)) * n - 0.5;
        let low = whole(at);
        // NaN coordinates give an arbitrary texel
        let index = |v: f32x4| {
            let v = v.max(f32x4::ZERO).fast_min(n - 1.0);
            v.fast_trunc_int().to_array().map(|i| i as usize)
        };
        let (before, after) = (low, low + 1.0);
        Self {
            texels: [
                index(before.simd_lt(f32x4::ZERO).select(n - 1.0, before)),
                index(after.simd_ge(n).select(f32x4::ZERO, after)),
            ],
            weight: whole((at - low) * 256.0 + 0.5).max(f32x4::ZERO).to_array(),
        }
    }
}

#[inline(always)]
fn flat_level(level: &Level, s: f32x4, t: f32x4, wanted: [bool; 4]) -> [f32x4; 4] {
    let (x, y) = (RepeatedAxis::new(s, level.width), RepeatedAxis::new(t, level.height));
    let mut out = [f32x4::ZERO; 4];
    for k in (0..4).filter(|&k| wanted[k]) {
        let row = |y: &[usize; 4]| {
            let row = &level.pixels[y[k] * level.width..][..level.width];
            let (left, right) = (row[x.texels[0][k]], row[x.texels[1][k]]);
            blend(numbers(left), numbers(right), x.weight[k])
        };
        out[k] = blend(row(&y.texels[0]), row(&y.texels[1]), y.weight[k]);
    }
    out
}

/// Returns the components of directions on a side of the cube: right, down, outward.
#[inline(always)]
fn components<T: Neg<Output = T>>(side: u8, [x, y, z]: [T; 3]) -> (T, T, T) {
    match side {
        0 => (-z, -y, x),
        1 => (z, -y, -x),
        2 => (x, z, y),
        3 => (x, -z, -y),
        4 => (x, -y, z),
        _ => (-x, -y, -z),
    }
}

/// Returns the direction with the given components on a side of the cube.
fn direction(side: u8, right: f32, down: f32) -> [f32; 3] {
    match side {
        0 => [1.0, -down, -right],
        1 => [-1.0, -down, right],
        2 => [right, 1.0, down],
        3 => [right, -1.0, -down],
        4 => [right, -down, 1.0],
        _ => [-right, -down, -1.0],
    }
}

/// Returns the sides of the cube that directions point through.
#[inline(always)]
fn sides_of([x, y, z]: &Coordinates) -> [u8; 4] {
    let (along_x, along_y) = (x.abs(), y.abs());
    let longer = along_x.simd_gt(along_y);
    let upright = z.abs().simd_ge(longer.select(along_x, along_y)).to_bitmask();
    let longer = longer.to_bitmask();
    let negative = [x, y, z].map(|v| v.is_sign_negative().to_bitmask());
    [0, 1, 2, 3].map(|k| {
        let axis = if upright >> k & 1 == 1 {
            2
        } else {
            1 - (longer >> k & 1)
        };
        (2 * axis + (negative[axis as usize] >> k & 1)) as u8
    })
}

/// Returns a block of four texels, some of which lie beyond an edge of the side.
#[cold]
fn across_edges(faces: &[Face; 6], side: u8, level: usize, x: i32, y: i32) -> [[u8; 4]; 4] {
    let at = |dx: i32, dy: i32| texel(faces, side, level, x + dx, y + dy);
    let mut found = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
    // at a corner of the cube only three texels meet
    if let Some(missing) = found.iter().position(Option::is_none) {
        let others = || found.iter().flatten();
        let count = others().count().max(1) as u16;
        let mean = [0, 1, 2, 3].map(|c| (others().map(|t| u16::from(t[c])).sum::<u16>() / count) as u8);
        found[missing] = Some(mean);
    }
    found.map(|t| t.unwrap_or_default())
}

/// Returns a texel of a side or, beyond one of its edges, of the adjoining side; `None` beyond two edges.
fn texel(faces: &[Face; 6], side: u8, level: usize, x: i32, y: i32) -> Option<[u8; 4]> {
    let image = |side: u8| &faces[usize::from(side)][level];
    let n = image(side).width;
    let inside = |i: i32| (0..n as i32).contains(&i);
    match (inside(x), inside(y)) {
        (true, true) => Some(image(side).pixels[y as usize * n + x as usize]),
        (false, false) => None,
        _ => {
            let place = |i: i32| (2 * i + 1) as f32 / n as f32 - 1.0;
            let at = direction(side, place(x), place(y));
            let side = sides_of(&at.map(f32x4::splat))[0];
            let (right, down, out) = components(side, at);
            let index = |v: f32| (((v / out + 1.0) * 0.5 * n as f32) as usize).min(n - 1);
            Some(image(side).pixels[index(down) * n + index(right)])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_and_directions_are_inverse() {
        for side in 0..6 {
            let at = direction(side, 0.3, -0.7);
            assert_eq!(sides_of(&at.map(f32x4::splat)), [side; 4]);
            assert_eq!(components(side, at), (0.3, -0.7, 1.0));
        }
    }

    #[test]
    fn levels_follow_the_logarithm() {
        let of = |texels: f32| {
            let detail = MipLevels::new(f32x4::splat(texels * texels), 8);
            (detail.level[0], detail.blend[0])
        };
        assert_eq!(of(0.1), (0, 0.0));
        assert_eq!(of(4.0), (2, 0.0));
        assert_eq!(of(2.0 * std::f32::consts::SQRT_2).0, 1);
        assert!((of(2.0 * std::f32::consts::SQRT_2).1 - 0.5).abs() < 1e-5);
        assert_eq!(of(1e9), (7, 0.0));
        assert_eq!(of(f32::NAN), (7, 0.0));
    }
}
