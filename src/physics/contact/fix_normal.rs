//! Normals of round shapes, for contacts whose normals have errors: prisms of a height field meet them at their edges, and MPR stops at a
//! portal near their surface.

use super::{PlacedGeom, sub};
use crate::math::{MINVAL, Vec3, mat_t_vec, mat_vec, norm, scale, unit};
use crate::model::GeomType;

/// Iterations of the searches, and the change at which they end.
const ITERATIONS: usize = 30;
const TOLERANCE: f64 = 1e-6;

/// Returns the normal of a contact, which points to the second geom, at the surface of a geom that is round there, or between both normals if both
/// are round; otherwise `normal` (MuJoCo's `mjc_fixNormal`).
pub(super) fn fixed(a: &PlacedGeom, b: &PlacedGeom, pos: Vec3, normal: Vec3) -> Vec3 {
    match (outward(a, pos, normal), outward(b, pos, scale(normal, -1.0))) {
        (Some(first), Some(second)) => unit(sub(first, second)).0,
        (Some(first), None) => first,
        (None, Some(second)) => scale(second, -1.0),
        (None, None) => normal,
    }
}

/// Returns the outward normal of a geom near a point where it is round; `own` is the normal that was found.
fn outward(geom: &PlacedGeom, pos: Vec3, own: Vec3) -> Option<Vec3> {
    let at = mat_t_vec(geom.mat, sub(pos, geom.pos));
    let found = round(geom, at, mat_t_vec(geom.mat, own))?;
    Some(mat_vec(geom.mat, unit(found).0))
}

/// Returns the outward normal near a point of a round shape in its frame, of any length: that of an ellipsoid is a unit vector already, which
/// another normalisation changes in its last bits.
fn round(geom: &PlacedGeom, at: Vec3, own: Vec3) -> Option<Vec3> {
    let [a, b, _] = geom.size;
    match geom.kind {
        GeomType::Sphere => Some(at),
        GeomType::Capsule => {
            let z = match at[2] {
                z if z < -b => z + b,
                z if z > b => z - b,
                _ => 0.0,
            };
            Some([at[0], at[1], z])
        }
        GeomType::Ellipsoid if geom.size.iter().all(|&v| v >= MINVAL) => ellipsoid(at, own, geom.size),
        GeomType::Cylinder => {
            // near an end the flat side may be meant
            if at[2].abs() > 0.95 * b {
                return None;
            }
            let to_end = (b - at[2].abs()).abs();
            let to_side = (a - (at[0] * at[0] + at[1] * at[1]).sqrt()).abs();
            (to_end >= 0.25 * to_side).then_some([at[0], at[1], 0.0])
        }
        _ => None,
    }
}

fn ellipsoid(at: Vec3, own: Vec3, size: Vec3) -> Option<Vec3> {
    let square = |k: usize| size[k] * size[k];
    let reach = at[0] * at[0] / square(0) + at[1] * at[1] / square(1) + at[2] * at[2] / square(2);
    if reach <= 1.0 {
        inside(at, own, size)
    } else {
        Some(outside(at, size))
    }
}

/// Follows a ray along the normal to the surface, whose normal is the next.
fn inside(at: Vec3, own: Vec3, size: Vec3) -> Option<Vec3> {
    let weight = size.map(|s| 1.0 / (s * s));
    let form = |u: Vec3, v: Vec3| u[0] * v[0] * weight[0] + u[1] * v[1] * weight[1] + u[2] * v[2] * weight[2];
    let c = form(at, at) - 1.0;
    if c > 0.0 {
        return None;
    }
    let mut normal = unit(own).0;
    for k in 0..ITERATIONS {
        let (a, b) = (form(normal, normal), form(at, normal));
        let det = b * b - a * c;
        let moved = Some(normal).filter(|_| k > 0);
        if det < MINVAL || a < MINVAL {
            return moved;
        }
        let x = (-b + det.sqrt()) / a;
        if x < 0.0 {
            return moved;
        }
        let next = unit(std::array::from_fn(|k| (at[k] + normal[k] * x) * weight[k])).0;
        let change = norm(sub(normal, next));
        normal = next;
        if change < TOLERANCE {
            break;
        }
    }
    Some(normal)
}

/// Returns the normal at the nearest point of the surface, by Newton's method on the multiplier.
fn outside(at: Vec3, size: Vec3) -> Vec3 {
    let square = size.map(|s| s * s);
    let weighted: Vec3 = std::array::from_fn(|k| at[k] * at[k] * square[k]);
    let mut multiplier = 0.0;
    for _ in 0..ITERATIONS {
        let r = square.map(|s| 1.0 / (s + multiplier));
        let value = weighted[0] * r[0] * r[0] + weighted[1] * r[1] * r[1] + weighted[2] * r[2] * r[2] - 1.0;
        if value < TOLERANCE {
            break;
        }
        let slope = -2.0
            * (weighted[0] * r[0] * r[0] * r[0] + weighted[1] * r[1] * r[1] * r[1] + weighted[2] * r[2] * r[2] * r[2]);
        if slope > -MINVAL {
            break;
        }
        let step = -value / slope;
        if step < TOLERANCE {
            break;
        }
        multiplier += step;
    }
    unit(std::array::from_fn(|k| at[k] / (square[k] + multiplier))).0
}
