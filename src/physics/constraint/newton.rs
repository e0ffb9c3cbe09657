//! Newton's method on the accelerations, island by island.

use crate::math::MINVAL;
use crate::model::Model;
use crate::physics::constraint::cone::{Zone, evaluate};
use crate::physics::constraint::hessian::Hessian;
use crate::physics::constraint::line_search::LineSearch;
use crate::physics::constraint::{Block, Efc};
use crate::physics::state::State;
use crate::physics::topology::Topology;

/// The constraint solver and its working memory.
#[derive(Clone, Debug, Default)]
pub struct Newton {
    hessian: Hessian,
    line: LineSearch,
    /// Union-find over trees.
    parent: Vec<usize>,
    /// Trees of the island at hand.
    trees: Vec<usize>,
    /// Blocks of the island at hand.
    blocks: Vec<u32>,
    /// Island (root tree) of each block.
    block_root: Vec<usize>,
    /// Degrees of freedom, full length; only the island's entries are touched.
    ma: Vec<f64>,
    gradient: Vec<f64>,
    search: Vec<f64>,
    m_search: Vec<f64>,
    /// Rows, full length.
    jar: Vec<f64>,
    jv: Vec<f64>,
    zones: Vec<Zone>,
}

impl Newton {
    /// With memory for `nv` degrees of freedom and `contacts` contacts, so that solving need not allocate.
    pub fn with_capacity(nv: usize, contacts: usize) -> Self {
        let (blocks, rows) = (contacts + 4 * nv, 4 * contacts + 4 * nv);
        Self {
            hessian: Hessian::with_capacity(nv, contacts),
            line: LineSearch::with_capacity(nv, contacts),
            blocks: Vec::with_capacity(blocks),
            block_root: Vec::with_capacity(blocks),
            zones: Vec::with_capacity(blocks),
            jar: Vec::with_capacity(rows),
            jv: Vec::with_capacity(rows),
            ..Self::default()
        }
    }

    /// Computes `qacc, qfrc_constraint`, the row forces and the contact forces. Starts from `qacc_warmstart` or
    /// `qacc_smooth`, whichever costs less, and stops when the improvement or the gradient, scaled by the mean inertia,
    /// falls below `opt.tolerance`.
    pub fn solve(&mut self, model: &Model, topology: &Topology, s: &mut State) {
        s.qacc.copy_from_slice(&s.qacc_smooth);
        s.qfrc_constraint.fill(0.0);
        s.solver_iterations = 0;
        if s.efc.nefc() > 0 {
            let (nv, nefc) = (model.nv, s.efc.nefc());
            for v in [&mut self.ma, &mut self.gradient, &mut self.search, &mut self.m_search] {
                v.resize(nv, 0.0);
            }
            self.jar.resize(nefc, 0.0);
            self.jv.resize(nefc, 0.0);
            self.find_islands(topology, &s.efc);
            for root in 0..topology.ntree() {
                self.blocks.clear();
                self.blocks
                    .extend((0..s.efc.blocks.len() as u32).filter(|&k| self.block_root[k as usize] == root));
                if self.blocks.is_empty() {
                    continue;
                }
                self.trees.clear();
                for t in root..topology.ntree() {
                    if find(&mut self.parent, t) == root {
                        self.trees.push(t);
                    }
                }
                self.island(model, topology, s);
            }
            for b in &s.efc.blocks {
                add_transposed(&s.efc, b, 1.0, &s.efc.force, &mut s.qfrc_constraint);
            }
        }
        for c in &mut s.contacts {
            c.force = [0.0; 6];
            if let Some(row) = c.efc_address {
                c.force[..c.dim].copy_from_slice(&s.efc.force[row..row + c.dim]);
            }
        }
        s.qacc_warmstart.copy_from_slice(&s.qacc);
    }

