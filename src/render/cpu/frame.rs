//! The geometry of an image: frustum culling, the order of drawing, occlusion.

use std::ops::Range;

use super::camera::{AffineRow, Vec3f, ViewCamera, dot};
use super::group::TriangleGroup;
use super::plane::{Basis, Vertex};
use super::target::{Triangle, VisibilityBuffer};
use crate::RenderError;
use crate::drawable::{BEHIND, Drawable, OPAQUE, Shape};
use crate::posed_skins::PosedSkins;
use crate::scenery::Scenery;
use crate::single::single;
use crate::view::{Poses, View};

/// The geometry of an image.
#[derive(Debug, Default)]
pub struct Frame {
    /// The visibility buffer at four samples of each pixel, for colours.
    pub colour: VisibilityBuffer,
    /// The visibility buffer at the centre of each pixel, for depth and segmentation.
    pub centre: VisibilityBuffer,
    /// Which of the two are drawn.
    pub targets: Targets,
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// The skins.
    pub skins: PosedSkins,
    /// Projected vertices of everything that is drawn.
    pub vertices: Vec<Vertex>,
    /// Their positions, 1/256 pixels from the lower left, rounded to whole numbers.
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    /// For each vertex, one bit for every clipping plane that it lies beyond.
    pub sides: Vec<u8>,
    /// For each patch of the drawable being drawn, one bit for each quadrilateral that may show its front.
    pub fronts: Vec<u8>,
    /// For each group of vertices of the drawable being drawn, whether such a quadrilateral uses one.
    pub needed: Vec<bool>,
    /// Triangles of the drawable being drawn that are still to be rasterised.
    pub waiting: TriangleGroup,
    /// Vertices made by clipping.
    pub points: Vec<ClipPoint>,
    /// Everything that is drawn, indexed like the drawables of the scenery.
    pub draws: Vec<PlacedDrawable>,
    /// Distance and index of the opaque drawables in view.
    opaque: Vec<(f32, u32)>,
    /// Distance and index of the transparent drawables in view.
    transparent: Vec<(f32, u32)>,
    /// Indices of the drawables that are drawn.
    pub placed: Vec<u32>,
    /// Range of fragments of each transparent drawable, the nearest drawable first.
    pub layers: Vec<Range<usize>>,
}

/// A drawable with its pose in the world.
#[derive(Clone, Copy, Debug)]
pub struct PlacedDrawable {
    pub pos: Vec3f,
    pub mat: [f32; 9],
    /// Transform from the unit shape to the camera frame.
    pub rows: [AffineRow; 3],
    /// Index of its first vertex in the frame.
    pub base: usize,
    /// Index after its vertices, at which the vertices created by clipping begin.
    pub end: usize,
    /// Index of the first of these among all points created by clipping.
    pub points: usize,
    /// Opacity.
    pub alpha: f32,
    /// Whether it shows its back, so that triangles are wound the other way.
    pub flip: bool,
    /// Whether it is transparent: it hides nothing.
    pub transparent: bool,
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
        end: 0,
        points: 0,
        alpha: 1.0,
        flip: false,
        transparent: false,
    };
}

/// The targets to draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Targets {
    /// Four samples for each pixel, for colours.
    pub colour: bool,
    /// The centre of each pixel, for depth and segmentation.
    pub centre: bool,
}

