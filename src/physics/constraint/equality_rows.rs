//! The rows of equalities.

use super::append::{RowAppender, RowParameters};
use super::tendon_rows::tendons;
use super::{ConstraintType, connected_points, impedance, weld_points};
use crate::math::sub;
use crate::model::EqualityKind;
use crate::state::State;

/// Appends the rows of the active equalities.
#[doc(alias = "mj_instantiateEquality")]
#[inline(always)]
pub fn equalities(rows: &mut RowAppender, s: &State) {
    let (model, params) = (rows.model, &*s.params);
    for id in 0..model.neq() {
        if !params.eq_active[id] {
            continue;
        }
        match model.eq_kind[id] {
            EqualityKind::Joint {
                joint1,
                joint2,
                polycoef,
            } => joint_equality(rows, s, id, (joint1, joint2), polycoef),
            EqualityKind::Tendon {
                tendon1,
                tendon2,
                polycoef,
            } => tendon_equality(rows, s, id, (tendon1, tendon2), polycoef),
            EqualityKind::Connect { body1, body2, .. } => connect_equality(rows, s, id, [body1, body2]),
            EqualityKind::Weld { body1, body2, .. } => weld_equality(rows, s, id, [body1, body2]),
            EqualityKind::Flex { flex } => flex_equality(rows, s, id, flex),
        }
    }
}

/// Appends the row of a joint equality: joint 1 is a polynomial of joint 2, or constant without one.
#[inline(always)]
fn joint_equality(rows: &mut RowAppender, s: &State, id: usize, joints: (usize, Option<usize>), c: [f64; 5]) {
    let model = rows.model;
    let (joint1, joint2) = joints;
    let displacement = |j: usize| s.qpos[model.jnt_qposadr[j]] - model.qpos0[model.jnt_qposadr[j]];
    let d1 = model.jnt_dofadr[joint1];
    let mut pos = displacement(joint1) - s.params.eq_offset[id];
    let mut spec = RowParameters {
        solref: model.eq_solref[id],
        solimp: model.eq_solimp[id],
        diag: s.params.dof_invweight0[d1],
    };
    let Some(joint2) = joint2 else {
        rows.single(ConstraintType::Equality, id, d1, 1.0);
        rows.row(pos, 0.0, pos, spec);
        return;
    };
    let d2 = model.jnt_dofadr[joint2];
    let x = displacement(joint2);
    let (value, slope) = polynomial(&c, x);
    pos -= value;
    spec.diag += s.params.dof_invweight0[d2];
    rows.block(ConstraintType::Equality, id, 1);
    let mut entries = [(d1, 1.0), (d2, -slope)];
    if d2 < d1 {
        entries.reverse();
    }
    entries.into_iter().for_each(|(d, v)| rows.entry(d, v));
    rows.row(pos, 0.0, pos, spec);
}

/// Returns a polynomial without its constant term, and its derivative.
fn polynomial(c: &[f64; 5], x: f64) -> (f64, f64) {
    (
        x * (c[1] + x * (c[2] + x * (c[3] + x * c[4]))),
        c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * 4.0 * c[4])),
    )
}

/// Appends the row of an equality of tendons: the length of tendon 1 is a polynomial of that of tendon 2, or constant without one.
fn tendon_equality(rows: &mut RowAppender, s: &State, id: usize, (first, second): (usize, Option<usize>), c: [f64; 5]) {
    let model = rows.model;
    let displacement = |t: usize| s.ten_length[t] - model.tendon_length0[t];
    let mut pos = displacement(first) - s.params.eq_offset[id];
    let mut diag = model.tendon_invweight0[first];
    let mut scales = [(first, 1.0), (first, 0.0)];
    if let Some(second) = second {
        let (value, slope) = polynomial(&c, displacement(second));
        pos -= value;
        diag += model.tendon_invweight0[second];
        scales[1] = (second, -slope);
    }
    let count = if second.is_some() { 2 } else { 1 };
    if tendons(rows, s, (ConstraintType::Equality, id), &scales[..count]) {
        let spec = RowParameters {
            solref: model.eq_solref[id],
            solimp: model.eq_solimp[id],
            diag,
        };
        rows.row(pos, 0.0, pos, spec);
    }
}

