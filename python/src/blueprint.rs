//! Compiled scenes.

use std::collections::HashMap;
use std::path::PathBuf;

use babybench::assets::{DirAssets, directory};
use babybench::env::{BlueprintOptions, EnvError, Info, Task, TaskDocument, TaskEvent, TaskScene};
use babybench::mimo::{DOCUMENT, Version};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::config::{config_of, to_dict};
use crate::errors::{IntoException, detached};
use crate::given_files::BesideDocument;
use crate::model;

/// The task of an environment that a program steps by hand: a document and a skin, without goals.
#[derive(Clone, Debug)]
struct ByHand {
    /// The document and the version of MIMo in it; `None` for the configuration's own.
    document: Option<(String, Version)>,
    touch_spacing: Vec<(String, f64)>,
}

impl Task for ByHand {
    fn name(&self) -> &str {
        "none"
    }

    fn document(&self, config: &babybench::Config) -> TaskDocument {
        let own = TaskDocument::of(config);
        let (xml, version) = self.document.clone().unwrap_or((own.xml, own.version));
        TaskDocument {
            xml,
            version,
            touch_spacing: self.touch_spacing.clone(),
        }
    }

    /// Nothing moves before the program's first step.
    fn settle(&self, _scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        Ok(())
    }

    fn inform(&self, _event: TaskEvent<'_>, info: &mut Info) {
        info.behavior = babybench::env::BehaviorInfo::None;
    }
}

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

    /// Compiles the scene with another infant of the configuration's population. Both share textures.
    fn with_body_number(&self, py: Python<'_>, number: u64) -> PyResult<Self> {
        let inner = detached(py, || self.inner.with_body_number(number))?;
        Ok(Self { inner })
    }

    /// Compiles a document, by default the configuration's, for a program that composes its own resets and steps.
    #[staticmethod]
    #[pyo3(signature = (config, document=None, version="v1", folder=PathBuf::new(), files=HashMap::new(), touch_spacing=Vec::new(), assets=None))]
    #[allow(clippy::too_many_arguments)] // keywords in Python
    fn by_hand(
        py: Python<'_>,
        config: &Bound<'_, PyAny>,
        document: Option<String>,
        version: &str,
        folder: PathBuf,
        files: HashMap<String, Vec<u8>>,
        touch_spacing: Vec<(String, f64)>,
        assets: Option<PathBuf>,
    ) -> PyResult<Self> {
        let config = config_of(py, config)?;
        let version = match version {
            "v1" => Version::V1,
            "v2" => Version::V2,
            other => {
                return Err(PyValueError::new_err(format!(
                    "version is {other:?}, expected \"v1\" or \"v2\""
                )));
            }
        };
        let mut options = BlueprintOptions::default();
        if document.is_some() {
            options = options.with_assets(BesideDocument::new(files, folder, directory(DOCUMENT))?);
        } else if let Some(assets) = assets {
            options = options.with_assets(DirAssets::new(assets).map_err(IntoException::into_exception)?);
        }
        let task = ByHand {
            document: document.map(|xml| (xml, version)),
            touch_spacing,
        };
        let inner = detached(py, || babybench::Blueprint::with(config, options.with_task(task)))?;
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
