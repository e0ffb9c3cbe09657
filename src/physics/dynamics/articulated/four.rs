//! Four right sides at once: what one lane computes is what [`Articulated::solve`] does, to the bit.

use std::ops::Range;

use super::Articulated;
use crate::model::Arrays;
use crate::physics::spatial::Spatial;
use crate::physics::state::State;

/// A number of each of four right sides, or solutions.
pub type Four = [f64; 4];

/// A force or a motion of each.
type Four6 = [Four; 6];

/// Working memory: bodies, bodies, degrees of freedom.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    force: Vec<Four6>,
    acc: Vec<Four6>,
    rest: Vec<Four>,
}

impl Articulated {
    /// Solves `M x = b` for four right sides (nv each), without damping, for the degrees of freedom of some bodies that hold whole
    /// trees; the rest of `x` stays as it is.
    #[inline(always)]
    pub fn solve_four(&mut self, model: &Arrays, s: &State, bodies: Range<usize>, b: &[Four], x: &mut [Four]) {
        let nb = model.nbody();
        let Memory { force, acc, rest } = &mut self.four;
        force.resize(nb, [[0.0; 4]; 6]);
        force[bodies.clone()].fill([[0.0; 4]; 6]);
        acc.resize(nb, [[0.0; 4]; 6]);
        rest.resize(model.nv, [0.0; 4]);
        let dofs = |body: usize| model.body_dofadr[body]..model.body_dofadr[body] + model.body_dofnum[body];
        for body in bodies.clone().rev() {
            let mut f = force[body];
            for d in dofs(body).rev() {
                let released = &self.released[d];
                let moved = power(&s.cdof[d], &f);
                let share = std::array::from_fn(|l| b[d][l] - moved[l]);
                rest[d] = share;
                add(
                    &mut f,
                    share.map(|v| v * released.inverse[0]),
                    &released.unit_force.map(|v| v[0]),
                );
            }
            let p = model.body_parentid[body];
            // what is below a tree does not move
            if bodies.contains(&p) {
                for (sum, v) in force[p].as_flattened_mut().iter_mut().zip(f.as_flattened()) {
                    *sum += v;
                }
            }
        }
        for body in bodies.clone() {
            let p = model.body_parentid[body];
            let mut a = if bodies.contains(&p) { acc[p] } else { [[0.0; 4]; 6] };
            for d in dofs(body) {
                let released = &self.released[d];
                let carried = power(&released.unit_force.map(|v| v[0]), &a);
                x[d] = std::array::from_fn(|l| (rest[d][l] - carried[l]) * released.inverse[0]);
                add(&mut a, x[d], &s.cdof[d]);
            }
            acc[body] = a;
        }
    }
}

/// Returns the products of one motion, or force, with four.
#[inline(always)]
fn power(one: &Spatial, four: &Four6) -> Four {
    let mut sum = four[0].map(|v| one[0] * v);
    for (a, row) in one.iter().zip(four).skip(1) {
        for (s, v) in sum.iter_mut().zip(row) {
            *s += a * v;
        }
    }
    sum
}

/// Adds four multiples of one.
#[inline(always)]
fn add(four: &mut Four6, factors: Four, one: &Spatial) {
    for (row, v) in four.iter_mut().zip(one) {
        for (sum, factor) in row.iter_mut().zip(factors) {
            *sum += factor * v;
        }
    }
}
