//! Everything about a scene that changes while it runs.

use crate::math::{MAT3_ID, Mat3, QUAT_ID, Quat, Vec3};
use crate::model::{EqualityKind, Model};
use crate::physics::constraint::Efc;
use crate::physics::spatial::{Inertia, Spatial};
use crate::physics::tiles::{Lanes, Tile};
use crate::physics::topology::Topology;

/// Contacts for which memory is reserved, so that steps need not allocate. The cubes scene reaches about 100.
pub(crate) const RESERVED_CONTACTS: usize = 192;

/// A detected contact between two geoms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The geoms: the one of lower [`crate::model::GeomType`] first, which the normal points away from.
    pub geom: [usize; 2],
    /// Distance between the surfaces, m; negative is penetration.
    pub dist: f64,
    /// Midpoint between the surfaces, world, m.
    pub pos: Vec3,
    /// Rows are the normal from the first to the second geom and two tangents, world.
    pub frame: Mat3,
    /// Dimension: 1 frictionless, 3 sliding, 4 with torsional, 6 with rolling friction.
    pub dim: usize,
    /// Two sliding, one torsional, two rolling friction coefficients.
    pub friction: [f64; 5],
    /// `solref` of the normal.
    pub solref: [f64; 2],
    /// `solref` of friction; zeros mean that of the normal.
    pub solreffriction: [f64; 2],
    /// `solimp`.
    pub solimp: [f64; 5],
    /// Distance at which the contact becomes a constraint: margin minus gap, m.
    pub includemargin: f64,
    /// First constraint row, when it is a constraint.
    pub efc_address: Option<usize>,
    /// Force that the first geom exerts on the second, and torque, in the contact frame, N and N m. Filled by the solver.
    pub force: [f64; 6],
}

/// Parameters that a program may change while the scene runs; copied from the model at construction.
#[derive(Debug, PartialEq)]
pub struct Params {
    /// Which equality constraints hold (neq).
    pub eq_active: Vec<bool>,
    /// Constant term of each joint equality (neq), rad; unused for welds.
    pub eq_offset: Vec<f64>,
    /// Joint stiffness (njnt), N m/rad.
    pub jnt_stiffness: Vec<f64>,
    /// Damping (nv), N m s/rad.
    pub dof_damping: Vec<f64>,
    /// Actuator gear (nu).
    pub actuator_gear: Vec<f64>,
    /// Whether the actuator force is limited (nu).
    pub actuator_forcelimited: Vec<bool>,
}

impl Clone for Params {
    fn clone(&self) -> Self {
        Self {
            eq_active: self.eq_active.clone(),
            eq_offset: self.eq_offset.clone(),
            jnt_stiffness: self.jnt_stiffness.clone(),
            dof_damping: self.dof_damping.clone(),
            actuator_gear: self.actuator_gear.clone(),
            actuator_forcelimited: self.actuator_forcelimited.clone(),
        }
    }

    /// Keeps the memory, so that a reset does not allocate.
    fn clone_from(&mut self, other: &Self) {
        self.eq_active.clone_from(&other.eq_active);
        self.eq_offset.clone_from(&other.eq_offset);
        self.jnt_stiffness.clone_from(&other.jnt_stiffness);
        self.dof_damping.clone_from(&other.dof_damping);
        self.actuator_gear.clone_from(&other.actuator_gear);
        self.actuator_forcelimited.clone_from(&other.actuator_forcelimited);
    }
}

impl Params {
    /// The model's own values.
    pub fn new(model: &Model) -> Self {
        let offset = |k: &EqualityKind| match k {
            EqualityKind::Joint { polycoef, .. } => polycoef[0],
            EqualityKind::Weld { .. } => 0.0,
        };
        Self {
            eq_active: model.eq_active0.clone(),
            eq_offset: model.eq_kind.iter().map(offset).collect(),
            jnt_stiffness: model.jnt_stiffness.clone(),
            dof_damping: model.dof_damping.clone(),
            actuator_gear: model.actuator_gear.clone(),
            actuator_forcelimited: model.actuator_forcelimited.clone(),
        }
    }
}

