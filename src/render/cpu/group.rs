//! Triangle setup, four at a time: edge functions, depth functions, and the samples that small triangles cover.

use wide::{f32x4, i32x4};

use super::lanes::{four, integers, three};
use super::plane::{Plane, Vertex};
use super::raster::{DepthFunction, Edges, MEDIUM, to_fixed_point};
use super::sampling::{GRAIN, Sampling};
use super::small::{CoveredSamples, PIXEL};

/// Number of triangles that are set up at a time.
pub const GROUP: usize = 4;

/// Triangles waiting to be set up together.
#[derive(Debug, Default)]
pub struct TriangleGroup {
    /// The projected corners of each triangle.
    corners: [[Vertex; GROUP]; 3],
    /// Vertices in the frame.
    vertices: [[usize; 3]; GROUP],
    count: usize,
}

/// The way in which a triangle is drawn.
pub enum DrawMethod {
    /// It is smaller than a pixel.
    Spots(CoveredSamples, DepthFunction),
    /// It fits into a few pixels: its edges, and the first and the last pixel in each direction.
    Medium(Edges, [[i32; 2]; 2], DepthFunction),
    /// It is larger, and still to be set up.
    Large,
}

impl TriangleGroup {
    /// Adds a triangle; returns whether the group is complete.
    #[inline(always)]
    pub fn add(&mut self, own: [usize; 3], vertices: &[Vertex]) -> bool {
        let at = self.count % GROUP;
        for (k, &vertex) in own.iter().enumerate() {
            self.corners[k][at] = vertices[vertex];
        }
        self.vertices[at] = own;
        self.count = at + 1;
        self.count == GROUP
    }

    /// Removes all triangles.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Passes on the triangles in their order, except for those that certainly cover no sample of an image of this size.
    #[inline(always)]
    pub fn each<S: Sampling>(&self, size: [usize; 2], mut each: impl FnMut([usize; 3], DrawMethod)) {
        if self.count == 0 {
            return;
        }
        let corners = three(|k| {
            f32x4::transpose(four(|i| {
                let Vertex { x, y, z, iw } = self.corners[k][i];
                f32x4::new([x, y, z, iw])
            }))
        });
        // rounded once more, which costs less than collecting the rounded values
        let (x, y) = (
            three(|k| to_fixed_point(corners[k][0])),
            three(|k| to_fixed_point(corners[k][1])),
        );
        let extent = [Extent::new(&x), Extent::new(&y)];
        let within = |limit: i32| {
            let limit = f32x4::splat(limit as f32);
            (extent[0].reach.simd_lt(limit) & extent[1].reach.simd_lt(limit)).to_bitmask()
        };
        let (small, medium) = (within(PIXEL), within(MEDIUM));
        // From the corner of the extent, coordinates of small and medium triangles are below 2^11, their products below
        // 2^22 and sums of two below 2^23: exact in single precision, hence the same as in integers.
        let edges = LaneEdges::new(three(|k| x[k] - extent[0].low), three(|k| y[k] - extent[1].low));
        let low = [integers(extent[0].low), integers(extent[1].low)];
        let covered = if small == 0 { [0; 4] } else { edges.covered::<S>(low) };
        // here the products are exact, so back faces are known, and triangles without area too
        let turned = edges.counterclockwise();
        let pixels = [extent[0].pixels(), extent[1].pixels()];
        let lanes = edges.at_pixels(&extent);
        let depth = LaneDepth::new(&corners, size);
        let corner = [low[0].to_array(), low[1].to_array()];
        for at in 0..self.count {
            let own = self.vertices[at];
            if small >> at & 1 == 1 {
                let bit = |k: usize| (covered[k] >> at & 1) << k;
                let spots = CoveredSamples {
                    corner: [corner[0][at], corner[1][at]],
                    samples: bit(0) | bit(1) | bit(2) | bit(3),
                };
                if spots.samples != 0 {
                    each(own, DrawMethod::Spots(spots, depth.of::<S>(at)));
                }
            } else if medium >> at & 1 == 0 {
                each(own, DrawMethod::Large);
            } else if turned >> at & 1 == 1 {
                let range = |k: usize| {
                    let [first, last] = pixels[k];
                    [first[at], last[at].min(size[k] as i32 - 1)]
                };
                let (x, y) = (range(0), range(1));
                if x[0] <= x[1] && y[0] <= y[1] {
                    let edges = Edges::new::<S>(three(|k| three(|i| lanes[k][i][at])));
                    each(own, DrawMethod::Medium(edges, [x, y], depth.of::<S>(at)));
                }
            }
        }
    }
}

/// The extents of four triangles in one direction, 1/256 pixels.
struct Extent {
    low: f32x4,
    /// Their extents from there.
    reach: f32x4,
    /// The edge of the first pixel that they may cover, which is in the image.
    pixel: i32x4,
}

