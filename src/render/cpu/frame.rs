//! The geometry of an image: what is in view, projected, clipped and rasterised.

use std::ops::Range;

use super::camera::{Eye, Row, V3, dot, fused, part_rows, single};
use super::clip::{self, Clip, EdgePoint, Origin, Polygon};
use super::plane::{Basis, Vertex};
use super::raster::{Extent, Fixed, LIMIT, is_counterclockwise};
use super::sampling::Sampling;
use super::target::{NONE, Opaque, Target, Transparent, Triangle};
use crate::math::{Mat3, Vec3};
use crate::render::RenderError;
use crate::render::mesh::{LANES, Mesh};
use crate::render::view::{Poses, View};
use crate::render::visual::{Drawable, Element, Shape, Visual};

/// The geometry of an image.
#[derive(Debug, Default)]
pub struct Frame {
    pub target: Target,
    /// Projected vertices of everything that is drawn.
    pub vertices: Vec<Vertex>,
    fixed: Vec<Fixed>,
    /// For each vertex, one bit for every clipping plane that it lies beyond.
    sides: Vec<u8>,
    /// For each band of the drawable being drawn, the sides on which any of its vertices is, and on which all are.
    bands: Vec<(u8, u8)>,
    /// Points made by clipping.
    pub points: Vec<ClipPoint>,
    /// Everything that is drawn, indexed like the drawables of the visual.
    pub draws: Vec<PlacedDrawable>,
    /// Distance and index of the opaque drawables in view.
    opaque: Vec<(f32, u32)>,
    /// Distance and index of the transparent drawables in view.
    transparent: Vec<(f32, u32)>,
    /// Range of fragments of each transparent drawable, the nearest drawable first.
    pub layers: Vec<Range<usize>>,
}

/// A drawable with its pose in the world.
#[derive(Clone, Copy, Debug)]
pub struct PlacedDrawable {
    pub pos: V3,
    pub mat: [f32; 9],
    /// Transform from the unit shape to the camera frame.
    rows: [Row; 3],
    /// Index of its first vertex in the frame.
    pub base: usize,
    /// Index of its first point among those made by clipping; they follow its vertices in the frame.
    pub points: usize,
    /// Opacity.
    pub alpha: f32,
    /// Whether it shows its back, so that triangles are wound the other way.
    flip: bool,
    /// Whether it is transparent: it hides nothing.
    transparent: bool,
}

/// A vertex between two other vertices of the frame: `from + share (to - from)`.
#[derive(Clone, Copy, Debug)]
pub struct ClipPoint {
    pub from: u32,
    pub to: u32,
    pub share: f32,
}

impl PlacedDrawable {
    const HIDDEN: Self = Self {
        pos: [0.0; 3],
        mat: [0.0; 9],
        rows: [[0.0; 4]; 3],
        base: 0,
        points: 0,
        alpha: 1.0,
        flip: false,
        transparent: false,
    };
}

/// The treatment of transparent drawables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transparency {
    /// PlacedDrawable them as if they were opaque.
    Opaque,
    /// Leave them out.
    Hidden,
    /// Collect their fragments for blending.
    Blended,
}

/// Least opacity of an opaque drawable.
const OPAQUE: f32 = 0.995;
/// Factor on the opacity of a plane seen from behind.
const BEHIND: f64 = 0.3;

/// Returns the pose of a drawable in the world.
pub fn pose(drawable: &Drawable, poses: &Poses) -> (Vec3, Mat3) {
    match drawable.element {
        Element::Geom(g) => (poses.geom_xpos[g], poses.geom_xmat[g]),
        Element::Site(s) => (poses.site_xpos[s], poses.site_xmat[s]),
    }
}

