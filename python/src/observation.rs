//! Observations as dictionaries of arrays: fresh ones, or views that each step brings up to date.

use babybench::Env;
use babybench::env::Observation;
use babybench::sensors::transform::Sense;
use babybench::sensors::{ObservationEntry, SkinValues};
use babybench::spaces::{ObservationSpace, Values};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays::shaped;
use crate::slab::AnySlab;

/// Returns what a skin reports with the list of what is not zero, if that is what an entry is.
fn skin_of<'e>(env: &'e Env, entry: &ObservationEntry) -> Option<&'e SkinValues> {
    match entry.sense {
        Some(Sense::Touch) => env.senses().touch_observed(),
        Some(Sense::Pain) => env.senses().pain_observed(),
        _ => None,
    }
}

/// Returns numbers as a fresh array of a shape.
fn fresh_array<'py>(py: Python<'py>, values: Values<'_>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    match values {
        Values::F64(values) => shaped(py, values, shape),
        Values::F32(values) => shaped(py, values, shape),
        Values::U8(values) => shaped(py, values, shape),
        Values::I32(values) => shaped(py, values, shape),
    }
}

/// Returns a fresh dictionary of fresh arrays.
pub fn fresh<'py>(py: Python<'py>, env: &Env) -> PyResult<Bound<'py, PyDict>> {
    let (dict, observation) = (PyDict::new(py), env.observation());
    for ((entry, values), space) in observation.entries().zip(env.observation_space()) {
        let array = match skin_of(env, entry) {
            Some(felt) => sparse(py, felt)?.into_any(),
            None => fresh_array(py, values, &space.shape)?,
        };
        dict.set_item(PyString::intern(py, entry.key), array)?;
    }
    Ok(dict)
}

/// Returns an observation that no environment holds any more as a fresh dictionary of fresh arrays; `spaces` are those of its entries.
pub fn dict_of_row<'py>(
    py: Python<'py>,
    observation: &Observation<'_>,
    spaces: &[ObservationSpace],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for ((entry, values), space) in observation.entries().zip(spaces) {
        dict.set_item(entry.key, fresh_array(py, values, &space.shape)?)?;
    }
    Ok(dict)
}

/// Returns touch or pain as a fresh array, of which only what feels something is written.
pub fn sparse<'py>(py: Python<'py>, touch: &SkinValues) -> PyResult<Bound<'py, PyArray1<f32>>> {
    let array = PyArray1::zeros(py, touch.values().len(), false);
    write_touched(array.readwrite().as_slice_mut()?, touch);
    Ok(array)
}

/// Writes what is felt into zeros.
pub fn write_touched(out: &mut [f32], touch: &SkinValues) {
    let (width, values) = (touch.width(), touch.values());
    for &sensor in touch.touched() {
        let of = width * sensor as usize..width * (sensor as usize + 1);
        out[of.clone()].copy_from_slice(&values[of]);
    }
}

/// An entry of an observation in an array that stays the same.
struct View {
    entry: &'static ObservationEntry,
    slab: AnySlab,
    /// Sensors of a skin that are not zero in the array.
    touched: Vec<u32>,
}

/// An observation whose arrays stay the same from step to step.
pub struct Views {
    pub dict: Py<PyDict>,
    views: Vec<View>,
}

impl Views {
    /// Makes views of what an environment observes.
    pub fn new(py: Python<'_>, env: &Env) -> PyResult<Self> {
        let (dict, mut views) = (PyDict::new(py), Vec::new());
        for ((entry, _), space) in env.observation().entries().zip(env.observation_space()) {
            let slab = AnySlab::new(py, entry.dtype, &space.shape)?;
            dict.set_item(entry.key, slab.view())?;
            let touched = Vec::new();
            views.push(View { entry, slab, touched });
        }
        let mut views = Self {
            dict: dict.unbind(),
            views,
        };
        views.update(py, env)?;
        Ok(views)
    }

    /// Brings the arrays up to date.
    pub fn update(&mut self, py: Python<'_>, env: &Env) -> PyResult<()> {
        for (view, (entry, values)) in self.views.iter_mut().zip(env.observation().entries()) {
            debug_assert_eq!(view.entry.key, entry.key);
            match (skin_of(env, view.entry), &view.slab) {
                (Some(felt), AnySlab::F32(slab)) => {
                    let (width, touched) = (felt.width(), &mut view.touched);
                    slab.write(py, |out| {
                        for &sensor in &*touched {
                            out[width * sensor as usize..width * (sensor as usize + 1)].fill(0.0);
                        }
                        write_touched(out, felt);
                    })?;
                    touched.clear();
                    touched.extend_from_slice(felt.touched());
                }
                (_, slab) => slab.lend(py).write_row(0, values)?,
            }
        }
        Ok(())
    }
}
