//! Scenes as documents, and the parts of a scene's model that are stored in a different form from MuJoCo's.

use std::path::PathBuf;

use babybench::Model;
use babybench::assets::{AssetSource, DirAssets};
use babybench::mimo::embedded;
use babybench::model::EqualityKind;
use babybench::runs::{SceneFile, SceneFileError, complete_scene, complete_scene_from};
use numpy::PyArray1;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::ToArray;
use crate::blueprint::Blueprint;
use crate::config::config_of;
use crate::errors::{IntoException, detached};

impl IntoException for SceneFileError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::Io { .. } => PyOSError::new_err(text),
            _ => PyValueError::new_err(text),
        }
    }
}

/// Returns the complete document of a configuration's scene, and the files that it names.
#[pyfunction]
#[pyo3(signature = (config, assets=None))]
pub fn scene_file<'py>(
    py: Python<'py>,
    config: &Bound<'py, PyAny>,
    assets: Option<PathBuf>,
) -> PyResult<(String, Bound<'py, PyDict>)> {
    let config = config_of(py, config)?;
    let assets = assets.map(DirAssets::new).transpose();
    let assets = assets.map_err(IntoException::into_exception)?;
    let SceneFile { xml, files: named } = detached(py, || match &assets {
        Some(assets) => complete_scene_from(&config, assets),
        None => complete_scene(&config),
    })?;
    let files = PyDict::new(py);
    for (name, bytes) in &named {
        files.set_item(name, PyBytes::new(py, bytes))?;
    }
    Ok((xml, files))
}

/// Returns the files that are embedded in the library, by path.
#[pyfunction]
pub fn embedded_files(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let (files, assets) = (PyDict::new(py), embedded());
    for &(name, _) in assets.0 {
        let bytes = assets.read(name).map_err(IntoException::into_exception)?;
        files.set_item(name, PyBytes::new(py, &bytes))?;
    }
    Ok(files)
}

/// Returns names of textures and materials, the number of lights, and MuJoCo's arrays of equality constraints.
#[pyfunction]
pub fn model_extras<'py>(py: Python<'py>, blueprint: &Bound<'py, Blueprint>) -> PyResult<Bound<'py, PyDict>> {
    extras(py, blueprint.get().inner.model())
}

/// Returns the result of [`model_extras`] for any model.
pub fn extras<'py>(py: Python<'py>, model: &Model) -> PyResult<Bound<'py, PyDict>> {
    let extras = PyDict::new(py);
    extras.set_item(
        "texture",
        model.textures.iter().map(|t| &t.name[..]).collect::<Vec<_>>(),
    )?;
    extras.set_item(
        "material",
        model.materials.iter().map(|m| &m.name[..]).collect::<Vec<_>>(),
    )?;
    extras.set_item("nlight", model.lights.len())?;
    let (ids, rows): (Vec<_>, Vec<_>) = model.eq_kind.iter().map(EqualityKind::numbers).unzip();
    extras.set_item("eq_data", rows[..].to_array(py)?)?;
    for (k, name) in ["eq_type", "eq_objtype", "eq_obj1id", "eq_obj2id"]
        .into_iter()
        .enumerate()
    {
        extras.set_item(name, PyArray1::from_iter(py, ids.iter().map(|id| id[k])))?;
    }
    Ok(extras)
}
