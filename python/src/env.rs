//! One environment.

use babybench::config::FacialExpression;
use babybench::env::{SecondInfant, Snapshot};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{Pair, read};
use crate::blueprint::Blueprint;
use crate::config::to_dict;
use crate::errors::{IntoException, detached};
use crate::guarded::{Guard, Guarded};
use crate::info::{Space, info_dict, report_dict, spaces, target_of};
use crate::observation::{Views, fresh, fresh_blind, fresh_images};
use crate::pictures::{self, Painters};
use crate::{model_change, state, task, touch};

/// Steps of a run between two checks for Ctrl-C: 3 ms without pictures, 60 ms with both eyes.
pub const UNINTERRUPTED: usize = 64;

/// The contents of a Python environment.
pub struct Inner {
    pub env: babybench::Env,
    /// Its blueprint, which other environments may share during its life.
    blueprint: Py<Blueprint>,
    pub painters: Painters,
    pub action: Vec<f32>,
    views: Option<Views>,
    /// The second infant in the scene, and his sensations.
    second: Option<SecondInfant>,
    felt: Vec<f64>,
    /// Whether observations have no images, which are drawn on request.
    lazy: bool,
}

/// An environment.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct Env {
    inner: Guarded<Inner>,
}

impl Env {
    /// Locks the environment for exclusive use.
    pub fn guard(&self) -> PyResult<Guard<'_, Inner>> {
        self.inner.guard()
    }

    /// Moves the scene to positions and velocities, and returns the observation.
    fn placed<'py>(
        &self,
        py: Python<'py>,
        [qpos, qvel]: [&Bound<'py, PyAny>; 2],
        work: impl FnOnce(&mut babybench::Env, &[f64], &[f64]) -> Result<(), babybench::EnvError> + Send,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let (mut q, mut v) = (Vec::new(), Vec::new());
        read("qpos", qpos, &[inner.env.model().nq], &mut q)?;
        read("qvel", qvel, &[inner.env.model().nv], &mut v)?;
        detached(py, || work(&mut inner.env, &q, &v))?;
        Self::observed(py, inner)
    }

    /// Recreates everything that was made from the earlier body.
    fn remade(py: Python<'_>, inner: &mut Inner) -> PyResult<()> {
        inner.painters = Painters::default();
        inner.second = inner.env.blueprint().second_infant();
        inner.blueprint = Py::new(
            py,
            Blueprint {
                inner: inner.env.blueprint().clone(),
            },
        )?;
        if inner.views.is_some() {
            inner.views = Some(Views::new(py, &inner.env, inner.lazy)?);
        }
        Ok(())
    }

    /// Runs an operation that may make a MIMo with a schedule of ages grow.
    fn growing<E: IntoException + Send>(
        py: Python<'_>,
        inner: &mut Inner,
        work: impl FnOnce(&mut babybench::Env) -> Result<(), E> + Send,
    ) -> PyResult<()> {
        let before = inner.env.config().age;
        detached(py, || work(&mut inner.env))?;
        if inner.env.config().age == before {
            return Ok(());
        }
        Self::remade(py, inner)
    }

    /// Returns the current observation.
    pub fn observed<'py>(py: Python<'py>, inner: &mut Inner) -> PyResult<Bound<'py, PyDict>> {
        if inner.lazy && inner.views.is_none() {
            return fresh_blind(py, &inner.env);
        }
        if !inner.lazy && inner.env.senses().vision_is_lazy() {
            detached(py, || inner.env.senses_mut().look().map(drop))?;
        }
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
    #[pyo3(signature = (blueprint, views=false, lazy=false))]
    fn new(py: Python<'_>, blueprint: Py<Blueprint>, views: bool, lazy: bool) -> PyResult<Self> {
        let shared = &blueprint.get().inner;
        let env = detached(py, || shared.env())?;
        let views = if views { Some(Views::new(py, &env, lazy)?) } else { None };
        let inner = Inner {
            second: env.blueprint().second_infant(),
            felt: Vec::new(),
            env,
            blueprint,
            painters: Painters::default(),
            action: Vec::new(),
            views,
            lazy,
        };
        Ok(Self {
            inner: Guarded::new(inner, "environment", "give each thread one of its own"),
        })
    }

    // --- life ---

    #[pyo3(signature = (seed=None))]
    fn reset<'py>(&self, py: Python<'py>, seed: Option<u64>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        Self::growing(py, inner, |env| env.reset(seed).map(drop))?;
        Self::observed(py, inner)
    }

    fn reset_with<'py>(&self, py: Python<'py>, actions: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let (rows, width) = (actions.len()?, inner.env.action_space().len());
        read("actions", actions, &[rows, width], &mut inner.action)?;
        let action = std::mem::take(&mut inner.action);
        Self::growing(py, inner, |env| env.by_hand().reset_with(&action).map(drop))?;
        inner.action = action;
        Self::observed(py, inner)
    }

    fn reset_to<'py>(
        &self,
        py: Python<'py>,
        qpos: &Bound<'py, PyAny>,
        qvel: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        self.placed(py, [qpos, qvel], |env, qpos, qvel| {
            env.by_hand().reset_to(qpos, qvel).map(drop)
        })
    }

    fn set_state<'py>(
        &self,
        py: Python<'py>,
        qpos: &Bound<'py, PyAny>,
        qvel: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        self.placed(py, [qpos, qvel], |env, qpos, qvel| {
            env.by_hand().set_state(qpos, qvel).map(drop)
        })
    }

    fn set_mocap(&self, body: &str, pos: [f64; 3], quat: [f64; 4]) -> PyResult<()> {
        let mut guard = self.guard()?;
        let put = guard.open()?.env.by_hand().set_mocap(body, pos, quat);
        put.map_err(IntoException::into_exception)
    }

    fn refresh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        detached(py, || inner.env.by_hand().refresh().map(drop))?;
        Self::observed(py, inner)
    }

    fn step<'py>(
        &self,
        py: Python<'py>,
        action: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyDict>, f64, bool, bool)> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let width = inner.env.action_space().len();
        read("action", action, &[width], &mut inner.action)?;
        let Inner { env, action, .. } = &mut *inner;
        let (reward, terminated, truncated) = detached(py, || {
            env.step(action)
                .map(|step| (step.reward, step.terminated, step.truncated))
        })?;
        Ok((Self::observed(py, inner)?, reward, terminated, truncated))
    }

    fn run(&self, py: Python<'_>, actions: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let width = inner.env.action_space().len();
        read("actions", actions, &[actions.len()?, width], &mut inner.action)?;
        let Inner { env, action, .. } = &mut *inner;
        for batch in action.chunks(width.max(1) * UNINTERRUPTED) {
            detached(py, || {
                batch
                    .chunks_exact(width.max(1))
                    .try_for_each(|action| env.step(action).map(|_| ()))
            })?;
            py.check_signals()?;
        }
        Ok(())
    }

    fn observation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        Self::observed(py, guard.open()?)
    }

    fn eyes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        detached(py, || inner.env.senses_mut().look().map(drop))?;
        let Some(views) = inner.views.as_mut().filter(|_| inner.lazy) else {
            return fresh_images(py, &inner.env);
        };
        views.update(py, &inner.env)?;
        Ok(views.images.bind(py).clone())
    }

    #[pyo3(signature = (details=true))]
    fn info<'py>(&self, py: Python<'py>, details: bool) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = &guard.open()?.env;
        let dict = info_dict(py, env.info(), details)?;
        task::add_terms(&dict, env, details)?;
        Ok(dict)
    }

    fn set_goal<'py>(&self, py: Python<'py>, desired: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        task::set_goal(&mut inner.env, desired)?;
        Self::observed(py, inner)
    }

    fn compute_reward<'py>(
        &self,
        py: Python<'py>,
        achieved: &Bound<'py, PyAny>,
        desired: &Bound<'py, PyAny>,
        terms: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        task::compute_reward(py, &self.guard()?.open()?.env, [achieved, desired, terms])
    }

    // --- second infant ---

    /// Returns the bounds of its action and the length of its observation, if there is one.
    fn second_spaces<'py>(&self, py: Python<'py>) -> PyResult<Option<(Pair<'py, f32>, usize)>> {
        let mut guard = self.guard()?;
        let second = guard.open()?.second.as_ref();
        Ok(second.map(|second| {
            let space = second.action_space();
            let bound = |side: &[f32]| PyArray1::from_slice(py, side);
            ((bound(space.low()), bound(space.high())), second.observation_len())
        }))
    }

    fn act_second(&self, action: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        let second = inner.second.as_ref().ok_or_else(no_second)?;
        read("action", action, &[second.actuators().len()], &mut inner.action)?;
        second
            .act(&mut inner.env, &inner.action)
            .map_err(IntoException::into_exception)
    }

    fn observe_second<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut guard = self.guard()?;
        let Inner { env, second, felt, .. } = guard.open()?;
        let second = second.as_ref().ok_or_else(no_second)?;
        second
            .observe(env.state(), felt)
            .map_err(|error| babybench::EnvError::from(error).into_exception())?;
        Ok(PyArray1::from_slice(py, felt))
    }

    #[getter]
    fn reward_terms(&self) -> PyResult<usize> {
        Ok(self.guard()?.open()?.env.goal().terms.len())
    }

    fn accumulate_info(&self, on: bool) -> PyResult<()> {
        self.guard()?.open()?.env.by_hand().accumulate_info(on);
        Ok(())
    }

    fn close(&self) -> PyResult<()> {
        self.guard()?.close();
        Ok(())
    }

    #[getter]
    fn closed(&self) -> PyResult<bool> {
        Ok(self.guard()?.closed())
    }

    #[getter]
    fn ready(&self) -> PyResult<bool> {
        Ok(self.guard()?.open()?.env.by_hand().ready())
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
        let inner = guard.open()?;
        Ok(spaces(&inner.env.observation_space(), inner.lazy))
    }

    fn seed_action_space(&self, seed: u64) -> PyResult<()> {
        self.guard()?.open()?.env.by_hand().seed_action_space(seed);
        Ok(())
    }

    fn draw_from(&self, drawn: u64) -> PyResult<()> {
        self.guard()?.open()?.env.by_hand().draw_from(drawn);
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

    /// Replaces the force and the torque that act on a body.
    #[pyo3(signature = (body, force, torque, point=None))]
    fn push(&self, body: usize, force: [f64; 3], torque: [f64; 3], point: Option<[f64; 3]>) -> PyResult<()> {
        let mut guard = self.guard()?;
        let state = guard.open()?.env.state_mut();
        let before = state.xfrc_applied.get(body).copied();
        if let Some(applied) = state.xfrc_applied.get_mut(body) {
            *applied = [0.0; 6];
        }
        let point = point.or_else(|| state.xipos.get(body).copied()).unwrap_or_default();
        let applied = state.apply_force(body, force, torque, point);
        if let (Err(_), Some(before)) = (&applied, before) {
            state.xfrc_applied[body] = before;
        }
        applied.map_err(|e| babybench::EnvError::from(e).into_exception())
    }

    fn apply_force(&self, body: usize, force: [f64; 3], point: [f64; 3]) -> PyResult<()> {
        let mut guard = self.guard()?;
        let applied = guard.open()?.env.state_mut().apply_force(body, force, [0.0; 3], point);
        applied.map_err(|e| babybench::EnvError::from(e).into_exception())
    }

    fn release_forces(&self) -> PyResult<()> {
        self.guard()?.open()?.env.state_mut().release_forces();
        Ok(())
    }

    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::contacts(py, self.guard()?.open()?.env.state())
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let snapshot = self.guard()?.open()?.env.snapshot();
        Ok(PyBytes::new(py, snapshot.as_bytes()))
    }

    fn restore(&self, py: Python<'_>, snapshot: &[u8]) -> PyResult<()> {
        let snapshot = Snapshot::from_bytes(snapshot.to_vec()).map_err(IntoException::into_exception)?;
        let mut guard = self.guard()?;
        Self::growing(py, guard.open()?, |env| env.restore(&snapshot))
    }

    fn resume<'py>(&self, py: Python<'py>, snapshot: &[u8]) -> PyResult<Bound<'py, PyDict>> {
        let snapshot = Snapshot::from_bytes(snapshot.to_vec()).map_err(IntoException::into_exception)?;
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        Self::growing(py, inner, |env| env.by_hand().resume(&snapshot).map(drop))?;
        Self::observed(py, inner)
    }

    fn swap_facial_expression(&self, py: Python<'_>, expression: &str) -> PyResult<()> {
        let face = FacialExpression::from_name(expression).ok_or_else(|| {
            let known = FacialExpression::NAMES.join(", ");
            PyValueError::new_err(format!("there is no face {expression:?}; there are {known}"))
        })?;
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        detached(py, || inner.env.mimo_mut().swap_facial_expression(face))?;
        // the earlier ones would continue to draw the old one
        inner.painters = Painters::default();
        inner.blueprint = Py::new(
            py,
            Blueprint {
                inner: inner.env.blueprint().clone(),
            },
        )?;
        Ok(())
    }

    #[pyo3(signature = (age))]
    fn set_age<'py>(&self, py: Python<'py>, age: Option<f64>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let inner = guard.open()?;
        detached(py, || inner.env.mimo_mut().set_age(age))?;
        Self::remade(py, inner)?;
        to_dict(py, inner.env.config())
    }

    #[getter]
    fn age(&self) -> PyResult<Option<f64>> {
        Ok(self.guard()?.open()?.env.config().age)
    }

    fn model_array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        model_change::array(py, &self.guard()?.open()?.env, name)
    }

    fn change_model(&self, changes: &Bound<'_, PyDict>) -> PyResult<()> {
        model_change::change(&mut self.guard()?.open()?.env, changes)
    }

    #[getter]
    fn model_changes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        model_change::changes(py, &self.guard()?.open()?.env)
    }

    #[getter]
    fn dt(&self) -> PyResult<f64> {
        Ok(self.guard()?.open()?.env.blueprint().dt())
    }

    #[pyo3(signature = (target, angle=0.0))]
    fn lock<'py>(&self, py: Python<'py>, target: &Bound<'py, PyAny>, angle: f64) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = &mut guard.open()?.env;
        let report = target_of(target, |target| {
            env.mimo_mut()
                .lock(target, angle)
                .map_err(IntoException::into_exception)
        })?;
        report_dict(py, env, &report)
    }

    fn unlock<'py>(&self, py: Python<'py>, target: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut guard = self.guard()?;
        let env = &mut guard.open()?.env;
        let report = target_of(target, |target| {
            env.mimo_mut().unlock(target).map_err(IntoException::into_exception)
        })?;
        report_dict(py, env, &report)
    }

    // --- senses ---

    #[getter]
    fn touch_width(&self) -> PyResult<usize> {
        Ok(self.guard()?.open()?.env.senses().touch().map_or(0, |t| t.width()))
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
    fn reflexes(&self) -> PyResult<Vec<&'static str>> {
        let mut guard = self.guard()?;
        Ok(guard.open()?.env.reflexes().map(|reflex| reflex.name()).collect())
    }

    #[getter]
    fn proprioception_entries(&self) -> PyResult<Vec<(&'static str, String, usize, usize)>> {
        let mut guard = self.guard()?;
        let env = &guard.open()?.env;
        let entries = env
            .senses()
            .proprioception()
            .entries(env.model(), env.blueprint().actuation())
            .into_iter();
        Ok(entries
            .map(|e| (e.component.name(), e.name, e.range.start, e.range.end))
            .collect())
    }

    // --- pictures ---

    fn render<'py>(
        &self,
        py: Python<'py>,
        camera: pictures::Camera,
        width: usize,
        height: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        pictures::colour(py, self.guard()?.open()?, &camera, [width, height])
    }

    fn depth<'py>(
        &self,
        py: Python<'py>,
        camera: pictures::Camera,
        width: usize,
        height: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        pictures::depth(py, self.guard()?.open()?, &camera, [width, height])
    }

    fn segmentation<'py>(
        &self,
        py: Python<'py>,
        camera: pictures::Camera,
        width: usize,
        height: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        pictures::segmentation(py, self.guard()?.open()?, &camera, [width, height])
    }
}

/// Returns the error that the scene has no second infant.
fn no_second() -> PyErr {
    PyValueError::new_err("the scene has no second infant: see the guide's chapter on rooms")
}

fn felt(inner: &Inner) -> PyResult<&babybench::sensors::Touch> {
    let off = "touch is off: set touch_active to True";
    inner.env.senses().touch().ok_or_else(|| PyValueError::new_err(off))
}
