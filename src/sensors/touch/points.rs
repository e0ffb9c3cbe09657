//! Sensor positions on a single geom: points on its surface at a given spacing.
//!
//! The formulas are those of MIMo's meshes, point by point and in their order, so that sensor `i` here is sensor `i`
//! there.

use std::collections::BTreeSet;

use crate::math::Vec3;
use crate::model::GeomType;

/// Places points on the surface of a geom, in its frame, m, about `spacing` (m, > 0) apart.
///
/// A geom that is small against the spacing has a single point, its centre. A plane has none.
pub fn surface_points(kind: GeomType, size: Vec3, spacing: f64) -> Vec<Vec3> {
    match kind {
        // a skin refuses meshes before it places points
        GeomType::Plane | GeomType::HField | GeomType::Mesh => Vec::new(),
        GeomType::Sphere => ellipsoid([size[0]; 3], spacing),
        GeomType::Ellipsoid => ellipsoid(size, spacing),
        GeomType::Box => cuboid(size, spacing),
        GeomType::Capsule => capsule(size[0], 2.0 * size[1], spacing),
        GeomType::Cylinder => cylinder(size[0], 2.0 * size[1], spacing),
    }
}

/// Estimates the number of points that [`surface_points`] makes, never less than a quarter of it.
pub(super) fn estimate(kind: GeomType, size: Vec3, spacing: f64) -> f64 {
    let half = match kind {
        GeomType::Plane | GeomType::HField | GeomType::Mesh => return 0.0,
        GeomType::Sphere => [size[0]; 3],
        GeomType::Ellipsoid | GeomType::Box => size,
        GeomType::Capsule => [size[0], size[0], size[0] + size[1]],
        GeomType::Cylinder => [size[0], size[0], size[1]],
    };
    let [a, b, c] = half.map(|h| 2.0 * h / spacing + 1.0);
    2.0 * (a * b + b * c + c * a)
}

const CENTRE: Vec3 = [0.0; 3];

/// Keeps only the first of points that agree to 1e-8 m, and their order.
fn dedupe(points: Vec<Vec3>) -> Vec<Vec3> {
    // caps repeat the last ring of the wall, faces of a box share their edges
    let mut seen = BTreeSet::new();
    let key = |p: &Vec3| p.map(|x| (x * 1e8).round_ties_even() as i64);
    points.into_iter().filter(|p| seen.insert(key(p))).collect()
}

/// Appends `count` points on a circle about the z axis.
fn ring(radius: f64, count: usize, z: f64, out: &mut Vec<Vec3>) {
    for j in 0..count {
        let (s, c) = pxfm::f_sincos(2.0 * std::f64::consts::PI * j as f64 / count as f64);
        out.push([radius * c, radius * s, z]);
    }
}

/// Converts a quotient that is already rounded to a count.
fn count(x: f64) -> usize {
    x as usize
}

/// Returns `n >= 2` equally spaced values from `a` to `b`.
fn linspace(a: f64, b: f64, n: usize) -> Vec<f64> {
    let step = (b - a) / (n - 1) as f64;
    (0..n)
        .map(|i| if i + 1 == n { b } else { a + i as f64 * step })
        .collect()
}

fn cuboid(half: Vec3, spacing: f64) -> Vec<Vec3> {
    if 0.75 * spacing > half[0].max(half[1]).max(half[2]) {
        return vec![CENTRE];
    }
    let grid = half.map(|h| linspace(-h, h, count((2.0 * h / spacing).ceil()).max(2)));
    let mut points = Vec::new();
    for axis in 0..3 {
        let (outer, inner) = ([1, 0, 0][axis], [2, 2, 1][axis]);
        for side in [-half[axis], half[axis]] {
            for &u in &grid[outer] {
                for &v in &grid[inner] {
                    let mut p = CENTRE;
                    (p[axis], p[outer], p[inner]) = (side, u, v);
                    points.push(p);
                }
            }
        }
    }
    dedupe(points)
}

fn ellipsoid(radii: Vec3, spacing: f64) -> Vec<Vec3> {
    let r = radii[0].max(radii[1]).max(radii[2]);
    if spacing > r {
        return vec![CENTRE];
    }
    let rings = count((std::f64::consts::PI * r / spacing).ceil());
    let mut points = Vec::new();
    for i in 0..rings {
        let (s, c) = pxfm::f_sincos((i as f64 + 0.5) * std::f64::consts::PI / rings as f64);
        let n = count((2.0 * std::f64::consts::PI * s * r / spacing).round_ties_even());
        ring(r * s, n, r * c, &mut points);
    }
    if radii != [r; 3] {
        for p in &mut points {
            *p = std::array::from_fn(|k| p[k] * (radii[k] / r));
        }
    }
    points
}

