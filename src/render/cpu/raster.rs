//! Rasterisation with edge functions (Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988): which
//! triangle each sample shows. Edges are in 1/256 pixels; depth is interpolated as in llvmpipe.

use wide::bytemuck::cast;
use wide::{f32x4, i32x4};

use super::lanes::{at_least, three};
use super::plane::{Basis, Plane, Vertex};
use super::sampling::{GRAIN, GRAIN_BITS, Sampling};

/// Bound on coordinates, 1/256 pixels.
pub const LIMIT: f32 = (1 << 21) as f32;

/// Side of the blocks in which large triangles are tested, pixels.
const BLOCK: i32 = 8;
/// Triangles below this extent are drawn without blocks, 1/256 pixels: single precision holds their edge functions
/// without rounding.
pub const MEDIUM: i32 = 8 << 8;

/// A projected vertex, 1/256 pixels from the lower left.
pub type FixedVertex = [i32; 2];

/// Converts to 1/256 pixels, rounded to the nearest, halves to even. Beyond [`LIMIT`] the result is at the limit.
#[inline(always)]
pub fn to_fixed_point(pixels: f32x4) -> f32x4 {
    // adding 1.5 * 2^23 rounds to the nearest integer
    const SHIFT: f32 = 12_582_912.0;
    // NaN becomes a limit, too
    let v = at_least(pixels * 256.0, f32x4::splat(-LIMIT)).fast_min(f32x4::splat(LIMIT));
    (v + SHIFT) - SHIFT
}

/// A receiver of the samples that a triangle covers.
pub trait Sink {
    /// Takes the samples of one pixel: `at` counts pixels from the lower left, `inside` is a mask of the covered samples,
    /// `z` holds the depths of all four.
    fn pixel(&mut self, at: usize, inside: f32x4, z: f32x4);
}

/// An edge function: positive to the left of the edge; zero belongs to one of the two triangles that share it.
#[derive(Clone, Copy, Default)]
struct Edge {
    dx: i32,
    dy: i32,
    /// Offset of the function, which makes zero count as inside or outside.
    bias: i64,
    from: FixedVertex,
}

/// An edge function around a pixel, in units of [`GRAIN`].
#[derive(Clone, Copy, Default)]
struct PixelEdge {
    samples: i32x4,
    right: i32x4,
    up: i32x4,
}

impl Edge {
    fn new(p: FixedVertex, q: FixedVertex) -> Self {
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        // the fill rule: a sample on an edge belongs to the triangle on one side of it, so that neighbours neither
        // overlap nor leave a seam
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
    fn around(&[a, b, c]: &[FixedVertex; 3]) -> [Self; 3] {
        [Self::new(b, c), Self::new(c, a), Self::new(a, b)]
    }

    /// Evaluates the edge function at the lower left corner of a pixel.
    fn at(&self, x: i32, y: i32) -> i64 {
        // products of two numbers of 22 bits
        let up = i64::from(self.dx) * i64::from(y * 256 - self.from[1]);
        up - i64::from(self.dy) * i64::from(x * 256 - self.from[0]) + self.bias
    }

    /// Returns the edge function around a pixel at whose corner its value is `at`. Dropping the low bits changes no sign, because all steps are whole
    /// grains.
    #[inline(always)]
    fn local<S: Sampling>(&self, at: i64) -> PixelEdge {
        // 32 bits hold the values around a block once the grain is taken out: eight pixels of edges that are at most
        // 2^22 long
        let at = (at >> GRAIN_BITS) as i32;
        PixelEdge {
            samples: S::steps(self.dx, self.dy) + i32x4::splat(at),
            right: i32x4::splat(-self.dy * (256 / GRAIN)),
            up: i32x4::splat(self.dx * (256 / GRAIN)),
        }
    }
}

/// The depth function of a triangle.
#[derive(Clone, Copy)]
pub struct DepthFunction {
    plane: Plane,
    gentle: bool,
    /// Differences between the samples and the corner of a pixel.
    spread: f32x4,
}

impl DepthFunction {
    #[inline(always)]
    pub fn new<S: Sampling>(vertices: [&Vertex; 3], size: [usize; 2]) -> Self {
        let [a, b, c] = vertices;
        let plane = Basis::new(vertices).plane([a.z, b.z, c.z]);
        Self::of::<S>(plane, plane.is_gentle(a.z, size))
    }

    /// Creates the depth function from its plane, and whether rounding errors are small.
    #[inline(always)]
    pub fn of<S: Sampling>(plane: Plane, gentle: bool) -> Self {
        Self {
            plane,
            gentle,
            spread: plane.spread(S::X, S::Y),
        }
    }

