//! Construction of the constraint rows.

use crate::math::*;
use crate::model::{ConeType, EqualityKind, JointType, Model};
use crate::physics::constraint::append::{Rows, Spec};
use crate::physics::constraint::impedance::is_solref;
use crate::physics::constraint::{Block, ConstraintType, Efc, MAX_ROWS, connected_points, impedance, weld_points};
use crate::physics::state::{Contact, State};
use crate::physics::tiles::{Lanes, total};
use crate::physics::topology::Topology;

/// Builds the constraint rows. Keeps those of dry friction of joints, which are always the same.
#[derive(Clone, Debug, Default)]
pub struct RowBuilder {
    friction: Efc,
    /// Damping of each row of dry friction.
    damping: Vec<f64>,
    /// `qvel` in lanes.
    qvel: Vec<Lanes>,
}

impl RowBuilder {
    /// Prepares the rows of `model` that are always the same.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let mut friction = Efc::default();
        let mut rows = Rows {
            model,
            topology,
            efc: &mut friction,
        };
        for d in 0..model.nv {
            let loss = model.dof_frictionloss[d];
            if loss > 0.0 {
                let spec = Spec {
                    solref: model.dof_solref[d],
                    solimp: model.dof_solimp[d],
                    diag: model.dof_invweight0[d],
                };
                rows.single(ConstraintType::FrictionDof, d, d, 1.0);
                rows.block_mut().frictionloss = loss;
                rows.row(0.0, 0.0, 0.0, spec);
            }
        }
        Self {
            damping: friction.vel.clone(),
            friction,
            qvel: vec![[0.0; 4]; topology.tiles.rows()],
        }
    }

    /// Fills `s.efc` from the position stage, the contacts and `qvel`: equalities, friction loss, limits of joints and
    /// tendons, contacts.
    #[inline(always)]
    pub fn build(&mut self, model: &Model, topology: &Topology, s: &mut State) {
        let mut efc = std::mem::take(&mut s.efc);
        efc.clear();
        let flags = &model.opt.flags;
        if !flags.constraint {
            s.efc = efc;
            return;
        }
        topology.to_lanes(&s.qvel, &mut self.qvel);
        let mut rows = Rows {
            model,
            topology,
            efc: &mut efc,
        };
        if flags.equality {
            equalities(&mut rows, s);
        }
        if flags.frictionloss {
            self.add_friction(rows.efc, s);
            tendon_friction(&mut rows, s);
        }
        if flags.limit {
            joint_limits(&mut rows, s);
            tendon_limits(&mut rows, s);
        }
        for i in 0..s.contact.len() {
            contact(&mut rows, s, i);
        }
        self.add_velocities(&mut efc, s);
        s.efc = efc;
    }

    /// Appends dry friction of joints.
    #[inline(always)]
    fn add_friction(&self, efc: &mut Efc, s: &State) {
        let f = &self.friction;
        let (row, col, jac) = (efc.pos.len(), efc.cols.len(), efc.jac.len());
        efc.blocks.extend(f.blocks.iter().map(|b| Block {
            row: row + b.row,
            col: col + b.col,
            jac: jac + b.jac,
            ..*b
        }));
        efc.cols.extend_from_slice(&f.cols);
        efc.jac.extend_from_slice(&f.jac);
        for (to, from) in [
            (&mut efc.pos, &f.pos),
            (&mut efc.margin, &f.margin),
            (&mut efc.diag_approx, &f.diag_approx),
            (&mut efc.r, &f.r),
            (&mut efc.d, &f.d),
        ] {
            to.extend_from_slice(from);
        }
        for (b, damping) in f.blocks.iter().zip(&self.damping) {
            let v = s.qvel[b.id];
            efc.vel.push(v);
            efc.aref.push(0.0 - damping * v);
        }
    }

    /// Computes the velocities of all rows but those of dry friction; `vel` holds the damping of each until here.
    #[inline(always)]
    fn add_velocities(&self, efc: &mut Efc, s: &State) {
        efc.force.resize(efc.pos.len(), 0.0);
        for k in 0..efc.blocks.len() {
            let b = &efc.blocks[k];
            if b.kind.is_friction() {
                continue;
            }
            let (row, dim, dof) = (b.row, b.dim, b.dof);
            let mut v = [0.0; MAX_ROWS];
            if let Some(dof) = dof {
                let value = efc.jac[b.jac].iter().find(|v| **v != 0.0);
                v[0] = value.copied().unwrap_or(0.0) * s.qvel[dof];
            } else {
                let mut sums = [[0.0; 4]; MAX_ROWS];
                for (tile, rows) in efc.tiles(b) {
                    let x = &self.qvel[tile as usize];
                    for (sum, row) in sums.iter_mut().zip(rows) {
                        for k in 0..4 {
                            sum[k] += row[k] * x[k];
                        }
                    }
                }
                v = sums.map(|s| total(&s));
            }
            let rows = row..row + dim;
            for ((vel, aref), v) in efc.vel[rows.clone()].iter_mut().zip(&mut efc.aref[rows]).zip(v) {
                *aref -= *vel * v;
                *vel = v;
            }
        }
    }
}

