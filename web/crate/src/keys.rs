//! The table of configuration keys, for forms.

use babybench::Config;
use babybench::config::{Key, KeyKind, KeyValue};
use wasm_bindgen::JsValue;

use crate::js::{list, object};

/// Lists all keys.
pub fn keys() -> JsValue {
    list(Config::keys().iter().map(describe))
}

/// Lists the values of a configuration by key.
pub fn values(config: &Config) -> JsValue {
    let entries = Config::keys().iter().map(|key| {
        let entry: [JsValue; 2] = [key.name.into(), value(&key.value(config))];
        list(entry)
    });
    list(entries)
}

fn describe(key: &Key) -> JsValue {
    let (kind, options, min, max) = match key.kind {
        KeyKind::Bool => ("boolean", JsValue::NULL, JsValue::NULL, JsValue::NULL),
        KeyKind::Whole { min, max } | KeyKind::NoneOrWhole { min, max } => {
            ("integer", JsValue::NULL, (min as f64).into(), (max as f64).into())
        }
        KeyKind::ZeroOrAtLeast(least) => ("number", JsValue::NULL, least.into(), JsValue::NULL),
        KeyKind::Number { min, max } | KeyKind::NoneOr { min, max } => {
            ("number", JsValue::NULL, min.into(), max.into())
        }
        KeyKind::Choice(names) => ("choice", list(names.iter().copied()), JsValue::NULL, JsValue::NULL),
        // paths are offered by the program that passes the files
        KeyKind::ChoiceOrFile { names, .. } => ("choice", list(names.iter().copied()), JsValue::NULL, JsValue::NULL),
        KeyKind::List(names) | KeyKind::NoneOrList(names) => {
            ("list", list(names.iter().copied()), JsValue::NULL, JsValue::NULL)
        }
        KeyKind::Text | KeyKind::Document | KeyKind::NoneOrAges { .. } => {
            ("text", JsValue::NULL, JsValue::NULL, JsValue::NULL)
        }
    };
    object([
        ("name", key.name.into()),
        ("section", key.section.into()),
        ("kind", kind.into()),
        ("options", options),
        ("min", min),
        ("max", max),
        ("expected", key.kind.expected().into()),
        ("default", value(&key.default_value())),
        ("doc", key.doc.into()),
    ])
}

fn value(value: &KeyValue) -> JsValue {
    match value {
        KeyValue::Bool(on) => (*on).into(),
        KeyValue::Whole(number) => (*number as f64).into(),
        KeyValue::Number(number) => (*number).into(),
        KeyValue::Choice(name) => (*name).into(),
        KeyValue::List(names) => list(names.iter().copied()),
        KeyValue::Text(text) => text.as_str().into(),
        KeyValue::None => JsValue::NULL,
    }
}
