//! MPR: the overlap of two convex shapes by Minkowski portal refinement (Snethen, "XenoCollide: Complex collision made simple", Game
//! Programming Gems 7, 2008), with the decisions of libccd's `ccdMPRPenetration`, which MuJoCo calls where `nativeccd` is off.
//!
//! From a point inside the Minkowski difference a ray goes through the origin. A portal is a triangle of support points that the ray goes
//! through. It is moved outwards, until the origin is behind it, or in front of a plane that touches the difference; and then on, until it is
//! on the surface: its nearest point to the origin is taken for the depth, though other parts of the surface may be nearer.

use super::support::{MinkowskiDifference, Support, Vertex};
use super::tolerance::{EPS, equal, is_zero};
use super::triangle::nearest;
use super::{dot, sub};
use crate::math::{Vec3, add, cross, scale};

/// Limit on the steps of a search: rounding errors can lead it in a circle, in which libccd would never end.
const ENDLESS: usize = 10_000;

/// The overlap of two shapes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Penetration {
    /// Depth, m.
    pub(super) depth: f64,
    /// Unit vector from the first shape to the second.
    pub(super) dir: Vec3,
    /// A point between both surfaces.
    pub(super) pos: Vec3,
}

/// Limits that end the search for the surface.
#[derive(Clone, Copy)]
pub(super) struct MprLimits {
    /// Distance from the surface at which a portal is near enough, m.
    pub(super) tolerance: f64,
    /// Limit on the moves of the portal once the origin is behind it.
    pub(super) iterations: usize,
}

/// Finds the overlap of two shapes, given a point inside each; `None` if they are apart, or touch without a direction.
pub(super) fn mpr(
    first: (&dyn Support, Vec3),
    second: (&dyn Support, Vec3),
    limits: &MprLimits,
) -> Option<Penetration> {
    let ((a, centre_a), (b, centre_b)) = (first, second);
    let mut inside = sub(centre_a, centre_b);
    if inside.iter().all(|&x| is_zero(x)) {
        inside[0] += 10.0 * EPS;
    }
    let inside = Vertex {
        point: inside,
        a: centre_a,
        b: centre_b,
    };
    let mut portal = Portal {
        shape: MinkowskiDifference { a, b },
        corners: [inside; 4],
    };
    match portal.discover() {
        PortalStart::Outside => None,
        PortalStart::OnRay => portal.on_ray(),
        PortalStart::Through => {
            if !portal.passes_origin(limits.tolerance) {
                return None;
            }
            portal.surface(limits)
        }
    }
}

/// Returns whether a height is at least zero, up to rounding errors.
#[inline(always)]
fn reaches(height: f64) -> bool {
    is_zero(height) || height > 0.0
}

/// Returns whether a height is below zero by more than rounding errors.
#[inline(always)]
fn below(height: f64) -> bool {
    !is_zero(height) && height < 0.0
}

/// Scales a vector to length one. A vector of length zero becomes NaN, as in libccd, and no comparison with it holds.
#[inline(always)]
fn direction(v: Vec3) -> Vec3 {
    scale(v, 1.0 / dot(v, v).sqrt())
}

/// The volume between three vectors, of either sign.
#[inline(always)]
fn volume(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    dot(cross(a, b), c)
}

/// The start of a search.
enum PortalStart {
    /// The shapes are apart.
    Outside,
    /// The first support point is on the ray, so no portal is needed.
    OnRay,
    /// The ray passes through the portal.
    Through,
}

/// The point inside the difference, and the three corners of the portal.
struct Portal<'s> {
    shape: MinkowskiDifference<&'s dyn Support, &'s dyn Support>,
    corners: [Vertex; 4],
}

