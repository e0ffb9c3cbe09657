//! Compiled scenes.

use std::path::PathBuf;

use babybench::assets::DirAssets;
use babybench::env::BlueprintOptions;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::config::{config_of, to_dict};
use crate::errors::{IntoException, detached};
use crate::model;

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
            Some(assets) => babybench::Blueprint::with(config, BlueprintOptions::default().with_assets(assets)),
            None => babybench::Blueprint::new(config),
        })?;
        Ok(Self { inner })
    }

    #[getter]
    fn config<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(py, self.inner.config())
    }

    #[getter]
    fn eye_sizes(&self) -> ((usize, usize), (usize, usize)) {
        let [left, right] = self.inner.config().eye_sizes().map(|[width, height]| (width, height));
        (left, right)
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
