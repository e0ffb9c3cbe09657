//! Exact search along a direction.

use super::island::Island;
use crate::math::MINVAL;
use crate::tiles::total;

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

    /// Computes the cost at `alpha`, minus that of the inertia at 0.
    pub(super) fn cost(&self, alpha: f64) -> f64 {
        let rows = self.island.scalar_rows.iter().map(|q| q.cost(alpha));
        let cones = self.island.cones.iter().map(|(c, _)| c.cost(alpha));
        alpha * (self.slope + 0.5 * alpha * self.curvature) + rows.sum::<f64>() + cones.sum::<f64>()
    }

    /// Finds the step length at which the derivative vanishes to within `tolerance`, from a first guess.
    ///
    /// This is Newton's method on the derivative (which is monotone), kept inside a bracket, which is halved where the method continues to
    /// swing between its ends.
    #[inline(always)]
    pub(super) fn minimise(&self, guess: f64, tolerance: f64, iterations: usize) -> f64 {
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut alpha = guess;
        // lengths of the last step and of the one before
        let (mut last, mut before) = (f64::INFINITY, f64::INFINITY);
        for tried in 0..iterations {
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
            let step = (next - alpha).abs();
            // Where the cost changes from one piece to another Newton's step may leave the bracket, or go back and forth between its
            // ends and hardly narrow it; mostly it finds its way from there by itself. A step that is short for the bracket is none of
            // these, however long it is beside those before: near the end all of them are rounding.
            let swings = tried >= iterations / 2 && step > 0.5 * before && step > 0.5 * (high - low);
            if !(next > low && next < high) || swings {
                next = if high.is_finite() {
                    0.5 * (low + high)
                } else {
                    2.0 * alpha
                };
            }
            if next == alpha {
                break;
            }
            (before, last) = (last, (next - alpha).abs());
            alpha = next;
        }
        alpha
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::cone::FrictionCone;
    use crate::constraint::jacobian::Jacobian;
    use crate::constraint::{Block, ConeShape, ConstraintType, Efc};

    /// Builds a contact that slides more and more slowly along the line, and turns round at `turn`.
    fn turning(d: f64, mu: f64, pressed: f64, [turn, aside]: [f64; 2]) -> (FrictionCone, Jacobian) {
        let block = Block {
            kind: ConstraintType::ContactElliptic,
            dim: 3,
            ..Block::default()
        };
        let shape = ConeShape {
            mu,
            friction: [1.0, 1.0, 0.0, 0.0, 0.0],
        };
        let tangential = d / (mu * mu);
        let efc = Efc {
            d: vec![d, tangential, tangential],
            aref: vec![0.0; 3],
            cones: vec![shape],
            ..Efc::default()
        };
        let mut cone = FrictionCone::new(&block, &efc);
        cone.jar[..3].copy_from_slice(&[-pressed, -turn, aside]);
        cone.jv[1] = 1.0;
        cone.prepare_line();
        (cone, Jacobian::default())
    }

    #[test]
    fn contacts_that_turn_round_are_searched_to_the_end() {
        let mut rng = testkit::Rng::with_seed(1);
        let mut power = |low: f64, high: f64| 10_f64.powf(low + (high - low) * rng.f64());
        let mut searched = 0;
        for _ in 0..20_000 {
            let mut island = Island::default();
            for _ in 0..2 {
                let (d, mu, pressed) = (power(-1.0, 2.0), power(-0.5, 0.5), power(-2.0, 1.0));
                let places = [power(-2.0, -0.3), power(-5.0, -1.0)];
                island.cones.push(turning(d, mu, pressed, places));
            }
            let line = LineSearch {
                slope: -power(-2.0, 1.0),
                curvature: power(-2.0, 1.5),
                island: &island,
            };
            if line.derivatives(0.0).0 < 0.0 {
                searched += 1;
                let alpha = line.minimise(1.0, 1e-10, 50);
                let (slope, curvature) = line.derivatives(alpha);
                assert!(slope.abs() < 1e-9 * curvature.max(1.0), "slope {slope} at {alpha}");
            }
        }
        assert!(searched > 10_000, "{searched}");
    }
}
