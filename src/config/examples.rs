//! The example configurations: the three of BabyBench, and one for each task.

use super::{Config, ConfigError};

/// An example configuration, as it stands in `configs/`.
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
    pub const TEST_INSTALLATION: Self = Self {
        name: "test_installation",
        yaml: include_str!("../../configs/config_test_installation.yml"),
    };
    /// BabyBench's three examples.
    pub const ALL: [Self; 3] = [Self::SELF_TOUCH, Self::HAND_REGARD, Self::TEST_INSTALLATION];
    /// An example for each task, by the name of its behavior.
    pub const TASKS: [Self; 7] = [
        Self {
            name: "reach",
            yaml: include_str!("../../configs/config_reach.yml"),
        },
        Self {
            name: "standup",
            yaml: include_str!("../../configs/config_standup.yml"),
        },
        Self {
            name: "selfbody",
            yaml: include_str!("../../configs/config_selfbody.yml"),
        },
        Self {
            name: "catch",
            yaml: include_str!("../../configs/config_catch.yml"),
        },
        Self {
            name: "roll_over",
            yaml: include_str!("../../configs/config_roll_over.yml"),
        },
        Self {
            name: "mobile",
            yaml: include_str!("../../configs/config_mobile.yml"),
        },
        Self {
            name: "play",
            yaml: include_str!("../../configs/config_play.yml"),
        },
    ];

    /// Parses the example.
    ///
    #[cfg_attr(feature = "internals", doc = "```")]
    #[cfg_attr(not(feature = "internals"), doc = "```ignore")]
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
