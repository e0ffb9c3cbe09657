//! The text of the top MJCF document of an environment.

use std::path::Path;

use super::version::{MIMO, Version};
use crate::config::{ActuationModel, Behavior, Config, Part, Scene};

/// Path of the top document in the assets; includes and textures are found relative to it.
pub const DOCUMENT: &str = "babybench/scene.xml";

/// The path of the top document around a custom scene, which may be called `scene.xml` itself.
const AROUND: &str = "babybench/*";

/// The file of the elements added to a scene of the library.
pub(super) const EXTRA_FILE: &str = "scene_extra.xml";

/// Returns the path of the top document of a configuration.
pub(crate) fn document_path(config: &Config) -> &'static str {
    match config.scene {
        Scene::File(_) => AROUND,
        _ => DOCUMENT,
    }
}

/// Order of the actuator groups in the document, which determines actuator ids.
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

/// Returns the top document of an environment: that of its task, that of BabyBench's scenes, or one that includes a custom scene, which
/// [`scene_assets`](crate::mimo::scene_assets) has.
pub fn scene_xml(config: &Config) -> String {
    let name = match config.age {
        None => "MIMo".to_string(),
        Some(age) => format!("MIMo at {age} months"),
    };
    let content = match &config.scene {
        _ if has_own_scene(config.behavior) => include(config.behavior.name()),
        Scene::File(path) => format!("  <include file=\"{}\"/>\n", quick_xml::escape::escape(file_name(path))),
        _ => babybench_scene(config),
    };
    format!("<mujoco model=\"{name}\">\n{content}</mujoco>\n")
}

/// Returns whether a behavior is a task whose scene cannot be chosen.
pub(crate) fn has_own_scene(behavior: Behavior) -> bool {
    match behavior {
        Behavior::None | Behavior::SelfTouch | Behavior::HandRegard | Behavior::Mobile | Behavior::Play => false,
        Behavior::Reach | Behavior::Standup | Behavior::SelfBody | Behavior::Catch | Behavior::RollOver => true,
    }
}

/// Writes the document of a BabyBench scene: MIMo at its initial pose, the base, MIMo's settings, the actuators of the
/// active groups, the scene. Element order determines all ids and follows the reference.
fn babybench_scene(config: &Config) -> String {
    let version = Version::of(config.behavior).name();
    let pose = match config.scene {
        Scene::Base | Scene::Blanket | Scene::File(_) => r#"pos="0 0 0.1" euler="0 -90 0""#,
        Scene::Crib | Scene::Mobile => r#"pos="0 0 0.3" euler="0 -90 0""#,
        Scene::Cubes | Scene::Playroom => r#"pos="0 0 0.0467196" quat="0.885453 -0.000184209 -0.464728 -0.000527509""#,
    };
    let mut xml = format!(
        "  <worldbody>\n    <body name=\"{MIMO}\" {pose}>\n      <freejoint name=\"{MIMO}\"/>\n      \
         <include file=\"mimo_{version}.xml\"/>\n    </body>\n  </worldbody>\n"
    );
    xml += &include("base");
    xml += &include(&format!("meta_{version}"));
    xml += &actuators(config);
    match config.scene {
        Scene::Base | Scene::File(_) => {}
        Scene::Crib => xml += &include("crib"),
        Scene::Cubes => xml += &include("cubes"),
        Scene::Mobile => {
            xml += &include("crib");
            xml += &include("mobile");
        }
        Scene::Playroom => xml += &include("playroom"),
        Scene::Blanket => xml += &include("blanket"),
    }
    if !config.scene_extra.is_empty() {
        xml += &include(EXTRA_FILE.trim_end_matches(".xml"));
    }
    xml
}

/// Writes the lines that include the actuators of the active groups.
pub(super) fn actuators(config: &Config) -> String {
    let version = Version::of(config.behavior).name();
    let kind = match config.actuation_model {
        ActuationModel::SpringDamper | ActuationModel::Muscle => "motor",
        ActuationModel::Positional => "position",
    };
    let active = ACTUATOR_GROUPS.iter().filter(|part| config.act.get(**part));
    let files = active.map(|part| {
        let suffix = match part {
            Part::Fingers | Part::Feet => format!("_{version}"),
            _ => String::new(),
        };
        include(&format!("{kind}_{}{suffix}", part.name()))
    });
    files.collect()
}

/// Writes the line that includes a file of the assets.
pub(super) fn include(file: &str) -> String {
    format!("  <include file=\"{file}.xml\"/>\n")
}

/// Returns the last part of a path.
pub(super) fn file_name(path: &str) -> &str {
    let name = Path::new(path).file_name().and_then(|name| name.to_str());
    name.unwrap_or(path)
}
