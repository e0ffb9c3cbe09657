//! Shading as with multisampling: each visible triangle once per pixel, at the pixel's centre, averaged over four samples.

use wide::{f32x4, i32x4, u32x4};

use super::camera::ViewCamera;
use super::frame::Frame;
use super::lanes::{at_least, four, rounded_down, three};
use super::light::Vec3x4;
use super::lit_plane::LitPlane;
use super::pixels::Pixels;
use super::plane::{Basis, Planes};
use super::sky::Rays;
use super::target::{NONE, Triangle};
use super::texels::channels;
use super::visible::VisibleTriangles;
use crate::scenery::Scenery;
use crate::texture::TexturePixels;
use crate::view::Poses;

/// Computes the colours of a frame.
#[derive(Debug, Default)]
pub struct Shader {
    seen: VisibleTriangles,
    rays: Rays,
    /// The shading of each visible triangle.
    setups: Vec<TriangleSetup>,
    /// The planes among them that are lit on a lattice.
    planes: Vec<LitPlane>,
    /// Colours of the samples of each pixel, in bytes; used where there are transparent drawables.
    samples: Vec<[f32x4; 4]>,
}

/// Number of samples by bit mask.
const COUNT: [f32; 16] = [
    0.0, 1.0, 1.0, 2.0, 1.0, 2.0, 2.0, 3.0, 1.0, 2.0, 2.0, 3.0, 2.0, 3.0, 3.0, 4.0,
];

/// The shading of a triangle: its colour and texture coordinates as linear functions.
#[derive(Clone, Copy, Debug)]
struct TriangleSetup {
    /// Colour, divided by w; for a plane that is lit on a lattice, the position on it.
    colour: Planes,
    texture: Planes,
    /// Factor on red, green and blue.
    tint: [f32; 3],
    /// Index of the texture, or [`NONE`].
    image: u32,
    /// Index of its plane, if that is lit on a lattice, or [`NONE`].
    plane: u32,
}

impl Shader {
    /// Writes pixels of the image, rows from the top.
    pub fn resolve(
        &mut self,
        frame: &mut Frame,
        scenery: &Scenery,
        poses: &Poses,
        eye: &ViewCamera,
        pixels: Pixels,
        out: &mut [u8],
    ) {
        self.seen.find(frame, scenery, poses, eye, pixels);
        let (w, h) = (frame.size[0], frame.size[1]);
        self.rays.aim(eye, frame.size);
        self.setups.clear();
        self.planes.clear();
        for k in 0..self.seen.triangles.len() {
            let id = self.seen.triangles[k];
            let record = &frame.colour.records[id as usize];
            let mut setup = TriangleSetup::new(frame, scenery, &self.seen, record);
            if scenery.drawables[record.draw as usize].lattice.is_some() {
                setup.plane = self.plane(frame, scenery, poses, eye, record.draw);
            }
            self.setups.push(setup);
        }
        if !frame.layers.is_empty() {
            self.blended(frame, scenery, pixels, out);
            return;
        }
        let part = pixels.of_block(h);
        // blocks of 2 x 2 pixels, since the differences within a block choose the mip level
        for y in (0..h).step_by(2) {
            for x in (0..w).step_by(2) {
                // inside a triangle all samples have its colour: one shading, no mean
                let colours = if let Some(id) = frame.colour.only(x, y) {
                    bytes(&self.colours(frame, scenery, [x, y], id, [true; 4]))
                } else {
                    // half of four samples, so that rounding their mean down rounds it to the nearest
                    let mut sums = [f32x4::splat(2.0); 3];
                    self.block(frame, scenery, [x, y], part, |samples, colour| {
                        let count = f32x4::new(four(|k| COUNT[(samples >> (4 * k) & 15) as usize]));
                        for k in 0..3 {
                            sums[k] += count * colour[k];
                        }
                    });
                    three(|k| sums[k] * 0.25)
                };
                pixels.write(out, frame.size, [x, y], &packed(&colours));
            }
        }
    }

    /// Returns the index of a plane among those that are lit on a lattice, after adding it if it is new.
    #[cold]
    fn plane(&mut self, frame: &Frame, scenery: &Scenery, poses: &Poses, eye: &ViewCamera, draw: u32) -> u32 {
        let known = self.planes.iter().position(|plane| plane.draw == draw);
        let index = known.or_else(|| {
            let (drawable, ..) = scenery.drawables[draw as usize].placed(poses)?;
            let plane = LitPlane::new(draw, &drawable, &frame.draws[draw as usize], eye.pos)?;
            self.planes.push(plane);
            Some(self.planes.len() - 1)
        });
        index.map_or(NONE, |index| index as u32)
    }

