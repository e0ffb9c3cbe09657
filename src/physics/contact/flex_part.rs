//! The shape of a vertex or an element of a flex.

use super::PlacedGeom;
use super::support::Support;
use crate::math::*;
use crate::model::GeomType;

/// A vertex or an element of a flex: the hull of up to four points, with a radius around it.
#[derive(Clone, Copy, Debug)]
pub struct FlexPart {
    pub(super) points: [Vec3; 4],
    pub(super) count: usize,
    pub(super) radius: f64,
    /// Middle of the box around the points.
    pub(super) centre: Vec3,
}

impl FlexPart {
    /// Makes a part from a radius (m) and the points (m) of a vertex or an element; the first four count.
    pub fn new(points: impl Iterator<Item = Vec3>, radius: f64) -> Self {
        let mut part = Self {
            points: [[0.0; 3]; 4],
            count: 0,
            radius,
            centre: [0.0; 3],
        };
        for (place, point) in part.points.iter_mut().zip(points) {
            *place = point;
            part.count += 1;
        }
        let first = part.points[0];
        let (low, high) = part.points().iter().fold((first, first), |(low, high), point| {
            (
                std::array::from_fn(|k| low[k].min(point[k])),
                std::array::from_fn(|k| high[k].max(point[k])),
            )
        });
        part.centre = std::array::from_fn(|k| 0.5 * (high[k] + low[k]));
        part
    }

    /// Returns the points.
    pub(super) fn points(&self) -> &[Vec3] {
        &self.points[..self.count]
    }

    /// Returns the part in the frame of a geom.
    pub(super) fn within(&self, geom: &PlacedGeom) -> Self {
        let local = |point: Vec3| mat_t_vec(geom.mat, sub(point, geom.pos));
        Self {
            points: self.points.map(local),
            centre: local(self.centre),
            ..*self
        }
    }

    /// Returns the shape, grown by a distance beyond the radius.
    pub(super) fn grown(&self, by: f64) -> GrownPart<'_> {
        GrownPart {
            part: self,
            reach: self.radius + by,
        }
    }

    /// Returns the points as a shape without a radius.
    pub(super) fn bare(&self) -> GrownPart<'_> {
        GrownPart { part: self, reach: 0.0 }
    }

    /// Returns the capsule of a line.
    pub(super) fn capsule<'a>(&self, mat: &'a mut Mat3) -> PlacedGeom<'a> {
        let [first, second, ..] = self.points;
        let (axis, length) = unit(sub(first, second));
        *mat = quat_to_mat(z_to(axis));
        PlacedGeom {
            kind: GeomType::Capsule,
            size: [self.radius, 0.5 * length, 0.0],
            pos: scale(add(first, second), 0.5),
            mat,
            mesh: None,
            hfield: None,
        }
    }

    /// Returns the sphere of a vertex.
    pub(super) fn sphere(&self) -> PlacedGeom<'static> {
        PlacedGeom {
            kind: GeomType::Sphere,
            size: [self.radius, 0.0, 0.0],
            pos: self.points[0],
            mat: &MAT3_ID,
            mesh: None,
            hfield: None,
        }
    }
}

/// Returns the shortest rotation of the z axis to a unit vector (MuJoCo's `mju_quatZ2Vec`).
fn z_to(to: Vec3) -> Quat {
    let (axis, sine) = unit([-to[1], to[0], 0.0]);
    if sine < MINVAL {
        return if to[2] < 0.0 { [0.0, 1.0, 0.0, 0.0] } else { QUAT_ID };
    }
    axis_angle_to_quat(axis, pxfm::f_atan2(sine, to[2]))
}

/// A part with a radius around it.
pub(super) struct GrownPart<'a> {
    part: &'a FlexPart,
    reach: f64,
}

impl Support for GrownPart<'_> {
    fn support(&self, dir: Vec3) -> Vec3 {
        let points = self.part.points();
        let (mut best, mut farthest) = (points[0], dot(points[0], dir));
        for &point in &points[1..] {
            let far = dot(point, dir);
            if far > farthest {
                (best, farthest) = (point, far);
            }
        }
        add_scaled(best, dir, self.reach)
    }
}
