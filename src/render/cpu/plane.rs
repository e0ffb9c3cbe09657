//! Linear functions over a triangle, set up and evaluated as in llvmpipe: from the lower left corner of the image.
//! For triangles seen edge-on they are steep, and the rounding errors are large but equal to those of the reference.

use wide::{f32x4, f64x4};

use super::camera::fused;

/// A plane is gentle if its magnitude over an image is within this multiple of a value: rounding errors are then
/// small.
const GENTLE: f32 = 8.0;

/// A projected vertex: pixels from the lower left, depth, 1/w.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vertex {
    pub x: f32,
    pub y: f32,
    pub z: f32,
    pub iw: f32,
}

/// A linear function: value at the corner of the image, change per pixel to the right and upward.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plane {
    pub at: f32,
    pub dx: f32,
    pub dy: f32,
}

/// Four linear functions: values at the corner of the image, changes per pixel to the right and upward.
#[derive(Clone, Copy, Debug, Default)]
pub struct Planes {
    at: f32x4,
    dx: f32x4,
    dy: f32x4,
    /// Whether rounding errors are small all over the image.
    gentle: bool,
}

/// The part of the set-up that all planes of a triangle share.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    x: f32,
    y: f32,
    dx01: f32,
    dy01: f32,
    dx20: f32,
    dy20: f32,
}

impl Basis {
    pub fn new([a, b, c]: [&Vertex; 3]) -> Self {
        let (dx01, dy01) = (a.x - b.x, a.y - b.y);
        let (dx20, dy20) = (c.x - a.x, c.y - a.y);
        // one division for all planes of a triangle, multiplied into the differences as Mesa does: other orders round
        // the colours of thin triangles to other bytes
        let scale = 1.0 / (dx01 * dy20 - dy01 * dx20);
        Self {
            x: a.x,
            y: a.y,
            dx01: dx01 * scale,
            dy01: dy01 * scale,
            dx20: dx20 * scale,
            dy20: dy20 * scale,
        }
    }

    /// Returns the plane through values at the corners.
    #[inline(always)]
    pub fn plane(&self, [a, b, c]: [f32; 3]) -> Plane {
        let (d01, d20) = (a - b, c - a);
        let dx = d01 * self.dy20 - d20 * self.dy01;
        let dy = d20 * self.dx01 - d01 * self.dx20;
        Plane {
            at: a - (dx * self.x + dy * self.y),
            dx,
            dy,
        }
    }
}

impl Planes {
    /// Makes planes through values at the corners. Where they vary little over an image of this size, compared with
    /// `magnitude`, they need not be rounded as llvmpipe does.
    #[inline(always)]
    pub fn new(basis: &Basis, [a, b, c]: [f32x4; 3], magnitude: f32, size: [usize; 2]) -> Self {
        let (d01, d20) = (a - b, c - a);
        let dx = d01 * f32x4::splat(basis.dy20) - d20 * f32x4::splat(basis.dy01);
        let dy = d20 * f32x4::splat(basis.dx01) - d01 * f32x4::splat(basis.dx20);
        let at = a - (dx * f32x4::splat(basis.x) + dy * f32x4::splat(basis.y));
        // where terms are much larger than their sum, its last bits are decided by rounding; only there llvmpipe's
        // order has to be followed
        let change = dx.abs() * f32x4::splat(size[0] as f32) + dy.abs() * f32x4::splat(size[1] as f32);
        let gentle = (at.abs() + change).simd_le(f32x4::splat(GENTLE * magnitude.abs()));
        Self {
            at,
            dx,
            dy,
            gentle: gentle.to_bitmask() == 15,
        }
    }

    /// Evaluates at the centres of a block of 2 x 2 pixels, whose first pixel is given: the lower two first.
    #[inline(always)]
    pub fn block(&self, x: f32, y: f32) -> [f32x4; 4] {
        if self.gentle {
            // additions give the other pixels, where the rounding of llvmpipe takes products for each
            let first = self.at + (self.dx * f32x4::splat(x) + self.dy * f32x4::splat(y));
            [first, first + self.dx, first + self.dy, first + (self.dx + self.dy)]
        } else {
            self.exact(x, y)
        }
    }

    /// Evaluates like [`Planes::block`], rounded as in llvmpipe: see [`fused`].
    #[inline(always)]
    fn exact(&self, x: f32, y: f32) -> [f32x4; 4] {
        let [at, dx, dy] = [self.at, self.dx, self.dy].map(double);
        let along = |slope: f64x4, place: f32, from: f64x4| single(slope * f64x4::splat(f64::from(place)) + from);
        // along a row first, then up, each rounded to single precision once, as two fused instructions round
        let columns = [double(along(dx, x, at)), double(along(dx, x + 1.0, at))];
        let row = |y: f32| columns.map(|from| along(dy, y, from));
        let ([a, b], [c, d]) = (row(y), row(y + 1.0));
        [a, b, c, d]
    }
}

#[inline(always)]
fn double(v: f32x4) -> f64x4 {
    f64x4::new(v.to_array().map(f64::from))
}

#[inline(always)]
fn single(v: f64x4) -> f32x4 {
    f32x4::new(v.to_array().map(|v| v as f32))
}

impl Plane {
    /// Returns whether rounding errors are small compared with `value` all over an image.
    pub fn is_gentle(&self, value: f32, size: [usize; 2]) -> bool {
        let change = self.dx.abs() * size[0] as f32 + self.dy.abs() * size[1] as f32;
        self.at.abs() + change <= GENTLE * value.abs()
    }

    /// Does the same for four planes, given as lanes of their fields: one bit for each.
    #[inline(always)]
    pub fn are_gentle([at, dx, dy]: [f32x4; 3], value: f32x4, size: [usize; 2]) -> u32 {
        let change = dx.abs() * size[0] as f32 + dy.abs() * size[1] as f32;
        (at.abs() + change).simd_le(value.abs() * GENTLE).to_bitmask()
    }

    /// Evaluates at one point, without llvmpipe's rounding.
    #[inline(always)]
    pub fn quick(&self, x: f32, y: f32) -> f32 {
        self.at + (self.dx * x + self.dy * y)
    }

    /// Returns the differences of the value over four displacements.
    #[inline(always)]
    pub fn spread(&self, dx: [f32; 4], dy: [f32; 4]) -> f32x4 {
        f32x4::splat(self.dx) * f32x4::new(dx) + f32x4::splat(self.dy) * f32x4::new(dy)
    }

    /// Evaluates at four points, rounded as in llvmpipe.
    #[inline(always)]
    pub fn at(&self, x: [f32; 4], y: [f32; 4]) -> [f32; 4] {
        let mut out = [0.0; 4];
        for k in 0..4 {
            out[k] = fused(self.dy, y[k], fused(self.dx, x[k], self.at));
        }
        out
    }
}
