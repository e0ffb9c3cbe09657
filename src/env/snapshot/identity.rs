//! The owner of a snapshot: a scene, and the keys of a configuration.

use std::collections::BTreeMap;

use super::SnapshotError;
use super::format::checksum;
use crate::config::{Config, Delays, Key, Scene};
use crate::math::order;
use crate::model::Model;
use crate::sensors::transform::Sense;
use crate::text::quoted;

/// The scenes and configurations whose snapshots an environment can restore.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::env) struct Identity {
    /// Checksum of all that must be equal.
    pub fingerprint: u64,
    /// Keys of the configuration that are not as they are by default, a line each: what is told where a snapshot does not fit.
    pub keys: String,
}

/// Keys on which no snapshot depends.
const APART: [&str; 8] = [
    "save_dir",
    "max_episode_steps",
    "render_size",
    "save_logs_every",
    "renderer",
    "seed",
    "vision_threads",
    "vision_lazy",
];

impl Identity {
    /// Describes the environments of a configuration.
    pub fn new(model: &Model, config: &Config) -> Self {
        let told = |key: &&Key| !APART.contains(&key.name) && key.section != "Locked joints";
        let mut keys = String::new();
        for key in Config::keys().iter().filter(told) {
            let value = key.value(config);
            if value != key.default_value() {
                keys += &format!("{}: {}\n", key.name, value.to_yaml().replace('\n', " "));
            }
        }
        Self {
            fingerprint: fingerprint(model, config),
            keys,
        }
    }

    /// Returns the same with another model: `changes` are its arrays that differ from those of the scene.
    pub fn with_changes(&self, changes: &BTreeMap<&'static str, &[f64]>) -> Self {
        let mut keys = self.keys.clone();
        for (name, values) in changes {
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            keys += &format!("{MODEL}{name}: {:016x}\n", checksum(&bytes));
        }
        let changed = &keys[self.keys.len()..];
        let fingerprint = self.fingerprint
            ^ if changed.is_empty() {
                0
            } else {
                checksum(changed.as_bytes())
            };
        Self { fingerprint, keys }
    }

    /// Returns the error for a snapshot with these keys that does not fit; `otherwise` where the keys do not tell why.
    pub fn refuse(&self, keys: Option<&str>, otherwise: SnapshotError) -> SnapshotError {
        let Some(keys) = keys else { return otherwise };
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

/// Before the names of arrays of a model that was changed.
const MODEL: &str = "model.";

/// Splits lines of a key and its value.
fn lines(keys: &str) -> BTreeMap<&str, &str> {
    order::map(keys.lines().filter_map(|line| line.split_once(": ")))
}

/// Tells what a key was and what it is.
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

/// The keys of senses whose state the fingerprint of the first layouts tells or leaves out.
const EARLY: [&str; 5] = [
    "touch_active",
    "touch_pooled",
    "pain_active",
    "vestibular_active",
    "vision_active",
];

/// Keys that came after the first snapshots, which stay readable where these are as they are by default.
const LATER: [&str; 10] = [
    "delay_by_age",
    "vision_width",
    "vision_width_left",
    "vision_width_right",
    "vision_height",
    "vision_height_left",
    "vision_height_right",
    "vision_fovy",
    "vision_fovy_left",
    "vision_fovy_right",
];

/// Computes a fingerprint of what decides the meaning of a snapshot: names and masses of the scene, all of a custom scene, and
/// the keys that shape an environment's memory.
fn fingerprint(model: &Model, config: &Config) -> u64 {
    let mut bytes = Vec::new();
    for names in [
        &model.body_name,
        &model.jnt_name,
        &model.actuator_name,
        &model.geom_name,
    ] {
        for name in names {
            bytes.extend_from_slice(name.as_bytes());
            bytes.push(0);
        }
        bytes.push(1);
    }
    // the number of activations, only where there are any, so that older snapshots stay readable
    if model.na > 0 {
        bytes.extend_from_slice(&(model.na as u64).to_le_bytes());
    }
    for v in model.qpos0.iter().chain(&model.body_mass) {
        bytes.extend_from_slice(&v.to_le_bytes());
    }
    let own = match &config.scene {
        // wherever it lies: the room itself counts
        Scene::File(_) => Some(format!("{:016x}", content(model))),
        _ if !config.scene_extra.is_empty() => Some(format!("{:016x}", content(model))),
        _ => None,
    };
    for name in [
        config.behavior.name(),
        own.as_deref().unwrap_or(config.scene.name()),
        config.actuation_model.name(),
        config.compat.name(),
        config.engine.name(),
    ] {
        bytes.extend_from_slice(name.as_bytes());
        bytes.push(0);
    }
    for key in shaping(config) {
        bytes.extend_from_slice(key.value(config).to_yaml().as_bytes());
        bytes.push(0);
    }
    checksum(&bytes)
}

/// Returns the keys that shape an environment's memory.
fn shaping(config: &Config) -> impl Iterator<Item = &'static Key> {
    let defaults = Config::default();
    // senses that came after the first snapshots tell themselves apart where they are on, so that older snapshots stay readable
    let is_added = |key| !EARLY.contains(&key) && Sense::ALL.iter().any(|sense| sense.switch() == key);
    let rated = config.rates().next().is_some();
    let remembers = config.delays != Delays::default() || config.pain_active || rated;
    let shapes = move |key: &&Key| {
        // rates, too, came later
        if !rated && ["vision_rate", "touch_rate"].contains(&key.name) {
            return false;
        }
        if LATER.contains(&key.name) && key.value(config) == key.value(&defaults) {
            return false;
        }
        // when images are drawn is remembered nowhere
        if key.name == "vision_lazy" {
            return false;
        }
        ["Delays", "Pain"].contains(&key.section)
            || key.name == "touch_pooled"
            || key.name == "act_others" && config.act_others
            || is_added(key.name) && key.value(config) != key.value(&defaults)
            || remembers && ["Vision", "Touch"].contains(&key.section)
    };
    Config::keys().iter().filter(shapes)
}

/// Computes a hash of everything in a model.
fn content(model: &Model) -> u64 {
    checksum(format!("{model:?}").as_bytes())
}

#[cfg(test)]
mod tests {
    use crate::{Blueprint, Config};

    #[test]
    fn snapshots_of_earlier_versions_stay_readable() {
        let fingerprint = |text: &str| {
            let config = Config::from_yaml(text, "c.yml").expect("a configuration");
            let blueprint = Blueprint::new(config).expect("embedded assets");
            format!("{:016x}", blueprint.identity().fingerprint)
        };
        for (text, expected) in [
            ("touch_active: no\nvision_active: no", "d6191abc0b92d2a3"),
            (include_str!("../../../configs/config_infant.yml"), "f2c87526a4dcc316"),
            ("scene: crib\nvision_rate: 30\ntouch_scale: 4", "d00a453064b163df"),
        ] {
            assert_eq!(fingerprint(text), expected, "{text}");
        }
    }
}
