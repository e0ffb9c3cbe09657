//! The part of a submission that changes from frame to frame: culled drawables, their instances, the order of drawing.

use super::atlas::{Atlas, Tile};
use super::pipelines::{INSTANCE, Output};
use super::scene::{GpuScene, LIGHTS, VERTEX, add_vertices};
use crate::RenderRequest;
use crate::cpu::{PlacedLight, Vec3f, ViewCamera, dot, place_lights};
use crate::drawable::{BEHIND, Drawable, Element, OPAQUE, Shape};
use crate::posed_skins::PosedSkins;
use crate::scenery::Scenery;
use crate::single::single;

/// Number of views in a column of the texture of views, as in the shader.
pub const VIEW_ROWS: usize = 1024;
/// Number of texels per view, as in the shader.
pub const VIEW_TEXELS: usize = 7 + 2 * LIGHTS;

/// Instances of one class, drawn by one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawCall {
    pub class: usize,
    pub first: u32,
    pub count: u32,
    /// First vertex of a skin in [`SubmissionData::worn_vertices`].
    pub skins: Option<i32>,
}

/// The calls for one view, clipped to its image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewCalls {
    pub view: usize,
    pub calls: std::ops::Range<usize>,
}

/// The views and calls of one texture.
#[derive(Debug, Default)]
pub struct Chunk {
    /// Range of its views.
    pub views: std::ops::Range<usize>,
    /// Calls for opaque drawables that lie inside their images, all views together.
    pub shared: std::ops::Range<usize>,
    /// Calls for opaque drawables that extend beyond their images.
    pub own: Vec<ViewCalls>,
    /// Calls for transparent drawables, in drawing order.
    pub clear: Vec<ViewCalls>,
}

/// The data of a submission, kept between submissions to reuse its memory.
#[derive(Debug, Default)]
pub struct SubmissionData {
    pub instances: Vec<[f32; INSTANCE]>,
    /// The texture of views, row by row.
    pub views: Vec<[f32; 4]>,
    pub calls: Vec<DrawCall>,
    pub chunks: Vec<Chunk>,
    /// Vertices of the skins, view by view.
    pub worn_vertices: Vec<f32>,
    /// First vertex of each mesh of the skins, view by view.
    worn_starts: Vec<i32>,
    skins: PosedSkins,
    eyes: Vec<ViewCamera>,
    lights: Vec<PlacedLight>,
    /// View and drawable of the opaque drawables inside the view, for each class.
    inside: Vec<Vec<(usize, usize)>>,
    /// View, class and drawable of the opaque drawables that may have to be clipped.
    outside: Vec<(usize, usize, usize)>,
    /// View, distance and drawable of the transparent drawables.
    clear: Vec<(usize, f32, usize)>,
}

/// A scene with the images to draw of it.
#[derive(Clone, Copy)]
pub struct Submission<'a> {
    pub scenery: &'a Scenery,
    pub scene: &'a GpuScene,
    pub requests: &'a [RenderRequest<'a>],
    pub atlas: &'a Atlas,
    /// Width and height of the textures.
    pub size: [u32; 2],
    pub output: Output,
}

/// Returns the width and height of the texture that holds this many views.
pub fn views_size(count: usize) -> [usize; 2] {
    [
        VIEW_TEXELS * count.div_ceil(VIEW_ROWS).max(1),
        count.clamp(1, VIEW_ROWS),
    ]
}

impl SubmissionData {
    pub fn build(&mut self, r: &Submission) {
        self.instances.clear();
        self.calls.clear();
        self.chunks.clear();
        self.eyes.clear();
        self.wear(r);
        self.inside.resize_with(r.scene.classes.len(), Vec::new);
        let [width, height] = views_size(r.requests.len());
        self.views.clear();
        self.views.resize(width * height, [0.0; 4]);
        let mut first = 0;
        for chunk in 0..r.atlas.chunks.len() {
            let end = r.atlas.tiles.partition_point(|t| t.chunk <= chunk);
            for view in first..end {
                let request = &r.requests[view];
                let eye = ViewCamera::new(r.scenery, &request.poses, &request.view);
                self.eyes.push(eye);
                self.place(r, view, &eye);
                self.sort(r, view, &eye);
            }
            if end - first == 1 {
                // alone, an image is drawn as if there were no texture around it
                let all = self.inside.iter_mut().enumerate();
                let own = all.flat_map(|(class, found)| found.drain(..).map(move |(view, i)| (view, class, i)));
                self.outside.extend(own);
            }
            let shared = self.emit_inside(r);
            let own = self.emit_outside(r);
            let clear = self.emit_clear(r);
            self.chunks.push(Chunk {
                views: first..end,
                shared,
                own,
                clear,
            });
            first = end;
        }
    }

