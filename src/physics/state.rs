//! Everything about a scene that changes while it runs.

use crate::math::{MAT3_ID, Mat3, QUAT_ID, Quat, Vec3, add, cross, sub};
use crate::model::Arrays;
use crate::physics::constraint::{Efc, EfcRow};
use crate::physics::engine::EngineError;
use crate::physics::params::Params;
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
    /// Force that the first geom exerts on the second, and torque, in the contact frame, N and N m. Filled by the
    /// solver.
    pub force: [f64; 6],
}

/// Everything that changes while a scene runs, and every quantity computed from it: MuJoCo's `mjData`.
///
/// The fields up to `params` decide how a run goes on, with any engine and any actuation model: a copy of them
/// ([`State::copy_dynamic_from`]) continues with the same bits. A step advances `qpos` and `qvel`; all computed
/// quantities describe the *start* of the last step, before integration, as in MuJoCo.
///
/// Constraint rows are read with [`State::efc_rows`], their Jacobian and the inertia matrix with
/// [`Engine::efc_j`](crate::physics::Engine::efc_j) and [`Engine::full_m`](crate::physics::Engine::full_m).
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
    /// Controls of the actuators (nu). With muscles 1 while they pull and 0 while they do not.
    pub ctrl: Vec<f64>,
    /// Activations of the muscles (na), 0..1: muscle 1 of every actuator, then muscle 2. Empty without muscles.
    pub act: Vec<f64>,
    /// What the actuators were last told to reach: excitations of muscles (na), 0..1, or desired angles of position
    /// servos (nu), rad. Empty for motors.
    pub actuator_target: Vec<f64>,
    /// Forces of the muscles (na) at the last activation, relative to their isometric maxima. Empty without muscles.
    pub muscle_force: Vec<f64>,
    /// Torques of the muscles on the joints of the actuators (nu), N m, which act at control 1 in place of the
    /// actuators' own. Empty without muscles.
    pub muscle_torque: Vec<f64>,
    /// Generalised force applied from outside (nv), N and N m.
    pub qfrc_applied: Vec<f64>,
    /// Force and torque applied from outside to each body (nbody) at its centre of mass `xipos`, world: force, N, torque,
    /// N m. They act in every step until they are changed; [`State::apply_force`] adds to them.
    pub xfrc_applied: Vec<[f64; 6]>,
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
    /// Motion axes (nv) about the centre of mass of their tree: rotation, translation.
    pub cdof: Vec<[f64; 6]>,
    /// Body inertias (nbody) about the centre of mass of their tree.
    pub(crate) cinert: Vec<Inertia>,
    /// Composite inertias of subtrees (nbody).
    pub(crate) crb: Vec<Inertia>,
    /// Motion axes by tile: six values for each lane, zeros where there is none.
    pub(crate) cdof_lanes: Vec<[Lanes; 6]>,
    /// Joint-space inertia in tiles ([`Topology::tiles`]), both triangles of those on the diagonal.
    pub(crate) qm: Vec<Tile>,
    /// Contacts in MuJoCo's order.
    pub contact: Vec<Contact>,
    /// Constraint rows.
    pub(crate) efc: Efc,

    // velocity stage
    /// Body velocities (nbody) about the centre of mass of their tree: rotation, rad/s, translation, m/s.
    pub cvel: Vec<[f64; 6]>,
    /// Rates of the motion axes (nv).
    pub(crate) cdof_dot: Vec<Spatial>,
    /// Coriolis, centrifugal and gravity force (nv).
    pub qfrc_bias: Vec<f64>,
    /// Spring and damper force (nv).
    pub qfrc_passive: Vec<f64>,

    // acceleration stage
    /// Actuator force before the gear (nu); with muscles their torque on the joint, N m.
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
    /// Body accelerations (nbody), gravity as upward acceleration of the world: rotation, rad/s^2, translation, m/s^2.
    pub cacc: Vec<[f64; 6]>,
    /// External wrench on each body (nbody), of contacts, welds and `xfrc_applied`: torque, N m, force, N.
    pub cfrc_ext: Vec<[f64; 6]>,
    /// Wrench that the parent exerts on each body (nbody): torque, N m, force, N.
    pub cfrc_int: Vec<[f64; 6]>,
    /// Values of the model's sensors (nsensordata), three for each, in the frame of its site: linear acceleration minus
    /// gravity, m/s^2; angular velocity, rad/s; torque that the parent exerts on the site's body about the site, N m.
    pub sensordata: Vec<f64>,
}

