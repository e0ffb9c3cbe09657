//! The numbers of a state and of a model as rows of one piece of memory, which arrays of NumPy are views of.

use babybench::model::Arrays;
use babybench::physics::State;

/// Numbers that lie side by side.
pub trait Flat {
    /// Numbers of each row; none for a vector.
    const WIDTH: Option<usize>;

    /// Returns them all.
    fn flat(&self) -> &[f64];

    /// Returns them all for writing.
    fn flat_mut(&mut self) -> &mut [f64];
}

impl Flat for f64 {
    const WIDTH: Option<usize> = None;

    fn flat(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }
}

impl<const N: usize> Flat for [f64; N] {
    const WIDTH: Option<usize> = None;

    fn flat(&self) -> &[f64] {
        self
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        self
    }
}

impl Flat for Vec<f64> {
    const WIDTH: Option<usize> = None;

    fn flat(&self) -> &[f64] {
        self
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        self
    }
}

impl<const N: usize> Flat for Vec<[f64; N]> {
    const WIDTH: Option<usize> = Some(N);

    fn flat(&self) -> &[f64] {
        self.as_flattened()
    }

    fn flat_mut(&mut self) -> &mut [f64] {
        self.as_flattened_mut()
    }
}

/// The description of a field: name, group, numbers of each row, and the numbers.
pub struct Field<T> {
    pub name: &'static str,
    pub group: u32,
    pub width: Option<usize>,
    pub values: T,
}

/// Defines functions that visit the fields in order.
macro_rules! fields {
    ($visit:ident, $visit_mut:ident, $of:ty; $($group:expr => $($name:ident = $($path:ident).+),+;)*) => {
        /// Visits the fields.
        pub fn $visit<'a>(of: &'a $of, mut work: impl FnMut(Field<&'a [f64]>)) {
            $($({
                let field = &of.$($path).+;
                work(Field { name: stringify!($name), group: $group, width: width(field), values: field.flat() });
            })+)*
        }

        /// Visits the fields for writing.
        pub fn $visit_mut(of: &mut $of, mut work: impl FnMut(Field<&mut [f64]>)) {
            $($({
                let field = &mut of.$($path).+;
                let width = width(field);
                work(Field { name: stringify!($name), group: $group, width, values: field.flat_mut() });
            })+)*
        }
    };
}

fn width<T: Flat>(_: &T) -> Option<usize> {
    T::WIDTH
}

/// Fields that a program writes and a step reads; they come first in a state.
pub const INPUT: u32 = 1;
/// Poses of bodies, joints, geoms and sites.
const KINEMATICS: u32 = 1 << 1;
/// Fields about the centres of mass.
const COM: u32 = 1 << 2;
/// Poses of cameras.
const CAMERAS: u32 = 1 << 3;
/// Lengths of tendons.
const TENDON: u32 = 1 << 4;
/// Lengths of actuators.
const TRANSMISSION: u32 = 1 << 5;
/// Velocities of bodies.
const COM_VELOCITY: u32 = 1 << 6;
/// Rates of lengths, and other quantities that follow from velocities.
const VELOCITY: u32 = 1 << 7;
/// Forces of actuators.
const ACTUATION: u32 = 1 << 8;
/// Accelerations.
const ACCELERATION: u32 = 1 << 9;
/// Fields that follow from accelerations and the forces of constraints.
pub const POST: u32 = 1 << 10;
/// Values of sensors.
const SENSORS: u32 = 1 << 11;
/// Contacts and constraint rows, which are not fields.
pub const CONSTRAINTS: u32 = 1 << 12;
/// Fields that all steps compute.
pub const COMPUTED: u32 = (CONSTRAINTS << 1) - 1 - INPUT - POST;

