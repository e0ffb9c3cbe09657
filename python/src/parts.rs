//! The parts of a reset and of a step, for environments that combine them as the Python kit does.

use std::sync::{Mutex, MutexGuard, PoisonError};

use babybench::physics::State;
use numpy::{PyArray1, PyReadonlyArrayDyn, PyReadwriteArray1, PyReadwriteArrayDyn};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::read;
use crate::env::Env;
use crate::errors::detached;
use crate::observation::sparse;

/// The memory of [`Parts`] between calls.
#[derive(Default)]
struct Memory {
    action: Vec<f32>,
    qpos: Vec<f64>,
    qvel: Vec<f64>,
    /// Positions and velocities at the start of the last physics step, to which all computed quantities belong.
    start: (Vec<f64>, Vec<f64>),
}

/// The parts of an environment's reset and step.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct Parts {
    env: Py<Env>,
    memory: Mutex<Memory>,
}

impl Parts {
    fn memory(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls a function with the environment.
    fn with<R>(&self, work: impl FnOnce(&mut babybench::Env, &mut Memory) -> PyResult<R>) -> PyResult<R> {
        let mut guard = self.env.get().guard()?;
        work(&mut guard.open()?.env, &mut self.memory())
    }

    fn place(
        &self,
        py: Python<'_>,
        [qpos, qvel]: [&Bound<'_, PyAny>; 2],
        work: impl FnOnce(&mut babybench::Env, &[f64], &[f64]) -> Result<(), babybench::EnvError> + Send,
    ) -> PyResult<()> {
        self.with(|env, m| {
            read("qpos", qpos, &[env.model().nq], &mut m.qpos)?;
            read("qvel", qvel, &[env.model().nv], &mut m.qvel)?;
            detached(py, || work(env, &m.qpos, &m.qvel))?;
            m.note_start(env.state());
            Ok(())
        })
    }
}

impl Memory {
    fn note_start(&mut self, state: &State) {
        self.start.0.clone_from(&state.qpos);
        self.start.1.clone_from(&state.qvel);
    }
}

#[pymethods]
impl Parts {
    #[new]
    fn new(env: Py<Env>) -> PyResult<Self> {
        let parts = Self {
            env,
            memory: Mutex::default(),
        };
        parts.with(|env, m| {
            m.note_start(env.state());
            Ok(())
        })?;
        Ok(parts)
    }

    fn reset_data(&self) -> PyResult<()> {
        self.with(|env, m| {
            env.by_hand().reset_data();
            m.note_start(env.state());
            Ok(())
        })
    }

    fn forward(&self, py: Python<'_>, qpos: &Bound<'_, PyAny>, qvel: &Bound<'_, PyAny>) -> PyResult<()> {
        self.place(py, [qpos, qvel], |env, qpos, qvel| env.by_hand().forward(qpos, qvel))
    }

    fn set_position(&self, py: Python<'_>, qpos: &Bound<'_, PyAny>, qvel: &Bound<'_, PyAny>) -> PyResult<()> {
        self.place(py, [qpos, qvel], |env, qpos, qvel| {
            env.by_hand().set_position(qpos, qvel)
        })
    }

    fn set_action(&self, action: &Bound<'_, PyAny>) -> PyResult<()> {
        self.with(|env, m| {
            read("action", action, &[env.action_space().len()], &mut m.action)?;
            env.by_hand()
                .set_action(&m.action)
                .map_err(crate::errors::IntoException::into_exception)
        })
    }

    fn substep(&self) -> PyResult<()> {
        self.with(|env, _| {
            env.by_hand().substep();
            Ok(())
        })
    }

    fn physics_step(&self, py: Python<'_>) -> PyResult<()> {
        self.with(|env, m| {
            m.note_start(env.state());
            detached(py, || env.by_hand().physics_step())
        })
    }

    fn observe(&self, py: Python<'_>) -> PyResult<()> {
        self.with(|env, _| detached(py, || env.by_hand().observe()))
    }

    fn track(&self) -> PyResult<()> {
        self.with(|env, _| {
            env.by_hand().track();
            Ok(())
        })
    }

    fn clear_info(&self) -> PyResult<()> {
        self.with(|env, _| {
            env.by_hand().clear_info();
            Ok(())
        })
    }

    /// Returns the geoms that each palm has touched, after the first ones.
    fn touches(&self, right: usize, left: usize) -> PyResult<Option<(Vec<usize>, Vec<usize>)>> {
        self.with(|env, _| {
            let beyond = |geoms: &[usize], known: usize| geoms.get(known..).unwrap_or_default().to_vec();
            let touches = env.info().behavior.touches();
            Ok(touches.map(|[r, l]| (beyond(r, right), beyond(l, left))))
        })
    }

    #[getter]
    fn regards(&self) -> PyResult<Option<[u64; 4]>> {
        self.with(|env, _| Ok(env.info().behavior.regards()))
    }

    #[getter]
    fn cost(&self) -> PyResult<f64> {
        self.with(|env, _| Ok(env.blueprint().actuation().cost(env.model(), env.state())))
    }

    #[getter]
    fn gear<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.with(|env, _| Ok(PyArray1::from_slice(py, env.state().reference_gear())))
    }

    /// Returns the proprioception of the last observation.
    #[getter]
    fn proprioception<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.with(|env, _| Ok(PyArray1::from_slice(py, env.observation().proprioception)))
    }

