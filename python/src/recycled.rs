//! Arrays that callers own, whose memory is reused once they have released it.

use numpy::{Element, PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

/// Number of pieces of memory kept for reuse: a program that steps holds the last observation, and often the one before.
const KEPT: usize = 3;

/// Returns Python's own count of the references to an object.
pub fn references(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    static COUNT: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    COUNT
        .import(object.py(), "sys", "getrefcount")?
        .call1((object,))?
        .extract()
}

/// Memory for arrays of one size.
pub struct Recycled<T> {
    pieces: Vec<Py<PyArray1<T>>>,
    /// Reference count of a piece when nothing else refers to it.
    idle: usize,
    /// The piece that is dropped next, if all are held.
    next: usize,
}

impl<T> Default for Recycled<T> {
    fn default() -> Self {
        Self {
            pieces: Vec::new(),
            idle: 0,
            next: 0,
        }
    }
}

impl<T: Element> Recycled<T> {
    /// Returns an unshared array of a shape, which `write` fills completely.
    pub fn array<'py>(
        &mut self,
        py: Python<'py>,
        shape: &[usize],
        write: impl FnOnce(&mut [T]),
    ) -> PyResult<Bound<'py, PyAny>> {
        let piece = self.free(py, shape.iter().product())?;
        write(piece.readwrite().as_slice_mut()?);
        Ok(piece.reshape(shape)?.into_any())
    }

    /// Returns unreferenced memory of a size. Every array that shares it references it, as NumPy's `base`.
    fn free<'py>(&mut self, py: Python<'py>, size: usize) -> PyResult<Bound<'py, PyArray1<T>>> {
        for piece in &self.pieces {
            let piece = piece.bind(py);
            if piece.len() == size && references(piece)? == self.idle {
                return Ok(piece.clone());
            }
        }
        let fresh = PyArray1::zeros(py, size, false).unbind();
        self.idle = references(fresh.bind(py))?;
        let piece = fresh.bind(py).clone();
        if self.pieces.len() < KEPT {
            self.pieces.push(fresh);
        } else {
            self.pieces[self.next] = fresh;
            self.next = (self.next + 1) % KEPT;
        }
        Ok(piece)
    }
}
