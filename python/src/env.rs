//! One environment.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use babybench::assets::DirAssets;
use babybench::config::Part;
use babybench::env::{BehaviorInfo, EYE_HAND_PAIRS, Info, Snapshot, Viewer};
use babybench::mimo::{LockReport, LockTarget};
use babybench::render::{Poses, RenderRequest, Renderer, View};
use babybench::spaces::Dtype;
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{Pair, read, shaped};
use crate::config::{config_of, to_dict};
use crate::errors::{IntoException, detached};
use crate::observation::{Views, fresh};
use crate::{model, state, touch};

/// A compiled scene with its configuration, which environments share.
#[pyclass(frozen, weakref, module = "babybench_core._native")]
pub struct Blueprint {
    pub inner: babybench::Blueprint,
}

#[pymethods]
impl Blueprint {
    #[new]
    #[pyo3(signature = (config, assets=None))]
    fn new(py: Python<'_>, config: &Bound<'_, PyAny>, assets: Option<PathBuf>) -> PyResult<Self> {
        let config = config_of(py, config)?;
        let assets = assets.map(DirAssets::new).transpose();
        let assets = assets.map_err(IntoException::into_exception)?;
        let inner = detached(py, || match assets {
            Some(assets) => babybench::Blueprint::with_kept_assets(config, Arc::new(assets)),
            None => babybench::Blueprint::new(config),
        })?;
        Ok(Self { inner })
    }

    #[getter]
    fn config<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(py, self.inner.config())
    }

    #[getter]
    fn init_qpos<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.inner.init_qpos())
    }

    #[getter]
    fn init_qvel<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.inner.init_qvel())
    }

    #[getter]
    fn model_names<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        model::names(py, self.inner.model())
    }

    #[getter]
    fn model_options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        model::options(py, self.inner.model())
    }

    #[classattr]
    #[allow(non_snake_case)]
    fn MODEL_ARRAYS() -> Vec<&'static str> {
        model::ARRAYS.to_vec()
    }

    fn model_array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        model::array(py, self.inner.model(), name)
    }
}

/// What an environment of Python's holds.
pub struct Inner {
    pub env: babybench::Env,
    /// What it was made from, which others may share as long as it lives.
    blueprint: Py<Blueprint>,
    viewer: Option<Viewer>,
    renderer: Option<Renderer>,
    action: Vec<f32>,
    views: Option<Views>,
}

/// An environment.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct Env {
    /// Nothing, once it is closed.
    inner: Mutex<Option<Box<Inner>>>,
}

/// An environment in use.
pub struct Guard<'a>(MutexGuard<'a, Option<Box<Inner>>>);

impl Guard<'_> {
    /// Returns the environment, if it is not closed.
    pub fn open(&mut self) -> PyResult<&mut Inner> {
        let closed = "the environment is closed: make another";
        self.0.as_deref_mut().ok_or_else(|| PyRuntimeError::new_err(closed))
    }
}

impl Env {
    /// Takes the environment for a while.
    pub fn guard(&self) -> PyResult<Guard<'_>> {
        match self.inner.try_lock() {
            Ok(guard) => Ok(Guard(guard)),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "another thread is using the environment: give each thread one of its own",
            )),
            Err(TryLockError::Poisoned(_)) => Err(PyRuntimeError::new_err("the environment is broken: make another")),
        }
    }

    /// Returns the present observation.
    fn observed<'py>(py: Python<'py>, inner: &mut Inner) -> PyResult<Bound<'py, PyDict>> {
        let Some(views) = &mut inner.views else {
            return fresh(py, &inner.env);
        };
        views.update(py, &inner.env)?;
        Ok(views.dict.bind(py).clone())
    }
}

