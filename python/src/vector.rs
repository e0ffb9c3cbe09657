//! Many environments at once, with arrays of NumPy over them.

use std::sync::{Mutex, MutexGuard, TryLockError};

use babybench::env::Snapshot;
use babybench::vector::{Buffers, Seeds};
use babybench::{AutoresetMode, VectorOptions};
use numpy::{PyArray1, PyReadwriteArray1};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{read, shaped};
use crate::config::to_dict;
use crate::env::{Blueprint, Space, info_dict, report_dict, spaces, target_of};
use crate::errors::{IntoException, detached};
use crate::observation::{Maps, Slab, dict_of_row};

/// Arrays over environments, which Rust writes and Python reads.
struct Arrays {
    rows: usize,
    /// Observations by key, as Python sees them.
    dict: Py<PyDict>,
    proprioception: Slab<f64>,
    touch: Option<Slab<f32>>,
    /// For each row the touch sensors that are not zero.
    touched: Vec<Vec<u32>>,
    eyes: Option<[Slab<u8>; 2]>,
    maps: Maps,
    vestibular: Option<Slab<f64>>,
    rewards: Slab<f64>,
    terminated: Slab<bool>,
    truncated: Slab<bool>,
}

impl Arrays {
    fn new(py: Python<'_>, rows: usize, spaces: &[Space]) -> PyResult<Self> {
        let shape = |key: &str| {
            let of = spaces.iter().find(|space| space.0 == key)?;
            Some([&[rows], &of.1[..]].concat())
        };
        fn slab<T: numpy::Element>(py: Python<'_>, shape: Option<Vec<usize>>) -> PyResult<Option<Slab<T>>> {
            shape.map(|shape| Slab::new(py, &shape)).transpose()
        }
        let touch = slab(py, shape("touch"))?;
        let eyes = slab(py, shape("eye_left"))?.zip(slab(py, shape("eye_right"))?);
        let dict = PyDict::new(py);
        let arrays = Self {
            rows,
            maps: Maps::new(&dict, shape)?,
            dict: dict.unbind(),
            proprioception: Slab::new(py, &shape("observation").unwrap_or_default())?,
            touched: touch.iter().flat_map(|_| vec![Vec::new(); rows]).collect(),
            touch,
            eyes: eyes.map(|(left, right)| [left, right]),
            vestibular: slab(py, shape("vestibular"))?,
            rewards: Slab::new(py, &[rows])?,
            terminated: Slab::new(py, &[rows])?,
            truncated: Slab::new(py, &[rows])?,
        };
        let dict = arrays.dict.bind(py);
        dict.set_item("observation", &arrays.proprioception.view)?;
        if let Some(touch) = &arrays.touch {
            dict.set_item("touch", &touch.view)?;
        }
        if let Some([left, right]) = &arrays.eyes {
            dict.set_item("eye_left", &left.view)?;
            dict.set_item("eye_right", &right.view)?;
        }
        if let Some(vestibular) = &arrays.vestibular {
            dict.set_item("vestibular", &vestibular.view)?;
        }
        Ok(arrays)
    }

    /// Lends all arrays to work that fills them.
    fn fill<R>(&mut self, py: Python<'_>, work: impl FnOnce(Buffers<'_>) -> PyResult<R>) -> PyResult<R> {
        let mut proprioception = self.proprioception.lend(py);
        let mut touch = self.touch.as_ref().map(|slab| slab.lend(py));
        let (left, right) = match &self.eyes {
            Some([left, right]) => (Some(left), Some(right)),
            None => (None, None),
        };
        let (mut left, mut right) = (left.map(|slab| slab.lend(py)), right.map(|slab| slab.lend(py)));
        let mut gray = lend(py, &self.maps.gray);
        let mut depth = lend(py, &self.maps.depth);
        let mut geoms = lend(py, &self.maps.segmentation);
        let mut vestibular = self.vestibular.as_ref().map(|slab| slab.lend(py));
        let mut rewards = self.rewards.lend(py);
        let (mut terminated, mut truncated) = (self.terminated.lend(py), self.truncated.lend(py));
        let touched = touch.is_some().then_some(&mut self.touched[..]);
        work(Buffers {
            proprioception: Some(proprioception.as_slice_mut()?),
            touch: slice(&mut touch)?,
            eye_left: slice(&mut left)?,
            eye_right: slice(&mut right)?,
            eye_gray: slices(&mut gray)?,
            eye_depth: slices(&mut depth)?,
            eye_segmentation: slices(&mut geoms)?,
            vestibular: slice(&mut vestibular)?,
            rewards: Some(rewards.as_slice_mut()?),
            terminated: Some(terminated.as_slice_mut()?),
            truncated: Some(truncated.as_slice_mut()?),
            touched,
        })
    }
}

