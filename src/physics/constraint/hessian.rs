//! The Hessian `M + J' C J` of an island: sparsity, assembly, factorisation.

use crate::physics::constraint::cone::{Zone, cone_hessian};
use crate::physics::constraint::{Block, Efc};
use crate::physics::topology::Topology;

/// Consecutive columns of a block: first and one past the last entry, and local index of the first.
type ColumnRun = (u32, u32, u32);

/// A symmetric positive matrix over the degrees of freedom of an island, dense rows (lower triangle) with known zeros.
///
/// The zeros are those of `L' D L` elimination from the last row to the first: a limb touches only its own chain, so the
/// pattern of the inertia survives contacts with fixed things, and self-contact couples two chains.
#[derive(Clone, Debug, Default)]
pub struct Hessian {
    n: usize,
    /// Local index of each degree of freedom of the island (nv).
    local: Vec<u32>,
    /// Degree of freedom of each local index.
    dofs: Vec<u32>,
    bits: Vec<u64>,
    /// Runs (start, length) of nonzeros left of the diagonal.
    runs: Vec<(u32, u32)>,
    run_adr: Vec<usize>,
    block_runs: Vec<ColumnRun>,
    block_run_adr: Vec<usize>,
    h: Vec<f64>,
    diag_inv: Vec<f64>,
    x: Vec<f64>,
    weighted: Vec<f64>,
}

impl Hessian {
    /// Finds the pattern for the island made of `trees` and `blocks` (indices into `efc.blocks`).
    pub fn analyse(&mut self, topology: &Topology, trees: &[usize], blocks: &[u32], efc: &Efc) {
        self.local.resize(topology.dof_tree.len(), 0);
        self.dofs.clear();
        for &t in trees {
            for d in topology.tree_adr[t]..topology.tree_adr[t + 1] {
                self.local[d] = self.dofs.len() as u32;
                self.dofs.push(d as u32);
            }
        }
        self.n = self.dofs.len();
        let (n, words) = (self.n, self.n.div_ceil(64));
        self.bits.clear();
        self.bits.resize(n * words, 0);
        let mut set = |i: usize, j: usize| self.bits[i * words + j / 64] |= 1 << (j % 64);
        for i in 0..n {
            for &a in topology.dof_chain(self.dofs[i] as usize) {
                set(i, self.local[a as usize] as usize);
            }
        }
        self.block_runs.clear();
        self.block_run_adr.clear();
        for &k in blocks {
            let cols = efc.columns(&efc.blocks[k as usize]);
            self.block_run_adr.push(self.block_runs.len());
            let mut c = 0;
            while c < cols.len() {
                let (start, first) = (c, self.local[cols[c] as usize]);
                while c < cols.len() && self.local[cols[c] as usize] == first + (c - start) as u32 {
                    c += 1;
                }
                self.block_runs.push((start as u32, c as u32, first));
            }
            for (a, &col) in cols.iter().enumerate().skip(1) {
                let i = self.local[col as usize] as usize;
                for &other in &cols[..a] {
                    set(i, self.local[other as usize] as usize);
                }
            }
        }
        self.block_run_adr.push(self.block_runs.len());
        self.fill_in(words);
        self.h.clear();
        self.h.resize(n * n, 0.0);
        self.diag_inv.resize(n, 0.0);
        self.x.resize(n, 0.0);
    }

    /// Symbolic elimination, then runs of each row.
    fn fill_in(&mut self, words: usize) {
        let n = self.n;
        for i in (0..n).rev() {
            let row = i * words;
            // drop the diagonal, then hand the row to its last nonzero column
            self.bits[row + i / 64] &= !(1 << (i % 64));
            let last = (0..words).rev().find(|&w| self.bits[row + w] != 0);
            if let Some(w) = last {
                let j = w * 64 + 63 - self.bits[row + w].leading_zeros() as usize;
                for w in 0..words {
                    let mut v = self.bits[row + w];
                    if w == j / 64 {
                        v &= !(1 << (j % 64));
                    }
                    self.bits[j * words + w] |= v;
                }
            }
        }
        self.runs.clear();
        self.run_adr.clear();
        for i in 0..n {
            self.run_adr.push(self.runs.len());
            let has = |j: usize| self.bits[i * words + j / 64] >> (j % 64) & 1 == 1;
            let mut j = 0;
            while j < i {
                if !has(j) {
                    j += 1;
                    continue;
                }
                let start = j;
                while j < i && has(j) {
                    j += 1;
                }
                self.runs.push((start as u32, (j - start) as u32));
            }
        }
        self.run_adr.push(self.runs.len());
    }

    /// Assembles the Hessian at `jar`, with the zone of each block.
    pub fn assemble(
        &mut self,
        topology: &Topology,
        qm: &[f64],
        blocks: &[u32],
        zones: &[Zone],
        efc: &Efc,
        jar: &[f64],
    ) {
        let n = self.n;
        for i in 0..n {
            for &(start, len) in &self.runs[self.run_adr[i]..self.run_adr[i + 1]] {
                self.h[i * n + start as usize..][..len as usize].fill(0.0);
            }
            let d = self.dofs[i] as usize;
            let row = &mut self.h[i * n..(i + 1) * n];
            for (k, &a) in topology.dof_chain(d).iter().enumerate() {
                row[self.local[a as usize] as usize] = qm[topology.row_adr[d] + k];
            }
        }
        for (index, &k) in blocks.iter().enumerate() {
            let b = &efc.blocks[k as usize];
            let zone = zones[index];
            if zone == Zone::Flat {
                continue;
            }
            if b.dim == 1 && b.ncol == 1 {
                let i = self.local[efc.cols[b.col] as usize] as usize;
                let j = efc.jac[b.jac];
                self.h[i * n + i] += efc.d[b.row] * j * j;
                continue;
            }
            self.weigh(b, zone, efc, jar);
            self.add_block(index, b, efc);
        }
    }

