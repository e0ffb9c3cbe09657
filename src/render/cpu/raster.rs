//! Rasterisation: which triangle each sample shows. Edges are in 1/256 pixels; depth is interpolated as in llvmpipe.

use wide::{f32x4, i32x4};

use super::plane::{Basis, Plane, Vertex};
use super::sampling::{GRAIN, GRAIN_BITS, Rows, Sampling};

/// Bound on coordinates, 1/256 pixels.
pub const LIMIT: f32 = (1 << 21) as f32;

/// Side of the blocks in which large triangles are tested, pixels.
const BLOCK: i32 = 8;
/// Triangles up to this extent are tested sample by sample, 1/256 pixels.
const TINY: i32 = 1 << 8;
/// Triangles up to this extent are drawn without blocks, 1/256 pixels.
const SMALL: i32 = 12 << 8;

/// A projected vertex, 1/256 pixels from the lower left.
pub type Fixed = [i32; 2];

/// A receiver of the samples that a triangle covers.
pub trait Sink {
    /// Takes the samples of one pixel: `at` counts pixels from the lower left, `inside` has a bit for each covered
    /// sample, `z` holds the depths of all four.
    fn pixel(&mut self, at: usize, inside: u32, z: f32x4);
}

/// An edge function: positive to the left of the edge; zero belongs to one of the two triangles that share it.
#[derive(Clone, Copy, Default)]
struct Edge {
    dx: i32,
    dy: i32,
    /// Added to the function, so that zero counts as inside or outside.
    bias: i64,
    from: Fixed,
}

/// An edge function around a pixel, in units of [`GRAIN`].
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

    /// Returns the three edges of a triangle.
    #[inline(always)]
    fn around(&[a, b, c]: &[Fixed; 3]) -> [Self; 3] {
        [Self::new(b, c), Self::new(c, a), Self::new(a, b)]
    }

    /// Evaluates the edge function at the lower left corner of a pixel.
    fn at(&self, x: i32, y: i32) -> i64 {
        let up = i64::from(self.dx) * i64::from(y * 256 - self.from[1]);
        up - i64::from(self.dy) * i64::from(x * 256 - self.from[0]) + self.bias
    }

    /// Evaluates the edge function at the lower left corner of a pixel near a small triangle, in 32 bits.
    #[inline(always)]
    fn near(&self, x: i32, y: i32) -> i64 {
        let up = self.dx.wrapping_mul(y * 256 - self.from[1]);
        i64::from(up.wrapping_sub(self.dy.wrapping_mul(x * 256 - self.from[0]))) + self.bias
    }

    /// Returns a negative number at points outside the edge of a tiny triangle; the point, in 1/256 pixels, lies within
    /// the triangle's extent.
    #[inline(always)]
    fn sign(&self, [x, y]: [i32; 2]) -> i32 {
        self.dx * (y - self.from[1]) - self.dy * (x - self.from[0]) + self.bias as i32
    }

    /// Returns the edge function around a pixel at whose corner its value is `at`. Dropping the low bits changes no
    /// sign, as all steps are whole grains.
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

/// The depth function of a triangle.
#[derive(Clone, Copy)]
pub struct Depth {
    plane: Plane,
    gentle: bool,
    /// Differences between the samples and the corner of a pixel.
    spread: f32x4,
}

impl Depth {
    #[inline(always)]
    pub fn new<S: Sampling>(vertices: [&Vertex; 3], size: [usize; 2]) -> Self {
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
        // NaN counts as farthest
        z.max(f32x4::ZERO).fast_min(f32x4::ONE)
    }
}

/// Returns whether a triangle is counterclockwise.
#[inline(always)]
pub fn is_counterclockwise([a, b, c]: &[Fixed; 3]) -> bool {
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

    /// Returns whether the triangle is tiny and lies between the samples.
    #[inline(always)]
    pub fn misses<S: Sampling>(&self) -> bool {
        let rows = Rows::<S>::within(self.y);
        self.below(TINY)
            && (rows.first..=rows.last).all(|row| {
                let place = Rows::<S>::place(row);
                self.x[1] < place + ((self.x[0] - place + 255) & !255)
            })
    }

    /// Returns the first and the last pixel in each direction that the triangle may cover; `None` if it covers none.
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
pub fn scan<S: Sampling>(sink: &mut impl Sink, size: [usize; 2], fixed: &[Fixed; 3], depth: impl Fn() -> Depth) {
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
