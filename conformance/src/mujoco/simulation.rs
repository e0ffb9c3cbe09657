//! A model and its data in MuJoCo 3.3.0, with all their arrays.

use std::ffi::{CStr, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use babybench::model::EqualityKind;
use babybench::physics::State;

use super::api::{Handle, Mujoco, NAMED};
use super::layout::{Field, Kind, Size, field, position};
use super::offsets::{CONTACT, CONTACT_SIZE, DATA, DATA_SIZES, MODEL, MODEL_SIZES, OPTION, PARTS, STATISTIC, WARNINGS};

/// Bits of `mjtDisableBit`.
const DISABLE_SENSOR: i32 = 1 << 12;
const DISABLE_CONTACT: i32 = 1 << 4;

/// A contact of MuJoCo's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The geoms.
    pub geom: [usize; 2],
    /// Distance, m.
    pub dist: f64,
    /// Position, m.
    pub pos: [f64; 3],
    /// Rows are the normal and two tangents.
    pub frame: [f64; 9],
    /// Dimension.
    pub dim: usize,
    /// Two sliding, one torsional, two rolling friction coefficients.
    pub friction: [f64; 5],
    /// Distance at which it becomes a constraint: margin minus gap, m.
    pub includemargin: f64,
    /// First constraint row, when it is a constraint.
    pub efc_address: Option<usize>,
    /// Force and torque in the contact frame, by `mj_contactForce`.
    pub force: [f64; 6],
}

/// A model and its data.
pub struct Simulation {
    api: &'static Mujoco,
    model: Handle,
    data: Handle,
}

// SAFETY: MuJoCo's model and data belong to no thread; they are changed only through `&mut`.
unsafe impl Send for Simulation {}

impl Drop for Simulation {
    fn drop(&mut self) {
        // SAFETY: both were made by the constructor and are used by nothing else.
        unsafe {
            (self.api.delete_data)(self.data);
            (self.api.delete_model)(self.model);
        }
    }
}

/// A number of rows or columns, found at compile time.
#[derive(Clone, Copy)]
enum Count {
    Fixed(usize),
    OfModel(usize),
    OfModelTimes(usize, usize),
    OfData(usize),
}

const fn count(size: Size) -> Count {
    match size {
        Size::Fixed(n) => Count::Fixed(n),
        Size::Times(name, factor) => Count::OfModelTimes(field(MODEL_SIZES, name).at, factor),
        Size::Named(name) => match (position(MODEL_SIZES, name), position(DATA_SIZES, name)) {
            (Some(k), _) => Count::OfModel(MODEL_SIZES[k].at),
            (None, Some(k)) => Count::OfData(DATA_SIZES[k].at),
            (None, None) => panic!("no such size"),
        },
    }
}

