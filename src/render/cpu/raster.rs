//! Which triangle is seen at each sample: edges in 1/256 pixels, depth as llvmpipe interpolates it.

use std::marker::PhantomData;

use wide::{f32x4, i32x4};

use super::plane::{Basis, Plane, Vertex};

/// Nothing is seen.
pub const NONE: u32 = u32::MAX;
/// Coordinates lie within this, 1/256 pixels.
pub const LIMIT: f32 = (1 << 21) as f32;

/// Places of the samples in a pixel are multiples of this, 1/256 pixels. Edge functions need no finer steps.
const GRAIN: i32 = 32;
/// See [`GRAIN`].
const GRAIN_BITS: u32 = GRAIN.trailing_zeros();
/// Side of the blocks in which large triangles are tested, pixels.
const BLOCK: i32 = 8;
/// Triangles up to this extent are tested sample by sample, 1/256 pixels.
const TINY: i32 = 1 << 8;
/// Triangles up to this extent are drawn without blocks, 1/256 pixels.
const SMALL: i32 = 12 << 8;

/// Where a pixel is sampled.
pub trait Sampling {
    /// From the lower left corner to the right and upward, in grains.
    const PLACES: [[i32; 4]; 2];
    /// The same in pixels, to the right.
    const X: [f32; 4];
    /// Upward.
    const Y: [f32; 4];
    /// Number of rows of samples in a pixel, which are equally far apart; each has one place, in the order of `PLACES`.
    const ROWS: usize;

    /// `dx y - dy x` at the places.
    fn steps(dx: i32, dy: i32) -> i32x4;
}

/// The four samples of a pixel of a picture in colours.
pub struct Four;
/// All samples in the middle, for pictures that are not colours.
pub struct Middle;

impl Sampling for Four {
    const PLACES: [[i32; 4]; 2] = [[3, 7, 1, 5], [1, 3, 5, 7]];
    const X: [f32; 4] = [0.375, 0.875, 0.125, 0.625];
    const Y: [f32; 4] = [0.125, 0.375, 0.625, 0.875];
    const ROWS: usize = 4;

    #[inline(always)]
    fn steps(dx: i32, dy: i32) -> i32x4 {
        // sums are cheaper than products of vectors
        let (dx2, dy2) = (dx + dx, dy + dy);
        let (dx3, dy3) = (dx + dx2, dy + dy2);
        let (dx5, dy5) = (dx3 + dx2, dy3 + dy2);
        i32x4::new([dx - dy3, dx3 - (dy5 + dy2), dx5 - dy, dx5 + dx2 - dy5])
    }
}

impl Sampling for Middle {
    const PLACES: [[i32; 4]; 2] = [[4; 4]; 2];
    const X: [f32; 4] = [0.5; 4];
    const Y: [f32; 4] = [0.5; 4];
    const ROWS: usize = 1;

    #[inline(always)]
    fn steps(dx: i32, dy: i32) -> i32x4 {
        i32x4::splat(4 * (dx - dy))
    }
}

/// A projected vertex, 1/256 pixels from the lower left.
pub type Fixed = [i32; 2];

/// A triangle that is seen somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// Index of what is drawn.
    pub draw: u32,
    /// Its vertices in the frame.
    pub vertices: [u32; 3],
    /// Index of how it is shaded, or [`NONE`].
    pub setup: u32,
}

/// Receives the samples that a triangle covers.
pub trait Sink {
    /// The samples of the pixel `at`, counted from the lower left, whose bits are in `inside`; the depths of all.
    fn pixel(&mut self, at: usize, inside: u32, z: f32x4);
}

/// The picture in work; row 0 is the lowest.
#[derive(Debug, Default)]
pub struct Target {
    pub width: usize,
    pub height: usize,
    /// Depth of each sample; 0 is farthest.
    pub depth: Vec<[f32; 4]>,
    /// Index of the record that is seen at each sample.
    pub ids: Vec<[u32; 4]>,
    pub records: Vec<Record>,
    /// What transparent triangles cover.
    pub fragments: Vec<Fragment>,
}

