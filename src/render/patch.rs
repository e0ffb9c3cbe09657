//! Parts of strips whose quadrilaterals are tested together by back-face culling.

use super::strip::{LANES, STRIP_LANES, Strip};

/// The bits of all quadrilaterals of a patch.
pub const ALL: u8 = 15;

/// Four quadrilaterals of a strip: their planes, and the groups of their vertices.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Outward normals of the planes, by component; the length of each is the area of the parallelogram over the smaller of the two triangles.
    pub normal: [[f32; STRIP_LANES]; 3],
    /// Distances of the planes from the origin, times the lengths of the normals.
    pub offset: [f32; STRIP_LANES],
    /// Groups of [`LANES`] vertices that the corners belong to; some may be the same.
    pub vertices: [u16; 4],
}

impl Patch {
    /// Creates a patch of the quadrilaterals of a strip starting at `first`; `at` returns the positions of vertices.
    pub fn new(strip: &Strip, first: usize, at: impl Fn(u16) -> [f32; 3]) -> Self {
        let mut patch = Self {
            normal: [[0.0; STRIP_LANES]; 3],
            offset: [0.0; STRIP_LANES],
            vertices: [strip.corners(first)[0] / LANES as u16; 4],
        };
        let mut known = 1;
        for k in 0..STRIP_LANES {
            let [a, b, c, d] = strip.corners(first + k);
            for group in [a, b, c, d].map(|v| v / LANES as u16) {
                if !patch.vertices[..known].contains(&group) {
                    patch.vertices[known] = group;
                    known += 1;
                }
            }
            // rounding of the corners in the image turns the smaller triangle first: a quadrilateral is culled only if
            // neither can turn
            let (normal, offset) = smaller(plane([a, b, d].map(&at)), plane([b, c, d].map(&at)), strip.fan);
            patch.offset[k] = offset as f32;
            for (components, v) in patch.normal.iter_mut().zip(normal) {
                components[k] = v as f32;
            }
        }
        patch
    }
}

type PatchPlane = ([f64; 3], f64);

/// Returns the plane of a triangle: its normal, whose length is the area of the parallelogram, and the offset.
fn plane(corners: [[f32; 3]; 3]) -> PatchPlane {
    let [a, b, c] = corners.map(|v| v.map(f64::from));
    let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let normal = crate::math::cross(minus(b, a), minus(c, a));
    (normal, crate::math::dot(normal, a))
}

/// Returns the plane of the smaller of two triangles; the first if there is no other.
fn smaller(first: PatchPlane, second: PatchPlane, alone: bool) -> PatchPlane {
    let area = |(n, _): PatchPlane| crate::math::dot(n, n);
    if alone || area(first) <= area(second) {
        first
    } else {
        second
    }
}
