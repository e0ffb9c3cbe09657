//! Sources of MJCF documents and textures: directories, the file system, memory, files embedded in the program, and layers of them.
//!
//! A source maps normalised paths to bytes; nothing outside it can be reached. All but [`FileSystem`] take relative paths alone.
//!
//! ```
//! use mjcf_sim::assets::{AssetSource, MemoryAssets, Overlay};
//!
//! let (mut base, mut changed) = (MemoryAssets::new(), MemoryAssets::new());
//! base.insert("scenes/crib.xml", "<mujoco><worldbody/></mujoco>")?;
//! changed.insert("scenes/crib.xml", "<mujoco/>")?;
//! let assets = Overlay::new(base).with(changed);
//! assert_eq!(assets.read("scenes/crib.xml")?.len(), 9);
//! # Ok::<(), mjcf_sim::assets::AssetError>(())
//! ```

mod directory;
mod file_system;

pub use directory::DirAssets;
pub use file_system::FileSystem;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use crate::text::quoted;

/// An error in reading a file from a source.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AssetError {
    /// The source has no such file.
    #[error("file \"{}\" does not exist", quoted(.0))]
    NotFound(String),
    /// A path is empty, absolute, leads out of the source, or uses separators other than `/`.
    #[error("path \"{}\" is not a relative path inside the asset source", quoted(.0))]
    BadPath(String),
    /// The file is larger than [`crate::Limits::asset_bytes`].
    #[error("file \"{}\" is larger than {limit} bytes", quoted(.path))]
    TooLarge {
        /// The path.
        path: String,
        /// The limit, bytes.
        limit: u64,
    },
    /// The file lies outside the folder whose files a document may name.
    #[error("file \"{}\" lies outside the document's folder, \"{}\"; move it there", quoted(.path), quoted(.folder))]
    Outside {
        /// The path.
        path: String,
        /// The folder.
        folder: String,
    },
    /// A custom file has the name of one of the library's files, so the name is ambiguous.
    #[error("file \"{}\" has the name of a file of the library; rename yours", quoted(.0))]
    Shadowed(String),
    /// The file system failed.
    #[error("file \"{}\": {message}", quoted(.path))]
    Io {
        /// The path.
        path: String,
        /// The error of the system.
        message: String,
    },
}

/// A source of files by their paths.
///
/// Paths are normalised, relative to the root of the source and separated by `/`. Threads share sources.
pub trait AssetSource: Send + Sync {
    /// Returns the content of a file.
    ///
    /// # Errors
    /// A path that leads out of the source, a file that does not exist, is too large or cannot be read.
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError>;

    /// Returns whether the file exists.
    fn contains(&self, path: &str) -> bool {
        self.read(path).is_ok()
    }

    /// Returns the path of a file that a document in the directory `dir` names.
    ///
    /// # Errors
    /// [`AssetError::BadPath`]: a path that this source cannot have.
    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        resolve(dir, file)
    }
}

/// Joins a directory of the source and a relative reference in a document. `..` may climb to the root, but not beyond.
///
/// # Errors
/// [`AssetError::BadPath`]: empty, absolute, beyond the root, or with a separator other than `/`.
pub fn resolve(dir: &str, file: &str) -> Result<String, AssetError> {
    let bad = || AssetError::BadPath(file.to_owned());
    if file.is_empty() || file.starts_with('/') || file.contains(['\\', ':', '\0']) {
        return Err(bad());
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in dir.split('/').chain(file.split('/')) {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop().ok_or_else(bad)?;
            }
            name => parts.push(name),
        }
    }
    if parts.is_empty() {
        Err(bad())
    } else {
        Ok(parts.join("/"))
    }
}

/// Returns the directory part of a path, without the last `/`.
pub fn directory(path: &str) -> &str {
    match path.rsplit_once('/') {
        None => "",
        Some(("", _)) => "/",
        Some((dir, _)) => dir,
    }
}

/// Returns whether a path begins at the root, or at a drive.
pub fn is_absolute(path: &str) -> bool {
    path.starts_with(['/', '\\']) || path.get(1..3).is_some_and(|drive| drive == ":/" || drive == ":\\")
}

/// A source of files that are in memory.
#[derive(Clone, Debug, Default)]
pub struct MemoryAssets {
    files: BTreeMap<String, Vec<u8>>,
}

impl MemoryAssets {
    /// Creates a source without files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds or replaces a file.
    ///
    /// # Errors
    /// As [`resolve`].
    pub fn insert(&mut self, path: &str, bytes: impl Into<Vec<u8>>) -> Result<(), AssetError> {
        self.files.insert(resolve("", path)?, bytes.into());
        Ok(())
    }
}

impl AssetSource for MemoryAssets {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let found = self.files.get(&resolve("", path)?);
        found
            .map(|bytes| Cow::Borrowed(bytes.as_slice()))
            .ok_or_else(|| AssetError::NotFound(path.to_owned()))
    }
}

/// A source of files that are embedded in the program, as pairs of path and content. This build leaves out files without content: documents may name
/// them, but reading them is an error.
#[derive(Clone, Copy, Debug)]
pub struct EmbeddedAssets(pub &'static [(&'static str, &'static [u8])]);

impl AssetSource for EmbeddedAssets {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let path = resolve("", path)?;
        match self.0.iter().find(|(name, _)| *name == path) {
            Some((_, [])) => Err(AssetError::Io {
                path,
                message: "this build leaves it out; give it among the assets, or enable the feature that embeds it"
                    .to_owned(),
            }),
            Some((_, bytes)) => Ok(Cow::Borrowed(bytes)),
            None => Err(AssetError::NotFound(path)),
        }
    }

    fn contains(&self, path: &str) -> bool {
        resolve("", path).is_ok_and(|path| self.0.iter().any(|(name, _)| *name == path))
    }
}

/// Several layered sources: a file comes from the topmost source that has it.
#[derive(Clone)]
pub struct Overlay {
    /// The topmost last.
    layers: Vec<Arc<dyn AssetSource>>,
}

impl std::fmt::Debug for Overlay {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Overlay")
            .field("layers", &self.layers.len())
            .finish_non_exhaustive()
    }
}

impl Overlay {
    /// Creates an overlay of a single source, the lowest.
    pub fn new(base: impl AssetSource + 'static) -> Self {
        Self {
            layers: vec![Arc::new(base)],
        }
    }

    /// Adds a source that takes precedence over the existing ones.
    #[must_use]
    pub fn with(mut self, layer: impl AssetSource + 'static) -> Self {
        self.layers.push(Arc::new(layer));
        self
    }
}

impl AssetSource for Overlay {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        for layer in self.layers.iter().rev() {
            match layer.read(path) {
                Err(AssetError::NotFound(_)) => {}
                answer => return answer,
            }
        }
        Err(AssetError::NotFound(path.to_owned()))
    }

    fn contains(&self, path: &str) -> bool {
        self.layers.iter().any(|layer| layer.contains(path))
    }
}

impl<A: AssetSource + ?Sized> AssetSource for &A {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        (**self).read(path)
    }

    fn contains(&self, path: &str) -> bool {
        (**self).contains(path)
    }

    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        (**self).resolve(dir, file)
    }
}

impl<A: AssetSource + ?Sized> AssetSource for Arc<A> {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        (**self).read(path)
    }

    fn contains(&self, path: &str) -> bool {
        (**self).contains(path)
    }

    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        (**self).resolve(dir, file)
    }
}
