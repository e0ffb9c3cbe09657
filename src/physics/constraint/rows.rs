//! Construction of the constraint rows.

use crate::math::*;
use crate::model::{EqualityKind, Model};
use crate::physics::constraint::{Block, Efc, RowKind, impedance};
use crate::physics::spatial::{angular, velocity_at};
use crate::physics::state::State;
use crate::physics::topology::Topology;

/// One column of the Jacobian of a relative motion: degree of freedom, translation, rotation.
type Column = (u32, Vec3, Vec3);

/// Pose error of a weld and what its Jacobian needs.
#[derive(Clone, Copy, Debug)]
pub struct Weld {
    /// Constrained point as body 1 carries it, world, m.
    pub point1: Vec3,
    /// Constrained point as body 2 carries it, world, m.
    pub point2: Vec3,
    /// Position error (m) and `torquescale` times the vector part of the relative quaternion.
    pub error: [f64; 6],
    quat1: Quat,
    quat2_conj: Quat,
    torquescale: f64,
}

impl Weld {
    /// Rate of the rotational error under a relative angular velocity `w` of body 1 (world, rad/s).
    pub fn rotation_rate(&self, w: Vec3) -> Vec3 {
        let q = quat_mul(quat_mul(self.quat2_conj, [0.0, w[0], w[1], w[2]]), self.quat1);
        scale([q[1], q[2], q[3]], 0.5 * self.torquescale)
    }

    /// Torque on body 1 (world, N m) of the multipliers of the rotational rows: the transpose of [`Self::rotation_rate`].
    pub fn torque_of_rows(&self, f: Vec3) -> Vec3 {
        std::array::from_fn(|k| {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            dot(self.rotation_rate(axis), f)
        })
    }
}

/// The current state of weld `id`; `None` when that equality is not a weld.
pub fn weld_points(model: &Model, s: &State, id: usize) -> Option<Weld> {
    let EqualityKind::Weld {
        body1,
        body2,
        anchor,
        relpos,
        relquat,
        torquescale,
    } = model.eq_kind[id]
    else {
        return None;
    };
    let (b1, b2) = (body1.0, body2.0);
    let point1 = add(mat_vec(&s.xmat[b1], relpos), s.xpos[b1]);
    let point2 = add(mat_vec(&s.xmat[b2], anchor), s.xpos[b2]);
    let quat1 = quat_mul(s.xquat[b1], relquat);
    let quat2_conj = quat_conj(s.xquat[b2]);
    let q = quat_mul(quat2_conj, quat1);
    let p = sub(point1, point2);
    let error = [
        p[0],
        p[1],
        p[2],
        torquescale * q[1],
        torquescale * q[2],
        torquescale * q[3],
    ];
    Some(Weld {
        point1,
        point2,
        error,
        quat1,
        quat2_conj,
        torquescale,
    })
}

/// Fills `s.efc` from the position stage, the contacts and `qvel`: equalities, friction loss, limits of joints and
/// tendons, contacts. `columns` is working memory.
pub fn make_constraints(model: &Model, topology: &Topology, s: &mut State, columns: &mut Vec<Column>) {
    let mut efc = std::mem::take(&mut s.efc);
    efc.clear();
    let mut rows = Rows { model, efc: &mut efc };
    equalities(&mut rows, topology, s, columns);
    for d in 0..model.nv {
        let loss = model.dof_frictionloss[d];
        if loss > 0.0 {
            let spec = Spec {
                solref: model.dof_solref[d],
                solimp: model.dof_solimp[d],
                diag: model.dof_invweight0[d],
            };
            rows.single(RowKind::FrictionLoss, d, d, 1.0);
            rows.block_mut().frictionloss = loss;
            rows.row(0.0, 0.0, 0.0, spec);
        }
    }
    limits(&mut rows, s);
    for i in 0..s.contacts.len() {
        contact(&mut rows, topology, s, i, columns);
    }
    // vel holds the damping of each row until here
    efc.force.resize(efc.pos.len(), 0.0);
    for k in 0..efc.blocks.len() {
        let b = efc.blocks[k];
        for r in 0..b.dim {
            let mut v = 0.0;
            for c in 0..b.ncol {
                v += efc.jac[b.jac + r * b.ncol + c] * s.qvel[efc.cols[b.col + c] as usize];
            }
            let damping = efc.vel[b.row + r];
            efc.aref[b.row + r] -= damping * v;
            efc.vel[b.row + r] = v;
        }
    }
    s.efc = efc;
}

/// Parameters shared by the rows of a block.
#[derive(Clone, Copy)]
struct Spec {
    solref: [f64; 2],
    solimp: [f64; 5],
    diag: f64,
}

/// Appends blocks and rows.
struct Rows<'a> {
    model: &'a Model,
    efc: &'a mut Efc,
}

