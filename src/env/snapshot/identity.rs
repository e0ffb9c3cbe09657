//! The identity of a snapshot: a scene, and the keys of a configuration.

use std::collections::BTreeMap;

use super::SnapshotError;
use super::format::checksum;
use crate::config::{Config, Key, Scene};
use crate::math::order;
use crate::model::Model;
use crate::text::quoted;

/// The identity of environments that can restore each other's snapshots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Identity {
    /// Checksum of everything that must be equal.
    pub fingerprint: u64,
    /// Keys of the configuration that differ from their defaults, a line each, for the error about a snapshot that does not match.
    pub keys: String,
}

/// Keys on which no snapshot depends: those about the run around an environment, and about pictures, which no snapshot holds.
const APART: [&str; 9] = [
    "save_dir",
    "max_episode_steps",
    "render_size",
    "save_logs_every",
    "renderer",
    "seed",
    "facial_expression",
    "vision_threads",
    "vision_lazy",
];

impl Identity {
    /// Describes the environments of a configuration.
    pub fn new(model: &Model, config: &Config) -> Self {
        // a snapshot holds which joints are locked
        let counts = |key: &&Key| !APART.contains(&key.name) && key.section != "Locked joints";
        let (mut all, mut keys) = (String::new(), String::new());
        for key in Config::keys().iter().filter(counts) {
            let value = key.value(config);
            let line = format!("{}: {}\n", key.name, value.to_yaml().replace('\n', " "));
            // a document of the user's own counts by its content, wherever it lies
            if !(key.name == "scene" && matches!(config.scene, Scene::File(_))) {
                all += &line;
            }
            if value != key.default_value() {
                keys += &line;
            }
        }
        Self {
            fingerprint: fingerprint(model, config, &all),
            keys,
        }
    }

    /// Returns the same identity with another model. `changes` are its arrays that differ from those of the scene.
    pub fn with_changes(&self, changes: &BTreeMap<&'static str, &[f64]>) -> Self {
        let mut keys = self.keys.clone();
        for (name, values) in changes {
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            keys += &format!("{MODEL}{name}: {:016x}\n", checksum(&bytes));
        }
        let changed = &keys[self.keys.len()..];
        // with all changes undone it is that of the scene again
        let fingerprint = self.fingerprint
            ^ if changed.is_empty() {
                0
            } else {
                checksum(changed.as_bytes())
            };
        Self { fingerprint, keys }
    }

    /// Returns the error for a snapshot with these keys that does not match; `otherwise` if the keys do not explain it.
    pub fn refuse(&self, keys: &str, otherwise: SnapshotError) -> SnapshotError {
        let (then, now) = (lines(keys), lines(&self.keys));
        let names = order::set(then.keys().chain(now.keys()).copied());
        let differing = names.into_iter().filter(|name| then.get(name) != now.get(name));
        let said: Vec<String> = differing
            .map(|name| difference(name, then.get(name), now.get(name)))
            .collect();
        if said.is_empty() {
            return otherwise;
        }
        SnapshotError::OtherConfiguration {
            differences: said.join("; "),
        }
    }
}

/// Precedes the names of changed arrays of the model.
const MODEL: &str = "model.";

/// Splits lines into a key and its value.
fn lines(keys: &str) -> BTreeMap<&str, &str> {
    order::map(keys.lines().filter_map(|line| line.split_once(": ")))
}

/// Describes the old and the new value of a key.
fn difference(name: &str, then: Option<&&str>, now: Option<&&str>) -> String {
    if name.starts_with(MODEL) {
        return format!("{} was another one", quoted(name));
    }
    let default = Key::named(name).map(|key| key.default_value().to_yaml());
    let value = |value: Option<&&str>| match (value, &default) {
        (Some(value), _) => quoted(value).to_string(),
        (None, Some(default)) => default.clone(),
        (None, None) => "unknown here".to_string(),
    };
    format!("{} was {}, but here it is {}", quoted(name), value(then), value(now))
}

/// Computes a fingerprint of everything that gives a snapshot its meaning: names, sizes and masses of the scene, the whole scene
/// if the user wrote it or added to it, and the keys of the configuration with their values.
fn fingerprint(model: &Model, config: &Config, keys: &str) -> u64 {
    let mut bytes = Vec::new();
    for names in [
        &model.body_name,
        &model.jnt_name,
        &model.actuator_name,
        &model.geom_name,
    ] {
        for name in names {
            bytes.extend_from_slice(name.as_bytes());
            // separators, because the same letters divided differently are other names
            bytes.push(0);
        }
        bytes.push(1);
    }
    bytes.extend_from_slice(&(model.na as u64).to_le_bytes());
    for v in model.qpos0.iter().chain(&model.body_mass) {
        bytes.extend_from_slice(&v.to_le_bytes());
    }
    if matches!(config.scene, Scene::File(_)) || !config.scene_extra.is_empty() {
        // the derived text has every field, including fields added later
        bytes.extend_from_slice(&checksum(format!("{model:?}").as_bytes()).to_le_bytes());
    }
    bytes.extend_from_slice(keys.as_bytes());
    checksum(&bytes)
}
