//! The Hessian `M + J' C J` of an island: sparsity, assembly, factorisation.

use crate::physics::constraint::cone::{Zone, cone_hessian};
use crate::physics::constraint::{Block, Efc};
use crate::physics::topology::Topology;

/// Where the entries of a block's row go in a row of the Hessian.
#[derive(Clone, Copy, Debug)]
enum Target {
    /// To consecutive places from here on.
    Run(u32),
    /// To the places listed from here on.
    List(u32),
}

/// A symmetric positive matrix over the degrees of freedom of an island; of each row the nonzeros up to the diagonal.
///
/// The pattern is that of `L' D L` elimination from the last row to the first. A limb touches only its own chain, so the
/// pattern of the inertia survives contacts with fixed things: the columns of an ancestor's row are then the first columns
/// of its descendant's, and elimination runs on consecutive memory. Self-contact couples two chains, whose rows have more.
#[derive(Clone, Debug, Default)]
pub struct Hessian {
    /// Local index of each degree of freedom of the island (nv).
    local: Vec<u32>,
    /// Degree of freedom of each local index.
    dofs: Vec<u32>,
    /// Pattern as bits, while it is found.
    bits: Vec<u64>,
    /// Columns of each row, ascending, the diagonal last.
    cols: Vec<u32>,
    row_adr: Vec<usize>,
    /// Values, laid out like `cols`.
    h: Vec<f64>,
    diag_inv: Vec<f64>,
    /// For each row of each block with several columns.
    targets: Vec<Target>,
    target_adr: Vec<usize>,
    places: Vec<u32>,
    x: Vec<f64>,
    weighted: Vec<f64>,
}

