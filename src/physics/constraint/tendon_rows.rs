//! The rows of tendons: dry friction and limits.

use super::ConstraintType;
use super::append::{RowAppender, RowParameters};
use crate::state::State;

/// Starts a block with one row on the lengths of tendons, each with a scale. Returns whether there is one: if the Jacobian is dense, MuJoCo drops a
/// row that nothing moves, as with equalities without effect.
pub fn tendons(
    rows: &mut RowAppender,
    s: &State,
    (kind, id): (ConstraintType, usize),
    scales: &[(usize, f64)],
) -> bool {
    let (model, topology) = (rows.model, rows.topology);
    rows.block(kind, id, 1);
    let row = |k: usize| match scales.get(k) {
        Some(&(t, scale)) => (topology.tendons.row(t), &s.ten_j[topology.tendons.range(t)], scale),
        None => (&[][..], &[][..], 0.0),
    };
    let ((dofs_a, arms_a, a), (dofs_b, arms_b, b)) = (row(0), row(1));
    // both are ascending
    let (mut i, mut k) = (0, 0);
    loop {
        let next = |dofs: &[u32], at: usize| dofs.get(at).copied().unwrap_or(u32::MAX);
        let (next_a, next_b) = (next(dofs_a, i), next(dofs_b, k));
        let d = next_a.min(next_b);
        if d == u32::MAX {
            break;
        }
        // a degree of freedom that moves both tendons gets two entries, which add up
        if next_a == d {
            rows.entry(d as usize, a * arms_a[i]);
            i += 1;
        }
        if next_b == d {
            rows.entry(d as usize, b * arms_b[k]);
            k += 1;
        }
    }
    let block = *rows.block_mut();
    let moves = rows.efc.jac[block.jac..].iter().flatten().any(|v| *v != 0.0);
    let sparse = || model.opt.jacobian.is_sparse(model.nv);
    let keeps = moves || sparse() && scales.iter().any(|&(t, _)| s.ten_entries[t]);
    if !keeps {
        rows.drop_block();
    }
    keeps
}

/// Appends a row for each tendon that has dry friction.
#[doc(alias = "mj_instantiateFriction")]
#[inline(always)]
pub fn tendon_friction(rows: &mut RowAppender, s: &State) {
    let model = rows.model;
    for t in 0..model.ntendon() {
        let loss = model.tendon_frictionloss[t];
        if loss > 0.0 && tendons(rows, s, (ConstraintType::FrictionTendon, t), &[(t, 1.0)]) {
            let spec = RowParameters {
                solref: model.tendon_solref_fri[t],
                solimp: model.tendon_solimp_fri[t],
                diag: model.tendon_invweight0[t],
            };
            rows.block_mut().frictionloss = loss;
            let damping = rows.row(0.0, 0.0, 0.0, spec);
            let (efc, v) = (&mut *rows.efc, s.ten_velocity[t]);
            if let (Some(vel), Some(aref)) = (efc.vel.last_mut(), efc.aref.last_mut()) {
                (*vel, *aref) = (v, 0.0 - damping * v);
            }
        }
    }
}

/// Appends a row for each limit of a tendon that is within its margin.
#[doc(alias = "mj_instantiateLimit")]
#[inline(always)]
pub fn tendon_limits(rows: &mut RowAppender, s: &State) {
    let model = rows.model;
    for t in 0..model.ntendon() {
        if !model.tendon_limited[t] {
            continue;
        }
        let length = s.ten_length[t];
        let margin = model.tendon_margin[t];
        let spec = RowParameters {
            solref: model.tendon_solref_lim[t],
            solimp: model.tendon_solimp_lim[t],
            diag: model.tendon_invweight0[t],
        };
        for (side, limit) in [(-1.0, model.tendon_range[t][0]), (1.0, model.tendon_range[t][1])] {
            let dist = side * (limit - length);
            if dist < margin && tendons(rows, s, (ConstraintType::LimitTendon, t), &[(t, -side)]) {
                rows.row(dist, margin, dist - margin, spec);
            }
        }
    }
}
