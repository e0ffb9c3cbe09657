//! Rays against shapes.

use crate::math::*;
use crate::model::{GeomType, Mesh, Model};
use crate::physics::state::State;

/// Returns the nearest geom that a ray meets, and its distance in lengths of `direction`, leaving out the geoms of one body and
/// those that are invisible (MuJoCo's `mj_ray`).
pub(super) fn nearest_geom(
    model: &Model,
    s: &State,
    origin: Vec3,
    direction: Vec3,
    without_body: usize,
) -> Option<(usize, f64)> {
    let mut nearest: Option<(usize, f64)> = None;
    for g in 0..model.ngeom() {
        let opacity = match model.geom_matid[g] {
            Some(material) => model.geom_rgba[g][3].max(model.materials[material].rgba[3]),
            None => model.geom_rgba[g][3],
        };
        if model.geom_bodyid[g] == without_body || opacity == 0.0 {
            continue;
        }
        let (pos, mat, size) = (s.geom_xpos[g], &s.geom_xmat[g], s.params.geom_size[g]);
        let found = match model.geom_dataid[g].and_then(|mesh| model.meshes.get(mesh)) {
            Some(mesh) if model.geom_type[g] == GeomType::Mesh => {
                let radius = s.params.geom_rbound[g];
                ray_mesh(
                    mesh,
                    radius,
                    mat_t_vec(mat, sub(origin, pos)),
                    mat_t_vec(mat, direction),
                )
            }
            _ => ray_shape(model.geom_type[g], size, pos, mat, origin, direction),
        };
        if let Some(distance) = found
            && nearest.is_none_or(|(_, least)| distance < least)
        {
            nearest = Some((g, distance));
        }
    }
    nearest
}

/// Returns the distance at which a ray meets a shape, in lengths of `direction`; from inside, that at which it leaves.
pub(super) fn ray_shape(
    kind: GeomType,
    size: Vec3,
    pos: Vec3,
    mat: &Mat3,
    origin: Vec3,
    direction: Vec3,
) -> Option<f64> {
    let (p, v) = (mat_t_vec(mat, sub(origin, pos)), mat_t_vec(mat, direction));
    match kind {
        GeomType::Plane => plane(size, p, v),
        GeomType::Sphere => first(quadratic(dot(v, v), dot(v, p), dot(p, p) - size[0] * size[0])),
        GeomType::Capsule => capsule(size, p, v),
        GeomType::Ellipsoid => {
            let weight = size.map(|r| 1.0 / (r * r));
            let form = |a: Vec3, b: Vec3| (0..3).map(|k| weight[k] * a[k] * b[k]).sum::<f64>();
            first(quadratic(form(v, v), form(v, p), form(p, p) - 1.0))
        }
        GeomType::Cylinder => cylinder(size, p, v),
        GeomType::Box => cuboid(size, p, v),
        // its triangles are with the model, and no site is one; models with height fields have no rays
        GeomType::HField | GeomType::Mesh => None,
    }
}

/// Returns the distance at which a ray meets a triangle of a mesh, from either side.
fn ray_mesh(mesh: &Mesh, radius: f64, p: Vec3, v: Vec3) -> Option<f64> {
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - radius * radius))?;
    // two directions across the ray
    let along = unit(v).0;
    let axis = (0..3).fold(
        0,
        |least, k| if along[k].abs() < along[least].abs() { k } else { least },
    );
    let mut e = [0.0; 3];
    e[axis] = 1.0;
    let across = unit(cross(along, e)).0;
    let basis = [across, cross(along, across)];
    let mut nearest = None;
    for corners in &mesh.face {
        let corner = |k: usize| mesh.vert.get(corners[k] as usize).map(|v| sub(v.map(f64::from), p));
        if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2))
            && let Some(x) = ray_triangle([a, b, c], v, &basis)
        {
            keep(&mut nearest, x);
        }
    }
    nearest
}

