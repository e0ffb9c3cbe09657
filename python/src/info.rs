//! Spaces and step information as Python objects.

use babybench::config::Part;
use babybench::env::{BehaviorInfo, EYE_HAND_PAIRS, Info};
use babybench::mimo::{LockReport, LockTarget};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Key, shape, number type, lower and upper bound.
pub type Space = (&'static str, Vec<usize>, &'static str, f64, f64);

/// Describes observation spaces.
pub fn spaces(spaces: &[babybench::spaces::ObservationSpace]) -> Vec<Space> {
    let describe = |s: &babybench::spaces::ObservationSpace| (s.key, s.shape.clone(), s.dtype.name(), s.low, s.high);
    spaces.iter().map(describe).collect()
}

/// Calls with what is to be locked or unlocked: a joint's number or name, or the name of a part.
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

/// Returns what a lock came to, with the names of joints.
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

/// Returns information under the keys of the reference, in its order, and the details, if wanted.
pub fn info_dict<'py>(py: Python<'py>, info: &Info, details: bool) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    match &info.behavior {
        BehaviorInfo::None => {}
        BehaviorInfo::SelfTouch { touches } => {
            dict.set_item(intern!(py, "right_hand_touches"), &touches.right_hand)?;
            dict.set_item(intern!(py, "left_hand_touches"), &touches.left_hand)?;
        }
        BehaviorInfo::HandRegard { counts } => {
            for (name, count) in EYE_HAND_PAIRS.iter().zip(counts.to_array()) {
                dict.set_item(*name, count)?;
            }
        }
        BehaviorInfo::Task(task) => {
            dict.set_item(intern!(py, "is_success"), task.outcome.is_success)?;
            dict.set_item(intern!(py, "is_failure"), task.outcome.is_failure)?;
            dict.set_item(intern!(py, "return"), task.episode_return)?;
        }
    }
    if details {
        if let Some(parts) = &info.details.touched_parts {
            let names = |parts: &[std::sync::Arc<str>]| parts.iter().map(|p| p.to_string()).collect::<Vec<_>>();
            dict.set_item(intern!(py, "right_hand_parts"), names(&parts.right_hand))?;
            dict.set_item(intern!(py, "left_hand_parts"), names(&parts.left_hand))?;
        }
        if let Some(angles) = info.details.gaze_angles {
            let gaze = PyDict::new(py);
            for (name, angle) in EYE_HAND_PAIRS.iter().zip(angles.to_array()) {
                gaze.set_item(*name, angle)?;
            }
            dict.set_item(intern!(py, "gaze_angles"), gaze)?;
        }
    }
    dict.set_item(intern!(py, "steps"), info.steps)?;
    Ok(dict)
}
