//! The renderer in pure Rust: first which triangle is seen at each sample, then the colour of what is seen.

mod camera;
mod light;
mod raster;
mod sample;
mod shade;

use camera::{Eye, Row, V3, part_rows, single};
use raster::{CENTRE, Corner, LIMIT, NONE, Record, SAMPLES, Target};

use crate::math::{Mat3, Vec3};
use crate::render::RenderError;
use crate::render::mesh::Part;
use crate::render::visual::{Drawable, Element, Poses, Shape, View, Visual};
use shade::Shader;

/// Draws pictures. It keeps its buffers, so that drawing allocates nothing once the largest picture has been drawn.
///
/// Everything is single-precision and integer arithmetic in a fixed order: the same poses give the same bytes everywhere.
#[derive(Debug, Default)]
pub struct Renderer {
    frame: Frame,
    shader: Shader,
}

/// The geometry of a picture.
#[derive(Debug, Default)]
struct Frame {
    target: Target,
    /// Projected vertices of everything drawn, 1/256 pixels from the lower left.
    x: Vec<i32>,
    /// See `x`.
    y: Vec<i32>,
    /// 1/w; 0 for a vertex that has no place on the picture.
    iw: Vec<f32>,
    /// What is drawn, indexed as the drawables of the visual.
    draws: Vec<Draw>,
    /// Distance and index of drawables in view.
    order: Vec<(f32, u32)>,
}

/// A drawable at its place.
#[derive(Clone, Copy, Debug)]
struct Draw {
    pos: V3,
    mat: [f32; 9],
    rows: [Row; 3],
    /// Its first vertex in the frame.
    base: usize,
}

impl Draw {
    const HIDDEN: Self = Self {
        pos: [0.0; 3],
        mat: [0.0; 9],
        rows: [[0.0; 4]; 3],
        base: 0,
    };
}

impl Renderer {
    /// Without buffers yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Draws a picture: red, green, blue of each pixel, rows from the top.
    ///
    /// # Errors
    /// A camera that does not exist, a size that is not allowed, poses or a buffer of the wrong length.
    pub fn rgb(&mut self, visual: &Visual, poses: &Poses, view: &View, out: &mut [u8]) -> Result<(), RenderError> {
        fits(out.len(), view.rgb_len())?;
        let eye = self.frame.draw(visual, poses, view, SAMPLES)?;
        self.shader.resolve(&mut self.frame, visual, poses, &eye, out);
        Ok(())
    }

    /// Draws a grey picture: one byte for each pixel, rows from the top, by the weights 0.2989, 0.5870, 0.1140. `rgb` is
    /// working space of [`View::rgb_len`] bytes and holds the colours afterwards.
    ///
    /// # Errors
    /// As [`Renderer::rgb`].
    pub fn gray(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        rgb: &mut [u8],
        out: &mut [u8],
    ) -> Result<(), RenderError> {
        fits(out.len(), view.pixels())?;
        self.rgb(visual, poses, view, rgb)?;
        for (gray, pixel) in out.iter_mut().zip(rgb.chunks_exact(3)) {
            *gray = luma([pixel[0], pixel[1], pixel[2]]);
        }
        Ok(())
    }

    /// Distance from the camera's plane of what is seen in the middle of each pixel, m, rows from the top; infinite where
    /// nothing is.
    ///
    /// # Errors
    /// As [`Renderer::rgb`].
    pub fn depth(&mut self, visual: &Visual, poses: &Poses, view: &View, out: &mut [f32]) -> Result<(), RenderError> {
        fits(out.len(), view.pixels())?;
        self.frame.draw(visual, poses, view, CENTRE)?;
        let target = &self.frame.target;
        for (row, line) in out.chunks_exact_mut(view.width).rev().enumerate() {
            for (v, d) in line.iter_mut().zip(&target.depth[row * view.width..]) {
                *v = 1.0 / d[0];
            }
        }
        Ok(())
    }

    /// Which geom is seen in the middle of each pixel, rows from the top; -1 where none is. Sites hide what is behind them.
    ///
    /// # Errors
    /// As [`Renderer::rgb`].
    pub fn segmentation(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        out: &mut [i32],
    ) -> Result<(), RenderError> {
        fits(out.len(), view.pixels())?;
        self.frame.draw(visual, poses, view, CENTRE)?;
        let target = &self.frame.target;
        for (row, line) in out.chunks_exact_mut(view.width).rev().enumerate() {
            for (v, id) in line.iter_mut().zip(&target.ids[row * view.width..]) {
                let drawable = target
                    .records
                    .get(id[0] as usize)
                    .map(|r| &visual.drawables[r.draw as usize]);
                *v = match drawable.map(|d| d.element) {
                    Some(Element::Geom(g)) => g as i32,
                    _ => -1,
                };
            }
        }
        Ok(())
    }
}

