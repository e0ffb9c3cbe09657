//! Conversion between the library's numbers and NumPy's arrays.

use babybench::model::{BiasType, DynType, GainType, GeomType, JointType, ObjType, SameFrame, SensorType, TrnType};
use numpy::{Element, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;

/// Two vectors.
pub type Pair<'py, T> = (Bound<'py, PyArray1<T>>, Bound<'py, PyArray1<T>>);

/// Something that is an array in Python.
pub trait ToArray {
    /// Returns a fresh array.
    fn to_array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>>;
}

/// Something that is a number in Python.
trait Number: Copy {
    type Out: Element + Copy;
    fn number(self) -> Self::Out;
}

macro_rules! numbers {
    ($($type:ty => $out:ty, |$value:ident| $number:expr;)*) => {$(
        impl Number for $type {
            type Out = $out;
            fn number(self) -> $out {
                let $value = self;
                $number
            }
        }
    )*};
}

numbers! {
    f64 => f64, |v| v;
    bool => bool, |v| v;
    i32 => i32, |v| v;
    u32 => i32, |v| v as i32;
    usize => i32, |v| v as i32;
    Option<usize> => i32, |v| v.map_or(-1, |v| v as i32);
    // MuJoCo's numbers
    GeomType => i32, |v| v.code();
    JointType => i32, |v| v.code();
    BiasType => i32, |v| v.code();
    SensorType => i32, |v| v.code();
    ObjType => i32, |v| v.code();
    DynType => i32, |v| v.code();
    GainType => i32, |v| v.code();
    TrnType => i32, |v| v.code();
    SameFrame => u8, |v| v as u8;
    f32 => f32, |v| v;
}

impl<T: Number> ToArray for [T] {
    fn to_array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(PyArray1::from_iter(py, self.iter().map(|v| v.number())).into_any())
    }
}

impl<T: Number, const N: usize> ToArray for [[T; N]] {
    fn to_array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let flat = PyArray1::from_iter(py, self.iter().flatten().map(|v| v.number()));
        Ok(flat.reshape([self.len(), N])?.into_any())
    }
}

impl ToArray for [Vec<f64>] {
    /// Returns rows padded with zeros to the length of the longest.
    fn to_array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let width = self.iter().map(Vec::len).max().unwrap_or(0);
        let padded: Vec<Vec<f64>> = self
            .iter()
            .map(|row| {
                let mut row = row.clone();
                row.resize(width, 0.0);
                row
            })
            .collect();
        Ok(PyArray2::from_vec2(py, &padded)
            .map_err(|e| PyValueError::new_err(e.to_string()))?
            .into_any())
    }
}

/// Returns a fresh array of a shape; the number of values must fit.
pub fn shaped<'py, T: Element + Copy>(py: Python<'py>, values: &[T], shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_slice(py, values).reshape(shape)?.into_any())
}

/// Reads numbers of a shape from an array, or from anything that NumPy can turn into one.
pub fn read<T: Element + Copy>(
    what: &str,
    values: &Bound<'_, PyAny>,
    shape: &[usize],
    out: &mut Vec<T>,
) -> PyResult<()> {
    let array = match values.cast::<PyArrayDyn<T>>() {
        Ok(array) if values.is_exact_instance_of::<PyUntypedArray>() => array.clone(),
        _ => converted(what, values)?,
    };
    if array.shape() != shape {
        let (found, needed) = (tuple(array.shape()), tuple(shape));
        return Err(PyValueError::new_err(format!(
            "{what} has the shape {found}, but {needed} is needed"
        )));
    }
    let array = array.try_readonly()?;
    out.clear();
    match array.as_slice() {
        // rust-numpy also returns slices of arrays in Fortran's order, whose values are in another order
        Ok(values) if array.is_c_contiguous() => out.extend_from_slice(values),
        _ => out.extend(array.as_array().iter().copied()),
    }
    Ok(())
}

/// Returns an array of the values that NumPy can convert to real numbers without loss of elements.
fn converted<'py, T: Element>(what: &str, values: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let py = values.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let masked = numpy.getattr(intern!(py, "ma"))?.getattr(intern!(py, "MaskedArray"))?;
    if values.is_instance(&masked)? {
        return Err(PyTypeError::new_err(format!(
            "{what} is a masked array: fill what is masked in, with its method filled(0)"
        )));
    }
    let asarray = numpy.getattr(intern!(py, "asarray"))?;
    let array = asarray.call1((values,))?;
    let dtype = array.getattr(intern!(py, "dtype"))?;
    let kind: String = dtype.getattr(intern!(py, "kind"))?.extract()?;
    // NumPy would drop imaginary parts and field names, and count the ticks of times
    if matches!(kind.as_str(), "c" | "V" | "m" | "M") {
        return Err(PyTypeError::new_err(format!(
            "{what} has the number type {dtype}, but real numbers are needed"
        )));
    }
    Ok(asarray.call1((array, T::get_dtype(py)))?.cast_into()?)
}

/// Writes a shape in Python's notation.
fn tuple(shape: &[usize]) -> String {
    match shape {
        [n] => format!("({n},)"),
        _ => format!(
            "({})",
            shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
        ),
    }
}
