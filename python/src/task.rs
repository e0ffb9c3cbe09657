//! Goals and rewards of tasks.

use babybench::Env;
use babybench::env::Goal;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::read;
use crate::errors::IntoException;

/// Adds the terms of a task's reward to its information.
pub fn add_terms(dict: &Bound<'_, PyDict>, env: &Env, details: bool) -> PyResult<()> {
    if details && env.info().behavior.task().is_some() {
        put_terms(dict, env.goal().terms)
    } else {
        Ok(())
    }
}

/// Adds terms of a reward to information.
pub fn put_terms(dict: &Bound<'_, PyDict>, terms: &[f64]) -> PyResult<()> {
    let py = dict.py();
    dict.set_item(intern!(py, "reward_terms"), PyArray1::from_slice(py, terms))
}

/// Changes the desired goal.
pub fn set_goal(env: &mut Env, desired: &Bound<'_, PyAny>) -> PyResult<()> {
    let mut goal = Vec::new();
    read("desired_goal", desired, &[env.goal().desired.len()], &mut goal)?;
    env.by_hand().set_goal(&goal).map_err(IntoException::into_exception)
}

/// Computes the reward of each row of achieved goals, desired goals and terms.
pub fn compute_reward<'py>(
    py: Python<'py>,
    env: &Env,
    arrays: [&Bound<'py, PyAny>; 3],
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let now = env.goal();
    let rows = arrays[0].len()?;
    let mut numbers = [Vec::new(), Vec::new(), Vec::new()];
    let expected = [
        ("achieved_goal", now.achieved.len()),
        ("desired_goal", now.desired.len()),
        ("reward_terms", now.terms.len()),
    ];
    for (((name, width), array), numbers) in expected.into_iter().zip(arrays).zip(&mut numbers) {
        read(name, array, &[rows, width], numbers)?;
    }
    let [achieved, desired, terms] = &numbers;
    let mut rewards = vec![0.0; rows];
    let goals = Goal {
        achieved,
        desired,
        terms,
    };
    env.blueprint()
        .compute_reward(goals, &mut rewards)
        .map_err(|e| PyValueError::new_err(e.to_string()))?;
    Ok(PyArray1::from_vec(py, rewards))
}
