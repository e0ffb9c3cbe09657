//! The state of a scene: MuJoCo's `mjData`.

use babybench::physics::State;
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{ToArray, read};
use crate::model::table;

table! { ARRAYS, array, State,
    qpos qvel ctrl act act_dot actuator_target muscle_force muscle_torque qfrc_applied xfrc_applied mocap_pos mocap_quat
    qacc_warmstart
    xpos xquat xmat xipos ximat xanchor xaxis geom_xpos geom_xmat site_xpos site_xmat cam_xpos cam_xmat subtree_com
    cdof cvel qfrc_bias qfrc_passive actuator_force qfrc_actuator qfrc_smooth qacc_smooth qfrc_constraint qacc
    cacc cfrc_ext cfrc_int sensordata
}

/// The arrays that can be written.
const WRITABLE: [&str; 9] = [
    "qpos",
    "qvel",
    "ctrl",
    "act",
    "qfrc_applied",
    "xfrc_applied",
    "mocap_pos",
    "mocap_quat",
    "qacc_warmstart",
];

/// Writes an array; the next step or `forward` computes the quantities that follow from it.
pub fn write(state: &mut State, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
    let (out, width): (&mut [f64], Option<usize>) = match name {
        "qpos" => (&mut state.qpos, None),
        "qvel" => (&mut state.qvel, None),
        "ctrl" => (&mut state.ctrl, None),
        "act" => (&mut state.act, None),
        "qfrc_applied" => (&mut state.qfrc_applied, None),
        "xfrc_applied" => (state.xfrc_applied.as_flattened_mut(), Some(6)),
        "mocap_pos" => (state.mocap_pos.as_flattened_mut(), Some(3)),
        "mocap_quat" => (state.mocap_quat.as_flattened_mut(), Some(4)),
        "qacc_warmstart" => (&mut state.qacc_warmstart, None),
        _ if ARRAYS.contains(&name) => {
            return Err(PyValueError::new_err(format!(
                "{name} is computed; what can be written is {}",
                WRITABLE.join(", ")
            )));
        }
        _ => {
            return Err(PyKeyError::new_err(format!("there is no array {name:?}")));
        }
    };
    let shape = width.map_or(vec![out.len()], |width| vec![out.len() / width, width]);
    let mut new: Vec<f64> = Vec::new();
    read(name, values, &shape, &mut new)?;
    if let Some((index, value)) = new.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        return Err(PyValueError::new_err(format!(
            "{name}[{index}] is {value}, which is not finite"
        )));
    }
    out.copy_from_slice(&new);
    Ok(())
}

/// Returns the contacts at the start of the last physics step as arrays, one entry for each.
pub fn contacts<'py>(py: Python<'py>, state: &State) -> PyResult<Bound<'py, PyDict>> {
    let (dict, contacts) = (PyDict::new(py), &state.contact);
    let ids = |side: usize| PyArray1::from_iter(py, contacts.iter().map(move |c| c.geom[side] as i32));
    dict.set_item("geom1", ids(0))?;
    dict.set_item("geom2", ids(1))?;
    dict.set_item("dim", PyArray1::from_iter(py, contacts.iter().map(|c| c.dim as i32)))?;
    dict.set_item("dist", PyArray1::from_iter(py, contacts.iter().map(|c| c.dist)))?;
    let address = contacts.iter().map(|c| c.efc_address.map_or(-1, |a| a as i32));
    dict.set_item("efc_address", PyArray1::from_iter(py, address))?;
    dict.set_item(
        "includemargin",
        PyArray1::from_iter(py, contacts.iter().map(|c| c.includemargin)),
    )?;
    macro_rules! rows {
        ($($field:ident)*) => {$(
            let rows: Vec<_> = contacts.iter().map(|c| c.$field).collect();
            dict.set_item(stringify!($field), rows[..].to_array(py)?)?;
        )*};
    }
    rows!(pos frame friction solref solreffriction solimp force);
    Ok(dict)
}
