//! The target of rasterisation: the nearest triangle at each sample, and the fragments of transparent triangles.

use std::marker::PhantomData;

use wide::bytemuck::cast;
use wide::{f32x4, u32x4};

use super::lanes::{four, three};
use super::plane::Vertex;
use super::raster::{DepthFunction, Edges, FixedVertex, Sink, large, medium};
use super::sampling::Sampling;
use super::small::CoveredSamples;

/// Index of nothing.
pub const NONE: u32 = u32::MAX;

/// A triangle that some sample has shown. The visibility buffer refers to it by index.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Index of the drawable.
    pub draw: u32,
    /// Indices of its vertices in the frame.
    pub vertices: [u32; 3],
    /// Index of its shading, or [`NONE`].
    pub setup: u32,
}

/// The image being drawn; row 0 is the lowest.
#[derive(Debug, Default)]
pub struct VisibilityBuffer {
    pub width: usize,
    pub height: usize,
    /// Depth of each sample; 0 is the farthest.
    pub depth: Vec<[f32; 4]>,
    /// Index of the record that each sample shows.
    pub ids: Vec<[u32; 4]>,
    pub records: Vec<Triangle>,
    /// Fragments of transparent triangles.
    pub fragments: Vec<Fragment>,
}

/// The samples of one pixel that a transparent triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    /// Index of the pixel, counted from the lower left.
    pub at: u32,
    /// Index of the record.
    pub id: u32,
    /// One bit for each sample.
    pub samples: u32,
}

impl VisibilityBuffer {
    pub fn clear(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.depth.clear();
        self.depth.resize(width * height, [0.0; 4]);
        self.ids.clear();
        self.ids.resize(width * height, [NONE; 4]);
        self.records.clear();
        self.fragments.clear();
    }

    /// Returns whether every sample in a range of pixels is nearer than the depth `z`.
    pub fn hides(&self, x: std::ops::Range<usize>, y: std::ops::Range<usize>, z: f32) -> bool {
        // every sample, not the farthest of a coarser grid: everything hidden is left out, however close, and nothing visible
        y.into_iter().all(|row| {
            let row = &self.depth[row * self.width..][x.clone()];
            row.iter()
                .all(|&d| f32x4::new(d).simd_gt(f32x4::splat(z)).to_bitmask() == 15)
        })
    }

    /// Returns the record that all samples of a block of 2 x 2 pixels show; `None` if they show several or the block
    /// reaches beyond the image.
    #[inline(always)]
    pub fn only(&self, x: usize, y: usize) -> Option<u32> {
        if x + 1 >= self.width || y + 1 >= self.height {
            return None;
        }
        let first = y * self.width + x;
        let (low, high) = (&self.ids[first..first + 2], &self.ids[first + self.width..][..2]);
        let id = low[0][0];
        let same = |ids: [u32; 4]| u32x4::new(ids).simd_eq(u32x4::splat(id));
        // one triangle over a whole block is the common case, and is shaded without sorting samples out
        let all = (same(low[0]) & same(low[1])) & (same(high[0]) & same(high[1]));
        (all.to_bitmask() == 15).then_some(id)
    }