#[pymethods]
impl Env {
    #[new]
    #[pyo3(signature = (blueprint, views=false))]
    fn new(py: Python<'_>, blueprint: Py<Blueprint>, views: bool) -> PyResult<Self> {
        let shared = &blueprint.get().inner;
        let env = detached(py, || shared.env())?;
        let views = if views { Some(Views::new(py, &env)?) } else { None };
        let inner = Box::new(Inner {
            env,
            blueprint,
            viewer: None,
            renderer: None,
            action: Vec::new(),
            views,
        });
        Ok(Self {
            inner: Mutex::new(Some(inner)),
        })
    }

    // --- life ---

    #[pyo3(signature = (seed=None))]
    fn reset<'py>(&self, py: Python<'py>, seed: Option<u64>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        detached(py, || inner.env.reset(seed).map(|_| ()))?;
        Self::observed(py, inner)
    }

    fn reset_with<'py>(&self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let (rows, width) = (actions.len()?, inner.env.action_space().len());
        read("actions", actions, &[rows, width], &mut inner.action)?;
        let Inner { env, action, .. } = &mut *inner;
        detached(py, || env.reset_with(action).map(|_| ()))?;
        Self::observed(py, inner)
    }

    fn reset_to<'py>(
        &self,
        py: Python<'py>,
        qpos: &Bound<'py, PyAny>,
        qvel: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let (qpos, qvel) = positions(&inner.env, qpos, qvel)?;
        detached(py, || inner.env.reset_to(&qpos, &qvel).map(|_| ()))?;
        Self::observed(py, inner)
    }

    fn set_state<'py>(
        &self,
        py: Python<'py>,
        qpos: &Bound<'py, PyAny>,
        qvel: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let (qpos, qvel) = positions(&inner.env, qpos, qvel)?;
        detached(py, || inner.env.set_state(&qpos, &qvel).map(|_| ()))?;
        Self::observed(py, inner)
    }

    fn forward<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let (qpos, qvel) = (inner.env.state().qpos.clone(), inner.env.state().qvel.clone());
        detached(py, || inner.env.set_state(&qpos, &qvel).map(|_| ()))?;
        Self::observed(py, inner)
    }

    fn step<'py>(&self, py: Python<'py>, action: &Bound<'py, PyAny>) -> PyResult<(Bound<'py, PyDict>, bool)> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let width = inner.env.action_space().len();
        read("action", action, &[width], &mut inner.action)?;
        let Inner { env, action, .. } = &mut *inner;
        let truncated = detached(py, || env.step(action).map(|step| step.truncated))?;
        Ok((Self::observed(py, inner)?, truncated))
    }

    fn run(&self, py: Python<'_>, actions: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let width = inner.env.action_space().len();
        read("actions", actions, &[actions.len()?, width], &mut inner.action)?;
        let Inner { env, action, .. } = &mut *inner;
        detached(py, || {
            action
                .chunks_exact(width.max(1))
                .try_for_each(|action| env.step(action).map(|_| ()))
        })
    }

    fn observe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        Self::observed(py, guard.open()?)
    }

    #[pyo3(signature = (details=true))]
    fn info<'py>(&self, py: Python<'py>, details: bool) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        info_dict(py, guard.open()?.env.info(), details)
    }

    fn accumulate_info(&self, on: bool) -> PyResult<()> {
        self.guard()?.open()?.env.accumulate_info(on);
        Ok(())
    }

    fn close(&self) -> PyResult<()> {
        self.guard()?.0.take();
        Ok(())
    }

    #[getter]
    fn closed(&self) -> PyResult<bool> {
        Ok(self.guard()?.0.is_none())
    }

    #[getter]
    fn ready(&self) -> PyResult<bool> {
        Ok(self.guard()?.open()?.env.ready())
    }

    #[getter]
    fn blueprint(&self, py: Python<'_>) -> PyResult<Py<Blueprint>> {
        Ok(self.guard()?.open()?.blueprint.clone_ref(py))
    }

    // --- spaces ---

    #[getter]
    fn action_bounds<'py>(&self, py: Python<'py>) -> PyResult<Pair<'py, f32>> {
        let mut guard = self.guard()?;
        let space = guard.open()?.env.action_space();
        Ok((
            PyArray1::from_slice(py, space.low()),
            PyArray1::from_slice(py, space.high()),
        ))
    }

    #[getter]
    fn observation_spaces(&self) -> PyResult<Vec<Space>> {
        let mut guard = self.guard()?;
        Ok(spaces(&guard.open()?.env.observation_space()))
    }

    fn seed_action_space(&self, seed: u64) -> PyResult<()> {
        self.guard()?.open()?.env.seed_action_space(seed);
        Ok(())
    }

    fn sample_action<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let mut guard = self.guard()?;
        let Inner { env, action, .. } = guard.open()?;
        env.sample_action(action);
        Ok(PyArray1::from_slice(py, action))
    }

    // --- state ---

    #[classattr]
    #[allow(non_snake_case)]
    fn STATE_ARRAYS() -> Vec<&'static str> {
        state::ARRAYS.to_vec()
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.guard()?.open()?.env.state().time)
    }

    #[setter]
    fn set_time(&self, time: f64) -> PyResult<()> {
        if !time.is_finite() {
            return Err(PyValueError::new_err(format!("time is {time}, which is not finite")));
        }
        self.guard()?.open()?.env.state_mut().time = time;
        Ok(())
    }

    fn state_array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        state::array(py, self.guard()?.open()?.env.state(), name)
    }

    fn write_state(&self, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
        state::write(self.guard()?.open()?.env.state_mut(), name, values)
    }

    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::contacts(py, self.guard()?.open()?.env.state())
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let snapshot = self.guard()?.open()?.env.snapshot();
        Ok(PyBytes::new(py, snapshot.as_bytes()))
    }

    fn restore(&self, snapshot: &[u8]) -> PyResult<()> {
        let snapshot = Snapshot::from_bytes(snapshot.to_vec()).map_err(IntoException::into_exception)?;
        let restored = self.guard()?.open()?.env.restore(&snapshot);
        restored.map_err(IntoException::into_exception)
    }

    #[pyo3(signature = (target, angle=0.0))]
    fn lock<'py>(&self, py: Python<'py>, target: &Bound<'py, PyAny>, angle: f64) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = &mut guard.open()?.env;
        let report = target_of(target, |target| {
            env.lock(target, angle).map_err(IntoException::into_exception)
        })?;
        report_dict(py, env, &report)
    }

    fn unlock<'py>(&self, py: Python<'py>, target: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = &mut guard.open()?.env;
        let report = target_of(target, |target| {
            env.unlock(target).map_err(IntoException::into_exception)
        })?;
        report_dict(py, env, &report)
    }

    // --- senses ---

    #[getter]
    fn touch_width(&self) -> PyResult<usize> {
        Ok(self.guard()?.open()?.env.touch().map_or(0, |t| t.width()))
    }

    fn touch_layout<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        touch::layout(py, felt(self.guard()?.open()?)?)
    }

    fn touch_of<'py>(&self, py: Python<'py>, body: usize) -> PyResult<Bound<'py, PyAny>> {
        touch::body_values(py, felt(self.guard()?.open()?)?, body)
    }

    fn touched<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        touch::touched(py, felt(self.guard()?.open()?)?)
    }

    fn touch_contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        touch::contacts(py, felt(self.guard()?.open()?)?)
    }

    #[getter]
    fn proprioception_entries(&self) -> PyResult<Vec<(&'static str, String, usize, usize)>> {
        let mut guard = self.guard()?;
        let env = &guard.open()?.env;
        let entries = env.proprioception().entries(env.model(), env.actuation()).into_iter();
        Ok(entries
            .map(|e| (e.component.name(), e.name, e.range.start, e.range.end))
            .collect())
    }

    #[getter]
    fn gaze_angles(&self) -> PyResult<Option<[f64; 4]>> {
        Ok(self.guard()?.open()?.env.gaze_angles().map(|angles| angles.to_array()))
    }

    // --- pictures ---

    fn render<'py>(&self, py: Python<'py>, camera: &str, width: usize, height: usize) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let Inner { env, viewer, .. } = guard.open()?;
        let picture = detached(py, || -> Result<Vec<u8>, babybench::EnvError> {
            if viewer.is_none() {
                *viewer = Some(Viewer::new(env.blueprint())?);
            }
            match viewer {
                Some(viewer) => Ok(viewer.draw(env, camera, width, height)?.to_vec()),
                None => Ok(Vec::new()),
            }
        })?;
        shaped(py, &picture, &[height, width, 3])
    }

    fn depth<'py>(&self, py: Python<'py>, camera: &str, width: usize, height: usize) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let picture = draw(
            py,
            guard.open()?,
            camera,
            [width, height],
            0.0_f32,
            |r, requests, out| r.depth(requests, [out]),
        )?;
        shaped(py, &picture, &[height, width])
    }

    fn segmentation<'py>(
        &self,
        py: Python<'py>,
        camera: &str,
        width: usize,
        height: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut guard = self.guard()?;
        let picture = draw(py, guard.open()?, camera, [width, height], 0_i32, |r, requests, out| {
            r.segmentation(requests, [out])
        })?;
        shaped(py, &picture, &[height, width])
    }
}