/// Samples of a pixel that a transparent triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    /// The pixel, counted from the lower left.
    pub at: u32,
    /// Index of the record.
    pub id: u32,
    /// A bit for each sample.
    pub samples: u32,
}

/// Collects what is not behind something.
struct Through<'a> {
    target: &'a mut Target,
    record: Record,
    id: u32,
}

/// Writes what is nearest.
struct Nearest<'a> {
    target: &'a mut Target,
    record: Record,
    id: u32,
}

/// An edge: positive to the left of it; zero belongs to one of the two triangles that share it.
#[derive(Clone, Copy, Default)]
struct Edge {
    dx: i32,
    dy: i32,
    /// Added to the function, so that zero counts or does not.
    bias: i64,
    from: Fixed,
}

/// An edge function around some pixel, in grains.
#[derive(Clone, Copy, Default)]
struct Local {
    samples: i32x4,
    right: i32x4,
    up: i32x4,
}

impl Edge {
    fn new(p: Fixed, q: Fixed) -> Self {
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let ours = dy < 0 || (dy == 0 && dx < 0);
        Self {
            dx,
            dy,
            bias: -i64::from(!ours),
            from: p,
        }
    }

    /// Those of a triangle.
    #[inline(always)]
    fn around(&[a, b, c]: &[Fixed; 3]) -> [Self; 3] {
        [Self::new(b, c), Self::new(c, a), Self::new(a, b)]
    }

    /// The value at the lower left corner of a pixel.
    fn at(&self, x: i32, y: i32) -> i64 {
        let up = i64::from(self.dx) * i64::from(y * 256 - self.from[1]);
        up - i64::from(self.dy) * i64::from(x * 256 - self.from[0]) + self.bias
    }

    /// The same for a pixel near the edge of a small triangle.
    #[inline(always)]
    fn near(&self, x: i32, y: i32) -> i64 {
        let up = self.dx.wrapping_mul(y * 256 - self.from[1]);
        i64::from(up.wrapping_sub(self.dy.wrapping_mul(x * 256 - self.from[0]))) + self.bias
    }

    /// Negative outside of the edge of a tiny triangle, at a place within its extent, 1/256 pixels.
    #[inline(always)]
    fn sign(&self, [x, y]: [i32; 2]) -> i32 {
        self.dx * (y - self.from[1]) - self.dy * (x - self.from[0]) + self.bias as i32
    }

    /// The function around a pixel where it is `at`. Dropping the low bits changes no sign, as all steps are whole grains.
    #[inline(always)]
    fn local<S: Sampling>(&self, at: i64) -> Local {
        let at = (at >> GRAIN_BITS) as i32;
        Local {
            samples: S::steps(self.dx, self.dy) + i32x4::splat(at),
            right: i32x4::splat(-self.dy * (256 / GRAIN)),
            up: i32x4::splat(self.dx * (256 / GRAIN)),
        }
    }
}

impl Target {
    pub fn clear(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.depth.clear();
        self.depth.resize(width * height, [0.0; 4]);
        self.ids.clear();
        self.ids.resize(width * height, [NONE; 4]);
        self.records.clear();
        self.fragments.clear();
    }

    /// Whether every sample in a range of pixels shows something nearer than the depth `z`.
    pub fn hides(&self, x: std::ops::Range<usize>, y: std::ops::Range<usize>, z: f32) -> bool {
        y.into_iter().all(|row| {
            let row = &self.depth[row * self.width..][x.clone()];
            row.iter()
                .all(|&d| f32x4::new(d).simd_gt(f32x4::splat(z)).to_bitmask() == 15)
        })
    }

