//! Pairs without a formula of their own: capsules with cylinders, cylinders with cylinders and cylinders with boxes.

use super::epa::epa;
use super::gjk::{Limits, Simplex, gjk};
use super::polytope::Polytope;
use super::support::{Capsule, Cuboid, Cylinder, Difference, Segment, Support};
use super::{BIG, BareContact, ContactOptions, PlacedGeom, add_scaled, column, dot, sub};
use crate::math::{Vec3, add, scale, unit};
use crate::model::GeomType;

/// Finds the contact of two convex geoms, at most one.
pub(super) fn convex(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    polytope: &mut Polytope,
) -> Option<BareContact> {
    let cylinder = |geom| Cylinder::new(geom, margin);
    match (a.kind, b.kind) {
        (GeomType::Capsule, GeomType::Cylinder) => {
            let core = Difference {
                a: Segment::new(a),
                b: cylinder(b),
            };
            if let Shallow::Known(touch) = shallow(&core, a, b, margin, options) {
                return touch;
            }
            let whole = Difference {
                a: Capsule::new(a, margin),
                b: cylinder(b),
            };
            deep(&whole, a, b, margin, options, polytope)
        }
        (GeomType::Cylinder, GeomType::Cylinder) => {
            let shape = Difference {
                a: cylinder(a),
                b: cylinder(b),
            };
            deep(&shape, a, b, margin, options, polytope)
        }
        (GeomType::Cylinder, GeomType::Box) => {
            let shape = Difference {
                a: cylinder(a),
                b: Cuboid::new(b, margin),
            };
            deep(&shape, a, b, margin, options, polytope)
        }
        _ => None,
    }
}

/// The distance between a capsule's segment and the other shape.
enum Shallow {
    /// The segment is outside: the contact, if there is one.
    Known(Option<BareContact>),
    /// The segment itself touches the other shape.
    Unknown,
}

/// Finds the contact of a capsule whose segment is outside the other shape: the distance from the segment less the
/// radius.
fn shallow<A: Support, B: Support>(
    core: &Difference<A, B>,
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
) -> Shallow {
    let radius = a.size[0] + 0.5 * margin;
    let limits = Limits {
        tolerance: options.ccd_tolerance,
        iterations: options.ccd_iterations,
        cutoff: radius,
        stop_at_same_centre: options.quirks.same_centre_is_no_contact,
    };
    let closest = gjk(core, a.pos, b.pos, &limits, &mut Simplex::default());
    let outside = closest.distance > options.ccd_tolerance;
    if !outside {
        return Shallow::Unknown;
    }
    if closest.distance >= BIG {
        return Shallow::Known(None);
    }
    let (towards, _) = unit(sub(closest.b, closest.a));
    let surface = add_scaled(closest.a, towards, radius);
    Shallow::Known(touch(closest.distance - radius, surface, closest.b, margin))
}

/// Finds the overlap of two shapes, by GJK and EPA.
fn deep<A: Support, B: Support>(
    shape: &Difference<A, B>,
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    polytope: &mut Polytope,
) -> Option<BareContact> {
    let limits = Limits {
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
        Some(overlap) => touch(-overlap.depth, overlap.a, overlap.b, margin),
        None if options.quirks.failed_depth_is_no_contact => None,
        None => least_overlap_of_axes(shape, a, b, margin),
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

/// Stands in for EPA: the least overlap along the axes of both geoms and the line of centres. The position is halfway
/// between the two support planes, next to the middle of the centres.
fn least_overlap_of_axes<A: Support, B: Support>(
    shape: &Difference<A, B>,
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
