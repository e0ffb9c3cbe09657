//! Sparse symmetric matrices in tiles of four by four.
//!
//! Degrees of freedom are dealt to *lanes*, four to a tile, so that those of a tile follow each other in a chain of the
//! tree ([`crate::Topology::slot`]); lanes left over have a unit diagonal and nothing else. A limb touches
//! only its own chain, so few tiles are nonzero, and every operation runs on tiles of fixed size, which compilers
//! unroll into vector instructions.

use crate::math::MINVAL;

/// Four values, of the degrees of freedom in a tile.
pub type Lanes = [f64; 4];

/// Four rows of four columns.
pub type Tile = [Lanes; 4];

/// No tile.
pub const ZERO: Tile = [[0.0; 4]; 4];

/// The stored tiles of a symmetric matrix: in each row those up to the diagonal, ascending.
#[derive(Clone, Debug, Default)]
pub struct Pattern {
    adr: Vec<usize>,
    cols: Vec<u32>,
}

impl Pattern {
    /// Reserves memory for `rows` rows and `tiles` tiles.
    pub fn with_capacity(rows: usize, tiles: usize) -> Self {
        let mut pattern = Self {
            adr: Vec::with_capacity(rows + 1),
            cols: Vec::with_capacity(tiles),
        };
        pattern.clear();
        pattern
    }

    /// Drops all rows but keeps the memory.
    pub fn clear(&mut self) {
        self.adr.clear();
        self.adr.push(0);
        self.cols.clear();
    }

    /// Adds a column to the row that is being added.
    #[inline]
    pub fn push_col(&mut self, col: u32) {
        self.cols.push(col);
    }

    /// Ends a row, whose last column is the diagonal.
    #[inline]
    pub fn end_row(&mut self) {
        self.adr.push(self.cols.len());
    }

    /// Returns the number of rows of tiles.
    #[inline]
    pub fn rows(&self) -> usize {
        self.adr.len() - 1
    }

    /// Returns the number of tiles.
    #[inline]
    pub fn tiles(&self) -> usize {
        self.cols.len()
    }

    /// Returns the first tile of a row; for the number of rows, one past the last tile.
    #[inline]
    pub fn start(&self, row: usize) -> usize {
        self.adr[row]
    }

    /// Returns the columns of a row, the diagonal last.
    #[inline]
    pub fn cols(&self, row: usize) -> &[u32] {
        &self.cols[self.adr[row]..self.adr[row + 1]]
    }
}

/// Computes `c -= a' b` for a diagonal tile: on and below the diagonal, and some of the rest.
#[inline(always)]
pub(super) fn sub_transposed_product_diagonal(c: &mut Tile, a: &Tile, b: &Tile) {
    let mut sum = *c;
    for k in 0..4 {
        for i in 0..4 {
            // pairs of columns make a vector
            for j in 0..(if i < 2 { 2 } else { 4 }) {
                sum[i][j] -= a[k][i] * b[k][j];
            }
        }
    }
    *c = sum;
}

/// Computes `c -= a' b`.
#[inline(always)]
pub(super) fn sub_transposed_product(c: &mut Tile, a: &Tile, b: &Tile) {
    let mut sum = *c;
    for k in 0..4 {
        for i in 0..4 {
            for j in 0..4 {
                sum[i][j] -= a[k][i] * b[k][j];
            }
        }
    }
    *c = sum;
}

/// Computes `y += a' x`.
#[inline(always)]
fn add_transposed(y: &mut Lanes, a: &Tile, x: &Lanes) {
    let mut sum = *y;
    for k in 0..4 {
        for j in 0..4 {
            sum[j] += a[k][j] * x[k];
        }
    }
    *y = sum;
}

/// Computes `sums += a x`, keeping the terms of each row apart.
#[inline(always)]
fn add_products(sums: &mut Tile, a: &Tile, x: &Lanes) {
    for i in 0..4 {
        for j in 0..4 {
            sums[i][j] += a[i][j] * x[j];
        }
    }
}

/// Returns the sum of the lanes.
#[inline(always)]
pub fn total(x: &Lanes) -> f64 {
    // the order in which vector instructions fold a register: halves onto each other, then the two that are left
    (x[0] + x[2]) + (x[1] + x[3])
}

#[cold]
#[inline(never)]
fn least() -> f64 {
    MINVAL
}

/// Factors the lower triangle of a diagonal tile as `L' D L`, and returns the inverse of `D`.
///
/// `L` is left below the diagonal.
#[inline(always)]
pub(super) fn factor_diagonal(h: &mut Tile) -> Lanes {
    let mut inv = [0.0; 4];
    // from the last, like the elimination of rows of tiles
    for k in (0..4).rev() {
        let mut pivot = h[k][k];
        // Beside rows with hardly any regularisation, as those of a body that turns about its centre of mass, rounding may leave a
        // pivot of nothing or less: MuJoCo's least one keeps the step finite, and the line search makes it short enough. A branch that
        // is never taken costs less than the greater of the two, for which the division would wait.
        if pivot < MINVAL || pivot.is_nan() {
            pivot = least();
        }
        inv[k] = 1.0 / pivot;
        let row = h[k];
        for i in 0..k {
            let t = row[i] * inv[k];
            for j in 0..=i {
                h[i][j] -= t * row[j];
            }
            h[k][i] = t;
        }
    }
    inv
}

/// Solves `L' x = b` in place for each column of a tile.
#[inline(always)]
pub(super) fn solve_columns(l: &Tile, b: &mut Tile) {
    let [mut b0, mut b1, mut b2, b3] = *b;
    for j in 0..4 {
        b2[j] -= l[3][2] * b3[j];
    }
    for j in 0..4 {
        b1[j] -= l[3][1] * b3[j];
        b1[j] -= l[2][1] * b2[j];
    }
    for j in 0..4 {
        b0[j] -= l[3][0] * b3[j];
        b0[j] -= l[2][0] * b2[j];
        b0[j] -= l[1][0] * b1[j];
    }
    *b = [b0, b1, b2, b3];
}

