//! The versions of MIMo, and names that both share.

use super::third::CHEST;
use crate::config::{Behavior, Config};

/// Prefix of the names of the second infant's parts.
pub(crate) const SECOND_PREFIX: &str = "other:";

/// Name of the body that places MIMo in the world, and of its free joint.
pub(super) const MIMO: &str = "mimo_location";

/// Names of the cameras in the eyes, left and right, which are also the keys of the observation.
pub const EYES: [&str; 2] = ["eye_left", "eye_right"];

/// A version of MIMo.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Version {
    /// MIMo with mitten hands and simple feet: 47 joints, and 49 with the chest of MIMo 3.
    V1,
    /// MIMo with five-fingered hands and big toes: 91 joints, and 93 with the chest of MIMo 3.
    V2,
}

impl Version {
    /// Returns the version for a behavior: hand regard and catching need fingers, everything else is faster without them.
    pub fn of(behavior: Behavior) -> Self {
        match behavior {
            Behavior::HandRegard | Behavior::Catch | Behavior::Play => Self::V2,
            Behavior::None
            | Behavior::SelfTouch
            | Behavior::Reach
            | Behavior::Standup
            | Behavior::SelfBody
            | Behavior::RollOver
            | Behavior::Mobile => Self::V1,
        }
    }

    /// Returns the name of the body of a configuration after "MIMo": `v1`, `v2`, or with the chest of MIMo 3 `3 v1`, `3 v2`.
    ///
    /// ```
    /// use babybench::Config;
    /// use babybench::mimo::Version;
    ///
    /// assert_eq!(Version::label(&Config::default()), "v1");
    /// assert_eq!(Version::label(&Config { mimo_version: 3, ..Config::default() }), "3 v1");
    /// ```
    pub fn label(config: &Config) -> &'static str {
        match (Self::of(config.behavior), config.mimo_version) {
            (Self::V1, CHEST) => "3 v1",
            (Self::V2, CHEST) => "3 v2",
            (version, _) => version.name(),
        }
    }

    /// Returns `v1` or `v2`.
    pub fn name(self) -> &'static str {
        match self {
            Self::V1 => "v1",
            Self::V2 => "v2",
        }
    }
}
