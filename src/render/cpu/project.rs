//! Vertex transform: the vertices of faces that may be front faces are projected.

use std::ops::Range;

use wide::f32x4;

use super::camera::{AffineRow, ViewCamera, fused, part_rows};
use super::clip::{self, FrustumTest};
use super::facing::LocalCamera;
use super::frame::Frame;
use super::plane::Vertex;
use super::raster::to_fixed_point;
use crate::drawable::Drawable;
use crate::mesh::{Band, Mesh};
use crate::patch::ALL;
use crate::scenery::Scenery;
use crate::strip::LANES;

impl Frame {
    /// Projects and draws the drawable with an index.
    pub fn add(&mut self, scenery: &Scenery, drawable: &Drawable, eye: &ViewCamera, index: usize) {
        let skins = std::mem::take(&mut self.skins);
        let mesh = skins.mesh(scenery, drawable);
        let draw = self.draws[index];
        self.vertices.resize(draw.end, Vertex::default());
        self.x.resize(draw.end, 0.0);
        self.y.resize(draw.end, 0.0);
        self.sides.resize(draw.end, 0);
        self.fronts.clear();
        self.fronts.resize(mesh.patches.len(), ALL);
        let facing = LocalCamera::new(drawable, &draw, eye, self.size);
        for band in &mesh.bands {
            let rows = eye.project(part_rows(band.part, draw.rows, drawable.size));
            // a band that is wholly in view needs no clip codes, and a band outside needs no vertices: most of a scene
            // is one or the other
            match (clip::place(&rows, band.low, band.high), &facing) {
                (FrustumTest::Outside, _) => {}
                (FrustumTest::Inside, Some(facing)) => {
                    self.find_fronts(mesh, band, facing);
                    for group in band.vertices.start / LANES..band.vertices.end / LANES {
                        if self.needed[group] {
                            self.project(mesh, draw.base, group, &rows);
                        }
                    }
                    self.inside(mesh, index, band);
                }
                _ => match self.project_all(mesh, draw.base, band.vertices.clone(), &rows) {
                    // the box crosses a plane, but no vertex is beyond one
                    (0, _) if !draw.flip => self.inside(mesh, index, band),
                    (_, 0) => self.across(mesh, &rows, index, band),
                    _ => {}
                },
            }
        }
        self.flush(index);
        self.skins = skins;
    }

    /// Finds the quadrilaterals of a band that may show their front, and their vertices.
    fn find_fronts(&mut self, mesh: &Mesh, band: &Band, facing: &LocalCamera) {
        let facing = facing.of(band);
        self.needed.clear();
        self.needed.resize(mesh.x.len() / LANES, false);
        for k in band.patches.clone() {
            let patch = &mesh.patches[k];
            let fronts = facing.fronts(patch);
            self.fronts[k] = fronts;
            if fronts != 0 {
                for group in patch.vertices {
                    self.needed[usize::from(group)] = true;
                }
            }
        }
    }

    /// Projects vertices of a mesh. Returns the outer sides on which any of them lies, and those on which all lie.
    fn project_all(&mut self, mesh: &Mesh, base: usize, range: Range<usize>, rows: &[AffineRow; 4]) -> (u8, u8) {
        let (mut any, mut all) = (0, u8::MAX);
        for group in range.start / LANES..range.end / LANES {
            let clips = self.project(mesh, base, group, rows);
            let sides = &mut self.sides[base + LANES * group..][..LANES];
            for (side, clip) in sides.iter_mut().zip(clips) {
                *side = clip::outside(clip) as u8;
            }
            for side in sides {
                any |= *side;
                all &= *side;
            }
        }
        (any, all)
    }

    /// Projects a group of vertices of a mesh. Returns them in clip coordinates.
    #[inline(always)]
    fn project(&mut self, mesh: &Mesh, base: usize, group: usize, rows: &[AffineRow; 4]) -> [clip::ClipVertex; LANES] {
        let half = [self.size[0] as f32 * 0.5, self.size[1] as f32 * 0.5];
        let at = LANES * group;
        let coordinates = |v: &[f32]| -> [f32; LANES] {
            let mut out = [0.0; LANES];
            out.copy_from_slice(&v[at..at + LANES]);
            out
        };
        let (x, y, z) = (coordinates(&mesh.x), coordinates(&mesh.y), coordinates(&mesh.z));
        // loops over arrays of fixed length, a component at a time, which compilers turn into vector instructions
        let mut clips = [[0.0; 4]; LANES];
        let (mut px, mut py, mut pz, mut iw) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            clips[k] = clip::apply(rows, [x[k], y[k], z[k]]);
            let [cx, cy, cz, cw] = clips[k];
            iw[k] = 1.0 / cw;
            // llvmpipe's viewport transform is a fused product and sum; a different rounding here moves vertices by
            // 1/256 pixel
            px[k] = fused(cx * iw[k], half[0], half[0]);
            py[k] = fused(cy * iw[k], half[1], half[1]);
            pz[k] = cz * iw[k];
        }
        let vertices = &mut self.vertices[base + at..][..LANES];
        for k in 0..LANES {
            vertices[k] = Vertex {
                x: px[k],
                y: py[k],
                z: pz[k],
                iw: iw[k],
            };
        }
        for (places, pixels) in [(&mut self.x, px), (&mut self.y, py)] {
            let places = &mut places[base + at..][..LANES];
            for (places, pixels) in places.as_chunks_mut().0.iter_mut().zip(pixels.as_chunks().0) {
                *places = to_fixed_point(f32x4::new(*pixels)).to_array();
            }
        }
        clips
    }
}
