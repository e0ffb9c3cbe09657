//! The top MJCF document of an environment.

use thiserror::Error;

use crate::assets::AssetSource;
use crate::config::{ActuationModel, Behavior, Config, FacialExpression, Measurements, Part, Scene};
use crate::math::{Vec3, scale};
use crate::mimo::growth::blame;
use crate::mimo::placement::{LowestPoint, Overlap, overlaps};
use crate::mimo::room::{EXTRA_FILE, OTHER_PREFIX, Room, RoomError, file_name, location};
use crate::mimo::{Growth, GrowthError};
use crate::mjcf_loader::{Draft, LoadError};
use crate::model::Model;
use crate::physics::{EngineError, compile};

/// Gives the path of the top document in the assets; includes and textures are found relative to it.
pub const DOCUMENT: &str = "babybench/scene.xml";

/// The path of the top document around a custom scene, which may be called `scene.xml` itself.
const AROUND: &str = "babybench/*";

/// Name of the body that places MIMo in the world, and of its free joint.
pub(super) const MIMO: &str = "mimo_location";

/// The material of MIMo's head.
const HEAD: &str = "head";

/// Names of the cameras in the eyes, left and right, which are also the keys of the observation.
pub const EYES: [&str; 2] = ["eye_left", "eye_right"];

/// Returns the path of the top document of a configuration.
pub(crate) fn document_path(config: &Config) -> &'static str {
    match config.scene {
        Scene::File(_) => AROUND,
        _ => DOCUMENT,
    }
}

