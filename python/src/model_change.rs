//! The numbers of an environment's model that a program may change, by name.

use std::collections::BTreeMap;

use babybench::env::CHANGEABLE;
use babybench::model::Arrays;
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::exceptions::{PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{read, shaped};
use crate::env::Env;
use crate::errors::IntoException;
use crate::model;
use crate::physics_columns::{columns, write_columns};
use crate::physics_fields::{Field, model_fields, model_fields_mut};
use crate::pictures::Painters;

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

/// Visits the numbers of a model as an environment's engine has them.
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

/// Returns fresh arrays of the look of an environment's model, and of its equalities and keyframes.
#[pyfunction]
pub fn model_columns<'py>(py: Python<'py>, env: &Bound<'py, Env>) -> PyResult<Bound<'py, PyDict>> {
    columns(py, env.get().guard()?.open()?.env.model())
}

/// Sets which equality constraints are active, now and in later episodes.
#[pyfunction]
pub fn set_equalities(env: &Bound<'_, Env>, active: Vec<bool>) -> PyResult<()> {
    let mut guard = env.get().guard()?;
    let changed = guard.open()?.env.model_mut().set_equalities(&active);
    changed.map_err(IntoException::into_exception)
}

/// Changes the look of an environment's model: whole arrays by name.
#[pyfunction]
pub fn paint(env: &Bound<'_, Env>, looks: &Bound<'_, PyDict>) -> PyResult<()> {
    let mut guard = env.get().guard()?;
    let inner = guard.open()?;
    let env = &mut inner.env;
    let mut given = BTreeMap::new();
    for (name, values) in looks {
        let flat = values.call_method0("ravel")?.call_method1("astype", ("float64",))?;
        given.insert(name.extract::<String>()?, flat.extract::<Vec<f64>>()?);
    }
    let mut looked = Arrays::clone(env.model());
    write_columns(&given, &mut looked)?;
    env.model_mut()
        .paint(|arrays| *arrays = looked)
        .map_err(IntoException::into_exception)?;
    // the earlier ones would continue to draw the old look
    inner.painters = Painters::default();
    Ok(())
}

/// The numbers of an array, in the types that arrays of a model have.
#[derive(PartialEq)]
enum Numbers {
    Double(Vec<f64>),
    Single(Vec<f32>),
    Whole(Vec<i32>),
    Byte(Vec<u8>),
    /// Since MuJoCo 4.
    Flag(Vec<bool>),
}

impl Numbers {
    fn of(array: &Bound<'_, PyAny>) -> PyResult<Self> {
        macro_rules! read {
            ($($kind:ident $type:ty),*) => {$(
                if let Ok(array) = array.cast::<PyArrayDyn<$type>>() {
                    return Ok(Self::$kind(content(&array.try_readonly()?)?.to_vec()));
                }
            )*};
        }
        read!(Double f64, Single f32, Whole i32, Byte u8, Flag bool);
        Err(PyTypeError::new_err("an array of a model has real numbers"))
    }

    /// Returns whether an array has these numbers.
    fn same(&self, array: &Bound<'_, PyAny>) -> PyResult<bool> {
        macro_rules! compare {
            ($($kind:ident $type:ty),*) => {
                match self {$(
                    Self::$kind(seen) => {
                        let array = array.cast::<PyArrayDyn<$type>>().map_err(|e| PyTypeError::new_err(e.to_string()))?;
                        Ok(content(&array.try_readonly()?)? == &seen[..])
                    }
                )*}
            };
        }
        compare!(Double f64, Single f32, Whole i32, Byte u8, Flag bool)
    }
}

/// Arrays that a program may write to, and their earlier contents.
#[pyclass(module = "babybench_core._native")]
pub struct Watch {
    seen: Vec<Numbers>,
}

#[pymethods]
impl Watch {
    #[new]
    fn new(arrays: Vec<Bound<'_, PyAny>>) -> PyResult<Self> {
        let seen = arrays.iter().map(Numbers::of).collect::<PyResult<_>>()?;
        Ok(Self { seen })
    }

    /// Returns which arrays have changed since the last call.
    fn changed(&mut self, arrays: Vec<Bound<'_, PyAny>>) -> PyResult<Vec<usize>> {
        let mut changed = Vec::new();
        for (k, (seen, array)) in self.seen.iter_mut().zip(&arrays).enumerate() {
            if !seen.same(array)? {
                changed.push(k);
                *seen = Numbers::of(array)?;
            }
        }
        Ok(changed)
    }
}

fn content<'a, T: Element>(array: &'a PyReadonlyArrayDyn<'_, T>) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|e| PyValueError::new_err(e.to_string()))
}
