//! Texture lookups as in Mesa's llvmpipe: bilinear in two mip levels, with one level of detail per 2 x 2 pixels.

use std::ops::Neg;

use wide::bytemuck::cast;
use wide::{f32x4, i32x4};

use super::flat;
use super::lanes::four;
use crate::render::texture::{Face, Level, Texture};

/// The mip levels to blend at each pixel of a block, and their blend weights.
#[derive(Clone, Copy, Debug)]
pub struct MipLevels {
    pub level: [usize; 4],
    pub blend: [f32; 4],
    /// Whether the whole block has one level.
    same: bool,
}

impl MipLevels {
    /// Finds the mip levels from the squared number of texels per pixel. The logarithm is linear between powers of two,
    /// as in llvmpipe; magnified textures use the first level.
    #[inline(always)]
    pub fn new(squared: f32x4, levels: usize) -> Self {
        let bits: i32x4 = cast(squared);
        let exponent = f32x4::from_i32x4((bits >> 23 & i32x4::splat(255)) - i32x4::splat(127));
        let mantissa: f32x4 = cast(bits & i32x4::splat(0x007f_ffff) | i32x4::splat(0x3f80_0000));
        let level = 0.5 * (exponent + mantissa - f32x4::ONE);
        // never NaN
        let level = level.fast_max(f32x4::ZERO).fast_min(f32x4::splat(levels as f32 - 1.0));
        let whole = level.fast_trunc_int();
        let first = whole.to_array()[0];
        Self {
            level: four(|k| whole.to_array()[k] as usize),
            blend: (level - f32x4::from_i32x4(whole)).to_array(),
            same: whole.simd_eq(i32x4::splat(first)).to_bitmask() == 15,
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
            Texture::Flat(face) => flat::colours(face, at, wanted),
            Texture::Cube(faces) => CubePoints::new(faces, at).colours(faces, wanted),
        };
        four(|k| colours[k] * f32x4::splat(1.0 / 255.0))
    }
}

/// Returns the differences between the columns of a block, at each pixel.
#[inline(always)]
pub fn across(v: f32x4) -> f32x4 {
    let v = v.to_array();
    f32x4::new([v[1], v[1], v[3], v[3]]) - f32x4::new([v[0], v[0], v[2], v[2]])
}

/// Returns the differences between the rows of a block, at each pixel.
#[inline(always)]
pub fn upward(v: f32x4) -> f32x4 {
    let v = v.to_array();
    f32x4::new([v[2], v[3], v[2], v[3]]) - f32x4::new([v[0], v[1], v[0], v[1]])
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
        let axes = Axes::new(at);
        match axes.common() {
            Some(side) => Self::on(faces, side, at),
            None => Self::apart(faces, axes.sides(), at),
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
                same: false,
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
        if !self.detail.same {
            return self.mixed(faces, wanted);
        }
        let face = &faces[usize::from(self.side[0])];
        let level = self.detail.level[0];
        let mut colours = self.at_level(faces, [&face[level]; 4], [level; 4], wanted);
        if self.detail.blends() {
            let level = (level + 1).min(face.len() - 1);
            let next = self.at_level(faces, [&face[level]; 4], [level; 4], wanted);
            self.blend(&mut colours, &next);
        }
        colours
    }

    /// Looks up pixels that lie on several sides or in several levels.
    #[inline(never)]
    fn mixed(&self, faces: &[Face; 6], wanted: [bool; 4]) -> [f32x4; 4] {
        let last = faces[0].len() - 1;
        let at = |level: [usize; 4]| {
            let images = four(|k| &faces[usize::from(self.side[k])][level[k]]);
            self.at_level(faces, images, level, wanted)
        };
        let mut colours = at(self.detail.level);
        if self.detail.blends() {
            let next = at(four(|k| (self.detail.level[k] + 1).min(last)));
            self.blend(&mut colours, &next);
        }
        colours
    }

    /// Blends in the colours of the next level.
    #[inline(always)]
    fn blend(&self, colours: &mut [f32x4; 4], next: &[f32x4; 4]) {
        for k in 0..4 {
            colours[k] += f32x4::splat(self.detail.blend[k]) * (next[k] - colours[k]);
        }
    }

    /// Looks up bilinearly in one mip level for each pixel, across the edges of the cube where needed; 0..255.
    #[inline(always)]
    fn at_level(&self, faces: &[Face; 6], images: [&Level; 4], level: [usize; 4], wanted: [bool; 4]) -> [f32x4; 4] {
        let size = f32x4::new(four(|k| images[k].width as f32));
        let (x, y) = (self.u * size - 0.5, self.v * size - 0.5);
        let (left, top) = (whole(x), whole(y));
        let (wx, wy) = ((x - left).to_array(), (y - top).to_array());
        let last = size - 1.0;
        let within = |v: f32x4| v.max(f32x4::splat(-1.0)).fast_min(last);
        let (left, top) = (within(left), within(top));
        let least = left.fast_min(top).simd_ge(f32x4::ZERO);
        let inside = (least & left.fast_max(top).simd_lt(last)).to_bitmask();
        // textures are small enough for exact indices
        let first = (top * size + left).fast_trunc_int().to_array();
        let (left, top) = (left.to_array(), top.to_array());
        let pixel = |k: usize| {
            if !wanted[k] {
                return f32x4::ZERO;
            }
            let [a, b, c, d] = if inside >> k & 1 == 1 {
                let (pixels, i, n) = (&images[k].pixels, first[k] as usize, images[k].width);
                let (upper, lower) = (&pixels[i..i + 2], &pixels[i + n..i + n + 2]);
                [upper[0], upper[1], lower[0], lower[1]]
            } else {
                across_edges(faces, self.side[k], level[k], left[k] as i32, top[k] as i32)
            };
            let [a, b, c, d] = [numbers(a), numbers(b), numbers(c), numbers(d)];
            let wx = f32x4::splat(wx[k]);
            let (upper, lower) = (a + wx * (b - a), c + wx * (d - c));
            upper + f32x4::splat(wy[k]) * (lower - upper)
        };
        four(pixel)
    }
}

