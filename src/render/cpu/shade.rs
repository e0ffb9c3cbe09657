//! Shading: the colour of each visible triangle once per pixel, at the pixel's centre, averaged over the four samples.

use wide::{f32x4, u32x4};

use super::camera::Eye;
use super::frame::Frame;
use super::lanes::{four, three};
use super::light::{self, PlacedLight};
use super::plane::{Basis, Planes};
use super::target::{NONE, Triangle};
use crate::render::view::Poses;
use crate::render::visual::Visual;

/// Computes the colours of a frame.
#[derive(Debug, Default)]
pub struct Shader {
    lights: Vec<PlacedLight>,
    /// Index into `lit` for each vertex of the frame, or [`NONE`].
    lit_of: Vec<u32>,
    lit: Vec<LitVertex>,
    setups: Vec<Setup>,
    /// Colours of the samples of each pixel, in bytes; used where there are transparent drawables.
    samples: Vec<[f32x4; 4]>,
}

/// Number of samples by their bits.
const COUNT: [f32; 16] = [
    0.0, 1.0, 1.0, 2.0, 1.0, 2.0, 2.0, 3.0, 1.0, 2.0, 2.0, 3.0, 2.0, 3.0, 3.0, 4.0,
];

/// The pixels of an image that are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pixels {
    /// Every pixel.
    All,
    /// Every second pixel of every second row, from the upper left.
    Second,
}

impl Pixels {
    /// Returns where a pixel goes, counted in pixels; `None` if it is not wanted. `y` is counted from the top.
    #[inline(always)]
    fn place(self, x: usize, y: usize, width: usize) -> Option<usize> {
        match self {
            Self::All => Some(y * width + x),
            Self::Second => (x.is_multiple_of(2) && y.is_multiple_of(2)).then(|| y / 2 * width.div_ceil(2) + x / 2),
        }
    }

    /// Returns which samples of a block of 2 x 2 pixels are wanted: four bits for each pixel, the lower two pixels
    /// first.
    fn of_block(self, height: usize) -> u32 {
        match self {
            Self::All => 0xffff,
            Self::Second if height.is_multiple_of(2) => 0x0f00,
            Self::Second => 0x000f,
        }
    }
}

/// A lit vertex of a visible triangle.
#[derive(Clone, Copy, Debug)]
struct LitVertex {
    /// Red, green, blue, 1.
    colour: f32x4,
    /// Texture coordinates, 0.
    texture: f32x4,
}

/// The shading of a triangle: its colour and texture coordinates as linear functions.
#[derive(Clone, Copy, Debug)]
struct Setup {
    /// Colour, divided by w.
    colour: Planes,
    texture: Planes,
    /// Index of the texture, or [`NONE`].
    image: u32,
}

/// The inputs of shading.
#[derive(Clone, Copy)]
struct Inputs<'a> {
    visual: &'a Visual,
    eye: &'a Eye,
    /// Factor from pixels to half images.
    step: [f32; 2],
}

impl Shader {
    /// Writes pixels of the image, rows from the top.
    pub fn resolve(
        &mut self,
        frame: &mut Frame,
        visual: &Visual,
        poses: &Poses,
        eye: &Eye,
        (pixels, out): (Pixels, &mut [u8]),
    ) {
        light::place(visual, poses, eye, &mut self.lights);
        self.lit_of.clear();
        self.lit_of.resize(frame.vertices.len(), NONE);
        self.lit.clear();
        self.setups.clear();
        let (w, h) = (frame.size[0], frame.size[1]);
        let inputs = Inputs {
            visual,
            eye,
            step: [2.0 / w as f32, 2.0 / h as f32],
        };
        if !frame.layers.is_empty() {
            self.blended(frame, &inputs, pixels, out);
            return;
        }
        let part = pixels.of_block(h);
        let wanted = [0, 1, 2, 3].map(|k| part >> (4 * k) & 15 != 0);
        for y in (0..h).step_by(2) {
            for x in (0..w).step_by(2) {
                let mut write = |k: usize, colour: [u8; 3]| {
                    let (x, y) = (x + k % 2, y + k / 2);
                    if x < w
                        && y < h
                        && let Some(at) = pixels.place(x, h - 1 - y, w)
                    {
                        out[3 * at..3 * at + 3].copy_from_slice(&colour);
                    }
                };
                if let Some(id) = frame.colour.only(x, y) {
                    let colours = self.colours(frame, &inputs, [x, y], id, wanted);
                    for k in 0..4 {
                        write(k, truncated(bytes(colours[k])));
                    }
                } else {
                    let mut sums = [f32x4::ZERO; 4];
                    self.block(frame, &inputs, [x, y], part, |k, samples, colour| {
                        sums[k] += f32x4::splat(COUNT[samples as usize]) * colour;
                    });
                    for k in 0..4 {
                        write(k, average(sums[k]));
                    }
                }
            }
        }
    }

