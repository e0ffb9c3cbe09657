//! Copies our states, parameters and options to MuJoCo.

use std::ffi::c_int;

use babybench::model::EqualityKind;
use babybench::physics::State;

use super::super::layout::{Field, Kind, field};
use super::super::offsets::{DATA, MODEL, OPTION, PARTS};
use super::{Simulation, array_mut, count};

/// Bits of `mjtDisableBit`.
const DISABLE_SENSOR: i32 = 1 << 12;
const DISABLE_CONTACT: i32 = 1 << 4;

impl Simulation {
    fn option<T: Copy>(&mut self, name: &str, kind: Kind) -> &mut T {
        let f = field(OPTION, name);
        assert!(f.kind == kind);
        let at = field(PARTS, "opt").at + f.at;
        // SAFETY: an option of this type lies at this offset in mjModel.
        unsafe { &mut *self.model.byte_add(at).cast::<T>() }
    }

    /// Sets the tolerances of Newton's method and of its line search, and the largest number of iterations; returns the previous ones.
    pub fn set_tolerance(&mut self, tolerance: f64, ls_tolerance: f64, iterations: usize) -> (f64, f64, usize) {
        let before: c_int = std::mem::replace(self.option("iterations", Kind::I32), iterations as c_int);
        (
            std::mem::replace(self.option("tolerance", Kind::F64), tolerance),
            std::mem::replace(self.option("ls_tolerance", Kind::F64), ls_tolerance),
            before as usize,
        )
    }

    fn disable(&mut self, bit: i32, off: bool) {
        let flags: &mut i32 = self.option("disableflags", Kind::I32);
        *flags = if off { *flags | bit } else { *flags & !bit };
    }

    /// Switches sensors off, or on again.
    pub fn disable_sensors(&mut self, off: bool) {
        self.disable(DISABLE_SENSOR, off);
    }

    /// Turns contacts off or on.
    pub fn disable_contacts(&mut self, off: bool) {
        self.disable(DISABLE_CONTACT, off);
    }

    /// Copies everything that our step depends on, including switches and parameters.
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

    /// Copies switches and parameters.
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
}