impl Hessian {
    /// With memory for `nv` degrees of freedom and `contacts` contacts.
    pub fn with_capacity(nv: usize, contacts: usize) -> Self {
        let values = nv * (nv + 1) / 2;
        Self {
            local: Vec::with_capacity(nv),
            dofs: Vec::with_capacity(nv),
            bits: Vec::with_capacity(nv * nv.div_ceil(64)),
            cols: Vec::with_capacity(values),
            row_adr: Vec::with_capacity(nv + 1),
            h: Vec::with_capacity(values),
            diag_inv: Vec::with_capacity(nv),
            targets: Vec::with_capacity(16 * contacts),
            target_adr: Vec::with_capacity(4 * nv + contacts),
            places: Vec::with_capacity(64 * contacts),
            x: Vec::with_capacity(nv),
            weighted: Vec::with_capacity(6 * nv),
        }
    }

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
        let n = self.dofs.len();
        let words = n.div_ceil(64);
        self.bits.clear();
        self.bits.resize(n * words, 0);
        for i in 0..n {
            for &a in topology.dof_chain(self.dofs[i] as usize) {
                set(&mut self.bits, words, i, self.local[a as usize] as usize);
            }
        }
        for &k in blocks {
            let cols = efc.columns(&efc.blocks[k as usize]);
            for (a, &col) in cols.iter().enumerate().skip(1) {
                let i = self.local[col as usize] as usize;
                for &other in &cols[..a] {
                    set(&mut self.bits, words, i, self.local[other as usize] as usize);
                }
            }
        }
        self.eliminate(words);
        self.h.resize(self.cols.len(), 0.0);
        self.diag_inv.resize(n, 0.0);
        self.x.resize(n, 0.0);
        self.place_blocks(blocks, efc);
    }

    /// Symbolic elimination, then the columns of each row.
    fn eliminate(&mut self, words: usize) {
        let n = self.dofs.len();
        for i in (0..n).rev() {
            let (head, row) = self.bits.split_at_mut(i * words);
            row[i / 64] &= !(1 << (i % 64));
            // a row hands its pattern to its last nonzero column
            if let Some(w) = (0..words).rev().find(|&w| row[w] != 0) {
                let j = w * 64 + 63 - row[w].leading_zeros() as usize;
                let target = &mut head[j * words..(j + 1) * words];
                for (t, r) in target.iter_mut().zip(&row[..words]) {
                    *t |= r;
                }
            }
        }
        self.cols.clear();
        self.row_adr.clear();
        for i in 0..n {
            self.row_adr.push(self.cols.len());
            for w in 0..words {
                let mut bits = self.bits[i * words + w];
                while bits != 0 {
                    self.cols.push((w * 64) as u32 + bits.trailing_zeros());
                    bits &= bits - 1;
                }
            }
            self.cols.push(i as u32);
        }
        self.row_adr.push(self.cols.len());
    }

    /// Finds where the entries of each block go.
    fn place_blocks(&mut self, blocks: &[u32], efc: &Efc) {
        self.targets.clear();
        self.target_adr.clear();
        self.places.clear();
        for &k in blocks {
            self.target_adr.push(self.targets.len());
            let cols = efc.columns(&efc.blocks[k as usize]);
            if cols.len() == 1 {
                continue;
            }
            for (a, &col) in cols.iter().enumerate() {
                let i = self.local[col as usize] as usize;
                let row = &self.cols[self.row_adr[i]..self.row_adr[i + 1]];
                let start = self.places.len();
                let mut p = 0;
                for &c in &cols[..=a] {
                    let c = self.local[c as usize];
                    while row[p] != c {
                        p += 1;
                    }
                    self.places.push(p as u32);
                }
                let first = self.places[start];
                self.targets.push(if p as u32 - first == a as u32 {
                    self.places.truncate(start);
                    Target::Run(first)
                } else {
                    Target::List(start as u32)
                });
            }
        }
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
        for (i, &d) in self.dofs.iter().enumerate() {
            let d = d as usize;
            let range = self.row_adr[i]..self.row_adr[i + 1];
            let (row, cols) = (&mut self.h[range.clone()], &self.cols[range]);
            let inertia = &qm[topology.row_adr[d]..topology.row_adr[d + 1]];
            if row.len() == inertia.len() {
                row.copy_from_slice(inertia);
            } else {
                row.fill(0.0);
                let mut p = 0;
                for (&a, &m) in topology.dof_chain(d).iter().zip(inertia) {
                    let c = self.local[a as usize];
                    while cols[p] != c {
                        p += 1;
                    }
                    row[p] = m;
                }
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
                self.h[self.row_adr[i + 1] - 1] += efc.d[b.row] * j * j;
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
        if zone == Zone::Quadratic {
            for (jac, &d) in jac.chunks_exact(n).zip(&efc.d[rows]) {
                self.weighted.extend(jac.iter().map(|j| d * j));
            }
        } else {
            self.weighted.resize(b.dim * n, 0.0);
            let mut c = [0.0; 36];
            cone_hessian(b, &jar[rows.clone()], &efc.d[rows], &mut c);
            for (r, weighted) in self.weighted.chunks_exact_mut(n).enumerate() {
                for (q, jac) in jac.chunks_exact(n).enumerate() {
                    let v = c[r * b.dim + q];
                    for (w, j) in weighted.iter_mut().zip(jac) {
                        *w += v * j;
                    }
                }
            }
        }
    }

    /// Adds `J' weighted` of one block to the lower triangle.
    fn add_block(&mut self, index: usize, b: &Block, efc: &Efc) {
        let (m, jac) = (b.ncol, efc.jacobian(b));
        for (a, &col) in efc.columns(b).iter().enumerate() {
            let i = self.local[col as usize] as usize;
            let row = &mut self.h[self.row_adr[i]..self.row_adr[i + 1]];
            match self.targets[self.target_adr[index] + a] {
                Target::Run(first) => {
                    let target = &mut row[first as usize..first as usize + a + 1];
                    let mut r = 0;
                    // three rows at a time: most contacts have three or six
                    while r + 3 <= b.dim {
                        let (j0, j1, j2) = (jac[r * m + a], jac[(r + 1) * m + a], jac[(r + 2) * m + a]);
                        let w = &self.weighted[r * m..(r + 3) * m];
                        let (w0, w1, w2) = (&w[..a + 1], &w[m..m + a + 1], &w[2 * m..2 * m + a + 1]);
                        for (k, t) in target.iter_mut().enumerate() {
                            *t += j0 * w0[k] + j1 * w1[k] + j2 * w2[k];
                        }
                        r += 3;
                    }
                    for r in r..b.dim {
                        let j = jac[r * m + a];
                        for (t, w) in target.iter_mut().zip(&self.weighted[r * m..]) {
                            *t += j * w;
                        }
                    }
                }
                Target::List(start) => {
                    let places = &self.places[start as usize..start as usize + a + 1];
                    for r in 0..b.dim {
                        let j = jac[r * m + a];
                        for (&p, w) in places.iter().zip(&self.weighted[r * m..]) {
                            row[p as usize] += j * w;
                        }
                    }
                }
            }
        }
    }

    /// Factorises in place, `H = L' D L`.
    pub fn factor(&mut self) {
        for i in (0..self.dofs.len()).rev() {
            let (head, tail) = self.h.split_at_mut(self.row_adr[i]);
            let n = self.row_adr[i + 1] - self.row_adr[i] - 1;
            let cols = &self.cols[self.row_adr[i]..][..n];
            let inv = 1.0 / tail[n];
            self.diag_inv[i] = inv;
            let row = &mut tail[..n];
            for (k, &j) in cols.iter().enumerate() {
                let t = row[k] * inv;
                let range = self.row_adr[j as usize]..self.row_adr[j as usize + 1];
                let target = &mut head[range.clone()];
                if target.len() == k + 1 {
                    // the columns of row j are the first of row i
                    for (a, b) in target.iter_mut().zip(&row[..k + 1]) {
                        *a -= t * b;
                    }
                } else if t != 0.0 {
                    let target_cols = &self.cols[range];
                    let mut p = 0;
                    for (&c, b) in cols[..k + 1].iter().zip(&row[..k + 1]) {
                        while target_cols[p] != c {
                            p += 1;
                        }
                        target[p] -= t * b;
                    }
                }
            }
            for v in row {
                *v *= inv;
            }
        }
    }

    /// `out = -H^-1 gradient` on the island's degrees of freedom (both nv).
    pub fn descend(&mut self, gradient: &[f64], out: &mut [f64]) {
        let n = self.dofs.len();
        let x = &mut self.x;
        for (v, &d) in x.iter_mut().zip(&self.dofs) {
            *v = -gradient[d as usize];
        }
        for i in (0..n).rev() {
            let xi = x[i];
            if xi != 0.0 {
                let range = self.row_adr[i]..self.row_adr[i + 1] - 1;
                for (&c, v) in self.cols[range.clone()].iter().zip(&self.h[range]) {
                    x[c as usize] -= v * xi;
                }
            }
        }
        for (v, inv) in x.iter_mut().zip(&self.diag_inv) {
            *v *= inv;
        }
        for i in 0..n {
            let range = self.row_adr[i]..self.row_adr[i + 1] - 1;
            let mut sum = 0.0;
            for (&c, v) in self.cols[range.clone()].iter().zip(&self.h[range]) {
                sum += v * x[c as usize];
            }
            x[i] -= sum;
        }
        for (v, &d) in x.iter().zip(&self.dofs) {
            out[d as usize] = *v;
        }
    }
}

#[inline]
fn set(bits: &mut [u64], words: usize, i: usize, j: usize) {
    bits[i * words + j / 64] |= 1 << (j % 64);
}
