//! Spaces and step information as Python objects.

use babybench::config::Part;
use babybench::env::{EYE_HAND_PAIRS, Info, InfoValue};
use babybench::mimo::{LockReport, LockTarget};
use babybench::sensors::ObservationEntry;
use babybench::spaces::ObservationSpace;
use babybench::vector::Infos;
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};

use crate::arrays::shaped;

/// Key, shape, number type, lower and upper bound.
pub type Space = (&'static str, Vec<usize>, &'static str, f64, f64);

/// Describes observation spaces, without images if they are drawn on request.
pub fn spaces(spaces: &[ObservationSpace], lazy: bool) -> Vec<Space> {
    let describe = |s: &ObservationSpace| (s.key, s.shape.clone(), s.dtype.name(), s.low, s.high);
    spaces.iter().filter(|s| !(lazy && is_image(s))).map(describe).collect()
}

/// Returns whether a space is that of images.
pub fn is_image(space: &ObservationSpace) -> bool {
    ObservationEntry::of_key(space.key).is_some_and(|entry| entry.image.is_some())
}

/// Calls a function with the target of a lock: a joint's number or name, or the name of a part.
pub fn target_of<R>(target: &Bound<'_, PyAny>, call: impl FnOnce(LockTarget<'_>) -> PyResult<R>) -> PyResult<R> {
    if let Ok(joint) = target.extract::<usize>() {
        return call(LockTarget::Joint(joint));
    }
    let Ok(name) = target.extract::<String>() else {
        return Err(PyTypeError::new_err(format!(
            "{target} is neither the name nor the number of a joint, nor the name of a part"
        )));
    };
    match Part::ALL.into_iter().find(|part| part.name() == name) {
        Some(part) => call(LockTarget::Part(part)),
        None => call(LockTarget::Name(&name)),
    }
}

/// Returns the result of a lock, with the names of joints.
pub fn report_dict<'py>(py: Python<'py>, env: &babybench::Env, report: &LockReport) -> PyResult<Bound<'py, PyDict>> {
    let name = |joint: &usize| env.model().jnt_name[*joint].clone();
    let dict = PyDict::new(py);
    dict.set_item("changed", report.changed.iter().map(name).collect::<Vec<_>>())?;
    dict.set_item(
        "held",
        report.held.iter().map(|(joint, _)| name(joint)).collect::<Vec<_>>(),
    )?;
    let beyond: Vec<_> = report.beyond_limits.iter().map(name).collect();
    dict.set_item("beyond_limits", beyond)?;
    Ok(dict)
}

/// Returns information under the reference's keys, in its order, and the details if requested.
pub fn info_dict<'py>(py: Python<'py>, info: &Info, details: bool) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in info.fields(details.then_some(&info.details)) {
        let key = PyString::intern(py, key);
        match value {
            InfoValue::Count(count) => dict.set_item(key, count)?,
            InfoValue::Geoms(geoms) => dict.set_item(key, geoms)?,
            InfoValue::Name(name) => dict.set_item(key, name)?,
            InfoValue::Flag(flag) => dict.set_item(key, flag)?,
            InfoValue::Number(number) => dict.set_item(key, number)?,
            InfoValue::Parts(names) => dict.set_item(key, PyList::new(py, names.iter().map(|name| &**name))?)?,
            InfoValue::Angles(angles) => {
                let gaze = PyDict::new(py);
                for (name, angle) in EYE_HAND_PAIRS.iter().zip(angles.to_array()) {
                    gaze.set_item(*name, angle)?;
                }
                dict.set_item(key, gaze)?;
            }
            InfoValue::Counts(counts) => {
                let regards = PyDict::new(py);
                for (name, count) in EYE_HAND_PAIRS.iter().zip(counts.to_array()) {
                    regards.set_item(*name, count)?;
                }
                dict.set_item(key, regards)?;
            }
            _ => {}
        }
    }
    Ok(dict)
}

/// Returns the information of all environments of a vector, as arrays with one entry for each environment.
pub fn infos_dict<'py>(py: Python<'py>, infos: Infos<'_>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let n = infos.steps.len();
    let steps = PyArray1::from_iter(py, infos.steps.iter().map(|&s| s as i64));
    dict.set_item(intern!(py, "steps"), steps)?;
    if let Some(touches) = infos.touches {
        let geoms = touches.len() / (2 * n).max(1);
        dict.set_item(intern!(py, "touches"), shaped(py, touches, &[n, 2, geoms])?)?;
    }
    for (key, regards) in [
        (intern!(py, "regards"), infos.regards),
        (intern!(py, "page_regards"), infos.page_regards),
        (intern!(py, "kit_regards"), infos.kit_regards),
    ] {
        if let Some(regards) = regards {
            let counts: Vec<i64> = regards.iter().map(|&r| r as i64).collect();
            dict.set_item(key, shaped(py, &counts, &[n, 4])?)?;
        }
    }
    if let Some(ages) = infos.vision_age {
        dict.set_item(intern!(py, "vision_age"), PyArray1::from_slice(py, ages))?;
    }
    if let Some(ages) = infos.age {
        dict.set_item(intern!(py, "age"), PyArray1::from_slice(py, ages))?;
    }
    if let Some(shares) = infos.reflexes {
        let columns = infos.reflex_names.len();
        for (column, reflex) in infos.reflex_names.iter().enumerate() {
            let column = shares.iter().skip(column).step_by(columns);
            dict.set_item(format!("reflex_{reflex}"), PyArray1::from_iter(py, column.copied()))?;
        }
    }
    if let (Some(outcomes), Some(terms)) = (infos.outcomes, infos.reward_terms) {
        let success = PyArray1::from_iter(py, outcomes.iter().map(|o| o.is_success));
        let failure = PyArray1::from_iter(py, outcomes.iter().map(|o| o.is_failure));
        dict.set_item(intern!(py, "is_success"), success)?;
        dict.set_item(intern!(py, "is_failure"), failure)?;
        let shape = [n, terms.len() / n.max(1)];
        dict.set_item(intern!(py, "reward_terms"), shaped(py, terms, &shape)?)?;
    }
    Ok(dict)
}