    /// Passes on the visible colours of a block of 2 x 2 pixels, at the samples with a bit in `part`: four bits for each
    /// pixel, the colours of all pixels in bytes.
    #[inline(always)]
    fn block(&self, frame: &Frame, scenery: &Scenery, at: [usize; 2], part: u32, mut emit: impl FnMut(u32, &Vec3x4)) {
        let (w, h) = (frame.size[0], frame.size[1]);
        let [x, y] = at;
        let first = y * w + x;
        // beyond the image a block repeats its own pixels, which are shaded with the others and not written
        let (right, up) = (usize::from(x + 1 < w), if y + 1 < h { w } else { 0 });
        let ids = &frame.colour.ids;
        let seen = [ids[first], ids[first + right], ids[first + up], ids[first + up + right]];
        let vectors = four(|k| u32x4::new(seen[k]));
        let mut rest = part;
        while rest != 0 {
            let next = rest.trailing_zeros() as usize;
            let id = seen[next / 4][next % 4];
            let same = |k: usize| vectors[k].simd_eq(u32x4::splat(id)).to_bitmask() << (4 * k);
            let mine = (same(0) | same(1) | same(2) | same(3)) & rest;
            rest &= !mine;
            let wanted = four(|k| mine >> (4 * k) & 15 != 0);
            emit(mine, &bytes(&self.colours(frame, scenery, at, id, wanted)));
        }
    }

    /// Writes an image with transparent drawables, each drawn twice: once front to back and once back to front.
    #[cold]
    fn blended(&mut self, frame: &Frame, scenery: &Scenery, pixels: Pixels, out: &mut [u8]) {
        let (w, h) = (frame.size[0], frame.size[1]);
        let mut samples = std::mem::take(&mut self.samples);
        samples.clear();
        samples.resize(w * h, [f32x4::ZERO; 4]);
        for y in (0..h).step_by(2) {
            for x in (0..w).step_by(2) {
                self.block(frame, scenery, [x, y], 0xffff, |covered, colours| {
                    let colours = by_pixel(colours);
                    for k in 0..4 {
                        let (x, y) = (x + k % 2, y + k / 2);
                        if x < w && y < h {
                            for s in (0..4).filter(|s| covered >> (4 * k + s) & 1 == 1) {
                                samples[y * w + x][s] = colours[k];
                            }
                        }
                    }
                });
            }
        }
        let layers = frame.layers.len();
        for k in (0..layers).chain((0..layers).rev()) {
            for i in frame.layers[k].clone() {
                let fragment = frame.colour.fragments[i];
                let (x, y) = (fragment.at as usize % w, fragment.at as usize / w);
                let mut wanted = [false; 4];
                let own = x % 2 + 2 * (y % 2);
                wanted[own] = true;
                let block = [x - x % 2, y - y % 2];
                let colour = by_pixel(&self.colours(frame, scenery, block, fragment.id, wanted))[own];
                let draw = frame.colour.records[fragment.id as usize].draw;
                let alpha = frame.draws[draw as usize].alpha;
                for s in (0..4).filter(|s| fragment.samples >> s & 1 == 1) {
                    let under = &mut samples[fragment.at as usize][s];
                    *under = blend(*under, colour, alpha);
                }
            }
        }
        for (i, s) in samples.iter().enumerate() {
            if let Some(at) = pixels.place(i % w, h - 1 - i / w, w) {
                let [r, g, b, _] = ((s[0] + s[1] + s[2] + s[3] + 2.0) * 0.25).fast_trunc_int().to_array();
                out[3 * at..3 * at + 3].copy_from_slice(&[r, g, b].map(|v| v as u8));
            }
        }
        self.samples = samples;
    }

    /// Returns the colours of a record at the centres of those pixels of a block that are `wanted`.
    #[inline(always)]
    fn colours(&self, frame: &Frame, scenery: &Scenery, at: [usize; 2], id: u32, wanted: [bool; 4]) -> Vec3x4 {
        if id == NONE {
            return self.rays.colours(scenery, at, wanted);
        }
        let index = frame.colour.records[id as usize].setup;
        let [x, y] = at.map(|v| v as f32 + 0.5);
        let setup = &self.setups[index as usize];
        let light = |x, y| match self.planes.get(setup.plane as usize) {
            Some(plane) => plane.colours(&self.seen.lights, x, y, wanted),
            None => [f32x4::ZERO; 3],
        };
        setup.colours(scenery, x, y, wanted, light)
    }
}

