//! The options and settings of a model that are not arrays.

use babybench::Model;
use babybench::model::{Flags, IntegratorType, SolverType};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::ToArray;
use crate::model;

/// The flags of a simulation in the order of MuJoCo's `mjtDisableBit`.
fn flags(flags: &mut Flags) -> [&mut bool; 17] {
    [
        &mut flags.constraint,
        &mut flags.equality,
        &mut flags.frictionloss,
        &mut flags.limit,
        &mut flags.contact,
        &mut flags.passive,
        &mut flags.gravity,
        &mut flags.clampctrl,
        &mut flags.warmstart,
        &mut flags.filterparent,
        &mut flags.actuation,
        &mut flags.refsafe,
        &mut flags.sensor,
        &mut flags.midphase,
        &mut flags.eulerdamp,
        &mut flags.autoreset,
        &mut flags.nativeccd,
    ]
}

/// The flags that are off by default, in the order of MuJoCo's `mjtEnableBit`, with the bit of the first. The bits around them are
/// `override`, which is never on, and `island`, which documents alone set.
fn enabled(flags: &mut Flags) -> (usize, [&mut bool; 4]) {
    let flags = [
        &mut flags.energy,
        &mut flags.fwdinv,
        &mut flags.invdiscrete,
        &mut flags.multiccd,
    ];
    (1, flags)
}

/// Returns the bit of islands in MuJoCo's `mjtEnableBit`, if they are on.
fn islands(flags: &Flags) -> usize {
    usize::from(flags.island) << 5
}

/// Returns sizes, options, statistics and visual settings that are in no array.
pub fn settings<'py>(py: Python<'py>, m: &Model) -> PyResult<Bound<'py, PyDict>> {
    let settings = model::options(py, m)?;
    for (name, size) in [
        ("nkey", m.nkey()),
        ("nlight", m.lights.len()),
        ("nexclude", m.exclude.len()),
        ("nmesh", m.nmesh()),
        ("nhfield", m.nhfield()),
        ("nskin", m.nskin()),
        ("nflex", m.nflex()),
    ] {
        settings.set_item(name, size)?;
    }
    let solver = match m.opt.solver {
        SolverType::Pgs => 0,
        SolverType::Cg => 1,
        SolverType::Newton => 2,
    };
    let jacobian = m.opt.jacobian as u8;
    let cone = m.opt.cone as u8;
    let integrator = match m.opt.integrator {
        IntegratorType::Euler => 0,
        IntegratorType::Rk4 => 1,
        IntegratorType::Implicit => 2,
        IntegratorType::ImplicitFast => 3,
    };
    for (name, value) in [
        ("solver", solver),
        ("jacobian", jacobian),
        ("cone", cone),
        ("integrator", integrator),
    ] {
        settings.set_item(name, value)?;
    }
    let mut own = m.opt.flags.clone();
    let bits = flags(&mut own)
        .into_iter()
        .enumerate()
        .map(|(bit, on)| u32::from(!*on) << bit);
    settings.set_item("disableflags", bits.sum::<u32>())?;
    let (first, on) = enabled(&mut own);
    let bits = on
        .into_iter()
        .enumerate()
        .map(|(bit, on)| usize::from(*on) << (first + bit));
    let bits: usize = bits.sum();
    settings.set_item("enableflags", bits | islands(&own))?;
    settings.set_item("noslip_iterations", m.opt.noslip_iterations)?;
    settings.set_item("disableactuator", m.opt.disableactuator)?;
    settings.set_item("nuserdata", m.nuserdata)?;
    for (name, value) in [
        ("meaninertia", m.stat.meaninertia),
        ("meanmass", m.stat.meanmass),
        ("meansize", m.stat.meansize),
        ("fovy", m.vis.fovy),
    ] {
        settings.set_item(name, value)?;
    }
    settings.set_item("center", m.stat.center[..].to_array(py)?)?;
    settings.set_item("offwidth", m.vis.offwidth)?;
    settings.set_item("offheight", m.vis.offheight)?;
    Ok(settings)
}

/// Returns a model with another whole number among its options.
pub fn with_option(model: &Model, name: &str, value: i64) -> PyResult<Model> {
    let refused = || {
        PyAttributeError::new_err(format!(
            "opt.{name} cannot be {value} here: what can be set are iterations, ls_iterations, ccd_iterations and noslip_iterations (0 or more), \
             integrator (0 Euler, 1 RK4, 2 implicit, 3 implicitfast), disableflags (bits 0 to 16), enableflags (bits 1 to 4) and \
             disableactuator (bits 0 to 30); set others in the document"
        ))
    };
    let count = usize::try_from(value).map_err(|_| refused())?;
    let mut known = true;
    let changed = model.edited(|arrays| {
        let opt = &mut arrays.opt;
        match (name, count) {
            ("iterations", 0..=1_000_000) => opt.iterations = count,
            ("ls_iterations", 0..=1_000_000) => opt.ls_iterations = count,
            ("ccd_iterations", 0..=1_000_000) => opt.ccd_iterations = count,
            ("integrator", 0) => opt.integrator = IntegratorType::Euler,
            ("integrator", 1) => opt.integrator = IntegratorType::Rk4,
            ("integrator", 2) => opt.integrator = IntegratorType::Implicit,
            ("integrator", 3) => opt.integrator = IntegratorType::ImplicitFast,
            ("noslip_iterations", 0..=1_000_000) => opt.noslip_iterations = count,
            ("disableactuator", 0..0x8000_0000) => opt.disableactuator = count as u32,
            ("enableflags", _) if count & !0b1_1110 == islands(&opt.flags) => {
                let (first, on) = enabled(&mut opt.flags);
                for (bit, on) in on.into_iter().enumerate() {
                    *on = count >> (first + bit) & 1 == 1;
                }
            }
            ("disableflags", 0..0x2_0000) => {
                for (bit, on) in flags(&mut opt.flags).into_iter().enumerate() {
                    *on = count >> bit & 1 == 0;
                }
            }
            _ => known = false,
        }
    });
    if !known {
        return Err(refused());
    }
    Ok(changed)
}
