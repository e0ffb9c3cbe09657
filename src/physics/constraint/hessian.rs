//! The Hessian `M + J' C J` of an island: sparsity, assembly, factorisation.

use super::cone::ConeZone;
use super::island::Island;
use super::jacobian::Jacobian;
use super::{Efc, MAX_ROWS};
use crate::tiles::{
    Lanes, Pattern, Tile, ZERO, add_outer_products, factor_diagonal, scale_rows, solve, solve_columns,
    sub_transposed_product, sub_transposed_product_diagonal,
};
use crate::vectorize::vectorize;

mod pattern;
mod weigh;

/// A symmetric positive matrix over the lanes of an island, kept up to date from one iteration to the next.
///
/// Elimination goes from the last row of tiles to the first, by fronts: a row, and the *update* that it and those
/// eliminated into it make to the rows of its other columns. From one iteration to the next few constraints change
/// sides, so few rows change; what has not changed, and depends on nothing that has, is kept. Kept and computed again
/// are the same bits.
#[derive(Clone, Debug, Default)]
pub(super) struct Hessian {
    words: usize,
    /// Pattern as bits, while it is found.
    bits: Vec<u64>,
    /// The pattern before elimination.
    analysed: Vec<u64>,
    pattern: Pattern,
    /// Place of tile (i, j) at `i rows + j`; only tiles of the pattern are valid.
    place: Vec<u32>,
    /// Rows eliminated into each row: the first, and the next of the same.
    child: Vec<u32>,
    sibling: Vec<u32>,
    /// First tile of each row's update: the lower triangle over its columns except the diagonal.
    update_adr: Vec<usize>,
    /// The matrix, its factor, the inverse of the factor's diagonal, the updates.
    h: Vec<Tile>,
    factor: Vec<Tile>,
    inv: Vec<Lanes>,
    update: Vec<Tile>,
    /// Rows whose entries have changed since they were factorised.
    changed: Vec<bool>,
    /// Curvatures and zones of the last assembly.
    weight: Vec<Lanes>,
    zone: Vec<ConeZone>,
    weighted: Vec<Lanes>,
}

/// Memory is reserved for islands of up to this many degrees of freedom, because some of it grows with their square.
const MANY: usize = 512;
/// No row.
const NONE: u32 = u32::MAX;

impl Hessian {
    /// Reserves memory for `nv` degrees of freedom and `contacts` contacts.
    pub(super) fn with_capacity(nv: usize, contacts: usize) -> Self {
        // tiles are mostly full, and of many trees few touch each other at a time, though toys lie in heaps
        let (rows, tiles) = (nv.min(MANY), (nv * (nv + 1) / 16).min(16 * nv));
        Self {
            words: 0,
            bits: Vec::with_capacity(rows * rows.div_ceil(64)),
            analysed: Vec::with_capacity(rows * rows.div_ceil(64)),
            pattern: Pattern::with_capacity(rows, tiles),
            place: Vec::with_capacity(rows * rows / 4),
            child: Vec::with_capacity(rows),
            sibling: Vec::with_capacity(rows),
            update_adr: Vec::with_capacity(rows),
            h: Vec::with_capacity(tiles),
            factor: Vec::with_capacity(tiles),
            inv: Vec::with_capacity(rows),
            update: Vec::with_capacity(2 * tiles),
            changed: Vec::with_capacity(rows),
            weight: Vec::with_capacity(nv + contacts),
            zone: Vec::with_capacity(contacts),
            weighted: Vec::with_capacity(6 * rows),
        }
    }

    /// Assembles and factorises the rows that have changed.
    #[inline(always)]
    pub(super) fn refresh(&mut self, island: &Island, efc: &Efc) {
        self.find_changes(island);
        self.assemble(island, efc);
        self.factorise();
    }

    /// Marks the rows whose constraints have changed their curvature since the last call.
    #[inline(always)]
    fn find_changes(&mut self, island: &Island) {
        let first = self.weight.is_empty() && self.zone.is_empty();
        // `analyse` has marked all rows
        if first {
            self.weight.extend(island.scalar_rows.iter().map(|q| q.weight));
            self.zone.extend(island.cones.iter().map(|c| c.0.zone));
            return;
        }
        for (i, (q, w)) in island.scalar_rows.iter().zip(&self.weight).enumerate() {
            // dry friction is on the diagonal alone
            if i < island.friction_tiles && q.weight != *w {
                self.changed[i] = true;
            }
        }
        let weight = |row: usize| {
            (
                island.scalar_rows[row / 4].weight[row % 4],
                self.weight[row / 4][row % 4],
            )
        };
        for s in &island.singles {
            let (now, before) = weight(s.row);
            if now != before {
                self.changed[s.slot / 4] = true;
            }
        }
        for (row, j) in &island.several {
            // each row of a weld keeps its weight, but the edges of a pyramid come and go one by one
            let differs = |k| {
                let (now, before) = weight(row + k);
                now != before
            };
            if (0..j.dim).any(differs) {
                for &c in island.cols(j) {
                    self.changed[c as usize] = true;
                }
            }
        }
        for ((c, j), zone) in island.cones.iter().zip(&self.zone) {
            // on the surface the curvature turns with every step; in the quadratic zone it is constant, in the flat one
            // nothing
            if c.zone != *zone || c.zone == ConeZone::Surface {
                for &c in island.cols(j) {
                    self.changed[c as usize] = true;
                }
            }
        }
        for (w, q) in self.weight.iter_mut().zip(&island.scalar_rows) {
            *w = q.weight;
        }
        for (z, c) in self.zone.iter_mut().zip(&island.cones) {
            *z = c.0.zone;
        }
    }

