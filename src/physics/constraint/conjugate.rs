//! Directions of conjugate gradients (MuJoCo's solver `CG`).

use super::island::Island;
use crate::dynamics::{Articulated, Damping};
use crate::math::MINVAL;
use crate::model::Model;
use crate::state::State;
use crate::tiles::{Lanes, total};
use crate::topology::Topology;

/// Finds directions by the rule of Polak and Ribiere, with the inertia as preconditioner, and holds the working memory. There is a single island of
/// all trees.
#[derive(Clone, Debug, Default)]
pub(super) struct ConjugateGradient {
    /// The gradient, and `M^-1` times it (nv).
    gradient: Vec<f64>,
    solution: Vec<f64>,
    /// `M^-1` times the gradient, in lanes.
    descent: Vec<Lanes>,
    /// Both at the start of the last direction.
    old_gradient: Vec<Lanes>,
    old_descent: Vec<Lanes>,
}

impl ConjugateGradient {
    /// Reserves memory for `nv` degrees of freedom.
    pub fn with_capacity(nv: usize) -> Self {
        let lanes = || Vec::with_capacity(nv);
        Self {
            gradient: Vec::with_capacity(nv),
            solution: Vec::with_capacity(nv),
            descent: lanes(),
            old_gradient: lanes(),
            old_descent: lanes(),
        }
    }

    /// Sets the search direction of an island from its gradient and, except for the first, from the previous direction.
    #[doc(alias = "mj_solCG")]
    pub fn descend(
        &mut self,
        model: &Model,
        topology: &Topology,
        bodies: &mut Articulated,
        s: &State,
        (island, first): (&mut Island, bool),
    ) {
        self.gradient.resize(model.nv, 0.0);
        self.solution.resize(model.nv, 0.0);
        topology.read_lanes(&island.gradient, &mut self.gradient);
        bodies.solve(s, Damping::Without, &self.gradient, &mut self.solution);
        self.descent.clear();
        self.descent.resize(island.gradient.len(), [0.0; 4]);
        topology.to_lanes(&self.solution, &mut self.descent);
        let beta = if first { 0.0 } else { self.weight(&island.gradient) };
        for (search, descent) in island.search.iter_mut().zip(&self.descent) {
            for k in 0..4 {
                search[k] = beta * search[k] - descent[k];
            }
        }
        self.old_gradient.clone_from(&island.gradient);
        self.old_descent.clone_from(&self.descent);
    }

    /// Returns the weight of the last direction: 0 if the rule gives a negative one.
    fn weight(&self, gradient: &[Lanes]) -> f64 {
        let (mut above, mut below) = ([0.0; 4], [0.0; 4]);
        let old = self.old_gradient.iter().zip(&self.old_descent);
        for ((g, d), (old_g, old_d)) in gradient.iter().zip(&self.descent).zip(old) {
            for k in 0..4 {
                above[k] += g[k] * (d[k] - old_d[k]);
                below[k] += old_g[k] * old_d[k];
            }
        }
        (total(&above) / total(&below).max(MINVAL)).max(0.0)
    }
}
