//! Friction forces of one contact that minimise the dual cost at a given normal force.

use crate::math::MINVAL;

/// Maximum number of friction directions of a contact.
pub(super) const DIRECTIONS: usize = 5;

/// A quadratic cost `x' A x / 2 + x' b` of up to five numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quadratic {
    pub n: usize,
    pub a: [[f64; DIRECTIONS]; DIRECTIONS],
    pub b: [f64; DIRECTIONS],
}

/// Iterations on the multiplier of the ellipsoid.
const ITERATIONS: usize = 20;
/// Below this, determinants, violations and changes of the multiplier count as zero, as in MuJoCo.
const SMALL: f64 = 1e-10;

impl Quadratic {
    /// Minimises the cost within the ellipsoid `sum (x_k / axes_k)^2 <= radius^2` (MuJoCo's `mju_QCQP`): no force if the matrix is barely positive
    /// definite.
    pub fn within_ellipsoid(&self, axes: &[f64; DIRECTIONS], radius: f64) -> [f64; DIRECTIONS] {
        let n = self.n;
        // scaled so that the ellipsoid is a ball
        let mut scaled = *self;
        for i in 0..n {
            scaled.b[i] *= axes[i];
            for k in 0..n {
                scaled.a[i][k] *= axes[i] * axes[k];
            }
        }
        let (mut multiplier, mut x) = (0.0, [0.0; DIRECTIONS]);
        for _ in 0..ITERATIONS {
            let Some(factor) = scaled.factor(multiplier) else {
                return [0.0; DIRECTIONS];
            };
            x = solve(n, &factor, &scaled.b.map(|b| -b));
            let excess = x[..n].iter().map(|v| v * v).sum::<f64>() - radius * radius;
            if excess < SMALL {
                break;
            }
            let rate = solve(n, &factor, &x);
            let slope = -2.0 * x[..n].iter().zip(&rate).map(|(v, r)| v * r).sum::<f64>();
            let change = -excess / slope;
            if change < SMALL {
                break;
            }
            multiplier += change;
        }
        for i in 0..n {
            x[i] *= axes[i];
        }
        if multiplier != 0.0 {
            // the multiplier is approximate
            let length: f64 = (0..n).map(|k| x[k] * x[k] / (axes[k] * axes[k])).sum();
            let scale = (radius * radius / length.max(MINVAL)).sqrt();
            x[..n].iter_mut().for_each(|v| *v *= scale);
        }
        x
    }

    /// Returns the lower triangle of Cholesky's factors of `A + multiplier`; nothing if it is singular by MuJoCo's measures:
    /// determinants of two and three rows, pivots of more.
    fn factor(&self, multiplier: f64) -> Option<[[f64; DIRECTIONS]; DIRECTIONS]> {
        let n = self.n;
        let (mut l, mut determinant) = ([[0.0; DIRECTIONS]; DIRECTIONS], 1.0);
        for j in 0..n {
            let pivot = self.a[j][j] + multiplier - l[j][..j].iter().map(|v| v * v).sum::<f64>();
            determinant *= pivot;
            if pivot <= 0.0 || (n > 3 && pivot < SMALL) {
                return None;
            }
            l[j][j] = pivot.sqrt();
            for i in j + 1..n {
                let inner: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
                l[i][j] = (self.a[i][j] - inner) / l[j][j];
            }
        }
        (n > 3 || determinant >= SMALL).then_some(l)
    }
}

/// Solves `L L' x = b`.
fn solve(n: usize, l: &[[f64; DIRECTIONS]; DIRECTIONS], b: &[f64; DIRECTIONS]) -> [f64; DIRECTIONS] {
    let mut x = *b;
    for i in 0..n {
        for k in 0..i {
            x[i] -= l[i][k] * x[k];
        }
        x[i] /= l[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= l[k][i] * x[k];
        }
        x[i] /= l[i][i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that is positive definite, and a gradient that leads out of the ball.
    fn cost(n: usize) -> Quadratic {
        let mut cost = Quadratic {
            n,
            ..Quadratic::default()
        };
        for i in 0..n {
            cost.b[i] = [3.0, -2.0, 1.0, 0.5, -1.5][i];
            for k in 0..n {
                cost.a[i][k] = if i == k {
                    2.0 + i as f64
                } else {
                    0.3 / (1.0 + (i + k) as f64)
                };
            }
        }
        cost
    }

    fn value(cost: &Quadratic, x: &[f64; DIRECTIONS]) -> f64 {
        let row = |i: usize| (0..cost.n).map(|k| cost.a[i][k] * x[k]).sum::<f64>();
        (0..cost.n).map(|i| x[i] * (cost.b[i] + 0.5 * row(i))).sum()
    }

    #[test]
    fn no_point_of_the_ellipsoid_costs_less() {
        let axes = [0.8, 0.7, 0.3, 0.2, 0.1];
        for n in [2, 3, 5] {
            let cost = cost(n);
            for radius in [0.1, 1.0, 50.0] {
                let best = cost.within_ellipsoid(&axes, radius);
                let size = |x: &[f64; DIRECTIONS]| (0..n).map(|k| (x[k] / axes[k]).powi(2)).sum::<f64>().sqrt();
                assert!(size(&best) <= radius * (1.0 + 1e-9), "{n} {radius}");
                for k in 0..n {
                    for step in [-1e-4, 1e-4] {
                        let mut other = best;
                        other[k] += step * radius;
                        let shrink = (radius / size(&other)).min(1.0);
                        other.iter_mut().for_each(|v| *v *= shrink);
                        assert!(value(&cost, &other) >= value(&cost, &best) - 1e-12, "{n} {radius} {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_matrix_that_is_hardly_definite_gives_no_force() {
        let mut cost = cost(2);
        cost.a = cost.a.map(|row| row.map(|v| 1e-6 * v));
        assert_eq!(cost.within_ellipsoid(&[1.0; DIRECTIONS], 1.0), [0.0; DIRECTIONS]);
    }
}
