//! The colour of what is seen: each triangle once per pixel, in the pixel's middle, averaged over the four samples.

use super::camera::{Eye, V3, part_rows};
use super::light::{self, PlacedLamp};
use super::raster::NONE;
use super::sample::Detail;
use super::{Frame, apply, part_of};
use crate::render::texture::Texture;
use crate::render::visual::{Poses, Visual};

/// Shades what a frame shows.
#[derive(Debug, Default)]
pub struct Shader {
    lamps: Vec<PlacedLamp>,
    /// Index in `lit` of each vertex of the frame, or [`NONE`].
    lit_of: Vec<u32>,
    lit: Vec<Lit>,
    setups: Vec<Setup>,
}

/// A vertex of a triangle that is seen.
#[derive(Clone, Copy, Debug)]
struct Lit {
    clip: V3,
    colour: V3,
    texture: V3,
}

/// How a triangle is shaded: numerators and the common denominator are linear in the pixel, counted from one where the
/// denominator is 1.
#[derive(Clone, Copy, Debug)]
struct Setup {
    origin: [f32; 2],
    denominator: [f32; 2],
    colour: [Linear; 3],
    coordinates: [Linear; 3],
    texture: Option<usize>,
}

/// Value at the origin, change to the right, change upward.
type Linear = [f32; 3];

/// Levels of detail of the triangles in a group of 2 x 2 pixels.
struct Quad {
    at: [f32; 2],
    known: [(u32, Detail); 4],
    count: usize,
}

/// Everything that is read while shading.
struct Scene<'a> {
    visual: &'a Visual,
    eye: &'a Eye,
    /// From pixels to half pictures.
    step: [f32; 2],
}

impl Shader {
    /// Writes the picture, rows from the top.
    pub fn resolve(&mut self, frame: &mut Frame, visual: &Visual, poses: &Poses, eye: &Eye, out: &mut [u8]) {
        light::place(visual, poses, eye, &mut self.lamps);
        self.lit_of.clear();
        self.lit_of.resize(frame.x.len(), NONE);
        self.lit.clear();
        self.setups.clear();
        let (w, h) = (frame.target.width, frame.target.height);
        let scene = Scene {
            visual,
            eye,
            step: [2.0 / w as f32, 2.0 / h as f32],
        };
        for qy in (0..h).step_by(2) {
            for qx in (0..w).step_by(2) {
                let mut quad = Quad {
                    at: [qx as f32, qy as f32],
                    known: [(NONE, Detail::default()); 4],
                    count: 0,
                };
                for y in qy..(qy + 2).min(h) {
                    for x in qx..(qx + 2).min(w) {
                        let rgb = self.pixel(frame, &scene, &mut quad, x, y);
                        let at = 3 * ((h - 1 - y) * w + x);
                        out[at..at + 3].copy_from_slice(&rgb);
                    }
                }
            }
        }
    }

    /// The average over the samples of a pixel, each rounded to a byte.
    fn pixel(&mut self, frame: &mut Frame, scene: &Scene, quad: &mut Quad, x: usize, y: usize) -> [u8; 3] {
        let ids = frame.target.ids[y * frame.target.width + x];
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
        let at = [x as f32, y as f32];
        if ids == [ids[0]; 4] {
            let [r, g, b] = self.colour(frame, scene, quad, at, ids[0]);
            return [byte(r) as u8, byte(g) as u8, byte(b) as u8];
        }
        let mut sum = [2; 3];
        for k in 0..4 {
            if ids[..k].contains(&ids[k]) {
                continue;
            }
            let share = ids[k..].iter().filter(|&&id| id == ids[k]).count() as u32;
            let colour = self.colour(frame, scene, quad, at, ids[k]);
            for (s, c) in sum.iter_mut().zip(colour) {
                *s += share * byte(c);
            }
        }
        [(sum[0] / 4) as u8, (sum[1] / 4) as u8, (sum[2] / 4) as u8]
    }

    /// The colour of a record in the middle of a pixel.
    fn colour(&mut self, frame: &mut Frame, scene: &Scene, quad: &mut Quad, at: [f32; 2], id: u32) -> V3 {
        if id == NONE {
            return scene.sky(quad, at);
        }
        let mut index = frame.target.records[id as usize].setup;
        if index == NONE {
            index = self.setups.len() as u32;
            let setup = self.setup(frame, scene, id, at);
            self.setups.push(setup);
            frame.target.records[id as usize].setup = index;
        }
        let setup = &self.setups[index as usize];
        let mut colour = setup.value(&setup.colour, at);
        if let Some(texture) = setup.texture {
            let texture = &scene.visual.textures[texture];
            let detail = quad.detail(id, texture, |at| setup.value(&setup.coordinates, at));
            let texel = texture.sample(setup.value(&setup.coordinates, at), detail);
            for (c, t) in colour.iter_mut().zip(texel) {
                *c *= t;
            }
        }
        colour
    }

