//! Random movements.

use babybench::spaces::{BoxSpace, Noise, NoiseError};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Action noise for one environment.
#[pyclass(module = "babybench_core._native")]
pub struct ActionNoise {
    noise: babybench::spaces::ActionNoise,
    action: Vec<f32>,
}

#[pymethods]
impl ActionNoise {
    #[new]
    fn new(noise: &str, low: Vec<f32>, high: Vec<f32>, step: f64, seed: u64) -> PyResult<Self> {
        let noise = noise
            .parse::<Noise>()
            .and_then(|noise| noise.at_age(None))
            .map_err(|e: NoiseError| PyValueError::new_err(e.to_string()))?;
        Ok(Self {
            noise: babybench::spaces::ActionNoise::new(noise, &BoxSpace::new(low, high), step, seed),
            action: Vec::new(),
        })
    }

    fn sample<'py>(&mut self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        self.noise.sample(&mut self.action);
        PyArray1::from_slice(py, &self.action)
    }

    fn reset(&mut self, seed: u64) {
        self.noise.reset(seed);
    }
}
