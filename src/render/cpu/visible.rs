//! Reads the visibility buffer: the triangles that an image shows, and their vertices, lit.

use wide::{f32x4, u32x4};

use super::camera::ViewCamera;
use super::frame::{Frame, PlacedDrawable};
use super::lanes::{four, three};
use super::light::{self, PlacedLight, VertexGroup};
use super::pixels::Pixels;
use super::target::{NONE, VisibilityBuffer};
use crate::drawable::Drawable;
use crate::mesh::Mesh;
use crate::scenery::Scenery;
use crate::view::Poses;

/// The triangles and vertices that are visible in an image.
#[derive(Debug, Default)]
pub struct VisibleTriangles {
    /// Indices of the records of triangles.
    pub triangles: Vec<u32>,
    pub lights: Vec<PlacedLight>,
    /// For each vertex of the frame, 1 if it is visible.
    marks: Vec<u8>,
    /// Index into `lit` for each visible vertex.
    lit_of: Vec<u32>,
    lit: Vec<LitVertex>,
    /// Visible points created by clipping, each with its drawable.
    points: Vec<[u32; 2]>,
}

/// A lit vertex of a visible triangle.
#[derive(Clone, Copy, Debug, Default)]
pub struct LitVertex {
    /// Red, green, blue, 1; for a plane with a [`Lattice`](crate::lattice::Lattice), the place on it, m, 0, 1.
    pub colour: f32x4,
    /// Texture coordinates, 0.
    pub texture: f32x4,
}

impl LitVertex {
    /// Lights four vertices of a mesh.
    #[inline(always)]
    fn new(
        lights: &[PlacedLight],
        drawable: &Drawable,
        draw: &PlacedDrawable,
        mesh: &Mesh,
        eye: &ViewCamera,
        vertices: [usize; 4],
    ) -> [Self; 4] {
        let lanes = |of: &dyn Fn(usize) -> f32| f32x4::new(four(|k| of(vertices[k])));
        let at = [&mesh.x, &mesh.y, &mesh.z].map(|v| lanes(&|i| v[i]));
        let corners = VertexGroup {
            part: four(|k| mesh.part_of(vertices[k])),
            at,
            normal: three(|k| lanes(&|i| mesh.normal[i][k])),
        };
        // on a plane that is lit on a lattice, the place is interpolated
        let [r, g, b] = match drawable.lattice {
            Some(_) => [at[0] * drawable.size[0], at[1] * drawable.size[1], f32x4::ZERO],
            None => light::vertices(lights, drawable, draw, eye.pos, &corners),
        };
        let [s, t, u] = if mesh.texcoord.is_empty() {
            three(|k| at[k] * drawable.texture_scale[k] + drawable.texture_offset)
        } else {
            let [s, t] = [0, 1].map(|k| lanes(&|i| mesh.texcoord[i][k]));
            [s, t, f32x4::ZERO]
        };
        let colours = f32x4::transpose([r, g, b, f32x4::ONE]);
        let places = f32x4::transpose([s, t, u, f32x4::ZERO]);
        four(|k| Self {
            colour: colours[k],
            texture: places[k],
        })
    }
}

/// Returns the number of vertices to reserve: five eighths of the frame's capacity if its vertices fit, otherwise all.
fn room(frame: &Frame) -> usize {
    let all = frame.vertices.capacity();
    // most of a frame's vertices belong to back faces or are occluded; room for all would seldom be used
    let most = all / 8 * 5;
    if frame.vertices.len() <= most { most } else { all }
}

impl VisibleTriangles {
    /// Returns the light on a visible vertex.
    #[inline(always)]
    pub fn lit(&self, vertex: u32) -> &LitVertex {
        &self.lit[self.lit_of[vertex as usize] as usize]
    }

    /// Finds the triangles that some pixels of a frame show, and numbers them; lights their vertices.
    pub fn find(&mut self, frame: &mut Frame, scenery: &Scenery, poses: &Poses, eye: &ViewCamera, pixels: Pixels) {
        // once an image, not once a drawable: no light depends on what it shines on
        light::place(scenery, poses, eye, &mut self.lights);
        // reserved with the frame's capacity, so that it does not grow later; a sample shows one triangle
        let samples = 4 * frame.colour.ids.len() + frame.colour.fragments.capacity();
        self.triangles.clear();
        self.triangles
            .reserve_exact(samples.min(frame.colour.records.capacity()));
        let room = room(frame);
        self.marks.clear();
        self.marks.reserve_exact(room);
        self.points.clear();
        self.points.reserve_exact(frame.points.capacity());
        match pixels {
            Pixels::All => self.number(&mut frame.colour, |_, _| true),
            Pixels::Second => {
                // rows here count from the bottom, wanted ones from the top
                let first = (frame.size[1] + 1) % 2;
                self.number(&mut frame.colour, |x, y| x % 2 == 0 && y % 2 == first);
            }
        }
        self.mark(frame);
        self.light(frame, scenery, poses, eye);
        self.between(frame);
    }

