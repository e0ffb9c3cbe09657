//! Many environments at once, with arrays of NumPy over them.

use babybench::env::Snapshot;
use babybench::spaces::ObservationSpace;
use babybench::vector::Seeds;
use babybench::{AutoresetMode, VectorOptions};
use numpy::PyArray1;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{read, shaped};
use crate::blueprint::Blueprint;
use crate::config::to_dict;
use crate::env::UNINTERRUPTED;
use crate::errors::{IntoException, detached};
use crate::guarded::{Guard, Guarded};
use crate::info::{Space, info_dict, infos_dict, is_image, report_dict, spaces, target_of};
use crate::observation::dict_of_row;
use crate::rows::Arrays;
use crate::{model_change, task};

/// Returns a mode by its name.
fn mode_of(name: &str) -> PyResult<AutoresetMode> {
    match name {
        "next_step" => Ok(AutoresetMode::NextStep),
        "same_step" => Ok(AutoresetMode::SameStep),
        "disabled" => Ok(AutoresetMode::Disabled),
        _ => Err(PyValueError::new_err(format!(
            "autoreset is {name:?}, expected next_step, same_step or disabled"
        ))),
    }
}

/// The contents of a Python vector.
struct Inner {
    envs: babybench::VectorEnv,
    touch_width: usize,
    /// Whether observations have no images, which are drawn on request.
    lazy: bool,
    /// The spaces of the entries of observations.
    spaces: Vec<ObservationSpace>,
    /// Rows of all environments, for steps.
    all: Arrays,
    /// Rows of the environments that were received last.
    some: Option<Arrays>,
    /// Whether the last rows come from a receive.
    received: bool,
    actions: Vec<f32>,
}

/// A vector of environments.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct VectorEnv {
    inner: Guarded<Inner>,
    /// The process that the threads belong to.
    process: u32,
}

impl Drop for VectorEnv {
    /// Leaks the threads that stayed in the parent process of a fork, because they cannot be joined.
    fn drop(&mut self) {
        if std::process::id() != self.process {
            self.inner.forget();
        }
    }
}

impl VectorEnv {
    fn guard(&self) -> PyResult<Guard<'_, Inner>> {
        if std::process::id() != self.process {
            return Err(PyRuntimeError::new_err(
                "the vector was made in another process, and its threads stayed there: make vectors after the fork, or \
                 start processes with the method `spawn`",
            ));
        }
        self.inner.guard()
    }
}

#[pymethods]
impl VectorEnv {
    #[new]
    #[pyo3(signature = (blueprints, autoreset="next_step", threads=0, max_memory=None, lazy=false, copies=1))]
    fn new(
        py: Python<'_>,
        blueprints: Vec<Py<Blueprint>>,
        autoreset: &str,
        threads: usize,
        max_memory: Option<u64>,
        lazy: bool,
        copies: usize,
    ) -> PyResult<Self> {
        let options = VectorOptions {
            autoreset: mode_of(autoreset)?,
            threads,
            max_memory,
            kept_copies: copies,
        };
        let blueprints: Vec<_> = blueprints.iter().map(|b| b.get().inner.clone()).collect();
        let envs = detached(py, || babybench::VectorEnv::from_blueprints(&blueprints, options))?;
        let touch_width = envs
            .env(0)
            .ok()
            .and_then(|env| env.senses().touch())
            .map_or(0, |touch| touch.width());
        let all = envs.single_observation_space();
        let inner = Inner {
            spaces: all.iter().filter(|space| !(lazy && is_image(space))).cloned().collect(),
            all: Arrays::new(py, envs.len(), all, touch_width, lazy)?,
            touch_width,
            lazy,
            some: None,
            received: false,
            actions: Vec::new(),
            envs,
        };
        Ok(Self {
            inner: Guarded::new(inner, "vector", "one thread at a time"),
            process: std::process::id(),
        })
    }