/// Appends the wall of a capsule or cylinder: rings from bottom to top.
fn pipe(r: f64, length: f64, around: usize, spacing: f64, out: &mut Vec<Vec3>) {
    let rows = count((length / spacing).ceil()) + 1;
    for i in 0..rows {
        let up = if rows > 1 {
            i as f64 * length / (rows - 1) as f64
        } else {
            0.0
        };
        ring(r, around, up - length / 2.0, out);
    }
}

fn capsule(r: f64, length: f64, spacing: f64) -> Vec<Vec3> {
    let around = count((2.0 * std::f64::consts::PI * r / spacing).ceil());
    if around < 3 {
        return vec![CENTRE];
    }
    let mut points = Vec::new();
    pipe(r, length, around, spacing, &mut points);
    let mut cap = Vec::new();
    let rings = count((std::f64::consts::PI * r / (2.0 * spacing)).ceil());
    for i in 0..=rings {
        let (s, c) = pxfm::f_sincos(i as f64 * std::f64::consts::PI / (2.0 * rings as f64));
        let n = count((2.0 * std::f64::consts::PI * s * r / spacing).ceil());
        if n < 2 {
            cap.push([0.0, 0.0, length / 2.0 + r]);
        } else {
            ring(r * s, n, r * c + length / 2.0, &mut cap);
        }
    }
    points.extend_from_slice(&cap);
    points.extend(cap.iter().map(|p| [p[0], p[1], -p[2]]));
    dedupe(points)
}

fn cylinder(r: f64, length: f64, spacing: f64) -> Vec<Vec3> {
    let rows = count((length / spacing).ceil());
    let around = count((2.0 * std::f64::consts::PI * r / spacing).ceil());
    let radii = count((r / spacing).round_ties_even()) + 1;
    if around < 3 || rows < 2 || radii == 1 {
        return vec![CENTRE];
    }
    let mut points = Vec::new();
    pipe(r, length, around, spacing, &mut points);
    for z in [length / 2.0, -length / 2.0] {
        points.push([0.0, 0.0, z]);
        for &rho in &linspace(0.0, r, radii)[1..] {
            let n = count((2.0 * std::f64::consts::PI * rho / spacing).ceil());
            ring(rho, n, z, &mut points);
        }
    }
    dedupe(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the numbers of points with those of MIMo's own meshes.
    #[test]
    fn counts_are_those_of_the_reference() {
        for (kind, size, spacing, expect) in [
            (GeomType::Box, [0.0228, 0.01, 0.0207], 0.002, 1638),
            (GeomType::Cylinder, [0.0102, 0.023, 0.0], 0.002, 926),
            (GeomType::Sphere, [0.0735, 0.0, 0.0], 0.013, 404),
            (GeomType::Capsule, [0.048, 0.043, 0.0], 0.025, 119),
            (GeomType::Capsule, [0.021, 0.028, 0.0], 0.038, 14),
            (GeomType::Sphere, [0.01125, 0.0, 0.0], 1.0, 1),
            (GeomType::Plane, [1.0; 3], 0.1, 0),
        ] {
            let points = surface_points(kind, size, spacing);
            assert_eq!(points.len(), expect, "{kind:?} {size:?}");
            assert!(estimate(kind, size, spacing) * 4.0 >= expect as f64);
        }
    }

    #[test]
    fn points_lie_on_the_surface() {
        let radii = [0.03, 0.05, 0.02];
        for p in surface_points(GeomType::Ellipsoid, radii, 0.007) {
            let one: f64 = p.iter().zip(radii).map(|(x, r)| (x / r) * (x / r)).sum();
            assert!((one - 1.0).abs() < 1e-12);
        }
        for p in surface_points(GeomType::Capsule, [0.03, 0.05, 0.0], 0.007) {
            let z = (p[2].abs() - 0.05).max(0.0);
            assert!(((p[0] * p[0] + p[1] * p[1] + z * z).sqrt() - 0.03).abs() < 1e-15);
        }
    }
}
