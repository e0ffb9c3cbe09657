//! Construction of the constraint rows.

use super::append::{RowAppender, RowParameters};
use super::contact_rows::contact;
use super::equality_rows::equalities;
use super::flex_rows::flex_contact;
use super::jacobian::{Jacobian, product};
use super::joint_rows::joint_limits;
use super::tendon_rows::{tendon_friction, tendon_limits};
use super::{Block, ConstraintType, Efc, MAX_ROWS};
use crate::dynamics::CompositeInertia;
use crate::model::Model;
use crate::state::State;
use crate::tiles::Lanes;
use crate::topology::Topology;

/// Builds the constraint rows. Keeps the rows of joints' dry friction, which never change.
#[derive(Clone, Debug, Default)]
pub struct RowBuilder {
    friction: Efc,
    /// Damping of each row of dry friction.
    damping: Vec<f64>,
    /// `qvel` in lanes.
    qvel: Vec<Lanes>,
}

impl RowBuilder {
    /// Prepares the rows of `model` that never change.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let mut friction = Efc::default();
        let mut rows = RowAppender {
            model,
            topology,
            axes: &[],
            efc: &mut friction,
        };
        for d in 0..model.nv {
            let loss = model.dof_frictionloss[d];
            if loss > 0.0 {
                let spec = RowParameters {
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
    #[doc(alias = "mj_makeConstraint")]
    #[inline(always)]
    pub fn build(&mut self, model: &Model, topology: &Topology, composite: &CompositeInertia, s: &mut State) {
        let mut efc = std::mem::take(&mut s.efc);
        efc.clear();
        let flags = &model.opt.flags;
        if !flags.constraint {
            s.efc = efc;
            return;
        }
        topology.to_lanes(&s.qvel, &mut self.qvel);
        let mut rows = RowAppender {
            model,
            topology,
            axes: &composite.axes,
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
        // last, as in MuJoCo: Gauss and Seidel's method visits rows in this order
        let (mut i, mut flexes) = (0, 0);
        loop {
            let end = s.flex_contact.get(flexes).map_or(s.contact.len(), |c| c.after);
            while i < end {
                contact(&mut rows, s, i);
                i += 1;
            }
            if flexes == s.flex_contact.len() {
                break;
            }
            flex_contact(&mut rows, s, flexes);
            flexes += 1;
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
            // not `-damping * v`, which is a negative zero at rest, where MuJoCo's is positive
            efc.aref.push(0.0 - damping * v);
        }
    }

    /// Computes the velocities of all rows except those of dry friction; until now `vel` holds the damping of each.
    #[inline(always)]
    fn add_velocities(&self, efc: &mut Efc, s: &State) {
        efc.force.resize(efc.pos.len(), 0.0);
        for k in 0..efc.blocks.len() {
            let b = &efc.blocks[k];
            if b.kind.is_friction() {
                continue;
            }
            let (row, dim) = (b.row, b.dim);
            let v: [f64; MAX_ROWS] = if let Some(dof) = b.dof {
                let value = efc.jac[b.jac].iter().find(|v| **v != 0.0);
                let mut v = [0.0; MAX_ROWS];
                v[0] = value.copied().unwrap_or(0.0) * s.qvel[dof as usize];
                v
            } else {
                let (col, ncol, jac) = (b.col, b.ncol, b.jac);
                product(&efc.cols, &efc.jac, &Jacobian { dim, col, ncol, jac }, &self.qvel)
            };
            let rows = row..row + dim;
            for ((vel, aref), v) in efc.vel[rows.clone()].iter_mut().zip(&mut efc.aref[rows]).zip(v) {
                *aref -= *vel * v;
                *vel = v;
            }
        }
    }
}
