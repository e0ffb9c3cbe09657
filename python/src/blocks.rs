//! The last values of a sense, as a dictionary of arrays.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyList, PySlice};

use crate::env::Env;
use crate::observation::write_touched;

/// Arrays by key on one piece of memory, which is reused when none of it is referenced.
struct Felt {
    moment: i64,
    memory: Py<PyAny>,
    arrays: Py<PyList>,
    dict: Py<PyDict>,
    /// Reference counts when nothing else holds a reference.
    idle: Py<PyList>,
}

impl Felt {
    /// Makes arrays of a number of rows each; a width of 0 makes vectors.
    fn new<T: Element>(
        py: Python<'_>,
        blocks: &[(Py<PyAny>, Range<usize>)],
        rows: usize,
        width: usize,
    ) -> PyResult<Self> {
        let memory = PyArray1::<T>::zeros(py, rows * width.max(1), false);
        let all = match width {
            0 => memory.clone().into_any(),
            _ => memory.reshape([rows, width])?.into_any(),
        };
        let (dict, arrays) = (PyDict::new(py), PyList::empty(py));
        for (key, range) in blocks {
            let array = all.get_item(PySlice::new(py, range.start as isize, range.end as isize, 1))?;
            dict.set_item(key, &array)?;
            arrays.append(array)?;
        }
        drop(all);
        let (memory, arrays, dict) = (memory.into_any().unbind(), arrays.unbind(), dict.unbind());
        let idle = references(py, &memory, &arrays, &dict)?.unbind();
        Ok(Self {
            moment: i64::MIN,
            memory,
            arrays,
            dict,
            idle,
        })
    }

    /// Returns whether the arrays have no other references and none was replaced.
    fn free(&self, py: Python<'_>) -> PyResult<bool> {
        let whole = self.dict.bind(py).len() == self.arrays.bind(py).len();
        Ok(whole && references(py, &self.memory, &self.arrays, &self.dict)?.eq(&self.idle)?)
    }

    /// Writes all of the memory.
    fn write<T: Element>(&self, py: Python<'_>, write: impl FnOnce(&mut [T])) -> PyResult<()> {
        let mut memory = self.memory.bind(py).cast::<PyArray1<T>>()?.readwrite();
        write(memory.as_slice_mut()?);
        Ok(())
    }
}

/// Counts references to arrays, to the memory below them and to the dictionary that has them.
fn references<'py>(
    py: Python<'py>,
    memory: &Py<PyAny>,
    arrays: &Py<PyList>,
    dict: &Py<PyDict>,
) -> PyResult<Bound<'py, PyList>> {
    static MAP: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    static COUNT: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let count = COUNT.import(py, "sys", "getrefcount")?;
    let counts = PyList::empty(py);
    let of_arrays = MAP.import(py, "builtins", "map")?.call1((count, arrays))?;
    counts.as_any().call_method1(intern!(py, "extend"), (of_arrays,))?;
    counts.append(count.call1((memory,))?)?;
    counts.append(count.call1((dict,))?)?;
    Ok(counts)
}

/// Last values of a sense: touch as arrays (sensors, 1 or 3), N, proprioception as vectors.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct Blocks {
    env: Py<Env>,
    touch: bool,
    blocks: Vec<(Py<PyAny>, Range<usize>)>,
    last: Mutex<Option<Felt>>,
}

#[pymethods]
impl Blocks {
    #[new]
    fn new(env: Py<Env>, touch: bool, blocks: Vec<(Py<PyAny>, usize, usize)>) -> Self {
        Self {
            env,
            touch,
            blocks: blocks.into_iter().map(|(key, first, end)| (key, first..end)).collect(),
            last: Mutex::default(),
        }
    }

    /// Returns what was felt last; the same arrays while `moment` stays the same.
    fn felt<'py>(&self, py: Python<'py>, moment: i64) -> PyResult<Bound<'py, PyDict>> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(felt) = last.as_ref().filter(|felt| felt.moment == moment) {
            return Ok(felt.dict.bind(py).clone());
        }
        let mut kept = last.take();
        if let Some(felt) = &kept
            && !felt.free(py)?
        {
            kept = None;
        }
        let mut guard = self.env.get().guard()?;
        let env = &guard.open()?.env;
        let mut felt = match (kept, self.touch) {
            (kept, true) => {
                let off = || PyValueError::new_err("touch is off: set touch_active to True");
                let touch = env.senses().touch_observed().ok_or_else(off)?;
                let width = touch.width();
                let fresh = || Felt::new::<f32>(py, &self.blocks, touch.values().len() / width, width);
                let felt = kept.map_or_else(fresh, Ok)?;
                felt.write::<f32>(py, |out| {
                    out.fill(0.0);
                    write_touched(out, touch);
                })?;
                felt
            }
            (kept, false) => {
                let values = env.observation().proprioception;
                let fresh = || Felt::new::<f64>(py, &self.blocks, values.len(), 0);
                let felt = kept.map_or_else(fresh, Ok)?;
                felt.write::<f64>(py, |out| out.copy_from_slice(values))?;
                felt
            }
        };
        felt.moment = moment;
        let dict = felt.dict.bind(py).clone();
        *last = Some(felt);
        Ok(dict)
    }
}