    /// Draws a large counterclockwise triangle of the kind `K`: [`Opaque`] or [`Transparent`]. `record` has the indices of its
    /// corners among `vertices`.
    #[inline(never)]
    pub fn large<'a, S: Sampling, K>(&'a mut self, fixed: &[FixedVertex; 3], vertices: &[Vertex], record: Triangle)
    where
        Writer<'a, K>: Sink,
    {
        let size = [self.width, self.height];
        let corners = record.vertices;
        let depth = || DepthFunction::new::<S>(three(|k| &vertices[corners[k] as usize]), size);
        large::<S>(&mut self.writer::<K>(record), size, fixed, depth);
    }

    /// Draws a triangle of medium size.
    #[inline(never)]
    pub fn medium<'a, S: Sampling, K>(
        &'a mut self,
        edges: &Edges,
        range: [[i32; 2]; 2],
        depth: &DepthFunction,
        record: Triangle,
    ) where
        Writer<'a, K>: Sink,
    {
        let width = self.width;
        medium::<S>(&mut self.writer::<K>(record), width, edges, range, depth);
    }

    fn writer<K>(&mut self, record: Triangle) -> Writer<'_, K> {
        Writer {
            target: self,
            record,
            id: NONE,
            kind: PhantomData,
        }
    }

    /// Draws a small triangle whose covered samples are known.
    #[inline(never)]
    pub fn spots<'a, S: Sampling, K>(&'a mut self, spots: &CoveredSamples, depth: &DepthFunction, record: Triangle)
    where
        Writer<'a, K>: Sink,
    {
        let (width, height) = (self.width, self.height);
        let mut writer = self.writer::<K>(record);
        let mut rest = spots.samples;
        while rest != 0 {
            let at = spots.pixel::<S>(rest.trailing_zeros() as usize);
            // a triangle smaller than a pixel may still reach into four: the samples of each go together
            let mut own = 0;
            for k in 0..4 {
                own |= u32::from(spots.pixel::<S>(k) == at) << k;
            }
            own &= rest;
            rest &= !own;
            let [x, y] = at;
            if (0..width as i32).contains(&x) && (0..height as i32).contains(&y) {
                let kinds = u32x4::new([1, 2, 4, 8]);
                let inside = (u32x4::splat(own) & kinds).simd_eq(kinds);
                writer.pixel(y as usize * width + x as usize, cast(inside), depth.at::<S>(x, y));
            }
        }
    }
}

/// The kind of triangle that hides those behind it: each sample keeps the nearest.
pub struct Opaque;
/// The kind of triangle that hides nothing: its fragments in front of everything opaque are collected.
pub struct Transparent;

/// A sink that writes a triangle to a target, and records it at the first sample that shows it.
pub struct Writer<'a, K> {
    target: &'a mut VisibilityBuffer,
    record: Triangle,
    id: u32,
    kind: PhantomData<K>,
}

/// Records a triangle unless it is already recorded; `id` is its index among the records, or [`NONE`].
#[inline(always)]
fn keep(id: &mut u32, records: &mut Vec<Triangle>, record: Triangle) {
    if *id == NONE {
        *id = records.len() as u32;
        records.push(record);
    }
}

impl Sink for Writer<'_, Opaque> {
    #[inline(always)]
    fn pixel(&mut self, at: usize, inside: f32x4, z: f32x4) {
        let depth = &mut self.target.depth[at];
        let before = f32x4::new(*depth);
        let mut seen = inside & z.simd_ge(before);
        if seen.to_bitmask() == 0 {
            return;
        }
        let ids = &mut self.target.ids[at];
        let records = &mut self.target.records;
        // at equal depth the one that comes later in the model is seen
        // MuJoCo draws in the order of the model and lets the later one win; here the nearer drawable is drawn first,
        // so the order has to be looked up
        let tie = (seen & z.simd_eq(before)).to_bitmask();
        if tie != 0 {
            let later = |id: u32| records.get(id as usize).is_some_and(|r| r.draw > self.record.draw);
            let covered = four(|k| tie >> k & 1 == 1 && ids[k] != self.id && later(ids[k]));
            let covered = u32x4::new(four(|k| if covered[k] { u32::MAX } else { 0 }));
            seen = cast(cast::<_, u32x4>(seen) & !covered);
            if seen.to_bitmask() == 0 {
                return;
            }
        }
        keep(&mut self.id, records, self.record);
        *depth = seen.select(z, before).to_array();
        let mask: u32x4 = cast(seen);
        *ids = mask.select(u32x4::splat(self.id), u32x4::new(*ids)).to_array();
    }
}

impl Sink for Writer<'_, Transparent> {
    fn pixel(&mut self, at: usize, inside: f32x4, z: f32x4) {
        // all opaque triangles are in the target by then, so what they hide is dropped here and never shaded
        let samples = (inside & z.simd_ge(f32x4::new(self.target.depth[at]))).to_bitmask();
        if samples == 0 {
            return;
        }
        keep(&mut self.id, &mut self.target.records, self.record);
        self.target.fragments.push(Fragment {
            at: at as u32,
            id: self.id,
            samples,
        });
    }
}
