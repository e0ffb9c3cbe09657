//! Constraint rows as programs read them.

use super::{ConstraintType, Efc};
use crate::topology::Topology;

/// A constraint row of the last step; the fields are MuJoCo's `efc_*`.
#[doc(alias("efc_pos", "efc_force"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EfcRow {
    /// Type of the constraint (`efc_type`).
    pub kind: ConstraintType,
    /// Id of the equality, degree of freedom, joint, tendon or contact that it comes from.
    pub id: usize,
    /// Violation of the constraint, m or rad.
    pub pos: f64,
    /// Margin within which it acts, m or rad.
    pub margin: f64,
    /// Approximation of the diagonal of `J M^-1 J'` (`efc_diagApprox`).
    pub diag_approx: f64,
    /// Regularisation (`efc_R`); `efc_D` is its inverse.
    pub r: f64,
    /// Velocity `J qvel`, m/s or rad/s.
    pub vel: f64,
    /// Reference acceleration, m/s^2 or rad/s^2.
    pub aref: f64,
    /// Constraint force, N or N m.
    pub force: f64,
}

impl Efc {
    /// Returns all rows, in order.
    pub fn rows(&self) -> impl Iterator<Item = EfcRow> + '_ {
        self.blocks.iter().flat_map(move |b| {
            (b.row..b.row + b.dim).map(move |row| EfcRow {
                kind: b.kind,
                id: b.id,
                pos: self.pos[row],
                margin: self.margin[row],
                diag_approx: self.diag_approx[row],
                r: self.r[row],
                vel: self.vel[row],
                aref: self.aref[row],
                force: self.force[row],
            })
        })
    }

    /// Returns row `row` of the Jacobian in full (nv), or nothing if there is no such row.
    pub fn jacobian_row(&self, topology: &Topology, row: usize) -> Option<Vec<f64>> {
        let block = self.blocks.iter().find(|b| (b.row..b.row + b.dim).contains(&row))?;
        let tiles = self.cols.get(block.col..block.col + block.ncol)?;
        if tiles.iter().any(|&tile| tile as usize >= topology.tiles.rows()) {
            return None;
        }
        let mut values = vec![0.0; topology.dof_tree.len()];
        for (r, dof, value) in self.entries(topology, block) {
            if block.row + r == row {
                values[dof] = value;
            }
        }
        Some(values)
    }
}
