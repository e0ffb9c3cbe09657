//! `scene.xml`: the complete scene of an environment in one MJCF document, which this library and MuJoCo load.
//!
//! Includes are replaced by their contents; a comment at the top holds the configuration. Images, meshes and attached models are
//! written next to it into `tex/`, `mesh/` and `models/`, so that the folder can be moved as a whole.

mod complete;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::assets::{AssetSource, DirAssets, directory};
use crate::config::{Compat, Config, ConfigError};
use crate::env::Blueprint;
use crate::files::{self, replace_file};
use crate::limits::Limits;
use crate::mimo::{
    CustomSceneError, Version, VersionAssets, document_path, embedded, has_own_scene, open_custom_scene, scene_xml,
};
use crate::mjcf_loader::{LoadError, load};
use crate::model::Model;
use crate::physics::compile;
use complete::{IMAGES, complete};

/// The document in the folder of a run.
const SCENE: &str = "scene.xml";
/// An error in writing or reading the file of a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The file system returned an error.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// An asset cannot be merged into one document.
    #[error("scene: {file}: {reason}")]
    Asset {
        /// The asset.
        file: String,
        /// Description of the fault.
        reason: String,
    },
    /// The scene does not load.
    #[error("cannot load the scene: {0}")]
    Load(#[from] LoadError),
    /// The custom scene cannot be read.
    #[error(transparent)]
    CustomScene(#[from] CustomSceneError),
    /// The folder holds the scene of another run.
    #[error(
        "{}: this is {found}, but the configuration describes {wanted}; positions and geoms in the logs would not \
         match the scene: give the configuration a save_dir of its own", path.display()
    )]
    Different {
        /// The document.
        path: PathBuf,
        /// Its kind.
        found: String,
        /// The expected kind.
        wanted: String,
    },
    /// The comment of the scene has no configuration, or an invalid one.
    #[error("invalid configuration in the comment of the scene: {0}")]
    Config(#[from] ConfigError),
}

/// A document and the files that it names, by relative path.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The document.
    pub xml: String,
    /// The images, meshes and attached models.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// Returns the scene of a configuration, from the embedded assets, as one document.
///
/// # Errors
/// None with the embedded assets.
pub fn complete_scene(config: &Config) -> Result<SceneFile, SceneFileError> {
    complete_scene_from(config, &embedded())
}

/// Returns the scene of a configuration, from assets laid out like the embedded ones, as one document.
///
/// # Errors
/// Assets that are missing or not XML.
pub fn complete_scene_from(config: &Config, assets: &dyn AssetSource) -> Result<SceneFile, SceneFileError> {
    let assets = VersionAssets::new(config, assets);
    let room = open_custom_scene(config, &assets)?;
    complete_document(&scene_xml(config), config, room.as_ref().map_or(&assets, |room| room))
}

/// Writes a document of a configuration as one document.
fn complete_document(document: &str, config: &Config, assets: &dyn AssetSource) -> Result<SceneFile, SceneFileError> {
    complete(document, document_path(config), comment(config), assets)
}

/// Writes `scene.xml` and its files, from the embedded assets, into the folder of a run, which is created if necessary.
///
/// # Errors
/// Errors of the file system.
#[doc(alias("mj_saveLastXML", "mj_saveXML"))]
pub fn write_scene(config: &Config, save_dir: &Path) -> Result<PathBuf, SceneFileError> {
    write_scene_from(config, &embedded(), save_dir)
}

/// Writes `scene.xml` as [`write_scene`] does, from assets laid out like the embedded ones.
///
/// # Errors
/// Assets that are missing or not XML; errors of the file system.
pub fn write_scene_from(config: &Config, assets: &dyn AssetSource, save_dir: &Path) -> Result<PathBuf, SceneFileError> {
    write_scene_file(&complete_scene_from(config, assets)?, save_dir)
}

/// Writes the scene of a blueprint with any task into the folder of its run.
pub(super) fn write_scene_of(blueprint: &Blueprint) -> Result<PathBuf, SceneFileError> {
    let config = blueprint.config();
    let scene = complete_document(&blueprint.task().document(config).xml, config, blueprint.assets())?;
    write_scene_file(&scene, Path::new(&config.save_dir))
}

fn write_scene_file(scene: &SceneFile, save_dir: &Path) -> Result<PathBuf, SceneFileError> {
    let io = |path: &Path| {
        let path = path.to_path_buf();
        move |source| SceneFileError::Io { path, source }
    };
    for folder in std::iter::once(IMAGES).chain(scene.files.keys().map(|name| directory(name))) {
        let folder = save_dir.join(folder);
        std::fs::create_dir_all(&folder).map_err(io(&folder))?;
    }
    for (name, bytes) in &scene.files {
        let path = save_dir.join(name);
        replace_file(&path, bytes).map_err(io(&path))?;
    }
    // the document last, so that the files that it names exist
    let path = save_dir.join(SCENE);
    replace_file(&path, scene.xml.as_bytes()).map_err(io(&path))?;
    Ok(path)
}

