//! `scene.xml`: the complete scene of an environment in one MJCF document, which this library and MuJoCo load.
//!
//! Includes are replaced by what they include; a comment at the top holds the configuration. Images of textures are
//! written beside it into `tex/`, so that the folder can be moved as a whole.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use thiserror::Error;

use crate::config::{Config, ConfigError};
use crate::env::Blueprint;
use crate::files::replace_file;
use crate::mimo::{DOCUMENT, Version, embedded, scene_xml};
use crate::mjcf_loader::{AssetSource, DirAssets, LoadError, MAX_INCLUDE_DEPTH, load, resolve};
use crate::model::Model;
use crate::physics::set_const;

/// The document in the folder of a run.
const SCENE: &str = "scene.xml";
/// Folder of the images, beside the document.
const IMAGES: &str = "tex";
/// Attributes that name images.
const IMAGE_ATTRIBUTES: [&str; 7] = [
    "file",
    "fileright",
    "fileleft",
    "fileup",
    "filedown",
    "filefront",
    "fileback",
];

/// Why a scene is not written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The file system refuses.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// An asset cannot be put into one document.
    #[error("scene: {file}: {reason}")]
    Asset {
        /// The asset.
        file: String,
        /// What is wrong.
        reason: String,
    },
    /// A scene that does not load.
    #[error("cannot load the scene: {0}")]
    Load(#[from] LoadError),
    /// The folder's scene is another one.
    #[error(
        "{}: this is {found}, but the configuration is of {wanted}: positions and geoms in the logs would not be \
         those of the scene; give the configuration a save_dir of its own", path.display()
    )]
    Different {
        /// The document.
        path: PathBuf,
        /// What it is of.
        found: String,
        /// What is wanted.
        wanted: String,
    },
    /// A scene without a configuration in its comment, or with one that is not allowed.
    #[error("the configuration in the comment of the scene: {0}")]
    Config(#[from] ConfigError),
}

/// A document with its images, by path relative to it.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The document.
    pub xml: String,
    /// The images.
    pub images: BTreeMap<String, Vec<u8>>,
}

/// The scene of a configuration from the embedded assets, as one document.
///
/// # Errors
/// None with the embedded assets.
pub fn complete_scene(config: &Config) -> Result<SceneFile, SceneFileError> {
    complete_scene_from(config, &embedded())
}

/// The scene of a configuration from other assets, laid out like the embedded ones, as one document.
///
/// # Errors
/// Assets that are missing or no XML.
pub fn complete_scene_from(config: &Config, assets: &dyn AssetSource) -> Result<SceneFile, SceneFileError> {
    let mut flattening = Flattening {
        assets,
        dir: DOCUMENT.rsplit_once('/').map_or("", |(dir, _)| dir),
        out: comment(config),
        images: BTreeMap::new(),
        depth: 0,
    };
    flattening.splice(&scene_xml(config), DOCUMENT, 0)?;
    Ok(SceneFile {
        xml: flattening.out,
        images: flattening.images,
    })
}

/// Writes `scene.xml` and its images, from the embedded assets, into the folder of a run, which is made if it is not there.
///
/// # Errors
/// What the file system says.
pub fn write_scene(config: &Config, save_dir: &Path) -> Result<PathBuf, SceneFileError> {
    write_scene_from(config, &embedded(), save_dir)
}

/// [`write_scene`] from other assets, laid out like the embedded ones.
///
/// # Errors
/// Assets that are missing or no XML; what the file system says.
pub fn write_scene_from(config: &Config, assets: &dyn AssetSource, save_dir: &Path) -> Result<PathBuf, SceneFileError> {
    let scene = complete_scene_from(config, assets)?;
    let io = |path: &Path| {
        let path = path.to_path_buf();
        move |source| SceneFileError::Io { path, source }
    };
    let folder = save_dir.join(IMAGES);
    std::fs::create_dir_all(&folder).map_err(io(&folder))?;
    for (name, bytes) in &scene.images {
        let path = save_dir.join(name);
        replace_file(&path, bytes).map_err(io(&path))?;
    }
    let path = save_dir.join(SCENE);
    replace_file(&path, scene.xml.as_bytes()).map_err(io(&path))?;
    Ok(path)
}

