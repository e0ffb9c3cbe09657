//! The elasticity of an element as a metric of its squared edge lengths: a membrane of triangles, or a solid of tetrahedra, of Saint
//! Venant and Kirchhoff's material. The strain of an element is a sum over its edges of changes of squared length times a symmetric
//! product of the normals of the sides that the edge does not touch (Weischedel, "A discrete geometric view on shear-deformable shell models",
//! section 4.1).

use crate::compile::normalize;
use crate::flex::Elasticity;
use crate::math::{Mat3, Vec3, cross, dot, sub};

/// Returns a metric of triangles with a thickness.
pub(super) fn triangle(x: [Vec3; 3], material: &Elasticity) -> [f64; 21] {
    let mut normal = cross(sub(x[1], x[0]), sub(x[2], x[0]));
    let area = normalize(&mut normal) / 2.0;
    // the two other edges of each edge
    let sides = [[1, 2], [2, 0], [0, 1]];
    let basis = sides.map(|[left, right]| {
        let ([l0, l1], [r0, r1]) = (sides[left], sides[right]);
        let (left, right) = (sub(x[l0], x[l1]), sub(x[r1], x[r0]));
        let mut normal = cross(right, left);
        normalize(&mut normal);
        product(cross(normal, left), cross(right, normal), 8.0 * area * area)
    });
    metric(&basis, area, material.thickness, material)
}

/// Returns a metric of tetrahedra.
pub(super) fn tetrahedron(x: [Vec3; 4], material: &Elasticity) -> [f64; 21] {
    let [a, b, c] = [1, 2, 3].map(|k| sub(x[k], x[0]));
    let volume = dot(cross(a, b), c) / 6.0;
    let normals = [[2, 1, 0], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        .map(|[i, j, k]: [usize; 3]| cross(sub(x[j], x[i]), sub(x[k], x[i])));
    // the two faces that each edge is not on
    let faces = [[2, 3], [1, 3], [2, 1], [1, 0], [0, 2], [0, 3]];
    let basis = faces.map(|[left, right]| product(normals[left], normals[right], 36.0 * 2.0 * volume * volume));
    // MuJoCo's elements of three dimensions have a thickness of 4, which is the divisor in `metric`
    metric(&basis, volume, 4.0, material)
}

/// Returns the symmetric product of two vectors, divided by a divisor.
fn product(a: Vec3, b: Vec3, divisor: f64) -> Mat3 {
    std::array::from_fn(|k| (a[k / 3] * b[k % 3] + b[k / 3] * a[k % 3]) / divisor)
}

/// Returns the upper triangle of the metric, row by row.
fn metric(basis: &[Mat3], volume: f64, thickness: f64, material: &Elasticity) -> [f64; 21] {
    let (young, poisson) = (material.young, material.poisson);
    // Lame's parameters
    let mu = young / (2.0 * (1.0 + poisson)) * volume.abs() / 4.0 * thickness;
    let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) * volume.abs() / 4.0 * thickness;
    let trace = |m: &Mat3| 0.0 + m[0] + m[4] + m[8];
    let mut upper = [0.0; 21];
    let mut entries = upper.iter_mut();
    for (i, a) in basis.iter().enumerate() {
        for (b, entry) in basis[i..].iter().zip(&mut entries) {
            let mut squared = 0.0;
            for k in 0..9 {
                squared += a[k] * b[3 * (k % 3) + k / 3];
            }
            *entry = mu * squared + lambda * trace(b) * trace(a);
        }
    }
    upper
}