impl Frame {
    /// Begins an image: finds the drawables in view.
    pub fn begin(
        &mut self,
        scenery: &Scenery,
        poses: &Poses,
        view: &View,
        targets: Targets,
    ) -> Result<ViewCamera, RenderError> {
        scenery.check(poses, view)?;
        let eye = ViewCamera::new(scenery, poses, view);
        self.clear(scenery, view, targets);
        self.skins.update(scenery, poses);
        for (i, drawable) in scenery.drawables.iter().enumerate() {
            let Some((drawable, pos, mat)) = drawable.placed(poses) else {
                continue;
            };
            let drawable = &drawable;
            let pos = drawable.centred(pos, &mat, eye.pos.map(f64::from));
            let [x, y, z] = eye.locate(single(pos));
            let r = drawable.radius;
            // the side planes of the frustum lean by `tan`; the root makes their normals unit vectors
            let beside = |v: f32, tan: f32| v.abs() - z * tan <= r * (1.0 + tan * tan).sqrt();
            // written so that a NaN pose is out of view
            if z > eye.near - r && beside(x, eye.tan[0]) && beside(y, eye.tan[1]) {
                self.arrange(drawable, &eye, i, single(pos), mat.map(|v| v as f32), z);
            }
        }
        // front to back: what is near occludes whole drawables behind it. Equal distances keep the model's order, so
        // that sorting gives the same image everywhere
        let nearer = |a: &(f32, u32), b: &(f32, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        self.opaque.sort_unstable_by(nearer);
        self.transparent.sort_unstable_by(nearer);
        Ok(eye)
    }

    /// Finds the opaque triangle that each sample shows.
    pub fn draw_opaque(&mut self, scenery: &Scenery, poses: &Poses, eye: &ViewCamera) {
        for k in 0..self.opaque.len() {
            self.place(scenery, poses, eye, self.opaque[k].1 as usize, false);
        }
    }

    /// Adds transparent drawables: their fragments for colours and, if `hiding` is set, also draws them to the pixel centres as if they were opaque.
    pub fn draw_transparent(&mut self, scenery: &Scenery, poses: &Poses, eye: &ViewCamera, hiding: bool) {
        self.targets.centre &= hiding;
        if self.targets == Targets::default() {
            return;
        }
        for k in 0..self.transparent.len() {
            let start = self.colour.fragments.len();
            self.place(scenery, poses, eye, self.transparent[k].1 as usize, true);
            self.layers.push(start..self.colour.fragments.len());
        }
    }

    fn clear(&mut self, scenery: &Scenery, view: &View, targets: Targets) {
        self.targets = targets;
        self.size = [view.width, view.height];
        for (target, wanted) in [(&mut self.colour, targets.colour), (&mut self.centre, targets.centre)] {
            if wanted {
                target.clear(view.width, view.height);
            }
        }
        self.vertices.clear();
        self.x.clear();
        self.y.clear();
        self.sides.clear();
        self.points.clear();
        self.draws.clear();
        self.draws.resize(scenery.drawables.len(), PlacedDrawable::HIDDEN);
        self.opaque.clear();
        self.transparent.clear();
        self.layers.clear();
        self.placed.clear();
    }

    /// Adds a drawable, which is `ahead` of the camera, to the list of opaque or transparent ones.
    fn arrange(&mut self, drawable: &Drawable, eye: &ViewCamera, index: usize, pos: Vec3f, mat: [f32; 9], ahead: f32) {
        let plane = drawable.shape == Shape::Plane;
        let d = [eye.pos[0] - pos[0], eye.pos[1] - pos[1], eye.pos[2] - pos[2]];
        let draw = &mut self.draws[index];
        draw.flip = plane && dot(d, [mat[2], mat[5], mat[8]]) < 0.0;
        draw.alpha = drawable.rgba[3];
        // a plane is seldom in front, and its centre does not tell how near it comes
        let far = if plane { f32::MAX } else { ahead - drawable.radius };
        if draw.alpha < OPAQUE || draw.flip {
            if draw.flip {
                draw.alpha = (f64::from(draw.alpha) * BEHIND) as f32;
            }
            // opaque drawables compare depths in the depth buffer, hence distances from the camera's plane; transparent
            // ones are blended in the order of their distances from the camera
            let distance = dot(d, d).sqrt() - drawable.radius;
            self.transparent
                .push((if plane { far } else { distance }, index as u32));
        } else {
            self.opaque.push((far, index as u32));
        }
    }

    /// Draws a drawable unless it is hidden.
    fn place(&mut self, scenery: &Scenery, poses: &Poses, eye: &ViewCamera, index: usize, transparent: bool) {
        let Some((drawable, pos, mat)) = scenery.drawables[index].placed(poses) else {
            return;
        };
        let drawable = &drawable;
        let pos = drawable.centred(pos, &mat, eye.pos.map(f64::from));
        if self.hidden(drawable, eye, single(pos)) {
            return;
        }
        self.draws[index] = PlacedDrawable {
            pos: single(pos),
            mat: mat.map(|v| v as f32),
            rows: eye.model(pos, &mat, drawable.size),
            base: self.vertices.len(),
            end: self.vertices.len() + self.skins.mesh(scenery, drawable).x.len(),
            points: self.points.len(),
            transparent,
            ..self.draws[index]
        };
        self.placed.push(index as u32);
        self.add(scenery, drawable, eye, index);
    }

    /// Writes the distance (m) from the camera's plane to the surface at the centre of each pixel, rows from the top;
    /// infinity where there is none.
    pub fn distances(&self, out: &mut [f32]) {
        self.middles(out, f32::INFINITY, |record, x, y| {
            let vertices = record.vertices.map(|v| &self.vertices[v as usize]);
            let plane = Basis::new(vertices).plane(vertices.map(|v| v.iw));
            // 1/w is linear in the image, and w is the distance from the camera's plane
            1.0 / plane.at([x as f32 + 0.5; 4], [y as f32 + 0.5; 4])[0]
        });
    }

    /// Writes the value of `of` for the drawable at the centre of each pixel, rows from the top; -1 where there is none.
    pub fn elements(&self, out: &mut [i32], of: impl Fn(usize) -> i32) {
        self.middles(out, -1, |record, _, _| of(record.draw as usize));
    }

    fn middles<T: Copy>(&self, out: &mut [T], nothing: T, of: impl Fn(&Triangle, usize, usize) -> T) {
        let width = self.size[0];
        for (y, line) in out.chunks_exact_mut(width).rev().enumerate() {
            for (x, v) in line.iter_mut().enumerate() {
                let record = self.centre.records.get(self.centre.ids[y * width + x][0] as usize);
                *v = record.map_or(nothing, |record| of(record, x, y));
            }
        }
    }

    /// Returns whether drawables drawn so far occlude the bounding sphere of a drawable.
    fn hidden(&self, drawable: &Drawable, eye: &ViewCamera, pos: Vec3f) -> bool {
        let [x, y, z] = eye.locate(pos);
        let r = drawable.radius;
        // part of it is in front of the near plane, where the tangents below have no meaning
        if z - r <= eye.near {
            return false;
        }
        let range = |v: f32, tan: f32, pixels: usize| {
            // the tangents of the two planes through the camera that touch the sphere, upright or level: the outline of
            // a sphere is not symmetric about its centre in perspective
            let (d, root) = (z * z - r * r, r * (v * v + z * z - r * r).sqrt());
            let place = |t: f32| (t / tan * 0.5 + 0.5) * pixels as f32;
            // one pixel more on either side, because vertices are rounded
            let low = place((v * z - root) / d).floor() - 1.0;
            let high = place((v * z + root) / d).ceil() + 1.0;
            low.clamp(0.0, pixels as f32) as usize..high.clamp(0.0, pixels as f32) as usize
        };
        let x = range(x, eye.tan[0], self.size[0]);
        let y = range(y, eye.tan[1], self.size[1]);
        // steep triangles are off by some rounding
        const SAFE: f32 = 1.001;
        let nearest = eye.depth_at(z - r) * SAFE;
        let hides = |wanted: bool, target: &VisibilityBuffer| !wanted || target.hides(x.clone(), y.clone(), nearest);
        x.start >= x.end
            || y.start >= y.end
            || (hides(self.targets.colour, &self.colour) && hides(self.targets.centre, &self.centre))
    }
}
