//! A custom scene: an MJCF document in which MIMo is included.
//!
//! The document is read as if it lay among the documents of the library, so that it can include them by name, in addition to its own files. The
//! library adds three that depend on the configuration: MIMo, his settings and his actuators ([`FILES`]).

mod check;
mod error;
mod extra;
mod same;
mod second_infant;
mod unused;

pub use error::CustomSceneError;
pub(crate) use second_infant::location;
pub use unused::{UnusedAttribute, unused_attributes};

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::document::{EXTRA_FILE, actuators, file_name, include};
use super::embedded;
use super::error::SceneError;
use super::third::VersionAssets;
use super::version::Version;
use crate::assets::{AssetError, AssetSource, DirAssets, EmbeddedAssets, directory, resolve};
use crate::config::{Config, Learner, Scene};
use crate::mjcf_loader::{ErrorKind, LoadError, Location};
use extra::ExtraElements;

/// Folder of the library's documents, which a custom scene is read as if it were in.
const FOLDER: &str = "babybench/";
/// Folders of the library's textures and meshes.
const BESIDE: [&str; 2] = ["tex/", "toys/"];
/// The library's settings, which several documents include.
const SETTINGS: &str = "babybench/settings.xml";
/// The same under another name, because a document may include both [`FILES`] and `base.xml`, but no file twice.
const SETTINGS_AGAIN: &str = "mimo_options.xml";

/// The files that a custom scene includes: name, place, and contents.
pub const FILES: [(&str, &str, &str); 3] = [
    ("mimo.xml", "in <body name=\"mimo_location\">", "MIMo's body"),
    (
        "mimo_settings.xml",
        "in <mujoco>",
        "his looks, his senses, his locks and the settings of the simulation",
    ),
    ("mimo_actuators.xml", "in <mujoco>", "his actuators"),
];

/// The source of the document and its files.
enum DocumentSource {
    /// In this folder of the assets.
    Given(String),
    /// In this folder of the file system.
    Disk { files: DirAssets, folder: PathBuf },
    /// In the additions to a scene of the library.
    Added(ExtraElements),
}

/// The assets of a custom scene: its files over the library's, which keep their names.
pub(super) struct CustomScene<A> {
    given: A,
    /// The embedded assets, for files that the given ones lack.
    library: VersionAssets<EmbeddedAssets>,
    own: DocumentSource,
    /// Path of the document, as in the configuration.
    path: String,
    /// The files that depend on the configuration.
    written: Vec<(&'static str, String)>,
    /// The body that places the learner.
    place: &'static str,
    /// Whether there must be a second infant.
    second: bool,
}

/// Returns the assets of a configuration's scene: `assets` with the documents of its version of MIMo. The files of a custom scene
/// ([`Scene::File`]) are laid over them, and so are the additions to a scene of the library ([`Config::scene_extra`]).
///
/// The document is one of `assets`, if they have its path; otherwise it is a file of the system, whose folder then has its textures and
/// includes, and nothing outside that folder is read. Documents of the library are found beside them, even if `assets` lack those.
///
/// # Errors
/// A document that does not exist, or has the name of a file of the library.
pub fn scene_assets(config: &Config, assets: Arc<dyn AssetSource>) -> Result<Arc<dyn AssetSource>, CustomSceneError> {
    let assets = VersionAssets::new(config, assets);
    Ok(match CustomScene::open(config, assets.clone())? {
        Some(room) => Arc::new(room),
        None => Arc::new(assets),
    })
}

/// Returns the assets of a custom scene over borrowed assets with the configuration's version of MIMo; `None` for a scene of the library.
#[cfg(feature = "eval")]
pub(crate) fn open_custom_scene<'a>(
    config: &Config,
    assets: &'a dyn AssetSource,
) -> Result<Option<impl AssetSource + use<'a>>, CustomSceneError> {
    CustomScene::open(config, assets)
}

