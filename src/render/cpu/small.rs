//! Small triangles, four at a time: which samples each covers, without setting its edges up one by one.

use wide::{f32x4, i32x4};

use super::lanes::{four, three};
use super::sampling::Sampling;

/// Number of triangles that are tested at a time.
pub const GROUP: usize = 4;
/// Triangles below this extent are small, 1/256 pixels: of each kind of sample, at most one lies within.
const PIXEL: i32 = 256;

/// Triangles that wait to be tested together.
#[derive(Debug, Default)]
pub struct Waiting {
    x: [[f32; GROUP]; 3],
    y: [[f32; GROUP]; 3],
    /// Vertices in the frame.
    vertices: [[usize; 3]; GROUP],
    count: usize,
}

/// The samples that a small triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct Spots {
    /// The lower left of the triangle's extent, 1/256 pixels.
    corner: [i32; 2],
    /// One bit for each kind of sample.
    pub samples: u32,
}

impl Spots {
    /// Returns the pixel in which a sample lies.
    #[inline(always)]
    pub fn pixel<S: Sampling>(&self, sample: usize) -> [i32; 2] {
        let along = |k: usize| {
            let from = self.corner[k];
            (from + ((S::PLACES[k][sample] - from) & (PIXEL - 1))) >> 8
        };
        [along(0), along(1)]
    }
}

impl Waiting {
    /// Adds a triangle by its corners, whole numbers of 1/256 pixels; returns whether the group is complete.
    #[inline(always)]
    pub fn add(&mut self, vertices: [usize; 3], x: &[f32], y: &[f32]) -> bool {
        let at = self.count % GROUP;
        for (k, &vertex) in vertices.iter().enumerate() {
            self.x[k][at] = x[vertex];
            self.y[k][at] = y[vertex];
        }
        self.vertices[at] = vertices;
        self.count = at + 1;
        self.count == GROUP
    }

    /// Removes all triangles.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Passes on the triangles in the order in which they came, each with the samples that it covers; `None` if it is not
    /// small.
    #[inline(always)]
    pub fn each<S: Sampling>(&self, mut each: impl FnMut([usize; 3], Option<Spots>)) {
        if self.count == 0 {
            return;
        }
        let (x, y) = (three(|k| f32x4::new(self.x[k])), three(|k| f32x4::new(self.y[k])));
        let (left, width) = extent(&x);
        let (lower, height) = extent(&y);
        let limit = f32x4::splat(PIXEL as f32);
        let small = (width.simd_lt(limit) & height.simd_lt(limit)).to_bitmask();
        let edges = Edges::new(three(|k| x[k] - left), three(|k| y[k] - lower));
        let (left, lower) = (left.fast_trunc_int(), lower.fast_trunc_int());
        let along = |from: i32x4, place: i32| -> f32x4 {
            f32x4::from_i32x4((i32x4::splat(place) - from) & i32x4::splat(PIXEL - 1))
        };
        let covers = four(|k| edges.cover(along(left, S::PLACES[0][k]), along(lower, S::PLACES[1][k])));
        let (left, lower) = (left.to_array(), lower.to_array());
        for at in 0..self.count {
            let bit = |k: usize| (covers[k] >> at & 1) << k;
            let spots = Spots {
                corner: [left[at], lower[at]],
                samples: bit(0) | bit(1) | bit(2) | bit(3),
            };
            each(self.vertices[at], (small >> at & 1 == 1).then_some(spots));
        }
    }
}

/// Returns the least coordinate of triangles, and how far they reach from it.
#[inline(always)]
fn extent([a, b, c]: &[f32x4; 3]) -> (f32x4, f32x4) {
    let low = a.fast_min(*b).fast_min(*c);
    (low, a.fast_max(*b).fast_max(*c) - low)
}

/// The edge functions of four triangles, exact if they are small; the same as those of the rasteriser.
struct Edges {
    dx: [f32x4; 3],
    dy: [f32x4; 3],
    at: [f32x4; 3],
}

impl Edges {
    #[inline(always)]
    fn new(x: [f32x4; 3], y: [f32x4; 3]) -> Self {
        let mut edges = Self {
            dx: [f32x4::ZERO; 3],
            dy: [f32x4::ZERO; 3],
            at: [f32x4::ZERO; 3],
        };
        for k in 0..3 {
            let (p, q) = ((k + 1) % 3, (k + 2) % 3);
            let (dx, dy) = (x[q] - x[p], y[q] - y[p]);
            // zero belongs to one of the two triangles that share an edge
            let ours = dy.simd_lt(f32x4::ZERO) | (dy.simd_eq(f32x4::ZERO) & dx.simd_lt(f32x4::ZERO));
            edges.at[k] = dy * x[p] - dx * y[p] + ours.select(f32x4::ZERO, -f32x4::ONE);
            (edges.dx[k], edges.dy[k]) = (dx, dy);
        }
        edges
    }

    /// Returns a bit for each triangle that covers a point of its own.
    #[inline(always)]
    fn cover(&self, x: f32x4, y: f32x4) -> u32 {
        let edge = |k: usize| self.dx[k] * y - self.dy[k] * x + self.at[k];
        edge(0)
            .fast_min(edge(1))
            .fast_min(edge(2))
            .simd_ge(f32x4::ZERO)
            .to_bitmask()
    }
}

/// Four quadrilaterals, each of two triangles, by their corners a, b, c, d: [a, b, d] and [b, c, d]. Corners are x and y,
/// whole numbers of 1/256 pixels.
pub struct Quads(pub [[f32x4; 2]; 4]);

impl Quads {
    /// Returns one bit for each quadrilateral, for its first and its second triangle; the others certainly show their back.
    #[inline(always)]
    pub fn front(&self) -> [u32; 2] {
        let [a, b, c, d] = &self.0;
        // rounding may make products equal, but does not change their order
        let front = |p: &[f32x4; 2], q: &[f32x4; 2], r: &[f32x4; 2]| {
            let (left, right) = ((q[0] - p[0]) * (r[1] - p[1]), (q[1] - p[1]) * (r[0] - p[0]));
            left.simd_ge(right).to_bitmask()
        };
        [front(a, b, d), front(b, c, d)]
    }

    /// Returns one bit for each quadrilateral that may cover a sample; the others certainly lie between the samples.
    #[inline(always)]
    pub fn hit<S: Sampling>(&self) -> u32 {
        let [a, b, c, d] = &self.0;
        let range = |k: usize| {
            let low = a[k].fast_min(b[k]).fast_min(c[k].fast_min(d[k]));
            let high = a[k].fast_max(b[k]).fast_max(c[k].fast_max(d[k]));
            (low.fast_trunc_int(), (high - low).fast_trunc_int())
        };
        let (x, y) = (range(0), range(1));
        let beyond = |(low, reach): (i32x4, i32x4), place: i32| -> i32x4 {
            ((i32x4::splat(place) - low) & i32x4::splat(PIXEL - 1)).simd_gt(reach)
        };
        let mut missed = !i32x4::ZERO;
        for k in 0..4 {
            missed &= beyond(x, S::PLACES[0][k]) | beyond(y, S::PLACES[1][k]);
        }
        15 & !missed.to_bitmask()
    }
}