fn slice<'a, T: numpy::Element>(array: &'a mut Option<PyReadwriteArray1<'_, T>>) -> PyResult<Option<&'a mut [T]>> {
    Ok(array.as_mut().map(|array| array.as_slice_mut()).transpose()?)
}

fn lend<'py, T: numpy::Element>(
    py: Python<'py>,
    slabs: &Option<[Slab<T>; 2]>,
) -> Option<[PyReadwriteArray1<'py, T>; 2]> {
    slabs.as_ref().map(|pair| pair.each_ref().map(|slab| slab.lend(py)))
}

fn slices<'a, T: numpy::Element>(
    arrays: &'a mut Option<[PyReadwriteArray1<'_, T>; 2]>,
) -> PyResult<Option<[&'a mut [T]; 2]>> {
    let Some([left, right]) = arrays else { return Ok(None) };
    Ok(Some([left.as_slice_mut()?, right.as_slice_mut()?]))
}

/// What a vector of Python's holds.
struct Inner {
    envs: babybench::VectorEnv,
    spaces: Vec<Space>,
    /// Rows of all environments, for steps.
    all: Arrays,
    /// Rows of those that were received last.
    some: Option<Arrays>,
    actions: Vec<f32>,
}

/// A vector of environments.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct VectorEnv {
    /// Nothing, once it is closed.
    inner: Mutex<Option<Box<Inner>>>,
    /// The process that the threads are in.
    process: u32,
}

impl Drop for VectorEnv {
    /// Leaves threads alone that stayed behind in the process that this one was forked from: nobody could wait for them.
    fn drop(&mut self) {
        if std::process::id() != self.process
            && let Ok(inner) = self.inner.get_mut()
        {
            std::mem::forget(inner.take());
        }
    }
}

/// A vector in use.
struct Guard<'a>(MutexGuard<'a, Option<Box<Inner>>>);

impl Guard<'_> {
    fn open(&mut self) -> PyResult<&mut Inner> {
        let closed = "the vector is closed: make another";
        self.0.as_deref_mut().ok_or_else(|| PyRuntimeError::new_err(closed))
    }
}

impl VectorEnv {
    fn guard(&self) -> PyResult<Guard<'_>> {
        if std::process::id() != self.process {
            return Err(PyRuntimeError::new_err(
                "the vector was made in another process, and its threads stayed there: make vectors after the fork, or \
                 start processes with the method `spawn`",
            ));
        }
        match self.inner.try_lock() {
            Ok(guard) => Ok(Guard(guard)),
            Err(TryLockError::WouldBlock) => {
                let text = "another thread is using the vector: one thread at a time";
                Err(PyRuntimeError::new_err(text))
            }
            Err(TryLockError::Poisoned(_)) => Err(PyRuntimeError::new_err("the vector is broken: make another")),
        }
    }
}

#[pymethods]
impl VectorEnv {
    #[new]
    #[pyo3(signature = (blueprints, autoreset="next_step", threads=0, max_memory=None))]
    fn new(
        py: Python<'_>,
        blueprints: Vec<Py<Blueprint>>,
        autoreset: &str,
        threads: usize,
        max_memory: Option<u64>,
    ) -> PyResult<Self> {
        let autoreset = match autoreset {
            "next_step" => AutoresetMode::NextStep,
            "same_step" => AutoresetMode::SameStep,
            "disabled" => AutoresetMode::Disabled,
            _ => {
                let text = format!("autoreset is {autoreset:?}, expected next_step, same_step or disabled");
                return Err(PyValueError::new_err(text));
            }
        };
        let options = VectorOptions {
            autoreset,
            threads,
            max_memory,
        };
        let blueprints: Vec<_> = blueprints.iter().map(|b| b.get().inner.clone()).collect();
        let envs = detached(py, || babybench::VectorEnv::from_blueprints(&blueprints, options))?;
        let spaces = spaces(envs.single_observation_space());
        let inner = Box::new(Inner {
            all: Arrays::new(py, envs.len(), &spaces)?,
            some: None,
            actions: Vec::new(),
            spaces,
            envs,
        });
        Ok(Self {
            inner: Mutex::new(Some(inner)),
            process: std::process::id(),
        })
    }

