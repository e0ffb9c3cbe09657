//! Exact search along a direction.

use crate::math::MINVAL;
use crate::physics::constraint::{Efc, RowKind};

/// An elliptic contact along the line: coefficients of its quadratic zone and of `n` and `t^2` in the cone.
#[derive(Clone, Copy, Debug, Default)]
struct ConeLine {
    mu: f64,
    dm: f64,
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

/// A row with two or three pieces along the line.
#[derive(Clone, Copy, Debug, Default)]
struct KinkLine {
    jar: f64,
    jv: f64,
    d: f64,
    /// Half width of the quadratic piece of dry friction, or negative for a one-sided row.
    edge: f64,
    loss: f64,
}

/// The cost of the solver restricted to a line, prepared once per direction.
#[derive(Clone, Debug, Default)]
pub struct LineSearch {
    slope: f64,
    curvature: f64,
    kinks: Vec<KinkLine>,
    cones: Vec<ConeLine>,
}

impl LineSearch {
    /// With memory for the rows of `nv` degrees of freedom and `contacts` contacts.
    pub fn with_capacity(nv: usize, contacts: usize) -> Self {
        Self {
            kinks: Vec::with_capacity(4 * nv),
            cones: Vec::with_capacity(contacts),
            ..Self::default()
        }
    }

    /// `slope` and `curvature` are those of the inertial part at 0; `jar` and `jv` are the rows' values and rates.
    pub fn prepare(&mut self, slope: f64, curvature: f64, blocks: &[u32], efc: &Efc, jar: &[f64], jv: &[f64]) {
        self.slope = slope;
        self.curvature = curvature;
        self.kinks.clear();
        self.cones.clear();
        for &k in blocks {
            let b = &efc.blocks[k as usize];
            let row = b.row;
            match b.kind {
                RowKind::Equality => {
                    for i in row..row + b.dim {
                        self.slope += efc.d[i] * jar[i] * jv[i];
                        self.curvature += efc.d[i] * jv[i] * jv[i];
                    }
                }
                RowKind::FrictionLoss => self.kinks.push(KinkLine {
                    jar: jar[row],
                    jv: jv[row],
                    d: efc.d[row],
                    edge: efc.r[row] * b.frictionloss,
                    loss: b.frictionloss,
                }),
                RowKind::Limit | RowKind::Frictionless => self.kinks.push(KinkLine {
                    jar: jar[row],
                    jv: jv[row],
                    d: efc.d[row],
                    edge: -1.0,
                    loss: 0.0,
                }),
                RowKind::Elliptic => {
                    let mut c = ConeLine {
                        mu: b.mu,
                        dm: efc.d[row] / (b.mu * b.mu * (1.0 + b.mu * b.mu)),
                        n0: jar[row] * b.mu,
                        n1: jv[row] * b.mu,
                        ..ConeLine::default()
                    };
                    for j in 0..b.dim {
                        let (x, v, d) = (jar[row + j], jv[row + j], efc.d[row + j]);
                        c.slope += d * x * v;
                        c.curvature += d * v * v;
                        if j > 0 {
                            let f = b.friction[j - 1];
                            let (u, w) = (x * f, v * f);
                            c.uu += u * u;
                            c.uv += u * w;
                            c.vv += w * w;
                        }
                    }
                    self.cones.push(c);
                }
            }
        }
    }

    /// First and second derivative at `alpha`.
    fn derivatives(&self, alpha: f64) -> (f64, f64) {
        let mut g = self.slope + alpha * self.curvature;
        let mut h = self.curvature;
        for k in &self.kinks {
            let x = k.jar + alpha * k.jv;
            if k.edge < 0.0 {
                if x < 0.0 {
                    g += k.d * x * k.jv;
                    h += k.d * k.jv * k.jv;
                }
            } else if x <= -k.edge {
                g -= k.loss * k.jv;
            } else if x >= k.edge {
                g += k.loss * k.jv;
            } else {
                g += k.d * x * k.jv;
                h += k.d * k.jv * k.jv;
            }
        }
        for c in &self.cones {
            let n = c.n0 + alpha * c.n1;
            let half_rate = c.uv + alpha * c.vv;
            let tt = c.uu + alpha * (c.uv + half_rate);
            let t = tt.max(0.0).sqrt();
            if n >= c.mu * t || (t <= 0.0 && n >= 0.0) {
                continue;
            }
            if c.mu * n + t <= 0.0 || t <= 0.0 {
                g += c.slope + alpha * c.curvature;
                h += c.curvature;
            } else {
                let t1 = half_rate / t;
                let t2 = c.vv / t - half_rate * t1 / tt;
                let y = n - c.mu * t;
                let y1 = c.n1 - c.mu * t1;
                g += c.dm * y * y1;
                h += c.dm * (y1 * y1 - y * c.mu * t2);
            }
        }
        (g, h)
    }

    /// Step length at which the derivative vanishes to within `tolerance`; 0 when the direction does not descend. Newton's
    /// method on the derivative (which is monotone), kept inside a bracket.
    pub fn minimise(&self, tolerance: f64, iterations: usize) -> f64 {
        let (g0, h0) = self.derivatives(0.0);
        if g0 >= 0.0 || h0 < MINVAL {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut alpha = -g0 / h0;
        for _ in 0..iterations {
            let (g, h) = self.derivatives(alpha);
            if g.abs() < tolerance {
                break;
            }
            if g < 0.0 {
                low = alpha;
            } else {
                high = alpha;
            }
            let mut next = alpha - g / h.max(MINVAL);
            if !(next > low && next < high) {
                next = if high.is_finite() {
                    0.5 * (low + high)
                } else {
                    2.0 * alpha
                };
            }
            if next == alpha {
                break;
            }
            alpha = next;
        }
        alpha
    }
}
