//! Cost, force and curvature of one block of rows.

use crate::physics::constraint::{Block, RowKind};

/// Where a block is on its cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zone {
    /// No force, or a constant one: no curvature.
    Flat,
    /// Quadratic: curvature `diag(d)`.
    Quadratic,
    /// On the surface of the friction cone: curvature from [`cone_hessian`].
    Cone,
}

/// Cost of a block at `jar = J a - aref`, and the force `-d cost / d jar`, written to `force`.
#[inline]
pub fn evaluate(b: &Block, jar: &[f64], d: &[f64], r: &[f64], force: &mut [f64]) -> (f64, Zone) {
    match b.kind {
        RowKind::Equality => quadratic(jar, d, force),
        RowKind::FrictionLoss => {
            let edge = r[0] * b.frictionloss;
            if jar[0] <= -edge {
                force[0] = b.frictionloss;
                (b.frictionloss * (-0.5 * edge - jar[0]), Zone::Flat)
            } else if jar[0] >= edge {
                force[0] = -b.frictionloss;
                (b.frictionloss * (-0.5 * edge + jar[0]), Zone::Flat)
            } else {
                quadratic(jar, d, force)
            }
        }
        RowKind::Limit | RowKind::Frictionless => {
            if jar[0] < 0.0 {
                quadratic(jar, d, force)
            } else {
                force[0] = 0.0;
                (0.0, Zone::Flat)
            }
        }
        RowKind::Elliptic => {
            let mu = b.mu;
            let n = jar[0] * mu;
            let mut tt = 0.0;
            for j in 1..b.dim {
                let u = jar[j] * b.friction[j - 1];
                tt += u * u;
            }
            let t = tt.sqrt();
            if n >= mu * t || (t <= 0.0 && n >= 0.0) {
                force.fill(0.0);
                (0.0, Zone::Flat)
            } else if mu * n + t <= 0.0 || (t <= 0.0 && n < 0.0) {
                quadratic(jar, d, force)
            } else {
                let dm = d[0] / (mu * mu * (1.0 + mu * mu));
                let y = n - mu * t;
                force[0] = -dm * y * mu;
                let tangential = dm * y * mu / t;
                for j in 1..b.dim {
                    let f = b.friction[j - 1];
                    force[j] = tangential * (jar[j] * f) * f;
                }
                (0.5 * dm * y * y, Zone::Cone)
            }
        }
    }
}

#[inline]
fn quadratic(jar: &[f64], d: &[f64], force: &mut [f64]) -> (f64, Zone) {
    let mut cost = 0.0;
    for ((f, &x), &d) in force.iter_mut().zip(jar).zip(d) {
        *f = -d * x;
        cost += 0.5 * d * x * x;
    }
    (cost, Zone::Quadratic)
}

/// Hessian of the cost of an elliptic contact in the cone zone, row-major `dim` by `dim`, with respect to `jar`.
///
/// The cost is `dm/2 y^2` with `y = n - mu t`, `n = mu jar_0` and `t` the length of `u_j = friction_j jar_j`.
#[inline]
pub fn cone_hessian(b: &Block, jar: &[f64], d: &[f64], h: &mut [f64; 36]) {
    let (mu, dim) = (b.mu, b.dim);
    let mut u = [0.0; 6];
    let mut tt = 0.0;
    for j in 1..dim {
        u[j] = jar[j] * b.friction[j - 1];
        tt += u[j] * u[j];
    }
    let t = tt.sqrt();
    let dm = d[0] / (mu * mu * (1.0 + mu * mu));
    let y = jar[0] * mu - mu * t;
    let mut gradient = [0.0; 6];
    gradient[0] = mu;
    for j in 1..dim {
        gradient[j] = -mu * u[j] * b.friction[j - 1] / t;
    }
    let curl = -mu * y / t;
    for a in 0..dim {
        for c in 0..dim {
            let mut v = gradient[a] * gradient[c];
            if a > 0 && c > 0 {
                let delta = if a == c { 1.0 } else { 0.0 };
                v += curl * b.friction[a - 1] * b.friction[c - 1] * (delta - u[a] * u[c] / tt);
            }
            h[a * dim + c] = dm * v;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact() -> Block {
        Block {
            kind: RowKind::Elliptic,
            dim: 4,
            mu: 0.8,
            friction: [0.8, 0.8, 0.05, 0.0, 0.0],
            ..Block::default()
        }
    }

    /// Regularisation of the tangential rows as the row builder gives it.
    fn regularisation(b: &Block) -> ([f64; 4], [f64; 4]) {
        let r0 = 0.01;
        let r = [r0, r0, r0, r0 * (0.8 / 0.05_f64).powi(2)];
        let _ = b;
        (r.map(|v| 1.0 / v), r)
    }

    #[test]
    fn force_is_the_negative_gradient_and_the_hessian_its_slope() {
        let b = contact();
        let (d, r) = regularisation(&b);
        let mut force = [0.0; 4];
        for jar in [[-0.3, 0.5, 0.2, 3.0], [0.1, 0.5, -0.4, 1.0], [-2.0, 0.1, 0.2, 0.3]] {
            let (_, zone) = evaluate(&b, &jar, &d, &r, &mut force);
            let mut hessian = [0.0; 36];
            if zone == Zone::Cone {
                cone_hessian(&b, &jar, &d, &mut hessian);
            }
            for k in 0..4 {
                let eps = 1e-6;
                let (mut up, mut down) = (jar, jar);
                up[k] += eps;
                down[k] -= eps;
                let (mut fu, mut fd) = ([0.0; 4], [0.0; 4]);
                let (cu, _) = evaluate(&b, &up, &d, &r, &mut fu);
                let (cd, _) = evaluate(&b, &down, &d, &r, &mut fd);
                assert!((force[k] + (cu - cd) / (2.0 * eps)).abs() < 1e-5, "{jar:?} {k}");
                if zone == Zone::Cone {
                    for c in 0..4 {
                        let slope = -(fu[c] - fd[c]) / (2.0 * eps);
                        assert!(
                            (hessian[k * 4 + c] - slope).abs() < 1e-4 * (1.0 + slope.abs()),
                            "{jar:?} {k} {c}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn zones_follow_the_cone() {
        let b = contact();
        let (d, r) = regularisation(&b);
        let mut f = [0.0; 4];
        assert_eq!(evaluate(&b, &[1.0, 0.1, 0.0, 0.0], &d, &r, &mut f).1, Zone::Flat);
        assert_eq!(evaluate(&b, &[-1.0, 0.01, 0.0, 0.0], &d, &r, &mut f).1, Zone::Quadratic);
        assert_eq!(evaluate(&b, &[-0.1, 1.0, 0.0, 0.0], &d, &r, &mut f).1, Zone::Cone);
    }
}
