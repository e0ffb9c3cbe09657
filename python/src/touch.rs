//! The sense of touch: positions and values of the sensors.

use babybench::sensors::Touch;
use babybench::sensors::touch::SkinBody;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{ToArray, shaped};

/// Returns for each sensing body, in the order of the observation, where its sensors are.
pub fn layout<'py>(py: Python<'py>, touch: &Touch) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let bodies = touch.layout().bodies().iter();
    bodies.map(|skin| body(py, skin)).collect()
}

fn body<'py>(py: Python<'py>, skin: &SkinBody) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("body", skin.body)?;
    dict.set_item("name", &skin.name)?;
    dict.set_item("spacing", skin.spacing)?;
    dict.set_item("offset", skin.offset)?;
    dict.set_item("positions", skin.positions().to_array(py)?)?;
    let geoms: Vec<(usize, usize, usize, usize)> = skin
        .geoms
        .iter()
        .map(|g| (g.geom, g.sensors.start, g.sensors.end, g.points))
        .collect();
    dict.set_item("geoms", geoms)?;
    Ok(dict)
}

/// Returns the values of all sensors of a body, (sensors, 1 or 3), N.
pub fn body_values<'py>(py: Python<'py>, touch: &Touch, body: usize) -> PyResult<Bound<'py, PyAny>> {
    let (values, width) = (touch.body_values(body), touch.width());
    shaped(py, values, &[values.len() / width, width])
}

/// Returns the sensors that contacts have reached, in ascending order, and their values.
pub fn touched<'py>(py: Python<'py>, touch: &Touch) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let mut sensors = touch.touched().to_vec();
    sensors.sort_unstable();
    let (width, all) = (touch.width(), touch.values());
    let mut values = Vec::with_capacity(width * sensors.len());
    for &sensor in &sensors {
        values.extend_from_slice(&all[width * sensor as usize..width * (sensor as usize + 1)]);
    }
    let ids = PyArray1::from_iter(py, sensors.iter().map(|&s| i64::from(s)));
    Ok((ids.into_any(), shaped(py, &values, &[sensors.len(), width])?))
}

/// Returns the contacts with skin, one side of a contact for each entry.
pub fn contacts<'py>(py: Python<'py>, touch: &Touch) -> PyResult<Bound<'py, PyDict>> {
    let (dict, contacts) = (PyDict::new(py), touch.contacts());
    macro_rules! columns {
        (ids: $($id:ident)*; numbers: $($number:ident)*) => {
            $(dict.set_item(stringify!($id), PyArray1::from_iter(py, contacts.iter().map(|c| c.$id as i32)))?;)*
            dict.set_item("normal", PyArray1::from_iter(py, contacts.iter().map(|c| c.normal)))?;
            $(
                let rows: Vec<_> = contacts.iter().map(|c| c.$number).collect();
                dict.set_item(stringify!($number), rows[..].to_array(py)?)?;
            )*
        };
    }
    // -1 for flexes
    let others = contacts.iter().map(|c| c.other.geom().map_or(-1, |geom| geom as i32));
    dict.set_item("other", PyArray1::from_iter(py, others))?;
    columns!(ids: contact body geom; numbers: force force_body point point_body);
    Ok(dict)
}
