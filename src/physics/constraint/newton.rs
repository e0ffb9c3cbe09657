//! Newton's method on the accelerations, island by island; conjugate gradients in the same way.

use std::ops::Range;

use super::cone::FrictionCone;
use super::conjugate::ConjugateGradient;
use super::hessian::Hessian;
use super::island::{AlongSearch, Island};
use super::line_search::LineSearch;
use super::{Block, ConstraintType, Efc};
use crate::dynamics::Articulated;
use crate::math::MINVAL;
use crate::model::{Model, SolverType};
use crate::state::State;
use crate::topology::Topology;
use crate::vectorize::vectorize;

/// Solves for the accelerations under constraints; holds the working memory.
#[derive(Clone, Debug, Default)]
pub struct NewtonSolver {
    island: Island,
    hessian: Hessian,
    conjugate: ConjugateGradient,
    /// Union-find over trees.
    parent: Vec<usize>,
    /// The next tree of the same island, ascending; for the last one, the number of trees.
    next: Vec<usize>,
    /// Trees of the current island.
    trees: Vec<usize>,
    /// Island (first tree) of each block.
    block_tree: Vec<u32>,
    /// Blocks, by island.
    blocks: Vec<u32>,
    /// First block of each island, by its first tree.
    block_adr: Vec<usize>,
}

impl NewtonSolver {
    /// Reserves memory for the degrees of freedom of a model and `contacts` contacts, so that solving need not allocate.
    pub fn with_capacity(topology: &Topology, nv: usize, contacts: usize) -> Self {
        let blocks = contacts + 4 * nv;
        Self {
            island: Island::with_capacity(topology.tiles.tiles(), nv, contacts),
            hessian: Hessian::with_capacity(nv, contacts),
            conjugate: ConjugateGradient::with_capacity(nv),
            parent: Vec::with_capacity(nv),
            next: Vec::with_capacity(nv),
            trees: Vec::with_capacity(nv),
            block_tree: Vec::with_capacity(blocks),
            blocks: Vec::with_capacity(blocks),
            block_adr: Vec::with_capacity(nv + 3),
        }
    }

    /// Computes `qacc, qfrc_constraint`, the row forces and the contact forces. Starts from `qacc_warmstart` or
    /// `qacc_smooth`, whichever costs less, and stops when the improvement or the gradient, scaled by the mean inertia,
    /// falls below `opt.tolerance`. `bodies` must be up to date.
    #[doc(alias("mj_fwdConstraint", "mj_solNewton"))]
    #[inline(always)]
    pub fn solve(&mut self, model: &Model, topology: &Topology, bodies: &mut Articulated, s: &mut State) {
        s.qacc.copy_from_slice(&s.qacc_smooth);
        s.qfrc_constraint.fill(0.0);
        s.solver_iterations = 0;
        if s.efc.nefc() > 0 {
            let mut efc = std::mem::take(&mut s.efc);
            self.find_islands(topology, &efc, cut_off(model));
            let idle = self.block_adr[topology.ntree()]..self.blocks.len();
            for &k in &self.blocks[idle] {
                let block = efc.blocks[k as usize];
                push_alone(&block, &mut efc);
            }
            for root in 0..topology.ntree() {
                let blocks = self.block_adr[root]..self.block_adr[root + 1];
                if blocks.is_empty() {
                    continue;
                }
                self.trees.clear();
                let mut tree = root;
                while tree < topology.ntree() {
                    self.trees.push(tree);
                    tree = self.next[tree];
                }
                self.solve_island(model, topology, bodies, blocks, &mut efc, s);
            }
            s.efc = efc;
        }
        s.qacc_warmstart.copy_from_slice(&s.qacc);
    }

