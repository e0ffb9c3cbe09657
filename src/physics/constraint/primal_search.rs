//! MuJoCo's own line search, step by step.
//!
//! Where a search converges, any exact one ends at the same point. Where `ls_iterations` cuts it off, the result depends
//! on which points it looked at, so models that allow few iterations are searched as MuJoCo 3.3.0 does it: Newton steps
//! from zero until the slope changes its sign, then both ends of the bracket and its middle until one of them is flat.

use super::line_search::LineSearch;
use crate::math::MINVAL;

/// A point on the line: step length, cost (up to a constant), and its first and second derivative.
#[derive(Clone, Copy)]
struct LinePoint {
    alpha: f64,
    cost: f64,
    slope: f64,
    curvature: f64,
}

impl LinePoint {
    /// Returns the next point of Newton's method.
    fn newton(&self) -> f64 {
        self.alpha - self.slope / self.curvature
    }
}

/// Evaluates points on the line and counts the evaluations.
struct PointEvaluator<'a> {
    line: &'a LineSearch<'a>,
    count: usize,
}

impl PointEvaluator<'_> {
    fn at(&mut self, alpha: f64) -> LinePoint {
        self.count += 1;
        let (slope, curvature) = self.line.derivatives(alpha);
        LinePoint {
            alpha,
            cost: self.line.cost(alpha),
            slope,
            curvature: if curvature > 0.0 { curvature } else { MINVAL },
        }
    }

    /// Moves an end of the bracket to the candidates on its side that are flatter, and `next` to the following point of Newton's method. Returns
    /// whether it moved.
    fn narrow(&mut self, end: &mut LinePoint, candidates: &[LinePoint; 3], next: &mut LinePoint) -> bool {
        let mut moved = false;
        for c in candidates {
            let rises = end.slope < 0.0 && c.slope < 0.0 && end.slope < c.slope;
            let falls = end.slope > 0.0 && c.slope > 0.0 && end.slope > c.slope;
            if rises || falls {
                (*end, moved) = (*c, true);
            }
        }
        if moved {
            *next = self.at(end.newton());
        }
        moved
    }
}

impl LineSearch<'_> {
    /// Finds a step length with a slope below `tolerance` in at most about `iterations` evaluations (MuJoCo's `PrimalSearch`);
    /// 0 if no point was better than the start.
    pub(super) fn follow(&self, tolerance: f64, iterations: usize) -> f64 {
        let mut probe = PointEvaluator { line: self, count: 0 };
        let start = probe.at(0.0);
        let mut near = probe.at(start.newton());
        if start.cost < near.cost {
            near = start;
        }
        if near.slope.abs() < tolerance {
            return near.alpha;
        }
        let direction = if near.slope < 0.0 { 1.0 } else { -1.0 };
        let mut behind = None;
        while near.slope * direction <= -tolerance && probe.count < iterations {
            behind = Some(near);
            near = probe.at(near.newton());
            if near.slope.abs() < tolerance {
                return near.alpha;
            }
        }
        let Some(mut far) = behind.filter(|_| probe.count < iterations) else {
            return near.alpha;
        };
        let mut far_next = near;
        let mut near_next = probe.at(near.newton());
        while probe.count < iterations {
            let middle = probe.at(0.5 * (near.alpha + far.alpha));
            let candidates = [near_next, far_next, middle];
            let flat = candidates.iter().filter(|c| c.slope.abs() < tolerance);
            // of equal ones the first
            let best = flat.reduce(|best, c| if c.cost < best.cost { c } else { best });
            if let Some(best) = best {
                return best.alpha;
            }
            let near_moved = probe.narrow(&mut near, &candidates, &mut near_next);
            let far_moved = probe.narrow(&mut far, &candidates, &mut far_next);
            if !near_moved && !far_moved {
                return middle.alpha;
            }
        }
        if near.cost <= far.cost && near.cost < start.cost {
            near.alpha
        } else if far.cost <= near.cost && far.cost < start.cost {
            far.alpha
        } else {
            0.0
        }
    }
}
