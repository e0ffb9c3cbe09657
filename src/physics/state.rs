//! Everything about a scene that changes while it runs.

use crate::math::{MAT3_ID, Mat3, QUAT_ID, Quat, Vec3, add, cross, sub};
use crate::model::Arrays;
use crate::physics::constraint::{Efc, EfcRow};
use crate::physics::engine::EngineError;
use crate::physics::params::Params;
use crate::physics::shared::Shared;
use crate::physics::table::table;
use crate::physics::tiles::Tile;
use crate::physics::topology::Topology;

/// Contacts for which memory is reserved, so that steps need not allocate. The cubes scene reaches about 100.
pub(crate) const RESERVED_CONTACTS: usize = 192;

/// A detected contact between two geoms.
#[doc(alias = "mjContact")]
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
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub solref: [f64; 2],
    /// `solref` of friction; zeros mean that of the normal.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub solreffriction: [f64; 2],
    /// `solimp`.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub solimp: [f64; 5],
    /// Distance at which the contact becomes a constraint: margin minus gap, m.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub includemargin: f64,
    /// First constraint row, when it is a constraint.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub efc_address: Option<usize>,
    /// Force that the first geom exerts on the second, and torque, in the contact frame, N and N m. Filled by the
    /// solver.
    pub force: [f64; 6],
}

