//! A directory as a source of assets.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::{AssetError, AssetSource, resolve};
use crate::files;
use crate::limits::Limits;

/// Reads files from a directory of the file system. Nothing outside it can be read, not even through links.
#[derive(Clone, Debug)]
pub struct DirAssets {
    root: PathBuf,
    /// Bytes of a file.
    limit: u64,
}

impl DirAssets {
    /// Opens the directory `root`.
    ///
    /// # Errors
    /// A directory that does not exist, a path that is not a directory.
    pub fn new(root: impl AsRef<Path>) -> Result<Self, AssetError> {
        Self::with_limits(root, &Limits::default())
    }

    /// Opens the directory `root`, from which files of at most [`Limits::asset_bytes`] are read.
    ///
    /// # Errors
    /// As [`DirAssets::new`].
    pub fn with_limits(root: impl AsRef<Path>, limits: &Limits) -> Result<Self, AssetError> {
        let root = root.as_ref();
        let canonical = root
            .canonicalize()
            .map_err(|e| io_error(&root.display().to_string(), &e))?;
        if canonical.is_dir() {
            Ok(DirAssets {
                root: canonical,
                limit: limits.asset_bytes,
            })
        } else {
            Err(AssetError::Io {
                path: root.display().to_string(),
                message: "this is not a folder".to_owned(),
            })
        }
    }

    /// Returns the real path of a file, once it is known to lie inside the root.
    fn locate(&self, path: &str) -> Result<PathBuf, AssetError> {
        let real = self
            .root
            .join(resolve("", path)?)
            .canonicalize()
            .map_err(|e| io_error(path, &e))?;
        if !real.starts_with(&self.root) {
            return Err(AssetError::Io {
                path: path.to_owned(),
                message: "this is a link that leads out of the folder".to_owned(),
            });
        }
        Ok(real)
    }
}

/// Reads a file that a document names by `path`, of at most `limit` bytes.
pub(super) fn read(file: &Path, path: &str, limit: u64) -> Result<Cow<'static, [u8]>, AssetError> {
    match files::read(file, limit) {
        Ok(bytes) => Ok(Cow::Owned(bytes)),
        Err(e) if e.kind() == std::io::ErrorKind::FileTooLarge => Err(AssetError::TooLarge {
            path: path.to_owned(),
            limit,
        }),
        Err(e) => Err(io_error(path, &e)),
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
        read(&self.locate(path)?, path, self.limit)
    }

    fn contains(&self, path: &str) -> bool {
        self.locate(path).is_ok_and(|real| real.is_file())
    }
}