/// The brightness of a colour, as `rgb2gray` computes it.
pub(crate) fn luma([r, g, b]: [u8; 3]) -> u8 {
    (0.2989 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b)) as u8
}

fn fits(found: usize, expected: usize) -> Result<(), RenderError> {
    if found == expected {
        Ok(())
    } else {
        Err(RenderError::Buffer { found, expected })
    }
}

/// The pose of a drawable.
fn pose(drawable: &Drawable, poses: &Poses) -> (Vec3, Mat3) {
    match drawable.element {
        Element::Geom(g) => (poses.geom_xpos[g], poses.geom_xmat[g]),
        Element::Site(s) => (poses.site_xpos[s], poses.site_xmat[s]),
    }
}

impl Frame {
    /// Finds what is seen at each sample.
    fn draw(
        &mut self,
        visual: &Visual,
        poses: &Poses,
        view: &View,
        samples: [[i32; 4]; 2],
    ) -> Result<Eye, RenderError> {
        visual.check(poses, view)?;
        let eye = Eye::new(visual, poses, view);
        self.target.clear(view.width, view.height, samples);
        self.x.clear();
        self.y.clear();
        self.iw.clear();
        self.draws.resize(visual.drawables.len(), Draw::HIDDEN);
        self.order.clear();
        for (i, drawable) in visual.drawables.iter().enumerate() {
            let (pos, _) = pose(drawable, poses);
            let [x, y, z] = eye.locate(single(pos));
            let r = drawable.radius;
            let beside = |v: f32, tan: f32| v.abs() - z * tan <= r * (1.0 + tan * tan).sqrt();
            // written so that a pose that is not a number is out of view
            if z > eye.near - r && beside(x, eye.tan[0]) && beside(y, eye.tan[1]) {
                let far_first = if drawable.shape == Shape::Plane {
                    f32::MAX
                } else {
                    z - r
                };
                self.order.push((far_first, i as u32));
            }
        }
        self.order
            .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for k in 0..self.order.len() {
            let i = self.order[k].1 as usize;
            let drawable = &visual.drawables[i];
            let (pos, mat) = pose(drawable, poses);
            if !self.hidden(drawable, &eye, single(pos)) {
                let rows = eye.projection(pos, &mat, drawable.size);
                self.add(
                    visual,
                    &eye,
                    i,
                    Draw {
                        pos: single(pos),
                        mat: mat.map(|v| v as f32),
                        rows,
                        base: self.x.len(),
                    },
                );
            }
        }
        Ok(eye)
    }