impl<A: AssetSource> CustomScene<A> {
    /// Finds the document of a configuration; `None` if its scene is one of the library.
    pub fn open(config: &Config, given: A) -> Result<Option<Self>, CustomSceneError> {
        if !config.scene_extra.is_empty() {
            extra::check(&config.scene_extra)?;
            return Ok(Some(Self {
                given,
                library: VersionAssets::new(config, embedded()),
                own: DocumentSource::Added(ExtraElements::new(&config.scene_extra)),
                path: extra::SHOWN.to_string(),
                written: written(config),
                place: location(config.learner),
                second: config.learner != Learner::default() || config.other_age.is_some(),
            }));
        }
        let Scene::File(path) = &config.scene else {
            return Ok(None);
        };
        let no_document = |reason: String| CustomSceneError::NoDocument {
            path: path.clone(),
            reason,
        };
        // the library's own documents are not rooms: a path that is also one of theirs is a file of the system
        let among = resolve("", path).ok();
        let among = among.filter(|path| !embedded().contains(path) && given.contains(path));
        let own = if let Some(path) = among {
            DocumentSource::Given(directory(&path).to_string())
        } else if cfg!(all(target_family = "wasm", target_os = "unknown")) {
            let reason = "it is not among the assets, and there is no file system here".to_string();
            return Err(no_document(reason));
        } else {
            let folder = Path::new(path).parent().filter(|folder| *folder != Path::new(""));
            let folder = folder.unwrap_or(Path::new(".")).to_path_buf();
            let files = DirAssets::new(&folder).map_err(|e| no_document(e.to_string()))?;
            let file = files.read(file_name(path));
            file.map_err(|e| no_document(e.to_string()))?;
            DocumentSource::Disk { files, folder }
        };
        let room = Self {
            given,
            library: VersionAssets::new(config, embedded()),
            own,
            path: path.clone(),
            written: written(config),
            place: location(config.learner),
            second: config.learner != Learner::default() || config.other_age.is_some(),
        };
        if room.library(file_name(path)) {
            Err(CustomSceneError::Shadowed {
                path: path.clone(),
                name: file_name(path).to_string(),
            })
        } else {
            Ok(Some(room))
        }
    }

    /// Returns whether the library has a document of this name.
    fn library(&self, name: &str) -> bool {
        let path = format!("{FOLDER}{name}");
        let beside = matches!(&self.own, DocumentSource::Given(folder) if format!("{folder}/") == FOLDER);
        let other = second_infant::original(name).is_some_and(|name| embedded().contains(&format!("{FOLDER}{name}")));
        name == SETTINGS_AGAIN
            || other
            || self.written.iter().any(|(written, _)| *written == name)
            || embedded().contains(&path)
            || !beside && self.given.contains(&path)
    }

    /// Reads a file of the library: the given one, if the assets replace it.
    fn read_library(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        match self.given.read(path) {
            Err(AssetError::NotFound(_)) => self.library.read(path),
            answer => answer,
        }
    }

    /// Returns whether the library names a file, even one that this build leaves out, or the assets have it.
    fn has_library(&self, path: &str) -> bool {
        self.given.contains(path) || embedded().contains(path)
    }

    /// Reads a file from the folder of the document.
    fn read_own(&self, name: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let shown = || self.shown(name);
        let answer = match &self.own {
            DocumentSource::Given(folder) => resolve(folder, name).and_then(|path| self.given.read(&path)),
            DocumentSource::Disk { files, .. } => files.read(name),
            DocumentSource::Added(extra) if name == EXTRA_FILE => Ok(Cow::Borrowed(extra.document.as_bytes())),
            DocumentSource::Added(_) => Err(AssetError::NotFound(shown())),
        };
        answer.map_err(|e| match e {
            AssetError::NotFound(_) => AssetError::NotFound(shown()),
            AssetError::TooLarge { limit, .. } => AssetError::TooLarge { path: shown(), limit },
            AssetError::Io { message, .. } => AssetError::Io { path: shown(), message },
            other => other,
        })
    }

    /// Returns whether the folder of the document has a file that is not the library's.
    fn has_own(&self, name: &str) -> bool {
        match &self.own {
            // files among the library's documents replace them
            DocumentSource::Given(folder) if format!("{folder}/") == FOLDER => {
                !embedded().contains(&format!("{FOLDER}{name}")) && self.read_own(name).is_ok()
            }
            DocumentSource::Given(_) => self.read_own(name).is_ok(),
            DocumentSource::Disk { files, .. } => files.contains(name),
            DocumentSource::Added(_) => false,
        }
    }