    /// Numbers the triangles that pixels show, and those of all fragments.
    #[inline(always)]
    fn number(&mut self, target: &mut VisibilityBuffer, wanted: impl Fn(usize, usize) -> bool) {
        let VisibilityBuffer {
            width,
            ids,
            records,
            fragments,
            ..
        } = target;
        let mut see = |id: u32| {
            // the background has no record: its index is beyond all
            if let Some(record) = records.get_mut(id as usize)
                && record.setup == NONE
            {
                record.setup = self.triangles.len() as u32;
                self.triangles.push(id);
            }
        };
        let mut last = NONE;
        for (y, row) in ids.chunks_exact(*width).enumerate() {
            for (k, several) in row.chunks(4).enumerate() {
                // neighbouring samples mostly show the same triangle
                let as_before = |ids: &[u32; 4]| u32x4::new(*ids).simd_eq(u32x4::splat(last));
                if let [a, b, c, d] = several
                    && (as_before(a) & as_before(b) & as_before(c) & as_before(d)).to_bitmask() == 15
                {
                    continue;
                }
                for (x, ids) in several.iter().enumerate() {
                    for &id in ids.iter().filter(|_| wanted(4 * k + x, y)) {
                        if id != last {
                            see(id);
                            last = id;
                        }
                    }
                }
            }
        }
        for fragment in fragments {
            see(fragment.id);
        }
    }

    /// Marks the vertices of visible triangles.
    fn mark(&mut self, frame: &Frame) {
        let count = frame.vertices.len();
        self.marks.resize(count, 0);
        // never cleared: entries of vertices without a mark are not read
        if self.lit_of.len() < count {
            let room = room(frame);
            self.lit_of.reserve_exact(room - self.lit_of.len());
            self.lit_of.resize(room, NONE);
        }
        for k in 0..self.triangles.len() {
            let id = self.triangles[k];
            let record = &frame.colour.records[id as usize];
            let end = frame.draws[record.draw as usize].end;
            for v in record.vertices {
                self.want(v, record.draw, end);
            }
        }
        // the list grows by the points between which others lie
        let mut next = 0;
        while let Some(&[v, draw]) = self.points.get(next) {
            let placed = &frame.draws[draw as usize];
            let point = frame.points[placed.points + v as usize - placed.end];
            self.want(point.from, draw, placed.end);
            self.want(point.to, draw, placed.end);
            next += 1;
        }
        // a vertex made by clipping comes after those it lies between, which have to be lit first
        self.points.sort_unstable();
    }

    /// Marks a vertex of a drawable, whose points created by clipping begin at `end`.
    #[inline(always)]
    fn want(&mut self, vertex: u32, draw: u32, end: usize) {
        let mark = &mut self.marks[vertex as usize];
        if *mark == 0 {
            *mark = 1;
            if vertex as usize >= end {
                self.points.push([vertex, draw]);
            }
        }
    }

    /// Lights the vertices of meshes.
    fn light(&mut self, frame: &Frame, scenery: &Scenery, poses: &Poses, eye: &ViewCamera) {
        const STRIDE: usize = 8;
        self.lit.clear();
        for &index in &frame.placed {
            let draw = &frame.draws[index as usize];
            let Some((drawable, ..)) = scenery.drawables[index as usize].placed(poses) else {
                continue;
            };
            let drawable = &drawable;
            let mesh = frame.skins.mesh(scenery, drawable);
            let (mut batch, mut count) = ([0; 4], 0);
            for first in (draw.base..draw.end).step_by(STRIDE) {
                // bands are filled up with vertices, so that their number is a multiple
                let marks = self.marks[first..].first_chunk::<STRIDE>();
                // a byte for each mark, so that eight are tested at once
                let mut rest = marks.map_or(0, |m| u64::from_le_bytes(*m));
                while rest != 0 {
                    let vertex = first + rest.trailing_zeros() as usize / 8;
                    rest &= rest - 1;
                    self.lit_of[vertex] = (self.lit.len() + count) as u32;
                    // four seen vertices side by side, however far apart they are in the mesh: most are not seen
                    batch[count] = vertex - draw.base;
                    count += 1;
                    if count == batch.len() {
                        let lit = LitVertex::new(&self.lights, drawable, draw, mesh, eye, batch);
                        self.lit.extend_from_slice(&lit);
                        count = 0;
                    }
                }
            }
            if count > 0 {
                let lit = LitVertex::new(&self.lights, drawable, draw, mesh, eye, batch);
                self.lit.extend_from_slice(&lit[..count]);
            }
        }
    }

    /// Lights the points created by clipping, which lie between others.
    fn between(&mut self, frame: &Frame) {
        for k in 0..self.points.len() {
            let [v, draw] = self.points[k];
            let own = &frame.draws[draw as usize];
            let point = frame.points[own.points + v as usize - own.end];
            let (from, to) = (*self.lit(point.from), *self.lit(point.to));
            // Mesa lights vertices before it clips: light on a new vertex is interpolated, not computed
            let share = f32x4::splat(point.share);
            self.lit_of[v as usize] = self.lit.len() as u32;
            self.lit.push(LitVertex {
                colour: from.colour + share * (to.colour - from.colour),
                texture: from.texture + share * (to.texture - from.texture),
            });
        }
    }
}
