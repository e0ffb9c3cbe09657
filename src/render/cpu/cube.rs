//! Lookups in cube maps, in single precision.

use wide::bytemuck::cast;
use wide::{f32x4, i32x4, u32x4};

use super::lanes::{at_least, four, integers, three};
use super::light::Vec3x4;
use super::texels::{Coordinates, MipBlend, across, are_settled, channels, floor, gather_squares, upward, whole};
use crate::texture::{Cube, components};

/// Looks up the pixels of a block that are `wanted`: red, green, blue; 0..255.
#[inline(always)]
pub fn colours(cube: &Cube, at: &Coordinates, wanted: [bool; 4]) -> Vec3x4 {
    let axes = Axes::new(at);
    let Some(side) = axes.common() else {
        return CubePoints::apart(cube, axes.sides(), at).mixed(cube, wanted);
    };
    let points = CubePoints::on(cube, side, at);
    if !points.detail.same() {
        return points.mixed(cube, wanted);
    }
    points.colours(cube, wanted)
}

/// The points of a cube map that the pixels of a block sample.
#[derive(Clone, Copy)]
struct CubePoints {
    side: [u8; 4],
    u: f32x4,
    v: f32x4,
    detail: MipBlend,
}

impl CubePoints {
    /// Locates pixels of a block across several faces: each as if the whole block were on its face.
    #[cold]
    fn apart(cube: &Cube, side: [u8; 4], at: &Coordinates) -> Self {
        // the differences of a face's own coordinates within the block choose the mip level: between coordinates of
        // two faces they would be as large as the face, and the blurriest level would be taken along every edge
        let mut found = Self::on(cube, side[0], at);
        for k in 1..4 {
            if side[..k].contains(&side[k]) {
                continue;
            }
            let own = Self::on(cube, side[k], at);
            let here = i32x4::new(four(|i| -i32::from(side[i] == side[k])));
            found.detail.level = here.select(own.detail.level, found.detail.level);
            let here: f32x4 = cast(here);
            found.detail.blend = here.select(own.detail.blend, found.detail.blend);
            found.u = here.select(own.u, found.u);
            found.v = here.select(own.v, found.v);
        }
        found.side = side;
        found
    }

    /// Locates pixels as if all of them were on one side.
    #[inline(always)]
    fn on(cube: &Cube, side: u8, at: &Coordinates) -> Self {
        let (sc, tc, ma) = components(side, *at);
        // a zero direction has no side; any colour will do
        let least = f32x4::splat(f32::MIN_POSITIVE);
        let inverse = f32x4::ONE / ma.simd_gt(least).select(ma, least);
        // OpenGL's coordinates on a face are (sc / ma + 1) / 2: `half` includes the factor, the summand 1/2 is added where
        // they are used
        let half = 0.5 * inverse;
        let scale = half * f32x4::splat(whole(cube.faces[0][0].width));
        let length = |change: fn(f32x4) -> f32x4| {
            // the differences of sc / ma by the quotient rule, as llvmpipe takes them; those of the quotients would
            // choose other levels
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
            detail: MipBlend::new(right.simd_gt(up).select(right, up), cube.faces[0].len()),
        }
    }

    /// Looks up pixels that lie on one side and in one level.
    #[inline(always)]
    fn colours(&self, cube: &Cube, wanted: [bool; 4]) -> Vec3x4 {
        let face = &cube.faces[usize::from(self.side[0])];
        let level = self.detail.level.to_array()[0] as usize;
        let image = &face[level];
        // copies, so that the originals stay in registers on the other path
        let beyond = |level: usize, spots: CubeTexels| {
            let points = *self;
            points.beyond(cube, [level; 4], &spots, wanted)
        };
        let spots = CubeTexels::new(self.u, self.v, f32x4::splat(whole(image.width)));
        let mut colours = if spots.inside == 15 {
            let square = gather_squares(image, spots.first.to_array());
            // around a settled texel there is no other colour, in this level or the next: nothing to lerp
            if are_settled(square[0]) {
                return channels(square[0]);
            }
            spots.between(square.map(channels))
        } else {
            beyond(level, spots)
        };
        if self.detail.blends() {
            let level = (level + 1).min(face.len() - 1);
            let image = &face[level];
            let spots = CubeTexels::new(self.u, self.v, f32x4::splat(whole(image.width)));
            let next = if spots.inside == 15 {
                spots.between(gather_squares(image, spots.first.to_array()).map(channels))
            } else {
                beyond(level, spots)
            };
            self.blend(&mut colours, &next);
        }
        colours
    }

