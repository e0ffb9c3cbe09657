//! The viewer in a browser of an environment that a Python program steps.

use babybench_cli::view::{Next, View as Inside};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::env::Env;
use crate::errors::detached;
use crate::guarded::Guarded;

/// A viewer of environments.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct View {
    inner: Guarded<Inside>,
    #[pyo3(get)]
    url: String,
}

#[pymethods]
impl View {
    #[new]
    #[pyo3(signature = (title, port=0))]
    fn new(title: &str, port: u16) -> PyResult<Self> {
        let opened = Inside::open(port, title).map_err(|e| PyOSError::new_err(format!("port {port}: {e}")))?;
        Ok(Self {
            url: opened.url(),
            inner: Guarded::new(opened, "viewer", "one thread shows an environment"),
        })
    }

    fn attend(&self, py: Python<'_>, env: &Env) -> PyResult<&'static str> {
        let (mut viewer, mut guard) = (self.inner.guard()?, env.guard()?);
        let (viewer, env) = (viewer.open()?, &mut guard.open()?.env);
        let next = detached(py, || Ok::<_, PyErr>(viewer.attend(env)))?;
        Ok(match next {
            Next::Step => "step",
            Next::Reset => "reset",
            Next::Wait => "wait",
        })
    }

    fn stepped(&self, env: &Env, seconds: f64) -> PyResult<()> {
        let (mut viewer, mut guard) = (self.inner.guard()?, env.guard()?);
        viewer.open()?.stepped(&mut guard.open()?.env, seconds);
        Ok(())
    }

    fn restarted(&self, env: &Env) -> PyResult<()> {
        let (mut viewer, mut guard) = (self.inner.guard()?, env.guard()?);
        viewer.open()?.restarted(&mut guard.open()?.env);
        Ok(())
    }

    #[getter]
    fn watched(&self) -> PyResult<bool> {
        Ok(self.inner.guard()?.open()?.watched())
    }

    #[getter]
    fn moves(&self) -> PyResult<bool> {
        Ok(self.inner.guard()?.open()?.moves())
    }

    fn close(&self) -> PyResult<()> {
        self.inner.guard()?.close();
        Ok(())
    }
}