    /// Refuses more environments than fit into memory, before any list of that length is made.
    #[staticmethod]
    fn check_memory(
        py: Python<'_>,
        blueprint: &Blueprint,
        count: usize,
        autoreset: &str,
        threads: usize,
        max_memory: Option<u64>,
        copies: usize,
    ) -> PyResult<()> {
        let options = VectorOptions {
            autoreset: mode_of(autoreset)?,
            threads,
            max_memory,
            kept_copies: copies,
        };
        let blueprint = &blueprint.inner;
        detached(py, || babybench::VectorEnv::check_memory(blueprint, count, options))
    }

    // --- life ---

    #[pyo3(signature = (seeds=None, mask=None, copy=false))]
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seeds: Option<&Bound<'py, PyAny>>,
        mask: Option<Vec<bool>>,
        copy: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let list: Option<Vec<Option<u64>>> = match seeds {
            Some(seeds) if seeds.hasattr("__len__")? => Some(seeds.extract().map_err(|_| bad_seeds(seeds))?),
            _ => None,
        };
        let seeds = match (&list, seeds) {
            (Some(list), _) => Seeds::Each(list),
            (None, Some(seed)) => Seeds::From(seed.extract().map_err(|_| bad_seeds(seed))?),
            (None, None) => Seeds::Keep,
        };
        let mut guard = self.guard()?;
        let Inner {
            envs, all, received, ..
        } = guard.open()?;
        *received = false;
        all.fill(py, |buffers| {
            detached(py, || envs.reset_into(mask.as_deref(), seeds, buffers))
        })?;
        all.observations(py, copy)
    }

    #[pyo3(signature = (actions, copy=false))]
    fn step<'py>(&self, py: Python<'py>, actions: &Bound<'py, PyAny>, copy: bool) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let shape = [inner.envs.len(), inner.envs.single_action_space().len()];
        read("actions", actions, &shape, &mut inner.actions)?;
        inner.received = false;
        let Inner { envs, all, actions, .. } = inner;
        all.fill(py, |buffers| detached(py, || envs.step_into(actions, buffers)))?;
        all.observations(py, copy)
    }

    fn run(&self, py: Python<'_>, actions: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let [n, width] = [inner.envs.len(), inner.envs.single_action_space().len()];
        read("actions", actions, &[actions.len()?, n, width], &mut inner.actions)?;
        let Inner { envs, actions, .. } = inner;
        let row = (n * width).max(1);
        for rows in actions.chunks(row * UNINTERRUPTED.div_ceil(n.max(1))) {
            detached(py, || {
                rows.chunks_exact(row)
                    .try_for_each(|batch| envs.step(batch).map(|_| ()))
            })?;
            py.check_signals()?;
        }
        Ok(())
    }

    fn send(&self, py: Python<'_>, actions: &Bound<'_, PyAny>, ids: Vec<usize>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let shape = [ids.len(), inner.envs.single_action_space().len()];
        read("actions", actions, &shape, &mut inner.actions)?;
        let Inner { envs, actions, .. } = inner;
        detached(py, || envs.send(actions, &ids))
    }

    #[pyo3(signature = (n, copy=false))]
    fn recv<'py>(&self, py: Python<'py>, n: usize, copy: bool) -> PyResult<Received<'py>> {
        let mut guard = self.guard()?;
        let Inner {
            envs,
            some,
            touch_width,
            lazy,
            received,
            ..
        } = guard.open()?;
        *received = true;
        let arrays = match some {
            Some(arrays) if arrays.rows == n => arrays,
            // a number that is too large is refused below, without an allocation
            _ => some.insert(Arrays::new(
                py,
                n.min(envs.len()),
                envs.single_observation_space(),
                *touch_width,
                *lazy,
            )?),
        };
        let ids = arrays.fill(py, |buffers| {
            detached(py, || envs.recv_into(n, buffers).map(<[usize]>::to_vec))
        })?;
        let ids = PyArray1::from_iter(py, ids.into_iter().map(|id| id as i64));
        let of = |view: &Py<PyAny>| view.bind(py).clone();
        Ok((
            arrays.observations(py, copy)?,
            of(&arrays.rewards.view),
            of(&arrays.terminated.view),
            of(&arrays.truncated.view),
            ids.into_any(),
        ))
    }

    #[pyo3(signature = (copy=false))]
    fn eyes<'py>(&self, py: Python<'py>, copy: bool) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let Inner {
            envs,
            all,
            some,
            received,
            ..
        } = guard.open()?;
        let arrays = some.as_mut().filter(|_| *received).unwrap_or(all);
        arrays.fill(py, |buffers| detached(py, || envs.look_into(buffers)))?;
        arrays.eyes(py, copy)
    }

    fn close(&self) -> PyResult<()> {
        self.guard()?.close();
        Ok(())
    }

    #[getter]
    fn closed(&self) -> PyResult<bool> {
        Ok(self.guard()?.closed())
    }

    // --- results ---

    #[getter]
    fn flags<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyAny>; 3]> {
        let mut guard = self.guard()?;
        let all = &guard.open()?.all;
        Ok([&all.rewards.view, &all.terminated.view, &all.truncated.view].map(|view| view.bind(py).clone()))
    }

    fn infos<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        infos_dict(py, guard.open()?.envs.infos())
    }

    fn failures(&self) -> PyResult<Vec<(usize, String)>> {
        let mut guard = self.guard()?;
        let failures = guard.open()?.envs.failures().iter();
        Ok(failures.map(|f| (f.env, f.error.to_string())).collect())
    }

    fn final_observations<'py>(&self, py: Python<'py>) -> PyResult<Vec<(usize, Bound<'py, PyDict>)>> {
        let mut guard = self.guard()?;
        let Inner { envs, spaces, .. } = guard.open()?;
        let (finals, ids) = (envs.finals(), envs.batch().ids);
        let ends = finals
            .iter()
            .flat_map(|f| (0..f.ended.len()).filter_map(|row| Some((row, f.row(row)?))));
        ends.map(|(row, observation)| Ok((ids[row], dict_of_row(py, &observation, spaces)?)))
            .collect()
    }

    #[pyo3(signature = (env, details=true))]
    fn info<'py>(&self, py: Python<'py>, env: usize, details: bool) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(env).map_err(IntoException::into_exception)?;
        let dict = info_dict(py, env.info(), details)?;
        task::add_terms(&dict, env, details)?;
        Ok(dict)
    }

    fn compute_reward<'py>(
        &self,
        py: Python<'py>,
        env: usize,
        achieved: &Bound<'py, PyAny>,
        desired: &Bound<'py, PyAny>,
        terms: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(env).map_err(IntoException::into_exception)?;
        task::compute_reward(py, env, [achieved, desired, terms])
    }

    #[getter]
    fn reward_terms(&self) -> PyResult<usize> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(0).map_err(IntoException::into_exception)?;
        Ok(env.goal().terms.len())
    }

    #[pyo3(signature = (env, details=true))]
    fn final_info<'py>(&self, py: Python<'py>, env: usize, details: bool) -> PyResult<Option<Bound<'py, PyDict>>> {
        let mut guard = self.guard()?;
        let envs = &guard.open()?.envs;
        let Some(info) = envs.final_info(env).map_err(IntoException::into_exception)? else {
            return Ok(None);
        };
        let dict = info_dict(py, info, details)?;
        let terms = envs.finals().and_then(|finals| finals.infos.reward_terms);
        let (ids, row) = (envs.batch().ids, envs.batch().ids.iter().position(|&id| id == env));
        if let (Some(terms), Some(row), true) = (terms, row, details) {
            let width = terms.len() / ids.len().max(1);
            task::put_terms(&dict, &terms[row * width..(row + 1) * width])?;
        }
        Ok(Some(dict))
    }

    // --- the vector ---

    #[getter]
    fn num_envs(&self) -> PyResult<usize> {
        Ok(self.guard()?.open()?.envs.len())
    }

    #[getter]
    fn threads(&self) -> PyResult<usize> {
        Ok(self.guard()?.open()?.envs.threads())
    }

    #[getter]
    fn clipped_threads(&self) -> PyResult<Option<String>> {
        Ok(self.guard()?.open()?.envs.clipped_threads().map(|c| c.to_string()))
    }

    #[getter]
    fn in_flight(&self) -> PyResult<usize> {
        Ok(self.guard()?.open()?.envs.in_flight())
    }

    #[getter]
    fn action_bounds<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray1<f32>>; 2]> {
        let mut guard = self.guard()?;
        let space = guard.open()?.envs.single_action_space();
        Ok([space.low(), space.high()].map(|bounds| PyArray1::from_slice(py, bounds)))
    }

    #[getter]
    fn observation_spaces(&self) -> PyResult<Vec<Space>> {
        Ok(spaces(&self.guard()?.open()?.spaces, false))
    }

    fn seed_action_spaces(&self, seed: u64) -> PyResult<()> {
        let seeded = self.guard()?.open()?.envs.seed_action_spaces(seed);
        seeded.map_err(IntoException::into_exception)
    }

    fn sample_actions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let Inner { envs, actions, .. } = guard.open()?;
        envs.sample_actions(actions).map_err(IntoException::into_exception)?;
        shaped(py, actions, &[envs.len(), envs.single_action_space().len()])
    }

    // --- one environment of it ---

    fn config<'py>(&self, py: Python<'py>, env: usize) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(env).map_err(IntoException::into_exception)?;
        to_dict(py, env.config())
    }

    fn snapshot<'py>(&self, py: Python<'py>, env: usize) -> PyResult<Bound<'py, PyBytes>> {
        let snapshot = self.guard()?.open()?.envs.snapshot(env);
        Ok(PyBytes::new(
            py,
            snapshot.map_err(IntoException::into_exception)?.as_bytes(),
        ))
    }

    fn restore(&self, env: usize, snapshot: &[u8]) -> PyResult<()> {
        let snapshot = Snapshot::from_bytes(snapshot.to_vec()).map_err(IntoException::into_exception)?;
        let restored = self.guard()?.open()?.envs.restore(env, &snapshot);
        restored.map_err(IntoException::into_exception)
    }

    fn model_array<'py>(&self, py: Python<'py>, env: usize, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(env).map_err(IntoException::into_exception)?;
        model_change::array(py, env, name)
    }

    #[pyo3(signature = (env, age))]
    fn set_age<'py>(&self, py: Python<'py>, env: usize, age: Option<f64>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let envs = &mut guard.open()?.envs;
        detached(py, || envs.set_age(env, age))?;
        to_dict(py, envs.env(env).map_err(IntoException::into_exception)?.config())
    }

    fn change_model(&self, env: usize, changes: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env_mut(env).map_err(IntoException::into_exception)?;
        model_change::change(env, changes)
    }

    fn model_changes<'py>(&self, py: Python<'py>, env: usize) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(env).map_err(IntoException::into_exception)?;
        model_change::changes(py, env)
    }

    #[pyo3(signature = (env, target, angle=0.0))]
    fn lock<'py>(
        &self,
        py: Python<'py>,
        env: usize,
        target: &Bound<'py, PyAny>,
        angle: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let envs = &mut guard.open()?.envs;
        let report = target_of(target, |t| {
            envs.lock(env, t, angle).map_err(IntoException::into_exception)
        })?;
        report_dict(py, envs.env(env).map_err(IntoException::into_exception)?, &report)
    }

    fn unlock<'py>(&self, py: Python<'py>, env: usize, target: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let envs = &mut guard.open()?.envs;
        let report = target_of(target, |t| envs.unlock(env, t).map_err(IntoException::into_exception))?;
        report_dict(py, envs.env(env).map_err(IntoException::into_exception)?, &report)
    }

    fn state_array<'py>(&self, py: Python<'py>, env: usize, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let env = guard.open()?.envs.env(env).map_err(IntoException::into_exception)?;
        crate::state::array(py, env.state(), name)
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        env: usize,
        camera: &str,
        width: usize,
        height: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let envs = &guard.open()?.envs;
        let env = envs.env(env).map_err(IntoException::into_exception)?;
        let picture = detached(py, || {
            let mut viewer = babybench::env::Viewer::new(env.blueprint())?;
            viewer.draw(env, camera, width, height).map(<[u8]>::to_vec)
        })?;
        shaped(py, &picture, &[height, width, 3])
    }
}

/// Observations, rewards, terminated, truncated, ids.
type Received<'py> = (
    Bound<'py, PyDict>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
);

fn bad_seeds(seeds: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!(
        "seed is {seeds}, expected None, a whole number from 0 or a list with one of them for each environment"
    ))
}