/// The state of a scene and every quantity computed from it.
///
/// `qpos` and `qvel` are advanced by a step; everything under "position stage" and later describes the *start* of the
/// last step, before integration, as in MuJoCo.
#[derive(Clone, Debug)]
pub struct State {
    /// Simulated time, s.
    pub time: f64,
    /// Steps done since construction or reset.
    pub step: u64,
    /// Positions (nq): m, rad, quaternions.
    pub qpos: Vec<f64>,
    /// Velocities (nv): m/s, rad/s.
    pub qvel: Vec<f64>,
    /// Controls (nu).
    pub ctrl: Vec<f64>,
    /// Generalised force applied from outside (nv), N and N m.
    pub qfrc_applied: Vec<f64>,
    /// Start of the solver (nv): the last acceleration.
    pub qacc_warmstart: Vec<f64>,
    /// Parameters that may change.
    pub params: Params,

    // position stage
    /// Body positions (nbody), world, m.
    pub xpos: Vec<Vec3>,
    /// Body orientations (nbody).
    pub xquat: Vec<Quat>,
    /// Body orientations (nbody) as matrices.
    pub xmat: Vec<Mat3>,
    /// Centres of mass (nbody), world, m.
    pub xipos: Vec<Vec3>,
    /// Orientations of the principal axes (nbody).
    pub ximat: Vec<Mat3>,
    /// Joint anchors (njnt), world, m.
    pub xanchor: Vec<Vec3>,
    /// Joint axes (njnt), world.
    pub xaxis: Vec<Vec3>,
    /// Geom positions (ngeom), world, m.
    pub geom_xpos: Vec<Vec3>,
    /// Geom orientations (ngeom).
    pub geom_xmat: Vec<Mat3>,
    /// Site positions (nsite), world, m.
    pub site_xpos: Vec<Vec3>,
    /// Site orientations (nsite).
    pub site_xmat: Vec<Mat3>,
    /// Camera positions (ncam), world, m.
    pub cam_xpos: Vec<Vec3>,
    /// Camera orientations (ncam); a camera looks along its -z.
    pub cam_xmat: Vec<Mat3>,
    /// Centre of mass of each subtree (nbody), world, m.
    pub subtree_com: Vec<Vec3>,
    /// Body inertias (nbody) about the centre of mass of their tree.
    pub cinert: Vec<Inertia>,
    /// Motion axes (nv) about the centre of mass of their tree.
    pub cdof: Vec<Spatial>,
    /// Composite inertias of subtrees (nbody).
    pub crb: Vec<Inertia>,
    /// Motion axes by tile: six values for each lane, zeros where there is none.
    pub cdof_lanes: Vec<[Lanes; 6]>,
    /// Joint-space inertia in tiles ([`Topology::tiles`]), both triangles of those on the diagonal.
    pub qm: Vec<Tile>,
    /// Contacts in MuJoCo's order.
    pub contacts: Vec<Contact>,
    /// Constraint rows.
    pub efc: Efc,

    // velocity stage
    /// Body velocities (nbody) about the centre of mass of their tree.
    pub cvel: Vec<Spatial>,
    /// Rates of the motion axes (nv).
    pub cdof_dot: Vec<Spatial>,
    /// Coriolis, centrifugal and gravity force (nv).
    pub qfrc_bias: Vec<f64>,
    /// Spring and damper force (nv).
    pub qfrc_passive: Vec<f64>,

