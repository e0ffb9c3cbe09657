//! MIMo's linear spread of forces, for senses with a custom touch function.

use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Sums below this do not spread.
const LEAST: f64 = 1e-10;

/// Arrays of the contacts: frames (n, 9), whose normals are inverted for bodies of first geoms, points (n, 3), distances and the bodies of
/// first geoms.
type Contacts<'py> = (
    PyReadwriteArray2<'py, f64>,
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    Vec<i64>,
);

/// Adds the force of each contact on each body, (contact, body, force), to the sensors within three times their distance: less to farther
/// ones, none beyond twice the distance. Poses are those of bodies (nbody, 3) and (nbody, 9); the dictionaries have positions (n, 3),
/// outputs (n, numbers) and distances between sensors of each body.
#[pyfunction]
pub fn spread_linear<'py>(
    sides: Vec<(usize, usize, Vec<f64>)>,
    contacts: Contacts<'py>,
    poses: (PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, f64>),
    skin: (Bound<'py, PyDict>, Bound<'py, PyDict>, Bound<'py, PyDict>),
) -> PyResult<()> {
    let (mut frames, points, distances, first) = contacts;
    let (mut frames, points, distances) = (frames.as_array_mut(), points.as_array(), distances.as_array());
    let (xpos, xmat) = (poses.0.as_array(), poses.1.as_array());
    let (positions, outputs, spacings) = skin;
    let missing = |what: &str, number: usize| PyIndexError::new_err(format!("there is no {what} {number}"));
    for (contact, body, force) in sides {
        if contact >= points.nrows() || contact >= frames.nrows() || contact >= first.len() {
            return Err(missing("contact", contact));
        }
        if body >= xpos.nrows() {
            return Err(missing("body", body));
        }
        let turned =
            |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| (0..3).map(|j| xmat[[body, 3 * j + i]] * v[j]).sum()) };
        let mut point = turned(std::array::from_fn(|k| points[[contact, k]] - xpos[[body, k]]));
        if distances[contact] < 0.0 {
            if first[contact] == body as i64 {
                (0..3).for_each(|k| frames[[contact, k]] *= -1.0);
            }
            let normal = turned(std::array::from_fn(|k| frames[[contact, k]]));
            (0..3).for_each(|k| point[k] += normal[k] * distances[contact] / 2.0);
        }
        let of = |dict: &Bound<'py, PyDict>| dict.get_item(body)?.ok_or_else(|| missing("sensing body", body));
        let spacing: f64 = of(&spacings)?.extract()?;
        let sensors = of(&positions)?.cast_into::<PyArray2<f64>>()?;
        let output = of(&outputs)?.cast_into::<PyArray2<f32>>()?;
        let (sensors, mut output) = (sensors.try_readonly()?, output.try_readwrite()?);
        add((sensors.as_slice()?, output.as_slice_mut()?), point, spacing, &force)?;
    }
    Ok(())
}

/// Adds a force at a point to the sensors of one body.
fn add((sensors, output): (&[f64], &mut [f32]), point: [f64; 3], spacing: f64, force: &[f64]) -> PyResult<()> {
    let sensors = sensors.as_chunks::<3>().0;
    if force.is_empty() || output.len() != sensors.len() * force.len() {
        return Err(PyValueError::new_err(
            "the force has another number of values than a sensor",
        ));
    }
    let weight = |sensor: &[f64; 3]| {
        let squares: f64 = sensor.iter().zip(point).map(|(s, p)| (s - p) * (s - p)).sum();
        (1.0 - squares.sqrt() / (2.0 * spacing)).max(0.0)
    };
    let total = (sensors.iter().map(|sensor| weight(sensor) * force[0]).sum::<f64>()).abs();
    let factor = if total > LEAST { (force[0] / total).abs() } else { 0.0 };
    for (sensor, felt) in sensors.iter().zip(output.chunks_exact_mut(force.len())) {
        let weight = weight(sensor);
        if weight > 0.0 {
            for (felt, force) in felt.iter_mut().zip(force) {
                *felt = (f64::from(*felt) + weight * force * factor) as f32;
            }
        }
    }
    Ok(())
}