/// Appends the rows of the active equalities.
#[inline(always)]
fn equalities(rows: &mut Rows, s: &State) {
    let model = rows.model;
    for id in 0..model.neq() {
        if !s.params.eq_active[id] {
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
        }
    }
}

/// Appends the row of a joint equality: joint 1 is a polynomial of joint 2, or constant without one.
#[inline(always)]
fn joint_equality(rows: &mut Rows, s: &State, id: usize, joints: (usize, Option<usize>), c: [f64; 5]) {
    let model = rows.model;
    let (joint1, joint2) = joints;
    let displacement = |j: usize| s.qpos[model.jnt_qposadr[j]] - model.qpos0[model.jnt_qposadr[j]];
    let d1 = model.jnt_dofadr[joint1];
    let mut pos = displacement(joint1) - s.params.eq_offset[id];
    let mut spec = Spec {
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
    entries.sort_unstable_by_key(|e| e.0);
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
fn tendon_equality(rows: &mut Rows, s: &State, id: usize, (first, second): (usize, Option<usize>), c: [f64; 5]) {
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
        let spec = Spec {
            solref: model.eq_solref[id],
            solimp: model.eq_solimp[id],
            diag,
        };
        rows.row(pos, 0.0, pos, spec);
    }
}

/// Starts a block with one row on the lengths of tendons, each with a scale. Returns whether there is one: as with equalities without
/// effect, MuJoCo drops a row that nothing moves, where the Jacobian is dense.
fn tendons(rows: &mut Rows, s: &State, (kind, id): (ConstraintType, usize), scales: &[(usize, f64)]) -> bool {
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

/// Appends the six rows of a weld: translation, rotation.
fn weld_equality(rows: &mut Rows, s: &State, id: usize, [body1, body2]: [usize; 2]) {
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
fn connect_equality(rows: &mut Rows, s: &State, id: usize, [body1, body2]: [usize; 2]) {
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

/// Gives the last block its rows, which hold two bodies: those of translation first, then those of rotation.
fn hold(rows: &mut Rows, s: &State, id: usize, [body1, body2]: [usize; 2], error: &[f64]) {
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
    for (k, &pos) in error.iter().enumerate() {
        let spec = Spec {
            solref: model.eq_solref[id],
            solimp: model.eq_solimp[id],
            diag: w1[k / 3] + w2[k / 3],
        };
        rows.row(pos, 0.0, norm, spec);
    }
}

/// Appends a row for each limit of a joint that is within its margin.
#[inline(always)]
fn joint_limits(rows: &mut Rows, s: &State) {
    let model = rows.model;
    for j in 0..model.njnt() {
        if !model.jnt_limited[j] {
            continue;
        }
        if model.jnt_type[j] == JointType::Ball {
            ball_limit(rows, s, j);
            continue;
        }
        let (value, margin, d) = (s.qpos[model.jnt_qposadr[j]], model.jnt_margin[j], model.jnt_dofadr[j]);
        for (side, limit) in [(-1.0, model.jnt_range[j][0]), (1.0, model.jnt_range[j][1])] {
            let dist = side * (limit - value);
            if dist < margin {
                let spec = Spec {
                    solref: model.jnt_solref[j],
                    solimp: model.jnt_solimp[j],
                    diag: s.params.dof_invweight0[d],
                };
                rows.single(ConstraintType::LimitJoint, j, d, -side);
                rows.row(dist, margin, dist - margin, spec);
            }
        }
    }
}

/// Appends a row if a ball joint is within the margin of the angle that it may turn by, about any axis.
#[inline(never)]
fn ball_limit(rows: &mut Rows, s: &State, j: usize) {
    let model = rows.model;
    let quat = quat_normalize(quat_at(&s.qpos, model.jnt_qposadr[j]));
    let (axis, angle) = unit(rotation_between(QUAT_ID, quat));
    let (margin, d, [low, high]) = (model.jnt_margin[j], model.jnt_dofadr[j], model.jnt_range[j]);
    let dist = low.max(high) - angle;
    if dist < margin {
        let spec = Spec {
            solref: model.jnt_solref[j],
            solimp: model.jnt_solimp[j],
            diag: s.params.dof_invweight0[d],
        };
        rows.block(ConstraintType::LimitJoint, j, 1);
        for (k, along) in axis.into_iter().enumerate() {
            rows.entry(d + k, -along);
        }
        rows.row(dist, margin, dist - margin, spec);
    }
}

/// Appends a row for each tendon that has dry friction.
#[inline(always)]
fn tendon_friction(rows: &mut Rows, s: &State) {
    let model = rows.model;
    for t in 0..model.ntendon() {
        let loss = model.tendon_frictionloss[t];
        if loss > 0.0 && tendons(rows, s, (ConstraintType::FrictionTendon, t), &[(t, 1.0)]) {
            let spec = Spec {
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
#[inline(always)]
fn tendon_limits(rows: &mut Rows, s: &State) {
    let model = rows.model;
    for t in 0..model.ntendon() {
        if !model.tendon_limited[t] {
            continue;
        }
        let length = s.ten_length[t];
        let margin = model.tendon_margin[t];
        let spec = Spec {
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

/// Appends the rows of contact `i`.
#[inline(always)]
fn contact(rows: &mut Rows, s: &mut State, i: usize) {
    s.contact[i].efc_address = None;
    let c = &s.contact[i];
    if c.dist >= c.includemargin {
        return;
    }
    let first = rows.efc.pos.len();
    let added = match rows.model.opt.cone {
        ConeType::Pyramidal if c.dim > 1 => pyramid(rows, s, i),
        _ => cone(rows, s, i),
    };
    if added {
        s.contact[i].efc_address = Some(first);
    }
}

/// Appends the rows of a contact with an elliptic cone, or without friction: the normal, then friction. The friction rows
/// have no stiffness; their regularisation follows from that of the normal so that the cone keeps its shape. Returns
/// whether there are any.
#[inline(always)]
fn cone(rows: &mut Rows, s: &State, i: usize) -> bool {
    let model = rows.model;
    let c = &s.contact[i];
    let [b1, b2] = c.geom.map(|g| model.geom_bodyid[g]);
    let kind = if c.dim == 1 {
        ConstraintType::ContactFrictionless
    } else {
        ConstraintType::ContactElliptic
    };
    rows.relative(
        (kind, i, c.dim),
        s,
        (b1, c.pos),
        (b2, c.pos),
        #[inline(always)]
        |translation, rotation, out| {
            for r in 0..c.dim {
                out.push(contact_row(c, r, translation, rotation));
            }
        },
    );
    if rows.block_mut().ncol == 0 && !keeps_without_effect(model, [b1, b2]) {
        rows.drop_block();
        return false;
    }
    let first = rows.efc.pos.len();
    let diag = s.params.body_invweight0[b1][0] + s.params.body_invweight0[b2][0];
    let spec = Spec {
        solref: c.solref,
        solimp: c.solimp,
        diag,
    };
    let mut damping = rows.row(c.dist, c.includemargin, c.dist - c.includemargin, spec);
    if c.dim > 1 {
        if is_solref(c.solreffriction) {
            damping = impedance(c.solreffriction, c.solimp, 0.0, model.opt.least_timeconst()).b;
        }
        let normal = rows.efc.r[first];
        let sliding = normal / model.opt.impratio.max(MINVAL);
        for f in c.friction.iter().take(c.dim - 1) {
            let r = (sliding * c.friction[0] * c.friction[0] / (f * f)).max(MINVAL);
            rows.push(0.0, 0.0, diag, r, 0.0, damping);
        }
        rows.efc.r[first + 1] = sliding;
        rows.efc.d[first + 1] = 1.0 / sliding;
        let block = rows.block_mut();
        block.mu = c.friction[0] * (sliding / normal).sqrt();
        block.friction = c.friction;
    }
    true
}

/// Appends the rows of a contact with a pyramidal cone: for each direction of friction two edges, the normal plus and
/// minus that direction times its coefficient. Returns whether there are any.
///
/// All edges have one regularisation, `2 mu^2 R` with `mu = friction_0 / sqrt(impratio)` and `R` that of the first edge:
/// then the pyramid resists pressing as the normal alone would.
#[inline(always)]
fn pyramid(rows: &mut Rows, s: &State, i: usize) -> bool {
    let model = rows.model;
    let c = &s.contact[i];
    let [b1, b2] = c.geom.map(|g| model.geom_bodyid[g]);
    let edges = 2 * (c.dim - 1);
    rows.relative(
        (ConstraintType::ContactPyramidal, i, edges),
        s,
        (b1, c.pos),
        (b2, c.pos),
        #[inline(always)]
        |translation, rotation, out| {
            let normal = contact_row(c, 0, translation, rotation);
            for r in 1..c.dim {
                let (along, f) = (contact_row(c, r, translation, rotation), c.friction[r - 1]);
                out.push(std::array::from_fn(|k| normal[k] + f * along[k]));
                out.push(std::array::from_fn(|k| normal[k] - f * along[k]));
            }
        },
    );
    if rows.block_mut().ncol == 0 && !keeps_without_effect(model, [b1, b2]) {
        rows.drop_block();
        return false;
    }
    let first = rows.efc.pos.len();
    let [w1, w2] = [b1, b2].map(|b| s.params.body_invweight0[b][0]);
    let spec = Spec {
        solref: c.solref,
        solimp: c.solimp,
        diag: (w1 + w2) * (1.0 + c.friction[0] * c.friction[0]),
    };
    let violation = c.dist - c.includemargin;
    for _ in 0..edges {
        rows.row(c.dist, c.includemargin, violation, spec);
    }
    let mu = c.friction[0] * (1.0 / model.opt.impratio.max(MINVAL)).sqrt();
    let r = (2.0 * mu * mu * rows.efc.r[first]).max(MINVAL);
    rows.efc.r[first..].fill(r);
    rows.efc.d[first..].fill(1.0 / r);
    let block = rows.block_mut();
    block.mu = mu;
    block.friction = c.friction;
    true
}

/// Tells whether MuJoCo gives rows to a contact of two bodies that no degree of freedom moves relative to each other. Such
/// rows move nothing, but the contact has a force; sparse, it drops those that no degree of freedom moves at all.
fn keeps_without_effect(model: &Model, bodies: [usize; 2]) -> bool {
    let fixed = bodies.iter().all(|&b| model.body_weldid[b] == 0);
    model.nv > 0 && !(fixed && model.opt.jacobian.is_sparse(model.nv))
}

/// Returns row `r` of the frame of a contact applied to the motion of a tile: translation along its three axes, then
/// rotation about them.
#[inline(always)]
fn contact_row(c: &Contact, r: usize, translation: &[Lanes; 3], rotation: &[Lanes; 3]) -> Lanes {
    let (axis, motion) = (row(&c.frame, r % 3), if r < 3 { translation } else { rotation });
    let mut lanes = [0.0; 4];
    for k in 0..4 {
        lanes[k] = axis[0] * motion[0][k] + axis[1] * motion[1][k] + axis[2] * motion[2][k];
    }
    lanes
}
