//! Tolerances between two solvers with the same stopping rule.
//!
//! Newton's method stops where a step lowers the cost by less than `E = tolerance * meaninertia * nv`. The cost is at least as
//! curved as the inertia `M`, so accelerations `d` away from its minimum cost at least `d' M d / 2` more than that. The steps that
//! are not taken gain less than the last one, so each solver ends within `E` of the minimum, `d' M d / 2 <= E`; by the triangle
//! inequality two solvers are within `(sqrt(E) + sqrt(E))^2 = 4 E` of each other. This decides nothing but where accelerations are
//! small: a relative limit asks there for more than either solver was told to find. Nor can a solver see that a step lowers the cost by less than
//! the rounding of the cost, a sum over the rows of constraints: where a row that moves nothing has a force of 1e17, both stop far from the minimum.

use babybench::Model;

use super::measured::Measured;
use crate::mujoco::Simulation;

/// Allowed distance of two solvers, in multiples of the cost at which one stops.
const APART: f64 = 4.0;

/// Distance from the optimum at which solvers stop in a state.
pub struct Slack {
    /// Cost at which a solver stops.
    cost: f64,
    /// Inertia (nv, nv).
    inertia: Vec<f64>,
}

impl Slack {
    /// Derives it from the options of a model, and from the inertia and forces of MuJoCo's current state.
    pub fn new(model: &Model, theirs: &Simulation) -> Self {
        let told = model.opt.tolerance * model.stat.meaninertia * model.nv.max(1) as f64;
        let rows = theirs.efc_force().iter().zip(theirs.efc_R());
        let whole: f64 = rows.map(|(force, r)| 0.5 * r * force * force).sum();
        Self {
            cost: told.max(theirs.nefc() as f64 * f64::EPSILON * whole),
            inertia: theirs.full_inertia(),
        }
    }

    /// Measures accelerations by the cost; `None` if they differ by more than the rule explains.
    pub fn accelerations(&self, ours: &[f64], theirs: &[f64]) -> Option<Measured> {
        self.within("qacc: by the cost at which solvers stop", ours, theirs, 1.0)
    }

    /// Measures velocities by the cost of the accelerations over a time step `h`: implicit damping makes differences smaller.
    pub fn velocities(&self, ours: &[f64], theirs: &[f64], h: f64) -> Option<Measured> {
        self.within(
            "qvel after the step: by the cost at which solvers stop",
            ours,
            theirs,
            h,
        )
    }

    /// Returns the root of `d' M d` of a difference `d`.
    pub fn norm(&self, ours: &[f64], theirs: &[f64]) -> f64 {
        let apart: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| a - b).collect();
        let momentum = |row: &[f64]| row.iter().zip(&apart).map(|(m, d)| m * d).sum::<f64>();
        let rows = self.inertia.chunks_exact(apart.len().max(1));
        rows.zip(&apart).map(|(row, d)| d * momentum(row)).sum::<f64>().sqrt()
    }

    /// Returns the root of `f' M^-1 f` of a difference `f` of forces, by Cholesky's decomposition.
    pub fn force_norm(&self, ours: &[f64], theirs: &[f64]) -> f64 {
        let n = ours.len();
        let mut lower = self.inertia.clone();
        // y of L y = f, whose square is f' M^-1 f
        let mut y: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| a - b).collect();
        for i in 0..n {
            for j in 0..=i {
                let sum: f64 = (0..j).map(|k| lower[i * n + k] * lower[j * n + k]).sum();
                let rest = lower[i * n + j] - sum;
                lower[i * n + j] = if i == j { rest.sqrt() } else { rest / lower[j * n + j] };
            }
            let sum: f64 = (0..i).map(|k| lower[i * n + k] * y[k]).sum();
            y[i] = (y[i] - sum) / lower[i * n + i];
        }
        y.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    fn within(&self, quantity: &'static str, ours: &[f64], theirs: &[f64], h: f64) -> Option<Measured> {
        if self.inertia.len() != ours.len() * ours.len() || ours.len() != theirs.len() {
            return None;
        }
        let cost = 0.5 * (self.norm(ours, theirs) / h).powi(2);
        let measured = Measured::new(
            quantity,
            cost / self.cost,
            APART,
            format!("{ours:?}, MuJoCo {theirs:?}"),
        );
        measured.agrees().then_some(measured)
    }
}

#[cfg(test)]
mod tests {
    use super::Slack;

    #[test]
    fn accelerations_agree_up_to_four_times_the_cost_and_no_further() {
        let slack = Slack {
            cost: 1e-8,
            inertia: vec![2.0, 0.5, 0.5, 1.0],
        };
        // d' M d / 2 = s^2 (2 + 2 * 0.5 * 2 + 4) / 2 = 4 s^2 for d = s (1, 2)
        let at = |s: f64| slack.accelerations(&[3.0 + s, 7.0 + 2.0 * s], &[3.0, 7.0]);
        assert!(at(0.0).is_some());
        assert!((at(0.5e-4).expect("a measure").error - 1.0).abs() < 1e-6);
        assert!(at(0.99e-4).is_some());
        assert!(at(1.01e-4).is_none());
        assert!(at(f64::NAN).is_none());
        // the same over a time step of 2 ms
        let at = |s: f64| slack.velocities(&[0.002 * s, 0.004 * s], &[0.0, 0.0], 0.002);
        assert!(at(0.99e-4).is_some() && at(1.01e-4).is_none());
        // a side that is only heavy: the same distance costs more
        let heavy = Slack {
            cost: 1e-8,
            inertia: vec![200.0, 0.0, 0.0, 1.0],
        };
        assert!(heavy.accelerations(&[0.99e-4, 0.0], &[0.0, 0.0]).is_none());
    }

    #[test]
    fn forces_count_by_the_acceleration_that_they_are() {
        let slack = Slack {
            cost: 1e-8,
            inertia: vec![2.0, 0.5, 0.5, 1.0],
        };
        // M d for d = (1, 2)
        let of_force = slack.force_norm(&[3.0 + 3.0, 1.0 + 2.5], &[3.0, 1.0]);
        assert!((of_force - slack.norm(&[1.0, 2.0], &[0.0, 0.0])).abs() < 1e-12);
    }

    #[test]
    fn a_document_that_asks_for_no_tolerance_gets_none() {
        let slack = Slack {
            cost: 0.0,
            inertia: vec![1.0],
        };
        assert!(slack.accelerations(&[1e-30], &[0.0]).is_none());
    }
}
