//! Where documents and textures come from.

use std::borrow::Cow;
use std::collections::BTreeMap;

/// A named file cannot be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AssetError {
    /// The source has no such file.
    #[error("file \"{0}\" does not exist")]
    NotFound(String),
    /// A path that is empty, absolute, leads out of the source or uses characters other than `/` to separate.
    #[error("path \"{0}\" is not a relative path inside the asset source")]
    BadPath(String),
    /// Larger than [`MAX_ASSET_BYTES`].
    #[error("file \"{0}\" is larger than {MAX_ASSET_BYTES} bytes")]
    TooLarge(String),
    /// The file system failed.
    #[error("file \"{path}\": {message}")]
    Io {
        /// The path.
        path: String,
        /// What the system said.
        message: String,
    },
}

/// Largest file read from a directory.
pub const MAX_ASSET_BYTES: u64 = 64 << 20;

/// A set of files. Paths are normalised, relative to the root of the source and separated by `/`.
pub trait AssetSource {
    /// The content of a file.
    ///
    /// # Errors
    /// A path that leads out of the source, a file that does not exist, is too large or cannot be read.
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError>;

    /// Whether the file exists.
    fn contains(&self, path: &str) -> bool {
        self.read(path).is_ok()
    }
}

/// Joins a directory of the source and a relative reference in a document. `..` may climb up to the root, not beyond.
///
/// # Errors
/// [`AssetError::BadPath`]: empty, absolute, beyond the root, or with another separator than `/`.
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

/// The directory part of a path, without the last `/`.
pub(super) fn directory(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(dir, _)| dir)
}

/// Files in memory.
#[derive(Clone, Debug, Default)]
pub struct MemoryAssets {
    files: BTreeMap<String, Vec<u8>>,
}

impl MemoryAssets {
    /// No files.
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

/// Files embedded in the program.
#[derive(Clone, Copy, Debug)]
pub struct EmbeddedAssets(pub &'static [(&'static str, &'static [u8])]);

impl AssetSource for EmbeddedAssets {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let path = resolve("", path)?;
        match self.0.iter().find(|(name, _)| *name == path) {
            Some((_, bytes)) => Ok(Cow::Borrowed(bytes)),
            None => Err(AssetError::NotFound(path)),
        }
    }
}

/// Several sources; the first that has a file gives it.
#[derive(Clone)]
pub struct Overlay<'a> {
    layers: Vec<&'a dyn AssetSource>,
}

impl std::fmt::Debug for Overlay<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Overlay")
            .field("layers", &self.layers.len())
            .finish_non_exhaustive()
    }
}

impl<'a> Overlay<'a> {
    /// Layers, the topmost first.
    pub fn new(layers: Vec<&'a dyn AssetSource>) -> Self {
        Overlay { layers }
    }
}

impl AssetSource for Overlay<'_> {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        for layer in &self.layers {
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

/// A directory of the file system. Nothing outside it can be read, through links neither.
#[derive(Clone, Debug)]
pub struct DirAssets {
    root: std::path::PathBuf,
}

impl DirAssets {
    /// The directory `root`.
    ///
    /// # Errors
    /// It does not exist or is no directory.
    pub fn new(root: impl AsRef<std::path::Path>) -> Result<Self, AssetError> {
        let root = root.as_ref();
        let canonical = root
            .canonicalize()
            .map_err(|e| io_error(&root.display().to_string(), &e))?;
        if canonical.is_dir() {
            Ok(DirAssets { root: canonical })
        } else {
            Err(AssetError::NotFound(root.display().to_string()))
        }
    }

    /// The real path of a file, once it is known to lie inside the root.
    fn locate(&self, path: &str) -> Result<std::path::PathBuf, AssetError> {
        let inside = resolve("", path)?;
        let real = self.root.join(&inside).canonicalize().map_err(|e| io_error(path, &e))?;
        if !real.starts_with(&self.root) {
            return Err(AssetError::BadPath(path.to_owned()));
        }
        if real.is_file() {
            Ok(real)
        } else {
            Err(AssetError::NotFound(inside))
        }
    }
}

fn io_error(path: &str, error: &std::io::Error) -> AssetError {
    match error.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => AssetError::NotFound(path.to_owned()),
        _ => AssetError::Io {
            path: path.to_owned(),
            message: error.to_string(),
        },
    }
}

impl AssetSource for DirAssets {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        use std::io::Read;
        let file = std::fs::File::open(self.locate(path)?).map_err(|e| io_error(path, &e))?;
        // One byte more than allowed tells a file that is too large from one that just fits, whatever its metadata say.
        let mut bytes = Vec::new();
        file.take(MAX_ASSET_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| io_error(path, &e))?;
        if bytes.len() as u64 > MAX_ASSET_BYTES {
            return Err(AssetError::TooLarge(path.to_owned()));
        }
        Ok(Cow::Owned(bytes))
    }

    fn contains(&self, path: &str) -> bool {
        self.locate(path).is_ok()
    }
}
