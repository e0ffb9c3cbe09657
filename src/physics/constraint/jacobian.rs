//! Products with the Jacobian of the constraint rows of an island.

use std::hint::black_box;

use super::Efc;
use crate::tiles::{Lanes, total};

/// A row on one degree of freedom.
#[derive(Clone, Copy, Debug)]
pub(super) struct SingleDofRow {
    /// Its place in the scalar rows.
    pub(super) row: usize,
    /// Lane of the degree of freedom.
    pub(super) slot: usize,
    pub(super) value: f64,
}

/// Jacobian of some rows over the tiles in which they have entries.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Jacobian {
    /// Number of rows.
    pub(super) dim: usize,
    /// First entry in the columns of the island, and their number.
    pub(super) col: usize,
    pub(super) ncol: usize,
    /// First entry in [`Efc::jac`].
    pub(super) jac: usize,
}

impl Jacobian {
    /// Returns the values: `dim` rows for each tile of columns.
    pub(super) fn values<'a>(&self, efc: &'a Efc) -> &'a [Lanes] {
        &efc.jac[self.jac..self.jac + self.dim * self.ncol]
    }
}

/// Computes `J x` of at most `N` rows.
#[inline(always)]
pub(super) fn product<const N: usize>(cols: &[u32], jac: &[Lanes], j: &Jacobian, x: &[Lanes]) -> [f64; N] {
    let mut out = [0.0; N];
    let mut first = 0;
    // a contact with friction has three rows or more: three sums at once read `x` once
    while first + 3 <= j.dim {
        let [a, b, c] = some_products::<3>(cols, jac, j, first, x);
        out[first..first + 3].copy_from_slice(&[a, b, c]);
        first += 3;
    }
    while first < j.dim {
        [out[first]] = some_products::<1>(cols, jac, j, first, x);
        first += 1;
    }
    out
}

/// Computes `N` rows of `J x`, starting at `first`.
#[inline(always)]
fn some_products<const N: usize>(cols: &[u32], jac: &[Lanes], j: &Jacobian, first: usize, x: &[Lanes]) -> [f64; N] {
    let mut sums = [[0.0; 4]; N];
    let rows = jac[j.jac..j.jac + j.dim * j.ncol].chunks_exact(j.dim);
    for (&c, rows) in cols[j.col..j.col + j.ncol].iter().zip(rows) {
        let x = x[c as usize];
        for (sum, row) in sums.iter_mut().zip(&rows[first..first + N]) {
            for k in 0..4 {
                sum[k] += row[k] * x[k];
            }
        }
    }
    // three rows that are summed up across would tempt the compiler to work across them in all columns: with three times the instructions
    black_box(sums).map(|s| total(&s))
}

/// Computes `out += J' force`.
#[inline(always)]
pub(super) fn add_transposed_product(cols: &[u32], jac: &[Lanes], j: &Jacobian, force: &[f64], out: &mut [Lanes]) {
    if let (3, Some(force)) = (j.dim, force.first_chunk::<3>()) {
        // contacts: a number of rows that is known saves most of the loop
        let (rows, _) = jac[j.jac..j.jac + 3 * j.ncol].as_chunks::<3>();
        for (&c, [x, y, z]) in cols[j.col..j.col + j.ncol].iter().zip(rows) {
            let out = &mut out[c as usize];
            for k in 0..4 {
                out[k] = ((out[k] + x[k] * force[0]) + y[k] * force[1]) + z[k] * force[2];
            }
        }
        return;
    }
    let rows = jac[j.jac..j.jac + j.dim * j.ncol].chunks_exact(j.dim);
    for (&c, rows) in cols[j.col..j.col + j.ncol].iter().zip(rows) {
        let out = &mut out[c as usize];
        let mut sum = *out;
        for (row, f) in rows.iter().zip(force) {
            for k in 0..4 {
                sum[k] += row[k] * f;
            }
        }
        *out = sum;
    }
}
