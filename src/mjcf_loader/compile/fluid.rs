//! Coefficients of a medium's forces on a geom, by the ellipsoid model.

use std::f64::consts::PI;

use super::geometry::EPS;
use crate::math::Vec3;
use crate::model::GeomType;

/// Weights of the Gauss-Kronrod rule with 15 points on the unit interval, with MuJoCo's digits.
const WEIGHTS: [f64; 15] = [
    0.01146766, 0.03154605, 0.05239501, 0.07032663, 0.08450236, 0.09517529, 0.10221647, 0.10474107, 0.10221647,
    0.09517529, 0.08450236, 0.07032663, 0.05239501, 0.03154605, 0.01146766,
];
/// The points `x`, stretched to all positive numbers: `x^3 / (1 - x)^2`.
const PLACES: [f64; 15] = [
    7.865151709349917e-08,
    1.7347976913907274e-05,
    0.0003548008144506193,
    0.002846636252924549,
    0.014094260903596077,
    0.053063261727396636,
    0.17041978741317773,
    0.5,
    1.4036301548686991,
    3.9353484827022642,
    11.644841677041734,
    39.53187807410903,
    177.5711362220801,
    1429.4772912937397,
    54087.416549217705,
];
/// Its slopes at the points: `x^2 (3 - x) / (1 - x)^3`.
const STRETCH: [f64; 15] = [
    5.538677720489877e-05,
    0.002080868285293228,
    0.016514126520723166,
    0.07261900344370877,
    0.23985243401862602,
    0.6868318249020725,
    1.8551129519182894,
    5.0,
    14.060031152313941,
    43.28941239611009,
    156.58546376397112,
    747.9826085305024,
    5827.4042950027115,
    116754.0197944512,
    25482945.327264845,
];

/// Returns the integral over all positive `l` of `x y z / sqrt((x^2 + l)^3 (y^2 + l) (z^2 + l))`, by which the medium resists an
/// ellipsoid that is accelerated along its first axis (Lamb, "Hydrodynamics", 1932, article 114).
fn resistance([x, y, z]: Vec3) -> f64 {
    let [x2, y2, z2] = [x, y, z].map(|v| 1.0 / (v * v));
    let scale = pxfm::f_pow(x * x * x * y * z, 0.4);
    let mut sum = 0.0;
    for ((weight, place), stretch) in WEIGHTS.iter().zip(PLACES).zip(STRETCH) {
        let l = scale * place;
        let far = 1.0 + l * x2;
        sum += scale * stretch / (far * (far * (1.0 + l * y2) * (1.0 + l * z2)).sqrt()) * weight;
    }
    sum * x2
}

/// Returns MuJoCo's `geom_fluid` of a geom: a flag for the ellipsoid model, its coefficients, and the volumes and moments of the
/// medium that move with it.
pub(super) fn fluid(kind: GeomType, size: &Vec3, coef: [f64; 5]) -> [f64; 12] {
    let [x, y, z] = match kind {
        GeomType::Sphere => [size[0]; 3],
        GeomType::Capsule => [size[0], size[0], size[1] + size[0]],
        GeomType::Cylinder => [size[0], size[0], size[1]],
        GeomType::Plane | GeomType::Ellipsoid | GeomType::Box | GeomType::Mesh | GeomType::HField => *size,
    };
    let volume = 4.0 / 3.0 * PI * x * y * z;
    let [kx, ky, kz] = [resistance([x, y, z]), resistance([y, z, x]), resistance([z, x, y])];
    let square = |v: f64| v * v;
    let moment = |a: f64, b: f64, ka: f64, kb: f64| {
        let (difference, sum) = (a * a - b * b, a * a + b * b);
        square(difference) * (kb - ka).abs() / EPS.max((2.0 * difference + sum * (ka - kb)).abs())
    };
    let mass = |k: f64| volume * k / EPS.max(2.0 - k);
    let [a, b, c, d, e] = coef;
    let moments = [moment(y, z, ky, kz), moment(z, x, kz, kx), moment(x, y, kx, ky)];
    let [jx, jy, jz] = moments.map(|m| volume * m / 5.0);
    [1.0, a, b, c, d, e, mass(kx), mass(ky), mass(kz), jx, jy, jz]
}
