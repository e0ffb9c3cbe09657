//! The camera of the reference: single precision, in the order of operations of MuJoCo and of Mesa's matrices, so that
//! vertices fall on the same 1/256 of a pixel.

use crate::math::{MAT3_ID, Mat3, Vec3, column};
use crate::mesh::MeshPart;
use crate::scenery::Scenery;
use crate::single::single;
use crate::view::{Poses, View};

pub type Vec3f = [f32; 3];
/// Coefficients of x, y, z and the constant.
pub type AffineRow = [f32; 4];

/// Distance between the two cameras of the reference, m; it draws from the middle between them.
const EYE_DISTANCE: f64 = 0.068;

pub fn dot(a: Vec3f, b: Vec3f) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vec3f, b: Vec3f) -> Vec3f {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn unit(a: Vec3f) -> Vec3f {
    let scale = 1.0 / dot(a, a).sqrt();
    [a[0] * scale, a[1] * scale, a[2] * scale]
}

/// Computes `a b + c` rounded once, like the fused instruction that llvmpipe uses: the product is exact. (In one case in
/// 2^29, the sum is rounded twice.)
#[inline(always)]
pub fn fused(a: f32, b: f32, c: f32) -> f32 {
    (f64::from(a) * f64::from(b) + f64::from(c)) as f32
}

/// A camera with its pose in the world and its projection.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewCamera {
    pub pos: Vec3f,
    pub right: Vec3f,
    pub up: Vec3f,
    pub forward: Vec3f,
    /// Tangents of half the field of view, horizontal and vertical.
    pub tan: [f32; 2],
    pub near: f32,
    /// Transform from the world to the camera frame; the camera looks along -z.
    view: [AffineRow; 3],
    /// Focal lengths in half images.
    pub focal: [f32; 2],
    /// Factor and offset of the depth before the division: 1 at the near plane, 0 at the far plane.
    pub depth: [f32; 2],
}

impl ViewCamera {
    pub fn new(scenery: &Scenery, poses: &Poses, view: &View) -> Self {
        let (place, mat) = poses.camera(view.camera).unwrap_or(([0.0; 3], MAT3_ID));
        let mat = &mat;
        // MuJoCo places two eyes in single precision, even where it draws one picture, and averages them: this moves the
        // camera by up to one rounding
        let aside = column(mat, 0);
        let side = |sign: f64| [0, 1, 2].map(|i| (place[i] + sign * EYE_DISTANCE * 0.5 * aside[i]) as f32);
        let (left, right) = (side(-1.0), side(1.0));
        let pos = [0, 1, 2].map(|i| ((f64::from(left[i]) + f64::from(right[i])) * 0.5) as f32);
        let doubled = |v: Vec3| single(v).map(|x| f64::from(x) + f64::from(x));
        // MuJoCo adds the directions of both eyes before it normalizes them: equal ones double without rounding
        let ahead = crate::math::unit(doubled(column(mat, 2).map(|v| -v))).0;
        let upward = doubled(column(mat, 1));
        let along = crate::math::dot(upward, ahead);
        // made perpendicular to the direction of view by Gram and Schmidt, in double precision, then single again
        let upward = crate::math::unit([0, 1, 2].map(|i| upward[i] - along * ahead[i])).0;

        let forward = unit(single(ahead));
        let right = unit(cross(forward, single(upward)));
        let up = unit(cross(right, forward));
        let (near, far) = (scenery.near as f32, scenery.far as f32);
        let tangent = pxfm::f_tan(scenery.fovy_of(view.camera) * std::f64::consts::PI / 360.0);
        let top = (f64::from(near) * tangent) as f32;
        // the width follows from the height, as in `glFrustum`: the field of view is vertical unless the camera has a lens
        let half_width = match scenery.half_width_of(view.camera) {
            Some(half) => (f64::from(near) * half) as f32,
            None => 0.5 * view.width as f32 / view.height as f32 * (top + top),
        };
        let back = forward.map(|v| -v);
        Self {
            pos,
            right,
            up,
            forward,
            tan: [half_width / near, top / near],
            near,
            // the product of a rotation and a translation: the last column is the camera's position in its own frame,
            // negated
            view: [
                [right[0], right[1], right[2], -dot(right, pos)],
                [up[0], up[1], up[2], -dot(up, pos)],
                [back[0], back[1], back[2], dot(forward, pos)],
            ],
            focal: [2.0 * near / (half_width + half_width), 2.0 * near / (top + top)],
            // the depth is reversed, 1 near and 0 far: floating-point numbers are densest around 0, where perspective
            // crowds what is far away
            depth: [
                -0.5 * (-(far + near) / (far - near)) - 0.5,
                -0.5 * (-(2.0 * far * near) / (far - near)),
            ],
        }
    }

    /// Returns a position in the frame of the camera: right, up, forward.
    pub fn locate(&self, pos: Vec3f) -> Vec3f {
        let d = [pos[0] - self.pos[0], pos[1] - self.pos[1], pos[2] - self.pos[2]];
        [dot(d, self.right), dot(d, self.up), dot(d, self.forward)]
    }

    /// Returns the depth value at a distance in front of the camera.
    pub fn depth_at(&self, ahead: f32) -> f32 {
        self.depth[1] / ahead - self.depth[0]
    }

    /// Returns the transform from a shape scaled by `size` and placed in the world to the camera frame.
    pub fn model(&self, pos: Vec3, mat: &Mat3, size: Vec3f) -> [AffineRow; 3] {
        let (pos, mat) = (single(pos), mat.map(|v| v as f32));
        self.view.map(|[x, y, z, c]| {
            // the product of view and pose is made once for a shape, so a vertex costs one transform instead of two
            let turned = |k: usize| x * mat[k] + y * mat[3 + k] + z * mat[6 + k];
            let constant = x * pos[0] + y * pos[1] + z * pos[2] + c;
            [turned(0) * size[0], turned(1) * size[1], turned(2) * size[2], constant]
        })
    }

    /// Turns a transform into the camera frame into a projection: rows that give x and y (in half images) and the
    /// depth, all times w, and w.
    pub fn project(&self, [x, y, z]: [AffineRow; 3]) -> [AffineRow; 4] {
        // divided by w, which is -z, this is a constant and a term in 1 / w
        let mut depth = z.map(|v| self.depth[0] * v);
        depth[3] += self.depth[1];
        [
            x.map(|v| self.focal[0] * v),
            y.map(|v| self.focal[1] * v),
            depth,
            z.map(|v| -v),
        ]
    }
}

/// Returns the transform for one part of a shape: the caps of a capsule are not stretched with its length.
pub fn part_rows(part: MeshPart, rows: [AffineRow; 3], size: Vec3f) -> [AffineRow; 3] {
    // a scaled capsule has caps that stay half balls: they are scaled by the radius in all directions and moved to
    // its ends
    let cap = 0.5 * (size[0] + size[1]);
    let length = size[2];
    let upper = |[x, y, z, c]: AffineRow| {
        let z = z * (cap / length);
        [x, y, z, z * ((length - cap) / cap) + c]
    };
    match part {
        MeshPart::Body => rows,
        MeshPart::Top => rows.map(upper),
        MeshPart::Bottom => rows.map(|r| {
            let [x, y, z, c] = upper(r);
            [x, y, z, z * (2.0 * (cap - length) / cap) + c]
        }),
    }
}