/// Returns a tile whose rows are multiplied by `factor`.
#[inline(always)]
pub(super) fn scale_rows(a: &Tile, factor: &Lanes) -> Tile {
    let mut out = *a;
    for k in 0..4 {
        for c in 0..4 {
            out[k][c] *= factor[k];
        }
    }
    out
}

/// Computes `c += a' b` for any number of rows of four values.
#[inline(always)]
pub(super) fn add_outer_products(c: &mut Tile, a: &[Lanes], b: &[Lanes]) {
    let mut sum = *c;
    for (a, b) in a.iter().zip(b) {
        for i in 0..4 {
            for j in 0..4 {
                sum[i][j] += a[i] * b[j];
            }
        }
    }
    *c = sum;
}

/// Solves `H x = b` in place, for `H = L' D L`: the diagonal tiles hold `L` below their diagonal, the others `D L`;
/// `inv` is the inverse of `D`.
#[inline(always)]
pub(super) fn solve(pattern: &Pattern, h: &[Tile], inv: &[Lanes], x: &mut [Lanes]) {
    let n = pattern.rows();
    for i in (0..n).rev() {
        let (head, tail) = x.split_at_mut(i);
        let row = &h[pattern.adr[i]..pattern.adr[i + 1]];
        let l = &row[row.len() - 1];
        let mut y = tail[0];
        y[2] -= l[3][2] * y[3];
        y[1] -= l[3][1] * y[3] + l[2][1] * y[2];
        y[0] -= l[3][0] * y[3] + l[2][0] * y[2] + l[1][0] * y[1];
        for k in 0..4 {
            y[k] *= inv[i][k];
        }
        tail[0] = y;
        let minus = y.map(|v| -v);
        for (&j, g) in pattern.cols(i).iter().zip(&row[..row.len() - 1]) {
            add_transposed(&mut head[j as usize], g, &minus);
        }
    }
    for i in 0..n {
        let (head, tail) = x.split_at_mut(i);
        let row = &h[pattern.adr[i]..pattern.adr[i + 1]];
        let l = &row[row.len() - 1];
        let mut sums = ZERO;
        for (&j, g) in pattern.cols(i).iter().zip(&row[..row.len() - 1]) {
            add_products(&mut sums, g, &head[j as usize]);
        }
        let y = &mut tail[0];
        for k in 0..4 {
            y[k] -= inv[i][k] * total(&sums[k]);
        }
        y[1] -= l[1][0] * y[0];
        y[2] -= l[2][0] * y[0] + l[2][1] * y[1];
        y[3] -= l[3][0] * y[0] + l[3][1] * y[1] + l[3][2] * y[2];
    }
}

/// Computes `out = H x`; the diagonal tiles must hold both triangles.
#[inline(always)]
pub fn mul(pattern: &Pattern, h: &[Tile], x: &[Lanes], out: &mut [Lanes]) {
    for i in 0..pattern.rows() {
        let (head, tail) = out.split_at_mut(i);
        let row = &h[pattern.adr[i]..pattern.adr[i + 1]];
        let mut sums = ZERO;
        for (&j, a) in pattern.cols(i).iter().zip(row) {
            add_products(&mut sums, a, &x[j as usize]);
        }
        // apart, as both together do not fit into registers
        for (&j, a) in pattern.cols(i).iter().zip(&row[..row.len() - 1]) {
            add_transposed(&mut head[j as usize], a, &x[i]);
        }
        tail[0] = [total(&sums[0]), total(&sums[1]), total(&sums[2]), total(&sums[3])];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Builds the matrix of two limbs on a trunk, with a coupling of the limbs.
    fn example() -> (Pattern, Vec<Tile>) {
        let mut pattern = Pattern::with_capacity(4, 8);
        for cols in [&[0][..], &[0, 1], &[0, 2], &[0, 2, 3]] {
            cols.iter().for_each(|&c| pattern.push_col(c));
            pattern.end_row();
        }
        let mut h = vec![ZERO; pattern.tiles()];
        for (n, tile) in h.iter_mut().enumerate() {
            for k in 0..16 {
                tile[k / 4][k % 4] = ((7 * n + 5 * k) % 11) as f64 / 11.0 - 0.5;
            }
        }
        for i in 0..4 {
            let d = &mut h[pattern.start(i + 1) - 1];
            for r in 0..4 {
                d[r][r] = 9.0 + r as f64;
                for c in 0..r {
                    d[c][r] = d[r][c];
                }
            }
        }
        (pattern, h)
    }

    #[test]
    fn the_product_is_that_of_the_full_matrix() {
        let (pattern, h) = example();
        let mut full = [[0.0; 16]; 16];
        for i in 0..4 {
            for (t, &j) in h[pattern.start(i)..].iter().zip(pattern.cols(i)) {
                for k in 0..16 {
                    let (r, c) = (4 * i + k / 4, 4 * j as usize + k % 4);
                    (full[r][c], full[c][r]) = (t[k / 4][k % 4], t[k / 4][k % 4]);
                }
            }
        }
        let x: Vec<Lanes> = (0..4).map(|i| [0.1, 1.0, -3.0, 2.0 - i as f64]).collect();
        let mut out = vec![[0.0; 4]; 4];
        mul(&pattern, &h, &x, &mut out);
        for (r, out) in out.iter().flatten().enumerate() {
            let sum: f64 = full[r].iter().zip(x.iter().flatten()).map(|(a, b)| a * b).sum();
            assert!((sum - out).abs() < 1e-14);
        }
    }
}