    /// Returns the path of a file next to the document, in the form in which the document's own path was given.
    fn shown(&self, name: &str) -> String {
        match &self.own {
            DocumentSource::Given(folder) if folder.is_empty() => name.to_string(),
            DocumentSource::Given(folder) => format!("{folder}/{name}"),
            DocumentSource::Disk { folder, .. } if folder == Path::new(".") && !self.path.starts_with('.') => {
                name.to_string()
            }
            DocumentSource::Disk { folder, .. } => folder.join(name).display().to_string(),
            DocumentSource::Added(_) if name == EXTRA_FILE => extra::SHOWN.to_string(),
            DocumentSource::Added(_) => name.to_string(),
        }
    }

    /// Converts a place in a file to the one that the user sees.
    fn locate(&self, place: &mut Location) {
        let Some(name) = place.file.strip_prefix(FOLDER).filter(|name| !self.library(name)) else {
            return;
        };
        match &self.own {
            DocumentSource::Added(extra) if name == EXTRA_FILE => extra.locate(place),
            _ => place.file = self.shown(name),
        }
    }

    /// Names files as the user knows them, not by their place among the library's files.
    fn localized_load(&self, mut error: LoadError) -> LoadError {
        let shown = |path: &str| {
            let own = path.strip_prefix(FOLDER).filter(|name| !self.library(name));
            own.map(|name| self.shown(name))
        };
        self.locate(&mut error.place);
        if let ErrorKind::RepeatedInclude(path) | ErrorKind::Asset(AssetError::NotFound(path)) = &mut error.kind
            && let Some(name) = path.strip_prefix(FOLDER)
        {
            *path = shown(path).unwrap_or_else(|| name.to_string());
        }
        error
    }

    /// Names files as the user knows them.
    pub fn localized(&self, error: SceneError) -> SceneError {
        match error {
            SceneError::Load(error) => self.localized_load(error).into(),
            other => other,
        }
    }
}

impl<A: AssetSource> AssetSource for CustomScene<A> {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let path = resolve("", path)?;
        let Some(name) = path.strip_prefix(FOLDER) else {
            let beside = BESIDE.iter().any(|folder| path.starts_with(folder));
            // what the library does not have there is beside the document's folder, where nothing is read
            return match beside.then(|| self.read_library(&path)) {
                None | Some(Err(AssetError::NotFound(_))) => Err(AssetError::Outside {
                    path: format!("../{path}"),
                    folder: self.shown("."),
                }),
                Some(answer) => answer,
            };
        };
        if !self.library(name) {
            return self.read_own(name);
        }
        if self.has_own(name) {
            return Err(AssetError::Shadowed(self.shown(name)));
        }
        match self.written.iter().find(|(written, _)| *written == name) {
            Some((_, text)) => Ok(Cow::Borrowed(text.as_bytes())),
            None if name == SETTINGS_AGAIN => self.read_library(SETTINGS),
            None => match second_infant::original(name) {
                Some(first) => {
                    let document = self.read_library(&format!("{FOLDER}{first}"))?;
                    let renamed = second_infant::renamed(&document);
                    renamed.map(Cow::Owned).ok_or(AssetError::NotFound(path))
                }
                None => self.read_library(&path),
            },
        }
    }

    fn contains(&self, path: &str) -> bool {
        let beside = |path: &String| BESIDE.iter().any(|folder| path.starts_with(folder));
        resolve("", path).is_ok_and(|path| beside(&path) && self.has_library(&path)) || self.read(path).is_ok()
    }
}

/// Writes the files that depend on the configuration.
fn written(config: &Config) -> Vec<(&'static str, String)> {
    let version = Version::of(config.behavior).name();
    let settings = SETTINGS_AGAIN.trim_end_matches(".xml");
    let [body, rest @ ..] = second_infant::written(config);
    let texts = [
        body.1,
        include(settings) + &include(&format!("meta_{version}")),
        actuators(config),
    ];
    let named = FILES.iter().map(|(name, ..)| *name).zip(texts).chain(rest);
    named
        .map(|(name, text)| (name, format!("<mujocoinclude>\n{text}</mujocoinclude>\n")))
        .collect()
}