    /// Draws a counterclockwise triangle, of which `record` tells which of the vertices are its own.
    #[inline(never)]
    pub fn triangle<S: Sampling>(&mut self, fixed: &[Fixed; 3], vertices: &[Vertex], record: Record) {
        let size = [self.width, self.height];
        let mut sink = Nearest {
            target: self,
            record,
            id: NONE,
        };
        let own = record.vertices;
        let depth = || Depth::new::<S>(own.map(|v| &vertices[v as usize]), size);
        scan::<S>(&mut sink, size, fixed, depth);
    }

    /// Collects the fragments of a transparent counterclockwise triangle.
    #[inline(never)]
    pub fn glass<S: Sampling>(&mut self, fixed: &[Fixed; 3], vertices: &[Vertex], record: Record) {
        let size = [self.width, self.height];
        let mut sink = Through {
            target: self,
            record,
            id: NONE,
        };
        let own = record.vertices;
        let depth = || Depth::new::<S>(own.map(|v| &vertices[v as usize]), size);
        scan::<S>(&mut sink, size, fixed, depth);
    }
}

impl Sink for Through<'_> {
    fn pixel(&mut self, at: usize, inside: u32, z: f32x4) {
        let samples = inside & z.simd_ge(f32x4::new(self.target.depth[at])).to_bitmask();
        if samples == 0 {
            return;
        }
        let records = &mut self.target.records;
        if self.id == NONE {
            self.id = records.len() as u32;
            records.push(self.record);
        }
        self.target.fragments.push(Fragment {
            at: at as u32,
            id: self.id,
            samples,
        });
    }
}

impl Sink for Nearest<'_> {
    #[inline(always)]
    fn pixel(&mut self, at: usize, inside: u32, z: f32x4) {
        let depth = &mut self.target.depth[at];
        let before = f32x4::new(*depth);
        let mut seen = inside & z.simd_ge(before).to_bitmask();
        if seen == 0 {
            return;
        }
        let ids = &mut self.target.ids[at];
        let records = &mut self.target.records;
        // of equally near things the one that comes later in the model is seen
        let tie = seen & z.simd_eq(before).to_bitmask();
        if tie != 0 {
            for k in 0..4 {
                let later = |id: u32| records.get(id as usize).is_some_and(|r| r.draw > self.record.draw);
                if tie & 1 << k != 0 && ids[k] != self.id && later(ids[k]) {
                    seen &= !(1 << k);
                }
            }
            if seen == 0 {
                return;
            }
        }
        if self.id == NONE {
            self.id = records.len() as u32;
            records.push(self.record);
        }
        let z = z.to_array();
        if seen == 15 {
            *depth = z;
            *ids = [self.id; 4];
            return;
        }
        for k in 0..4 {
            if seen & 1 << k != 0 {
                depth[k] = z[k];
                ids[k] = self.id;
            }
        }
    }
}

/// The depth over a triangle.
#[derive(Clone, Copy)]
struct Depth {
    plane: Plane,
    gentle: bool,
    /// Differences of the samples from the corner of a pixel.
    spread: f32x4,
}

impl Depth {
    #[inline(always)]
    fn new<S: Sampling>(vertices: [&Vertex; 3], size: [usize; 2]) -> Self {
        let [a, b, c] = vertices;
        let plane = Basis::new(vertices).plane([a.z, b.z, c.z]);
        Self {
            plane,
            gentle: plane.is_gentle(a.z, size),
            spread: plane.spread(S::X, S::Y),
        }
    }

    #[inline(always)]
    fn at<S: Sampling>(&self, x: i32, y: i32) -> f32x4 {
        let (x, y) = (x as f32, y as f32);
        let z = if self.gentle {
            f32x4::splat(self.plane.quick(x, y)) + self.spread
        } else {
            let (mut sx, mut sy) = (S::X, S::Y);
            for k in 0..4 {
                sx[k] += x;
                sy[k] += y;
            }
            f32x4::new(self.plane.at(sx, sy))
        };
        // what is not a number is farthest
        z.max(f32x4::ZERO).fast_min(f32x4::ONE)
    }
}

