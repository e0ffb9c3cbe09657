//! A camera as the reference sets it up: single precision, in the same order of operations, so that vertices fall on the
//! same 1/256 of a pixel.

use crate::math::{Mat3, Vec3, column};
use crate::render::mesh::Part;
use crate::render::visual::{Poses, View, Visual};

pub type V3 = [f32; 3];
/// Coefficients of x, y, z and the constant.
pub type Row = [f32; 4];

pub fn dot(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V3, b: V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn unit(a: V3) -> V3 {
    let scale = 1.0 / dot(a, a).sqrt();
    [a[0] * scale, a[1] * scale, a[2] * scale]
}

pub fn single(v: Vec3) -> V3 {
    v.map(|x| x as f32)
}

/// A camera at its place.
#[derive(Clone, Copy, Debug, Default)]
pub struct Eye {
    pub pos: V3,
    pub right: V3,
    pub up: V3,
    pub forward: V3,
    /// Tangents of half of the field of view.
    pub tan: [f32; 2],
    /// Focal lengths in half pictures.
    focal: [f32; 2],
    pub near: f32,
}

impl Eye {
    pub fn new(visual: &Visual, poses: &Poses, view: &View) -> Self {
        let mat = &poses.cam_xmat[view.camera.0];
        let pos = single(poses.cam_xpos[view.camera.0]);
        let forward = unit(single(column(mat, 2)).map(|v| -v));
        let right = unit(cross(forward, single(column(mat, 1))));
        let up = unit(cross(right, forward));
        let tangent = pxfm::f_tan(visual.cameras[view.camera.0].fovy.to_radians() * 0.5);
        let near = visual.near as f32;
        let top = (visual.near * tangent) as f32;
        let half_width = 0.5 * view.width as f32 / view.height as f32 * (top + top);
        Self {
            pos,
            right,
            up,
            forward,
            tan: [half_width / near, top / near],
            focal: [2.0 * near / (half_width + half_width), 2.0 * near / (top + top)],
            near,
        }
    }

    /// Position in the frame of the camera: to the right, up, ahead.
    pub fn locate(&self, pos: V3) -> V3 {
        let d = [pos[0] - self.pos[0], pos[1] - self.pos[1], pos[2] - self.pos[2]];
        [dot(d, self.right), dot(d, self.up), dot(d, self.forward)]
    }

    /// Projection of something scaled by `size` and placed in the world: rows that give x, y (in half pictures, times w)
    /// and w.
    pub fn projection(&self, pos: Vec3, mat: &Mat3, size: V3) -> [Row; 3] {
        let (pos, mat) = (single(pos), mat.map(|v| v as f32));
        let back = self.forward.map(|v| -v);
        let row = |axis: V3, offset: f32| {
            let turned = |k: usize| axis[0] * mat[k] + axis[1] * mat[3 + k] + axis[2] * mat[6 + k];
            let constant = axis[0] * pos[0] + axis[1] * pos[1] + axis[2] * pos[2] + offset;
            [turned(0) * size[0], turned(1) * size[1], turned(2) * size[2], constant]
        };
        let x = row(self.right, -dot(self.right, self.pos));
        let y = row(self.up, -dot(self.up, self.pos));
        let z = row(back, dot(self.forward, self.pos));
        [
            x.map(|v| v * self.focal[0]),
            y.map(|v| v * self.focal[1]),
            z.map(|v| -v),
        ]
    }
}

/// The rows for a part of a shape: the caps of a capsule are not stretched with its length.
pub fn part_rows(part: Part, rows: [Row; 3], size: V3) -> [Row; 3] {
    let cap = 0.5 * (size[0] + size[1]);
    let length = size[2];
    let upper = |[x, y, z, c]: Row| {
        let z = z * (cap / length);
        [x, y, z, z * ((length - cap) / cap) + c]
    };
    match part {
        Part::Body => rows,
        Part::Top => rows.map(upper),
        Part::Bottom => rows.map(|r| {
            let [x, y, z, c] = upper(r);
            [x, y, z, z * (2.0 * (cap - length) / cap) + c]
        }),
    }
}
