//! Everything about a scene that changes while it runs.

use crate::constraint::{Efc, EfcRow};
use crate::detected::{Contact, FlexContact};
use crate::error::EngineError;
use crate::math::{MAT3_ID, Mat3, QUAT_ID, Quat, Vec3, add, cross, sub};
use crate::model::Arrays;
use crate::params::Params;
use crate::shared::Shared;
use crate::table::table;
use crate::tiles::Tile;
use crate::topology::Topology;

/// Contacts for which memory is reserved, so that steps need not allocate. The cubes scene reaches about 100.
pub const RESERVED_CONTACTS: usize = 192;

table! {
    |model: &Arrays, topology: &Topology|
    /// Everything that changes while a scene runs, and every quantity computed from it: MuJoCo's `mjData`. Fields for the muscles of MIMo,
    /// the infant of BabyBench, are empty in other models.
    ///
    /// The fields up to `params` determine the rest of a run, with any engine and any actuation model: a copy of them
    /// ([`State::copy_dynamic_from`]) continues with the same bits. A step advances `qpos` and `qvel`; all computed
    /// quantities describe the *start* of the last step, before integration, as in MuJoCo. The integrator `RK4` evaluates them four
    /// times in a step: they are those of its last evaluation, except for `sensordata`, which describes the start there, too.
    ///
    /// A state belongs to the model that its engine was made for: it keeps the poses of what never moves from its first step on, so that an
    /// engine of another model, even of the same sizes, would go on with the wrong ones.
    ///
    /// Constraint rows are read with [`State::efc_rows`], their Jacobian and the inertia matrix with
    /// [`Engine::efc_j`](crate::Engine::efc_j) and [`Engine::full_m`](crate::Engine::full_m).
    #[doc(alias = "mjData")]
    #[derive(Debug)]
    pub struct State, "";
    dynamic {
        /// Simulated time, s.
        pub time: (f64) = 0.0;
        /// Steps done since construction or reset. Not in MuJoCo's `mjData`.
        pub step: (u64) = 0;
        /// Positions (nq): m for slides and positions of free joints, world frame; rad for hinges; unit quaternions `w, x, y, z` for
        /// balls and free joints.
        pub qpos: [f64; model.nq] finite => model.qpos0.clone();
        /// Velocities (nv): m/s for translations; rad/s for rotations, those of balls and free joints in the body frame.
        pub qvel: [f64; model.nv] finite = 0.0;
        /// Controls of the actuators (nu), in the unit of each actuator's control. With MIMo's muscles, 1 while they pull and 0 while they do not.
        pub ctrl: [f64; model.nu()] finite = 0.0;
        /// Activations of the actuators that have one (na), in their order and units. With MIMo's muscles, their activations (2 nu), 0..1: muscle 1
        /// of every actuator, then muscle 2.
        pub act: [f64; any] finite => vec![0.0; model.na];
        /// Last targets of MIMo's actuators: excitations of muscles (2 nu), 0..1, or desired angles of position servos (nu), rad. Empty
        /// for motors. Not in MuJoCo's `mjData`.
        pub actuator_target: [f64; any];
        /// Forces of MIMo's muscles (2 nu) at the last activation, as shares of their isometric maxima, no unit. Empty without muscles.
        /// Not in MuJoCo's `mjData`.
        pub muscle_force: [f64; any];
        /// Torques of MIMo's muscles on the joints of the actuators (nu), N m, about the joint axes. They act at control 1 instead of
        /// the actuators' own. Empty without muscles. Not in MuJoCo's `mjData`.
        pub muscle_torque: [f64; maybe model.nu()] finite;
        /// Generalised forces applied from outside (nv): N for translations, N m for rotations, along the coordinates of `qvel`.
        pub qfrc_applied: [f64; model.nv] finite = 0.0;
        /// Force, N, and torque, N m, applied from outside to each body (nbody, 6) at its centre of mass `xipos`, world frame. They act
        /// in every step until a program changes them; [`State::apply_force`] adds to them.
        pub xfrc_applied: [[f64; 6]; model.nbody()] finite = [0.0; 6];
        /// Positions of the mocap bodies (nmocap, 3), world frame, m; `body_mocapid` tells which they are. They have no velocity: objects that a
        /// program throws or holds with one are attached to it by an equality.
        pub mocap_pos: [Vec3; model.nmocap] finite => mocap(model).map(|b| model.body_pos[b]).collect();
        /// Orientations of the mocap bodies (nmocap, 4), world frame, quaternions `w, x, y, z` of any length.
        pub mocap_quat: [Quat; model.nmocap] finite => mocap(model).map(|b| model.body_quat[b]).collect();
        /// Accelerations from which the solver starts (nv), those of the last step: m/s^2 or rad/s^2.
        pub qacc_warmstart: [f64; model.nv] = 0.0;
        /// Parameters that may change while the scene runs. States share them until one writes to its own.
        pub params: (Shared<Params>) = Params::new(model).into();
    }
    computed {
        // position stage
        /// Whether bodies, geoms and sites that never move have their poses.
        pub fixed_placed: (bool) = false;
        /// Position of each body's frame (nbody, 3), world frame, m.
        pub xpos: [Vec3; model.nbody()] = [0.0; 3];
        /// Orientation of each body's frame (nbody, 4), world frame, unit quaternion `w, x, y, z`.
        pub xquat: [Quat; model.nbody()] = QUAT_ID;
        /// Orientation of each body's frame (nbody, 9), world frame, rotation matrix row by row.
        pub xmat: [Mat3; model.nbody()] = MAT3_ID;
        /// Centre of mass of each body (nbody, 3), world frame, m.
        pub xipos: [Vec3; model.nbody()] = [0.0; 3];
        /// Orientation of each body's principal axes of inertia (nbody, 9), world frame, rotation matrix row by row.
        pub ximat: [Mat3; model.nbody()] = MAT3_ID;
        /// Anchor of each joint (njnt, 3), world frame, m.
        pub xanchor: [Vec3; model.njnt()] = [0.0; 3];
        /// Axis of each joint (njnt, 3), world frame, unit vector.
        pub xaxis: [Vec3; model.njnt()] = [0.0; 3];
        /// Centre of each geom (ngeom, 3), world frame, m.
        pub geom_xpos: [Vec3; model.ngeom()] = [0.0; 3];
        /// Orientation of each geom (ngeom, 9), world frame, rotation matrix row by row.
        pub geom_xmat: [Mat3; model.ngeom()] = MAT3_ID;
        /// Position of each site (nsite, 3), world frame, m.
        pub site_xpos: [Vec3; model.nsite()] = [0.0; 3];
        /// Orientation of each site (nsite, 9), world frame, rotation matrix row by row.
        pub site_xmat: [Mat3; model.nsite()] = MAT3_ID;
        /// Position of each camera (ncam, 3), world frame, m.
        pub cam_xpos: [Vec3; model.ncam()] = [0.0; 3];
        /// Orientation of each camera (ncam, 9), world frame, rotation matrix row by row. A camera looks along its -z axis.
        pub cam_xmat: [Mat3; model.ncam()] = MAT3_ID;
        /// Centre of mass of each body with all bodies below it (nbody, 3), world frame, m.
        pub subtree_com: [Vec3; model.nbody()] = [0.0; 3];
        /// Motion axis of each degree of freedom (nv, 6) about the centre of mass of its tree, world axes: rotation (3), no unit,
        /// translation (3), m or no unit.
        pub cdof: [[f64; 6]; model.nv] = [0.0; 6];
        /// Inertia of each body (nbody, 10) about the centre of mass of its tree, world axes: `Ixx, Iyy, Izz, Ixy, Ixz, Iyz`, kg m^2;
        /// mass times the offset of the body's centre of mass (3), kg m; mass, kg. Zeros for the world.
        pub cinert: [[f64; 10]; model.nbody()] = [0.0; 10];
        /// Positions of the vertices of flexes (nflexvert, 3), world frame, m.
        pub flexvert_xpos: [Vec3; model.nflexvert()] = [0.0; 3];
        /// Lengths of the edges of flexes (nflexedge), m; 0 in rigid flexes.
        pub flexedge_length: [f64; model.nflexedge()] = 0.0;
        /// Derivatives of these lengths by the degrees of freedom that change them, one edge after another, no unit: MuJoCo's `flexedge_J`,
        /// sparse entries only. Flexes whose edges neither pull nor have damping have none.
        pub flexedge_j: [f64; topology.flexedges.len()] = 0.0;
        /// Rates of these lengths (nflexedge), m/s; 0 in flexes without derivatives.
        pub flexedge_velocity: [f64; model.nflexedge()] = 0.0;
        /// Length of each tendon (ntendon): m for spatial tendons; for fixed ones coordinates of joints, rad or m, times coefficients.
        pub ten_length: [f64; model.ntendon()] = 0.0;
        /// Rate of each tendon's length (ntendon), its unit per second.
        pub ten_velocity: [f64; model.ntendon()] = 0.0;
        /// Derivatives of the lengths of the tendons by the degrees of freedom that change them, one tendon after another: MuJoCo's
        /// `ten_J`, sparse entries only.
        pub ten_j: [f64; topology.tendons.len()] = 0.0;
        /// Whether the length of each tendon has a derivative (ntendon), even a zero one. It has one if successive points are on different
        /// bodies and one of these can move.
        pub ten_entries: [bool; model.ntendon()] = true;
        /// First point of each tendon in `wrap_xpos` (ntendon).
        pub ten_wrapadr: [usize; model.ntendon()] = 0;
        /// Number of points of each tendon in `wrap_xpos` (ntendon); 0 for fixed tendons.
        pub ten_wrapnum: [usize; model.ntendon()] = 0;
        /// Points on the paths of spatial tendons (2 nwrap, 3), world frame, m: sites, and where a tendon meets and leaves a geom.
        /// Zeros for a pulley, where the path is interrupted.
        pub wrap_xpos: [Vec3; 2 * model.nwrap()] = [0.0; 3];
        /// Object at each of these points (2 nwrap): the id of a geom, -1 for a site, -2 for a pulley.
        pub wrap_obj: [i32; 2 * model.nwrap()] = 0;
        /// Derivatives of the lengths of actuators on sites, slider-cranks and contacts by the degrees of freedom, one actuator after
        /// another.
        pub actuator_moment: [f64; topology.actuators.len()] = 0.0;
        /// Joint-space inertia in tiles ([`Topology::tiles`]), both triangles of those on the diagonal; MuJoCo's `qM` as a whole is
        /// [`Engine::full_m`](crate::Engine::full_m).
        pub qm: [Tile; topology.tiles.tiles()] => topology.new_tiles();
        /// Contacts (ncon) in MuJoCo's order; [`Contact`] tells units and frames.
        pub contact: (Vec<Contact>) = Vec::with_capacity(RESERVED_CONTACTS);
        /// Contacts of flexes, in MuJoCo's order; [`FlexContact`] describes how they are mixed with contacts of geoms there.
        pub flex_contact: (Vec<FlexContact>) = Vec::new();
        /// Constraint rows.
        pub efc: (Efc) = Efc::with_capacity(model.nv, RESERVED_CONTACTS);

        // velocity stage
        /// Velocity of each body (nbody, 6) about the centre of mass of its tree, world axes: rotation (3), rad/s, translation (3),
        /// m/s.
        pub cvel: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// Time derivative of each motion axis `cdof` (nv, 6), world axes: rotation (3), 1/s, translation (3), m/s or 1/s.
        pub cdof_dot: [[f64; 6]; model.nv] = [0.0; 6];
        /// Length of each actuator (nu): the coordinate of its joint or the length of its tendon, rad or m, times the gear; for a site, its
        /// displacement from the reference site along the gears; for a slider-crank, that of the slider, m.
        pub actuator_length: [f64; model.nu()] = 0.0;
        /// Rate of each actuator's length (nu), its unit per second; 0 where actuators are switched off.
        pub actuator_velocity: [f64; model.nu()] = 0.0;
        /// Coriolis, centrifugal and gravity forces (nv): N or N m. They are on the left side of the equation of motion.
        pub qfrc_bias: [f64; model.nv] = 0.0;
        /// Forces of springs, dampers, the medium and passive gravity compensation (nv): N or N m.
        pub qfrc_passive: [f64; model.nv] = 0.0;
        /// Forces that compensate gravity (nv): N or N m. They are part of `qfrc_passive`, or of `qfrc_actuator` on joints with
        /// `jnt_actgravcomp`.
        pub qfrc_gravcomp: [f64; model.nv] = 0.0;

        // acceleration stage
        /// Time derivatives of the activations (na), their unit per second. MIMo's muscles have none.
        pub act_dot: [f64; model.na] = 0.0;
        /// Force of each actuator before the gear (nu): N or N m. With MIMo's muscles, their torque on the joint, N m.
        pub actuator_force: [f64; model.nu()] = 0.0;
        /// Forces of the actuators on the degrees of freedom (nv): N or N m.
        pub qfrc_actuator: [f64; model.nv] = 0.0;
        /// All forces except those of constraints (nv): N or N m.
        pub qfrc_smooth: [f64; model.nv] = 0.0;
        /// Accelerations without constraints (nv): m/s^2 or rad/s^2.
        pub qacc_smooth: [f64; model.nv] = 0.0;
        /// Forces of the constraints (nv): N or N m.
        pub qfrc_constraint: [f64; model.nv] = 0.0;
        /// Accelerations (nv), m/s^2 or rad/s^2, without the implicit damping of the integrator.
        pub qacc: [f64; model.nv] = 0.0;
        /// Iterations of the solver in the last step, summed over islands: the sum of MuJoCo's `solver_niter`.
        pub solver_iterations: (usize) = 0;

        // after constraints
        /// Acceleration of each body (nbody, 6) about the centre of mass of its tree, world axes: rotation (3), rad/s^2, translation
        /// (3), m/s^2. Gravity is included as an upward acceleration of the world.
        pub cacc: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// External wrench on each body (nbody, 6) about the centre of mass of its tree, world axes: torque (3), N m, force (3), N, of
        /// contacts, connects, welds and `xfrc_applied`. The default engine computes it, with `cacc` and `cfrc_int`, where a sensor of
        /// the model reads one of them, as in environments, or where
        /// [`SoftOptions::post_constraint`](crate::SoftOptions::post_constraint) requests it; otherwise it keeps its values.
        pub cfrc_ext: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// Wrench that the parent exerts on each body (nbody, 6) about the centre of mass of its tree, world axes: torque (3), N m,
        /// force (3), N.
        pub cfrc_int: [[f64; 6]; model.nbody()] = [0.0; 6];
        /// Values of the model's sensors (nsensordata), from `sensor_adr` of each on; [`SensorType`](crate::model::SensorType) tells
        /// quantities, units and frames. Those of MIMo give three each, in the frame of their site: linear acceleration minus gravity,
        /// m/s^2; angular velocity, rad/s; torque that the parent exerts on the site's body about the site, N m.
        pub sensordata: [f64; model.nsensordata()] = 0.0;
    }
}

