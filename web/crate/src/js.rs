//! Objects and errors of JavaScript.

use babybench::EnvError;
use babybench::config::ConfigError;
use js_sys::{Array, Object, Reflect};
use wasm_bindgen::JsValue;

/// Makes an object of keys and values.
pub fn object<const N: usize>(entries: [(&str, JsValue); N]) -> JsValue {
    let object = Object::new();
    for (key, value) in entries {
        set(&object, key, &value);
    }
    object.into()
}

/// Makes an array.
pub fn list<T: Into<JsValue>>(items: impl IntoIterator<Item = T>) -> JsValue {
    items.into_iter().map(Into::into).collect::<Array>().into()
}

/// Makes an array of numbers.
pub fn numbers<T: Copy + Into<f64>>(values: &[T]) -> JsValue {
    list(values.iter().map(|&v| JsValue::from_f64(v.into())))
}

/// Makes a number of an id.
pub fn id(id: usize) -> JsValue {
    JsValue::from_f64(id as f64)
}

/// Makes an array of ids.
pub fn ids(ids: &[usize]) -> JsValue {
    list(ids.iter().map(|&i| id(i)))
}

/// Converts `None` to `null`.
pub fn optional<T>(value: Option<T>, make: impl FnOnce(T) -> JsValue) -> JsValue {
    value.map_or(JsValue::NULL, make)
}

/// Sets a property of an object that was made here, which cannot fail.
fn set(object: &Object, key: &str, value: &JsValue) {
    let _ = Reflect::set(object, &key.into(), value);
}

/// Makes an `Error` with the text of a library error.
pub fn error(error: impl std::fmt::Display) -> JsValue {
    js_sys::Error::new(&error.to_string()).into()
}

/// Makes an `Error`; an error of a configuration also has `key`, `line` and `column`, if known.
pub fn env_error(e: &EnvError) -> JsValue {
    match e {
        EnvError::Config(config) => config_error(config),
        other => error(other),
    }
}

/// Makes an `Error` with the key and the place of the fault.
pub fn config_error(e: &ConfigError) -> JsValue {
    let error = js_sys::Error::new(&e.to_string());
    error.set_name("ConfigError");
    if let Some(key) = e.key() {
        set(&error, "key", &key.into());
    }
    if let Some((line, column)) = e.position() {
        set(&error, "line", &line.into());
        set(&error, "column", &column.into());
    }
    error.into()
}
