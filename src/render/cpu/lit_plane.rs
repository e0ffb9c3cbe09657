//! Light on planes: computed at the corners of the rectangle of a [`Lattice`](crate::lattice::Lattice) that a pixel shows, and interpolated.

use wide::f32x4;

use super::camera::Vec3f;
use super::frame::PlacedDrawable;
use super::lanes::{four, three};
use super::light::{self, PlacedLight, Vec3x4, VertexGroup};
use crate::drawable::Drawable;
use crate::lattice::Lattice;
use crate::mesh::MeshPart;

/// A visible plane.
#[derive(Clone, Copy, Debug)]
pub struct LitPlane {
    /// Index of the drawable.
    pub draw: u32,
    drawable: Drawable,
    placed: PlacedDrawable,
    lattice: Lattice,
    eye: Vec3f,
}

impl LitPlane {
    /// Returns the plane of a drawable, if it is lit on a lattice.
    pub fn new(draw: u32, drawable: &Drawable, placed: &PlacedDrawable, eye: Vec3f) -> Option<Self> {
        drawable.lattice.map(|lattice| Self {
            draw,
            drawable: *drawable,
            placed: *placed,
            lattice,
            eye,
        })
    }

    /// Returns the colours at four places on the plane, m; those that are not `wanted` are unspecified.
    pub fn colours(&self, lights: &[PlacedLight], x: f32x4, y: f32x4, wanted: [bool; 4]) -> Vec3x4 {
        let (x, y) = (x.to_array(), y.to_array());
        let mut colours = [[0.0; 4]; 3];
        let mut last = ([0.0; 4], [[0.0; 4]; 3]);
        for k in (0..4).filter(|&k| wanted[k]) {
            let ([left, right], [low, high]) = (self.lattice.around(0, x[k]), self.lattice.around(1, y[k]));
            // neighbouring pixels mostly show the same rectangle
            if last.0 != [left, right, low, high] {
                last = (
                    [left, right, low, high],
                    self.corners(lights, corners_between([left, right, low, high])),
                );
            }
            let (a, b) = ((x[k] - left) / (right - left), (y[k] - low) / (high - low));
            for (colour, [p, q, r, s]) in colours.iter_mut().zip(last.1) {
                // the rectangle is split from the right lower corner to the left upper one
                colour[k] = if a + b <= 1.0 {
                    p + (q - p) * a + (s - p) * b
                } else {
                    r + (s - r) * (1.0 - a) + (q - r) * (1.0 - b)
                };
            }
        }
        colours.map(f32x4::new)
    }

    /// Returns the colours at the corners of a rectangle, counterclockwise from the one on the left below.
    #[inline(never)]
    fn corners(&self, lights: &[PlacedLight], [x, y]: [[f32; 4]; 2]) -> [[f32; 4]; 3] {
        let [width, depth, _] = self.drawable.size;
        let corners = VertexGroup {
            part: four(|_| MeshPart::Body),
            at: [f32x4::new(x) / width, f32x4::new(y) / depth, f32x4::ZERO],
            normal: [f32x4::ZERO, f32x4::ZERO, f32x4::ONE],
        };
        let lit = light::vertices(lights, &self.drawable, &self.placed, self.eye, &corners);
        three(|k| lit[k].to_array())
    }
}

/// Returns the corners of a rectangle between lines, counterclockwise from the one on the left below.
fn corners_between([left, right, low, high]: [f32; 4]) -> [[f32; 4]; 2] {
    [[left, right, right, left], [low, low, high, high]]
}