impl Rows<'_> {
    fn block(&mut self, kind: RowKind, id: usize, dim: usize, ncol: usize) {
        let e = &mut *self.efc;
        e.blocks.push(Block {
            kind,
            id,
            row: e.pos.len(),
            dim,
            col: e.cols.len(),
            ncol,
            jac: e.jac.len(),
            ..Block::default()
        });
    }

    fn block_mut(&mut self) -> &mut Block {
        let last = self.efc.blocks.len() - 1;
        &mut self.efc.blocks[last]
    }

    /// Starts a block with one row on one degree of freedom.
    fn single(&mut self, kind: RowKind, id: usize, dof: usize, value: f64) {
        self.block(kind, id, 1, 1);
        self.efc.cols.push(dof as u32);
        self.efc.jac.push(value);
    }

    /// Appends a row whose impedance follows from `violation` (the distance to the margin, or the norm of a weld's error).
    fn row(&mut self, pos: f64, margin: f64, violation: f64, spec: Spec) {
        let i = impedance(spec.solref, spec.solimp, violation, self.model.opt.timestep);
        let r = ((1.0 - i.imp) / i.imp * spec.diag).max(MINVAL);
        let k = if self.block_mut().kind == RowKind::FrictionLoss {
            0.0
        } else {
            i.k
        };
        self.push(pos, margin, spec.diag, r, -k * i.imp * (pos - margin), i.b);
    }

    fn push(&mut self, pos: f64, margin: f64, diag: f64, r: f64, aref: f64, damping: f64) {
        let e = &mut *self.efc;
        e.pos.push(pos);
        e.margin.push(margin);
        e.diag_approx.push(diag);
        e.r.push(r);
        e.d.push(1.0 / r);
        e.aref.push(aref);
        e.vel.push(damping);
    }
}

fn equalities(rows: &mut Rows, topology: &Topology, s: &State, columns: &mut Vec<Column>) {
    let model = rows.model;
    for id in 0..model.neq() {
        if !s.params.eq_active[id] {
            continue;
        }
        let mut spec = Spec {
            solref: model.eq_solref[id],
            solimp: model.eq_solimp[id],
            diag: 0.0,
        };
        match model.eq_kind[id] {
            EqualityKind::Joint {
                joint1,
                joint2,
                polycoef,
            } => {
                let displacement = |j: usize| s.qpos[model.jnt_qposadr[j]] - model.qpos0[model.jnt_qposadr[j]];
                let d1 = model.jnt_dofadr[joint1.0];
                let mut pos = displacement(joint1.0) - s.params.eq_offset[id];
                spec.diag = model.dof_invweight0[d1];
                let Some(joint2) = joint2 else {
                    rows.single(RowKind::Equality, id, d1, 1.0);
                    rows.row(pos, 0.0, pos, spec);
                    continue;
                };
                let d2 = model.jnt_dofadr[joint2.0];
                let (x, c) = (displacement(joint2.0), polycoef);
                pos -= x * (c[1] + x * (c[2] + x * (c[3] + x * c[4])));
                let slope = c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * 4.0 * c[4]));
                spec.diag += model.dof_invweight0[d2];
                rows.block(RowKind::Equality, id, 1, 2);
                let mut entries = [(d1, 1.0), (d2, -slope)];
                entries.sort_unstable_by_key(|e| e.0);
                for (d, v) in entries {
                    rows.efc.cols.push(d as u32);
                    rows.efc.jac.push(v);
                }
                rows.row(pos, 0.0, pos, spec);
            }
            EqualityKind::Weld { body1, body2, .. } => {
                let Some(weld) = weld_points(model, s, id) else {
                    continue;
                };
                relative_jacobian(
                    model,
                    topology,
                    s,
                    (body2.0, weld.point2),
                    (body1.0, weld.point1),
                    columns,
                );
                let (n, jac) = (columns.len(), rows.efc.jac.len());
                rows.block(RowKind::Equality, id, 6, n);
                rows.efc.jac.resize(jac + 6 * n, 0.0);
                for (c, &(dof, translation, rotation)) in columns.iter().enumerate() {
                    rows.efc.cols.push(dof);
                    let turn = weld.rotation_rate(rotation);
                    for k in 0..3 {
                        rows.efc.jac[jac + k * n + c] = translation[k];
                        rows.efc.jac[jac + (3 + k) * n + c] = turn[k];
                    }
                }
                let norm = weld.error.iter().map(|e| e * e).sum::<f64>().sqrt();
                for (k, &pos) in weld.error.iter().enumerate() {
                    let (w1, w2) = (model.body_invweight0[body1.0], model.body_invweight0[body2.0]);
                    spec.diag = w1[k / 3] + w2[k / 3];
                    rows.row(pos, 0.0, norm, spec);
                }
            }
        }
    }
}

