//! Pairs without their own formula, by GJK and EPA: ellipsoids and meshes with everything but planes, capsules with cylinders, cylinders with
//! cylinders and cylinders with boxes.

use super::epa::{Overlap, epa};
use super::flex_part::FlexPart;
use super::gjk::{GjkLimits, Simplex, gjk};
use super::mesh::MeshShape;
use super::polytope::Polytope;
use super::support::{Ball, Capsule, Cuboid, Cylinder, Ellipsoid, MinkowskiDifference, Point, Segment, Support};
use super::{BareContact, ContactOptions, MAXVAL, PlacedGeom, Scratch, add_scaled, column, dot, sub};
use crate::math::{MAT3_ID, Vec3, add, scale, unit};
use crate::model::GeomType;

/// Finds the deepest contact of two convex geoms, and leaves the overlap where it comes from one.
pub(super) fn convex(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    polytope: &mut Polytope,
    overlap: &mut Option<Overlap>,
) -> Option<BareContact> {
    use GeomType::{Box, Capsule as Pill, Cylinder as Rod, Ellipsoid as Egg, Mesh};
    let rod = |g| Cylinder::new(g, margin);
    let mut find = ConvexPair {
        a,
        b,
        margin,
        options,
        polytope,
        overlap,
    };
    match (a.kind, b.kind) {
        (Pill, Rod) => find.rounded(Segment::new(a), Capsule::new(a, margin), rod(b)),
        (Rod, Rod) => find.deep(rod(a), rod(b)),
        (Rod, Box) => find.deep(rod(a), Cuboid::new(b, margin)),
        (_, Egg | Mesh) | (Egg, _) => find.any(),
        _ => None,
    }
}

/// Finds the contact of a geom, anything but a plane, and a part of a flex with its shape.
pub(super) fn against(
    geom: &PlacedGeom,
    (part, shape): (&FlexPart, &dyn Support),
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
) -> Option<BareContact> {
    let mut find = ConvexPair {
        a: geom,
        b: &stand_in(part.centre),
        margin,
        options,
        polytope: &mut scratch.polytope,
        overlap: &mut None,
    };
    find.against(shape)
}

/// Finds the contact of two shapes, each with its centre.
pub(super) fn of_shapes(
    (a, centre_a): (&dyn Support, Vec3),
    (b, centre_b): (&dyn Support, Vec3),
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
) -> Option<BareContact> {
    let mut find = ConvexPair {
        a: &stand_in(centre_a),
        b: &stand_in(centre_b),
        margin,
        options,
        polytope: &mut scratch.polytope,
        overlap: &mut None,
    };
    find.deep(a, b)
}

/// Returns a geom that has only the centre of a shape.
fn stand_in(pos: Vec3) -> PlacedGeom<'static> {
    PlacedGeom {
        kind: GeomType::Sphere,
        size: [0.0; 3],
        pos,
        mat: &MAT3_ID,
        mesh: None,
        hfield: None,
    }
}

/// Two convex geoms, with the options and buffers of the search for their contact.
struct ConvexPair<'a, 'g> {
    a: &'a PlacedGeom<'g>,
    b: &'a PlacedGeom<'g>,
    margin: f64,
    options: &'a ContactOptions,
    polytope: &'a mut Polytope,
    overlap: &'a mut Option<Overlap>,
}

impl ConvexPair<'_, '_> {
    /// Finds the contact of a sphere or capsule, the set of points near its `core`: from the exact distance of the core, or, if the core is inside
    /// the other shape, from the overlap of the `whole`.
    #[inline(always)]
    fn rounded<O: Support>(&mut self, core: impl Support, whole: impl Support, other: O) -> Option<BareContact> {
        let core = MinkowskiDifference { a: core, b: other };
        match shallow(&core, self.a, self.b, self.margin, self.options) {
            CoreContact::Known(touch) => touch,
            CoreContact::Unknown => self.deep(whole, core.b),
        }
    }

    /// Finds the contact of a pair with a mesh or an ellipsoid, anything but a plane: one copy of the routines for all, since MIMo has
    /// neither.
    fn any(&mut self) -> Option<BareContact> {
        use GeomType::{Box, Cylinder as Rod, Ellipsoid as Egg, Mesh};
        let (b, margin) = (self.b, self.margin);
        let other: &dyn Support = match b.kind {
            Egg => &Ellipsoid::new(b, margin),
            Rod => &Cylinder::new(b, margin),
            Box => &Cuboid::new(b, margin),
            Mesh => &MeshShape::new(b, b.mesh?, margin),
            _ => return None,
        };
        self.against(other)
    }