/// A version of MIMo.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Version {
    /// MIMo with mitten hands and simple feet: 47 joints.
    V1,
    /// MIMo with five-fingered hands and big toes: 91 joints.
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
/// active groups, the scene. Element order fixes all ids, and is the reference's.
fn babybench_scene(config: &Config) -> String {
    let version = Version::of(config.behavior).name();
    let pose = match config.scene {
        Scene::Base | Scene::File(_) => r#"pos="0 0 0.1" euler="0 -90 0""#,
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

/// An error in making a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The assets cannot be read or compiled.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A custom scene is not as it must be.
    #[error(transparent)]
    Room(#[from] RoomError),
    /// MIMo cannot grow to the age of the configuration.
    #[error(transparent)]
    Growth(#[from] GrowthError),
    /// MIMo of that age has no pose that can be simulated.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// Loads and compiles the scene of a configuration from `assets`, with MIMo at his age.
///
/// A MIMo of another size than the original is moved up or down until his lowest point is where the original's is, both in the posture in
/// which the scene holds them. A custom scene is one of the assets, or otherwise a file of the system; see
/// [`scene_assets`](crate::mimo::scene_assets).
///
/// # Errors
/// Fails if the assets cannot be read or compiled, and then names file, line and element; if a custom scene lacks MIMo or changes
/// him; if MIMo cannot grow to the age, or measurements make a body whose parts vanish or are in each other, and then names the keys.
pub fn build_model(config: &Config, assets: &dyn AssetSource) -> Result<Model, SceneError> {
    build_scene(&scene_xml(config), Version::of(config.behavior), config, assets)
}

/// Compiles a document with a MIMo of some version, at the age of a configuration; see [`build_model`].
///
/// # Errors
/// As [`build_model`].
pub fn build_scene(
    document: &str,
    version: Version,
    config: &Config,
    assets: &dyn AssetSource,
) -> Result<Model, SceneError> {
    let path = document_path(config);
    let Some(room) = Room::open(config, assets)? else {
        return Source::of(config, document, path, assets).build(version, config);
    };
    let source = Source::of(config, document, path, &room);
    if document != scene_xml(config) {
        // a task with a document of its own, in which the room may or may not be
        return source.build(version, config).map_err(|e| room.localized(e));
    }
    room.check(&source)?;
    let model = source.build(version, config).map_err(|e| room.localized(e))?;
    room.compare(&source, &model, config)?;
    Ok(model)
}

/// A document and what it includes.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub document: &'a str,
    /// Its file name in the assets.
    pub path: &'a str,
    /// His face: the texture of the material of his head.
    face: FacialExpression,
    /// The vertical fields of view of his left and his right eye, degrees, where the configuration has its own.
    fields: [Option<f64>; 2],
    pub assets: &'a dyn AssetSource,
}

impl<'a> Source<'a> {
    /// Returns a document, read as file `path` of the assets, with the MIMo of a configuration in it.
    pub fn of(config: &Config, document: &'a str, path: &'a str, assets: &'a dyn AssetSource) -> Self {
        Self {
            document,
            path,
            face: config.facial_expression,
            fields: config.eyes.fields(),
            assets,
        }
    }

    fn read(&self) -> Result<Draft, LoadError> {
        let mut draft = Draft::read_str(self.document, self.path, self.assets)?;
        if self.face != FacialExpression::Default
            && let Some(texture) = draft.material_texture(HEAD)
        {
            *texture = Some(format!("tex_head_{}", self.face));
        }
        for (eye, field) in EYES.into_iter().zip(self.fields) {
            if let (Some(fovy), Some(field)) = (draft.camera_fovy(eye), field) {
                *fovy = field;
            }
        }
        Ok(draft)
    }

    /// Compiles the document with MIMo of the original proportions.
    pub fn original(&self) -> Result<Model, SceneError> {
        Ok(compile(self.read()?.compile(self.assets)?)?)
    }

    /// Compiles the document with MIMo at the age of a configuration.
    fn build(&self, version: Version, config: &Config) -> Result<Model, SceneError> {
        let place = location(config.learner);
        let other = other_growth(config, version)?;
        let Some(growth) = Growth::of(config, version)? else {
            let mut draft = self.read()?;
            grow_other(&mut draft, other.as_ref())?;
            return Ok(compile(draft.compile(self.assets)?)?);
        };
        let made = self.grow(&growth, other.as_ref(), place);
        if config.measurements == Measurements::default() {
            return made;
        }
        // user-supplied measurements may describe an impossible body
        let age = growth.age();
        let ordinary = Config {
            measurements: Measurements::default(),
            ..config.clone()
        };
        let usual = overlaps(&self.build(version, &ordinary)?.into())?;
        let fault = |made: &Result<Model, SceneError>| -> Option<String> {
            match made {
                Ok(model) => {
                    let found = overlaps(&model.clone().into()).ok()?;
                    deeper(model, &found, &usual)
                }
                Err(e) => Some(format!("the body cannot be made ({e})")),
            }
        };
        let Some(reason) = fault(&made) else { return made };
        let works = |other: &Config| {
            let growth = Growth::of(other, version).ok().flatten();
            growth.is_some_and(|growth| fault(&self.grow(&growth, None, place)).is_none())
        };
        Err(blame(config, age, reason, works).into())
    }

    /// Compiles the scene with a MIMo that has grown, his lowest point where the original's is.
    fn grow(&self, growth: &Growth, other: Option<&Growth>, place: &str) -> Result<Model, SceneError> {
        let grown = |shift: Vec3| -> Result<Model, SceneError> {
            let mut draft = self.read()?;
            growth.apply(&mut draft)?;
            grow_other(&mut draft, other)?;
            if let Some(pos) = draft.body_pos(place) {
                pos.iter_mut().zip(shift).for_each(|(x, by)| *x += by);
            }
            Ok(compile(draft.compile(self.assets)?)?)
        };
        let before = LowestPoint::of(&self.original()?.into())?;
        let after = LowestPoint::of(&grown([0.0; 3])?.into())?;
        grown(scale(before.up, before.height - after.height))
    }
}

/// Returns how the second infant grows to his age; `None` if he has none.
fn other_growth(config: &Config, version: Version) -> Result<Option<Growth>, SceneError> {
    let own = Config {
        age: config.other_age,
        strength_age: None,
        measurements: Measurements::default(),
        ..config.clone()
    };
    Ok(Growth::of(&own, version)?)
}

/// Gives the second infant of a document his age.
fn grow_other(draft: &mut Draft, growth: Option<&Growth>) -> Result<(), SceneError> {
    let Some(growth) = growth else { return Ok(()) };
    draft.set_prefix(OTHER_PREFIX);
    let grown = growth.apply(draft);
    draft.set_prefix("");
    Ok(grown?)
}

/// Tolerance of the overlap of two parts over that at the same age without measurements, m.
const OVERLAP: f64 = 0.003;

/// Returns two parts of MIMo that overlap more than usual, if any.
fn deeper(model: &Model, found: &[Overlap], usual: &[Overlap]) -> Option<String> {
    let name = |geom: usize| &model.body_name[model.geom_bodyid[geom]];
    found.iter().find_map(|o| {
        let before = usual.iter().find(|u| u.geoms == o.geoms).map_or(0.0, |u| u.depth);
        let (a, b, depth) = (name(o.geoms[0]), name(o.geoms[1]), 1e3 * o.depth);
        let text = || format!("{a:?} and {b:?} are {depth:.1} mm in each other at rest");
        (o.depth > before + OVERLAP).then(text)
    })
}