/// Converts colours of 0..1 to bytes: rounded to the nearest, halves to even; NaN becomes 0.
#[inline(always)]
fn bytes(colours: &Vec3x4) -> Vec3x4 {
    three(|k| rounded(colours[k]))
}

#[inline(always)]
fn rounded(colour: f32x4) -> f32x4 {
    // adding 2^23 rounds to the nearest integer
    const SHIFT: f32 = 8_388_608.0;
    // from 2^23 on there is no room for fractions, and adding rounds them as the hardware rounds sums: to the
    // nearest, halves to even
    (at_least(colour, f32x4::ZERO).fast_min(f32x4::ONE) * 255.0 + SHIFT) - SHIFT
}

/// Returns red, green and blue of each pixel in bytes, rounded down; the colours are whole quarters.
#[inline(always)]
fn packed(colours: &Vec3x4) -> [[u8; 4]; 4] {
    let [r, g, b] = three(|k| rounded_down(colours[k]));
    let joined: i32x4 = r | g << 8 | b << 16;
    joined.to_array().map(i32::to_le_bytes)
}

/// Returns the colour of each pixel.
fn by_pixel(&[r, g, b]: &Vec3x4) -> [f32x4; 4] {
    f32x4::transpose([r, g, b, f32x4::ZERO])
}

/// Blends a colour over one in bytes.
fn blend(under: f32x4, over: f32x4, alpha: f32) -> f32x4 {
    let over = at_least(over, f32x4::ZERO).fast_min(f32x4::ONE);
    rounded(over * f32x4::splat(alpha) + under / f32x4::splat(255.0) * f32x4::splat(1.0 - alpha))
}

impl TriangleSetup {
    fn new(frame: &Frame, scenery: &Scenery, seen: &VisibleTriangles, record: &Triangle) -> Self {
        let lit = three(|k| seen.lit(record.vertices[k]));
        let vertices = three(|k| &frame.vertices[record.vertices[k] as usize]);
        let basis = Basis::new(vertices);
        // Over the image, not the values but the values over w are linear. The fourth lane is 1, so it becomes 1 / w,
        // by which the others are divided at each pixel.
        // one reciprocal per vertex, from the projection
        let iw = three(|k| f32x4::splat(vertices[k].iw));
        let over = |of: [f32x4; 3]| Planes::new(&basis, three(|k| of[k] * iw[k]), vertices[0].iw, frame.size);
        let mut setup = Self {
            colour: over(three(|k| lit[k].colour)),
            texture: Planes::default(),
            tint: [1.0; 3],
            image: NONE,
            plane: NONE,
        };
        let Some(image) = scenery.drawables[record.draw as usize].texture else {
            return setup;
        };
        if let TexturePixels::Flat(face) = &scenery.textures[image]
            // a texture of one colour is a factor, with no coordinates to interpolate
            && face[0].has_one_colour()
        {
            let texel = u32::from_le_bytes(face[0].pixels[0]);
            setup.tint = channels(u32x4::splat(texel)).map(|v| v.to_array()[0] * (1.0 / 255.0));
        } else {
            setup.texture = over(three(|k| lit[k].texture));
            setup.image = image as u32;
        }
        setup
    }

    /// Returns the colours of a block of 2 x 2 pixels. `light` returns those at places on a plane.
    #[inline(always)]
    fn colours(
        &self,
        scenery: &Scenery,
        x: f32,
        y: f32,
        wanted: [bool; 4],
        light: impl Fn(f32x4, f32x4) -> Vec3x4,
    ) -> Vec3x4 {
        let [r, g, b, w] = f32x4::transpose(self.colour.block(x, y));
        // the perspective division: one for each pixel instead of one for each channel
        let w = f32x4::ONE / w;
        let mut colours = [r * w, g * w, b * w];
        if self.plane != NONE {
            colours = light(colours[0], colours[1]);
        }
        if self.image == NONE {
            return three(|k| colours[k] * self.tint[k]);
        }
        let [s, t, u, _] = f32x4::transpose(self.texture.block(x, y));
        let texels = scenery.textures[self.image as usize].sample(&[s * w, t * w, u * w], wanted);
        three(|k| colours[k] * texels[k])
    }
}