/// Iterates over the bodies that a program moves, in their order.
fn mocap(model: &Arrays) -> impl Iterator<Item = usize> {
    (1..model.nbody()).filter(|&b| model.body_mocapid[b].is_some())
}

impl State {
    /// Returns the reference configuration at rest. Nothing is computed yet: all frames are at the origin.
    pub fn new(model: &Arrays, topology: &Topology) -> Self {
        Self::first(model, topology)
    }

    /// Copies everything on which a continuation depends: time, positions, velocities, controls, activations, applied forces, warm
    /// start and parameters. The next step recomputes everything else. Between states of one model and one actuation model nothing is
    /// allocated.
    #[doc(alias("mj_copyData", "mj_setState"))]
    pub fn copy_dynamic_from(&mut self, other: &State) {
        self.copy_dynamic(other);
    }

    /// Adds a force (N) at a point (m) and a torque (N m) to the forces on a body, all in the world frame: MuJoCo's
    /// `mj_applyFT` into [`State::xfrc_applied`]. The point refers to the body's current pose, which belongs to the start of the last step. The force
    /// acts in every step until [`State::release_forces`] or the next reset.
    ///
    /// ```
    /// use mjcf_sim::Simulation;
    ///
    /// let mut ball = Simulation::from_text("<mujoco><option gravity='0 0 0'/><worldbody>
    ///   <body name='ball'><freejoint/><geom size='.1' mass='2'/></body></worldbody></mujoco>")?;
    /// ball.forward()?; // where the ball is
    /// let body = ball.model().body("ball").ok_or("no ball")?;
    /// let centre = ball.state.xipos[body];
    /// ball.state.apply_force(body, [0.0, 0.0, 5.0], [0.0; 3], centre)?;
    /// ball.run(100)?; // 0.2 s at 5 N / 2 kg
    /// assert!((ball.state.qvel[2] - 0.5).abs() < 1e-12);
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

    /// Returns the bodies that a program moves to their positions in the document.
    pub fn rest_mocap(&mut self, model: &Arrays) {
        for (k, body) in mocap(model).enumerate() {
            self.mocap_pos[k] = model.body_pos[body];
            self.mocap_quat[k] = model.body_quat[body];
        }
    }

    /// Removes all forces on bodies: sets [`State::xfrc_applied`] to zero.
    pub fn release_forces(&mut self) {
        self.xfrc_applied.fill([0.0; 6]);
    }

    /// Returns the gears (nu) as in the reference. Its muscles act through the gears of the actuators, so with muscles these are the muscles'
    /// torques, N m; otherwise they are `params.actuator_gear`.
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
