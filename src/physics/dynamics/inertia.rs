//! The joint-space inertia matrix, packed by ancestor chains, and its factorisation.

use crate::model::Model;
use crate::physics::spatial::{dot6, inertia_mul};
use crate::physics::state::State;
use crate::physics::topology::Topology;

/// Composite-rigid-body algorithm: `crb` and `qm` from `cinert` and `cdof`, armature included.
pub fn crb(model: &Model, topology: &Topology, s: &mut State) {
    s.crb.copy_from_slice(&s.cinert);
    for b in (1..model.nbody()).rev() {
        let p = model.body_parentid[b];
        if p > 0 {
            let (head, tail) = s.crb.split_at_mut(b);
            for (a, c) in head[p].iter_mut().zip(&tail[0]) {
                *a += c;
            }
        }
    }
    for d in 0..model.nv {
        let force = inertia_mul(&s.crb[model.dof_bodyid[d]], &s.cdof[d]);
        let range = topology.row_adr[d]..topology.row_adr[d + 1];
        for (m, &a) in s.qm[range.clone()].iter_mut().zip(&topology.chain[range.clone()]) {
            *m = dot6(&s.cdof[a as usize], &force);
        }
        s.qm[range.end - 1] += model.dof_armature[d];
    }
}

/// Factorises `qm` into `qld` and `qld_diag_inv`.
pub fn factor_m(topology: &Topology, s: &mut State) {
    s.qld.copy_from_slice(&s.qm);
    factor_packed(topology, &mut s.qld, &mut s.qld_diag_inv);
}

/// In place `M = L' D L` of a packed matrix (`nm`); `diag_inv` (nv) receives the inverse of `D`. On return the rows hold
/// `L` without its unit diagonal.
pub fn factor_packed(topology: &Topology, m: &mut [f64], diag_inv: &mut [f64]) {
    let adr = &topology.row_adr;
    for i in (0..diag_inv.len()).rev() {
        let (head, tail) = m.split_at_mut(adr[i]);
        let n = adr[i + 1] - adr[i] - 1;
        let inv = 1.0 / tail[n];
        diag_inv[i] = inv;
        let row = &mut tail[..n];
        for (k, &j) in topology.chain[adr[i]..adr[i] + n].iter().enumerate() {
            let t = row[k] * inv;
            let start = adr[j as usize];
            // the chain of ancestor j is the first k + 1 entries of this chain
            for (a, b) in head[start..start + k + 1].iter_mut().zip(&row[..k + 1]) {
                *a -= t * b;
            }
        }
        for v in row {
            *v *= inv;
        }
    }
}

/// Solves `M x = b` in place for one right-hand side (nv), with the factor from [`factor_packed`].
pub fn solve_packed(topology: &Topology, l: &[f64], diag_inv: &[f64], x: &mut [f64]) {
    let adr = &topology.row_adr;
    let nv = diag_inv.len();
    for i in (0..nv).rev() {
        let xi = x[i];
        if xi != 0.0 {
            let range = adr[i]..adr[i + 1] - 1;
            for (&j, &v) in topology.chain[range.clone()].iter().zip(&l[range]) {
                x[j as usize] -= v * xi;
            }
        }
    }
    for (v, inv) in x.iter_mut().zip(diag_inv) {
        *v *= inv;
    }
    for i in 0..nv {
        let range = adr[i]..adr[i + 1] - 1;
        let mut sum = 0.0;
        for (&j, &v) in topology.chain[range.clone()].iter().zip(&l[range]) {
            sum += v * x[j as usize];
        }
        x[i] -= sum;
    }
}

/// `out = M x` for a packed matrix.
pub fn mul_m(topology: &Topology, m: &[f64], x: &[f64], out: &mut [f64]) {
    let adr = &topology.row_adr;
    out.fill(0.0);
    for i in 0..x.len() {
        let (start, diag) = (adr[i], adr[i + 1] - 1);
        let xi = x[i];
        let mut sum = m[diag] * xi;
        for (&j, &v) in topology.chain[start..diag].iter().zip(&m[start..diag]) {
            sum += v * x[j as usize];
            out[j as usize] += v * xi;
        }
        out[i] += sum;
    }
}