    // --- life ---

    #[pyo3(signature = (seeds=None, mask=None))]
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seeds: Option<&Bound<'py, PyAny>>,
        mask: Option<Vec<bool>>,
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
        let Inner { envs, all, .. } = guard.open()?;
        all.fill(py, |buffers| {
            detached(py, || envs.reset_into(mask.as_deref(), seeds, buffers))
        })?;
        Ok(all.dict.bind(py).clone())
    }

    fn step<'py>(&self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let shape = [inner.envs.len(), inner.envs.single_action_space().len()];
        read("actions", actions, &shape, &mut inner.actions)?;
        let Inner { envs, all, actions, .. } = inner;
        all.fill(py, |buffers| detached(py, || envs.step_into(actions, buffers)))?;
        Ok(all.dict.bind(py).clone())
    }

    fn run(&self, py: Python<'_>, actions: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let [n, width] = [inner.envs.len(), inner.envs.single_action_space().len()];
        read("actions", actions, &[actions.len()?, n, width], &mut inner.actions)?;
        let Inner { envs, actions, .. } = inner;
        let batches = actions.chunks_exact((n * width).max(1));
        detached(py, || {
            batches.into_iter().try_for_each(|batch| envs.step(batch).map(|_| ()))
        })
    }

    fn send(&self, py: Python<'_>, actions: &Bound<'_, PyAny>, ids: Vec<usize>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let shape = [ids.len(), inner.envs.single_action_space().len()];
        read("actions", actions, &shape, &mut inner.actions)?;
        let Inner { envs, actions, .. } = inner;
        detached(py, || envs.send(actions, &ids))
    }

    fn recv<'py>(&self, py: Python<'py>, n: usize) -> PyResult<Received<'py>> {
        let mut guard = self.guard()?;
        let Inner { envs, some, spaces, .. } = guard.open()?;
        let arrays = match some {
            Some(arrays) if arrays.rows == n => arrays,
            // more than there are is refused below, without room for them
            _ => some.insert(Arrays::new(py, n.min(envs.len()), spaces)?),
        };
        let ids = arrays.fill(py, |buffers| {
            detached(py, || envs.recv_into(n, buffers).map(<[usize]>::to_vec))
        })?;
        let ids = PyArray1::from_iter(py, ids.into_iter().map(|id| id as i64));
        let of = |view: &Py<PyAny>| view.bind(py).clone();
        Ok((
            arrays.dict.bind(py).clone(),
            of(&arrays.rewards.view),
            of(&arrays.terminated.view),
            of(&arrays.truncated.view),
            ids.into_any(),
        ))
    }

    fn close(&self) -> PyResult<()> {
        self.guard()?.0.take();
        Ok(())
    }

    #[getter]
    fn closed(&self) -> PyResult<bool> {
        Ok(self.guard()?.0.is_none())
    }

    // --- what came of it ---

    #[getter]
    fn flags<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyAny>; 3]> {
        let mut guard = self.guard()?;
        let all = &guard.open()?.all;
        Ok([&all.rewards.view, &all.terminated.view, &all.truncated.view].map(|view| view.bind(py).clone()))
    }

    fn infos<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let (dict, infos) = (PyDict::new(py), guard.open()?.envs.infos());
        let n = infos.steps.len();
        let steps = PyArray1::from_iter(py, infos.steps.iter().map(|&s| s as i64));
        dict.set_item(intern!(py, "steps"), steps)?;
        if let Some(touches) = infos.touches {
            let geoms = touches.len() / (2 * n).max(1);
            dict.set_item(intern!(py, "touches"), shaped(py, touches, &[n, 2, geoms])?)?;
        }
        if let Some(regards) = infos.regards {
            let counts: Vec<i64> = regards.iter().map(|&r| r as i64).collect();
            dict.set_item(intern!(py, "regards"), shaped(py, &counts, &[n, 4])?)?;
        }
        Ok(dict)
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
        info_dict(py, env.info(), details)
    }

    #[pyo3(signature = (env, details=true))]
    fn final_info<'py>(&self, py: Python<'py>, env: usize, details: bool) -> PyResult<Option<Bound<'py, PyDict>>> {
        let mut guard = self.guard()?;
        let info = guard
            .open()?
            .envs
            .final_info(env)
            .map_err(IntoException::into_exception)?;
        info.map(|info| info_dict(py, info, details)).transpose()
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
        Ok(self.guard()?.open()?.spaces.clone())
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
