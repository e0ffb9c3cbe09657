//! A model and its data in MuJoCo 3.3.0, with all their arrays.

mod contact;
mod model;
mod set;

use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use super::api::{Handle, Mujoco};
use super::layout::{Field, Kind, Size, field, position};
use super::offsets::{DATA, DATA_SIZES, MODEL_SIZES, PARTS, WARNINGS};
pub use contact::Contact;

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
    /// Jacobian of constraint rows, full or sparse.
    efc_J,
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
/// As [`array`], without other references to the values.
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

    /// Returns a size of the model, such as `nq`; `None` if mjModel has no size of that name.
    pub fn known_size(&self, name: &str) -> Option<usize> {
        let size = MODEL_SIZES.iter().find(|f| f.name == name)?;
        Some(self.number(Count::OfModel(size.at)))
    }

    /// Returns a size of the model, such as `nq`.
    ///
    /// # Panics
    /// The size does not exist.
    pub fn size(&self, name: &str) -> usize {
        self.known_size(name)
            .unwrap_or_else(|| panic!("mjModel has no size {name}"))
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

    /// Advances by one time step where MuJoCo may give up, for example because of a singular inertia.
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

    /// Returns which equalities are active.
    pub fn eq_active(&self) -> Vec<bool> {
        // SAFETY: `eq_active` has a byte for each equality.
        let bytes = unsafe { array::<u8>(self.data, const { field(DATA, "eq_active").at }, self.size("neq")) };
        bytes.iter().map(|&v| v != 0).collect()
    }

    /// Returns the generalised forces (nv) of a force and a torque at a point: `mj_applyFT`.
    pub fn apply_ft(&mut self, body: usize, force: [f64; 3], torque: [f64; 3], point: [f64; 3]) -> Vec<f64> {
        let mut qfrc = vec![0.0; self.size("nv")];
        let (f, t, p) = (force.as_ptr(), torque.as_ptr(), point.as_ptr());
        // SAFETY: model and data are valid, the vectors have 3 numbers and nv.
        unsafe { (self.api.apply_ft)(self.model, self.data, f, t, p, body as c_int, qfrc.as_mut_ptr()) };
        qfrc
    }

    /// Returns the largest entry of the Jacobian in each constraint row.
    pub fn efc_rates(&self) -> Vec<f64> {
        let (jacobian, rows, nv) = (self.efc_J(), self.nefc(), self.size("nv"));
        let largest = |row: &[f64]| row.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // SAFETY: the model is valid.
        if unsafe { (self.api.is_sparse)(self.model) } == 0 {
            return jacobian.chunks_exact(nv.max(1)).take(rows).map(largest).collect();
        }
        // SAFETY: a sparse Jacobian has both numbers for each row.
        let (adr, nnz) = unsafe {
            (
                array::<c_int>(self.data, const { field(DATA, "efc_J_rowadr").at }, rows),
                array::<c_int>(self.data, const { field(DATA, "efc_J_rownnz").at }, rows),
            )
        };
        let row = |(&adr, &nnz): (&c_int, &c_int)| largest(&jacobian[adr as usize..][..nnz as usize]);
        adr.iter().zip(nnz).map(row).collect()
    }

    /// Returns the number of contacts.
    pub fn ncon(&self) -> usize {
        self.number(const { Count::OfData(field(DATA_SIZES, "ncon").at) })
    }

    /// Returns the number of constraint rows.
    pub fn nefc(&self) -> usize {
        self.number(const { Count::OfData(field(DATA_SIZES, "nefc").at) })
    }

    /// Returns the number of warnings since the last reset: numbers that are not finite, full buffers, a singular inertia.
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