    /// `weighted = C J` for one block.
    fn weigh(&mut self, b: &Block, zone: Zone, efc: &Efc, jar: &[f64]) {
        let (n, jac, rows) = (b.ncol, efc.jacobian(b), b.row..b.row + b.dim);
        self.weighted.clear();
        self.weighted.resize(b.dim * n, 0.0);
        if zone == Zone::Quadratic {
            for (r, &d) in efc.d[rows].iter().enumerate() {
                for (w, j) in self.weighted[r * n..(r + 1) * n].iter_mut().zip(&jac[r * n..]) {
                    *w = d * j;
                }
            }
        } else {
            let mut c = [0.0; 36];
            cone_hessian(b, &jar[rows.clone()], &efc.d[rows], &mut c);
            for r in 0..b.dim {
                for q in 0..b.dim {
                    let v = c[r * b.dim + q];
                    for (w, j) in self.weighted[r * n..(r + 1) * n].iter_mut().zip(&jac[q * n..]) {
                        *w += v * j;
                    }
                }
            }
        }
    }

    /// Adds `J' weighted` of one block to the lower triangle.
    fn add_block(&mut self, index: usize, b: &Block, efc: &Efc) {
        let (n, m, jac) = (self.n, b.ncol, efc.jacobian(b));
        let runs = &self.block_runs[self.block_run_adr[index]..self.block_run_adr[index + 1]];
        for (a, &col) in efc.columns(b).iter().enumerate() {
            let i = self.local[col as usize] as usize;
            let row = &mut self.h[i * n..i * n + i + 1];
            for &(start, end, first) in runs {
                let start = start as usize;
                if start > a {
                    break;
                }
                let len = (end as usize).min(a + 1) - start;
                let target = &mut row[first as usize..first as usize + len];
                if b.dim == 3 {
                    let (j0, j1, j2) = (jac[a], jac[m + a], jac[2 * m + a]);
                    let w0 = &self.weighted[start..start + len];
                    let w1 = &self.weighted[m + start..m + start + len];
                    let w2 = &self.weighted[2 * m + start..2 * m + start + len];
                    for k in 0..len {
                        target[k] += j0 * w0[k] + j1 * w1[k] + j2 * w2[k];
                    }
                } else {
                    for r in 0..b.dim {
                        let j = jac[r * m + a];
                        for (t, w) in target.iter_mut().zip(&self.weighted[r * m + start..]) {
                            *t += j * w;
                        }
                    }
                }
            }
        }
    }

    /// Factorises in place, `H = L' D L`.
    pub fn factor(&mut self) {
        let n = self.n;
        for i in (0..n).rev() {
            let (head, tail) = self.h.split_at_mut(i * n);
            let row = &mut tail[..=i];
            let inv = 1.0 / row[i];
            self.diag_inv[i] = inv;
            let runs = &self.runs[self.run_adr[i]..self.run_adr[i + 1]];
            for (k, &(start, len)) in runs.iter().enumerate() {
                let (start, end) = (start as usize, (start + len) as usize);
                for j in start..end {
                    let t = row[j] * inv;
                    if t == 0.0 {
                        continue;
                    }
                    let target = &mut head[j * n..j * n + j + 1];
                    for &(s, l) in &runs[..k] {
                        subtract(&mut target[s as usize..(s + l) as usize], &row[s as usize..], t);
                    }
                    subtract(&mut target[start..], &row[start..], t);
                }
            }
            for &(start, len) in runs {
                for v in &mut row[start as usize..(start + len) as usize] {
                    *v *= inv;
                }
            }
        }
    }

    /// `out = -H^-1 gradient` on the island's degrees of freedom (both nv).
    pub fn descend(&mut self, gradient: &[f64], out: &mut [f64]) {
        let n = self.n;
        let x = &mut self.x;
        for (v, &d) in x.iter_mut().zip(&self.dofs) {
            *v = -gradient[d as usize];
        }
        for i in (0..n).rev() {
            let xi = x[i];
            if xi != 0.0 {
                for &(s, l) in &self.runs[self.run_adr[i]..self.run_adr[i + 1]] {
                    let (s, e) = (s as usize, (s + l) as usize);
                    subtract(&mut x[s..e], &self.h[i * n + s..], xi);
                }
            }
        }
        for (v, inv) in x.iter_mut().zip(&self.diag_inv) {
            *v *= inv;
        }
        for i in 0..n {
            let mut sum = 0.0;
            for &(s, l) in &self.runs[self.run_adr[i]..self.run_adr[i + 1]] {
                let (s, e) = (s as usize, (s + l) as usize);
                for (a, b) in x[s..e].iter().zip(&self.h[i * n + s..]) {
                    sum += a * b;
                }
            }
            x[i] -= sum;
        }
        for (v, &d) in x.iter().zip(&self.dofs) {
            out[d as usize] = *v;
        }
    }
}

/// `a -= t b`, over the length of `a`.
#[inline(always)]
fn subtract(a: &mut [f64], b: &[f64], t: f64) {
    for (x, y) in a.iter_mut().zip(b) {
        *x -= t * y;
    }
}