impl Extent {
    #[inline(always)]
    fn new([a, b, c]: &[f32x4; 3]) -> Self {
        let low = a.fast_min(*b).fast_min(*c);
        // no sample is nearer to the edges of a pixel than a grain
        let first = (integers(low) + i32x4::splat(GRAIN - 1)) >> 8_u32;
        let first = first & !(first >> 31_u32);
        Self {
            low,
            reach: a.fast_max(*b).fast_max(*c) - low,
            pixel: first << 8_u32,
        }
    }

    /// Returns the first and the last pixels that the triangles may cover; the last may lie beyond the image.
    #[inline(always)]
    fn pixels(&self) -> [[i32; 4]; 2] {
        let high = integers(self.low + self.reach);
        let last = (high - i32x4::splat(GRAIN)) >> 8_u32;
        [(self.pixel >> 8_u32).to_array(), last.to_array()]
    }
}

/// The edge functions of four triangles, exact if they are not large; positive inside.
struct LaneEdges {
    dx: [f32x4; 3],
    dy: [f32x4; 3],
    /// Values at the lower left of the triangles' extents.
    at: [f32x4; 3],
}

impl LaneEdges {
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
            // the fill rule: zero belongs to one of the two triangles that share an edge, or their seam would be drawn
            // twice or not at all
            let ours = dy.simd_lt(f32x4::ZERO) | (dy.simd_eq(f32x4::ZERO) & dx.simd_lt(f32x4::ZERO));
            edges.at[k] = dy * x[p] - dx * y[p] + ours.select(f32x4::ZERO, -f32x4::ONE);
            (edges.dx[k], edges.dy[k]) = (dx, dy);
        }
        edges
    }

    /// Returns a bit for each triangle that is counterclockwise.
    #[inline(always)]
    fn counterclockwise(&self) -> u32 {
        let (dx, dy) = (&self.dx, &self.dy);
        (dx[0] * dy[1]).simd_gt(dy[0] * dx[1]).to_bitmask()
    }

    /// Returns, for each kind of sample, a bit for each small triangle that covers a sample of that kind; `low` is the lower left of their extents.
    #[inline(always)]
    fn covered<S: Sampling>(&self, low: [i32x4; 2]) -> [u32; 4] {
        let along = |k: usize, place: i32| -> f32x4 {
            // samples of one kind repeat every pixel: the first one at or after the corner is the only one that a small
            // triangle can reach
            f32x4::from_i32x4((i32x4::splat(place) - low[k]) & i32x4::splat(PIXEL - 1))
        };
        four(|k| {
            let (x, y) = (along(0, S::PLACES[0][k]), along(1, S::PLACES[1][k]));
            let edge = |k: usize| self.dx[k] * y - self.dy[k] * x + self.at[k];
            edge(0)
                .fast_min(edge(1))
                .fast_min(edge(2))
                .simd_ge(f32x4::ZERO)
                .to_bitmask()
        })
    }

    /// Returns for each edge the changes to the right (negated) and upward, and the value at the corner of the first pixel.
    #[inline(always)]
    fn at_pixels(&self, [x, y]: &[Extent; 2]) -> [[[f32; 4]; 3]; 3] {
        let (right, up) = (f32x4::from_i32x4(x.pixel) - x.low, f32x4::from_i32x4(y.pixel) - y.low);
        three(|k| {
            let at = self.dx[k] * up - self.dy[k] * right + self.at[k];
            [self.dx[k].to_array(), self.dy[k].to_array(), at.to_array()]
        })
    }
}

/// The depth functions of four triangles.
struct LaneDepth {
    at: [f32; 4],
    dx: [f32; 4],
    dy: [f32; 4],
    gentle: u32,
}

impl LaneDepth {
    #[inline(always)]
    fn new(corners: &[[f32x4; 4]; 3], size: [usize; 2]) -> Self {
        // the order in which Mesa sets triangles up
        let [[bx, by, bz, _], [ax, ay, az, _], [cx, cy, cz, _]] = *corners;
        let (dx01, dy01) = (ax - bx, ay - by);
        let (dx20, dy20) = (cx - ax, cy - ay);
        let scale = f32x4::ONE / (dx01 * dy20 - dy01 * dx20);
        let (d01, d20) = (az - bz, cz - az);
        let dx = d01 * (dy20 * scale) - d20 * (dy01 * scale);
        let dy = d20 * (dx01 * scale) - d01 * (dx20 * scale);
        let at = az - (dx * ax + dy * ay);
        Self {
            gentle: Plane::are_gentle([at, dx, dy], az, size),
            at: at.to_array(),
            dx: dx.to_array(),
            dy: dy.to_array(),
        }
    }

    #[inline(always)]
    fn of<S: Sampling>(&self, k: usize) -> DepthFunction {
        let plane = Plane {
            at: self.at[k],
            dx: self.dx[k],
            dy: self.dy[k],
        };
        DepthFunction::of::<S>(plane, self.gentle >> k & 1 == 1)
    }
}