    /// Fills the changed rows of the matrix.
    #[inline(always)]
    fn assemble(&mut self, island: &Island, efc: &Efc) {
        let n = island.tiles();
        for i in 0..n {
            if !self.changed[i] {
                continue;
            }
            let inertia = island.m_pattern.start(i)..island.m_pattern.start(i + 1);
            let row = &mut self.h[self.pattern.start(i)..self.pattern.start(i + 1)];
            let inertia = &island.m[inertia];
            // no constraint couples this row to more than its ancestors: nothing to spread out
            if row.len() == inertia.len() {
                row.copy_from_slice(inertia);
            } else {
                row.fill(ZERO);
                let start = self.pattern.start(i);
                for (m, &c) in inertia.iter().zip(island.m_pattern.cols(i)) {
                    row[self.place[i * n + c as usize] as usize - start] = *m;
                }
            }
            if let (Some(q), Some(diagonal)) = (island.scalar_rows[..island.friction_tiles].get(i), row.last_mut()) {
                for k in 0..4 {
                    diagonal[k][k] += q.weight[k];
                }
            }
        }
        for s in &island.singles {
            let (i, k) = (s.slot / 4, s.slot % 4);
            if self.changed[i] {
                // a row that was kept has it already
                let weight = island.scalar_rows[s.row / 4].weight[s.row % 4];
                self.h[self.pattern.start(i + 1) - 1][k][k] += weight * s.value * s.value;
            }
        }
        for (row, j) in &island.several {
            let mut weight = [0.0; MAX_ROWS];
            for (k, w) in weight.iter_mut().enumerate().take(j.dim) {
                *w = island.scalar_rows[(row + k) / 4].weight[(row + k) % 4];
            }
            if weight.iter().any(|w| *w != 0.0) && self.touches_changed(island, j) {
                self.weigh_diagonal(j.values(efc), &weight, j.dim);
                self.add_weighted(island, j, efc);
            }
        }
        for (c, j) in &island.cones {
            // a constraint that has not changed is added again to the changed rows among its own, as those start from
            // the inertia
            if c.zone == ConeZone::Flat || !self.touches_changed(island, j) {
                continue;
            }
            if c.zone == ConeZone::Quadratic {
                self.weigh_diagonal(j.values(efc), &c.d, j.dim);
            } else {
                self.weigh(j.values(efc), &c.curvature(), j.dim);
            }
            self.add_weighted(island, j, efc);
        }
    }

    #[inline(always)]
    fn touches_changed(&self, island: &Island, j: &Jacobian) -> bool {
        island.cols(j).iter().any(|&c| self.changed[c as usize])
    }

    /// Adds `J' weighted` to the changed rows of the lower triangle.
    #[inline(always)]
    fn add_weighted(&mut self, island: &Island, j: &Jacobian, efc: &Efc) {
        vectorize(
            #[inline(always)]
            || self.add_weighted_tiles(island.tiles(), island.cols(j), j.values(efc), j.dim),
        );
    }

    /// Does the same for a Jacobian over the columns `cols`, in an island of `n` tiles.
    #[inline(always)]
    fn add_weighted_tiles(&mut self, n: usize, cols: &[u32], jac: &[Lanes], dim: usize) {
        for (a, (&i, rows)) in cols.iter().zip(jac.chunks_exact(dim)).enumerate() {
            let i = i as usize;
            // kept rows hold this constraint already
            if !self.changed[i] {
                continue;
            }
            // columns ascend: those up to this row are the lower triangle
            for (&c, weighted) in cols[..a + 1].iter().zip(self.weighted.chunks_exact(dim)) {
                let place = self.place[i * n + c as usize] as usize;
                add_outer_products(&mut self.h[place], rows, weighted);
            }
        }
    }

