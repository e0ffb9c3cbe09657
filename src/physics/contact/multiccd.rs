//! The contacts of a convex pair: the deepest one, and with MuJoCo's `multiccd` more of them.

use super::mesh::mesh_radius;
use super::{BareContact, ContactOptions, ContactPoint, PlacedGeom, Scratch, ccd_support, convex, faces, push, sub};
use crate::math::{Mat3, Vec3, add, mat_mul, mat_vec, norm, quat_to_mat, scale, transpose, unit};
use crate::mjcf_loader::bounding_radius;
use crate::model::GeomType;

/// Half of the angle by which geoms are tilted against each other: cosine and sine of 0.0005 rad.
const COS: f64 = 0.9999998750000026;
const SIN: f64 = 0.0004999999791666669;
/// Least distance between contacts, in bounding radii of the smaller geom.
const APART: f64 = 1e-3;

/// Appends the contacts of two convex geoms.
pub(super) fn convex(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    scratch: &mut Scratch,
    out: &mut Vec<ContactPoint>,
) {
    let (mut overlap, mut corners) = (None, [0; 2]);
    let found = if options.nativeccd {
        convex::convex(a, b, margin, options, &mut scratch.polytope, &mut overlap)
    } else {
        ccd_support::convex(a, b, margin, options, &mut corners)
    };
    let Some(touch) = found else { return };
    if options.multiccd {
        let faceted = |geom: &PlacedGeom| matches!(geom.kind, GeomType::Box | GeomType::Mesh);
        // a margin rounds the corners of faces
        if options.nativeccd && faceted(a) && faceted(b) && margin <= 0.0 {
            let points = overlap.and_then(|overlap| faces::clip(a, b, &overlap, &scratch.polytope, &mut scratch.faces));
            if let Some((points, step)) = points {
                return points.iter().for_each(|&b| push(between(b, step, touch.dist), out));
            }
        } else {
            push(Some(touch), out);
            return tilted(a, b, margin, options, (scratch, corners), out);
        }
    }
    push(Some(touch), out);
}

/// Returns the contact at a point of the second geom, a step from the first.
fn between(point: Vec3, step: Vec3, dist: f64) -> Option<BareContact> {
    let other = sub(point, step);
    Some(BareContact {
        dist,
        pos: scale(add(other, point), 0.5),
        normal: unit(sub(other, point)).0,
    })
}

/// Searches for further contacts: tilts the geoms against each other about the two tangents of the first contact, to either side, and adds
/// contacts at other places, with the distance of the first.
#[cold]
fn tilted(
    a: &PlacedGeom,
    b: &PlacedGeom,
    margin: f64,
    options: &ContactOptions,
    (scratch, mut corners): (&mut Scratch, [usize; 2]),
    out: &mut Vec<ContactPoint>,
) {
    let round = |geom: &PlacedGeom| matches!(geom.kind, GeomType::Sphere | GeomType::Ellipsoid);
    let begin = out.len() - 1;
    let ContactPoint { dist, pos, frame } = out[begin];
    // round things have one deepest point however they are tilted
    if round(a) || round(b) {
        return;
    }
    let apart = APART * radius(a).min(radius(b));
    for tangent in [[frame[3], frame[4], frame[5]], [frame[6], frame[7], frame[8]]] {
        for sin in [-SIN, SIN] {
            let [x, y, z] = scale(tangent, sin);
            let tilt = quat_to_mat([COS, x, y, z]);
            let ((pos_a, mat_a), (pos_b, mat_b)) = (turned(a, pos, &tilt), turned(b, pos, &transpose(&tilt)));
            let a = PlacedGeom {
                pos: pos_a,
                mat: &mat_a,
                ..*a
            };
            let b = PlacedGeom {
                pos: pos_b,
                mat: &mat_b,
                ..*b
            };
            let found = if options.nativeccd {
                convex::convex(&a, &b, margin, options, &mut scratch.polytope, &mut None)
            } else {
                ccd_support::convex(&a, &b, margin, options, &mut corners)
            };
            let elsewhere =
                |touch: &BareContact| out[begin..].iter().all(|known| norm(sub(known.pos, touch.pos)) > apart);
            if let Some(touch) = found.filter(elsewhere) {
                push(Some(BareContact { dist, ..touch }), out);
            }
        }
    }
}

/// Returns the pose of a geom after a rotation about a point.
fn turned(geom: &PlacedGeom, about: Vec3, turn: &Mat3) -> (Vec3, Mat3) {
    let arm = sub(about, geom.pos);
    let moved = sub(mat_vec(turn, arm), arm);
    (sub(geom.pos, moved), mat_mul(turn, geom.mat))
}

fn radius(geom: &PlacedGeom) -> f64 {
    match geom.mesh.filter(|_| geom.kind == GeomType::Mesh) {
        Some(mesh) => mesh_radius(mesh),
        None => bounding_radius(geom.kind, &geom.size),
    }
}
