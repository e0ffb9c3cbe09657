//! Observations as dictionaries of arrays: fresh ones, or views that each step updates.

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

/// Returns the values of a skin with the list of nonzero ones, if the entry is touch or pain.
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
    fresh_of(py, env, |_| true)
}

/// Returns a fresh dictionary of fresh arrays, without images.
pub fn fresh_blind<'py>(py: Python<'py>, env: &Env) -> PyResult<Bound<'py, PyDict>> {
    fresh_of(py, env, |entry| entry.image.is_none())
}

/// Returns a fresh dictionary of fresh arrays of the images.
pub fn fresh_images<'py>(py: Python<'py>, env: &Env) -> PyResult<Bound<'py, PyDict>> {
    fresh_of(py, env, |entry| entry.image.is_some())
}

/// Returns the chosen entries that exist.
fn fresh_of<'py>(
    py: Python<'py>,
    env: &Env,
    chosen: impl Fn(&ObservationEntry) -> bool,
) -> PyResult<Bound<'py, PyDict>> {
    let (dict, observation) = (PyDict::new(py), env.observation());
    let mut spaces = env.observation_space().into_iter();
    for (entry, values) in observation.entries() {
        // both have the same order, and images that wait are among the spaces alone
        let Some(space) = spaces.find(|space| space.key == entry.key) else {
            break;
        };
        if !chosen(entry) {
            continue;
        }
        let array = match skin_of(env, entry) {
            Some(felt) => sparse(py, felt)?.into_any(),
            None => fresh_array(py, values, &space.shape)?,
        };
        dict.set_item(PyString::intern(py, entry.key), array)?;
    }
    Ok(dict)
}

/// Returns an observation that environments no longer hold as a fresh dictionary of fresh arrays; `spaces` are those of its entries.
pub fn dict_of_row<'py>(
    py: Python<'py>,
    observation: &Observation<'_>,
    spaces: &[ObservationSpace],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (entry, values) in observation.entries() {
        // images on request are not among the spaces
        if let Some(space) = spaces.iter().find(|space| space.key == entry.key) {
            dict.set_item(entry.key, fresh_array(py, values, &space.shape)?)?;
        }
    }
    Ok(dict)
}

/// Returns touch or pain as a fresh array, writing only the active sensors.
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
    /// Its place in [`ObservationEntry::ALL`].
    place: usize,
    slab: AnySlab,
    /// Sensors of a skin that are not zero in the array.
    touched: Vec<u32>,
}

/// An observation whose arrays stay the same from step to step.
pub struct Views {
    /// The contents of an observation.
    pub dict: Py<PyDict>,
    /// The images, if they are drawn on request.
    pub images: Py<PyDict>,
    views: Vec<View>,
}

impl Views {
    /// Creates views of an environment's observation. Images on request are separate.
    pub fn new(py: Python<'_>, env: &Env, lazy: bool) -> PyResult<Self> {
        let (dict, images, mut views) = (PyDict::new(py), PyDict::new(py), Vec::new());
        for space in env.observation_space() {
            let mut known = ObservationEntry::ALL.iter().enumerate();
            let Some((place, entry)) = known.find(|(_, entry)| entry.key == space.key) else {
                continue;
            };
            let slab = AnySlab::new(py, entry.dtype, &space.shape)?;
            let of = if lazy && entry.image.is_some() { &images } else { &dict };
            of.set_item(entry.key, slab.view())?;
            let touched = Vec::new();
            views.push(View {
                entry,
                place,
                slab,
                touched,
            });
        }
        let mut views = Self {
            dict: dict.unbind(),
            images: images.unbind(),
            views,
        };
        views.update(py, env)?;
        Ok(views)
    }

    /// Updates the arrays.
    pub fn update(&mut self, py: Python<'_>, env: &Env) -> PyResult<()> {
        let observed = env.observation().values();
        for view in &mut self.views {
            // images still to be drawn, and parts that a restored snapshot does not hold, do not change
            let Some(values) = observed[view.place] else { continue };
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
