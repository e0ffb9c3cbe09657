//! The top MJCF document of an environment.

use std::fmt::Write as _;

use crate::assets::AssetSource;
use crate::config::{ActuationModel, Behavior, Config, Part, Scene};
use crate::mjcf_loader::{LoadError, load_str};
use crate::model::Model;
use crate::physics::compile;

/// Gives the path of the top document in the assets; includes and textures are found relative to it.
pub const DOCUMENT: &str = "babybench/scene.xml";

/// A version of MIMo.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Version {
    /// MIMo with mitten hands and simple feet: 47 joints.
    V1,
    /// MIMo with five-fingered hands and big toes: 91 joints.
    V2,
}

impl Version {
    /// Returns the version for a behavior: hand regard has fingers to look at, everything else is faster without.
    pub fn of(behavior: Behavior) -> Self {
        match behavior {
            Behavior::HandRegard => Self::V2,
            Behavior::None | Behavior::SelfTouch => Self::V1,
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

/// Order of the actuator groups in the document, which fixes actuator ids.
const ACTUATOR_GROUPS: [Part; 8] = [
    Part::Body,
    Part::Head,
    Part::Eyes,
    Part::Arms,
    Part::Hands,
    Part::Fingers,
    Part::Legs,
    Part::Feet,
];

/// Writes the top document of an environment: MIMo at its initial pose, the base, MIMo's settings, the actuators of the
/// active groups, the scene. Element order fixes all ids, and is the reference's.
pub fn scene_xml(config: &Config) -> String {
    let version = Version::of(config.behavior).name();
    let pose = match config.scene {
        Scene::Base => r#"pos="0 0 0.1" euler="0 -90 0""#,
        Scene::Crib => r#"pos="0 0 0.3" euler="0 -90 0""#,
        Scene::Cubes => r#"pos="0 0 0.0467196" quat="0.885453 -0.000184209 -0.464728 -0.000527509""#,
    };
    let mut xml = format!(
        "<mujoco model=\"MIMo\">\n  <worldbody>\n    <body name=\"mimo_location\" {pose}>\n      \
         <freejoint name=\"mimo_location\"/>\n      <include file=\"mimo_{version}.xml\"/>\n    </body>\n  \
         </worldbody>\n"
    );
    let mut include = |file: &str| {
        // writing to a string cannot fail
        let _ = writeln!(xml, "  <include file=\"{file}.xml\"/>");
    };
    include("base");
    include(&format!("meta_{version}"));
    let kind = match config.actuation_model {
        ActuationModel::SpringDamper | ActuationModel::Muscle => "motor",
        ActuationModel::Positional => "position",
    };
    for part in ACTUATOR_GROUPS {
        if config.act.get(part) {
            let suffix = match part {
                Part::Fingers | Part::Feet => format!("_{version}"),
                _ => String::new(),
            };
            include(&format!("{kind}_{}{suffix}", part.name()));
        }
    }
    match config.scene {
        Scene::Base => {}
        Scene::Crib => include("crib"),
        Scene::Cubes => include("cubes"),
    }
    xml.push_str("</mujoco>\n");
    xml
}

/// Loads and compiles the scene of a configuration from `assets`.
///
/// # Errors
/// Fails if the assets cannot be read or compiled; the error names file, line and element.
pub fn build_model(config: &Config, assets: &dyn AssetSource) -> Result<Model, LoadError> {
    compile(load_str(&scene_xml(config), DOCUMENT, assets)?)
}