table! {
    |model: &Arrays, topology: &Topology|
    /// Everything that changes while a scene runs, and every quantity computed from it: MuJoCo's `mjData`.
    ///
    /// The fields up to `params` decide how a run goes on, with any engine and any actuation model: a copy of them
    /// ([`State::copy_dynamic_from`]) continues with the same bits. A step advances `qpos` and `qvel`; all computed
    /// quantities describe the *start* of the last step, before integration, as in MuJoCo. The integrator `RK4` evaluates them four
    /// times in a step: they are those of its last evaluation, but for `sensordata`, which describes the start there, too.
    ///
    /// A state belongs to the model that its engine was made for: it keeps the poses of what never moves from its first step on, so that an
    /// engine of another model, even of the same sizes, would go on with the wrong ones.
    ///
    /// Constraint rows are read with [`State::efc_rows`], their Jacobian and the inertia matrix with
    /// [`Engine::efc_j`](crate::physics::Engine::efc_j) and [`Engine::full_m`](crate::physics::Engine::full_m).
    #[derive(Debug)]
    pub struct State, "";
    dynamic {
        /// Simulated time, s.
        pub time: (f64) = 0.0;
        /// Steps done since construction or reset.
        pub step: (u64) = 0;
        /// Positions (nq): m, rad, quaternions.
        pub qpos: [f64; model.nq] finite => model.qpos0.clone();
        /// Velocities (nv): m/s, rad/s.
        pub qvel: [f64; model.nv] finite = 0.0;
        /// Controls of the actuators (nu). With muscles 1 while they pull and 0 while they do not.
        pub ctrl: [f64; model.nu()] finite = 0.0;
        /// Activations of the actuators that have one (na), in their order. With MIMo's muscles theirs (2 nu), 0..1: muscle 1 of
        /// every actuator, then muscle 2.
        pub act: [f64; any] finite => vec![0.0; model.na];
        /// Last targets of the actuators: excitations of muscles (2 nu), 0..1, or desired angles of position
        /// servos (nu), rad. Empty for motors.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub actuator_target: [f64; any];
        /// Forces of the muscles (2 nu) at the last activation, relative to their isometric maxima. Empty without muscles.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub muscle_force: [f64; any];
        /// Torques of the muscles on the joints of the actuators (nu), N m, which act at control 1 in place of the
        /// actuators' own. Empty without muscles.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub muscle_torque: [f64; maybe model.nu()] finite;
        /// Generalised force applied from outside (nv), N and N m.
        pub qfrc_applied: [f64; model.nv] finite = 0.0;
        /// Force and torque applied from outside to each body (nbody) at its centre of mass `xipos`, world: force, N, torque,
        /// N m. They act in every step until they are changed; [`State::apply_force`] adds to them.
        pub xfrc_applied: [[f64; 6]; model.nbody()] finite = [0.0; 6];
        /// Positions of the bodies that a program moves (nmocap), world, m; `body_mocapid` tells which they are. They have no velocity:
        /// what is to be thrown or held by one hangs on it by an equality.
        pub mocap_pos: [Vec3; model.nmocap] finite => mocap(model).map(|b| model.body_pos[b]).collect();
        /// Orientations of the bodies that a program moves (nmocap); they need not have unit length.
        pub mocap_quat: [Quat; model.nmocap] finite => mocap(model).map(|b| model.body_quat[b]).collect();
        /// Start of the solver (nv): the last acceleration.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub qacc_warmstart: [f64; model.nv] = 0.0;
        /// Parameters that may change. States share them until one writes to its own.
        pub params: (Shared<Params>) = Params::new(model).into();
    }
    computed {
        // position stage
        /// Whether bodies, geoms and sites that never move have their poses.
        pub(crate) fixed_placed: (bool) = false;
        /// Body positions (nbody), world, m.
        pub xpos: [Vec3; model.nbody()] = [0.0; 3];
        /// Body orientations (nbody).
        pub xquat: [Quat; model.nbody()] = QUAT_ID;
        /// Body orientations (nbody) as matrices.
        pub xmat: [Mat3; model.nbody()] = MAT3_ID;
        /// Centres of mass (nbody), world, m.
        pub xipos: [Vec3; model.nbody()] = [0.0; 3];
        /// Orientations of the principal axes (nbody).
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub ximat: [Mat3; model.nbody()] = MAT3_ID;
        /// Joint anchors (njnt), world, m.
        pub xanchor: [Vec3; model.njnt()] = [0.0; 3];
        /// Joint axes (njnt), world.
        pub xaxis: [Vec3; model.njnt()] = [0.0; 3];
        /// Geom positions (ngeom), world, m.
        pub geom_xpos: [Vec3; model.ngeom()] = [0.0; 3];
        /// Geom orientations (ngeom).
        pub geom_xmat: [Mat3; model.ngeom()] = MAT3_ID;
        /// Site positions (nsite), world, m.
        pub site_xpos: [Vec3; model.nsite()] = [0.0; 3];
        /// Site orientations (nsite).
        pub site_xmat: [Mat3; model.nsite()] = MAT3_ID;
        /// Camera positions (ncam), world, m.
        pub cam_xpos: [Vec3; model.ncam()] = [0.0; 3];
        /// Camera orientations (ncam); a camera looks along its -z.
        pub cam_xmat: [Mat3; model.ncam()] = MAT3_ID;
        /// Centre of mass of each subtree (nbody), world, m.
        pub subtree_com: [Vec3; model.nbody()] = [0.0; 3];
        /// Motion axes (nv) about the centre of mass of their tree: rotation, translation.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub cdof: [[f64; 6]; model.nv] = [0.0; 6];
        /// Body inertias (nbody) about the centre of mass of their tree, along the axes of the world: `Ixx, Iyy, Izz, Ixy, Ixz, Iyz`,
        /// kg m^2, mass times the offset of the body's centre of mass (3), kg m, mass, kg. Those of the world are zero.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub cinert: [[f64; 10]; model.nbody()] = [0.0; 10];
        /// Lengths of the tendons (ntendon): coordinates of their joints, rad or m, times their coefficients; m for spatial ones.
        pub ten_length: [f64; model.ntendon()] = 0.0;
        /// Rates of the lengths of the tendons (ntendon).
        pub ten_velocity: [f64; model.ntendon()] = 0.0;
        /// Derivatives of the lengths of the tendons by the degrees of freedom that change them, one tendon after another.
        pub(crate) ten_j: [f64; topology.tendons.len()] = 0.0;
        /// Whether the length of each tendon has a derivative (ntendon), be it zero: whether points that follow each other are on
        /// different bodies of which one can move.
        pub(crate) ten_entries: [bool; model.ntendon()] = true;
        /// First point of each tendon in `wrap_xpos` (ntendon).
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub ten_wrapadr: [usize; model.ntendon()] = 0;
        /// Number of points of each tendon (ntendon); none for fixed ones.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub ten_wrapnum: [usize; model.ntendon()] = 0;
        /// Points that spatial tendons run through (twice the number of what they run along), world, m: sites, and where a tendon comes
        /// onto a geom and leaves it. Zeros for a pulley, where the tendon is interrupted.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub wrap_xpos: [Vec3; 2 * model.nwrap()] = [0.0; 3];
        /// The object that each of these points is on: a geom, or -1 for a site, -2 for a pulley.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub wrap_obj: [i32; 2 * model.nwrap()] = 0;
        /// Derivatives of the lengths of actuators on sites, slider-cranks and contacts by the degrees of freedom, one after another.
        pub(crate) actuator_moment: [f64; topology.actuators.len()] = 0.0;
        /// Joint-space inertia in tiles ([`Topology::tiles`]), both triangles of those on the diagonal.
        pub(crate) qm: [Tile; topology.tiles.tiles()] => topology.new_tiles();
        /// Contacts in MuJoCo's order.
        pub contact: (Vec<Contact>) = Vec::with_capacity(RESERVED_CONTACTS);
        /// Constraint rows.
        pub(crate) efc: (Efc) = Efc::with_capacity(model.nv, RESERVED_CONTACTS);

        // velocity stage
        /// Body velocities (nbody) about the centre of mass of their tree: rotation, rad/s, translation, m/s.
        pub cvel: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// Rates of the motion axes (nv): rotation, translation, 1/s.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub cdof_dot: [[f64; 6]; model.nv] = [0.0; 6];
        /// Lengths of the actuators (nu): the coordinate of the joint or the length of the tendon, rad or m, times the gear; of a site
        /// its displacement from the reference site along the gears; of a slider-crank that of the slider.
        pub actuator_length: [f64; model.nu()] = 0.0;
        /// Rates of the lengths of the actuators (nu); zero where actuators are switched off.
        pub actuator_velocity: [f64; model.nu()] = 0.0;
        /// Coriolis, centrifugal and gravity force (nv).
        pub qfrc_bias: [f64; model.nv] = 0.0;
        /// Spring and damper force (nv).
        pub qfrc_passive: [f64; model.nv] = 0.0;
        /// Forces that compensate gravity: a part of `qfrc_passive`, or of `qfrc_actuator` where `jnt_actgravcomp` says so.
        pub qfrc_gravcomp: [f64; model.nv] = 0.0;

        // acceleration stage
        /// Rates of the activations (na), 1/s. MIMo's muscles have none.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub act_dot: [f64; model.na] = 0.0;
        /// Actuator force before the gear (nu); with muscles their torque on the joint, N m.
        pub actuator_force: [f64; model.nu()] = 0.0;
        /// Actuator force on the joints (nv).
        pub qfrc_actuator: [f64; model.nv] = 0.0;
        /// All forces but those of constraints (nv).
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub qfrc_smooth: [f64; model.nv] = 0.0;
        /// Acceleration without constraints (nv).
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub qacc_smooth: [f64; model.nv] = 0.0;
        /// Constraint force (nv).
        pub qfrc_constraint: [f64; model.nv] = 0.0;
        /// Acceleration (nv), without the implicit damping of the integrator.
        pub qacc: [f64; model.nv] = 0.0;
        /// Iterations of the solver in the last step, summed over islands.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub solver_iterations: (usize) = 0;

        // after constraints
        /// Body accelerations (nbody), gravity as upward acceleration of the world: rotation, rad/s^2, translation, m/s^2.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub cacc: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// External wrench on each body (nbody), of contacts, welds and `xfrc_applied`: torque, N m, force, N. The default engine computes it, and
        /// `cacc` and `cfrc_int`, where a sensor of the model reads one of them, as in environments, or where
        /// [`SoftOptions::post_constraint`](crate::physics::SoftOptions::post_constraint) asks for it; else it is what it was.
        pub cfrc_ext: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// Wrench that the parent exerts on each body (nbody): torque, N m, force, N.
        #[cfg_attr(not(feature = "internals"), doc(hidden))]
        pub cfrc_int: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// Values of the model's sensors (nsensordata), from `sensor_adr` of each on; [`SensorType`](crate::model::SensorType)
        /// tells quantities, units and frames. Those of MIMo give three each, in the frame of their site: linear acceleration minus
        /// gravity, m/s^2; angular velocity, rad/s; torque that the parent exerts on the site's body about the site, N m.
        pub sensordata: [f64; model.nsensordata()] = 0.0;
    }
}