    /// Trees that share a block belong together; the island's name is its first tree.
    fn find_islands(&mut self, topology: &Topology, efc: &Efc) {
        self.parent.clear();
        self.parent.extend(0..topology.ntree());
        let tree_of = |col: u32| topology.dof_tree[col as usize];
        for b in &efc.blocks {
            let cols = efc.columns(b);
            for &c in &cols[1..] {
                let (a, c) = (
                    find(&mut self.parent, tree_of(cols[0])),
                    find(&mut self.parent, tree_of(c)),
                );
                self.parent[a.max(c)] = a.min(c);
            }
        }
        self.block_root.clear();
        for b in &efc.blocks {
            self.block_root.push(find(&mut self.parent, tree_of(efc.cols[b.col])));
        }
    }

    fn island(&mut self, model: &Model, topology: &Topology, s: &mut State) {
        let State {
            efc,
            qm,
            qfrc_smooth,
            qacc_smooth,
            qacc_warmstart,
            qacc,
            solver_iterations,
            ..
        } = s;
        let problem = Problem {
            topology,
            trees: &self.trees,
            blocks: &self.blocks,
            qm,
            qfrc_smooth,
            qacc_smooth,
        };
        let mut force = std::mem::take(&mut efc.force);
        let (ma, jar, zones) = (&mut self.ma, &mut self.jar, &mut self.zones);

        let smooth_cost = problem.cost_at(efc, qacc_smooth, qfrc_smooth, jar, &mut force, zones);
        problem.mul_m(qacc_warmstart, ma);
        let mut cost = problem.cost_at(efc, qacc_warmstart, ma, jar, &mut force, zones);
        if cost < smooth_cost {
            problem.for_dofs(|d| qacc[d] = qacc_warmstart[d]);
        } else {
            // M qacc_smooth is qfrc_smooth
            problem.for_dofs(|d| (qacc[d], ma[d]) = (qacc_smooth[d], qfrc_smooth[d]));
            cost = problem.cost_at(efc, qacc_smooth, ma, jar, &mut force, zones);
        }
        let scale = 1.0 / (model.stat.meaninertia * model.nv.max(1) as f64);
        problem.gradient(efc, ma, &force, &mut self.gradient);
        self.hessian.analyse(topology, &self.trees, &self.blocks, efc);
        for _ in 0..model.opt.iterations {
            self.hessian
                .assemble(topology, problem.qm, &self.blocks, zones, efc, jar);
            self.hessian.factor();
            self.hessian.descend(&self.gradient, &mut self.search);
            problem.mul_m(&self.search, &mut self.m_search);
            problem.mul_j(efc, &self.search, &mut self.jv);
            let (mut slope, mut curvature, mut length) = (0.0, 0.0, 0.0);
            problem.for_dofs(|d| {
                slope += self.search[d] * (ma[d] - qfrc_smooth[d]);
                curvature += self.search[d] * self.m_search[d];
                length += self.search[d] * self.search[d];
            });
            let length = length.sqrt();
            if length < MINVAL {
                break;
            }
            self.line.prepare(slope, curvature, &self.blocks, efc, jar, &self.jv);
            let tolerance = model.opt.tolerance * model.opt.ls_tolerance * length / scale;
            let alpha = self.line.minimise(tolerance, model.opt.ls_iterations);
            if alpha == 0.0 {
                break;
            }
            *solver_iterations += 1;
            problem.for_dofs(|d| {
                qacc[d] += alpha * self.search[d];
                ma[d] += alpha * self.m_search[d];
            });
            problem.for_rows(efc, |i| jar[i] += alpha * self.jv[i]);
            let previous = cost;
            cost = problem.cost(efc, qacc, ma, jar, &mut force, zones);
            problem.gradient(efc, ma, &force, &mut self.gradient);
            let mut norm = 0.0;
            problem.for_dofs(|d| norm += self.gradient[d] * self.gradient[d]);
            if scale * (previous - cost) < model.opt.tolerance || scale * norm.sqrt() < model.opt.tolerance {
                break;
            }
        }
        efc.force = force;
    }
}

/// Root of a tree's island, with path halving.
fn find(parent: &mut [usize], mut t: usize) -> usize {
    while parent[t] != t {
        parent[t] = parent[parent[t]];
        t = parent[t];
    }
    t
}