    /// Finds the contact of the first geom, anything but a plane, and a shape.
    fn against(&mut self, other: &dyn Support) -> Option<BareContact> {
        use GeomType::{Box, Capsule as Pill, Cylinder as Rod, Ellipsoid as Egg, Mesh, Sphere};
        let (a, margin) = (self.a, self.margin);
        match a.kind {
            Sphere => {
                let (core, whole) = (Point::new(a), Ball::new(a, margin));
                self.rounded(&core as &dyn Support, &whole as &dyn Support, other)
            }
            Pill => {
                let (core, whole) = (Segment::new(a), Capsule::new(a, margin));
                self.rounded(&core as &dyn Support, &whole as &dyn Support, other)
            }
            Egg => self.deep(&Ellipsoid::new(a, margin) as &dyn Support, other),
            Rod => self.deep(&Cylinder::new(a, margin) as &dyn Support, other),
            Box => self.deep(&Cuboid::new(a, margin) as &dyn Support, other),
            Mesh => self.deep(&MeshShape::new(a, a.mesh?, margin) as &dyn Support, other),
            GeomType::Plane | GeomType::HField => None,
        }
    }

    /// Finds the overlap of two shapes.
    #[inline(always)]
    fn deep(&mut self, a: impl Support, b: impl Support) -> Option<BareContact> {
        let shape = MinkowskiDifference { a, b };
        let found = deep(&shape, self.a, self.b, self.options, self.polytope)?;
        *self.overlap = found;
        match found {
            Some(overlap) => touch(-overlap.depth, overlap.a, overlap.b, self.margin),
            None => least_overlap_of_axes(&shape, self.a, self.b, self.margin),
        }
    }
}

/// The result of GJK between the core of a sphere or capsule (its centre or segment) and the other shape.
enum CoreContact {
    /// The core is outside: the contact, if there is one.
    Known(Option<BareContact>),
    /// The core itself touches the other shape.
    Unknown,
}

/// Finds the contact of a sphere or capsule whose core is outside the other shape: the distance from the core minus the radius.
fn shallow<A: Support, B: Support>(
    core: &MinkowskiDifference<A, B>,
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
) -> CoreContact {
    let radius = a.size[0] + 0.5 * margin;
    let limits = GjkLimits {
        tolerance: options.ccd_tolerance,
        iterations: options.ccd_iterations,
        cutoff: radius,
        stop_at_same_centre: options.quirks.same_centre_is_no_contact,
    };
    let closest = gjk(core, a.pos, b.pos, &limits, &mut Simplex::default());
    let outside = closest.distance > options.ccd_tolerance;
    if !outside {
        return CoreContact::Unknown;
    }
    if closest.distance >= MAXVAL {
        return CoreContact::Known(None);
    }
    let (towards, _) = unit(sub(closest.b, closest.a));
    let surface = add_scaled(closest.a, towards, radius);
    CoreContact::Known(touch(closest.distance - radius, surface, closest.b, margin))
}

/// Finds the overlap of two shapes, by GJK and EPA. Returns `Some(None)`, still a contact, if they overlap but EPA finds no depth.
fn deep<A: Support, B: Support>(
    shape: &MinkowskiDifference<A, B>,
    a: &PlacedGeom,
    b: &PlacedGeom,
    options: &ContactOptions,
    polytope: &mut Polytope,
) -> Option<Option<Overlap>> {
    let limits = GjkLimits {
        tolerance: options.ccd_tolerance,
        iterations: options.ccd_iterations,
        cutoff: 0.0,
        stop_at_same_centre: options.quirks.same_centre_is_no_contact,
    };
    let mut simplex = Simplex::default();
    let closest = gjk(shape, a.pos, b.pos, &limits, &mut simplex);
    let overlapping = closest.distance <= limits.tolerance && simplex.len >= 2;
    if !overlapping {
        return None;
    }
    match epa(shape, &simplex, limits.tolerance, limits.iterations, polytope) {
        None if options.quirks.failed_depth_is_no_contact => None,
        found => Some(found),
    }
}

/// Creates a contact from the signed distance of the grown shapes and the nearest or deepest point of either.
fn touch(dist: f64, point_a: Vec3, point_b: Vec3, margin: f64) -> Option<BareContact> {
    (dist < 0.0).then(|| BareContact {
        dist: margin + dist,
        pos: scale(add(point_a, point_b), 0.5),
        normal: unit(sub(point_a, point_b)).0,
    })
}

/// Replaces EPA: the least overlap along the axes of both geoms and the line of centres. The position is halfway
/// between the two support planes, next to the middle of the centres.
fn least_overlap_of_axes<A: Support, B: Support>(
    shape: &MinkowskiDifference<A, B>,
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
) -> Option<BareContact> {
    let axes = [0, 1, 2].map(|k| column(a.mat, k));
    let others = [0, 1, 2].map(|k| column(b.mat, k));
    let line = unit(sub(b.pos, a.pos)).0;
    let mut least: Option<(f64, BareContact)> = None;
    for axis in axes.into_iter().chain(others).chain([line]) {
        for normal in [axis, scale(axis, -1.0)] {
            let vertex = shape.support(normal);
            let depth = dot(vertex.point, normal);
            let better = depth > 0.0 && least.is_none_or(|(best, _)| depth < best);
            if !better {
                continue;
            }
            let middle = scale(add(a.pos, b.pos), 0.5);
            let height = 0.5 * (dot(vertex.a, normal) + dot(vertex.b, normal));
            let pos = add_scaled(middle, normal, height - dot(middle, normal));
            let dist = margin - depth;
            least = Some((depth, BareContact { dist, pos, normal }));
        }
    }
    least.map(|(_, touch)| touch)
}
