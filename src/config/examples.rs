//! The example configurations: the three of BabyBench, and one for each task.

use super::{Config, ConfigError};

/// Makes the example of a name from `configs/config_NAME.yml`.
macro_rules! example {
    ($name:literal) => {
        Example {
            name: $name,
            yaml: include_str!(concat!("../../configs/config_", $name, ".yml")),
        }
    };
}

/// An example configuration from `configs/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// Name: `self_touch`, `hand_regard`, `test_installation`, or that of a task.
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
    pub const TEST_INSTALLATION: Self = example!("test_installation");
    /// BabyBench's three examples.
    pub const ALL: [Self; 3] = [Self::SELF_TOUCH, Self::HAND_REGARD, Self::TEST_INSTALLATION];
    /// An example for each task, by the name of its behavior.
    pub const TASKS: [Self; 7] = [
        example!("reach"),
        example!("standup"),
        example!("selfbody"),
        example!("catch"),
        example!("roll_over"),
        example!("mobile"),
        example!("play"),
    ];

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
