//! Construction of the constraint rows.

use crate::math::*;
use crate::model::{EqualityKind, Model};
use crate::physics::constraint::{Block, Efc, RowKind, impedance};
use crate::physics::state::State;
use crate::physics::tiles::{Lanes, total};
use crate::physics::topology::Topology;

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

/// Builds the constraint rows. Keeps those of dry friction, which are always the same.
#[derive(Clone, Debug, Default)]
pub struct RowBuilder {
    friction: Efc,
    /// Damping of each row of dry friction.
    damping: Vec<f64>,
    /// `qvel` in lanes.
    qvel: Vec<Lanes>,
}

impl RowBuilder {
    /// For `model`.
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
                rows.single(RowKind::FrictionLoss, d, d, 1.0);
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
    pub fn build(&mut self, model: &Model, topology: &Topology, s: &mut State) {
        let mut efc = std::mem::take(&mut s.efc);
        efc.clear();
        topology.to_lanes(&s.qvel, &mut self.qvel);
        let mut rows = Rows {
            model,
            topology,
            efc: &mut efc,
        };
        equalities(&mut rows, s);
        self.add_friction(rows.efc, s);
        limits(&mut rows, s);
        for i in 0..s.contacts.len() {
            contact(&mut rows, s, i);
        }
        self.add_velocities(&mut efc, s);
        s.efc = efc;
    }

    /// Appends dry friction.
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

