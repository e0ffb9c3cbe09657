//! MIMo's surroundings: a scene of the library by name, or a custom document by its path.

use std::fmt;
use std::path::Path;

/// The surroundings of MIMo (`scene`).
///
/// ```
/// use babybench::config::Scene;
///
/// assert_eq!(Scene::from_name("crib"), Some(Scene::Crib));
/// assert_eq!(Scene::from_name("rooms/mine.xml"), Some(Scene::File("rooms/mine.xml".to_string())));
/// assert_eq!(Scene::from_name("nursery"), None);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scene {
    /// The bare floor; MIMo is free.
    #[default]
    Base,
    /// The mattress of a crib, with MIMo lying on it, the lower body fixed.
    Crib,
    /// Loose cubes and balls, with MIMo sitting among them.
    Cubes,
    /// The crib with a mobile over it, and a ribbon from one of MIMo's limbs to a hook beside the mobile.
    Mobile,
    /// Furniture and toys, with MIMo sitting among them.
    Playroom,
    /// The floor, with MIMo lying on his back under a blanket.
    Blanket,
    /// A custom MJCF document, in which MIMo is included: a path that ends in `.xml`, which starts at the working directory
    /// unless it is absolute. Where a [`Blueprint`](crate::Blueprint) is given assets, the document may be one of them.
    File(String),
}

impl Scene {
    /// The scenes of BabyBench, in the order of the documentation.
    pub const BABYBENCH: &'static [Self] = &[Self::Base, Self::Crib, Self::Cubes];
    /// All scenes of the library: those of BabyBench, those of the tasks `mobile` and `play`, and the blanket.
    pub const LIBRARY: &'static [Self] = &[
        Self::Base,
        Self::Crib,
        Self::Cubes,
        Self::Mobile,
        Self::Playroom,
        Self::Blanket,
    ];
    /// The names of [`Self::LIBRARY`] in a configuration file.
    pub const NAMES: &'static [&'static str] = &["base", "crib", "cubes", "mobile", "playroom", "blanket"];
    /// The ending of a document's path.
    pub const ENDING: &'static str = ".xml";

    /// Returns the name in a configuration: that of a scene of the library, or a path.
    pub fn name(&self) -> &str {
        match self {
            Self::Base => "base",
            Self::Crib => "crib",
            Self::Cubes => "cubes",
            Self::Mobile => "mobile",
            Self::Playroom => "playroom",
            Self::Blanket => "blanket",
            Self::File(path) => path,
        }
    }

    /// Returns the scene of the library with this name, or otherwise the document at this path; `None` if it is neither a name nor ends
    /// in `.xml`.
    pub fn from_name(name: &str) -> Option<Self> {
        // names come first, so a document called `crib` needs its ending
        let known = Self::LIBRARY.iter().find(|scene| scene.name() == name);
        let file = || name.ends_with(Self::ENDING).then(|| Self::File(name.to_string()));
        known.cloned().or_else(file)
    }

    /// Resolves the path of a document from a folder instead of the working directory. Absolute paths stay; `None` if the folder's
    /// name is not UTF-8.
    pub(super) fn starting_at(&self, folder: &Path) -> Option<Self> {
        match self {
            // a configuration given as text has no folder: the path stays relative to the working directory
            Self::File(path) if folder.components().next().is_some() => {
                folder.join(path).to_str().map(|path| Self::File(path.to_string()))
            }
            _ => Some(self.clone()),
        }
    }
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(feature = "eval")]
impl serde::Serialize for Scene {
    /// Serializes the name.
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

#[cfg(feature = "eval")]
impl<'de> serde::Deserialize<'de> for Scene {
    /// Deserializes a scene from its name.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = <String as serde::Deserialize>::deserialize(deserializer)?;
        Self::from_name(&name).ok_or_else(|| {
            let names = Self::NAMES.join(", ");
            serde::de::Error::custom(format!(
                "unknown scene `{name}`, expected one of {names}, or a path that ends in .xml"
            ))
        })
    }
}