    // acceleration stage
    /// Actuator force before the gear (nu).
    pub actuator_force: Vec<f64>,
    /// Actuator force on the joints (nv).
    pub qfrc_actuator: Vec<f64>,
    /// All forces but those of constraints (nv).
    pub qfrc_smooth: Vec<f64>,
    /// Acceleration without constraints (nv).
    pub qacc_smooth: Vec<f64>,
    /// Constraint force (nv).
    pub qfrc_constraint: Vec<f64>,
    /// Acceleration (nv), without the implicit damping of the integrator.
    pub qacc: Vec<f64>,
    /// Newton iterations of the last step, summed over islands.
    pub solver_iterations: usize,

    // after constraints
    /// Body accelerations (nbody), gravity as upward acceleration of the world.
    pub cacc: Vec<Spatial>,
    /// External wrench on each body (nbody): contacts and welds.
    pub cfrc_ext: Vec<Spatial>,
    /// Wrench that the parent exerts on each body (nbody).
    pub cfrc_int: Vec<Spatial>,
}

impl State {
    /// The reference configuration at rest; nothing is computed yet, all frames are at the origin.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let (nv, nb, ng) = (model.nv, model.nbody(), model.ngeom());
        Self {
            time: 0.0,
            step: 0,
            qpos: model.qpos0.clone(),
            qvel: vec![0.0; nv],
            ctrl: vec![0.0; model.nu()],
            qfrc_applied: vec![0.0; nv],
            qacc_warmstart: vec![0.0; nv],
            params: Params::new(model),
            xpos: vec![[0.0; 3]; nb],
            xquat: vec![QUAT_ID; nb],
            xmat: vec![MAT3_ID; nb],
            xipos: vec![[0.0; 3]; nb],
            ximat: vec![MAT3_ID; nb],
            xanchor: vec![[0.0; 3]; model.njnt()],
            xaxis: vec![[0.0; 3]; model.njnt()],
            geom_xpos: vec![[0.0; 3]; ng],
            geom_xmat: vec![MAT3_ID; ng],
            site_xpos: vec![[0.0; 3]; model.nsite()],
            site_xmat: vec![MAT3_ID; model.nsite()],
            cam_xpos: vec![[0.0; 3]; model.ncam()],
            cam_xmat: vec![MAT3_ID; model.ncam()],
            subtree_com: vec![[0.0; 3]; nb],
            cinert: vec![[0.0; 10]; nb],
            cdof: vec![[0.0; 6]; nv],
            crb: vec![[0.0; 10]; nb],
            cdof_lanes: vec![[[0.0; 4]; 6]; topology.tiles.rows()],
            qm: topology.new_tiles(),
            contacts: Vec::with_capacity(RESERVED_CONTACTS),
            efc: Efc::with_capacity(nv, RESERVED_CONTACTS),
            cvel: vec![[0.0; 6]; nb],
            cdof_dot: vec![[0.0; 6]; nv],
            qfrc_bias: vec![0.0; nv],
            qfrc_passive: vec![0.0; nv],
            actuator_force: vec![0.0; model.nu()],
            qfrc_actuator: vec![0.0; nv],
            qfrc_smooth: vec![0.0; nv],
            qacc_smooth: vec![0.0; nv],
            qfrc_constraint: vec![0.0; nv],
            qacc: vec![0.0; nv],
            solver_iterations: 0,
            cacc: vec![[0.0; 6]; nb],
            cfrc_ext: vec![[0.0; 6]; nb],
            cfrc_int: vec![[0.0; 6]; nb],
        }
    }

    /// Copies what a later continuation depends on: time, positions, velocities, controls, applied forces, warm start
    /// and parameters. Everything else is recomputed by the next step.
    pub fn copy_dynamic_from(&mut self, other: &State) {
        self.time = other.time;
        self.step = other.step;
        self.qpos.copy_from_slice(&other.qpos);
        self.qvel.copy_from_slice(&other.qvel);
        self.ctrl.copy_from_slice(&other.ctrl);
        self.qfrc_applied.copy_from_slice(&other.qfrc_applied);
        self.qacc_warmstart.copy_from_slice(&other.qacc_warmstart);
        self.params.clone_from(&other.params);
    }
}
