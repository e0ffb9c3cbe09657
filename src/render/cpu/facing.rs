//! Conservative back-face culling, before projection: vertices that only back faces use need not be projected.
//!
//! A face culled here must be one that the rasteriser would reject, which decides by the rounded corners of triangles in
//! the image; so a face counts as a back face only if rounding cannot turn it.

use wide::f32x4;

use super::camera::{Vec3f, ViewCamera, dot};
use super::frame::PlacedDrawable;
use crate::drawable::{Drawable, Shape};
use crate::mesh::{Band, MeshPart};
use crate::patch::{ALL, Patch};

/// Bound on the relative rounding of distances from a plane.
const ROUNDING: f32 = 1e-5;
/// Bound on the areas of faces of unit shapes.
const AREA: f32 = 0.26;

/// The camera in the frame of a drawable.
pub struct LocalCamera {
    /// Its position in the frame of the drawable, m.
    eye: Vec3f,
    /// Size of the drawable, m.
    size: Vec3f,
    /// Pixels per metre where the drawable is nearest.
    nearest: f32,
    /// Area in pixels of a square metre, seen from the front at a distance of 1 m, over the cube of the greatest distance.
    area: f32,
    /// Bound on the rounding error of the difference between two vertices, pixels: they are rounded to 1/256 pixels.
    moved: f32,
}

/// The camera in the unit shape of one part of a drawable.
pub struct PartCamera {
    eye: Vec3f,
    /// Smallest product of the distance from a plane and the area of a face for which the face may show its front.
    least: f32,
}

impl LocalCamera {
    /// Locates the camera; `None` if the drawable is flat or a mesh of the model, or so near that it may be clipped.
    pub fn new(drawable: &Drawable, draw: &PlacedDrawable, eye: &ViewCamera, image: [usize; 2]) -> Option<Self> {
        let d = [
            eye.pos[0] - draw.pos[0],
            eye.pos[1] - draw.pos[1],
            eye.pos[2] - draw.pos[2],
        ];
        let m = &draw.mat;
        let ahead = -dot(d, eye.forward);
        let (near, far) = (ahead - drawable.radius, ahead + drawable.radius);
        // meshes of the model have no patches
        if matches!(drawable.shape, Shape::Plane | Shape::Mesh) || near <= eye.near {
            return None;
        }
        let half = [image[0] as f32 * 0.5, image[1] as f32 * 0.5];
        let focal = [half[0] * eye.focal[0], half[1] * eye.focal[1]];
        // the greatest slope of the projection focal x / z: x / z itself is at most half / focal in the image
        let steepest = |k: usize| (focal[k] * focal[k] + half[k] * half[k]).sqrt();
        Some(Self {
            eye: [0, 1, 2].map(|k| d[0] * m[k] + d[1] * m[3 + k] + d[2] * m[6 + k]),
            size: drawable.size,
            nearest: steepest(0).max(steepest(1)) / near,
            // the area of a projected triangle is focal^2 times the triple product of its corners over the product of
            // their three depths
            area: focal[0] * focal[1] / (far * far * far),
            // each end moves by half a step at most; single precision adds a little that grows with the image
            moved: 1.05 / 256.0 + 1e-5 * half[0].max(half[1]),
        })
    }

    /// Locates the camera in the unit shape of a band.
    pub fn of(&self, band: &Band) -> PartCamera {
        let [width, depth, length] = self.size;
        let cap = 0.5 * (width + depth);
        let (stretch, shift) = match band.part {
            MeshPart::Body => (length, 0.0),
            MeshPart::Top => (cap, length - cap),
            MeshPart::Bottom => (cap, cap - length),
        };
        let [x, y, z] = self.eye;
        // In the unit shape all drawables share their normals and offsets. Which side of a plane a point is on survives
        // any scaling.
        let eye = [x / width, y / depth, (z - shift) / stretch];
        let edge = [band.edge[0] * width, band.edge[1] * depth, band.edge[2] * stretch];
        let longest = dot(edge, edge).sqrt() * self.nearest;
        // moving its corners changes the area of a parallelogram by no more than this
        let change = self.moved * (4.0 * longest + 2.0 * self.moved);
        let distance = eye[0].abs() + eye[1].abs() + eye[2].abs() + 2.0;
        PartCamera {
            eye,
            least: -change / (self.area * width * depth * stretch) - ROUNDING * AREA * distance,
        }
    }
}

impl PartCamera {
    /// Returns one bit for each quadrilateral of a patch that may be a front face.
    #[inline(always)]
    pub fn fronts(&self, patch: &Patch) -> u8 {
        let [x, y, z] = patch.normal.map(f32x4::new);
        let [ex, ey, ez] = self.eye;
        let out = x * ex + y * ey + z * ez - f32x4::new(patch.offset);
        // NaN counts as front
        ALL & !out.simd_lt(f32x4::splat(self.least)).to_bitmask() as u8
    }
}
