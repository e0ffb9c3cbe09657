//! What the dynamics derives from a model's tree once: ancestor chains, trees, and the packed layout of the inertia.

use crate::model::Model;

/// Derived structure of a [`Model`].
///
/// A *tree* is a set of degrees of freedom that depend on each other, a consecutive range. Row `i` of the joint-space
/// inertia is nonzero for `i` and its ancestors only. Rows are packed one after the other, ancestors ascending, the
/// diagonal last; the chain of an ancestor is a prefix of the chain of its descendant, so factorisation works on
/// consecutive memory.
#[derive(Clone, Debug)]
pub struct Topology {
    /// First degree of freedom of each tree, and one past the last: `ntree + 1` values.
    pub tree_adr: Vec<usize>,
    /// Tree of each degree of freedom.
    pub dof_tree: Vec<usize>,
    /// Start of each row of the packed inertia; `nv + 1` values. Also the layout of `chain`.
    pub row_adr: Vec<usize>,
    /// Ancestors of each degree of freedom, ascending, itself last.
    pub chain: Vec<u32>,
    /// The last degree of freedom that moves a body, if any does.
    pub body_last_dof: Vec<Option<usize>>,
}

impl Topology {
    /// Derives the structure of `model`.
    pub fn new(model: &Model) -> Self {
        let nv = model.nv;
        let mut tree_adr = Vec::new();
        let mut dof_tree = vec![0; nv];
        let mut row_adr = vec![0; nv + 1];
        let mut chain: Vec<u32> = Vec::new();
        for d in 0..nv {
            match model.dof_parentid[d] {
                None => tree_adr.push(d),
                Some(p) => chain.extend_from_within(row_adr[p]..row_adr[p + 1]),
            }
            chain.push(d as u32);
            row_adr[d + 1] = chain.len();
            dof_tree[d] = tree_adr.len() - 1;
        }
        tree_adr.push(nv);
        let mut body_last_dof = vec![None; model.nbody()];
        for b in 1..model.nbody() {
            body_last_dof[b] = match model.body_dofnum[b] {
                0 => body_last_dof[model.body_parentid[b]],
                n => Some(model.body_dofadr[b] + n - 1),
            };
        }
        Self {
            tree_adr,
            dof_tree,
            row_adr,
            chain,
            body_last_dof,
        }
    }

    /// Number of trees.
    pub fn ntree(&self) -> usize {
        self.tree_adr.len() - 1
    }

    /// Number of values in the packed inertia.
    pub fn nm(&self) -> usize {
        self.chain.len()
    }

    /// Ancestors of `dof`, ascending, itself last.
    #[inline]
    pub fn dof_chain(&self, dof: usize) -> &[u32] {
        &self.chain[self.row_adr[dof]..self.row_adr[dof + 1]]
    }

    /// Degrees of freedom that move `body`, ascending.
    #[inline]
    pub fn body_chain(&self, body: usize) -> &[u32] {
        match self.body_last_dof[body] {
            Some(d) => self.dof_chain(d),
            None => &[],
        }
    }
}
