//! Contacts of the elements and vertices of flexes: rounded points, lines, triangles and tetrahedra.

use super::flex_part::FlexPart;
use super::hfield::hfield_flex;
use super::mpr::{MprLimits, mpr};
use super::support::Support;
use super::{
    BareContact, ContactOptions, ContactPoint, PlacedGeom, Scratch, ccd_support, collide, convex, frame, push,
};
use crate::math::*;
use crate::model::GeomType;

/// Appends the contacts of a geom, anything but a plane, and an element. The normal points to the element.
#[doc(alias = "mj_collideGeomElem")]
pub fn geom_element(
    geom: &PlacedGeom,
    element: &FlexPart,
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
    out: &mut Vec<ContactPoint>,
) {
    let mut mat = MAT3_ID;
    match (geom.kind, element.count) {
        (GeomType::Sphere | GeomType::Capsule, 2) => {
            collide(geom, &element.capsule(&mut mat), margin, options, scratch, out);
        }
        (GeomType::Box, 2) => {
            let first = out.len();
            collide(&element.capsule(&mut mat), geom, margin, options, scratch, out);
            for contact in &mut out[first..] {
                contact.frame = frame::of_unit(scale(contact.normal(), -1.0));
            }
        }
        (GeomType::HField, _) => hfield_flex(geom, element, margin, options, &mut scratch.polytope, out),
        (GeomType::Sphere, 3) => push(sphere_triangle(geom.pos, geom.size[0], element, margin), out),
        _ => {
            let found = if options.nativeccd {
                convex::against(geom, (element, &element.grown(0.5 * margin)), margin, options, scratch)
            } else {
                let shape = ccd_support::CcdSupport::new(geom, margin, 0);
                let usable = geom.kind != GeomType::Mesh || geom.mesh.is_some();
                usable
                    .then(|| portal((&shape, geom.pos), element, margin, options))
                    .flatten()
            };
            push(found, out);
        }
    }
}

/// Appends the contacts of two elements. The normal points to the second.
#[doc(alias = "mj_collideElems")]
pub fn element_element(
    a: &FlexPart,
    b: &FlexPart,
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
    out: &mut Vec<ContactPoint>,
) {
    if a.count == 2 && b.count == 2 {
        let (mut first, mut second) = (MAT3_ID, MAT3_ID);
        return collide(
            &a.capsule(&mut first),
            &b.capsule(&mut second),
            margin,
            options,
            scratch,
            out,
        );
    }
    push(parts(a, b, margin, options, scratch), out);
}

/// Appends the contact of a vertex and an element of one flex. The normal points to the element.
#[doc(alias = "mj_collideElemVert")]
pub fn vertex_element(
    vertex: &FlexPart,
    element: &FlexPart,
    options: &ContactOptions,
    scratch: &mut Scratch,
    out: &mut Vec<ContactPoint>,
) {
    let mut mat = MAT3_ID;
    match element.count {
        2 => collide(&vertex.sphere(), &element.capsule(&mut mat), 0.0, options, scratch, out),
        3 => push(sphere_triangle(vertex.points[0], vertex.radius, element, 0.0), out),
        _ => push(parts(vertex, element, 0.0, options, scratch), out),
    }
}

/// Finds the contact of two parts of flexes by the routine for all convex shapes.
fn parts(
    a: &FlexPart,
    b: &FlexPart,
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
) -> Option<BareContact> {
    let (first, second) = (a.grown(0.5 * margin), b.grown(0.5 * margin));
    if options.nativeccd {
        convex::of_shapes((&first, a.centre), (&second, b.centre), margin, options, scratch)
    } else {
        portal((&first, a.centre), b, margin, options)
    }
}

/// Finds the contact of a shape and a part of a flex by MPR.
fn portal(first: (&dyn Support, Vec3), part: &FlexPart, margin: f64, options: &ContactOptions) -> Option<BareContact> {
    let limits = MprLimits {
        tolerance: options.ccd_tolerance,
        iterations: options.ccd_iterations,
    };
    let found = mpr(first, (&part.grown(0.5 * margin), part.centre), &limits)?;
    Some(BareContact {
        dist: margin - found.depth,
        pos: found.pos,
        normal: found.dir,
    })
}

/// Finds the contact of a sphere and the nearest point of a rounded triangle.
fn sphere_triangle(centre: Vec3, radius: f64, triangle: &FlexPart, margin: f64) -> Option<BareContact> {
    let [origin, a, b, _] = triangle.points;
    let reach = margin + radius + triangle.radius;
    let (s, a, b) = (sub(centre, origin), sub(a, origin), sub(b, origin));
    let normal = unit(cross(a, b)).0;
    let height = dot(normal, s);
    if height.abs() > reach {
        return None;
    }
    let projection = add_scaled(s, normal, -height);
    // axes in the plane of the triangle
    let (x, length) = unit(a);
    let y = unit(cross(normal, a)).0;
    let place = |p: Vec3| [dot(x, p), dot(y, p)];
    let corners = [[0.0, 0.0], [length, 0.0], place(b)];
    let p = place(projection);
    let edges = [[0, 1], [1, 2], [2, 0]].map(|ends: [usize; 2]| ends.map(|k| corners[k]));
    let side = |[u, v]: [[f64; 2]; 2]| {
        let area = (p[0] - v[0]) * (u[1] - v[1]) - (u[0] - v[0]) * (p[1] - v[1]);
        i8::from(area > 0.0) - i8::from(area < 0.0)
    };
    let sides = edges.map(side);
    let nearest = if sides[0] == sides[1] && sides[1] == sides[2] {
        projection
    } else {
        let on = edges.map(|edge| nearest_on_segment(p, edge));
        let best = if on[0].1 < on[1].1 && on[0].1 < on[2].1 {
            0
        } else if on[1].1 < on[2].1 {
            1
        } else {
            2
        };
        add_scaled(scale(x, on[best].0[0]), y, on[best].0[1])
    };
    let (normal, distance) = unit(sub(nearest, s));
    if distance > reach {
        return None;
    }
    let dist = distance - radius - triangle.radius;
    Some(BareContact {
        dist,
        pos: add_scaled(centre, normal, radius + dist / 2.0),
        normal,
    })
}

/// Returns the point of a segment in the plane that is nearest to another, and its distance.
fn nearest_on_segment(p: [f64; 2], [u, v]: [[f64; 2]; 2]) -> ([f64; 2], f64) {
    let (along, to) = ([v[0] - u[0], v[1] - u[1]], [p[0] - u[0], p[1] - u[1]]);
    let product = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let share = product(along, to) / product(along, along).max(MINVAL);
    let nearest = if share <= 0.0 {
        u
    } else if share >= 1.0 {
        v
    } else {
        [u[0] + along[0] * share, u[1] + along[1] * share]
    };
    let apart = [nearest[0] - p[0], nearest[1] - p[1]];
    (nearest, product(apart, apart).sqrt())
}