/// What the folder of a run had as its scene, see [`keep_scene`].
#[derive(Debug)]
pub enum KeptScene {
    /// Nothing: it was written.
    Written,
    /// The same scene.
    Same,
    /// The same bodies, joints and geoms with other numbers, such as masses: of other assets or another release.
    Similar,
    /// A document that does not load here, such as the Python kit's, which names files of its installation.
    Foreign(Box<SceneFileError>),
}

/// Sees to it that the folder of a run holds the scene of an environment: writes it as training does if there is none, and
/// never changes one that is there, which belongs to the logs beside it. `assets` are those of the blueprint.
///
/// # Errors
/// [`SceneFileError::Different`] for a scene in which positions and geom ids mean something else; what the file system says.
pub fn keep_scene(blueprint: &Blueprint, assets: &dyn AssetSource) -> Result<KeptScene, SceneFileError> {
    let (config, model) = (blueprint.config(), blueprint.model());
    let save_dir = Path::new(&config.save_dir);
    let path = save_dir.join(SCENE);
    if !path.exists() {
        write_scene_from(config, assets, save_dir)?;
        return Ok(KeptScene::Written);
    }
    Ok(match read_scene(save_dir) {
        Ok(found) if found == **model => KeptScene::Same,
        Ok(found) if same_ids(&found, model) => KeptScene::Similar,
        Ok(_) => {
            let xml = std::fs::read_to_string(&path).unwrap_or_default();
            let found = read_config(&xml).map_or_else(|_| "another scene".to_string(), |found| about(&found));
            let wanted = about(config);
            return Err(SceneFileError::Different { path, found, wanted });
        }
        Err(e) => KeptScene::Foreign(Box::new(e)),
    })
}

/// Whether `qpos` and the ids of bodies, joints and geoms mean the same.
fn same_ids(a: &Model, b: &Model) -> bool {
    a.nq == b.nq && a.body_name == b.body_name && a.jnt_name == b.jnt_name && a.geom_bodyid == b.geom_bodyid
}

/// What makes the ids of a scene.
fn about(config: &Config) -> String {
    let version = Version::of(config.behavior).name();
    format!("the scene {} with MIMo {version}", config.scene)
}

/// Loads and compiles the `scene.xml` of a run.
///
/// # Errors
/// A missing folder or document, one that is not understood.
pub fn read_scene(save_dir: &Path) -> Result<Model, SceneFileError> {
    let assets = DirAssets::new(save_dir).map_err(|e| SceneFileError::Asset {
        file: save_dir.display().to_string(),
        reason: e.to_string(),
    })?;
    let mut model = load(&assets, SCENE)?;
    set_const(&mut model);
    Ok(model)
}

/// The configuration in the comment at the top of a `scene.xml`.
///
/// # Errors
/// No such comment, a configuration that is not allowed.
pub fn read_config(xml: &str) -> Result<Config, SceneFileError> {
    let text = xml.strip_prefix("<!--").and_then(|rest| rest.split_once("-->"));
    let text = text.map_or("", |(comment, _)| comment);
    Ok(Config::from_yaml(text, "scene.xml")?)
}

/// The configuration as a comment, without the explanations of its keys.
fn comment(config: &Config) -> String {
    let mut out = String::from("<!--\n# The scene of a BabyBench environment, complete, with this configuration:\n");
    for line in config
        .to_yaml()
        .lines()
        .filter(|l| !l.is_empty() && !l.starts_with('#'))
    {
        // two hyphens would end the comment; only quoted text can hold them
        out.push_str(&line.replace("--", "-\\x2D"));
        out.push('\n');
    }
    out.push_str("-->\n");
    out
}

struct Flattening<'a> {
    assets: &'a dyn AssetSource,
    dir: &'a str,
    out: String,
    images: BTreeMap<String, Vec<u8>>,
    depth: usize,
}

