//! The top MJCF document of an environment.

use std::fmt::Write as _;

use thiserror::Error;

use crate::assets::AssetSource;
use crate::config::{ActuationModel, Behavior, Config, Part, Scene};
use crate::mimo::placement::lowest_point;
use crate::mimo::{Growth, GrowthError};
use crate::mjcf_loader::{Draft, LoadError};
use crate::model::Model;
use crate::physics::{EngineError, compile};

/// Gives the path of the top document in the assets; includes and textures are found relative to it.
pub const DOCUMENT: &str = "babybench/scene.xml";

/// Name of the body that places MIMo in the world, and of its free joint.
const MIMO: &str = "mimo_location";

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
    let name = match config.age {
        None => "MIMo".to_string(),
        Some(age) => format!("MIMo at {age} months"),
    };
    let mut xml = format!(
        "<mujoco model=\"{name}\">\n  <worldbody>\n    <body name=\"{MIMO}\" {pose}>\n      \
         <freejoint name=\"{MIMO}\"/>\n      <include file=\"mimo_{version}.xml\"/>\n    </body>\n  \
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

/// An error in making a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The assets cannot be read or compiled.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// MIMo cannot grow to the age of the configuration.
    #[error(transparent)]
    Growth(#[from] GrowthError),
    /// MIMo of that age has no pose that can be simulated.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// Loads and compiles the scene of a configuration from `assets`, with MIMo at his age.
///
/// A MIMo of another size than the original's is moved up or down until his lowest point is where the original's is.
///
/// # Errors
/// Fails if the assets cannot be read or compiled, and then names file, line and element; if MIMo cannot grow to the age.
pub fn build_model(config: &Config, assets: &dyn AssetSource) -> Result<Model, SceneError> {
    let document = scene_xml(config);
    let original = || Draft::read_str(&document, DOCUMENT, assets);
    let Some(growth) = Growth::of(config)? else {
        return Ok(compile(original()?.compile(assets)?)?);
    };
    let grown = |up: f64| -> Result<Model, SceneError> {
        let mut draft = original()?;
        growth.apply(&mut draft)?;
        if let Some(pos) = draft.body_pos(MIMO) {
            pos[2] += up;
        }
        Ok(compile(draft.compile(assets)?)?)
    };
    let before = lowest_point(&compile(original()?.compile(assets)?)?.into())?;
    let after = lowest_point(&grown(0.0)?.into())?;
    grown(before - after)
}