    /// Returns the depth at the samples of a pixel.
    #[inline(always)]
    pub fn at<S: Sampling>(&self, x: i32, y: i32) -> f32x4 {
        let (x, y) = (x as f32, y as f32);
        // the sum of two parts would round steep planes unlike llvmpipe, which evaluates at each sample's own
        // place
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
        at_least(z, f32x4::ZERO).fast_min(f32x4::ONE)
    }
}

/// Returns whether a triangle is counterclockwise.
#[inline(always)]
pub fn is_counterclockwise([a, b, c]: &[FixedVertex; 3]) -> bool {
    // coordinates are up to 2^22 apart, so products need 64 bits
    let wide = i64::from;
    wide(b[0] - a[0]) * wide(c[1] - a[1]) > wide(b[1] - a[1]) * wide(c[0] - a[0])
}

/// Returns the first and the last pixel in each direction that a triangle may cover; `None` if it covers none.
fn pixels([a, b, c]: &[FixedVertex; 3], size: [usize; 2]) -> Option<[[i32; 2]; 2]> {
    // no sample is nearer to the edges of a pixel than a grain
    let range = |k: usize| {
        let (least, greatest) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
        let first = ((least + GRAIN - 1) >> 8).max(0);
        let last = ((greatest - GRAIN) >> 8).min(size[k] as i32 - 1);
        [first, last]
    };
    let (x, y) = (range(0), range(1));
    (x[0] <= x[1] && y[0] <= y[1]).then_some([x, y])
}

/// The edge functions of a triangle of medium size at the samples of a pixel, and their changes to the next pixels.
pub struct Edges {
    samples: [f32x4; 3],
    right: [f32x4; 3],
    up: [f32x4; 3],
}

impl Edges {
    /// Sets the edges up from their differences in x and y, 1/256 pixels, and their values at the corner of a pixel.
    #[inline(always)]
    pub fn new<S: Sampling>(edges: [[f32; 3]; 3]) -> Self {
        let (across, upward) = (f32x4::new(S::X) * 256.0, f32x4::new(S::Y) * 256.0);
        Self {
            samples: three(|k| upward * edges[k][0] - across * edges[k][1] + edges[k][2]),
            right: three(|k| f32x4::splat(-256.0 * edges[k][1])),
            up: three(|k| f32x4::splat(256.0 * edges[k][0])),
        }
    }
}

/// Passes the samples that a large counterclockwise triangle covers to `sink`.
#[inline(always)]
pub fn large<S: Sampling>(
    sink: &mut impl Sink,
    size: [usize; 2],
    fixed: &[FixedVertex; 3],
    depth: impl Fn() -> DepthFunction,
) {
    if let Some(range) = pixels(fixed, size) {
        blocks::<S>(sink, size[0], &Edge::around(fixed), range, &depth());
    }
}

/// Passes the samples that a triangle of medium size covers to `sink`; its edges are given at the first pixel.
#[inline(always)]
pub fn medium<S: Sampling>(
    sink: &mut impl Sink,
    width: usize,
    edges: &Edges,
    [x, y]: [[i32; 2]; 2],
    depth: &DepthFunction,
) {
    // sums stay exact in single precision, as the whole triangle is within a few pixels
    let mut samples = edges.samples;
    let (right, up) = (&edges.right, &edges.up);
    let mut py = y[0];
    while py <= y[1] {
        let [mut a, mut b, mut c] = samples;
        let mut px = x[0];
        while px <= x[1] {
            let inside = a.fast_min(b).fast_min(c).simd_ge(f32x4::ZERO);
            if inside.to_bitmask() != 0 {
                let at = py as usize * width + px as usize;
                sink.pixel(at, inside, depth.at::<S>(px, py));
            }
            a += right[0];
            b += right[1];
            c += right[2];
            px += 1;
        }
        for k in 0..3 {
            samples[k] += up[k];
        }
        py += 1;
    }
}

/// Traverses a large triangle in blocks.
#[inline(never)]
fn blocks<S: Sampling>(
    sink: &mut impl Sink,
    width: usize,
    edges: &[Edge; 3],
    [x, y]: [[i32; 2]; 2],
    depth: &DepthFunction,
) {
    let wide = i64::from;
    let reach = i64::from(BLOCK * 256);
    for by in (y[0] / BLOCK * BLOCK..=y[1]).step_by(BLOCK as usize) {
        let y = [by.max(y[0]), (by + BLOCK - 1).min(y[1])];
        for bx in (x[0] / BLOCK * BLOCK..=x[1]).step_by(BLOCK as usize) {
            let x = [bx.max(x[0]), (bx + BLOCK - 1).min(x[1])];
            let mut local = [PixelEdge::default(); 3];
            let (mut outside, mut whole) = (false, true);
            for (l, e) in local.iter_mut().zip(edges) {
                let corner = e.at(bx, by);
                let (up, right) = (wide(e.dx) * reach, -wide(e.dy) * reach);
                // an edge function is linear: over a block it is greatest at the corner where both changes help, and
                // least where none does
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
                let all = f32x4::ZERO.simd_eq(f32x4::ZERO);
                for py in y[0]..=y[1] {
                    for px in x[0]..=x[1] {
                        sink.pixel(py as usize * width + px as usize, all, depth.at::<S>(px, py));
                    }
                }
            } else {
                patch::<S>(sink, width, local, x, y, depth);
            }
        }
    }
}

/// Tests the samples of some pixels.
#[inline(always)]
fn patch<S: Sampling>(
    sink: &mut impl Sink,
    width: usize,
    mut local: [PixelEdge; 3],
    x: [i32; 2],
    y: [i32; 2],
    depth: &DepthFunction,
) {
    let mut py = y[0];
    while py <= y[1] {
        let row = py as usize * width;
        let [mut a, mut b, mut c] = [local[0].samples, local[1].samples, local[2].samples];
        let mut px = x[0];
        while px <= x[1] {
            // one sign bit for three: it is set if any of them is negative
            let inside = (a | b | c).simd_gt(-i32x4::ONE);
            if inside.to_bitmask() != 0 {
                sink.pixel(row + px as usize, cast(inside), depth.at::<S>(px, py));
            }
            a += local[0].right;
            b += local[1].right;
            c += local[2].right;
            px += 1;
        }
        for l in &mut local {
            l.samples += l.up;
        }
        py += 1;
    }
}