    /// Finds the islands and sorts the blocks by island.
    ///
    /// Trees that share a block belong together, with `all` any trees; the island's name is its first tree.
    #[inline(always)]
    fn find_islands(&mut self, topology: &Topology, efc: &Efc, all: bool) {
        let ntree = topology.ntree();
        self.parent.clear();
        self.parent.extend(0..ntree);
        self.block_tree.clear();
        for b in &efc.blocks {
            if b.ncol == 0 {
                // behind all trees
                self.block_tree.push(ntree as u32);
                continue;
            }
            let first = topology.tile_tree(efc.cols[b.col] as usize);
            let mut last = first;
            for &tile in &efc.cols[b.col + 1..b.col + b.ncol] {
                let tree = topology.tile_tree(tile as usize);
                if tree != last {
                    let (a, c) = (find(&mut self.parent, first), find(&mut self.parent, tree));
                    // the lower number becomes the root, so that an island is named by its first tree whatever the
                    // order of the contacts
                    self.parent[a.max(c)] = a.min(c);
                    last = tree;
                }
            }
            self.block_tree.push(first as u32);
        }
        if all {
            self.parent.fill(0);
        }
        for t in 0..ntree {
            self.parent[t] = find(&mut self.parent, t);
        }
        // lists of the trees of each island, filled from their ends
        self.next.clear();
        self.next.resize(ntree, ntree);
        // each tree is put right behind the root, so going down leaves the list ascending
        for t in (0..ntree).rev() {
            let root = self.parent[t];
            if root != t {
                self.next[t] = std::mem::replace(&mut self.next[root], t);
            }
        }
        // counting sort
        self.block_adr.clear();
        self.block_adr.resize(ntree + 3, 0);
        for tree in &mut self.block_tree {
            *tree = self.parent.get(*tree as usize).map_or(*tree, |&root| root as u32);
            self.block_adr[*tree as usize + 2] += 1;
        }
        for t in 0..ntree + 1 {
            self.block_adr[t + 2] += self.block_adr[t + 1];
        }
        self.blocks.clear();
        self.blocks.resize(efc.blocks.len(), 0);
        for (k, &tree) in self.block_tree.iter().enumerate() {
            let place = &mut self.block_adr[tree as usize + 1];
            self.blocks[*place] = k as u32;
            *place += 1;
        }
    }

    /// Loads an island and chooses where to start; returns the cost there and the length of its gradient.
    #[inline(always)]
    fn begin(&mut self, model: &Model, topology: &Topology, blocks: Range<usize>, efc: &Efc, s: &State) -> (f64, f64) {
        let island = &mut self.island;
        let (trees, blocks) = (&self.trees[..], &self.blocks[blocks]);
        vectorize(
            #[inline(always)]
            || island.load(topology, trees, blocks, efc, s),
        );
        let warm = if model.opt.flags.warmstart {
            &s.qacc_warmstart
        } else {
            &s.qacc_smooth
        };
        island.start(topology, warm, efc)
    }

    /// Returns whether an island with a gradient of this length needs no step: the Hessian exceeds the inertia, so its steps are bounded
    /// by the inertia's inverse.
    #[inline(always)]
    fn rests(&self, topology: &Topology, s: &State, length: f64) -> bool {
        let mobility: f64 = self
            .trees
            .iter()
            .map(|&t| topology.mobility(&s.params.dof_invweight0, t))
            .sum();
        mobility > 0.0 && length * length * mobility < MINVAL
    }