impl State {
    /// Returns the reference configuration at rest, of which nothing is computed yet: all frames are at the origin.
    pub fn new(model: &Arrays, topology: &Topology) -> Self {
        let (nv, nb, ng) = (model.nv, model.nbody(), model.ngeom());
        Self {
            time: 0.0,
            step: 0,
            qpos: model.qpos0.clone(),
            qvel: vec![0.0; nv],
            ctrl: vec![0.0; model.nu()],
            act: Vec::new(),
            actuator_target: Vec::new(),
            muscle_force: Vec::new(),
            muscle_torque: Vec::new(),
            qfrc_applied: vec![0.0; nv],
            xfrc_applied: vec![[0.0; 6]; nb],
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
            contact: Vec::with_capacity(RESERVED_CONTACTS),
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
            sensordata: vec![0.0; model.nsensordata()],
        }
    }

    /// Copies what a continuation depends on: time, positions, velocities, controls, muscles, applied forces, warm
    /// start and parameters. Everything else is computed anew by the next step. Between states of one model and one
    /// actuation model nothing is allocated.
    pub fn copy_dynamic_from(&mut self, other: &State) {
        self.time = other.time;
        self.step = other.step;
        self.qpos.clone_from(&other.qpos);
        self.qvel.clone_from(&other.qvel);
        self.ctrl.clone_from(&other.ctrl);
        self.act.clone_from(&other.act);
        self.actuator_target.clone_from(&other.actuator_target);
        self.muscle_force.clone_from(&other.muscle_force);
        self.muscle_torque.clone_from(&other.muscle_torque);
        self.qfrc_applied.clone_from(&other.qfrc_applied);
        self.xfrc_applied.clone_from(&other.xfrc_applied);
        self.qacc_warmstart.clone_from(&other.qacc_warmstart);
        self.params.clone_from(&other.params);
    }

    /// Adds a force (N) at a point (m) and a torque (N m) to what acts on a body, all in the world frame: MuJoCo's
    /// `mj_applyFT` into [`State::xfrc_applied`]. The point is taken with the body's present pose, that of the start of the
    /// last step. The force acts in every step until [`State::release_forces`] or the next reset.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let mut env = Env::new(Config { touch_active: false, vision_active: false, ..Config::default() })?;
    /// env.reset(Some(0))?;
    /// let hand = env.model().body("right_hand").ok_or("MIMo has hands")?;
    /// let action = vec![0.0; env.action_space().len()];
    /// let before = env.state().xpos[hand];
    /// for _ in 0..20 {
    ///     let state = env.state_mut();
    ///     state.release_forces();
    ///     state.apply_force(hand, [0.0, 0.0, 5.0], [0.0; 3], state.xpos[hand])?;
    ///     env.step(&action)?;
    /// }
    /// assert!(env.state().xpos[hand][2] > before[2] + 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A body that does not exist, numbers that are not finite; nothing is changed then.
    pub fn apply_force(&mut self, body: usize, force: Vec3, torque: Vec3, point: Vec3) -> Result<(), EngineError> {
        let count = self.xfrc_applied.len().min(self.xipos.len());
        if body >= count {
            return Err(EngineError::NoBody { body, count });
        }
        for (what, values) in [("force", force), ("torque", torque), ("point", point)] {
            if let Some(index) = values.iter().position(|v| !v.is_finite()) {
                let value = values[index];
                return Err(EngineError::Applied { what, index, value });
            }
        }
        let moment = add(torque, cross(sub(point, self.xipos[body]), force));
        for (sum, v) in self.xfrc_applied[body].iter_mut().zip(force.into_iter().chain(moment)) {
            *sum += v;
        }
        Ok(())
    }

    /// Takes off all forces on bodies: sets [`State::xfrc_applied`] to zero.
    pub fn release_forces(&mut self) {
        self.xfrc_applied.fill([0.0; 6]);
    }

    /// Returns the gears (nu) that the reference shows: its muscles act through the gears of the actuators, so with
    /// muscles these are the muscles' torques, N m, and otherwise `params.actuator_gear`.
    pub fn reference_gear(&self) -> &[f64] {
        if self.muscle_torque.is_empty() {
            &self.params.actuator_gear
        } else {
            &self.muscle_torque
        }
    }

    /// Returns the number of constraint rows.
    pub fn nefc(&self) -> usize {
        self.efc.nefc()
    }

    /// Returns the constraint rows of the last step, in MuJoCo's order.
    pub fn efc_rows(&self) -> impl Iterator<Item = EfcRow> + '_ {
        self.efc.rows()
    }
}
