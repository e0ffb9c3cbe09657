//! The three example configurations of BabyBench.

use super::{Config, ConfigError};

/// An example configuration, as it stands in `configs/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// Name: `self_touch`, `hand_regard` or `test_installation`.
    pub name: &'static str,
    /// Text of the file.
    pub yaml: &'static str,
}

impl Example {
    /// Self-touch in the crib: MIMo v1, proprioception, touch and balance.
    pub const SELF_TOUCH: Self = Self {
        name: "self_touch",
        yaml: include_str!("../../configs/config_selftouch.yml"),
    };
    /// Hand regard among the cubes: MIMo v2, proprioception, balance and both eyes.
    pub const HAND_REGARD: Self = Self {
        name: "hand_regard",
        yaml: include_str!("../../configs/config_handregard.yml"),
    };
    /// Installation test: MIMo v1 on the bare floor with every sense.
    pub const TEST_INSTALLATION: Self = Self {
        name: "test_installation",
        yaml: include_str!("../../configs/config_test_installation.yml"),
    };
    /// All three examples.
    pub const ALL: [Self; 3] = [Self::SELF_TOUCH, Self::HAND_REGARD, Self::TEST_INSTALLATION];

    /// Parses the example.
    ///
    /// ```
    /// use babybench::config::{Behavior, Example};
    ///
    /// assert_eq!(Example::HAND_REGARD.config()?.behavior, Behavior::HandRegard);
    /// # Ok::<(), babybench::config::ConfigError>(())
    /// ```
    ///
    /// # Errors
    /// Never fails: the examples are valid.
    pub fn config(self) -> Result<Config, ConfigError> {
        Config::from_yaml(self.yaml, self.name)
    }
}
