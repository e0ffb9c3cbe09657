//! The configuration of an environment: every key of the API page with its default and its errors.
//!
//! A configuration file is a flat YAML mapping; one key has a list of names. Keys that are left out have their documented default. A key
//! that does not exist, appears twice or has an invalid value is an error that names location, key, value and the allowed values. YAML
//! 1.1's booleans (`True`, `yes`, `on` ...) are accepted as PyYAML accepts them; anchors, aliases and tags are not.
//!
//! ```
//! use babybench::config::{Behavior, Scene};
//! use babybench::Config;
//!
//! let config = Config::from_yaml("behavior: self_touch\nscene: crib\ntouch_eyes: True\n", "example.yml")?;
//! assert_eq!((config.behavior, config.scene), (Behavior::SelfTouch, Scene::Crib));
//! assert_eq!(config.max_episode_steps, 1000);
//!
//! let error = Config::from_yaml("behaviour: self_touch\n", "example.yml").unwrap_err();
//! assert_eq!(error.to_string(), "example.yml:1:1: unknown key `behaviour`; did you mean `behavior`?");
//! # Ok::<(), babybench::config::ConfigError>(())
//! ```
//!
//! With the feature `serde`, a [`Config`] is a flat map in every format that serde knows, with the same keys, defaults and
//! checks.

mod ages;
mod choices;
mod conflicts;
mod defaults;
mod error;
mod examples;
mod keys;
mod kinds;
pub(crate) mod latencies;
mod outputs;
mod parts;
mod reader;
mod reflexes;
mod scene;
mod schedule;
mod senses;
#[cfg(feature = "eval")]
mod serial;
pub(crate) mod table;
mod yaml;

#[cfg(test)]
mod tests;

pub use choices::{
    ActuationModel, Behavior, Compat, DelayUnit, EngineKind, FacialExpression, Learner, Limb, Proportions, Reflex,
    ReflexVor, RendererKind, Sex, SpringModel, StartingPosition, StrengthModel, TouchFunction, TouchResponse,
    VisionOutput,
};
pub use error::{ConfigError, Location};
pub use examples::Example;
pub use kinds::{KeyKind, KeyValue};
pub use outputs::VisionOutputs;
pub use parts::{BodyParts, Part};
pub use reader::ConfigReader;
pub use reflexes::ReflexSet;
pub use scene::Scene;
pub use schedule::AgeSchedule;
pub use table::Config;
pub use table::Key;
pub use table::{
    CatchOptions, Delays, EyeOptions, IndividualOptions, MAX_AGE, Measurements, MobileOptions, NoiseLevels,
    PainOptions, PlayOptions, ReflexDelays, ReflexGains, ReflexOptions, RollOverOptions, StrengthFactors,
};

use std::path::Path;

impl Config {
    /// Reads a configuration; `file_name` only names the file in errors, and the path of a scene starts at the working directory.
    /// [`ConfigReader`] accepts other defaults, another folder or other limits.
    ///
    /// # Errors
    /// Returns the first fault of the text, see [`ConfigError`].
    pub fn from_yaml(text: &str, file_name: &str) -> Result<Self, ConfigError> {
        ConfigReader::default().read_text(text, file_name)
    }

    /// Reads a configuration file. The path of a scene in it starts at the file's folder.
    ///
    /// # Errors
    /// Fails like [`Config::from_yaml`], and if the file cannot be read or is not UTF-8.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        ConfigReader::default().read_file(path)
    }

    /// Writes the configuration as a documented file that loads back equal.
    pub fn to_yaml(&self) -> String {
        let mut out = String::from("# Configuration of a BabyBench environment. Keys left out have their default.\n");
        let mut section = "";
        for key in Self::keys() {
            if key.section != section {
                section = key.section;
                out.push_str(&format!("\n# --- {section} ---\n"));
            }
            let options = match key.kind {
                KeyKind::Choice(names) | KeyKind::List(names) | KeyKind::NoneOrList(names) => {
                    format!(" Options: {}.", names.join(", "))
                }
                KeyKind::ChoiceOrFile { .. } => format!(" Options: {}.", key.kind.expected()),
                _ => String::new(),
            };
            let (doc, default) = (key.doc, key.default_value().to_yaml());
            out.push_str(&format!("# {doc}{options} Default: {default}\n"));
            out.push_str(&format!("{}: {}\n", key.name, key.value(self).to_yaml()));
        }
        out
    }

    /// Returns every key with its values and meaning, in the order of [`Config::to_yaml`].
    pub fn keys() -> &'static [Key] {
        table::KEYS
    }

    /// Returns the configuration of a file that sets only this behavior. Tasks have defaults of their own.
    ///
    /// ```
    /// use babybench::config::Behavior;
    /// use babybench::Config;
    ///
    /// let reach = Config::of(Behavior::Reach);
    /// assert_eq!((reach.frame_skip, reach.vision_active), (2, false));
    /// assert_eq!(reach, Config::from_yaml("behavior: reach", "reach.yml")?);
    /// # Ok::<(), babybench::config::ConfigError>(())
    /// ```
    pub fn of(behavior: Behavior) -> Self {
        let mut config = Self {
            behavior,
            ..Self::default()
        };
        // nothing was given in a file, so every key takes the default of the task
        config.take_defaults(|_| false);
        config
    }

    /// Returns whether touch is observed: it is active and its scale is not 0.
    pub fn touch_enabled(&self) -> bool {
        self.touch_active && self.touch_scale > 0.0
    }

    /// Checks every value by itself and against the others, as reading a file does.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn validate(&self) -> Result<(), ConfigError> {
        self.check("configuration", |_| None)
    }

    /// Validates the configuration and names the position of a key at fault; see [`Config::validate`].
    fn check(&self, file: &str, position: impl Fn(&str) -> Option<(u32, u32)>) -> Result<(), ConfigError> {
        let location = |position| Location {
            file: file.to_string(),
            position,
        };
        for key in Self::keys() {
            // fields are public, so a program may have set any value
            let value = key.value(self);
            if let Err(misfit) = key.kind.check(&value) {
                return Err(yaml::refusal(
                    key,
                    misfit,
                    value.to_yaml(),
                    location(position(key.name)),
                ));
            }
        }
        match self.conflict() {
            Some((key, value, reason)) => {
                // a default that conflicts is nowhere in the file: the key that excludes it is, which the reason names in most cases
                let named = reason.split('`').skip(1).step_by(2);
                let excluding = named.filter_map(|words| position(words.split(':').next()?)).next();
                let at = position(key).or(excluding).or_else(|| position("behavior"));
                let location = location(at);
                Err(ConfigError::Conflict {
                    location,
                    key,
                    value,
                    reason,
                })
            }
            None => Ok(()),
        }
    }
}