/// The state of the scene in the folder of a run; see [`keep_scene`].
#[derive(Debug)]
pub enum SceneFileStatus {
    /// There was none, and it was written.
    Written,
    /// It is the same scene.
    Same,
    /// It has the same bodies, joints and geoms with other numbers, such as masses, from other assets or another release.
    Similar,
    /// It does not load here, like the Python kit's, which names files of its installation.
    Foreign(Box<SceneFileError>),
}

/// Ensures that the folder of a run holds the scene of an environment.
///
/// If there is none, it is written as training writes it. An existing one belongs to the logs next to it and is never changed.
///
/// # Errors
/// [`SceneFileError::Different`] for a scene in which positions and geom ids mean something else; errors of the file system.
pub fn keep_scene(blueprint: &Blueprint) -> Result<SceneFileStatus, SceneFileError> {
    let (config, model) = (blueprint.config(), blueprint.model());
    let save_dir = Path::new(&config.save_dir);
    let path = save_dir.join(SCENE);
    if !path.exists() {
        write_scene_of(blueprint)?;
        return Ok(SceneFileStatus::Written);
    }
    Ok(match read_scene(save_dir) {
        Ok(found) if found == **model => SceneFileStatus::Same,
        Ok(found) if same_ids(&found, model) => SceneFileStatus::Similar,
        Ok(_) => {
            let found = scene_config(save_dir);
            let found = found.map_or_else(|| "another scene".to_string(), |found| about(&found));
            let wanted = about(config);
            return Err(SceneFileError::Different { path, found, wanted });
        }
        Err(e) => SceneFileStatus::Foreign(Box::new(e)),
    })
}

/// Returns whether `qpos` and the ids of bodies, joints and geoms mean the same in both models.
fn same_ids(a: &Model, b: &Model) -> bool {
    a.nq == b.nq && a.body_name == b.body_name && a.jnt_name == b.jnt_name && a.geom_bodyid == b.geom_bodyid
}

/// Describes what determines the ids of a scene: the scene and the version of MIMo.
fn about(config: &Config) -> String {
    let version = Version::label(config);
    if has_own_scene(config.behavior) {
        format!("the task {} with MIMo {version}", config.behavior)
    } else {
        format!("the scene {} with MIMo {version}", config.scene)
    }
}

/// Loads and compiles the `scene.xml` of a run.
///
/// # Errors
/// A missing folder or document, or one that cannot be read.
pub fn read_scene(save_dir: &Path) -> Result<Model, SceneFileError> {
    let assets = DirAssets::new(save_dir).map_err(|e| SceneFileError::Asset {
        file: save_dir.display().to_string(),
        reason: e.to_string(),
    })?;
    Ok(compile(load(&assets, SCENE)?)?)
}

/// Reads the configuration in the comment at the top of a `scene.xml`.
///
/// # Errors
/// A missing comment, or an invalid configuration.
pub fn read_config(xml: &str) -> Result<Config, SceneFileError> {
    let text = xml.strip_prefix("<!--").and_then(|rest| rest.split_once("-->"));
    let text = text.map_or("", |(comment, _)| comment);
    Ok(Config::from_yaml(text, "scene.xml")?)
}

/// Reads the configuration in the `scene.xml` of a run, if possible.
pub fn scene_config(save_dir: &Path) -> Option<Config> {
    let bytes = files::read(&save_dir.join(SCENE), Limits::DEFAULT.document_bytes as u64).ok()?;
    read_config(std::str::from_utf8(&bytes).ok()?).ok()
}

/// Returns the `compat` of a run: that of the configuration in its scene, or `api` if it cannot be read.
pub fn scene_compat(save_dir: &Path) -> Compat {
    scene_config(save_dir).map_or(Compat::Api, |config| config.compat)
}

/// Writes the configuration as an XML comment, without the explanations of its keys.
fn comment(config: &Config) -> String {
    let mut out = String::from("<!--\n# The scene of a BabyBench environment, complete, with this configuration:\n");
    for line in config
        .to_yaml()
        .lines()
        .filter(|l| !l.is_empty() && !l.starts_with('#'))
    {
        // two hyphens would end the comment, and only quoted text can hold them
        out.push_str(&line.replace("--", "-\\x2D"));
        out.push('\n');
    }
    out.push_str("-->\n");
    out
}
