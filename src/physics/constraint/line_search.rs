//! Exact search along a direction.

use crate::math::MINVAL;
use crate::physics::constraint::island::Island;
use crate::physics::tiles::total;

/// The cost of an island restricted to a line.
pub(super) struct LineSearch<'a> {
    /// First and second derivative of the inertial part at 0.
    pub(super) slope: f64,
    pub(super) curvature: f64,
    pub(super) island: &'a Island,
}

impl LineSearch<'_> {
    /// Computes the first and second derivative of the cost at `alpha`.
    #[inline(always)]
    pub(super) fn derivatives(&self, alpha: f64) -> (f64, f64) {
        let (mut first, mut second) = ([0.0; 4], [0.0; 4]);
        for q in &self.island.scalar_rows {
            q.add_slopes(alpha, &mut first, &mut second);
        }
        // the two sums look alike, and LLVM would keep them in pairs of a first and a second derivative, half as wide as the rows
        // are: here they meet too late for it
        let (first, second) = std::hint::black_box((first, second));
        let mut g = self.slope + alpha * self.curvature + total(&first);
        let mut h = self.curvature + total(&second);
        for (c, _) in &self.island.cones {
            c.add_slopes(alpha, &mut g, &mut h);
        }
        (g, h)
    }

    /// Computes the cost at `alpha`, less that of the inertia at 0.
    pub(super) fn cost(&self, alpha: f64) -> f64 {
        let rows = self.island.scalar_rows.iter().map(|q| q.cost(alpha));
        let cones = self.island.cones.iter().map(|(c, _)| c.cost(alpha));
        alpha * (self.slope + 0.5 * alpha * self.curvature) + rows.sum::<f64>() + cones.sum::<f64>()
    }

    /// Finds the step length at which the derivative vanishes to within `tolerance`, from a first guess.
    ///
    /// This is Newton's method on the derivative (which is monotone), kept inside a bracket.
    #[inline(always)]
    pub(super) fn minimise(&self, guess: f64, tolerance: f64, iterations: usize) -> f64 {
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut alpha = guess;
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
            // pieces of the cost are linear, where the slope has no rate
            let mut next = alpha - g / h.max(MINVAL);
            if !(next > low && next < high) {
                // Newton's step may leave the bracket where the cost changes from one piece to another
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