/// Returns the distance at which a ray from the origin meets a triangle; `basis` is across the ray.
fn ray_triangle([a, b, c]: [Vec3; 3], v: Vec3, basis: &[Vec3; 2]) -> Option<f64> {
    let plane = |p: Vec3| basis.map(|axis| dot(p, axis));
    let (pa, pb, pc) = (plane(a), plane(b), plane(c));
    for k in 0..2 {
        let all = [pa[k], pb[k], pc[k]];
        if all.iter().all(|x| *x > 0.0) || all.iter().all(|x| *x < 0.0) {
            return None;
        }
    }
    // the origin as a mean of the corners
    let (x, y) = ([pa[0] - pc[0], pa[1] - pc[1]], [pb[0] - pc[0], pb[1] - pc[1]]);
    let det = x[0] * y[1] - x[1] * y[0];
    if det.abs() < MINVAL {
        return None;
    }
    let (s, t) = ((y[0] * pc[1] - y[1] * pc[0]) / det, (x[1] * pc[0] - x[0] * pc[1]) / det);
    if s < 0.0 || t < 0.0 || s + t > 1.0 {
        return None;
    }
    let normal = cross(sub(a, c), sub(b, c));
    let slope = dot(v, normal);
    if slope.abs() < MINVAL {
        return None;
    }
    Some(dot(c, normal) / slope).filter(|x| *x >= 0.0)
}

/// Solves `a x^2 + 2 b x + c = 0`: both solutions, ascending.
fn quadratic(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = b * b - a * c;
    if discriminant < MINVAL {
        return None;
    }
    let root = discriminant.sqrt();
    Some([(-b - root) / a, (-b + root) / a])
}

/// Returns the first solution that lies ahead.
fn first(solutions: Option<[f64; 2]>) -> Option<f64> {
    solutions?.into_iter().find(|x| *x >= 0.0)
}

/// Keeps the lesser of two distances.
fn keep(nearest: &mut Option<f64>, x: f64) {
    if nearest.is_none_or(|least| x < least) {
        *nearest = Some(x);
    }
}

fn plane(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    // it is seen from above only
    if v[2] > -MINVAL {
        return None;
    }
    let x = -p[2] / v[2];
    let within = |k: usize| size[k] <= 0.0 || (p[k] + x * v[k]).abs() <= size[k];
    (x >= 0.0 && within(0) && within(1)).then_some(x)
}

/// Returns where a ray meets the round side of a cylinder without ends.
fn round_side(radius: f64, p: Vec3, v: Vec3) -> Option<f64> {
    let a = v[0] * v[0] + v[1] * v[1];
    let b = v[0] * p[0] + v[1] * p[1];
    first(quadratic(a, b, p[0] * p[0] + p[1] * p[1] - radius * radius))
}

fn capsule(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    let reach = size[0] + size[1];
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - reach * reach))?;
    let mut nearest = round_side(size[0], p, v).filter(|x| (p[2] + x * v[2]).abs() <= size[1]);
    for side in [1.0, -1.0] {
        let from = [p[0], p[1], p[2] - side * size[1]];
        let met = quadratic(dot(v, v), dot(v, from), dot(from, from) - size[0] * size[0]);
        for x in met.into_iter().flatten() {
            // the outer half of the cap
            if x >= 0.0 && side * (p[2] + x * v[2]) >= size[1] {
                keep(&mut nearest, x);
            }
        }
    }
    nearest
}

fn cylinder(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    let reach = size[0] * size[0] + size[1] * size[1];
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - reach))?;
    let mut nearest = None;
    if v[2].abs() > MINVAL {
        for side in [-1.0, 1.0] {
            let x = (side * size[1] - p[2]) / v[2];
            let (a, b) = (p[0] + x * v[0], p[1] + x * v[1]);
            if x >= 0.0 && a * a + b * b <= size[0] * size[0] {
                keep(&mut nearest, x);
            }
        }
    }
    if let Some(x) = round_side(size[0], p, v).filter(|x| (p[2] + x * v[2]).abs() <= size[1]) {
        keep(&mut nearest, x);
    }
    nearest
}

fn cuboid(size: Vec3, p: Vec3, v: Vec3) -> Option<f64> {
    first(quadratic(dot(v, v), dot(v, p), dot(p, p) - dot(size, size)))?;
    let mut nearest = None;
    for k in (0..3).filter(|&k| v[k].abs() > MINVAL) {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        for side in [-1.0, 1.0] {
            let x = (side * size[k] - p[k]) / v[k];
            if x >= 0.0 && (p[i] + x * v[i]).abs() <= size[i] && (p[j] + x * v[j]).abs() <= size[j] {
                keep(&mut nearest, x);
            }
        }
    }
    nearest
}