/// Converts bytes to numbers.
#[inline(always)]
pub fn numbers(v: [u8; 4]) -> f32x4 {
    let mut out = [0.0; 4];
    for k in 0..4 {
        out[k] = f32::from(v[k]);
    }
    f32x4::new(out)
}

/// Rounds down to integers, for numbers within +-2^22.
#[inline(always)]
pub fn whole(x: f32x4) -> f32x4 {
    // adding 1.5 * 2^23 rounds to the nearest integer
    let nearest = (x + 12_582_912.0) - 12_582_912.0;
    nearest - (nearest.simd_gt(x) & f32x4::ONE)
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

/// The axes of the cube along which directions are longest: one bit for each pixel.
struct Axes {
    /// Whether x is longer than y.
    longer: u32,
    /// Whether z is the longest.
    upright: u32,
    /// Whether x, y and z are negative.
    negative: [u32; 3],
}

impl Axes {
    #[inline(always)]
    fn new([x, y, z]: &Coordinates) -> Self {
        let (along_x, along_y) = (x.abs(), y.abs());
        let longer = along_x.simd_gt(along_y);
        Self {
            longer: longer.to_bitmask(),
            upright: z.abs().simd_ge(longer.select(along_x, along_y)).to_bitmask(),
            negative: [x, y, z].map(|v| v.is_sign_negative().to_bitmask()),
        }
    }

    /// Returns the side through which all directions point; `None` if they point through several.
    #[inline(always)]
    fn common(&self) -> Option<u8> {
        let axis = match (self.upright, self.longer) {
            (15, _) => 2,
            (0, 15) => 0,
            (0, 0) => 1,
            _ => return None,
        };
        match self.negative[axis] {
            0 => Some(2 * axis as u8),
            15 => Some(2 * axis as u8 + 1),
            _ => None,
        }
    }

    /// Returns the side through which each direction points.
    fn sides(&self) -> [u8; 4] {
        [0, 1, 2, 3].map(|k| {
            let axis = if self.upright >> k & 1 == 1 {
                2
            } else {
                1 - (self.longer >> k & 1)
            };
            (2 * axis + (self.negative[axis as usize] >> k & 1)) as u8
        })
    }
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
            let side = Axes::new(&at.map(f32x4::splat)).sides()[0];
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
            assert_eq!(Axes::new(&at.map(f32x4::splat)).sides(), [side; 4]);
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
