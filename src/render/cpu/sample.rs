//! Texture lookups as Mesa's llvmpipe makes them: bilinear in two levels, with one level of detail per 2 x 2 pixels.

use crate::render::texture::{Face, Level, Texture};

/// Between which mip levels to blend, and how far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detail {
    level: usize,
    blend: f32,
}

impl Detail {
    /// From the square of the number of texels per pixel. The logarithm is linear between powers of two, as llvmpipe's is.
    fn new(squared: f32, levels: usize) -> Self {
        let last = levels as i32 - 1;
        let bits = squared.to_bits();
        let exponent = ((bits >> 23) & 255) as i32 - 127;
        let mantissa = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000);
        let level = (0.5 * (exponent as f32 + mantissa - 1.0)).max(0.0);
        let whole = floor(level);
        if whole >= last {
            Self {
                level: last as usize,
                blend: 0.0,
            }
        } else {
            Self {
                level: whole as usize,
                blend: level - whole as f32,
            }
        }
    }
}

impl Texture {
    /// The level of detail for coordinates at a pixel, its right and its upper neighbour.
    pub fn detail(&self, at: [f32; 3], right: [f32; 3], up: [f32; 3]) -> Detail {
        match self {
            Texture::Flat(face) => {
                let (w, h) = (face[0].width as f32, face[0].height as f32);
                let squared = |v: [f32; 3]| {
                    let (s, t) = ((v[0] - at[0]) * w, (v[1] - at[1]) * h);
                    s * s + t * t
                };
                Detail::new(squared(right).max(squared(up)), face.len())
            }
            Texture::Cube(faces) => {
                let (side, sc, tc, ma) = project(at);
                let scale = 0.5 / ma * faces[0][0].width as f32;
                let squared = |v: [f32; 3]| {
                    let d = [v[0] - at[0], v[1] - at[1], v[2] - at[2]];
                    let (dsc, dtc, dma) = components(side, d);
                    let shift = dma / ma;
                    let (s, t) = ((dsc - shift * sc) * scale, (dtc - shift * tc) * scale);
                    s * s + t * t
                };
                Detail::new(squared(right).max(squared(up)), faces[0].len())
            }
        }
    }

    /// The colour, 0..1.
    pub fn sample(&self, at: [f32; 3], detail: Detail) -> [f32; 3] {
        let [r, g, b, _] = match self {
            Texture::Flat(face) => flat(face, at, detail),
            Texture::Cube(faces) => {
                let (side, sc, tc, ma) = project(at);
                let half = 0.5 / ma;
                let (u, v) = (sc * half + 0.5, tc * half + 0.5);
                let mut colour = cube(faces, side, detail.level, u, v);
                if detail.blend > 0.0 {
                    let next = cube(faces, side, detail.level + 1, u, v);
                    for k in 0..4 {
                        colour[k] += detail.blend * (next[k] - colour[k]);
                    }
                }
                colour
            }
        };
        const BYTE: f32 = 1.0 / 255.0;
        [r * BYTE, g * BYTE, b * BYTE]
    }
}

/// The largest integer that is not greater; coordinates are small, and what is not a number becomes 0.
#[inline(always)]
fn floor(x: f32) -> i32 {
    let whole = x as i32;
    whole - i32::from(whole as f32 > x)
}

/// Blend of bytes with a weight of 0..256.
#[inline(always)]
fn blend(a: [i32; 4], b: [i32; 4], weight: i32) -> [i32; 4] {
    let mut out = a;
    for k in 0..4 {
        out[k] += ((b[k] - a[k]) * weight + 128) >> 8;
    }
    out
}

/// Two-dimensional lookups go through 8-bit arithmetic.
fn flat(face: &Face, at: [f32; 3], detail: Detail) -> [f32; 4] {
    let mut colour = flat_level(&face[detail.level], at);
    if detail.blend > 0.0 {
        let weight = (detail.blend * 256.0) as i32;
        colour = blend(colour, flat_level(&face[detail.level + 1], at), weight);
    }
    let [r, g, b, a] = colour;
    [r as f32, g as f32, b as f32, a as f32]
}

/// Texels before and after a place along an image that repeats, and the weight of the second.
#[inline(always)]
fn repeated(x: f32, n: usize) -> (usize, usize, i32) {
    let x = (x - floor(x) as f32) * n as f32 - 0.5;
    let low = floor(x);
    let weight = ((x - low as f32) * 256.0 + 0.5) as i32;
    let n = n as i32;
    let wrap = |i: i32| {
        let i = if i < 0 { i + n } else { i };
        (if i >= n { i - n } else { i }).clamp(0, n - 1) as usize
    };
    (wrap(low), wrap(low + 1), weight)
}

#[inline(always)]
fn flat_level(level: &Level, at: [f32; 3]) -> [i32; 4] {
    let (x0, x1, wx) = repeated(at[0], level.width);
    let (y0, y1, wy) = repeated(at[1], level.height);
    let (upper, lower) = (y0 * level.width, y1 * level.width);
    let texel = |i: usize| {
        let [r, g, b, a] = level.pixels[i];
        [i32::from(r), i32::from(g), i32::from(b), i32::from(a)]
    };
    let above = blend(texel(upper + x0), texel(upper + x1), wx);
    let below = blend(texel(lower + x0), texel(lower + x1), wx);
    blend(above, below, wy)
}

