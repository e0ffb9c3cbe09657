//! Videos as motion JPEG.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use babybench::formats::avi::{AviError, AviWriter};
use numpy::PyReadonlyArray3;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::errors::{IntoException, detached};

impl IntoException for AviError {
    fn into_exception(self) -> PyErr {
        PyOSError::new_err(self.to_string())
    }
}

/// Writes frames (height, width, 3), red, green and blue, as a video.
#[pyfunction]
pub fn write_video(
    py: Python<'_>,
    path: PathBuf,
    frames: Vec<PyReadonlyArray3<'_, u8>>,
    frame_rate: f64,
    width: u32,
    height: u32,
) -> PyResult<()> {
    let unreadable = |e| PyValueError::new_err(format!("a frame cannot be read: {e}"));
    let frames: Vec<&[u8]> = frames
        .iter()
        .map(|f| f.as_slice().map_err(unreadable))
        .collect::<PyResult<_>>()?;
    let fps = frame_rate.round().clamp(1.0, 1000.0) as u32;
    detached(py, || {
        let failed = |e: std::io::Error| PyOSError::new_err(format!("{}: {e}", path.display()));
        let file = BufWriter::new(File::create(&path).map_err(failed)?);
        let mut video = AviWriter::new(file, width, height, fps).map_err(IntoException::into_exception)?;
        for frame in frames {
            video.frame(frame).map_err(IntoException::into_exception)?;
        }
        video.into_inner().flush().map_err(failed)
    })
}