    /// Velocities of all rows but those of dry friction; `vel` holds the damping of each until here.
    fn add_velocities(&self, efc: &mut Efc, s: &State) {
        efc.force.resize(efc.pos.len(), 0.0);
        for k in 0..efc.blocks.len() {
            let b = &efc.blocks[k];
            if b.kind == RowKind::FrictionLoss {
                continue;
            }
            let (row, dim, dof) = (b.row, b.dim, b.dof);
            let mut v = [0.0; 6];
            if let Some(dof) = dof {
                let value = efc.jac[b.jac].iter().find(|v| **v != 0.0);
                v[0] = value.copied().unwrap_or(0.0) * s.qvel[dof];
            } else {
                let mut sums = [[0.0; 4]; 6];
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
    topology: &'a Topology,
    efc: &'a mut Efc,
}

impl Rows<'_> {
    /// Starts a block without columns.
    fn block(&mut self, kind: RowKind, id: usize, dim: usize) {
        let e = &mut *self.efc;
        e.blocks.push(Block {
            kind,
            id,
            row: e.pos.len(),
            dim,
            col: e.cols.len(),
            jac: e.jac.len(),
            ..Block::default()
        });
    }

    fn block_mut(&mut self) -> &mut Block {
        let last = self.efc.blocks.len() - 1;
        &mut self.efc.blocks[last]
    }

    /// Adds to the entry of a degree of freedom in the last block, whose dimension is 1. Degrees of freedom come
    /// ascending.
    fn entry(&mut self, dof: usize, value: f64) {
        let slot = self.topology.slot[dof];
        let e = &mut *self.efc;
        let last = e.blocks.len() - 1;
        let b = &mut e.blocks[last];
        if b.ncol == 0 || e.cols.last() != Some(&(slot / 4)) {
            e.cols.push(slot / 4);
            e.jac.push([0.0; 4]);
            b.ncol += 1;
        }
        if let Some(lanes) = e.jac.last_mut() {
            lanes[slot as usize % 4] += value;
        }
    }

    /// Starts a block with one row on one degree of freedom.
    fn single(&mut self, kind: RowKind, id: usize, dof: usize, value: f64) {
        self.block(kind, id, 1);
        self.entry(dof, value);
        self.block_mut().dof = Some(dof);
    }

    /// Starts a block for the motion of a point of body `b` relative to a point of body `a`, over the tiles that move either;
    /// those that move both alike are left out. `rows` turns translation and rotation (three axes each) of a tile into rows.
    fn relative(
        &mut self,
        (kind, id, dim): (RowKind, usize, usize),
        s: &State,
        (a, point_a): (usize, Vec3),
        (b, point_b): (usize, Vec3),
        mut rows: impl FnMut(&[Lanes; 3], &[Lanes; 3], &mut Vec<Lanes>),
    ) {
        self.block(kind, id, dim);
        let (model, topology) = (self.model, self.topology);
        let (mut tiles_a, mut tiles_b) = (topology.body_tiles(a), topology.body_tiles(b));
        // of the same tree, or one of them is not used
        let com_a = s.subtree_com[model.body_rootid[a]];
        let com_b = s.subtree_com[model.body_rootid[b]];
        let (offset_a, offset_b) = (sub(point_a, com_a), sub(point_b, com_b));
        let mut ncol = 0;
        loop {
            let next = |tiles: &[(u32, u32)]| tiles.first().map_or((u32::MAX, 0), |t| *t);
            let ((tile_a, lanes_a), (tile_b, lanes_b)) = (next(tiles_a), next(tiles_b));
            let tile = tile_a.min(tile_b);
            if tile == u32::MAX {
                break;
            }
            let (mut translation, mut rotation) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
            let cdof = &s.cdof_lanes[tile as usize];
            if tile_b == tile {
                tiles_b = &tiles_b[1..];
            }
            if tile_a == tile {
                tiles_a = &tiles_a[1..];
            }
            if tile_a == tile_b && lanes_a == lanes_b && point_a == point_b {
                continue;
            }
            if tile_b == tile {
                add_motion(cdof, lanes_b, offset_b, |v, w| v + w, &mut translation, &mut rotation);
            }
            if tile_a == tile {
                add_motion(cdof, lanes_a, offset_a, |v, w| v - w, &mut translation, &mut rotation);
            }
            self.efc.cols.push(tile);
            rows(&translation, &rotation, &mut self.efc.jac);
            ncol += 1;
        }
        self.block_mut().ncol = ncol;
    }

    /// Appends a row whose impedance follows from `violation` (the distance to the margin, or the norm of a weld's error).
    /// Returns its damping.
    fn row(&mut self, pos: f64, margin: f64, violation: f64, spec: Spec) -> f64 {
        let i = impedance(spec.solref, spec.solimp, violation, self.model.opt.timestep);
        let r = ((1.0 - i.imp) / i.imp * spec.diag).max(MINVAL);
        let k = if self.block_mut().kind == RowKind::FrictionLoss {
            0.0
        } else {
            i.k
        };
        self.push(pos, margin, spec.diag, r, -k * i.imp * (pos - margin), i.b);
        i.b
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

/// Adds (or subtracts) the motion of a point at `offset` from the centre of mass due to the first `lanes` of a tile.
#[inline(always)]
fn add_motion(
    cdof: &[Lanes; 6],
    lanes: u32,
    offset: Vec3,
    join: impl Fn(f64, f64) -> f64,
    translation: &mut [Lanes; 3],
    rotation: &mut [Lanes; 3],
) {
    let [wx, wy, wz, x, y, z] = cdof;
    for k in 0..4 {
        let moves = if (k as u32) < lanes { 1.0 } else { 0.0 };
        let (wx, wy, wz) = (moves * wx[k], moves * wy[k], moves * wz[k]);
        let v = [
            moves * x[k] + (wy * offset[2] - wz * offset[1]),
            moves * y[k] + (wz * offset[0] - wx * offset[2]),
            moves * z[k] + (wx * offset[1] - wy * offset[0]),
        ];
        for (c, w) in [wx, wy, wz].into_iter().enumerate() {
            translation[c][k] = join(translation[c][k], v[c]);
            rotation[c][k] = join(rotation[c][k], w);
        }
    }
}

fn equalities(rows: &mut Rows, s: &State) {
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
                rows.block(RowKind::Equality, id, 1);
                let mut entries = [(d1, 1.0), (d2, -slope)];
                entries.sort_unstable_by_key(|e| e.0);
                entries.into_iter().for_each(|(d, v)| rows.entry(d, v));
                rows.row(pos, 0.0, pos, spec);
            }
            EqualityKind::Weld { body1, body2, .. } => {
                let Some(weld) = weld_points(model, s, id) else {
                    continue;
                };
                rows.relative(
                    (RowKind::Equality, id, 6),
                    s,
                    (body2.0, weld.point2),
                    (body1.0, weld.point1),
                    |translation, rotation, out| {
                        let mut turn = [[0.0; 4]; 3];
                        for k in 0..4 {
                            let rate = weld.rotation_rate([rotation[0][k], rotation[1][k], rotation[2][k]]);
                            (turn[0][k], turn[1][k], turn[2][k]) = (rate[0], rate[1], rate[2]);
                        }
                        out.extend_from_slice(translation);
                        out.extend_from_slice(&turn);
                    },
                );
                if rows.block_mut().ncol == 0 {
                    rows.efc.blocks.pop();
                    continue;
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
        for (side, limit) in [(-1.0, model.jnt_range[j][0]), (1.0, model.jnt_range[j][1])] {
            let dist = side * (limit - value);
            if dist < margin {
                let spec = Spec {
                    solref: model.jnt_solref[j],
                    solimp: model.jnt_solimp[j],
                    diag: model.dof_invweight0[d],
                };
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
                rows.block(RowKind::Limit, t, 1);
                // ascending, whatever the order in the model
                let mut from = 0;
                while let Some(d) = wrap.iter().map(|w| model.jnt_dofadr[w.0]).filter(|d| *d >= from).min() {
                    let coef: f64 = wrap.iter().filter(|w| model.jnt_dofadr[w.0] == d).map(|w| w.1).sum();
                    rows.entry(d, -side * coef);
                    from = d + 1;
                }
                rows.row(dist, margin, dist - margin, spec);
            }
        }
    }
}

/// Rows of contact `i`: the normal, then friction. The friction rows have no stiffness; their regularisation follows from
/// that of the normal so that the cone keeps its shape.
fn contact(rows: &mut Rows, s: &mut State, i: usize) {
    let model = rows.model;
    s.contacts[i].efc_address = None;
    let c = &s.contacts[i];
    if c.dist >= c.includemargin {
        return;
    }
    let (b1, b2) = (model.geom_bodyid[c.geom[0]], model.geom_bodyid[c.geom[1]]);
    let kind = if c.dim == 1 {
        RowKind::Frictionless
    } else {
        RowKind::Elliptic
    };
    rows.relative(
        (kind, i, c.dim),
        s,
        (b1, c.pos),
        (b2, c.pos),
        |translation, rotation, out| {
            for r in 0..c.dim {
                let (axis, motion) = (row(&c.frame, r % 3), if r < 3 { translation } else { rotation });
                let mut lanes = [0.0; 4];
                for k in 0..4 {
                    lanes[k] = axis[0] * motion[0][k] + axis[1] * motion[1][k] + axis[2] * motion[2][k];
                }
                out.push(lanes);
            }
        },
    );
    if rows.block_mut().ncol == 0 {
        rows.efc.blocks.pop();
        return;
    }
    let first = rows.efc.pos.len();
    let diag = model.body_invweight0[b1][0] + model.body_invweight0[b2][0];
    let spec = Spec {
        solref: c.solref,
        solimp: c.solimp,
        diag,
    };
    let mut damping = rows.row(c.dist, c.includemargin, c.dist - c.includemargin, spec);
    if c.dim > 1 {
        if c.solreffriction != [0.0; 2] {
            damping = impedance(c.solreffriction, c.solimp, 0.0, model.opt.timestep).b;
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
    s.contacts[i].efc_address = Some(first);
}