/// Components of a direction on a side of the cube: to the right, downward, outward.
#[inline(always)]
fn components(side: usize, [x, y, z]: [f32; 3]) -> (f32, f32, f32) {
    match side {
        0 => (-z, -y, x),
        1 => (z, -y, -x),
        2 => (x, z, y),
        3 => (x, -z, -y),
        4 => (x, -y, z),
        _ => (-x, -y, -z),
    }
}

/// The direction of components on a side of the cube.
fn direction(side: usize, right: f32, down: f32) -> [f32; 3] {
    match side {
        0 => [1.0, -down, -right],
        1 => [-1.0, -down, right],
        2 => [right, 1.0, down],
        3 => [right, -1.0, -down],
        4 => [right, -down, 1.0],
        _ => [-right, -down, -1.0],
    }
}

/// The side of the cube that a direction goes through, and its components there.
#[inline(always)]
fn project(at: [f32; 3]) -> (usize, f32, f32, f32) {
    let [x, y, z] = [at[0].abs(), at[1].abs(), at[2].abs()];
    let (axis, positive) = if z >= x.max(y) {
        (2, at[2] >= 0.0)
    } else if x > y {
        (0, at[0] >= 0.0)
    } else {
        (1, at[1] >= 0.0)
    };
    let side = 2 * axis + usize::from(!positive);
    let (right, down, out) = components(side, at);
    // a zero direction has no side; any colour will do
    (side, right, down, out.max(f32::MIN_POSITIVE))
}

/// Bilinear lookup on a side of a cube, across its edges where needed; 0..255.
#[inline(always)]
fn cube(faces: &[Face; 6], side: usize, level: usize, u: f32, v: f32) -> [f32; 4] {
    let image = &faces[side][level];
    let n = image.width;
    let (x, y) = (u * n as f32 - 0.5, v * n as f32 - 0.5);
    let (x0, y0) = (floor(x), floor(y));
    let (wx, wy) = (x - x0 as f32, y - y0 as f32);
    let last = n as i32 - 1;
    let [a, b, c, d] = if x0 >= 0 && y0 >= 0 && x0 < last && y0 < last {
        let i = y0 as usize * n + x0 as usize;
        let (upper, lower) = (&image.pixels[i..i + 2], &image.pixels[i + n..i + n + 2]);
        [upper[0], upper[1], lower[0], lower[1]]
    } else {
        across_edges(faces, side, level, x0, y0)
    };
    let wide = |[r, g, b, a]: [u8; 4]| [f32::from(r), f32::from(g), f32::from(b), f32::from(a)];
    let (a, b, c, d) = (wide(a), wide(b), wide(c), wide(d));
    let mut colour = [0.0; 4];
    for k in 0..4 {
        let (upper, lower) = (a[k] + wx * (b[k] - a[k]), c[k] + wx * (d[k] - c[k]));
        colour[k] = upper + wy * (lower - upper);
    }
    colour
}

/// Four texels of which some lie beyond an edge.
#[cold]
fn across_edges(faces: &[Face; 6], side: usize, level: usize, x: i32, y: i32) -> [[u8; 4]; 4] {
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

/// A texel of a side or, beyond one of its edges, of the side that adjoins there; none beyond two.
fn texel(faces: &[Face; 6], side: usize, level: usize, x: i32, y: i32) -> Option<[u8; 4]> {
    let n = faces[side][level].width;
    let inside = |i: i32| (0..n as i32).contains(&i);
    match (inside(x), inside(y)) {
        (true, true) => Some(faces[side][level].pixels[y as usize * n + x as usize]),
        (false, false) => None,
        _ => {
            let place = |i: i32| (2 * i + 1) as f32 / n as f32 - 1.0;
            let (side, right, down, out) = project(direction(side, place(x), place(y)));
            let index = |v: f32| (((v / out + 1.0) * 0.5 * n as f32) as usize).min(n - 1);
            Some(faces[side][level].pixels[index(down) * n + index(right)])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_and_directions_are_inverse() {
        for side in 0..6 {
            let (s, right, down, out) = project(direction(side, 0.3, -0.7));
            assert_eq!((s, right, down, out), (side, 0.3, -0.7, 1.0));
        }
    }

    #[test]
    fn levels_follow_the_logarithm() {
        let of = |texels: f32| Detail::new(texels * texels, 8);
        assert_eq!(of(0.1), Detail { level: 0, blend: 0.0 });
        assert_eq!(of(4.0), Detail { level: 2, blend: 0.0 });
        assert_eq!(of(2.0 * std::f32::consts::SQRT_2).level, 1);
        assert!((of(2.0 * std::f32::consts::SQRT_2).blend - 0.5).abs() < 1e-5);
        assert_eq!(of(1e9), Detail { level: 7, blend: 0.0 });
        assert_eq!(Detail::new(f32::NAN, 8).blend, 0.0);
    }
}
