//! Contacts with an elliptic friction cone: cost, force, curvature, slopes along a line.

use super::{Block, ConeShape, Efc};

/// The zone of a contact in the elliptic cone's cost: MuJoCo's top, bottom and middle zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) enum ConeZone {
    /// No force, no curvature.
    #[default]
    Flat,
    /// Quadratic: curvature `diag(d)`.
    Quadratic,
    /// On the surface of the friction cone: curvature from [`FrictionCone::curvature`].
    Surface,
}

/// A contact with friction. The first row is the normal; only the first `dim` rows count.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrictionCone {
    /// Number of rows.
    pub(super) dim: usize,
    /// First row in [`Efc`].
    pub(super) row: usize,
    /// Slope of the regularised cone.
    mu: f64,
    /// Friction coefficient of each row but the first.
    friction: [f64; 6],
    /// Inverse of the regularisation.
    pub(super) d: [f64; 6],
    /// Curvature across the surface.
    dm: f64,
    pub(super) aref: [f64; 6],
    /// `J a - aref`
    pub(super) jar: [f64; 6],
    /// `J` times the search direction.
    pub(super) jv: [f64; 6],
    /// Minus the gradient of the cost by `jar`.
    pub(super) force: [f64; 6],
    pub(super) zone: ConeZone,
    /// Coefficients of the cost along the search direction.
    line: ConeLine,
}

/// The cost of a contact along a search direction: the quadratic zone, and `n` and `t^2` for the others.
#[derive(Clone, Copy, Debug, Default)]
struct ConeLine {
    /// First and second derivative at 0 when all rows are quadratic.
    slope: f64,
    curvature: f64,
    /// `n = n0 + alpha n1`
    n0: f64,
    n1: f64,
    /// `t^2 = uu + 2 alpha uv + alpha^2 vv`
    uu: f64,
    uv: f64,
    vv: f64,
}

impl FrictionCone {
    /// Creates the cone of a contact from its block of rows.
    #[inline(always)]
    pub(super) fn new(b: &Block, efc: &Efc) -> Self {
        let ConeShape { mu, friction } = *efc.cone(b);
        let mut cone = Self {
            dim: b.dim,
            row: b.row,
            mu,
            // the one curvature that makes cost and force continuous where the surface zone meets the quadratic one, at
            // mu n + t = 0 (there d_k = d_0 (friction_k / mu)^2)
            dm: efc.d[b.row] / (mu * mu * (1.0 + mu * mu)),
            ..Self::default()
        };
        for k in 0..b.dim {
            (cone.d[k], cone.aref[k]) = (efc.d[b.row + k], efc.aref[b.row + k]);
        }
        cone.friction[1..].copy_from_slice(&friction);
        cone
    }

    /// Computes the cost, and fills in force and zone.
    #[inline(always)]
    pub(super) fn evaluate(&mut self) -> f64 {
        let (jar, mu) = (&self.jar, self.mu);
        let n = jar[0] * mu;
        let mut tt = 0.0;
        for k in 1..self.dim {
            let u = jar[k] * self.friction[k];
            tt += u * u;
        }
        let t = tt.sqrt();
        self.force = [0.0; 6];
        // The zones of the elliptic cone in MuJoCo's "Computation" chapter: the contact opens faster than friction
        // could follow; or it holds without slipping; or it slides, with the force on the cone.
        if n >= mu * t || (t <= 0.0 && n >= 0.0) {
            self.zone = ConeZone::Flat;
            0.0
        } else if mu * n + t <= 0.0 || (t <= 0.0 && n < 0.0) {
            self.zone = ConeZone::Quadratic;
            let mut cost = 0.0;
            for k in 0..self.dim {
                self.force[k] = -self.d[k] * jar[k];
                cost += 0.5 * self.d[k] * jar[k] * jar[k];
            }
            cost
        } else {
            self.zone = ConeZone::Surface;
            let y = n - mu * t;
            self.force[0] = -self.dm * y * mu;
            let tangential = self.dm * y * mu / t;
            for k in 1..self.dim {
                self.force[k] = tangential * (jar[k] * self.friction[k]) * self.friction[k];
            }
            0.5 * self.dm * y * y
        }
    }

    /// Computes the Hessian of the cost on the surface of the cone with respect to `jar`.
    ///
    /// The cost is `dm/2 y^2` with `y = n - mu t`, `n = mu jar_0` and `t` the length of `u_k = friction_k jar_k`.
    #[inline(always)]
    pub(super) fn curvature(&self) -> [[f64; 6]; 6] {
        let (mu, dim) = (self.mu, self.dim);
        let mut u = [0.0; 6];
        let mut tt = 0.0;
        for k in 1..dim {
            u[k] = self.jar[k] * self.friction[k];
            tt += u[k] * u[k];
        }
        let t = tt.sqrt();
        let y = self.jar[0] * mu - mu * t;
        let mut gradient = [0.0; 6];
        gradient[0] = mu;
        for k in 1..dim {
            gradient[k] = -mu * u[k] * self.friction[k] / t;
        }
        // Positive, as y is negative on the surface. The length t is convex, so the second part of the product rule
        // adds to the first, and the Hessian stays positive semidefinite.
        let curl = -mu * y / t;
        let mut h = [[0.0; 6]; 6];
        for a in 0..dim {
            for c in 0..=a {
                let mut v = gradient[a] * gradient[c];
                if a > 0 && c > 0 {
                    let delta = if a == c { 1.0 } else { 0.0 };
                    v += curl * self.friction[a] * self.friction[c] * (delta - u[a] * u[c] / tt);
                }
                h[a][c] = self.dm * v;
                h[c][a] = h[a][c];
            }
        }
        h
    }