/// The groups by name.
pub const GROUPS: &[(&str, u32)] = &[
    ("input", INPUT),
    ("kinematics", KINEMATICS),
    ("com", COM),
    ("cameras", CAMERAS),
    ("tendon", TENDON),
    ("transmission", TRANSMISSION),
    ("com_velocity", COM_VELOCITY),
    ("velocity", VELOCITY),
    ("actuation", ACTUATION),
    ("acceleration", ACCELERATION),
    ("post", POST),
    ("sensors", SENSORS),
    ("constraints", CONSTRAINTS),
];

fields! { state_fields, state_fields_mut, State;
    INPUT => time = time, qpos = qpos, qvel = qvel, act = act, ctrl = ctrl, qfrc_applied = qfrc_applied,
        xfrc_applied = xfrc_applied, mocap_pos = mocap_pos, mocap_quat = mocap_quat, qacc_warmstart = qacc_warmstart;
    KINEMATICS => xpos = xpos, xquat = xquat, xmat = xmat, xipos = xipos, ximat = ximat, xanchor = xanchor, xaxis = xaxis,
        geom_xpos = geom_xpos, geom_xmat = geom_xmat, site_xpos = site_xpos, site_xmat = site_xmat;
    COM => subtree_com = subtree_com, cdof = cdof, cinert = cinert;
    CAMERAS => cam_xpos = cam_xpos, cam_xmat = cam_xmat;
    TENDON => ten_length = ten_length;
    TRANSMISSION => actuator_length = actuator_length;
    COM_VELOCITY => cvel = cvel, cdof_dot = cdof_dot;
    VELOCITY => qfrc_bias = qfrc_bias, qfrc_passive = qfrc_passive, ten_velocity = ten_velocity,
        actuator_velocity = actuator_velocity;
    ACTUATION => act_dot = act_dot, actuator_force = actuator_force, qfrc_actuator = qfrc_actuator;
    ACCELERATION => qfrc_smooth = qfrc_smooth, qacc_smooth = qacc_smooth, qfrc_constraint = qfrc_constraint, qacc = qacc;
    POST => cacc = cacc, cfrc_ext = cfrc_ext, cfrc_int = cfrc_int;
    SENSORS => sensordata = sensordata;
}

// what a program may change between two steps: everything that each step reads and nothing is derived from beforehand
fields! { model_fields, model_fields_mut, Arrays;
    0 => opt_timestep = opt.timestep, opt_gravity = opt.gravity, opt_tolerance = opt.tolerance,
        opt_ls_tolerance = opt.ls_tolerance, opt_impratio = opt.impratio, opt_ccd_tolerance = opt.ccd_tolerance,
        opt_density = opt.density, opt_viscosity = opt.viscosity, opt_wind = opt.wind, opt_magnetic = opt.magnetic,
        body_pos = body_pos, body_quat = body_quat, body_mass = body_mass, body_inertia = body_inertia, body_invweight0 = body_invweight0,
        jnt_range = jnt_range, jnt_margin = jnt_margin, jnt_stiffness = jnt_stiffness, jnt_solref = jnt_solref,
        jnt_solimp = jnt_solimp, jnt_pos = jnt_pos, jnt_axis = jnt_axis, jnt_actfrcrange = jnt_actfrcrange,
        dof_armature = dof_armature, dof_damping = dof_damping, dof_frictionloss = dof_frictionloss,
        dof_invweight0 = dof_invweight0, dof_solref = dof_solref, dof_solimp = dof_solimp,
        qpos0 = qpos0, qpos_spring = qpos_spring,
        geom_size = geom_size, geom_rbound = geom_rbound, geom_pos = geom_pos, geom_quat = geom_quat,
        geom_friction = geom_friction, geom_solmix = geom_solmix, geom_solref = geom_solref, geom_solimp = geom_solimp,
        geom_margin = geom_margin, geom_gap = geom_gap,
        site_pos = site_pos, site_size = site_size, site_quat = site_quat, cam_pos = cam_pos, cam_quat = cam_quat,
        pair_solref = pair_solref, pair_solreffriction = pair_solreffriction, pair_solimp = pair_solimp,
        pair_friction = pair_friction, pair_margin = pair_margin, pair_gap = pair_gap,
        eq_solref = eq_solref, eq_solimp = eq_solimp,
        tendon_range = tendon_range, tendon_margin = tendon_margin, tendon_solref_lim = tendon_solref_lim,
        tendon_solimp_lim = tendon_solimp_lim, tendon_lengthspring = tendon_lengthspring,
        tendon_stiffness = tendon_stiffness, tendon_damping = tendon_damping, tendon_invweight0 = tendon_invweight0,
        tendon_frictionloss = tendon_frictionloss, tendon_solref_fri = tendon_solref_fri, tendon_solimp_fri = tendon_solimp_fri,
        tendon_length0 = tendon_length0,
        actuator_ctrlrange = actuator_ctrlrange, actuator_forcerange = actuator_forcerange,
        actuator_actrange = actuator_actrange, actuator_gear = actuator_gear6, actuator_dynprm = actuator_dynprm,
        actuator_gainprm = actuator_gainprm, actuator_biasprm = actuator_biasprm,
        actuator_acc0 = actuator_acc0, actuator_length0 = actuator_length0, actuator_lengthrange = actuator_lengthrange;
}