/// Iterates over the bodies that a program moves, in their order.
fn mocap(model: &Arrays) -> impl Iterator<Item = usize> {
    (1..model.nbody()).filter(|&b| model.body_mocapid[b].is_some())
}

impl State {
    /// Returns the reference configuration at rest, of which nothing is computed yet: all frames are at the origin.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub fn new(model: &Arrays, topology: &Topology) -> Self {
        Self::first(model, topology)
    }

    /// Copies what a continuation depends on: time, positions, velocities, controls, activations, applied forces, warm
    /// start and parameters. Everything else is computed anew by the next step. Between states of one model and one
    /// actuation model nothing is allocated.
    #[doc(alias("mj_copyData", "mj_setState"))]
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub fn copy_dynamic_from(&mut self, other: &State) {
        self.copy_dynamic(other);
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
    #[doc(alias("mj_applyFT", "xfrc_applied"))]
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

    /// Puts the bodies that a program moves back where the document has them.
    pub(crate) fn rest_mocap(&mut self, model: &Arrays) {
        for (k, body) in mocap(model).enumerate() {
            self.mocap_pos[k] = model.body_pos[body];
            self.mocap_quat[k] = model.body_quat[body];
        }
    }

    /// Takes off all forces on bodies: sets [`State::xfrc_applied`] to zero.
    pub fn release_forces(&mut self) {
        self.xfrc_applied.fill([0.0; 6]);
    }

    /// Returns the gears (nu) that the reference shows: its muscles act through the gears of the actuators, so with
    /// muscles these are the muscles' torques, N m, and otherwise `params.actuator_gear`.
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
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
    #[cfg_attr(not(feature = "internals"), doc(hidden))]
    pub fn efc_rows(&self) -> impl Iterator<Item = EfcRow> + '_ {
        self.efc.rows()
    }
}
