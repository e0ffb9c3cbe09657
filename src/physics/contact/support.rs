//! Support points of convex geoms, and of the Minkowski difference of two.

use super::{PlacedGeom, add_scaled, sub};
use crate::math::{Mat3, Vec3, add, mat_t_vec, mat_vec, norm, scale};

/// A convex shape, defined by its support function.
pub(super) trait Support {
    /// Returns the farthest point in the unit direction `dir`.
    fn support(&self, dir: Vec3) -> Vec3;

    /// Returns whether it is the hull of finitely many points; between two such shapes MuJoCo computes the distance to the last bit.
    fn discrete(&self) -> bool {
        false
    }
}

/// Any shape: pairs with meshes share one copy of the routines, because most of the time is spent in the shape.
impl Support for &dyn Support {
    fn support(&self, dir: Vec3) -> Vec3 {
        (**self).support(dir)
    }

    fn discrete(&self) -> bool {
        (**self).discrete()
    }
}

/// The pose of a shape, and the distance by which it is grown on all sides.
#[derive(Clone, Copy)]
pub(super) struct Pose<'a> {
    pos: Vec3,
    pub(super) mat: &'a Mat3,
    grown: f64,
}

impl<'a> Pose<'a> {
    /// Prepares a shape of a pair; each geom gets half the margin.
    pub(super) fn new(geom: &PlacedGeom<'a>, margin: f64) -> Self {
        Pose {
            pos: geom.pos,
            mat: geom.mat,
            grown: 0.5 * margin,
        }
    }

    /// Returns whether its corners are sharp: growing a shape rounds them.
    pub(super) fn sharp(&self) -> bool {
        self.grown == 0.0
    }

    #[inline(always)]
    pub(super) fn place(&self, local: Vec3, dir: Vec3) -> Vec3 {
        let point = add(mat_vec(self.mat, local), self.pos);
        if self.grown > 0.0 {
            add_scaled(point, dir, self.grown)
        } else {
            point
        }
    }
}

/// Returns `half` with the sign of the component; a component of either zero counts as positive. Without a branch,
/// since the sign is hard to predict.
#[inline(always)]
fn along(component: f64, half: f64) -> f64 {
    half.copysign(component + 0.0)
}

/// The segment inside a capsule.
pub(super) struct Segment<'a> {
    pose: Pose<'a>,
    half: f64,
}

impl<'a> Segment<'a> {
    /// Returns the segment of a capsule, which the margin does not grow.
    pub(super) fn new(geom: &PlacedGeom<'a>) -> Self {
        Segment {
            pose: Pose::new(geom, 0.0),
            half: geom.size[1],
        }
    }
}

impl Support for Segment<'_> {
    #[inline(always)]
    fn support(&self, dir: Vec3) -> Vec3 {
        let local = mat_t_vec(self.pose.mat, dir);
        self.pose.place([0.0, 0.0, along(local[2], self.half)], dir)
    }
}

/// A capsule, grown by half the margin.
pub(super) struct Capsule<'a> {
    pose: Pose<'a>,
    radius: f64,
    half: f64,
}

impl<'a> Capsule<'a> {
    /// Creates a capsule grown by half the margin.
    pub(super) fn new(geom: &PlacedGeom<'a>, margin: f64) -> Self {
        Capsule {
            pose: Pose::new(geom, margin),
            radius: geom.size[0],
            half: geom.size[1],
        }
    }
}

impl Support for Capsule<'_> {
    #[inline(always)]
    fn support(&self, dir: Vec3) -> Vec3 {
        let local = mat_t_vec(self.pose.mat, dir);
        let mut point = scale(local, self.radius);
        point[2] += along(local[2], self.half);
        self.pose.place(point, dir)
    }
}

/// A cylinder, grown by half the margin.
pub(super) struct Cylinder<'a> {
    pose: Pose<'a>,
    radius: f64,
    half: f64,
}

impl<'a> Cylinder<'a> {
    /// Creates a cylinder grown by half the margin.
    pub(super) fn new(geom: &PlacedGeom<'a>, margin: f64) -> Self {
        Cylinder {
            pose: Pose::new(geom, margin),
            radius: geom.size[0],
            half: geom.size[1],
        }
    }
}

impl Support for Cylinder<'_> {
    /// Returns the farthest point: along the axis the middle of the end disc, exactly across it the middle of the side.
    #[inline(always)]
    fn support(&self, dir: Vec3) -> Vec3 {
        const RADIAL_MIN: f64 = crate::math::MINVAL * crate::math::MINVAL;
        let local = mat_t_vec(self.pose.mat, dir);
        let radial2 = local[0] * local[0] + local[1] * local[1];
        let z = if local[2] == 0.0 {
            0.0
        } else {
            along(local[2], self.half)
        };
        let point = if radial2 > RADIAL_MIN {
            let factor = self.radius / radial2.sqrt();
            [local[0] * factor, local[1] * factor, z]
        } else {
            [0.0, 0.0, z]
        };
        self.pose.place(point, dir)
    }
}