impl Flattening<'_> {
    /// Appends a document; of an included one, what is inside its root.
    fn splice(&mut self, text: &str, path: &str, level: usize) -> Result<(), SceneFileError> {
        let broken = |reason: String| SceneFileError::Asset {
            file: path.to_string(),
            reason,
        };
        if level > MAX_INCLUDE_DEPTH {
            return Err(broken("includes are nested too deeply".to_string()));
        }
        let mut reader = Reader::from_str(text);
        reader.config_mut().check_end_names = true;
        let mut inside = 0;
        loop {
            match reader.read_event().map_err(|e| broken(e.to_string()))? {
                Event::Start(e) => {
                    inside += 1;
                    if level > 0 && inside == 1 {
                        continue;
                    }
                    self.element(&e, path, level, ">")?;
                    self.depth += 1;
                }
                Event::Empty(e) => self.element(&e, path, level, "/>")?,
                Event::End(e) => {
                    inside -= 1;
                    if level > 0 && inside == 0 {
                        continue;
                    }
                    self.depth = self.depth.saturating_sub(1);
                    self.indent();
                    let name = e.name();
                    let name: &str = name.as_ref();
                    self.out.push_str(&format!("</{name}>\n"));
                }
                Event::Eof => return Ok(()),
                // MJCF has no text, and comments explain the assets, not the scene
                _ => {}
            }
        }
    }

    fn indent(&mut self) {
        self.out.extend(std::iter::repeat_n("  ", self.depth));
    }

    fn element(&mut self, e: &BytesStart, path: &str, level: usize, end: &str) -> Result<(), SceneFileError> {
        let broken = |reason: String| SceneFileError::Asset {
            file: path.to_string(),
            reason,
        };
        let name = e.name();
        let name: &str = name.as_ref();
        let mut attributes = Vec::new();
        for attribute in e.attributes() {
            let attribute = attribute.map_err(|e| broken(e.to_string()))?;
            let key: &str = attribute.key.as_ref();
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|e| broken(e.to_string()))?;
            attributes.push((key.to_string(), value.into_owned()));
        }
        if name == "include" {
            let file = attributes
                .iter()
                .find(|(key, _)| key == "file")
                .map(|(_, value)| value.as_str());
            let file = file.ok_or_else(|| broken("an include without a file".to_string()))?;
            let bytes = self.read(file)?;
            let text = std::str::from_utf8(&bytes).map_err(|e| broken(e.to_string()))?;
            return self.splice(text, file, level + 1);
        }
        self.indent();
        self.out.push_str(&format!("<{name}"));
        for (key, mut value) in attributes {
            if name == "texture" && IMAGE_ATTRIBUTES.contains(&key.as_str()) {
                value = self.image(&value)?;
            }
            let value = quick_xml::escape::escape(value.as_str());
            self.out.push_str(&format!(" {key}=\"{value}\""));
        }
        self.out.push_str(&format!("{end}\n"));
        Ok(())
    }

    /// Takes an image along and returns its new path. Equal names in different folders would clash; assets have none.
    fn image(&mut self, file: &str) -> Result<String, SceneFileError> {
        let name = file.rsplit('/').next().unwrap_or(file);
        let path = format!("{IMAGES}/{name}");
        let bytes = self.read(file)?;
        if self
            .images
            .insert(path.clone(), bytes.clone())
            .is_some_and(|before| before != bytes)
        {
            return Err(SceneFileError::Asset {
                file: file.to_string(),
                reason: "another image has the same name".to_string(),
            });
        }
        Ok(path)
    }

    fn read(&self, file: &str) -> Result<Vec<u8>, SceneFileError> {
        let asset = |e: crate::mjcf_loader::AssetError| SceneFileError::Asset {
            file: file.to_string(),
            reason: e.to_string(),
        };
        let path = resolve(self.dir, file).map_err(asset)?;
        Ok(self.assets.read(&path).map_err(asset)?.into_owned())
    }
}
