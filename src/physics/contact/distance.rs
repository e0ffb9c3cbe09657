//! The distance between two separate or overlapping geoms, and the points between which it is measured (MuJoCo 3.3.0's `mj_geomDistance`).

use super::epa::epa;
use super::gjk::{GjkLimits, Simplex, gjk};
use super::mesh::MeshShape;
use super::polytope::Polytope;
use super::support::{Ball, Capsule, Cuboid, Cylinder, Ellipsoid, MinkowskiDifference, Point, Segment, Support};
use super::{ContactOptions, ContactPoint, MAXVAL, PlacedGeom, Scratch, add_scaled, collide, sub};
use crate::math::{Vec3, unit};
use crate::model::GeomType;

/// The distance of two geoms, and the points between which it is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeomDistance {
    /// Distance, m; negative if the geoms overlap.
    pub dist: f64,
    /// Point of the first geom, m.
    pub from: Vec3,
    /// Point of the second geom, m.
    pub to: Vec3,
}

/// Measures the distance of two geoms if it is below `most`, m; `points` is working memory. Planes have no distance from planes.
///
/// Where GJK and EPA measure it, MuJoCo returns the points in the order of the types of the geoms, whichever is given first.
#[doc(alias = "mj_geomDistance")]
pub fn distance(
    first: &PlacedGeom,
    second: &PlacedGeom,
    most: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
    points: &mut Vec<ContactPoint>,
) -> Option<GeomDistance> {
    use GeomType::{Box, Capsule as Pill, Cylinder as Rod, Ellipsoid as Egg, Mesh, Sphere};
    let turned = first.kind > second.kind;
    let (a, b) = if turned { (second, first) } else { (first, second) };
    let (rod, egg, cuboid) = (
        |g| Cylinder::new(g, 0.0),
        |g| Ellipsoid::new(g, 0.0),
        |g| Cuboid::new(g, 0.0),
    );
    if !options.nativeccd {
        return of_contacts(a, b, turned, most, options, scratch, points);
    }
    let mut find = DistanceSearch {
        a,
        b,
        most,
        options,
        polytope: &mut scratch.polytope,
    };
    // one copy of the routines for all shapes: only sensors ask for distances, and modules of the page hold each copy
    let span = match (a.kind, b.kind) {
        (Sphere, Egg) => find.rounded(&Point::new(a), &Ball::new(a, 0.0), &egg(b)),
        (Pill, Egg) => find.rounded(&Segment::new(a), &Capsule::new(a, 0.0), &egg(b)),
        (Pill, Rod) => find.rounded(&Segment::new(a), &Capsule::new(a, 0.0), &rod(b)),
        (Egg, Egg) => find.whole(&egg(a), &egg(b)),
        (Egg, Rod) => find.whole(&egg(a), &rod(b)),
        (Egg, Box) => find.whole(&egg(a), &cuboid(b)),
        (Rod, Rod) => find.whole(&rod(a), &rod(b)),
        (Rod, Box) => find.whole(&rod(a), &cuboid(b)),
        (Box, Box) => find.whole(&cuboid(a), &cuboid(b)),
        (Sphere, Mesh) => find.rounded(&Point::new(a), &Ball::new(a, 0.0), &mesh(b)?),
        (Pill, Mesh) => find.rounded(&Segment::new(a), &Capsule::new(a, 0.0), &mesh(b)?),
        (Egg, Mesh) => find.whole(&egg(a), &mesh(b)?),
        (Rod, Mesh) => find.whole(&rod(a), &mesh(b)?),
        (Box, Mesh) => find.whole(&cuboid(a), &mesh(b)?),
        (Mesh, Mesh) => find.whole(&mesh(a)?, &mesh(b)?),
        _ => return of_contacts(a, b, turned, most, options, scratch, points),
    };
    (span.dist < most).then_some(span)
}

/// Returns the shape of a mesh.
fn mesh<'g>(geom: &PlacedGeom<'g>) -> Option<MeshShape<'g>> {
    geom.mesh.map(|mesh| MeshShape::new(geom, mesh, 0.0))
}

/// Measures by contacts, with the largest relevant distance as margin.
fn of_contacts(
    a: &PlacedGeom,
    b: &PlacedGeom,
    turned: bool,
    most: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
    points: &mut Vec<ContactPoint>,
) -> Option<GeomDistance> {
    points.clear();
    collide(a, b, most, options, scratch, points);
    nearest(points, most, if turned { -1.0 } else { 1.0 })
}

/// Returns the span of the nearest of some contacts.
fn nearest(points: &[ContactPoint], most: f64, sign: f64) -> Option<GeomDistance> {
    let (mut dist, mut found) = (most, None);
    for point in points {
        if point.dist < dist {
            (dist, found) = (point.dist, Some(point));
        }
    }
    found.map(|point| GeomDistance {
        dist,
        from: add_scaled(point.pos, point.normal(), -0.5 * sign * dist),
        to: add_scaled(point.pos, point.normal(), 0.5 * sign * dist),
    })
}

/// A search for the distance of two convex geoms.
struct DistanceSearch<'a, 'g> {
    a: &'a PlacedGeom<'g>,
    b: &'a PlacedGeom<'g>,
    most: f64,
    options: &'a ContactOptions,
    polytope: &'a mut Polytope,
}

impl DistanceSearch<'_, '_> {
    fn limits(&self, grown: f64) -> GjkLimits {
        GjkLimits {
            tolerance: self.options.ccd_tolerance,
            iterations: self.options.ccd_iterations,
            cutoff: self.most + grown,
            stop_at_same_centre: self.options.quirks.same_centre_is_no_contact,
        }
    }

    /// Measures from a sphere or capsule, the set of points near its `core`.
    fn rounded(&mut self, core: &dyn Support, whole: &dyn Support, other: &dyn Support) -> GeomDistance {
        let (core, radius) = (MinkowskiDifference { a: core, b: other }, self.a.size[0]);
        let limits = self.limits(radius);
        let closest = gjk(&core, self.a.pos, self.b.pos, &limits, &mut Simplex::default());
        if closest.distance <= limits.tolerance {
            return self.whole(whole, other);
        }
        let (towards, _) = unit(sub(closest.b, closest.a));
        let dist = closest.distance - radius;
        GeomDistance {
            dist: if dist > self.most { MAXVAL } else { dist },
            from: add_scaled(closest.a, towards, radius),
            to: closest.b,
        }
    }

    /// Measures between whole shapes, apart or in each other.
    fn whole(&mut self, a: &dyn Support, b: &dyn Support) -> GeomDistance {
        let (shape, limits, mut simplex) = (MinkowskiDifference { a, b }, self.limits(0.0), Simplex::default());
        let closest = gjk(&shape, self.a.pos, self.b.pos, &limits, &mut simplex);
        if closest.distance > limits.tolerance || simplex.len < 2 {
            return GeomDistance {
                dist: closest.distance,
                from: closest.a,
                to: closest.b,
            };
        }
        let overlap = epa(&shape, &simplex, limits.tolerance, limits.iterations, self.polytope);
        // without a depth MuJoCo takes the geoms for touching, at no point
        overlap.map_or(
            GeomDistance {
                dist: 0.0,
                from: [0.0; 3],
                to: [0.0; 3],
            },
            |overlap| GeomDistance {
                dist: -overlap.depth,
                from: overlap.a,
                to: overlap.b,
            },
        )
    }
}