    fn setup(&mut self, frame: &Frame, scene: &Scene, id: u32, at: [f32; 2]) -> Setup {
        let record = &frame.target.records[id as usize];
        let index = record.draw as usize;
        let drawable = &scene.visual.drawables[index];
        let draw = &frame.draws[index];
        let mesh = &scene.visual.meshes[drawable.shape as usize];
        let corners = record.vertices.map(|v| {
            let slot = self.lit_of[v as usize];
            if slot != NONE {
                return self.lit[slot as usize];
            }
            let i = v as usize - draw.base;
            let unit = [mesh.x[i], mesh.y[i], mesh.z[i]];
            let part = part_of(&mesh.parts, i);
            let lit = Lit {
                clip: apply(&part_rows(part, draw.rows, drawable.size), unit),
                colour: light::vertex(&self.lamps, drawable, draw, scene.eye.pos, (part, unit, mesh.normal[i])),
                texture: [0, 1, 2].map(|k| unit[k] * drawable.texture_scale[k] + drawable.texture_offset),
            };
            self.lit_of[v as usize] = self.lit.len() as u32;
            self.lit.push(lit);
            lit
        });
        Setup::new(scene, corners, at, drawable.texture)
    }
}

impl Setup {
    /// The weights of the corners are ratios of determinants of clip coordinates, which also holds for corners behind the
    /// camera.
    fn new(scene: &Scene, corners: [Lit; 3], at: [f32; 2], texture: Option<usize>) -> Self {
        let wide = |v: &Lit| [f64::from(v.clip[0]), f64::from(v.clip[1]), f64::from(v.clip[2])];
        let (p, q, r) = (wide(&corners[0]), wide(&corners[1]), wide(&corners[2]));
        use crate::math::cross;
        let normals = [cross(q, r), cross(r, p), cross(p, q)];
        let [sx, sy] = scene.step.map(f64::from);
        let (x, y) = ((f64::from(at[0]) + 0.5) * sx - 1.0, (f64::from(at[1]) + 0.5) * sy - 1.0);
        let [l, m, n] = normals;
        let weight = |n: [f64; 3]| n[0] * x + n[1] * y + n[2];
        let weights = [weight(l), weight(m), weight(n)];
        let total = weights[0] + weights[1] + weights[2];
        // an edge-on triangle has no denominator; it is one sample at most
        let scale = if total != 0.0 { 1.0 / total } else { 0.0 };
        let linear = |a: f32, b: f32, c: f32| -> Linear {
            let (a, b, c) = (f64::from(a), f64::from(b), f64::from(c));
            [
                ((a * weights[0] + b * weights[1] + c * weights[2]) * scale) as f32,
                ((a * l[0] + b * m[0] + c * n[0]) * scale * sx) as f32,
                ((a * l[1] + b * m[1] + c * n[1]) * scale * sy) as f32,
            ]
        };
        let [a, b, c] = &corners;
        let colour = |k: usize| linear(a.colour[k], b.colour[k], c.colour[k]);
        let coordinate = |k: usize| linear(a.texture[k], b.texture[k], c.texture[k]);
        let [_, dx, dy] = linear(1.0, 1.0, 1.0);
        Self {
            origin: at,
            denominator: [dx, dy],
            colour: [colour(0), colour(1), colour(2)],
            coordinates: if texture.is_some() {
                [coordinate(0), coordinate(1), coordinate(2)]
            } else {
                [[0.0; 3]; 3]
            },
            texture,
        }
    }

    fn value(&self, numerators: &[Linear; 3], at: [f32; 2]) -> V3 {
        let (dx, dy) = (at[0] - self.origin[0], at[1] - self.origin[1]);
        let scale = 1.0 / (1.0 + self.denominator[0] * dx + self.denominator[1] * dy);
        let [a, b, c] = numerators;
        let value = |n: &Linear| (n[0] + n[1] * dx + n[2] * dy) * scale;
        [value(a), value(b), value(c)]
    }
}

impl Quad {
    /// The level of detail of a record, from the coordinates in the lower left pixel of the group and its neighbours.
    fn detail(&mut self, id: u32, texture: &Texture, coordinates: impl Fn([f32; 2]) -> V3) -> Detail {
        if let Some(found) = self.known[..self.count].iter().find(|k| k.0 == id) {
            return found.1;
        }
        let [x, y] = self.at;
        let detail = texture.detail(
            coordinates([x, y]),
            coordinates([x + 1.0, y]),
            coordinates([x, y + 1.0]),
        );
        if self.count < self.known.len() {
            self.known[self.count] = (id, detail);
            self.count += 1;
        }
        detail
    }
}

impl Scene<'_> {
    /// The background: a cube map turned by 90 degrees about x, seen in the direction of a pixel.
    fn sky(&self, quad: &mut Quad, at: [f32; 2]) -> V3 {
        let Some(sky) = self.visual.sky else {
            return [0.0; 3];
        };
        let texture = &self.visual.textures[sky];
        let direction = |at: [f32; 2]| {
            let x = ((at[0] + 0.5) * self.step[0] - 1.0) * self.eye.tan[0];
            let y = ((at[1] + 0.5) * self.step[1] - 1.0) * self.eye.tan[1];
            let Eye { forward, right, up, .. } = self.eye;
            let along = |k: usize| forward[k] + right[k] * x + up[k] * y;
            let d = [along(0), along(1), along(2)];
            [d[0], d[2], -d[1]]
        };
        let detail = quad.detail(NONE, texture, direction);
        texture.sample(direction(at), detail)
    }
}