    /// Returns the touch of the last observation.
    #[getter]
    fn touch<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f32>>>> {
        self.with(|env, _| env.senses().touch_observed().map(|touch| sparse(py, touch)).transpose())
    }

    /// Returns which equality constraints are active after a reset.
    #[getter]
    fn eq_active0<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u8>>> {
        let params = |env: &mut babybench::Env| env.blueprint().params().eq_active.clone();
        self.with(|env, _| Ok(PyArray1::from_iter(py, params(env).into_iter().map(u8::from))))
    }

    /// Returns the force of each constraint row.
    #[getter]
    fn efc_force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.with(|env, _| Ok(PyArray1::from_iter(py, env.state().efc_rows().map(|row| row.force))))
    }

    /// Writes the state into arrays of the same lengths, in the order of `FILLED`.
    fn fill(&self, mut arrays: Vec<PyReadwriteArrayDyn<'_, f64>>) -> PyResult<()> {
        self.with(|env, _| fill(env.state(), &mut arrays))
    }

    /// Writes which equality constraints are active, and the positions and velocities to which all computed quantities belong.
    fn fill_start(
        &self,
        mut eq_active: PyReadwriteArray1<'_, u8>,
        mut position: [PyReadwriteArrayDyn<'_, f64>; 2],
    ) -> PyResult<()> {
        self.with(|env, m| {
            let active = &env.state().params.eq_active;
            for (out, &on) in eq_active.as_slice_mut()?.iter_mut().zip(active) {
                *out = u8::from(on);
            }
            let [qpos, qvel] = &mut position;
            write("qpos", &m.start.0, Some(qpos))?;
            write("qvel", &m.start.1, Some(qvel))
        })
    }

    /// Writes the current positions and velocities.
    fn fill_position(&self, mut position: [PyReadwriteArrayDyn<'_, f64>; 2]) -> PyResult<()> {
        self.with(|env, _| {
            let [qpos, qvel] = &mut position;
            write("qpos", &env.state().qpos, Some(qpos))?;
            write("qvel", &env.state().qvel, Some(qvel))
        })
    }

    /// Returns which of `qpos`, `qvel`, `ctrl`, `act`, `qfrc_applied`, `xfrc_applied`, `mocap_pos` and `mocap_quat` differ from the state, as bits 0
    /// to 7.
    fn differences(&self, arrays: Vec<PyReadonlyArrayDyn<'_, f64>>) -> PyResult<u32> {
        self.with(|env, _| {
            let s = env.state();
            let own: [&[f64]; 8] = [
                &s.qpos,
                &s.qvel,
                &s.ctrl,
                &s.act,
                &s.qfrc_applied,
                s.xfrc_applied.as_flattened(),
                s.mocap_pos.as_flattened(),
                s.mocap_quat.as_flattened(),
            ];
            let mut bits = 0;
            for (k, (own, array)) in own.into_iter().zip(&arrays).enumerate() {
                let other = array.as_slice().map_err(|e| PyValueError::new_err(e.to_string()))?;
                // the kit's muscles are not MuJoCo's, so `act` is empty
                if other.len() == own.len() && other != own {
                    bits |= 1 << k;
                }
            }
            Ok(bits)
        })
    }

    #[classattr]
    #[allow(non_snake_case)]
    fn FILLED() -> Vec<&'static str> {
        FILLED.to_vec()
    }
}

macro_rules! filled {
    ($($field:ident)*; $($rows:ident)*) => {
        /// The arrays that [`Parts::fill`] writes.
        const FILLED: &[&str] = &[$(stringify!($field),)* $(stringify!($rows),)*];

        fn fill(state: &State, arrays: &mut [PyReadwriteArrayDyn<'_, f64>]) -> PyResult<()> {
            let mut arrays = arrays.iter_mut();
            $(write(stringify!($field), &state.$field, arrays.next())?;)*
            $(write(stringify!($rows), state.$rows.as_flattened(), arrays.next())?;)*
            Ok(())
        }
    };
}

filled! {
    qpos qvel ctrl qfrc_applied qacc_warmstart qfrc_bias qfrc_passive actuator_force qfrc_actuator qfrc_smooth qacc_smooth
    qfrc_constraint qacc sensordata;
    xpos xquat xmat xipos ximat xanchor xaxis geom_xpos geom_xmat site_xpos site_xmat cam_xpos cam_xmat subtree_com
    cdof cvel cacc cfrc_ext cfrc_int xfrc_applied mocap_pos mocap_quat
}

fn write(name: &str, values: &[f64], array: Option<&mut PyReadwriteArrayDyn<'_, f64>>) -> PyResult<()> {
    let Some(array) = array else {
        return Err(PyRuntimeError::new_err(format!("there is no array for {name}")));
    };
    let out = array
        .as_slice_mut()
        .map_err(|e| PyValueError::new_err(format!("{name}: {e}")))?;
    if out.len() != values.len() {
        let (found, expected) = (out.len(), values.len());
        return Err(PyValueError::new_err(format!(
            "{name} has {found} values, but {expected} are needed"
        )));
    }
    out.copy_from_slice(values);
    Ok(())
}
