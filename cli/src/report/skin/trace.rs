//! Intersections of rays and geoms, for the picture of the skin.

use babybench::math::*;
use babybench::model::GeomType;

/// Casts the ray from `o` in direction `d` (unit); returns the distance to the geom, m, and the outward unit normal
/// there, all in the geom's frame. The ray must start outside. Planes are ignored.
pub(super) fn trace(kind: GeomType, size: Vec3, o: Vec3, d: Vec3) -> Option<(f64, Vec3)> {
    match kind {
        GeomType::Plane | GeomType::HField | GeomType::Mesh => None,
        GeomType::Sphere => ellipsoid([size[0]; 3], o, d),
        GeomType::Ellipsoid => ellipsoid(size, o, d),
        GeomType::Box => cuboid(size, o, d),
        GeomType::Cylinder => nearer(wall(size[0], size[1], o, d), lids(size[0], size[1], o, d)),
        GeomType::Capsule => {
            let end = |z: f64| ellipsoid([size[0]; 3], [o[0], o[1], o[2] - z], d);
            nearer(wall(size[0], size[1], o, d), nearer(end(size[1]), end(-size[1])))
        }
    }
}

type Hit = Option<(f64, Vec3)>;

fn nearer(a: Hit, b: Hit) -> Hit {
    match (a, b) {
        (Some(x), Some(y)) => Some(if x.0 <= y.0 { x } else { y }),
        (a, b) => a.or(b),
    }
}

/// Returns the smaller root of `a t^2 + 2 b t + c`.
fn entry(a: f64, b: f64, c: f64) -> Option<f64> {
    let root = b * b - a * c;
    (a > 0.0 && root >= 0.0).then(|| (-b - root.sqrt()) / a)
}

fn ellipsoid(radii: Vec3, o: Vec3, d: Vec3) -> Hit {
    let by_radius = |v: Vec3| -> Vec3 { std::array::from_fn(|k| v[k] / radii[k]) };
    let (p, q) = (by_radius(o), by_radius(d));
    let t = entry(dot(q, q), dot(p, q), dot(p, p) - 1.0)?;
    Some((t, unit(by_radius(add_scaled(p, q, t))).0))
}

fn cuboid(half: Vec3, o: Vec3, d: Vec3) -> Hit {
    let (mut enter, mut leave, mut face) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for k in 0..3 {
        if d[k] == 0.0 {
            if o[k].abs() > half[k] {
                return None;
            }
            continue;
        }
        let near = (-half[k].copysign(d[k]) - o[k]) / d[k];
        if near > enter {
            (enter, face) = (near, k);
        }
        leave = leave.min((half[k].copysign(d[k]) - o[k]) / d[k]);
    }
    let mut normal = [0.0; 3];
    normal[face] = -1.0_f64.copysign(d[face]);
    (enter <= leave).then_some((enter, normal))
}

/// Intersects the round side of a cylinder.
fn wall(r: f64, half: f64, o: Vec3, d: Vec3) -> Hit {
    let flat = |v: Vec3, w: Vec3| v[0] * w[0] + v[1] * w[1];
    let t = entry(flat(d, d), flat(o, d), flat(o, o) - r * r)?;
    let p = add_scaled(o, d, t);
    (p[2].abs() <= half).then_some((t, [p[0] / r, p[1] / r, 0.0]))
}

/// Intersects the flat side of a cylinder that faces the ray.
fn lids(r: f64, half: f64, o: Vec3, d: Vec3) -> Hit {
    if d[2] == 0.0 {
        return None;
    }
    let up = -1.0_f64.copysign(d[2]);
    let t = (up * half - o[2]) / d[2];
    let p = add_scaled(o, d, t);
    (p[0] * p[0] + p[1] * p[1] <= r * r).then_some((t, [0.0, 0.0, up]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use babybench::sensors::touch::surface_points;
    use babybench::spaces::NumpyRng;

    #[test]
    fn rays_at_sensor_points_end_there_or_before() {
        let mut rng = NumpyRng::seed(2);
        for (kind, size) in [
            (GeomType::Sphere, [0.05, 0.0, 0.0]),
            (GeomType::Ellipsoid, [0.03, 0.05, 0.02]),
            (GeomType::Box, [0.03, 0.05, 0.02]),
            (GeomType::Cylinder, [0.03, 0.05, 0.0]),
            (GeomType::Capsule, [0.03, 0.05, 0.0]),
        ] {
            let mut met = 0;
            for p in surface_points(kind, size, 0.01) {
                let d = unit(std::array::from_fn(|_| rng.uniform() - 0.5)).0;
                let o = add_scaled(p, d, -1.0);
                // the edges of a body may be missed by rounding
                let Some((t, normal)) = trace(kind, size, o, d) else {
                    continue;
                };
                assert!(t < 1.0 + 1e-9, "{kind:?}");
                assert!((norm(normal) - 1.0).abs() < 1e-9 && dot(normal, d) < 1e-9);
                met += usize::from((t - 1.0).abs() < 1e-9);
            }
            assert!(met > 20, "{kind:?}: {met}");
        }
    }
}
