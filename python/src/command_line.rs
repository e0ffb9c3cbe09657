//! The command line, which Python programs call.

use std::ffi::OsString;

use pyo3::prelude::*;

use crate::errors::detached;

/// Runs a command and returns the exit code of the process.
#[pyfunction]
pub fn command_line(py: Python<'_>, arguments: Vec<OsString>, program: &str) -> PyResult<u8> {
    let known = ["python -m babybench", "python -m babybench_core", "babybench"];
    let name = known.into_iter().find(|name| *name == program).unwrap_or(known[0]);
    let arguments = std::iter::once(OsString::from(name)).chain(arguments);
    detached(py, || Ok::<_, PyErr>(babybench_cli::main_from(arguments, Some(name))))
}
