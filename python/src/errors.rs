//! From the library's errors to Python's exceptions, with the library's text.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use babybench::EnvError;
use babybench::assets::AssetError;
use babybench::config::ConfigError;
use babybench::env::SnapshotError;
use babybench::mimo::{CustomSceneError, LockError};
use babybench::physics::EngineError;
use babybench::vector::VectorError;
use pyo3::exceptions::{PyFileNotFoundError, PyKeyError, PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

/// An error that has a Python exception.
pub trait IntoException: Send {
    /// Returns the corresponding exception.
    fn into_exception(self) -> PyErr;
}

impl IntoException for PyErr {
    fn into_exception(self) -> PyErr {
        self
    }
}

impl IntoException for EnvError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::Config(e) => e.into_exception(),
            Self::Lock(e) => e.into_exception(),
            Self::Snapshot(_)
            | Self::Load(_)
            | Self::Growth(_)
            | Self::Skin(_)
            | Self::Render(_)
            | Self::Actuation(_)
            | Self::ModelChange(_)
            | Self::Schedule { .. }
            | Self::Spaces { .. }
            | Self::MocapMotion(_)
            | Self::NoVision
            | Self::SenseOff { .. }
            | Self::Rapier(_)
            | Self::ActionLength { .. }
            | Self::ActionNotFinite { .. }
            | Self::StateLength { .. }
            | Self::Engine(EngineError::NotFinite { .. } | EngineError::Applied { .. }) => PyValueError::new_err(text),
            Self::CustomScene(CustomSceneError::NoDocument { .. }) => PyFileNotFoundError::new_err(text),
            Self::CustomScene(CustomSceneError::Stray { .. }) => PyValueError::new_err(text),
            Self::Missing { .. } => PyKeyError::new_err(text),
            _ => PyRuntimeError::new_err(text),
        }
    }
}

impl IntoException for ConfigError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::Read { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                PyFileNotFoundError::new_err(text)
            }
            Self::Read { .. } => PyOSError::new_err(text),
            _ => PyValueError::new_err(text),
        }
    }
}

impl IntoException for LockError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::NoJoint { .. } => PyKeyError::new_err(text),
            _ => PyValueError::new_err(text),
        }
    }
}

impl IntoException for SnapshotError {
    fn into_exception(self) -> PyErr {
        PyValueError::new_err(self.to_string())
    }
}

impl IntoException for AssetError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::NotFound(_) => PyFileNotFoundError::new_err(text),
            _ => PyOSError::new_err(text),
        }
    }
}

impl IntoException for VectorError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::Env { source, .. } => {
                // the exception of the cause, with the number of the environment in its text
                let cause = source.into_exception();
                Python::attach(|py| PyErr::from_type(cause.get_type(py), text))
            }
            Self::Memory { .. } => PyMemoryError::new_err(text),
            Self::Unknown { .. } => pyo3::exceptions::PyIndexError::new_err(text),
            Self::NoEnvironments
            | Self::Spaces { .. }
            | Self::Grown { .. }
            | Self::Shape { .. }
            | Self::NoSense { .. } => PyValueError::new_err(text),
            _ => PyRuntimeError::new_err(text),
        }
    }
}

/// Does work without Python's lock. A panic becomes a `RuntimeError`.
pub fn detached<T: Send, E: IntoException>(py: Python<'_>, work: impl FnOnce() -> Result<T, E> + Send) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(done) => done.map_err(E::into_exception),
        Err(payload) => Err(PyRuntimeError::new_err(format!(
            "internal error of babybench, please report it: {}",
            message(&*payload)
        ))),
    }
}

/// Returns the message of a panic.
fn message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}