/// Appends a row for each edge of a flex whose ends can move against each other: its length is that at `qpos0`.
#[inline(never)]
fn flex_equality(rows: &mut RowAppender, s: &State, id: usize, flex: usize) {
    let (model, topology) = (rows.model, rows.topology);
    let flex = &model.flexes[flex];
    for (k, _) in flex.edge_rigid.iter().enumerate().filter(|(_, rigid)| !**rigid) {
        let e = flex.edgeadr + k;
        let entries = topology
            .flexedges
            .row(e)
            .iter()
            .zip(&s.flexedge_j[topology.flexedges.range(e)]);
        rows.block(ConstraintType::Equality, id, 1);
        entries.for_each(|(&d, &v)| rows.entry(d as usize, v));
        let pos = s.flexedge_length[e] - flex.edge_length0[k];
        let spec = RowParameters {
            solref: model.eq_solref[id],
            solimp: model.eq_solimp[id],
            diag: flex.edge_invweight0[k],
        };
        rows.row(pos, 0.0, pos, spec);
    }
}

/// Appends the six rows of a weld: translation, rotation.
#[inline(always)]
fn weld_equality(rows: &mut RowAppender, s: &State, id: usize, [body1, body2]: [usize; 2]) {
    let model = rows.model;
    let Some(weld) = weld_points(model, s, id) else {
        return;
    };
    rows.relative(
        (ConstraintType::Equality, id, 6),
        s,
        (body2, weld.point2),
        (body1, weld.point1),
        #[inline(always)]
        |translation, rotation, out| {
            let mut rates = [[0.0; 4]; 3];
            for k in 0..4 {
                let rate = weld.rotation_rate([rotation[0][k], rotation[1][k], rotation[2][k]]);
                (rates[0][k], rates[1][k], rates[2][k]) = (rate[0], rate[1], rate[2]);
            }
            out.extend_from_slice(translation);
            out.extend_from_slice(&rates);
        },
    );
    hold(rows, s, id, [body1, body2], &weld.error);
}

/// Appends the three rows of a connection of two points.
#[inline(always)]
fn connect_equality(rows: &mut RowAppender, s: &State, id: usize, [body1, body2]: [usize; 2]) {
    let Some([point1, point2]) = connected_points(rows.model, s, id) else {
        return;
    };
    rows.relative(
        (ConstraintType::Equality, id, 3),
        s,
        (body2, point2),
        (body1, point1),
        #[inline(always)]
        |translation, _, out| out.extend_from_slice(translation),
    );
    hold(rows, s, id, [body1, body2], &sub(point1, point2));
}

/// Appends the rows of the last block, which hold two bodies together: translation first, then rotation.
#[inline(always)]
fn hold(rows: &mut RowAppender, s: &State, id: usize, [body1, body2]: [usize; 2], error: &[f64]) {
    let model = rows.model;
    // MuJoCo drops an equality that no degree of freedom can do anything about, which it sees only where the Jacobian is
    // dense: the forces of rows that it keeps move nothing, but torque sensors feel them
    let block = *rows.block_mut();
    let moves = rows.efc.jac[block.jac..].iter().flatten().any(|v| *v != 0.0);
    let fixed = [body1, body2].iter().all(|&b| model.body_weldid[b] == 0);
    if !moves && (fixed || !model.opt.jacobian.is_sparse(model.nv)) {
        rows.drop_block();
        return;
    }
    let (w1, w2) = (s.params.body_invweight0[body1], s.params.body_invweight0[body2]);
    let norm = error.iter().map(|e| e * e).sum::<f64>().sqrt();
    // all rows have the violation of the whole, and so one impedance
    let least = model.opt.least_timeconst();
    let impedance = impedance(model.eq_solref[id], model.eq_solimp[id], norm, least);
    for (k, &pos) in error.iter().enumerate() {
        rows.row_with(pos, 0.0, w1[k / 3] + w2[k / 3], impedance);
    }
}