    /// Moves the flexes and skins to the poses of each view.
    fn wear(&mut self, r: &Submission) {
        self.worn_vertices.clear();
        self.worn_starts.clear();
        if r.scenery.soft_parts().next().is_none() {
            return;
        }
        for request in r.requests {
            self.skins.update(r.scenery, &request.poses);
            for mesh in self.skins.meshes() {
                self.worn_starts.push((self.worn_vertices.len() / VERTEX) as i32);
                add_vertices(mesh, &mut self.worn_vertices);
            }
        }
    }

    /// Writes the texels of a view.
    fn place(&mut self, r: &Submission, view: usize, eye: &ViewCamera) {
        let request = &r.requests[view];
        place_lights(r.scenery, &request.poses, eye, &mut self.lights);
        let [width, _] = views_size(r.requests.len());
        let start = view % VIEW_ROWS * width + view / VIEW_ROWS * VIEW_TEXELS;
        let texels = &mut self.views[start..start + VIEW_TEXELS];
        let with = |[a, b, c]: Vec3f, w: f32| [a, b, c, w];
        let Tile {
            x, y, width, height, ..
        } = r.atlas.tiles[view];
        let [w, h] = r.size.map(|n| n as f32);
        texels[0] = with(eye.pos, 0.0);
        texels[1] = with(eye.forward, 0.0);
        texels[2] = with(eye.right.map(|v| v * eye.tan[0]), 0.0);
        texels[3] = with(eye.up.map(|v| v * eye.tan[1]), 0.0);
        // from pixels of the image, upward, to the texture, whose rows run downward from 1 to -1
        texels[4] = [2.0 / w, -2.0 / h, 2.0 * x as f32 / w - 1.0, 1.0 - 2.0 * y as f32 / h];
        texels[5] = [
            0.5 * width as f32,
            0.5 * height as f32,
            eye.near,
            f32::from(u8::from(x + y > 0)),
        ];
        texels[6] = [eye.focal[0], eye.focal[1], eye.depth[0], eye.depth[1]];
        for (k, light) in self.lights.iter().take(LIGHTS).enumerate() {
            texels[7 + 2 * k] = light.pos.map_or([0.0; 4], |p| with(p, 1.0));
            texels[8 + 2 * k] = with(light.dir, 0.0);
        }
    }

    /// Culls and sorts the drawables of a view.
    fn sort(&mut self, r: &Submission, view: usize, eye: &ViewCamera) {
        for (i, drawable) in r.scenery.drawables.iter().enumerate() {
            let Some((drawable, pos, mat)) = drawable.placed(&r.requests[view].poses) else {
                continue;
            };
            let drawable = &drawable;
            let pos = drawable.centred(pos, &mat, eye.pos.map(f64::from));
            let at = eye.locate(single(pos));
            // drawables inside their image need no clipping at its border, so those of all views share one call
            let Some(whole) = seen(eye, at, drawable.radius, r.scenery.far as f32) else {
                continue;
            };
            // depth and segmentation have no blending: transparent drawables are drawn like the others
            let blended = drawable.rgba[3] < OPAQUE || behind(eye, drawable, single(pos), &mat);
            if blended && r.output == Output::Colour {
                // a plane's centre does not tell its distance; it is sorted behind the rest
                let key = if drawable.shape == Shape::Plane {
                    f32::INFINITY
                } else {
                    dot(at, at).sqrt() - drawable.radius
                };
                self.clear.push((view, key, i));
            } else if whole {
                self.inside[r.scene.class_of[i]].push((view, i));
            } else {
                self.outside.push((view, r.scene.class_of[i], i));
            }
        }
    }

    fn emit_inside(&mut self, r: &Submission) -> std::ops::Range<usize> {
        let start = self.calls.len();
        let mut inside = std::mem::take(&mut self.inside);
        for (class, found) in inside.iter_mut().enumerate() {
            for (view, drawable) in found.drain(..) {
                self.emit(r, start, class, view, drawable, false);
            }
        }
        self.inside = inside;
        start..self.calls.len()
    }

    fn emit_outside(&mut self, r: &Submission) -> Vec<ViewCalls> {
        let mut outside = std::mem::take(&mut self.outside);
        // by view, as each needs its own viewport; by class within, as instances of a class are one call
        outside.sort_unstable();
        let mut own = Vec::new();
        for of_view in outside.chunk_by(|a, b| a.0 == b.0) {
            let (start, view) = (self.calls.len(), of_view[0].0);
            for &(_, class, drawable) in of_view {
                self.emit(r, start, class, view, drawable, true);
            }
            let calls = start..self.calls.len();
            own.push(ViewCalls { view, calls });
        }
        outside.clear();
        self.outside = outside;
        own
    }

