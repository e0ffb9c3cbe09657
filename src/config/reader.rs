//! Reading of configurations, with the values of missing keys, the folder at which paths start, and the limits of a text.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::error::{ConfigError, Location};
use super::table::{Config, KEYS};
use super::yaml;
use crate::files;
use crate::limits::Limits;

/// Reads configurations with defaults, a folder and limits of your own.
///
/// ```
/// use babybench::config::{Compat, Config, ConfigReader};
///
/// let base = Config { compat: Compat::Reference, ..Config::default() };
/// let config = ConfigReader::over(base).read_text("touch_function: normal_force\n", "recorded.yml")?;
/// assert_eq!(config.compat, Compat::Reference);
/// # Ok::<(), babybench::config::ConfigError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConfigReader {
    /// Values of keys that a text leaves out: by default the documented ones.
    pub base: Config,
    /// The folder at which the path of a scene in a text starts: by default the working directory. A file's path starts at its own folder.
    pub folder: PathBuf,
    /// Limits; only [`Limits::config_bytes`] applies.
    pub limits: Limits,
}

impl ConfigReader {
    /// Returns a reader for which missing keys have the values of `base`.
    pub fn over(base: Config) -> Self {
        Self {
            base,
            ..Self::default()
        }
    }

    /// Reads a configuration; `file_name` only names the file in errors.
    ///
    /// # Errors
    /// Returns the first fault of the text, see [`ConfigError`]; fails, too, if the name of the folder is needed and is not UTF-8.
    pub fn read_text(self, text: &str, file_name: &str) -> Result<Config, ConfigError> {
        let Self {
            base: mut config,
            folder,
            limits,
        } = self;
        let at = |position| Location {
            file: file_name.to_string(),
            position,
        };
        let limit = limits.config_bytes;
        if text.len() > limit {
            return Err(ConfigError::TooLarge {
                location: at(None),
                limit,
            });
        }
        let before = config.behavior;
        let positions = yaml::read(text, file_name, &mut config)?;
        // for the same behavior, the base has these defaults already or its caller has changed them
        if config.behavior != before {
            // the defaults of some keys are those of the behavior, unless the text sets them
            config.take_defaults(|key| positions[key].is_some());
        }
        let position = |name: &str| {
            let index = KEYS.iter().position(|key| key.name == name)?;
            positions[index]
        };
        if let Some(given) = position("scene") {
            let Some(scene) = config.scene.starting_at(&folder) else {
                return Err(ConfigError::Conflict {
                    location: at(Some(given)),
                    key: "scene",
                    value: config.scene.to_string(),
                    reason: "the folder of the configuration, where it starts, has a name that is not UTF-8; rename the folder"
                        .to_string(),
                });
            };
            config.scene = scene;
        }
        config.check(file_name, position)?;
        Ok(config)
    }

    /// Reads a configuration file.
    ///
    /// # Errors
    /// Fails like [`ConfigReader::read_text`], and if the file cannot be read or is not UTF-8.
    pub fn read_file(mut self, path: impl AsRef<Path>) -> Result<Config, ConfigError> {
        let path = path.as_ref();
        let file = path.display().to_string();
        let limit = self.limits.config_bytes;
        let bytes = match files::read(path, limit as u64) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == ErrorKind::FileTooLarge => {
                let location = Location { file, position: None };
                return Err(ConfigError::TooLarge { location, limit });
            }
            Err(source) => return Err(ConfigError::Read { file, source }),
        };
        match std::str::from_utf8(&bytes) {
            Ok(text) => {
                self.folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
                self.read_text(text, &file)
            }
            Err(error) => {
                let position = Some(end_of(&bytes[..error.valid_up_to()]));
                Err(ConfigError::Encoding {
                    location: Location { file, position },
                })
            }
        }
    }
}

/// Returns the line and the column at which valid UTF-8 ends. The column counts characters, as editors do, not bytes.
fn end_of(good: &[u8]) -> (u32, u32) {
    let line = 1 + good.iter().filter(|byte| **byte == b'\n').count() as u32;
    let last = String::from_utf8_lossy(good);
    let column = 1 + last.chars().rev().take_while(|c| *c != '\n').count() as u32;
    (line, column)
}