    /// Whether nearer things cover the bounding sphere of a drawable.
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
        x.start >= x.end || y.start >= y.end || self.target.hides(x, y, 1.0 / (z - r))
    }

    /// Projects and draws all triangles of a drawable.
    fn add(&mut self, visual: &Visual, eye: &Eye, index: usize, draw: Draw) {
        let drawable = &visual.drawables[index];
        let mesh = &visual.meshes[drawable.shape as usize];
        self.draws[index] = draw;
        let half = [self.target.width as f32 * 0.5, self.target.height as f32 * 0.5];
        let count = mesh.x.len();
        self.x.resize(draw.base + count, 0);
        self.y.resize(draw.base + count, 0);
        self.iw.resize(draw.base + count, 0.0);
        let (x, y, iw) = (
            &mut self.x[draw.base..],
            &mut self.y[draw.base..],
            &mut self.iw[draw.base..],
        );
        let mut start = 0;
        let mut all_placed = true;
        for &(part, end) in &mesh.parts {
            let rows = part_rows(part, draw.rows, drawable.size);
            all_placed &= project(
                [&mesh.x[start..end], &mesh.y[start..end], &mesh.z[start..end]],
                &rows,
                half,
                eye.near,
                (&mut x[start..end], &mut y[start..end], &mut iw[start..end]),
            );
            start = end;
        }
        for t in &mesh.triangles {
            let v = [
                draw.base + t[0] as usize,
                draw.base + t[1] as usize,
                draw.base + t[2] as usize,
            ];
            let corner = |i: usize| (self.x[i], self.y[i], self.iw[i]);
            let corners = [corner(v[0]), corner(v[1]), corner(v[2])];
            let record = Record {
                draw: index as u32,
                vertices: [v[0] as u32, v[1] as u32, v[2] as u32],
                setup: NONE,
            };
            if all_placed || corners.iter().all(|c| c.2 > 0.0) {
                self.target.triangle(corners, record);
            } else {
                let clip = t.map(|i| {
                    let i = i as usize;
                    let rows = part_rows(part_of(&mesh.parts, i), draw.rows, drawable.size);
                    apply(&rows, [mesh.x[i], mesh.y[i], mesh.z[i]])
                });
                self.clipped(clip, eye.near, half, record);
            }
        }
    }

    /// Draws what is left of a triangle that reaches behind the near plane or far beyond the edges of the picture.
    fn clipped(&mut self, clip: [V3; 3], near: f32, half: [f32; 2], record: Record) {
        let reach = half.map(|h| (LIMIT / 256.0 - 16.0 - h) / h);
        let planes: [[f32; 4]; 5] = [
            [0.0, 0.0, 1.0, -near],
            [1.0, 0.0, reach[0], 0.0],
            [-1.0, 0.0, reach[0], 0.0],
            [0.0, 1.0, reach[1], 0.0],
            [0.0, -1.0, reach[1], 0.0],
        ];
        // each of five planes adds at most one corner
        let mut polygon = [[0.0; 3]; 8];
        polygon[..3].copy_from_slice(&clip);
        let mut count = 3;
        for plane in planes {
            let side = |p: &V3| p[0] * plane[0] + p[1] * plane[1] + p[2] * plane[2] + plane[3];
            let source = polygon;
            let kept = count;
            count = 0;
            for k in 0..kept {
                let (p, q) = (source[k], source[(k + 1) % kept]);
                let (a, b) = (side(&p), side(&q));
                if a >= 0.0 && count < polygon.len() {
                    polygon[count] = p;
                    count += 1;
                }
                if (a >= 0.0) != (b >= 0.0) && count < polygon.len() {
                    let t = a / (a - b);
                    polygon[count] = [0, 1, 2].map(|i| p[i] + (q[i] - p[i]) * t);
                    count += 1;
                }
            }
        }
        let corner = |p: V3| -> Corner {
            let iw = 1.0 / p[2].max(near);
            (
                fixed((p[0] * iw) * half[0] + half[0]),
                fixed((p[1] * iw) * half[1] + half[1]),
                iw,
            )
        };
        for k in 2..count {
            let corners = [polygon[0], polygon[k - 1], polygon[k]].map(corner);
            self.target.triangle(corners, record);
        }
    }
}

fn part_of(parts: &[(Part, usize)], vertex: usize) -> Part {
    parts.iter().find(|p| vertex < p.1).map_or(Part::Body, |p| p.0)
}

#[inline(always)]
fn apply(rows: &[Row; 3], [x, y, z]: V3) -> V3 {
    let row = |r: &Row| x * r[0] + y * r[1] + z * r[2] + r[3];
    [row(&rows[0]), row(&rows[1]), row(&rows[2])]
}

/// To 1/256 pixels, to the nearest, halves to even. Beyond [`LIMIT`] the result is at the limit.
#[inline(always)]
fn fixed(pixels: f32) -> i32 {
    // adding 1.5 * 2^23 leaves the integer in the low bits
    const SHIFT: f32 = 12_582_912.0;
    #[allow(clippy::manual_clamp)] // unlike `clamp`, this makes a number of what is none
    let v = (pixels * 256.0).max(-LIMIT).min(LIMIT);
    (v + SHIFT).to_bits() as i32 - SHIFT.to_bits() as i32
}

/// Projects vertices. Tells whether all have a place on the picture: before the near plane and not too far outside.
#[inline]
fn project(
    [mx, my, mz]: [&[f32]; 3],
    rows: &[Row; 3],
    half: [f32; 2],
    near: f32,
    (ox, oy, oiw): (&mut [i32], &mut [i32], &mut [f32]),
) -> bool {
    let n = mx.len();
    let (my, mz) = (&my[..n], &mz[..n]);
    let (ox, oy, oiw) = (&mut ox[..n], &mut oy[..n], &mut oiw[..n]);
    let mut least = 1.0f32;
    let edge = LIMIT / 256.0 - 8.0;
    for i in 0..n {
        let [x, y, w] = apply(rows, [mx[i], my[i], mz[i]]);
        let iw = 1.0 / w;
        let (px, py) = ((x * iw) * half[0] + half[0], (y * iw) * half[1] + half[1]);
        let placed = (w >= near) & (px.abs() <= edge) & (py.abs() <= edge);
        ox[i] = fixed(px);
        oy[i] = fixed(py);
        oiw[i] = if placed { iw } else { 0.0 };
        least = least.min(oiw[i]);
    }
    least > 0.0
}
