//! The numbers of an environment's model that a program may change, by name.

use std::collections::BTreeMap;

use babybench::env::CHANGEABLE;
use babybench::model::Arrays;
use numpy::PyReadonlyArrayDyn;
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{read, shaped};
use crate::errors::IntoException;
use crate::model;
use crate::physics_fields::{Field, model_fields, model_fields_mut};

/// Returns the name of a field of the table of a model's numbers.
fn field_name(name: &str) -> String {
    name.replacen("opt.", "opt_", 1)
}

/// Returns the shape in Python of a field.
fn shape(width: Option<usize>, len: usize) -> Vec<usize> {
    match width {
        Some(width) => vec![len / width.max(1), width],
        None => vec![len],
    }
}

/// The gears. The engine of an environment has the first of each row.
const GEARS: &str = "actuator_gear";

/// Goes through the numbers of a model as the engine of an environment has them.
fn numbers_of<'a>(arrays: &'a Arrays, mut work: impl FnMut(Field<&'a [f64]>)) {
    model_fields(arrays, |field| {
        let first = field.name == GEARS;
        work(Field {
            width: if first { None } else { field.width },
            values: if first { &arrays.actuator_gear } else { field.values },
            ..field
        });
    });
}

/// Changes numbers of a model: the whole array of each name.
pub fn change(env: &mut babybench::Env, changes: &Bound<'_, PyDict>) -> PyResult<()> {
    let mut shapes = BTreeMap::new();
    numbers_of(env.model(), |field| {
        shapes.insert(field.name, shape(field.width, field.values.len()));
    });
    let mut read_values = BTreeMap::new();
    for (name, values) in changes {
        let name: String = name.extract()?;
        let field = field_name(&name);
        let known = shapes.get(&field[..]).filter(|_| CHANGEABLE.contains(&&name[..]));
        let shape = known.ok_or_else(|| {
            PyKeyError::new_err(format!(
                "nothing of the model that can change is called {name:?}; what can are {}",
                CHANGEABLE.join(", ")
            ))
        })?;
        let single = name.starts_with("opt.") && shape[..] == [1];
        let mut numbers = Vec::new();
        read(&name, &values, if single { &[] } else { shape }, &mut numbers)?;
        read_values.insert(field, numbers);
    }
    let edit = |arrays: &mut Arrays| {
        if let Some(gears) = read_values.remove(GEARS) {
            arrays.actuator_gear = gears;
        }
        model_fields_mut(arrays, |field| {
            if let Some(numbers) = read_values.get(field.name) {
                field.values.copy_from_slice(numbers);
            }
        });
    };
    env.model_mut().change(edit).map_err(IntoException::into_exception)
}

/// Returns what was changed, by name.
pub fn changes<'py>(py: Python<'py>, env: &babybench::Env) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for name in env.blueprint().model_changes() {
        dict.set_item(name, value(py, env, name)?)?;
    }
    Ok(dict)
}

/// Returns the current values of an array of the model.
pub fn array<'py>(py: Python<'py>, env: &babybench::Env, name: &str) -> PyResult<Bound<'py, PyAny>> {
    if CHANGEABLE.contains(&name) {
        value(py, env, name)
    } else {
        model::array(py, env.model(), name)
    }
}

/// Returns numbers that may change: an array, or a single number of the options.
fn value<'py>(py: Python<'py>, env: &babybench::Env, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let wanted = field_name(name);
    let mut found = None;
    numbers_of(&env.blueprint().model_arrays(), |field| {
        if field.name == wanted {
            found = Some(match field.values {
                [single] if name.starts_with("opt.") => shaped(py, &[*single], &[]),
                values => shaped(py, values, &shape(field.width, values.len())),
            });
        }
    });
    found.unwrap_or_else(|| Err(PyKeyError::new_err(format!("there is no array {name:?}"))))
}

/// Arrays that a program may write to, and what was in them.
#[pyclass(module = "babybench_core._native")]
pub struct Watch {
    seen: Vec<Vec<f64>>,
}

#[pymethods]
impl Watch {
    #[new]
    fn new(arrays: Vec<PyReadonlyArrayDyn<'_, f64>>) -> PyResult<Self> {
        let seen = arrays.iter().map(|array| Ok(content(array)?.to_vec()));
        Ok(Self {
            seen: seen.collect::<PyResult<_>>()?,
        })
    }

    /// Returns which arrays have changed since the last call.
    fn changed(&mut self, arrays: Vec<PyReadonlyArrayDyn<'_, f64>>) -> PyResult<Vec<usize>> {
        let mut changed = Vec::new();
        for (k, (seen, array)) in self.seen.iter_mut().zip(&arrays).enumerate() {
            let now = content(array)?;
            if now != &seen[..] {
                changed.push(k);
                seen.clear();
                seen.extend_from_slice(now);
            }
        }
        Ok(changed)
    }
}

fn content<'a>(array: &'a PyReadonlyArrayDyn<'_, f64>) -> PyResult<&'a [f64]> {
    array.as_slice().map_err(|e| PyValueError::new_err(e.to_string()))
}