/// Returns the name, the group and the shape of each field of a state, in the order of the memory.
pub fn state_layout(state: &State) -> Vec<(&'static str, u32, Vec<usize>)> {
    let mut layout = Vec::new();
    state_fields(state, |field| {
        layout.push((field.name, field.group, shape(field.width, field.values.len())));
    });
    layout
}

/// Returns the name and the shape of each field of a model, in the order of the memory.
pub fn model_layout(arrays: &Arrays) -> Vec<(&'static str, Vec<usize>)> {
    let mut layout = Vec::new();
    model_fields(arrays, |field| {
        layout.push((field.name, shape(field.width, field.values.len())));
    });
    layout
}

fn shape(width: Option<usize>, len: usize) -> Vec<usize> {
    match width {
        Some(width) => vec![len / width.max(1), width],
        None => vec![len],
    }
}

/// Reads the first fields of a state from memory.
pub fn read_inputs(memory: &[f64], state: &mut State) {
    let mut rest = memory;
    state_fields_mut(state, |field| {
        if field.group == INPUT
            && let Some((own, after)) = rest.split_at_checked(field.values.len())
        {
            field.values.copy_from_slice(own);
            rest = after;
        }
    });
}

/// Writes the fields of some groups of a state into memory.
pub fn write_state(state: &State, groups: u32, memory: &mut [f64]) {
    let mut at = 0;
    state_fields(state, |field| {
        let end = at + field.values.len();
        if groups & field.group != 0
            && let Some(own) = memory.get_mut(at..end)
        {
            own.copy_from_slice(field.values);
        }
        at = end;
    });
}

/// Returns a field of a state in memory.
pub fn part<'a>(state: &State, memory: &'a [f64], name: &str) -> &'a [f64] {
    let (mut at, mut found) = (0, 0..0);
    state_fields(state, |field| {
        let end = at + field.values.len();
        if field.name == name {
            found = at..end;
        }
        at = end;
    });
    memory.get(found).unwrap_or_default()
}

/// Returns the numbers of a model that a program may change.
pub fn write_model(arrays: &Arrays) -> Vec<f64> {
    let mut memory = Vec::new();
    model_fields(arrays, |field| memory.extend_from_slice(field.values));
    memory
}

/// Reads the numbers of a model from memory.
///
/// # Errors
/// The field, the position in it, and the number that is not finite.
pub fn read_model(memory: &[f64], arrays: &mut Arrays) -> Result<(), (&'static str, usize, f64)> {
    let (mut rest, mut fault) = (memory, None);
    model_fields_mut(arrays, |field| {
        let Some((values, after)) = rest.split_at_checked(field.values.len()) else {
            return;
        };
        if let Some((i, v)) = values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
            fault.get_or_insert((field.name, i, *v));
        }
        field.values.copy_from_slice(values);
        rest = after;
    });
    fault.map_or(Ok(()), Err)
}