/// Key, shape, number type, lower and upper bound.
pub type Space = (&'static str, Vec<usize>, &'static str, f64, f64);

/// Describes observation spaces.
pub fn spaces(spaces: &[babybench::spaces::ObservationSpace]) -> Vec<Space> {
    let dtype = |dtype| match dtype {
        Dtype::F64 => "float64",
        Dtype::F32 => "float32",
        Dtype::U8 => "uint8",
        Dtype::I32 => "int32",
    };
    let describe = |s: &babybench::spaces::ObservationSpace| (s.key, s.shape.clone(), dtype(s.dtype), s.low, s.high);
    spaces.iter().map(describe).collect()
}

fn positions(env: &babybench::Env, qpos: &Bound<'_, PyAny>, qvel: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<f64>)> {
    let (mut q, mut v) = (Vec::new(), Vec::new());
    read("qpos", qpos, &[env.model().nq], &mut q)?;
    read("qvel", qvel, &[env.model().nv], &mut v)?;
    Ok((q, v))
}

fn felt(inner: &Inner) -> PyResult<&babybench::sensors::Touch> {
    let off = "touch is off: set touch_active to True";
    inner.env.touch().ok_or_else(|| PyValueError::new_err(off))
}

/// A method of a renderer that draws numbers of one kind.
type Draw<T> = fn(&mut Renderer, &[RenderRequest], &mut [T]) -> Result<(), babybench::render::RenderError>;

/// Draws a picture of numbers, (height, width).
fn draw<T: Clone + Send>(
    py: Python<'_>,
    inner: &mut Inner,
    camera: &str,
    [width, height]: [usize; 2],
    zero: T,
    method: Draw<T>,
) -> PyResult<Vec<T>> {
    let Inner { env, renderer, .. } = inner;
    let camera = env.model().camera(camera).ok_or_else(|| {
        let cameras = env.model().cam_name.join(", ");
        PyKeyError::new_err(format!("there is no camera {camera:?}; there are {cameras}"))
    })?;
    detached(py, || -> Result<Vec<T>, babybench::EnvError> {
        let view = View { camera, width, height };
        view.check()?;
        let mut picture = vec![zero; view.pixels()];
        let poses = Poses::from(env.state());
        let renderer = match renderer {
            Some(renderer) => renderer,
            None => renderer.insert(env.blueprint().renderer()?),
        };
        method(renderer, &[RenderRequest { poses, view }], &mut picture)?;
        Ok(picture)
    })
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