    /// Factorises the changed rows and those they are eliminated into.
    #[inline(always)]
    fn factorise(&mut self) {
        let n = self.pattern.rows();
        // From the last row, since joints have higher numbers than their ancestors: an inertia then fills in nothing
        // (Featherstone 2008, chapter 6). What is eliminated into a row comes before it, so one pass carries changes
        // all the way.
        for i in (0..n).rev() {
            let mut c = self.child[i];
            while c != NONE && !self.changed[i] {
                self.changed[i] = self.changed[c as usize];
                c = self.sibling[c as usize];
            }
            if self.changed[i] {
                vectorize(
                    #[inline(always)]
                    || self.factorise_row(i),
                );
            }
        }
        self.changed.fill(false);
    }

    #[inline(always)]
    fn factorise_row(&mut self, i: usize) {
        let range = self.pattern.start(i)..self.pattern.start(i + 1);
        let cols = self.pattern.cols(i);
        let count = cols.len() - 1;
        let start = self.update_adr[i];
        // updates lie in the order of their rows, and those eliminated into this row have higher numbers
        let (mine, others) = self.update[start..].split_at_mut(count * (count + 1) / 2);
        let first = start + mine.len();
        let row = &mut self.factor[range.clone()];
        row.copy_from_slice(&self.h[range]);
        let mut c = self.child[i] as usize;
        if self.child[i] == NONE {
            mine.fill(ZERO);
        } else {
            // The assembly of the multifrontal method (Duff and Reid, "The multifrontal solution of indefinite sparse
            // symmetric linear equations", ACM Transactions on Mathematical Software 9, 1983): the updates of all
            // children, added up, are all that eliminated rows do to this one and those below it. The last column of a
            // child is this row, so the last row of its triangle is added here, and the rest is handed on.
            let mut empty = true;
            while c != NONE as usize {
                let child_cols = &self.pattern.cols(c)[..self.pattern.cols(c).len() - 1];
                let update = &others[self.update_adr[c] - first..];
                let m = child_cols.len() - 1;
                let (triangle, last) = update[..(m + 1) * (m + 2) / 2].split_at(m * (m + 1) / 2);
                // the same columns, as everywhere along a limb: no places to look up
                if m == count {
                    add_tiles(row, last);
                    if empty {
                        mine.copy_from_slice(triangle);
                    } else {
                        add_tiles(mine, triangle);
                    }
                } else {
                    if empty {
                        mine.fill(ZERO);
                    }
                    extend_add(cols, child_cols, row, mine, update);
                }
                empty = false;
                c = self.sibling[c] as usize;
            }
        }
        let (row, rest) = row.split_at_mut(count);
        let diagonal = &mut rest[0];
        let inv = factor_diagonal(diagonal);
        self.inv[i] = inv;
        let mut triangle = mine.iter_mut();
        for a in 0..count {
            solve_columns(diagonal, &mut row[a]);
            // the row keeps D L, which `solve` wants; L serves the update alone
            let l = scale_rows(&row[a], &inv);
            for (g, u) in row[..a].iter().zip(&mut triangle) {
                sub_transposed_product(u, &l, g);
            }
            if let Some(u) = triangle.next() {
                sub_transposed_product_diagonal(u, &l, &row[a]);
            }
        }
    }

    /// Sets `out` to minus the inverse times `gradient`.
    #[inline(always)]
    pub(super) fn descend(&self, gradient: &[Lanes], out: &mut [Lanes]) {
        for (o, g) in out.iter_mut().zip(gradient) {
            *o = g.map(|v| -v);
        }
        let (pattern, factor, inv) = (&self.pattern, &self.factor[..], &self.inv[..]);
        vectorize(
            #[inline(always)]
            || solve(pattern, factor, inv, out),
        );
    }
}

/// Adds the update of a row with `child_cols` to the row with `cols` that it is eliminated into, and to that row's
/// update.
#[inline(always)]
fn extend_add(cols: &[u32], child_cols: &[u32], row: &mut [Tile], update: &mut [Tile], child: &[Tile]) {
    let mut child = child.iter();
    let mut a = 0;
    for (n, col) in child_cols.iter().enumerate() {
        // both ascend, and a child's columns are all among its parent's: no search
        while cols[a] != *col {
            a += 1;
        }
        let target = if a + 1 == cols.len() {
            &mut *row
        } else {
            &mut update[a * (a + 1) / 2..]
        };
        let mut b = 0;
        for (col, u) in child_cols[..n + 1].iter().zip(&mut child) {
            while cols[b] != *col {
                b += 1;
            }
            add(&mut target[b], u);
        }
    }
}

#[inline(always)]
fn add_tiles(a: &mut [Tile], b: &[Tile]) {
    for (a, b) in a.iter_mut().zip(b) {
        add(a, b);
    }
}

#[inline(always)]
fn add(a: &mut Tile, b: &Tile) {
    for i in 0..4 {
        for j in 0..4 {
            a[i][j] += b[i][j];
        }
    }
}