impl Frame {
    /// Finds what is seen at each sample.
    pub fn draw<S: Sampling>(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        transparency: Transparency,
    ) -> Result<Eye, RenderError> {
        visual.check(poses, view)?;
        let eye = Eye::new(visual, poses, view);
        self.clear(visual, view);
        for (i, drawable) in visual.drawables.iter().enumerate() {
            let (pos, mat) = pose(drawable, poses);
            let [x, y, z] = eye.locate(single(pos));
            let r = drawable.radius;
            let beside = |v: f32, tan: f32| v.abs() - z * tan <= r * (1.0 + tan * tan).sqrt();
            // written so that a NaN pose is out of view
            if z > eye.near - r && beside(x, eye.tan[0]) && beside(y, eye.tan[1]) {
                self.arrange(drawable, &eye, i, (single(pos), mat.map(|v| v as f32), z));
            }
        }
        let nearer = |a: &(f32, u32), b: &(f32, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if transparency == Transparency::Opaque {
            self.opaque.append(&mut self.transparent);
        }
        self.opaque.sort_unstable_by(nearer);
        self.transparent.sort_unstable_by(nearer);
        for k in 0..self.opaque.len() {
            self.place::<S>(visual, poses, &eye, self.opaque[k].1 as usize, false);
        }
        if transparency == Transparency::Blended {
            for k in 0..self.transparent.len() {
                let start = self.target.fragments.len();
                self.place::<S>(visual, poses, &eye, self.transparent[k].1 as usize, true);
                self.layers.push(start..self.target.fragments.len());
            }
        }
        Ok(eye)
    }

    fn clear(&mut self, visual: &Visual, view: &View) {
        self.target.clear(view.width, view.height);
        self.vertices.clear();
        self.fixed.clear();
        self.sides.clear();
        self.points.clear();
        self.draws.clear();
        self.draws.resize(visual.drawables.len(), PlacedDrawable::HIDDEN);
        self.opaque.clear();
        self.transparent.clear();
        self.layers.clear();
    }

    /// Adds a drawable, which is `ahead` of the camera, to the list of opaque or transparent ones.
    fn arrange(&mut self, drawable: &Drawable, eye: &Eye, index: usize, (pos, mat, ahead): (V3, [f32; 9], f32)) {
        let plane = drawable.shape == Shape::Plane;
        let d = [eye.pos[0] - pos[0], eye.pos[1] - pos[1], eye.pos[2] - pos[2]];
        let draw = &mut self.draws[index];
        draw.flip = plane && dot(d, [mat[2], mat[5], mat[8]]) < 0.0;
        draw.alpha = drawable.rgba[3];
        let far = if plane { f32::MAX } else { ahead - drawable.radius };
        if draw.alpha < OPAQUE || draw.flip {
            if draw.flip {
                draw.alpha = (f64::from(draw.alpha) * BEHIND) as f32;
            }
            let distance = dot(d, d).sqrt() - drawable.radius;
            self.transparent
                .push((if plane { far } else { distance }, index as u32));
        } else {
            self.opaque.push((far, index as u32));
        }
    }

    /// Draws a drawable unless it is hidden.
    fn place<S: Sampling>(&mut self, visual: &Visual, poses: &Poses, eye: &Eye, index: usize, transparent: bool) {
        let drawable = &visual.drawables[index];
        let (pos, mat) = pose(drawable, poses);
        if self.hidden(drawable, eye, single(pos)) {
            return;
        }
        self.draws[index] = PlacedDrawable {
            pos: single(pos),
            mat: mat.map(|v| v as f32),
            rows: eye.model(pos, &mat, drawable.size),
            base: self.vertices.len(),
            points: self.points.len(),
            transparent,
            ..self.draws[index]
        };
        self.add::<S>(visual, eye, index);
    }

    /// Returns the distance (m) from the camera's plane to what the middle of a pixel shows; infinity where it shows
    /// nothing.
    pub fn distance(&self, x: usize, y: usize) -> f32 {
        let id = self.target.ids[y * self.target.width + x][0];
        self.target.records.get(id as usize).map_or(f32::INFINITY, |record| {
            let vertices = record.vertices.map(|v| &self.vertices[v as usize]);
            let plane = Basis::new(vertices).plane(vertices.map(|v| v.iw));
            1.0 / plane.at([x as f32 + 0.5; 4], [y as f32 + 0.5; 4])[0]
        })
    }

    /// Returns whether nearer things cover the bounding sphere of a drawable.
    fn hidden(&self, drawable: &Drawable, eye: &Eye, pos: V3) -> bool {
        let [x, y, z] = eye.locate(pos);
        let r = drawable.radius;
        if z - r <= eye.near {
            return false;
        }
        let range = |v: f32, tan: f32, pixels: usize| {
            let (d, root) = (z * z - r * r, r * (v * v + z * z - r * r).sqrt());
            let place = |t: f32| (t / tan * 0.5 + 0.5) * pixels as f32;
            let low = place((v * z - root) / d).floor() - 1.0;
            let high = place((v * z + root) / d).ceil() + 1.0;
            low.clamp(0.0, pixels as f32) as usize..high.clamp(0.0, pixels as f32) as usize
        };
        let x = range(x, eye.tan[0], self.target.width);
        let y = range(y, eye.tan[1], self.target.height);
        // steep triangles are off by some rounding
        const SAFE: f32 = 1.001;
        x.start >= x.end || y.start >= y.end || self.target.hides(x, y, eye.depth_at(z - r) * SAFE)
    }

    /// Projects and draws all triangles of a drawable.
    fn add<S: Sampling>(&mut self, visual: &Visual, eye: &Eye, index: usize) {
        let drawable = &visual.drawables[index];
        let mesh = &visual.meshes[drawable.shape as usize];
        let draw = self.draws[index];
        let half = [self.target.width as f32 * 0.5, self.target.height as f32 * 0.5];
        self.bands.clear();
        for band in &mesh.bands {
            let rows = eye.project(part_rows(band.part, draw.rows, drawable.size));
            let sides = if clip::is_box_outside(&rows, band.low, band.high) {
                let end = self.vertices.len() + band.vertices.len();
                self.vertices.resize(end, Vertex::default());
                self.fixed.resize(end, [0; 2]);
                self.sides.resize(end, u8::MAX);
                (u8::MAX, u8::MAX)
            } else {
                self.project(mesh, band.vertices.clone(), &rows, half)
            };
            self.bands.push(sides);
        }
        for (k, band) in mesh.bands.iter().enumerate() {
            match self.bands[k] {
                (0, _) if !draw.flip => self.inside::<S>(mesh, index, band.triangles.clone()),
                (_, 0) => {
                    let rows = eye.project(part_rows(band.part, draw.rows, drawable.size));
                    self.across::<S>(mesh, &rows, index, band.triangles.clone());
                }
                _ => {}
            }
        }
    }

    /// Draws triangles of which some are not wholly in view.
    fn across<S: Sampling>(&mut self, mesh: &Mesh, rows: &[Row; 4], index: usize, range: Range<usize>) {
        let draw = self.draws[index];
        for &[a, b, c] in &mesh.triangles[range] {
            let t = if draw.flip { [a, c, b] } else { [a, b, c] };
            let own = t.map(|i| draw.base + usize::from(i));
            let [p, q, r] = own.map(|i| self.sides[i]);
            if p & q & r != 0 {
                continue;
            }
            if p | q | r != 0 {
                self.clipped::<S>(mesh, rows, index, t, p | q | r);
            } else if is_seen::<S>(&own.map(|i| self.fixed[i])) {
                self.triangle::<S>(index, own);
            }
        }
    }

    /// Draws triangles that are wholly in view.
    fn inside<S: Sampling>(&mut self, mesh: &Mesh, index: usize, range: Range<usize>) {
        let base = self.draws[index].base;
        let mut k = range.start;
        let all = &mesh.triangles[..range.end];
        while k < all.len() {
            let fixed = &self.fixed[base..base + mesh.x.len()];
            let seen = |t: &[u16; 3]| is_seen::<S>(&t.map(|i| fixed[usize::from(i)]));
            let Some(next) = all[k..].iter().position(seen) else {
                return;
            };
            k += next;
            self.triangle::<S>(index, all[k].map(|i| base + usize::from(i)));
            k += 1;
        }
    }

    /// Draws a triangle, whose vertices are given, unless it shows its back.
    fn triangle<S: Sampling>(&mut self, index: usize, [a, b, c]: [usize; 3]) {
        let fixed = [self.fixed[a], self.fixed[b], self.fixed[c]];
        if !is_counterclockwise(&fixed) {
            return;
        }
        // the order in which Mesa sets triangles up
        let record = Triangle {
            draw: index as u32,
            vertices: [b as u32, a as u32, c as u32],
            setup: NONE,
        };
        if self.draws[index].transparent {
            self.target.triangle::<S, Transparent>(&fixed, &self.vertices, record);
        } else {
            self.target.triangle::<S, Opaque>(&fixed, &self.vertices, record);
        }
    }

    /// Projects vertices of a mesh. Gives the outer sides on which any of them is, and on which all are.
    fn project(&mut self, mesh: &Mesh, range: Range<usize>, rows: &[Row; 4], half: [f32; 2]) -> (u8, u8) {
        let (mut any, mut all) = (0, u8::MAX);
        let coordinates = |v: &[f32], at: usize| -> [f32; LANES] {
            let mut out = [0.0; LANES];
            out.copy_from_slice(&v[at..at + LANES]);
            out
        };
        for at in range.step_by(LANES) {
            let [x, y, z] = [&mesh.x, &mesh.y, &mesh.z].map(|v| coordinates(v, at));
            let (mut vertices, mut places) = ([Vertex::default(); LANES], [[0; 2]; LANES]);
            let (mut px, mut py, mut pz, mut iw) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
            let mut sides = [0; LANES];
            for k in 0..LANES {
                let clip = clip::apply(rows, [x[k], y[k], z[k]]);
                let [cx, cy, cz, cw] = clip;
                iw[k] = 1.0 / cw;
                px[k] = fused(cx * iw[k], half[0], half[0]);
                py[k] = fused(cy * iw[k], half[1], half[1]);
                pz[k] = cz * iw[k];
                sides[k] = clip::outside(clip);
            }
            for k in 0..LANES {
                vertices[k] = Vertex {
                    x: px[k],
                    y: py[k],
                    z: pz[k],
                    iw: iw[k],
                };
                places[k] = [fixed(px[k]), fixed(py[k])];
            }
            let sides = sides.map(|s| s as u8);
            self.vertices.extend_from_slice(&vertices);
            self.fixed.extend_from_slice(&places);
            self.sides.extend_from_slice(&sides);
            for s in &sides {
                any |= s;
                all &= s;
            }
        }
        (any, all)
    }

    /// Draws what is left of a triangle that reaches beyond some sides of what is seen.
    #[cold]
    fn clipped<S: Sampling>(&mut self, mesh: &Mesh, rows: &[Row; 4], index: usize, t: [u16; 3], sides: u8) {
        let draw = self.draws[index];
        let half = [self.target.width, self.target.height].map(|n| n as f32 * 0.5);
        let corner = |i: u16| {
            let i = usize::from(i);
            clip::apply(rows, [mesh.x[i], mesh.y[i], mesh.z[i]])
        };
        let triangle: [Clip; 3] = [corner(t[0]), corner(t[1]), corner(t[2])];
        if clip::faces_away(&triangle) {
            return;
        }
        let mut polygon = Polygon::new(triangle);
        polygon.cut(u32::from(sides));
        let (corners, points) = polygon.parts();
        if corners.len() < 3 {
            return;
        }
        let first = self.vertices.len();
        let place = |source: Origin| match source {
            Origin::Own(k) => draw.base + usize::from(t[k]),
            Origin::New(k) => first + k,
        };
        for &EdgePoint { clip, from, to, share } in points {
            let vertex = clip::project(clip, half);
            self.fixed.push([fixed(vertex.x), fixed(vertex.y)]);
            self.vertices.push(vertex);
            self.sides.push(0);
            self.points.push(ClipPoint {
                from: place(from) as u32,
                to: place(to) as u32,
                share,
            });
        }
        for k in 2..corners.len() {
            let [a, b, c] = [k - 1, k, 0].map(|k| place(corners[k].from));
            self.triangle::<S>(index, [a, b, c]);
        }
    }
}

/// Returns whether a triangle shows its front and does not lie between the samples.
#[inline(always)]
fn is_seen<S: Sampling>(fixed: &[Fixed; 3]) -> bool {
    is_counterclockwise(fixed) && !Extent::new(fixed).misses::<S>()
}

/// Converts to 1/256 pixels, rounded to the nearest, halves to even. Beyond [`LIMIT`] the result is at the limit.
#[inline(always)]
fn fixed(pixels: f32) -> i32 {
    // adding 1.5 * 2^23 leaves the integer in the low bits
    const SHIFT: f32 = 12_582_912.0;
    #[allow(clippy::manual_clamp)] // unlike `clamp`, this turns NaN into a number
    let v = (pixels * 256.0).max(-LIMIT).min(LIMIT);
    (v + SHIFT).to_bits() as i32 - SHIFT.to_bits() as i32
}