    /// Emits the transparent drawables of each view twice: from near to far, then from far to near.
    fn emit_clear(&mut self, r: &Submission) -> Vec<ViewCalls> {
        let mut clear = std::mem::take(&mut self.clear);
        clear.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut own = Vec::new();
        for of_view in clear.chunk_by(|a, b| a.0 == b.0) {
            let (start, view) = (self.calls.len(), of_view[0].0);
            for &(_, _, drawable) in of_view.iter().chain(of_view.iter().rev()) {
                let Some((_, pos, mat)) = r.scenery.drawables[drawable].placed(&r.requests[view].poses) else {
                    continue;
                };
                let class = if behind(&self.eyes[view], &r.scenery.drawables[drawable], single(pos), &mat) {
                    r.scene.class_behind[drawable]
                } else {
                    r.scene.class_of[drawable]
                };
                self.emit(r, start, class, view, drawable, true);
            }
            let calls = start..self.calls.len();
            own.push(ViewCalls { view, calls });
        }
        clear.clear();
        self.clear = clear;
        own
    }

    /// Adds an instance, to the last call since `start` if that is of the same class. `own` instances are drawn with the
    /// image as viewport.
    fn emit(&mut self, r: &Submission, start: usize, class: usize, view: usize, drawable: usize, own: bool) {
        let Some(instance) = instance(r, &self.eyes[view], view, &r.scenery.drawables[drawable], own) else {
            return;
        };
        let first = self.instances.len() as u32;
        let skins = r.scene.classes[class].worn.map(|mesh| {
            let meshes = self.worn_starts.len() / r.requests.len();
            self.worn_starts[view * meshes + mesh]
        });
        match self.calls[start..].last_mut() {
            Some(call) if (call.class, call.skins) == (class, skins) => call.count += 1,
            _ => self.calls.push(DrawCall {
                class,
                first,
                count: 1,
                skins,
            }),
        }
        self.instances.push(instance);
    }
}

/// Returns whether a sphere is in view: `None` if it is not, `Some(true)` if all of it is.
fn seen(eye: &ViewCamera, [x, y, z]: Vec3f, radius: f32, far: f32) -> Option<bool> {
    // distance from the sides of the view, positive inside
    let side = |v: f32, tan: f32| (z * tan - v.abs()) / (1.0 + tan * tan).sqrt();
    let margin = (z - eye.near).min(side(x, eye.tan[0])).min(side(y, eye.tan[1]));
    // written so that a NaN pose is out of view
    if margin > -radius && z.is_finite() {
        Some(margin > radius * 1.001 + 1e-6 && z + radius < far)
    } else {
        None
    }
}

/// Returns whether a drawable is a plane seen from behind.
fn behind(eye: &ViewCamera, drawable: &Drawable, pos: Vec3f, mat: &crate::math::Mat3) -> bool {
    let d = [eye.pos[0] - pos[0], eye.pos[1] - pos[1], eye.pos[2] - pos[2]];
    drawable.shape == Shape::Plane && dot(d, [mat[2] as f32, mat[5] as f32, mat[8] as f32]) < 0.0
}

/// Returns the attributes of an instance; `None` for a piece of a tendon that does not exist.
fn instance(r: &Submission, eye: &ViewCamera, view: usize, drawable: &Drawable, own: bool) -> Option<[f32; INSTANCE]> {
    let (drawable, pos, mat) = drawable.placed(&r.requests[view].poses)?;
    let drawable = &drawable;
    let pos = drawable.centred(pos, &mat, eye.pos.map(f64::from));
    let [x, y, z] = eye.model(pos, &mat, drawable.size);
    let [sx, sy, length] = drawable.size;
    let cap = 0.5 * (sx + sy);
    let [red, green, blue, mut alpha] = drawable.rgba;
    if behind(eye, drawable, single(pos), &mat) {
        alpha *= BEHIND as f32;
    }
    let id = match drawable.element {
        Element::Geom(g) => (g + 1) as f32,
        Element::Site(_) | Element::Tendon { .. } => 0.0,
        Element::FlexEdge { .. } | Element::Flex(_) | Element::Skin(_) => 0.0,
    };
    let [u, v, s] = drawable.texture_scale;
    let (pos, m) = (single(pos), mat.map(|v| v as f32));
    let rows: [[f32; 4]; INSTANCE / 4] = [
        x,
        y,
        z,
        [sx, sy, length, view as f32],
        [
            cap / length,
            (length - cap) / cap,
            2.0 * (cap - length) / cap,
            f32::from(u8::from(own)),
        ],
        [red, green, blue, alpha],
        [
            drawable.emission,
            drawable.specular,
            drawable.exponent,
            drawable.texture_offset,
        ],
        [u, v, s, id],
        [m[0], m[1], m[2], pos[0]],
        [m[3], m[4], m[5], pos[1]],
        [m[6], m[7], m[8], pos[2]],
    ];
    let mut out = [0.0; INSTANCE];
    out.copy_from_slice(rows.as_flattened());
    Some(out)
}
