//! Arrays that Rust writes and Python reads.

use babybench::spaces::{Dtype, Values, ValuesMut};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadwriteArray1};
use pyo3::intern;
use pyo3::prelude::*;

use crate::recycled::Recycled;

/// An array that Rust writes and Python reads.
pub struct Slab<T> {
    array: Py<PyArray1<T>>,
    shape: Vec<usize>,
    /// Python's array: the same memory, in its shape, read-only.
    pub view: Py<PyAny>,
    copies: Recycled<T>,
}

impl<T: Element> Slab<T> {
    /// Creates an array of zeros, with a read-only view of a shape for Python.
    pub fn new(py: Python<'_>, shape: &[usize]) -> PyResult<Self> {
        let array = PyArray1::<T>::zeros(py, shape.iter().product::<usize>(), false);
        let view = array.call_method1(intern!(py, "reshape"), (shape,))?;
        view.getattr(intern!(py, "flags"))?
            .setattr(intern!(py, "writeable"), false)?;
        Ok(Self {
            array: array.unbind(),
            shape: shape.to_vec(),
            view: view.unbind(),
            copies: Recycled::default(),
        })
    }

    /// Lends the array for writing.
    pub fn lend<'py>(&self, py: Python<'py>) -> PyReadwriteArray1<'py, T> {
        // there is no other borrow: Python has only the view
        self.array.bind(py).readwrite()
    }

    /// Returns an array that Python owns. `write` fills all of it from this one.
    pub fn copy<'py>(&mut self, py: Python<'py>, write: impl FnOnce(&[T], &mut [T])) -> PyResult<Bound<'py, PyAny>> {
        let array = self.array.bind(py).readonly();
        let values = array.as_slice()?;
        self.copies.array(py, &self.shape, |out| write(values, out))
    }

    /// Lends the array to a function.
    pub fn write<R>(&self, py: Python<'_>, write: impl FnOnce(&mut [T]) -> R) -> PyResult<R> {
        Ok(write(self.lend(py).as_slice_mut()?))
    }
}

macro_rules! slabs {
    ($($kind:ident: $type:ty;)*) => {
        /// A [`Slab`] of a type that is known at run time.
        pub enum AnySlab {
            $($kind(Slab<$type>),)*
        }

        /// An array lent for writing.
        pub enum Lent<'py> {
            $($kind(PyReadwriteArray1<'py, $type>),)*
        }

        impl AnySlab {
            /// Creates an array of zeros, with a read-only view of a shape for Python.
            pub fn new(py: Python<'_>, dtype: Dtype, shape: &[usize]) -> PyResult<Self> {
                Ok(match dtype {
                    $(Dtype::$kind => Self::$kind(Slab::new(py, shape)?),)*
                })
            }

            /// Returns Python's array.
            pub fn view(&self) -> &Py<PyAny> {
                match self {
                    $(Self::$kind(slab) => &slab.view,)*
                }
            }

            /// Lends the array for writing.
            pub fn lend<'py>(&self, py: Python<'py>) -> Lent<'py> {
                match self {
                    $(Self::$kind(slab) => Lent::$kind(slab.lend(py)),)*
                }
            }

            /// Returns a copy that Python owns.
            pub fn copy<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                match self {
                    $(Self::$kind(slab) => slab.copy(py, |from, to| to.copy_from_slice(from)),)*
                }
            }
        }

        impl Lent<'_> {
            /// Returns the numbers.
            pub fn values_mut(&mut self) -> PyResult<ValuesMut<'_>> {
                Ok(match self {
                    $(Self::$kind(array) => ValuesMut::$kind(array.as_slice_mut()?),)*
                })
            }
        }
    };
}

slabs! {
    F64: f64;
    F32: f32;
    U8: u8;
    I32: i32;
}

impl Lent<'_> {
    /// Writes `values` into row `row`, where all rows have the length of `values`.
    pub fn write_row(mut self, row: usize, values: Values<'_>) -> PyResult<()> {
        self.values_mut()?.write_row(row, values);
        Ok(())
    }
}