/// `out += sign J' force` of one block.
#[inline]
fn add_transposed(efc: &Efc, b: &Block, sign: f64, force: &[f64], out: &mut [f64]) {
    let (cols, jac) = (efc.columns(b), efc.jacobian(b));
    for r in 0..b.dim {
        let f = sign * force[b.row + r];
        if f != 0.0 {
            for (&c, j) in cols.iter().zip(&jac[r * b.ncol..]) {
                out[c as usize] += j * f;
            }
        }
    }
}

/// What does not change while an island is solved.
struct Problem<'a> {
    topology: &'a Topology,
    trees: &'a [usize],
    blocks: &'a [u32],
    qm: &'a [f64],
    qfrc_smooth: &'a [f64],
    qacc_smooth: &'a [f64],
}

impl Problem<'_> {
    #[inline]
    fn for_dofs(&self, mut f: impl FnMut(usize)) {
        for &t in self.trees {
            for d in self.topology.tree_adr[t]..self.topology.tree_adr[t + 1] {
                f(d);
            }
        }
    }

    #[inline]
    fn for_rows(&self, efc: &Efc, mut f: impl FnMut(usize)) {
        for &k in self.blocks {
            let b = &efc.blocks[k as usize];
            for i in b.row..b.row + b.dim {
                f(i);
            }
        }
    }

    /// `out = M x` on the island.
    fn mul_m(&self, x: &[f64], out: &mut [f64]) {
        let adr = &self.topology.row_adr;
        self.for_dofs(|d| out[d] = 0.0);
        self.for_dofs(|i| {
            let (start, diag) = (adr[i], adr[i + 1] - 1);
            let xi = x[i];
            let mut sum = self.qm[diag] * xi;
            for (&j, &v) in self.topology.chain[start..diag].iter().zip(&self.qm[start..diag]) {
                sum += v * x[j as usize];
                out[j as usize] += v * xi;
            }
            out[i] += sum;
        });
    }

    /// `out = J x` on the island's rows.
    fn mul_j(&self, efc: &Efc, x: &[f64], out: &mut [f64]) {
        for &k in self.blocks {
            let b = &efc.blocks[k as usize];
            if b.ncol == 1 {
                out[b.row] = efc.jac[b.jac] * x[efc.cols[b.col] as usize];
                continue;
            }
            let (cols, jac) = (efc.columns(b), efc.jacobian(b));
            for r in 0..b.dim {
                let mut sum = 0.0;
                for (&c, j) in cols.iter().zip(&jac[r * b.ncol..]) {
                    sum += j * x[c as usize];
                }
                out[b.row + r] = sum;
            }
        }
    }

    /// Cost at `x` with `ma` up to date; fills `jar`, the forces and the zones.
    fn cost_at(
        &self,
        efc: &Efc,
        x: &[f64],
        ma: &[f64],
        jar: &mut [f64],
        force: &mut [f64],
        zones: &mut Vec<Zone>,
    ) -> f64 {
        self.mul_j(efc, x, jar);
        self.for_rows(efc, |i| jar[i] -= efc.aref[i]);
        self.cost(efc, x, ma, jar, force, zones)
    }

    /// Cost at `x` with `ma` and `jar` up to date.
    fn cost(&self, efc: &Efc, x: &[f64], ma: &[f64], jar: &[f64], force: &mut [f64], zones: &mut Vec<Zone>) -> f64 {
        let mut cost = 0.0;
        self.for_dofs(|d| cost += 0.5 * (ma[d] - self.qfrc_smooth[d]) * (x[d] - self.qacc_smooth[d]));
        zones.clear();
        for &k in self.blocks {
            let b = &efc.blocks[k as usize];
            let rows = b.row..b.row + b.dim;
            let (c, zone) = evaluate(
                b,
                &jar[rows.clone()],
                &efc.d[rows.clone()],
                &efc.r[rows.clone()],
                &mut force[rows],
            );
            cost += c;
            zones.push(zone);
        }
        cost
    }

    /// `gradient = M x - qfrc_smooth - J' force`
    fn gradient(&self, efc: &Efc, ma: &[f64], force: &[f64], gradient: &mut [f64]) {
        self.for_dofs(|d| gradient[d] = ma[d] - self.qfrc_smooth[d]);
        for &k in self.blocks {
            let b = &efc.blocks[k as usize];
            add_transposed(efc, b, -1.0, force, gradient);
        }
    }
}