/// Whether a triangle is counterclockwise.
#[inline(always)]
pub fn faces([a, b, c]: &[Fixed; 3]) -> bool {
    let wide = i64::from;
    wide(b[0] - a[0]) * wide(c[1] - a[1]) > wide(b[1] - a[1]) * wide(c[0] - a[0])
}

/// The extent of a triangle, 1/256 pixels.
pub struct Extent {
    x: [i32; 2],
    y: [i32; 2],
}

impl Extent {
    #[inline(always)]
    pub fn new([a, b, c]: &[Fixed; 3]) -> Self {
        let range = |k: usize| [a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k])];
        Self {
            x: range(0),
            y: range(1),
        }
    }

    #[inline(always)]
    fn below(&self, limit: i32) -> bool {
        self.x[1] - self.x[0] < limit && self.y[1] - self.y[0] < limit
    }

    /// Whether it is tiny and lies between the samples.
    #[inline(always)]
    pub fn misses<S: Sampling>(&self) -> bool {
        let rows = Rows::<S>::within(self.y);
        self.below(TINY)
            && (rows.first..=rows.last).all(|row| {
                let place = Rows::<S>::place(row);
                self.x[1] < place + ((self.x[0] - place + 255) & !255)
            })
    }

    /// The pixels that the triangle may cover, the first and the last in each direction; none if there are none.
    #[inline(always)]
    fn pixels(&self, size: [usize; 2]) -> Option<[[i32; 2]; 2]> {
        // no sample is nearer to the edges of a pixel than a grain
        let range = |[least, greatest]: [i32; 2], size: usize| {
            let first = ((least + GRAIN - 1) >> 8).max(0);
            let last = ((greatest - GRAIN) >> 8).min(size as i32 - 1);
            [first, last]
        };
        let (x, y) = (range(self.x, size[0]), range(self.y, size[1]));
        (x[0] <= x[1] && y[0] <= y[1]).then_some([x, y])
    }
}

/// Passes the samples that a counterclockwise triangle covers to `sink`. Most small triangles lie between the samples and need
/// neither edges nor depth.
#[inline(always)]
fn scan<S: Sampling>(sink: &mut impl Sink, size: [usize; 2], fixed: &[Fixed; 3], depth: impl Fn() -> Depth) {
    let extent = Extent::new(fixed);
    if extent.below(TINY) {
        tiny::<S>(sink, size, fixed, &extent, depth);
        return;
    }
    let Some([x, y]) = extent.pixels(size) else {
        return;
    };
    let edges = Edge::around(fixed);
    if extent.below(SMALL) {
        let local = |e: &Edge| e.local::<S>(e.near(x[0], y[0]));
        let local = [local(&edges[0]), local(&edges[1]), local(&edges[2])];
        patch::<S>(sink, size[0], local, (x, y), depth);
    } else {
        blocks::<S>(sink, size[0], &edges, (x, y), &depth());
    }
}

/// Goes through the samples within the extent of a triangle one by one.
#[inline(always)]
fn tiny<S: Sampling>(
    sink: &mut impl Sink,
    size: [usize; 2],
    fixed: &[Fixed; 3],
    extent: &Extent,
    new_depth: impl Fn() -> Depth,
) {
    let rows = Rows::<S>::within(extent.y);
    let (mut edges, mut depth) = (None, None);
    for row in rows.first.max(0)..=rows.last.min((size[1] * S::ROWS) as i32 - 1) {
        let place = Rows::<S>::place(row);
        let from = ((extent.x[0] - place + 255) >> 8).max(0);
        let to = ((extent.x[1] - place) >> 8).min(size[0] as i32 - 1);
        for px in from..=to {
            let edges = edges.get_or_insert_with(|| Edge::around(fixed));
            let at = [px * 256 + place, Rows::<S>::height(row)];
            if edges.iter().any(|e| e.sign(at) < 0) {
                continue;
            }
            let depth = depth.get_or_insert_with(&new_depth);
            let py = row / S::ROWS as i32;
            sink.pixel(
                py as usize * size[0] + px as usize,
                Rows::<S>::samples(row),
                depth.at::<S>(px, py),
            );
        }
    }
}