    /// Looks up pixels that lie on several sides or in several levels.
    #[inline(never)]
    fn mixed(self, cube: &Cube, wanted: [bool; 4]) -> Vec3x4 {
        let last = cube.faces[0].len() - 1;
        let at = |level: [usize; 4]| {
            let size = f32x4::new(four(|k| whole(cube.faces[0][level[k]].width)));
            self.beyond(cube, level, &CubeTexels::new(self.u, self.v, size), wanted)
        };
        let level = self.detail.level.to_array().map(|level| level as usize);
        let mut colours = at(level);
        if self.detail.blends() {
            let next = at(level.map(|level| (level + 1).min(last)));
            self.blend(&mut colours, &next);
        }
        colours
    }

    /// Lerps to the colours of the next mip level.
    #[inline(always)]
    fn blend(&self, colours: &mut Vec3x4, next: &Vec3x4) {
        for k in 0..3 {
            colours[k] += self.detail.blend * (next[k] - colours[k]);
        }
    }

    /// Looks up bilinearly in one mip level for each pixel, across the edges of the cube where needed.
    #[inline(never)]
    fn beyond(&self, cube: &Cube, level: [usize; 4], spots: &CubeTexels, wanted: [bool; 4]) -> Vec3x4 {
        let (left, top) = (spots.left.to_array(), spots.top.to_array());
        let mut corners = [[0; 4]; 4];
        for k in (0..4).filter(|&k| wanted[k]) {
            let found = cube.block(self.side[k], level[k], left[k] as i32, top[k] as i32);
            for i in 0..4 {
                corners[i][k] = u32::from_le_bytes(found[i]);
            }
        }
        spots.between(corners.map(|c| channels(u32x4::new(c))))
    }
}

/// The texels of one mip level that the pixels of a block sample.
#[derive(Clone, Copy)]
struct CubeTexels {
    /// Column of the texel before; -1 or the last one if the texel after lies beyond the edge.
    left: f32x4,
    /// Row of the texel before, likewise.
    top: f32x4,
    /// Places between the texels, 0..1.
    across: f32x4,
    down: f32x4,
    /// Index of the first texel, if all four are inside.
    first: i32x4,
    /// One bit for each pixel: whether all four texels are inside the image.
    inside: u32,
}

impl CubeTexels {
    #[inline(always)]
    fn new(u: f32x4, v: f32x4, size: f32x4) -> Self {
        let (x, y) = (u * size - 0.5, v * size - 0.5);
        let (left, top) = (floor(x), floor(y));
        let (across, down) = (x - left, y - top);
        let last = size - 1.0;
        // bounded before it becomes an integer: coordinates that are not numbers or far away would be undefined
        // indices
        let within = |v: f32x4| at_least(v, f32x4::splat(-1.0)).fast_min(last);
        let (left, top) = (within(left), within(top));
        let least = left.fast_min(top).simd_ge(f32x4::ZERO);
        Self {
            left,
            top,
            across,
            down,
            // textures are small enough for exact indices
            first: integers(top * size + left),
            inside: (least & left.fast_max(top).simd_lt(last)).to_bitmask(),
        }
    }

    /// Lerps between four texels for each pixel.
    #[inline(always)]
    fn between(&self, [a, b, c, d]: [Vec3x4; 4]) -> Vec3x4 {
        three(|k| {
            let (upper, lower) = (a[k] + self.across * (b[k] - a[k]), c[k] + self.across * (d[k] - c[k]));
            upper + self.down * (lower - upper)
        })
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
            // at equal lengths z wins over x and y, and y over x, as in llvmpipe, so that what lies on an edge of the
            // cube is on the same face there
            upright: z.abs().simd_ge(longer.select(along_x, along_y)).to_bitmask(),
            // the bit mask is made of signs
            negative: [x, y, z].map(|v| v.to_bitmask()),
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
