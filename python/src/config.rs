//! Configurations: YAML and dictionaries.

use std::path::PathBuf;

use babybench::Config;
use babybench::config::{ConfigReader, Example, KeyKind, KeyValue};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use serde::Deserialize;
use serde::de::value::{Error, MapDeserializer, SeqDeserializer};
use serde::de::{Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

use crate::errors::{IntoException, detached};

/// A value of a dictionary for a configuration.
enum Value {
    None,
    Bool(bool),
    Whole(i128),
    Number(f64),
    Text(String),
    List(Vec<Self>),
    /// Ages over steps.
    Ages(Vec<(Self, Self)>),
}

impl<'de> Deserializer<'de> for Value {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Self::None => visitor.visit_none(),
            Self::Bool(on) => visitor.visit_bool(on),
            Self::Whole(number) => match (u64::try_from(number), i64::try_from(number)) {
                (Ok(number), _) => visitor.visit_u64(number),
                (_, Ok(number)) => visitor.visit_i64(number),
                _ => visitor.visit_f64(number as f64),
            },
            Self::Number(number) => visitor.visit_f64(number),
            Self::Text(text) => visitor.visit_string(text),
            Self::List(values) => visitor.visit_seq(SeqDeserializer::new(values.into_iter())),
            Self::Ages(ages) => visitor.visit_map(MapDeserializer::new(ages.into_iter())),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

impl IntoDeserializer<'_> for Value {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// Reads one value; NumPy's numbers are accepted like Python's.
fn value_of(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_none() {
        return Ok(Value::None);
    }
    if let Ok(on) = value.cast::<PyBool>() {
        return Ok(Value::Bool(on.is_true()));
    }
    if value.is_instance_of::<PyInt>() {
        // what is beyond 128 bits is out of every range
        return Ok(value.extract().map_or(Value::Number(f64::INFINITY), Value::Whole));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Number(value.extract()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::Text(text.to_cow()?.into_owned()));
    }
    if let Ok(path) = value.extract::<PathBuf>() {
        return Ok(Value::Text(path.display().to_string()));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let values = value.try_iter()?.map(|item| value_of(key, &item?));
        return Ok(Value::List(values.collect::<PyResult<_>>()?));
    }
    if let (Ok(ages), "age" | "age_schedule") = (value.cast::<PyDict>(), key) {
        let ages = ages
            .iter()
            .map(|(steps, age)| Ok((value_of(key, &steps)?, value_of(key, &age)?)));
        return Ok(Value::Ages(ages.collect::<PyResult<_>>()?));
    }
    let kind = value.get_type();
    let module = kind.module()?;
    if module.to_cow()? == "numpy" && value.getattr("ndim").and_then(|n| n.extract::<usize>()).ok() == Some(0) {
        return value_of(key, &value.call_method0("item")?);
    }
    Err(PyTypeError::new_err(format!(
        "configuration: `{key}` is a {}, expected a bool, a number, a str or a list",
        kind.name()?
    )))
}

/// Reads a configuration from a dictionary or another mapping.
fn from_mapping(mapping: &Bound<'_, PyMapping>) -> PyResult<Config> {
    let mut entries = Vec::new();
    for item in mapping.items()?.iter() {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let Ok(key) = key.extract::<String>() else {
            return Err(PyTypeError::new_err(format!(
                "configuration: the key {key} is not a str"
            )));
        };
        let value = value_of(&key, &value)?;
        entries.push((key, value));
    }
    let entries = MapDeserializer::<_, Error>::new(entries.into_iter());
    Config::deserialize(entries).map_err(|e| PyValueError::new_err(e.to_string()))
}

/// Reads a configuration from a mapping, from YAML text (a `str` of several lines or with a colon and a space), or from a file.
pub fn config_of(py: Python<'_>, config: &Bound<'_, PyAny>) -> PyResult<Config> {
    if let Ok(mapping) = config.cast::<PyMapping>() {
        return from_mapping(mapping);
    }
    if let Ok(path) = config.extract::<PathBuf>() {
        return detached(py, || Config::from_file(path));
    }
    Err(PyTypeError::new_err(format!(
        "a configuration is a mapping or the path of a YAML file, not a {}",
        config.get_type().name()?
    )))
}

/// Returns a value of a key as Python's.
fn to_python<'py>(py: Python<'py>, value: KeyValue) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        KeyValue::Bool(on) => PyBool::new(py, on).to_owned().into_any(),
        KeyValue::Whole(number) => number.into_pyobject(py)?.into_any(),
        KeyValue::Number(number) => number.into_pyobject(py)?.into_any(),
        KeyValue::Choice(name) => name.into_pyobject(py)?.into_any(),
        KeyValue::List(names) => PyList::new(py, names)?.into_any(),
        KeyValue::Text(text) => text.into_pyobject(py)?.into_any(),
        KeyValue::None => py.None().into_bound(py),
    })
}

/// Returns all keys of a configuration with their values.
pub fn to_dict<'py>(py: Python<'py>, config: &Config) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for key in Config::keys() {
        dict.set_item(key.name, to_python(py, key.value(config))?)?;
    }
    Ok(dict)
}

#[pyfunction]
pub fn config_from_mapping<'py>(py: Python<'py>, mapping: &Bound<'py, PyMapping>) -> PyResult<Bound<'py, PyDict>> {
    to_dict(py, &from_mapping(mapping)?)
}

#[pyfunction]
#[pyo3(signature = (text, file="configuration", folder=PathBuf::new()))]
pub fn config_from_yaml<'py>(py: Python<'py>, text: &str, file: &str, folder: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let config = ConfigReader {
        folder,
        ..ConfigReader::default()
    }
    .read_text(text, file);
    let config = config.map_err(IntoException::into_exception)?;
    to_dict(py, &config)
}

#[pyfunction]
pub fn config_examples(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let examples = PyDict::new(py);
    for example in Example::ALL.into_iter().chain(Example::TASKS) {
        let config = example.config().map_err(IntoException::into_exception)?;
        examples.set_item(example.name, to_dict(py, &config)?)?;
    }
    Ok(examples)
}

#[pyfunction]
pub fn config_keys(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let keys = PyDict::new(py);
    for key in Config::keys() {
        let entry = PyDict::new(py);
        entry.set_item("default", to_python(py, key.default_value())?)?;
        entry.set_item("section", key.section)?;
        entry.set_item("expected", key.kind.expected())?;
        entry.set_item("doc", key.doc)?;
        if let KeyKind::Choice(names)
        | KeyKind::ChoiceOrFile { names, .. }
        | KeyKind::List(names)
        | KeyKind::NoneOrList(names) = key.kind
        {
            entry.set_item("choices", names)?;
        }
        keys.set_item(key.name, entry)?;
    }
    Ok(keys)
}