/// Rows of samples, counted from the lower edge of the picture.
struct Rows<S> {
    first: i32,
    last: i32,
    sampling: PhantomData<S>,
}

impl<S: Sampling> Rows<S> {
    const SPACING: i32 = 256 / S::ROWS as i32;

    /// Those in a range, 1/256 pixels.
    #[inline(always)]
    fn within([low, high]: [i32; 2]) -> Self {
        let below = |y: i32| y.div_euclid(Self::SPACING);
        Self {
            first: below(low + (Self::SPACING / 2 - 1)),
            last: below(high - Self::SPACING / 2),
            sampling: PhantomData,
        }
    }

    /// Where a row lies.
    #[inline(always)]
    fn height(row: i32) -> i32 {
        row * Self::SPACING + Self::SPACING / 2
    }

    /// Its index in a pixel.
    #[inline(always)]
    fn index(row: i32) -> usize {
        row as usize % S::ROWS
    }

    /// Where its samples lie in pixels, to the right.
    #[inline(always)]
    fn place(row: i32) -> i32 {
        S::PLACES[0][Self::index(row)] * GRAIN
    }

    /// A bit for each of its samples in a pixel.
    #[inline(always)]
    fn samples(row: i32) -> u32 {
        15 >> (4 - 4 / S::ROWS) << Self::index(row)
    }
}

/// Goes through a large triangle in blocks.
#[inline(never)]
fn blocks<S: Sampling>(
    sink: &mut impl Sink,
    width: usize,
    edges: &[Edge; 3],
    (x, y): ([i32; 2], [i32; 2]),
    depth: &Depth,
) {
    let wide = i64::from;
    let reach = i64::from(BLOCK * 256);
    for by in (y[0] / BLOCK * BLOCK..=y[1]).step_by(BLOCK as usize) {
        let y = [by.max(y[0]), (by + BLOCK - 1).min(y[1])];
        for bx in (x[0] / BLOCK * BLOCK..=x[1]).step_by(BLOCK as usize) {
            let x = [bx.max(x[0]), (bx + BLOCK - 1).min(x[1])];
            let mut local = [Local::default(); 3];
            let (mut outside, mut whole) = (false, true);
            for (l, e) in local.iter_mut().zip(edges) {
                let corner = e.at(bx, by);
                let (up, right) = (wide(e.dx) * reach, -wide(e.dy) * reach);
                outside |= corner + up.max(0) + right.max(0) < 0;
                // an edge that the whole block lies within needs no test
                if corner + up.min(0) + right.min(0) < 0 {
                    whole = false;
                    *l = e.local::<S>(e.at(x[0], y[0]));
                }
            }
            if outside {
                continue;
            }
            if whole {
                for py in y[0]..=y[1] {
                    for px in x[0]..=x[1] {
                        sink.pixel(py as usize * width + px as usize, 15, depth.at::<S>(px, py));
                    }
                }
            } else {
                patch::<S>(sink, width, local, (x, y), || *depth);
            }
        }
    }
}

/// Tests the samples of some pixels.
#[inline(always)]
fn patch<S: Sampling>(
    sink: &mut impl Sink,
    width: usize,
    mut local: [Local; 3],
    (x, y): ([i32; 2], [i32; 2]),
    new_depth: impl Fn() -> Depth,
) {
    let mut depth = None;
    for py in y[0]..=y[1] {
        let row = py as usize * width;
        let [mut a, mut b, mut c] = [local[0].samples, local[1].samples, local[2].samples];
        for px in x[0]..=x[1] {
            let inside = !(a | b | c).to_bitmask() & 15;
            if inside != 0 {
                let depth = depth.get_or_insert_with(&new_depth);
                sink.pixel(row + px as usize, inside, depth.at::<S>(px, py));
            }
            a += local[0].right;
            b += local[1].right;
            c += local[2].right;
        }
        for l in &mut local {
            l.samples += l.up;
        }
    }
}