    /// Prepares [`Self::add_slopes`] for `jar` and `jv`.
    #[inline(always)]
    pub(super) fn prepare_line(&mut self) {
        let mut line = ConeLine {
            n0: self.jar[0] * self.mu,
            n1: self.jv[0] * self.mu,
            ..ConeLine::default()
        };
        for k in 0..self.dim {
            let (x, v, d, f) = (self.jar[k], self.jv[k], self.d[k], self.friction[k]);
            line.slope += d * x * v;
            line.curvature += d * v * v;
            // the normal has no friction coefficient
            let (u, w) = (x * f, v * f);
            line.uu += u * u;
            line.uv += u * w;
            line.vv += w * w;
        }
        self.line = line;
    }

    /// Returns the cost at `jar + alpha jv`.
    pub(super) fn cost(&self, alpha: f64) -> f64 {
        let mut there = *self;
        for k in 0..self.dim {
            there.jar[k] += alpha * self.jv[k];
        }
        there.evaluate()
    }

    /// Adds first and second derivative of the cost at `jar + alpha jv`.
    #[inline(always)]
    pub(super) fn add_slopes(&self, alpha: f64, first: &mut f64, second: &mut f64) {
        let (c, mu) = (&self.line, self.mu);
        let n = c.n0 + alpha * c.n1;
        let half_rate = c.uv + alpha * c.vv;
        let tt = c.uu + alpha * (c.uv + half_rate);
        // rounding may leave the square of a small length negative
        let t = tt.max(0.0).sqrt();
        // the zones of `evaluate`; a contact may pass through all three along one line
        if n >= mu * t || (t <= 0.0 && n >= 0.0) {
            return;
        }
        if mu * n + t <= 0.0 || t <= 0.0 {
            *first += c.slope + alpha * c.curvature;
            *second += c.curvature;
        } else {
            let t1 = half_rate / t;
            let t2 = c.vv / t - half_rate * t1 / tt;
            let y = n - mu * t;
            let y1 = c.n1 - mu * t1;
            *first += self.dm * y * y1;
            *second += self.dm * (y1 * y1 - y * mu * t2);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::ConstraintType;

    /// Builds a contact with torsional friction, regularised as the row builder does it.
    fn contact(jar: [f64; 4]) -> FrictionCone {
        let block = Block {
            kind: ConstraintType::ContactElliptic,
            dim: 4,
            ..Block::default()
        };
        let shape = ConeShape {
            mu: 0.8,
            friction: [0.8, 0.8, 0.05, 0.0, 0.0],
        };
        let torsional = 100.0 / (0.8 / 0.05_f64).powi(2);
        let efc = Efc {
            d: vec![100.0, 100.0, 100.0, torsional],
            aref: vec![0.0; 4],
            cones: vec![shape],
            ..Efc::default()
        };
        let mut cone = FrictionCone::new(&block, &efc);
        cone.jar[..4].copy_from_slice(&jar);
        cone
    }

    #[test]
    fn force_is_the_negative_gradient_and_the_curvature_its_slope() {
        for jar in [[-0.3, 0.5, 0.2, 3.0], [0.1, 0.5, -0.4, 1.0], [-2.0, 0.1, 0.2, 0.3]] {
            let mut cone = contact(jar);
            cone.evaluate();
            let curvature = cone.curvature();
            for k in 0..4 {
                let eps = 1e-6;
                let (mut up, mut down) = (cone, cone);
                up.jar[k] += eps;
                down.jar[k] -= eps;
                let (cu, cd) = (up.evaluate(), down.evaluate());
                assert!((cone.force[k] + (cu - cd) / (2.0 * eps)).abs() < 1e-5, "{jar:?} {k}");
                if cone.zone == ConeZone::Surface {
                    for c in 0..4 {
                        let slope = -(up.force[c] - down.force[c]) / (2.0 * eps);
                        assert!(
                            (curvature[k][c] - slope).abs() < 1e-4 * (1.0 + slope.abs()),
                            "{jar:?} {k} {c}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn slopes_along_a_line_are_those_of_the_cost() {
        for jar in [[-0.3, 0.5, 0.2, 3.0], [0.1, 0.5, -0.4, 1.0], [-2.0, 0.1, 0.2, 0.3]] {
            let mut cone = contact(jar);
            cone.jv = [0.3, -0.2, 0.7, 0.4, 0.0, 0.0];
            cone.prepare_line();
            for alpha in [0.0, 0.4, 2.0] {
                let at = |alpha: f64| {
                    let mut moved = cone;
                    for k in 0..4 {
                        moved.jar[k] += alpha * cone.jv[k];
                    }
                    let cost = moved.evaluate();
                    let slope: f64 = (0..4).map(|k| -moved.force[k] * cone.jv[k]).sum();
                    (cost, slope)
                };
                let (mut first, mut second) = (0.0, 0.0);
                cone.add_slopes(alpha, &mut first, &mut second);
                let eps = 1e-6;
                let numeric = (at(alpha + eps).1 - at(alpha - eps).1) / (2.0 * eps);
                assert!(
                    (first - at(alpha).1).abs() < 1e-9 * (1.0 + first.abs()),
                    "{jar:?} {alpha}"
                );
                assert!(
                    (second - numeric).abs() < 1e-4 * (1.0 + second.abs()),
                    "{jar:?} {alpha}"
                );
            }
        }
    }

    #[test]
    fn zones_follow_the_cone() {
        let zone = |jar| {
            let mut cone = contact(jar);
            cone.evaluate();
            cone.zone
        };
        assert_eq!(zone([1.0, 0.1, 0.0, 0.0]), ConeZone::Flat);
        assert_eq!(zone([-1.0, 0.01, 0.0, 0.0]), ConeZone::Quadratic);
        assert_eq!(zone([-0.1, 1.0, 0.0, 0.0]), ConeZone::Surface);
    }
}
