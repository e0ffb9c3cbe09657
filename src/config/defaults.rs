//! Defaults of tasks, and values that they exclude.

use super::error::Conflict;
use super::table::KEYS;
use super::table::Key;
use super::{ActuationModel, Behavior, BodyParts, Compat, Config, Learner, Scene, TouchFunction, TouchResponse};
use crate::text::quoted;

impl Config {
    /// Sets keys that a file left out (`given` marks the others, by their index in the table) to the default of the behavior.
    pub(super) fn take_defaults(&mut self, given: impl Fn(usize) -> bool) {
        let Some(own) = of_task(self.behavior) else {
            return;
        };
        for (index, key) in KEYS.iter().enumerate() {
            // a key that differs was set by the caller's base configuration, which a task must not overwrite
            if !given(index) && key.value(self) == key.default_value() {
                key.assign(self, &key.value(&own));
            }
        }
    }
}

/// Returns the configuration of a task as MIMo's authors define it; `None` for BabyBench's behaviors.
fn of_task(behavior: Behavior) -> Option<Config> {
    let task = Config {
        save_dir: format!("results/{behavior}"),
        behavior,
        frame_skip: 2,
        vestibular_active: false,
        vision_active: false,
        touch_active: false,
        touch_function: TouchFunction::ForceVector,
        touch_response: TouchResponse::SpreadLinear,
        ..Config::default()
    };
    Some(match behavior {
        Behavior::None | Behavior::SelfTouch | Behavior::HandRegard => return None,
        Behavior::Reach => task,
        Behavior::Standup | Behavior::RollOver => Config {
            max_episode_steps: 500,
            vestibular_active: true,
            done_active: false,
            ..task
        },
        Behavior::SelfBody => Config {
            max_episode_steps: 500,
            frame_skip: 1,
            touch_active: true,
            ..task
        },
        // the library's own tasks: everything is observed, as by default
        Behavior::Mobile => Config {
            scene: Scene::Mobile,
            max_episode_steps: 3000,
            ..own_task(behavior)
        },
        Behavior::Play => Config {
            scene: Scene::Playroom,
            ..own_task(behavior)
        },
        Behavior::Catch => Config {
            max_episode_steps: 800,
            touch_active: true,
            actuation_model: ActuationModel::Muscle,
            ..task
        },
    })
}

/// Returns what the library's own tasks have in common: everything is observed, and success does not end an episode.
fn own_task(behavior: Behavior) -> Config {
    Config {
        save_dir: format!("results/{behavior}"),
        behavior,
        frame_skip: 2,
        done_active: false,
        ..Config::default()
    }
}

/// Returns the first value that one of the library's own tasks excludes.
fn own_conflict(config: &Config) -> Option<Conflict> {
    if config.compat == Compat::Reference {
        let reason = "the Python code that `compat: reference` follows does not have this task; leave `compat` out";
        return Some(("behavior", config.behavior.to_string(), reason.to_string()));
    }
    if config.behavior == Behavior::Mobile && config.mobile.baseline + config.mobile.extinction > 1.0 {
        let reason =
            "with `mobile_baseline` it is more than the whole episode; both are shares that add up to 1 at most";
        return Some((
            "mobile_extinction",
            config.mobile.extinction.to_string(),
            reason.to_string(),
        ));
    }
    None
}

/// Returns a value about a second infant in a scene that has none.
fn second_infant(config: &Config) -> Option<Conflict> {
    let (key, value) = if matches!(config.scene, Scene::File(_)) {
        return None;
    } else if config.learner != Learner::Mimo {
        ("learner", config.learner.to_string())
    } else {
        ("other_age", config.other_age?.to_string())
    };
    // ignored, the key would let a scene run without the infant that its author expects
    let reason = "only a custom document has a second infant; set `scene` to its path, or leave it out";
    Some((key, value, reason.to_string()))
}

/// Returns a value that is calibrated only for the body of MIMo 2.
fn other_body(config: &Config) -> Option<Conflict> {
    let calibrated = ["strength", "springs", "proportions"];
    let changed = |key: &&Key| calibrated.contains(&key.name) && key.value(config) != key.default_value();
    let key = KEYS.iter().find(changed).filter(|_| config.mimo_version != 2)?;
    let reason = "it is calibrated on the body of MIMo 2, whose chest has no joints; leave it or `mimo_version` out";
    Some((key.name, key.value(config).to_yaml(), reason.to_string()))
}

/// Returns the first value that the task of a configuration excludes: key, value, and why.
pub(super) fn conflict(config: &Config) -> Option<Conflict> {
    if let Some(conflict) = other_body(config) {
        return Some(conflict);
    }
    if let Some(conflict) = second_infant(config) {
        return Some(conflict);
    }
    if config.act_others && config.actuation_model == ActuationModel::Muscle {
        let reason = "`actuation_model: muscle` turns all actuators into muscles, which other bodies do not have; use spring_damper or positional";
        return Some(("act_others", config.act_others.to_string(), reason.to_string()));
    }
    let task = !matches!(
        config.behavior,
        Behavior::None | Behavior::SelfTouch | Behavior::HandRegard | Behavior::Mobile | Behavior::Play
    );
    if !config.scene_extra.is_empty() && (task || matches!(config.scene, Scene::File(_))) {
        let reason = "it is added to a scene of the library that is chosen by its name; a task with a scene of its own \
                      and a document of one's own are whole: write it into the document, or leave it out";
        return Some((
            "scene_extra",
            quoted(&config.scene_extra).to_string(),
            reason.to_string(),
        ));
    }
    // they use BabyBench's scenes and actuation, so what MIMo's own tasks exclude does not concern them
    if matches!(config.behavior, Behavior::Mobile | Behavior::Play) {
        return own_conflict(config);
    }
    // BabyBench's behaviors end here: only tasks exclude what follows
    of_task(config.behavior)?;
    if config.scene != Scene::Base {
        let reason = "a task has a scene of its own; leave `scene` out";
        return Some(("scene", config.scene.to_string(), reason.to_string()));
    }
    if config.act != BodyParts::all(true) {
        let off = KEYS
            .iter()
            .find(|key| key.name.starts_with("act_") && key.value(config) != key.default_value())?;
        let reason = "a task drives the joints that it needs; leave `act_...` out";
        return Some((off.name, off.value(config).to_yaml(), reason.to_string()));
    }
    if config.actuation_model == ActuationModel::Positional {
        let reason = "a task has motors and no servos; use spring_damper or muscle";
        return Some((
            "actuation_model",
            config.actuation_model.to_string(),
            reason.to_string(),
        ));
    }
    if config.behavior == Behavior::SelfBody && !config.touch_enabled() {
        let reason = "the task selfbody is about touch; leave `touch_active` and `touch_scale` out";
        return Some(("touch_active", config.touch_active.to_string(), reason.to_string()));
    }
    None
}