impl Portal<'_> {
    #[inline(always)]
    fn points(&self) -> [Vec3; 4] {
        self.corners.map(|corner| corner.point)
    }

    /// Returns the direction of the portal, away from the point inside.
    fn outwards(&self) -> Vec3 {
        let [_, a, b, c] = self.points();
        direction(cross(sub(b, a), sub(c, a)))
    }

    /// Replaces a corner by the support point in a direction; returns whether that is beyond the origin.
    fn reach(&mut self, corner: usize, dir: Vec3) -> bool {
        self.corners[corner] = self.shape.support(dir);
        let height = dot(self.corners[corner].point, dir);
        !(is_zero(height) || height < 0.0)
    }

    /// Returns the direction of the plane through the point inside and the first two corners.
    fn side(&self) -> Vec3 {
        let [inside, a, b, _] = self.points();
        direction(cross(sub(a, inside), sub(b, inside)))
    }

    /// Searches for a portal that the ray passes through.
    fn discover(&mut self) -> PortalStart {
        let inside = self.corners[0].point;
        if !self.reach(1, direction(scale(inside, -1.0))) {
            return PortalStart::Outside;
        }
        let across = cross(inside, self.corners[1].point);
        if is_zero(dot(across, across)) {
            return PortalStart::OnRay;
        }
        if !self.reach(2, direction(across)) {
            return PortalStart::Outside;
        }
        let mut dir = self.side();
        if dot(dir, inside) > 0.0 {
            self.corners.swap(1, 2);
            dir = scale(dir, -1.0);
        }
        for _ in 0..ENDLESS {
            if !self.reach(3, dir) {
                return PortalStart::Outside;
            }
            // the ray passes a side of the pyramid: the new corner takes the place of the one that is farthest from it
            let [_, a, b, c] = self.points();
            let farthest = match () {
                () if below(volume(a, c, inside)) => 2,
                () if below(volume(c, b, inside)) => 1,
                () => return PortalStart::Through,
            };
            self.corners[farthest] = self.corners[3];
            dir = self.side();
        }
        PortalStart::Outside
    }

    /// Moves the portal outwards until the origin is behind it; returns whether that succeeds.
    fn passes_origin(&mut self, tolerance: f64) -> bool {
        for _ in 0..ENDLESS {
            let dir = self.outwards();
            if reaches(dot(dir, self.corners[1].point)) {
                return true;
            }
            let vertex = self.shape.support(dir);
            if !reaches(dot(vertex.point, dir)) || self.on_surface(&vertex, dir, tolerance) {
                return false;
            }
            self.expand(vertex);
        }
        false
    }

    /// Moves the portal, which has the origin behind it, to the surface, and measures there.
    fn surface(&mut self, limits: &MprLimits) -> Option<Penetration> {
        let mut iteration = 0;
        loop {
            let dir = self.outwards();
            let vertex = self.shape.support(dir);
            if self.on_surface(&vertex, dir, limits.tolerance) || iteration > limits.iterations {
                break;
            }
            self.expand(vertex);
            iteration += 1;
        }
        let [_, a, b, c] = self.points();
        let (foot, square) = nearest(a, b, c);
        let depth = square.sqrt();
        if is_zero(depth) {
            return None;
        }
        let dir = direction(foot);
        Some(Penetration {
            depth,
            dir,
            pos: self.middle(),
        })
    }

    /// Measures along the ray if the first corner is on it, because the ray leaves the difference there.
    fn on_ray(&self) -> Option<Penetration> {
        let corner = &self.corners[1];
        // a corner at the origin: the shapes touch, in no direction
        if corner.point.iter().all(|&x| is_zero(x)) {
            return None;
        }
        Some(Penetration {
            depth: dot(corner.point, corner.point).sqrt(),
            dir: direction(corner.point),
            pos: scale(add(corner.a, corner.b), 0.5),
        })
    }

    /// Returns whether a support in the direction of the portal is barely farther than the portal.
    fn on_surface(&self, vertex: &Vertex, dir: Vec3, tolerance: f64) -> bool {
        let height = dot(vertex.point, dir);
        let [_, a, b, c] = self.points().map(|point| height - dot(point, dir));
        let least = |a: f64, b: f64| if a < b { a } else { b };
        let gain = least(least(a, b), c);
        gain < tolerance || equal(gain, tolerance)
    }

    /// Replaces the corner whose replacement keeps the ray within the portal.
    fn expand(&mut self, vertex: Vertex) {
        let [inside, a, b, c] = self.points();
        let plane = cross(vertex.point, inside);
        let corner = if dot(a, plane) > 0.0 {
            if dot(b, plane) > 0.0 { 1 } else { 3 }
        } else if dot(c, plane) > 0.0 {
            2
        } else {
            1
        };
        self.corners[corner] = vertex;
    }

    /// Returns the point between the shapes: the mean of the points of both shapes that have the origin's barycentric coordinates.
    fn middle(&self) -> Vec3 {
        let [inside, a, b, c] = self.points();
        let mut weights = [
            volume(a, b, c),
            volume(c, b, inside),
            volume(inside, a, c),
            volume(b, a, inside),
        ];
        let mut sum = weights[0] + weights[1] + weights[2] + weights[3];
        if is_zero(sum) || sum < 0.0 {
            // a flat pyramid: the foot of the origin on the portal stands for it
            let dir = self.outwards();
            weights = [0.0, volume(b, c, dir), volume(c, a, dir), volume(a, b, dir)];
            sum = weights[1] + weights[2] + weights[3];
        }
        let inverse = 1.0 / sum;
        let (mut first, mut second) = ([0.0; 3], [0.0; 3]);
        for (corner, weight) in self.corners.iter().zip(weights) {
            first = add(first, scale(corner.a, weight));
            second = add(second, scale(corner.b, weight));
        }
        scale(add(scale(first, inverse), scale(second, inverse)), 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::super::PlacedGeom;
    use super::super::support::{Ball, Cuboid};
    use super::*;
    use crate::math::{MAT3_ID, norm};
    use crate::model::GeomType;

    const LIMITS: MprLimits = MprLimits {
        tolerance: 1e-6,
        iterations: 50,
    };

    fn geom(kind: GeomType, size: Vec3, pos: Vec3) -> PlacedGeom<'static> {
        PlacedGeom {
            kind,
            size,
            pos,
            mat: &MAT3_ID,
            mesh: None,
            hfield: None,
        }
    }

    fn boxes(pos: Vec3) -> Option<Penetration> {
        let [a, b] = [[0.0; 3], pos].map(|pos| geom(GeomType::Box, [0.5; 3], pos));
        let [first, second] = [&a, &b].map(|geom| Cuboid::new(geom, 0.0));
        mpr((&first, a.pos), (&second, b.pos), &LIMITS)
    }

    #[test]
    fn balls_overlap_along_the_line_of_their_centres() {
        let [a, b] = [[0.0; 3], [0.0, 0.0, 1.5]].map(|pos| geom(GeomType::Sphere, [1.0, 0.0, 0.0], pos));
        let [first, second] = [&a, &b].map(|geom| Ball::new(geom, 0.0));
        let found = mpr((&first, a.pos), (&second, b.pos), &LIMITS).expect("they overlap");
        assert_eq!(
            (found.depth, found.dir, found.pos),
            (0.5, [0.0, 0.0, 1.0], [0.0, 0.0, 0.75])
        );
        let far = [0.0, 0.0, 2.001];
        assert!(
            mpr(
                (&first, a.pos),
                (&Ball::new(&PlacedGeom { pos: far, ..b }, 0.0), far),
                &LIMITS
            )
            .is_none()
        );
    }

    #[test]
    fn boxes_overlap_where_the_ray_leaves_their_difference() {
        let found = boxes([0.03, -0.02, 0.9]).expect("they overlap");
        assert!((found.depth - 0.1).abs() < 1e-12, "{found:?}");
        assert!(norm(sub(found.dir, [0.0, 0.0, 1.0])) < 1e-12, "{found:?}");
        assert!((found.pos[2] - 0.45).abs() < 1e-12, "{found:?}");
        assert!(boxes([0.03, -0.02, 1.001]).is_none());
        // without a ray one along x serves
        let found = boxes([0.0; 3]).expect("they overlap");
        assert_eq!((found.depth, found.dir[0].abs()), (1.0, 1.0));
    }

    #[test]
    fn what_is_not_a_number_ends_the_search() {
        for x in [f64::NAN, f64::INFINITY, -f64::INFINITY, f64::MAX] {
            for k in 0..3 {
                let mut pos = [0.1, 0.2, 0.3];
                pos[k] = x;
                let touch = boxes(pos);
                assert!(
                    touch.is_none_or(|touch| touch.depth.is_nan() || touch.depth >= 0.0),
                    "{touch:?}"
                );
            }
        }
    }
}
