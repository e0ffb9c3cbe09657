//! Soft constraints in MuJoCo's formulation: rows and the Newton solver.
//!
//! A constraint row `i` has a Jacobian row `J_i`, a reference acceleration `aref_i = -b vel_i - k imp pos_i`, and a
//! regularisation `R_i = (1 - imp)/imp * diagApprox_i`, with impedance `imp` from `solimp` and stiffness `k`, damping
//! `b` from `solref`. The solver minimises `1/2 (a - a_smooth)' M (a - a_smooth) + sum s_i(J a - aref)` over
//! accelerations `a`, where `s_i` is a quadratic on the active side of each constraint and, for contacts with an elliptic
//! friction cone, that of the cone ("Computation" chapter of MuJoCo's documentation). A pyramidal cone is a set of
//! one-sided rows, one for each edge.

mod append;
mod cone;
mod conjugate;
mod contact_force;
mod contact_rows;
mod dual;
mod equality_rows;
mod flex_rows;
mod friction;
mod hessian;
mod impedance;
mod island;
mod jacobian;
mod joint_rows;
mod line_search;
mod newton;
mod primal_search;
mod rows;
mod scalar_rows;
mod tendon_rows;
mod view;
mod weld;

pub use contact_force::contact_forces;
pub use dual::DualSolver;
pub use impedance::impedance;
pub use newton::NewtonSolver;
pub use rows::RowBuilder;
pub use view::EfcRow;
pub use weld::Weld;
pub use weld::{connected_points, weld_points};

use crate::tiles::Lanes;
use crate::topology::Topology;

/// The type of a constraint row: what it constrains, as in MuJoCo's `efc_type`. Rows are in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum ConstraintType {
    /// An equality: the force may have either sign.
    #[default]
    Equality,
    /// Dry friction of a degree of freedom: the force stays within plus and minus `frictionloss`.
    FrictionDof,
    /// Dry friction of a tendon: the force stays within plus and minus `frictionloss`.
    FrictionTendon,
    /// A limit of a joint: the force is not negative.
    LimitJoint,
    /// A limit of a tendon: the force is not negative.
    LimitTendon,
    /// A contact without friction: the force is not negative.
    ContactFrictionless,
    /// A contact with a pyramidal friction cone: the force along each edge is not negative.
    ContactPyramidal,
    /// A contact with an elliptic friction cone.
    ContactElliptic,
}

impl ConstraintType {
    /// Returns whether it is dry friction, which has no position.
    pub fn is_friction(self) -> bool {
        matches!(self, Self::FrictionDof | Self::FrictionTendon)
    }
}

/// Maximum number of rows of a block: the edges of a pyramid with six dimensions.
pub const MAX_ROWS: usize = 10;

/// Rows that belong together and share their columns.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Block {
    /// Type of the constraint.
    pub kind: ConstraintType,
    /// Id of the equality, degree of freedom, joint, tendon or contact that it comes from.
    pub id: usize,
    /// First row.
    pub row: usize,
    /// Number of rows.
    pub dim: usize,
    /// First tile in [`Efc::cols`].
    pub col: usize,
    /// Number of tiles.
    pub ncol: usize,
    /// First entry in [`Efc::jac`].
    pub jac: usize,
    /// The degree of freedom of a row that has only one.
    pub dof: Option<u32>,
    /// Bound of dry friction, N m.
    pub frictionloss: f64,
    /// Index in [`Efc::cones`], for a contact with friction.
    pub cone: u32,
}

/// The friction of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ConeShape {
    /// Slope of the regularised cone.
    pub mu: f64,
    /// Coefficients.
    pub friction: [f64; 5],
}

/// The constraint rows of a step ("efc" in MuJoCo).
#[derive(Clone, Debug, Default)]
pub struct Efc {
    /// Blocks, in row order.
    pub blocks: Vec<Block>,
    /// Tiles of degrees of freedom ([`Topology::tiles`]) in which each block has entries, ascending.
    pub cols: Vec<u32>,
    /// Friction of contacts. It is stored separately from blocks, which are written in each step and mostly have one degree of freedom.
    pub cones: Vec<ConeShape>,
    /// Jacobian values of each block: for each of its tiles, `dim` rows.
    pub jac: Vec<Lanes>,
    /// Constraint violation of each row, m or rad.
    pub pos: Vec<f64>,
    /// Margin of each row.
    pub margin: Vec<f64>,
    /// Approximation of the diagonal of `J M^-1 J'`.
    pub diag_approx: Vec<f64>,
    /// Regularisation.
    pub r: Vec<f64>,
    /// Inverse of `r`.
    pub d: Vec<f64>,
    /// Velocity `J qvel`.
    pub vel: Vec<f64>,
    /// Reference acceleration.
    pub aref: Vec<f64>,
    /// Constraint force, N or N m.
    pub force: Vec<f64>,
}

impl Efc {
    /// Returns the number of rows.
    pub fn nefc(&self) -> usize {
        self.pos.len()
    }

    /// Reserves memory for `contacts` contacts and the rows of `nv` degrees of freedom.
    pub fn with_capacity(nv: usize, contacts: usize) -> Self {
        let rows = 4 * contacts + 3 * nv;
        let reserved = || Vec::with_capacity(rows);
        Self {
            blocks: Vec::with_capacity(contacts + 3 * nv),
            cones: Vec::with_capacity(contacts),
            cols: Vec::with_capacity(8 * contacts + 3 * nv),
            jac: Vec::with_capacity(32 * contacts + 9 * nv),
            pos: reserved(),
            margin: reserved(),
            diag_approx: reserved(),
            r: reserved(),
            d: reserved(),
            vel: reserved(),
            aref: reserved(),
            force: reserved(),
        }
    }

    /// Drops all rows but keeps the memory.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.cones.clear();
        self.cols.clear();
        self.jac.clear();
        for v in [
            &mut self.pos,
            &mut self.margin,
            &mut self.diag_approx,
            &mut self.r,
            &mut self.d,
            &mut self.vel,
            &mut self.aref,
            &mut self.force,
        ] {
            v.clear();
        }
    }

    /// Returns the friction of a contact from its block.
    #[inline(always)]
    pub fn cone(&self, b: &Block) -> &ConeShape {
        &self.cones[b.cone as usize]
    }

    /// Returns the tiles of a block, and for each of them `dim` rows.
    pub fn tiles(&self, b: &Block) -> impl Iterator<Item = (u32, &[Lanes])> {
        let rows = self.jac[b.jac..b.jac + b.dim * b.ncol].chunks_exact(b.dim.max(1));
        self.cols[b.col..b.col + b.ncol].iter().copied().zip(rows)
    }

    /// Returns the entries of the Jacobian of a block: row in the block, degree of freedom, value.
    pub fn entries(&self, topology: &Topology, b: &Block) -> impl Iterator<Item = (usize, usize, f64)> {
        self.tiles(b).flat_map(move |(tile, rows)| {
            let (first, lanes) = (topology.tile_dof[tile as usize], topology.lanes(tile as usize));
            let row = move |(r, row): (usize, &Lanes)| {
                let row = *row;
                (0..lanes).map(move |k| (r, first + k, row[k]))
            };
            rows.iter().enumerate().flat_map(row)
        })
    }
}
