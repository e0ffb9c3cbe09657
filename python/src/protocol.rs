//! Protocols: experiments with infants, and what MIMo does beside published numbers.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use babybench::eval::protocol::{Protocol, ProtocolError, ProtocolPlan};
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::errors::{IntoException, detached};

impl IntoException for ProtocolError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::Unknown { .. } => PyKeyError::new_err(text),
            Self::Io { source, .. } => std::io::Error::new(source.kind(), text).into(),
            Self::Document { .. } | Self::Plan { .. } | Self::Config { .. } => PyValueError::new_err(text),
            _ => PyRuntimeError::new_err(text),
        }
    }
}

/// Returns the names of the protocols of the library.
#[pyfunction]
pub fn protocol_names() -> Vec<&'static str> {
    Protocol::names().collect()
}

/// Returns a protocol as JSON.
#[pyfunction]
pub fn protocol_description(py: Python<'_>, name: &str) -> PyResult<String> {
    detached(py, || Protocol::named(name).map(|protocol| protocol.to_json()))
}

/// Runs a protocol into a folder and returns the results as JSON.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // keywords in Python
pub fn run_protocol(
    py: Python<'_>,
    name: &str,
    out: PathBuf,
    policies: Vec<String>,
    ages: Option<Vec<f64>>,
    seeds: u64,
    length: f64,
    keys: String,
    jobs: Option<usize>,
    keep_records: bool,
    policy_timeout: f64,
) -> PyResult<String> {
    let limit = Duration::try_from_secs_f64(policy_timeout)
        .map_err(|_| PyValueError::new_err(format!("policy_timeout is {policy_timeout}, expected seconds")))?;
    let plan = ProtocolPlan {
        policies,
        ages,
        seeds,
        length,
        keys,
        keep_records,
        limit,
    };
    let stop = AtomicBool::new(false);
    let progress = || {
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let work = || {
        let protocol = Protocol::named(name)?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let result = protocol.run(&plan, &out, jobs.unwrap_or(cores), &progress)?;
        result.write(&out)?;
        Ok::<_, ProtocolError>(result.to_json())
    };
    detached(py, || {
        std::thread::scope(|scope| {
            let worker = scope.spawn(work);
            let mut interrupted = Ok(());
            // only the thread that called learns of an interruption
            while !worker.is_finished() {
                std::thread::sleep(Duration::from_millis(10));
                if interrupted.is_ok() {
                    interrupted = Python::attach(|py| py.check_signals());
                    stop.store(interrupted.is_err(), Ordering::Relaxed);
                }
            }
            let done = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            interrupted?;
            done.map_err(IntoException::into_exception)
        })
    })
}