/// Getters of arrays of `mjData` that are numbers.
macro_rules! data {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {
        #[allow(non_snake_case)] // the names are MuJoCo's
        impl Simulation {$(
            $(#[$doc])*
            pub fn $name(&self) -> &[f64] {
                const FIELD: Field = field(DATA, stringify!($name));
                const SHAPE: [Count; 2] = [count(FIELD.rows), count(FIELD.cols)];
                const { assert!(matches!(FIELD.kind, Kind::F64)) };
                let n = self.number(SHAPE[0]) * self.number(SHAPE[1]);
                // SAFETY: the table gives type, place and length of the array, which lives as long as `self`.
                unsafe { array(self.data, FIELD.at, n) }
            }
        )*}
    };
}

data! {
    /// Positions.
    qpos,
    /// Velocities.
    qvel,
    /// Controls.
    ctrl,
    /// Activations.
    act,
    /// Rates of the activations.
    act_dot,
    /// Accelerations.
    qacc,
    /// Start of the solver.
    qacc_warmstart,
    /// Acceleration without constraints.
    qacc_smooth,
    /// Forces of constraints.
    qfrc_constraint,
    /// Coriolis, centrifugal and gravity forces.
    qfrc_bias,
    /// Forces of springs and dampers.
    qfrc_passive,
    /// Forces of actuators.
    qfrc_actuator,
    /// Sensors.
    sensordata,
    /// Body positions.
    xpos,
    /// Body orientations.
    xquat,
    /// Centres of mass.
    xipos,
    /// Geom positions.
    geom_xpos,
    /// Geom orientations.
    geom_xmat,
    /// Inertia, sparse.
    qM,
    /// Constraint violations.
    efc_pos,
    /// Margins of constraint rows.
    efc_margin,
    /// Regularisations of constraint rows.
    efc_R,
    /// Velocities of constraint rows.
    efc_vel,
    /// Inverse regularisations of constraint rows.
    efc_D,
    /// Reference accelerations of constraint rows.
    efc_aref,
    /// Constraint forces.
    efc_force,
}

/// Returns the `n` values behind the pointer at `base + at`.
///
/// # Safety
/// `base + at` must hold a pointer to `n` values of type `T`, valid for `'a`, or anything when `n` is 0.
unsafe fn array<'a, T>(base: Handle, at: usize, n: usize) -> &'a [T] {
    if n == 0 {
        return &[];
    }
    // SAFETY: the caller's.
    unsafe { slice::from_raw_parts(*base.byte_add(at).cast::<*const T>(), n) }
}

/// Returns the `n` values behind the pointer at `base + at`, to write to.
///
/// # Safety
/// As [`array`], and nothing else may refer to the values.
unsafe fn array_mut<'a, T>(base: Handle, at: usize, n: usize) -> &'a mut [T] {
    if n == 0 {
        return &mut [];
    }
    // SAFETY: the caller's.
    unsafe { slice::from_raw_parts_mut(*base.byte_add(at).cast::<*mut T>(), n) }
}

impl Simulation {
    /// Compiles the document `path` of `files` (names and contents).
    ///
    /// # Errors
    /// MuJoCo's message.
    pub fn new(api: &'static Mujoco, path: &str, files: &[(&str, &[u8])]) -> Result<Self, String> {
        let model = api.compile(path, files)?;
        // SAFETY: the model is valid.
        let data = unsafe { (api.make_data)(model) };
        if data.is_null() {
            // SAFETY: the model is valid and used no more.
            unsafe { (api.delete_model)(model) };
            return Err("MuJoCo cannot make the data of the model".to_string());
        }
        Ok(Self { api, model, data })
    }

    fn number(&self, count: Count) -> usize {
        // SAFETY: sizes are `int`s at these offsets.
        let n = unsafe {
            match count {
                Count::Fixed(n) => return n,
                Count::OfModelTimes(at, factor) => return factor * self.number(Count::OfModel(at)),
                Count::OfModel(at) => *self.model.byte_add(at).cast::<c_int>(),
                Count::OfData(at) => *self.data.byte_add(at).cast::<c_int>(),
            }
        };
        usize::try_from(n).unwrap_or(0)
    }

    /// Returns a size of the model, such as `nq`; `None` when mjModel has none of that name.
    pub fn known_size(&self, name: &str) -> Option<usize> {
        let size = MODEL_SIZES.iter().find(|f| f.name == name)?;
        Some(self.number(Count::OfModel(size.at)))
    }

    /// Returns a size of the model, such as `nq`.
    ///
    /// # Panics
    /// There is no such size.
    pub fn size(&self, name: &str) -> usize {
        self.known_size(name)
            .unwrap_or_else(|| panic!("mjModel has no size {name}"))
    }

    /// Returns an array of the model, as numbers; `None` when mjModel has none of that name.
    pub fn model_array(&self, name: &str) -> Option<Vec<f64>> {
        let f = MODEL.iter().find(|f| f.name == name)?;
        let n = self.number(count(f.rows)) * self.number(count(f.cols));
        // SAFETY: the table gives type, place and length of the array.
        Some(unsafe {
            match f.kind {
                Kind::F64 => array::<f64>(self.model, f.at, n).to_vec(),
                Kind::F32 => array::<f32>(self.model, f.at, n)
                    .iter()
                    .map(|&v| f64::from(v))
                    .collect(),
                Kind::I32 => array::<i32>(self.model, f.at, n)
                    .iter()
                    .map(|&v| f64::from(v))
                    .collect(),
                Kind::U8 => array::<u8>(self.model, f.at, n).iter().map(|&v| f64::from(v)).collect(),
            }
        })
    }

    /// Returns an option or a statistic of the model, as numbers.
    pub fn model_value(&self, name: &str) -> Option<Vec<f64>> {
        let part = |name| field(PARTS, name).at;
        let find = |table: &'static [Field]| table.iter().find(|f| f.name == name);
        let (base, f) = match (find(OPTION), find(STATISTIC)) {
            (Some(f), _) => (part("opt"), f),
            (None, Some(f)) => (part("stat"), f),
            (None, None) => return None,
        };
        let Size::Fixed(n) = f.cols else { return None };
        // SAFETY: the values lie inside mjModel, at these offsets.
        Some(unsafe {
            let first = self.model.byte_add(base + f.at);
            match f.kind {
                Kind::F64 => slice::from_raw_parts(first.cast::<f64>(), n).to_vec(),
                Kind::I32 => slice::from_raw_parts(first.cast::<i32>(), n)
                    .iter()
                    .map(|&v| f64::from(v))
                    .collect(),
                Kind::F32 | Kind::U8 => return None,
            }
        })
    }

    /// Returns all arrays, options and statistics of the model, as numbers, in the order of the tables.
    pub fn all_model_values(&self) -> Vec<Vec<f64>> {
        let known = |size: Size| match size {
            Size::Fixed(_) | Size::Times(..) => true,
            Size::Named(name) => position(MODEL_SIZES, name).is_some(),
        };
        let whole = MODEL.iter().filter(|f| known(f.rows) && known(f.cols));
        let arrays = whole.filter_map(|f| self.model_array(f.name));
        let values = OPTION.iter().chain(STATISTIC).filter_map(|f| self.model_value(f.name));
        arrays.chain(values).collect()
    }

    /// Returns the names of the elements of a kind: `body`, `jnt`, `geom` and so on.
    pub fn names(&self, kind: &str) -> Vec<String> {
        let Some((_, object, size)) = NAMED.iter().find(|n| n.0 == kind) else {
            return Vec::new();
        };
        let name = |k: usize| {
            // SAFETY: `k` is below the number of elements; the name ends with 0.
            let name = unsafe { (self.api.id2name)(self.model, *object, k as c_int) };
            if name.is_null() {
                return String::new();
            }
            unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned()
        };
        (0..self.size(size)).map(name).collect()
    }

    fn option<T: Copy>(&mut self, name: &str, kind: Kind) -> &mut T {
        let f = field(OPTION, name);
        assert!(f.kind == kind);
        let at = field(PARTS, "opt").at + f.at;
        // SAFETY: an option of this type lies at this offset in mjModel.
        unsafe { &mut *self.model.byte_add(at).cast::<T>() }
    }

    /// Sets the tolerances of Newton's method and of its line search, and the largest number of iterations.
    pub fn set_tolerance(&mut self, tolerance: f64, ls_tolerance: f64, iterations: usize) {
        *self.option("tolerance", Kind::F64) = tolerance;
        *self.option("ls_tolerance", Kind::F64) = ls_tolerance;
        *self.option("iterations", Kind::I32) = iterations as c_int;
    }

    fn disable(&mut self, bit: i32, off: bool) {
        let flags: &mut i32 = self.option("disableflags", Kind::I32);
        *flags = if off { *flags | bit } else { *flags & !bit };
    }

    /// Switches sensors off, or on again.
    pub fn disable_sensors(&mut self, off: bool) {
        self.disable(DISABLE_SENSOR, off);
    }

    /// Switches contacts off, or on again.
    pub fn disable_contacts(&mut self, off: bool) {
        self.disable(DISABLE_CONTACT, off);
    }

    /// Resets the simulation to `qpos0` at rest.
    pub fn reset(&mut self) {
        // SAFETY: model and data are valid.
        unsafe { (self.api.reset_data)(self.model, self.data) }
    }

    /// Advances by one time step.
    pub fn step(&mut self) {
        // SAFETY: model and data are valid.
        unsafe { (self.api.step)(self.model, self.data) }
    }

    /// Advances by one time step where MuJoCo may give up, as at an inertia that is singular.
    ///
    /// # Errors
    /// MuJoCo's message. Only a reset makes the simulation usable again.
    pub fn try_step(&mut self) -> Result<(), String> {
        self.attempt(Self::step)
    }

    /// Computes what follows from the state where MuJoCo may give up.
    ///
    /// # Errors
    /// As [`Simulation::try_step`].
    pub fn try_forward(&mut self) -> Result<(), String> {
        self.attempt(Self::forward)
    }

    fn attempt(&mut self, work: impl FnOnce(&mut Self)) -> Result<(), String> {
        let done = catch_unwind(AssertUnwindSafe(|| work(self)));
        done.map_err(|panic| panic.downcast_ref::<String>().cloned().unwrap_or_default())
    }

    /// Computes what follows from the state, without advancing.
    pub fn forward(&mut self) {
        // SAFETY: model and data are valid.
        unsafe { (self.api.forward)(self.model, self.data) }
    }

    /// Takes over all that a step of ours depends on, switches and parameters included.
    ///
    /// # Panics
    /// The state is of another model.
    pub fn set_state(&mut self, model: &babybench::Model, s: &State) {
        self.set_motion(&s.qpos, &s.qvel);
        self.set_ctrl(&s.ctrl);
        if model.na > 0 {
            self.data_mut(field(DATA, "act")).copy_from_slice(&s.act);
        }
        self.data_mut(field(DATA, "mocap_pos"))
            .copy_from_slice(s.mocap_pos.as_flattened());
        self.data_mut(field(DATA, "mocap_quat"))
            .copy_from_slice(s.mocap_quat.as_flattened());
        self.set_warmstart(&s.qacc_warmstart);
        self.data_mut(field(DATA, "qfrc_applied"))
            .copy_from_slice(&s.qfrc_applied);
        self.data_mut(field(DATA, "xfrc_applied"))
            .copy_from_slice(s.xfrc_applied.as_flattened());
        self.set_params(model, &s.params);
        self.set_gear(s.reference_gear());
    }

    /// Takes over switches and parameters.
    ///
    /// # Panics
    /// They are of another model.
    pub fn set_params(&mut self, model: &babybench::Model, p: &babybench::physics::Params) {
        let active = field(DATA, "eq_active");
        let n = self.size("neq");
        // SAFETY: `eq_active` has a byte for each equality.
        let bytes = unsafe { array_mut::<u8>(self.data, active.at, n) };
        assert_eq!(bytes.len(), p.eq_active.len());
        bytes
            .iter_mut()
            .zip(&p.eq_active)
            .for_each(|(to, &from)| *to = u8::from(from));
        let data = self.model_mut(field(MODEL, "eq_data"));
        for (row, (kind, &offset)) in data.chunks_exact_mut(11).zip(model.eq_kind.iter().zip(&p.eq_offset)) {
            if matches!(kind, EqualityKind::Joint { .. } | EqualityKind::Tendon { .. }) {
                row[0] = offset;
            }
        }
        self.model_mut(field(MODEL, "jnt_stiffness"))
            .copy_from_slice(&p.jnt_stiffness);
        self.model_mut(field(MODEL, "dof_damping"))
            .copy_from_slice(&p.dof_damping);
        self.set_gear(&p.actuator_gear);
        let limited = field(MODEL, "actuator_forcelimited");
        let n = self.size("nu");
        // SAFETY: `actuator_forcelimited` has a byte for each actuator.
        let bytes = unsafe { array_mut::<u8>(self.model, limited.at, n) };
        bytes
            .iter_mut()
            .zip(&p.actuator_forcelimited)
            .for_each(|(to, &from)| *to = u8::from(from));
    }

    /// Sets the gears of the actuators.
    fn set_gear(&mut self, gear: &[f64]) {
        let rows = self.model_mut(field(MODEL, "actuator_gear"));
        for (row, &gear) in rows.chunks_exact_mut(6).zip(gear) {
            row[0] = gear;
        }
    }

    /// Sets positions and velocities.
    pub fn set_motion(&mut self, qpos: &[f64], qvel: &[f64]) {
        self.data_mut(field(DATA, "qpos")).copy_from_slice(qpos);
        self.data_mut(field(DATA, "qvel")).copy_from_slice(qvel);
    }

    /// Sets the controls.
    pub fn set_ctrl(&mut self, ctrl: &[f64]) {
        self.data_mut(field(DATA, "ctrl")).copy_from_slice(ctrl);
    }

    /// Sets the start of the solver.
    pub fn set_warmstart(&mut self, qacc: &[f64]) {
        self.data_mut(field(DATA, "qacc_warmstart")).copy_from_slice(qacc);
    }

    fn data_mut(&mut self, f: Field) -> &mut [f64] {
        assert!(f.kind == Kind::F64);
        let n = self.number(count(f.rows)) * self.number(count(f.cols));
        // SAFETY: the table gives type, place and length; `self` is borrowed mutably.
        unsafe { array_mut(self.data, f.at, n) }
    }

    fn model_mut(&mut self, f: Field) -> &mut [f64] {
        assert!(f.kind == Kind::F64);
        let n = self.number(count(f.rows)) * self.number(count(f.cols));
        // SAFETY: the table gives type, place and length; `self` is borrowed mutably, and shares its model with nothing.
        unsafe { array_mut(self.model, f.at, n) }
    }

    /// Returns which equalities are active.
    pub fn eq_active(&self) -> Vec<bool> {
        // SAFETY: `eq_active` has a byte for each equality.
        let bytes = unsafe { array::<u8>(self.data, const { field(DATA, "eq_active").at }, self.size("neq")) };
        bytes.iter().map(|&v| v != 0).collect()
    }

    /// Returns what a force and a torque at a point do to the joints (nv): `mj_applyFT`.
    pub fn apply_ft(&mut self, body: usize, force: [f64; 3], torque: [f64; 3], point: [f64; 3]) -> Vec<f64> {
        let mut qfrc = vec![0.0; self.size("nv")];
        let (f, t, p) = (force.as_ptr(), torque.as_ptr(), point.as_ptr());
        // SAFETY: model and data are valid, the vectors have 3 numbers and nv.
        unsafe { (self.api.apply_ft)(self.model, self.data, f, t, p, body as c_int, qfrc.as_mut_ptr()) };
        qfrc
    }

    /// Returns the number of contacts.
    pub fn ncon(&self) -> usize {
        self.number(const { Count::OfData(field(DATA_SIZES, "ncon").at) })
    }

    /// Returns the number of constraint rows.
    pub fn nefc(&self) -> usize {
        self.number(const { Count::OfData(field(DATA_SIZES, "nefc").at) })
    }

    /// Returns how many warnings came since the last reset: numbers that are not finite, full buffers, a singular inertia.
    pub fn warnings(&self) -> usize {
        // SAFETY: `WARNINGS` pairs of `int`s lie at this offset in mjData, the second of each a number.
        let pairs = unsafe {
            let first = self.data.byte_add(const { field(PARTS, "warning").at });
            slice::from_raw_parts(first.cast::<[c_int; 2]>(), WARNINGS)
        };
        pairs.iter().filter_map(|pair| usize::try_from(pair[1]).ok()).sum()
    }

    /// Returns the simulated time, s.
    pub fn time(&self) -> f64 {
        // SAFETY: the time lies at this offset in mjData.
        unsafe { *self.data.byte_add(const { field(DATA_SIZES, "time").at }).cast::<f64>() }
    }

    /// Returns the number of Newton iterations of the last step, in the first island.
    pub fn solver_iterations(&self) -> usize {
        // SAFETY: the number lies at this offset in mjData.
        let n = unsafe {
            *self
                .data
                .byte_add(const { field(PARTS, "solver_niter").at })
                .cast::<c_int>()
        };
        usize::try_from(n).unwrap_or(0)
    }

    /// Returns the contacts of the last step, with their forces.
    pub fn contacts(&self) -> Vec<Contact> {
        let at = const { field(PARTS, "contact").at };
        // SAFETY: `contact` points to `ncon` structures of this size.
        let all = unsafe { array::<u8>(self.data, at, self.ncon() * CONTACT_SIZE) };
        all.chunks_exact(CONTACT_SIZE)
            .enumerate()
            .map(|(k, c)| self.contact(k, c))
            .collect()
    }

    fn contact(&self, k: usize, bytes: &[u8]) -> Contact {
        let number = |name: &str, i: usize| {
            let at = field(CONTACT, name).at + 8 * i;
            f64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
        };
        let integer = |name: &str, i: usize| {
            let at = field(CONTACT, name).at + 4 * i;
            i32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
        };
        let mut force = [0.0; 6];
        // SAFETY: `k` is below the number of contacts, and there is room for six numbers.
        unsafe { (self.api.contact_force)(self.model, self.data, k as c_int, force.as_mut_ptr()) };
        Contact {
            geom: [0, 1].map(|side| usize::try_from(integer("geom", side)).unwrap_or(usize::MAX)),
            dist: number("dist", 0),
            pos: std::array::from_fn(|i| number("pos", i)),
            frame: std::array::from_fn(|i| number("frame", i)),
            dim: usize::try_from(integer("dim", 0)).unwrap_or(0),
            friction: std::array::from_fn(|i| number("friction", i)),
            includemargin: number("includemargin", 0),
            efc_address: usize::try_from(integer("efc_address", 0)).ok(),
            force,
        }
    }

    /// Computes the potential and kinetic energy at a motion, J, and leaves the simulation there.
    pub fn energy_at(&mut self, qpos: &[f64], qvel: &[f64]) -> [f64; 2] {
        self.set_motion(qpos, qvel);
        self.forward();
        // SAFETY: model and data are valid; both energies lie at this offset in mjData.
        unsafe {
            (self.api.energy_pos)(self.model, self.data);
            (self.api.energy_vel)(self.model, self.data);
            *self
                .data
                .byte_add(const { field(PARTS, "energy").at })
                .cast::<[f64; 2]>()
        }
    }

    /// Returns the full inertia matrix (nv, nv).
    pub fn full_inertia(&self) -> Vec<f64> {
        let nv = self.size("nv");
        let mut out = vec![0.0; nv * nv];
        // SAFETY: there is room for the matrix, and `qM` is the data's.
        unsafe { (self.api.full_m)(self.model, out.as_mut_ptr(), self.qM().as_ptr()) };
        out
    }

    /// Returns positions, velocities, warm start and controls from `mj_getState`.
    ///
    /// MuJoCo knows the layout itself, so this checks the offsets.
    pub fn state_by_mujoco(&self) -> [Vec<f64>; 4] {
        [1, 2, 4, 5].map(|bit| {
            // SAFETY: the buffer has the size that MuJoCo asks for.
            unsafe {
                let n = (self.api.state_size)(self.model, 1 << bit);
                let mut out = vec![0.0; usize::try_from(n).unwrap_or(0)];
                (self.api.get_state)(self.model, self.data, out.as_mut_ptr(), 1 << bit);
                out
            }
        })
    }
}