    /// Passes on the colours that are seen in a block of 2 x 2 pixels, at the samples with a bit in `part`: the pixel in the block,
    /// a bit for each sample, the colour in bytes.
    #[inline(always)]
    fn block(
        &mut self,
        frame: &mut Frame,
        inputs: &Inputs,
        at: [usize; 2],
        part: u32,
        mut emit: impl FnMut(usize, u32, f32x4),
    ) {
        let (w, h) = (frame.size[0], frame.size[1]);
        let [x, y] = at;
        let first = y * w + x;
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
            let samples = [mine & 15, mine >> 4 & 15, mine >> 8 & 15, mine >> 12 & 15];
            let colours = self.colours(frame, inputs, at, id, four(|k| samples[k] != 0));
            for k in 0..4 {
                if samples[k] != 0 {
                    emit(k, samples[k], bytes(colours[k]));
                }
            }
        }
    }

    /// Writes an image with transparent things, each drawn twice: from the front to the back and then back.
    #[cold]
    fn blended(&mut self, frame: &mut Frame, inputs: &Inputs, pixels: Pixels, out: &mut [u8]) {
        let (w, h) = (frame.size[0], frame.size[1]);
        let mut samples = std::mem::take(&mut self.samples);
        samples.clear();
        samples.resize(w * h, [f32x4::ZERO; 4]);
        for y in (0..h).step_by(2) {
            for x in (0..w).step_by(2) {
                self.block(frame, inputs, [x, y], 0xffff, |k, covered, colour| {
                    let (x, y) = (x + k % 2, y + k / 2);
                    if x < w && y < h {
                        for s in (0..4).filter(|s| covered >> s & 1 == 1) {
                            samples[y * w + x][s] = colour;
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
                let colour = self.colours(frame, inputs, block, fragment.id, wanted)[own];
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
                out[3 * at..3 * at + 3].copy_from_slice(&average(s[0] + s[1] + s[2] + s[3]));
            }
        }
        self.samples = samples;
    }

    /// Returns the colours of a record at the centres of those pixels of a block that are `wanted`.
    #[inline(always)]
    fn colours(
        &mut self,
        frame: &mut Frame,
        inputs: &Inputs,
        [x, y]: [usize; 2],
        id: u32,
        wanted: [bool; 4],
    ) -> [f32x4; 4] {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        if id == NONE {
            return inputs.sky(x, y, wanted);
        }
        let mut index = frame.colour.records[id as usize].setup;
        if index == NONE {
            index = self.setups.len() as u32;
            let record = frame.colour.records[id as usize];
            let setup = self.setup(frame, inputs, &record);
            self.setups.push(setup);
            frame.colour.records[id as usize].setup = index;
        }
        self.setups[index as usize].colours(inputs.visual, x, y, wanted)
    }

    fn setup(&mut self, frame: &Frame, inputs: &Inputs, record: &Triangle) -> Setup {
        let index = record.draw as usize;
        let lit = three(|k| self.lit(frame, inputs, index, record.vertices[k]));
        let vertices = three(|k| &frame.vertices[record.vertices[k] as usize]);
        let basis = Basis::new(vertices);
        let iw = three(|k| f32x4::splat(vertices[k].iw));
        let size = [frame.size[0], frame.size[1]];
        let over = |[a, b, c]: [f32x4; 3]| Planes::new(&basis, [a * iw[0], b * iw[1], c * iw[2]], vertices[0].iw, size);
        let image = inputs.visual.drawables[index].texture;
        Setup {
            colour: over(three(|k| lit[k].colour)),
            texture: match image {
                Some(_) => over(three(|k| lit[k].texture)),
                None => Planes::default(),
            },
            image: image.map_or(NONE, |i| i as u32),
        }
    }

    /// Returns the lighting of a vertex of the frame, computed when it is first asked for.
    fn lit(&mut self, frame: &Frame, inputs: &Inputs, index: usize, v: u32) -> LitVertex {
        let slot = self.lit_of[v as usize];
        if slot != NONE {
            return self.lit[slot as usize];
        }
        let drawable = &inputs.visual.drawables[index];
        let draw = &frame.draws[index];
        let mesh = &inputs.visual.meshes[drawable.shape as usize];
        let i = v as usize - draw.base;
        let lit = match i.checked_sub(mesh.x.len()) {
            Some(point) => {
                let point = frame.points[draw.points + point];
                let from = self.lit(frame, inputs, index, point.from);
                let to = self.lit(frame, inputs, index, point.to);
                let share = f32x4::splat(point.share);
                LitVertex {
                    colour: from.colour + share * (to.colour - from.colour),
                    texture: from.texture + share * (to.texture - from.texture),
                }
            }
            None => {
                let unit = [mesh.x[i], mesh.y[i], mesh.z[i]];
                let part = mesh.part_of(i);
                let vertex = (part, unit, mesh.normal[i]);
                let [r, g, b] = light::vertex(&self.lights, drawable, draw, inputs.eye.pos, vertex);
                let [s, t, u] = [0, 1, 2].map(|k| unit[k] * drawable.texture_scale[k] + drawable.texture_offset);
                LitVertex {
                    colour: f32x4::new([r, g, b, 1.0]),
                    texture: f32x4::new([s, t, u, 0.0]),
                }
            }
        };
        self.lit_of[v as usize] = self.lit.len() as u32;
        self.lit.push(lit);
        lit
    }
}

/// Converts a colour of 0..1 to bytes: rounded to the nearest, halves to even; NaN becomes 0.
#[inline(always)]
fn bytes(colour: f32x4) -> f32x4 {
    // adding 2^23 rounds to the nearest integer
    const SHIFT: f32 = 8_388_608.0;
    (colour.max(f32x4::ZERO).fast_min(f32x4::ONE) * 255.0 + SHIFT) - SHIFT
}

/// Lays a colour over one in bytes.
fn blend(under: f32x4, over: f32x4, alpha: f32) -> f32x4 {
    let over = over.max(f32x4::ZERO).fast_min(f32x4::ONE);
    bytes(over * f32x4::splat(alpha) + under / f32x4::splat(255.0) * f32x4::splat(1.0 - alpha))
}

/// Returns the average of four colours in bytes, from their sum.
#[inline(always)]
fn average(sum: f32x4) -> [u8; 3] {
    truncated((sum + 2.0) * 0.25)
}

/// Returns a colour in bytes, rounded down.
#[inline(always)]
fn truncated(colour: f32x4) -> [u8; 3] {
    let [r, g, b, _] = colour.fast_trunc_int().to_array();
    [r as u8, g as u8, b as u8]
}

impl Setup {
    #[inline(always)]
    fn colours(&self, visual: &Visual, x: f32, y: f32, wanted: [bool; 4]) -> [f32x4; 4] {
        let mut colours = self.colour.block(x, y);
        let w = f32x4::ONE / f32x4::new(four(|k| colours[k].to_array()[3]));
        let each = w.to_array();
        for k in 0..4 {
            colours[k] *= f32x4::splat(each[k]);
        }
        if self.image != NONE {
            let [s, t, u, _] = f32x4::transpose(self.texture.block(x, y));
            let texels = visual.textures[self.image as usize].sample(&[s * w, t * w, u * w], wanted);
            for k in 0..4 {
                colours[k] *= texels[k];
            }
        }
        colours
    }
}

impl Inputs<'_> {
    /// Returns the background: a cube map turned by 90 degrees about x, seen in the directions of the pixels of a
    /// block.
    fn sky(&self, x: f32, y: f32, wanted: [bool; 4]) -> [f32x4; 4] {
        let Some(sky) = self.visual.sky else {
            return [f32x4::ZERO; 4];
        };
        let Eye { forward, right, up, .. } = self.eye;
        let ray = |at: [f32; 4], k: usize| (f32x4::new(at) * self.step[k] - 1.0) * self.eye.tan[k];
        let across = ray([x, x + 1.0, x, x + 1.0], 0);
        let upward = ray([y, y, y + 1.0, y + 1.0], 1);
        let along = |k: usize| forward[k] + right[k] * across + up[k] * upward;
        self.visual.textures[sky].sample(&[along(0), along(2), -along(1)], wanted)
    }
}