fn limits(rows: &mut Rows, s: &State) {
    let model = rows.model;
    for j in 0..model.njnt() {
        if !model.jnt_limited[j] {
            continue;
        }
        let (value, margin, d) = (s.qpos[model.jnt_qposadr[j]], model.jnt_margin[j], model.jnt_dofadr[j]);
        let spec = Spec {
            solref: model.jnt_solref[j],
            solimp: model.jnt_solimp[j],
            diag: model.dof_invweight0[d],
        };
        for (side, limit) in [(-1.0, model.jnt_range[j][0]), (1.0, model.jnt_range[j][1])] {
            let dist = side * (limit - value);
            if dist < margin {
                rows.single(RowKind::Limit, j, d, -side);
                rows.row(dist, margin, dist - margin, spec);
            }
        }
    }
    for t in 0..model.ntendon() {
        if !model.tendon_limited[t] {
            continue;
        }
        let wrap = &model.tendon_wrap[t];
        let length: f64 = wrap.iter().map(|&(j, coef)| coef * s.qpos[model.jnt_qposadr[j]]).sum();
        let margin = model.tendon_margin[t];
        let spec = Spec {
            solref: model.tendon_solref_lim[t],
            solimp: model.tendon_solimp_lim[t],
            diag: model.tendon_invweight0[t],
        };
        for (side, limit) in [(-1.0, model.tendon_range[t][0]), (1.0, model.tendon_range[t][1])] {
            let dist = side * (limit - length);
            if dist < margin {
                rows.block(RowKind::Limit, t, 1, wrap.len());
                let start = rows.efc.cols.len();
                rows.efc
                    .cols
                    .extend(wrap.iter().map(|&(j, _)| model.jnt_dofadr[j] as u32));
                rows.efc.cols[start..].sort_unstable();
                for c in start..rows.efc.cols.len() {
                    let dof = rows.efc.cols[c] as usize;
                    let coef: f64 = wrap.iter().filter(|w| model.jnt_dofadr[w.0] == dof).map(|w| w.1).sum();
                    rows.efc.jac.push(-side * coef);
                }
                rows.row(dist, margin, dist - margin, spec);
            }
        }
    }
}

/// Rows of contact `i`: the normal, then friction. The friction rows have no stiffness; their regularisation follows from
/// that of the normal so that the cone keeps its shape.
fn contact(rows: &mut Rows, topology: &Topology, s: &mut State, i: usize, columns: &mut Vec<Column>) {
    let model = rows.model;
    let c = s.contacts[i];
    s.contacts[i].efc_address = None;
    if c.dist >= c.includemargin {
        return;
    }
    let (b1, b2) = (model.geom_bodyid[c.geom[0]], model.geom_bodyid[c.geom[1]]);
    relative_jacobian(model, topology, s, (b1, c.pos), (b2, c.pos), columns);
    let (n, jac) = (columns.len(), rows.efc.jac.len());
    if n == 0 {
        return;
    }
    let kind = if c.dim == 1 {
        RowKind::Frictionless
    } else {
        RowKind::Elliptic
    };
    rows.block(kind, i, c.dim, n);
    rows.efc.jac.resize(jac + c.dim * n, 0.0);
    for (k, &(dof, translation, rotation)) in columns.iter().enumerate() {
        rows.efc.cols.push(dof);
        for r in 0..c.dim {
            let motion = if r < 3 { translation } else { rotation };
            rows.efc.jac[jac + r * n + k] = dot(row(&c.frame, r % 3), motion);
        }
    }
    let first = rows.efc.pos.len();
    let diag = model.body_invweight0[b1][0] + model.body_invweight0[b2][0];
    let spec = Spec {
        solref: c.solref,
        solimp: c.solimp,
        diag,
    };
    rows.row(c.dist, c.includemargin, c.dist - c.includemargin, spec);
    if c.dim > 1 {
        let solref = if c.solreffriction == [0.0; 2] {
            c.solref
        } else {
            c.solreffriction
        };
        let damping = impedance(solref, c.solimp, c.dist - c.includemargin, model.opt.timestep).b;
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
    s.contacts[i].efc_address = Some(first);
}

/// Jacobian of the motion of a point of body `b` relative to a point of body `a`, over the degrees of freedom that move
/// either; those that move both alike are left out.
fn relative_jacobian(
    model: &Model,
    topology: &Topology,
    s: &State,
    (a, point_a): (usize, Vec3),
    (b, point_b): (usize, Vec3),
    out: &mut Vec<Column>,
) {
    out.clear();
    let (chain_a, chain_b) = (topology.body_chain(a), topology.body_chain(b));
    let common = if point_a == point_b {
        chain_a.iter().zip(chain_b).take_while(|(x, y)| x == y).count()
    } else {
        0
    };
    let (mut ia, mut ib) = (common, common);
    while ia < chain_a.len() || ib < chain_b.len() {
        let da = chain_a.get(ia).copied().unwrap_or(u32::MAX);
        let db = chain_b.get(ib).copied().unwrap_or(u32::MAX);
        let d = da.min(db);
        let cdof = &s.cdof[d as usize];
        let com = s.subtree_com[model.body_rootid[model.dof_bodyid[d as usize]]];
        let (mut translation, mut rotation) = ([0.0; 3], [0.0; 3]);
        if db == d {
            translation = velocity_at(cdof, sub(point_b, com));
            rotation = angular(cdof);
            ib += 1;
        }
        if da == d {
            translation = sub(translation, velocity_at(cdof, sub(point_a, com)));
            rotation = sub(rotation, angular(cdof));
            ia += 1;
        }
        out.push((d, translation, rotation));
    }
}