/// A box, grown by half the margin.
pub(super) struct Cuboid<'a> {
    pose: Pose<'a>,
    size: Vec3,
}

impl<'a> Cuboid<'a> {
    /// Creates a box grown by half the margin.
    pub(super) fn new(geom: &PlacedGeom<'a>, margin: f64) -> Self {
        Cuboid {
            pose: Pose::new(geom, margin),
            size: geom.size,
        }
    }
}

impl Support for Cuboid<'_> {
    #[inline(always)]
    fn support(&self, dir: Vec3) -> Vec3 {
        let local = mat_t_vec(self.pose.mat, dir);
        let point = [
            along(local[0], self.size[0]),
            along(local[1], self.size[1]),
            along(local[2], self.size[2]),
        ];
        self.pose.place(point, dir)
    }

    fn discrete(&self) -> bool {
        self.pose.sharp()
    }
}

/// An ellipsoid, grown by half the margin.
pub(super) struct Ellipsoid<'a> {
    pose: Pose<'a>,
    size: Vec3,
}

impl<'a> Ellipsoid<'a> {
    /// Creates an ellipsoid grown by half the margin.
    pub(super) fn new(geom: &PlacedGeom<'a>, margin: f64) -> Self {
        Ellipsoid {
            pose: Pose::new(geom, margin),
            size: geom.size,
        }
    }
}

impl Support for Ellipsoid<'_> {
    /// Returns the farthest point, computed on the unit ball after scaling the axes away.
    #[inline(always)]
    fn support(&self, dir: Vec3) -> Vec3 {
        let local = mat_t_vec(self.pose.mat, dir);
        let scaled: Vec3 = std::array::from_fn(|k| local[k] * self.size[k]);
        let inverse = 1.0 / norm(scaled);
        self.pose
            .place(std::array::from_fn(|k| scaled[k] * (self.size[k] * inverse)), dir)
    }
}

/// The centre of a sphere.
pub(super) struct Point {
    pos: Vec3,
}

impl Point {
    /// Returns the centre of a sphere, which the margin does not grow.
    pub(super) fn new(geom: &PlacedGeom) -> Self {
        Point { pos: geom.pos }
    }
}

impl Support for Point {
    #[inline(always)]
    fn support(&self, _dir: Vec3) -> Vec3 {
        self.pos
    }
}

/// A sphere, grown by half the margin.
pub(super) struct Ball {
    pos: Vec3,
    radius: f64,
    grown: f64,
}

impl Ball {
    /// Creates a sphere grown by half the margin.
    pub(super) fn new(geom: &PlacedGeom, margin: f64) -> Self {
        Ball {
            pos: geom.pos,
            radius: geom.size[0],
            grown: 0.5 * margin,
        }
    }
}

impl Support for Ball {
    #[inline(always)]
    fn support(&self, dir: Vec3) -> Vec3 {
        let point = add_scaled(self.pos, dir, self.radius);
        if self.grown > 0.0 {
            add_scaled(point, dir, self.grown)
        } else {
            point
        }
    }
}

/// A point of the Minkowski difference and where it comes from.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Vertex {
    /// Point `a - b`.
    pub(super) point: Vec3,
    /// Point of the first shape.
    pub(super) a: Vec3,
    /// Point of the second shape.
    pub(super) b: Vec3,
}

/// The Minkowski difference of two shapes, first minus second: it holds the origin when they overlap.
pub(super) struct MinkowskiDifference<A, B> {
    /// First shape.
    pub(super) a: A,
    /// Second shape.
    pub(super) b: B,
}

impl<A: Support, B: Support> MinkowskiDifference<A, B> {
    /// Returns the farthest vertex in the unit direction `dir`.
    #[inline(always)]
    pub(super) fn support(&self, dir: Vec3) -> Vertex {
        let a = self.a.support(dir);
        let b = self.b.support(scale(dir, -1.0));
        Vertex { point: sub(a, b), a, b }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::MAT3_ID;
    use crate::model::GeomType;

    #[test]
    fn a_cylinder_has_no_corner_across_or_along_its_axis() {
        let geom = PlacedGeom {
            kind: GeomType::Cylinder,
            size: [0.5, 2.0, 0.0],
            pos: [1.0, 0.0, 0.0],
            mat: &MAT3_ID,
            mesh: None,
            hfield: None,
        };
        let cylinder = Cylinder::new(&geom, 0.0);
        assert_eq!(cylinder.support([0.0, 0.0, 1.0]), [1.0, 0.0, 2.0]);
        assert_eq!(cylinder.support([-1.0, 0.0, 0.0]), [0.5, 0.0, 0.0]);
        assert_eq!(Cylinder::new(&geom, 0.5).support([0.0, 0.0, -1.0]), [1.0, 0.0, -2.25]);
    }
}