    #[inline(always)]
    fn solve_island(
        &mut self,
        model: &Model,
        topology: &Topology,
        bodies: &mut Articulated,
        blocks: Range<usize>,
        efc: &mut Efc,
        s: &mut State,
    ) {
        let (mut cost, mut length) = self.begin(model, topology, blocks, efc, s);
        let rests = self.rests(topology, s, length);
        let (island, hessian) = (&mut self.island, &mut self.hessian);
        let newton = model.opt.solver != SolverType::Cg;
        let scale = 1.0 / (model.stat.meaninertia * model.nv.max(1) as f64);
        if rests {
            island.store(topology, efc, s);
            return;
        }
        if newton {
            hessian.analyse(island);
        }
        for iteration in 0..model.opt.iterations {
            if newton {
                hessian.refresh(island, efc);
                hessian.descend(&island.gradient, &mut island.search);
            } else {
                let first = iteration == 0;
                self.conjugate
                    .descend(model, topology, bodies, s, (&mut *island, first));
            }
            island.follow_search(efc);
            let along = island.along_search();
            if along.length < MINVAL {
                break;
            }
            // a slope that is not negative comes from rounding: there is nothing left to descend. Conjugate gradients may lead upwards
            // where a search was cut off, and MuJoCo then goes back along them. Rows with nearly no regularisation are so stiff that a
            // slope of nothing can be one of forces.
            let level = || -along.slope < MINVAL && length <= BALANCED * island.constraint_force_length();
            if newton && (along.slope >= 0.0 || level()) {
                break;
            }
            for (c, _) in &mut island.cones {
                c.prepare_line();
            }
            let alpha = step_length(model, island, &along, scale);
            if alpha == 0.0 {
                break;
            }
            s.solver_iterations += 1;
            island.advance(alpha);
            let previous = cost;
            cost = island.evaluate();
            length = island.differentiate(efc);
            // MuJoCo's two criteria; it applies them to all islands at once, so where it iterates on for another island
            // it may be nearer to the minimum here
            if scale * (previous - cost) < model.opt.tolerance || scale * length < model.opt.tolerance {
                break;
            }
        }
        island.store(topology, efc, s);
    }
}

/// Returns the step length along the search direction of an island.
#[inline(always)]
fn step_length(model: &Model, island: &Island, along: &AlongSearch, scale: f64) -> f64 {
    let line = LineSearch {
        slope: along.inertial_slope,
        curvature: along.inertial_curvature,
        island,
    };
    // MuJoCo's tolerance is one of the scaled gradient: the slope is the gradient times the length of the direction
    let tolerance = model.opt.tolerance * model.opt.ls_tolerance * along.length / scale;
    if cut_off(model) {
        line.follow(tolerance, model.opt.ls_iterations)
    } else {
        vectorize(
            #[inline(always)]
            || line.minimise(1.0, tolerance, model.opt.ls_iterations),
        )
    }
}

/// Share of the constraint forces by which the balance may be violated if the solver stops because the cost is flat.
const BALANCED: f64 = 1e-6;

/// Computes the forces of a contact or weld that nothing can move: the forces of its rows at zero acceleration.
fn push_alone(b: &Block, efc: &mut Efc) {
    if b.kind == ConstraintType::ContactElliptic {
        let mut cone = FrictionCone::new(b, efc);
        cone.jar = cone.aref.map(|a| -a);
        cone.evaluate();
        efc.force[b.row..b.row + b.dim].copy_from_slice(&cone.force[..b.dim]);
    } else {
        let least = if b.kind == ConstraintType::Equality {
            f64::NEG_INFINITY
        } else {
            0.0
        };
        for row in b.row..b.row + b.dim {
            efc.force[row] = (efc.d[row] * efc.aref[row]).max(least);
        }
    }
}

/// A limit of iterations below this counts as a request to stop early. Newton's method and its line search almost never need so many.
const FEW_ITERATIONS: usize = 20;

/// Returns whether a model may stop the solver before it converges, as conjugate gradients do. Then all trees are solved as one island, including
/// those without constraints, which start from the last acceleration. The line search is MuJoCo's, so the solver stops where MuJoCo stops.
fn cut_off(model: &Model) -> bool {
    model.opt.solver == SolverType::Cg
        || model.opt.iterations < FEW_ITERATIONS
        || model.opt.ls_iterations < FEW_ITERATIONS
}

/// Finds the root of a tree's island, with path halving.
#[inline(always)]
fn find(parent: &mut [usize], mut t: usize) -> usize {
    while parent[t] != t {
        parent[t] = parent[parent[t]];
        t = parent[t];
    }
    t
}
