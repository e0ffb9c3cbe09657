//! Jacobians times curvatures.

use super::Hessian;
use crate::tiles::Lanes;

impl Hessian {
    /// Computes `weighted = diag(weight) J`.
    #[inline(always)]
    pub(super) fn weigh_diagonal(&mut self, jac: &[Lanes], weight: &[f64], dim: usize) {
        let out = room(&mut self.weighted, jac.len());
        match dim {
            3 => weigh_rows::<3>(jac, weight, out),
            4 => weigh_rows::<4>(jac, weight, out),
            6 => weigh_rows::<6>(jac, weight, out),
            _ => {
                for (rows, out) in jac.chunks_exact(dim).zip(out.chunks_exact_mut(dim)) {
                    for ((out, row), w) in out.iter_mut().zip(rows).zip(weight) {
                        *out = row.map(|v| w * v);
                    }
                }
            }
        }
    }

    /// Computes `weighted = C J`.
    #[inline(always)]
    pub(super) fn weigh(&mut self, jac: &[Lanes], c: &[[f64; 6]; 6], dim: usize) {
        let out = room(&mut self.weighted, jac.len());
        for (rows, out) in jac.chunks_exact(dim).zip(out.chunks_exact_mut(dim)) {
            for (out, c) in out.iter_mut().zip(c) {
                let mut sum = [0.0; 4];
                for (row, c) in rows.iter().zip(c) {
                    for k in 0..4 {
                        sum[k] += c * row[k];
                    }
                }
                *out = sum;
            }
        }
    }
}

/// Returns the first `len` entries of a vector, which grows if it is shorter. Callers overwrite the contents.
#[inline(always)]
fn room(v: &mut Vec<Lanes>, len: usize) -> &mut [Lanes] {
    if v.len() < len {
        v.resize(len, [0.0; 4]);
    }
    &mut v[..len]
}

/// Multiplies each of `N` rows with its weight, in every tile.
#[inline(always)]
fn weigh_rows<const N: usize>(jac: &[Lanes], weight: &[f64], out: &mut [Lanes]) {
    let Some(weight) = weight.first_chunk::<N>() else {
        return;
    };
    let ((tiles, _), (out, _)) = (jac.as_chunks::<N>(), out.as_chunks_mut::<N>());
    for (rows, out) in tiles.iter().zip(out) {
        for r in 0..N {
            out[r] = rows[r].map(|v| weight[r] * v);
        }
    }
}
