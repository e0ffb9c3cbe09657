//! The file system as a source of assets.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::directory::read;
use super::{AssetError, AssetSource, is_absolute};
use crate::limits::Limits;

/// Reads any file that a document names, as MuJoCo does: next to the document, above it (`../meshes/arm.stl`) and by absolute
/// path.
///
/// This is for documents that one would run in MuJoCo, too. [`DirAssets`](super::DirAssets) is for those of strangers.
#[derive(Clone, Debug)]
pub struct FileSystem {
    folder: PathBuf,
    /// Bytes of a file.
    limit: u64,
}

impl FileSystem {
    /// Returns the file system as seen from a folder, from which files of at most [`Limits::asset_bytes`] are read.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            limit: Limits::default().asset_bytes,
        }
    }

    /// Returns the file system as seen from the folder of a file, and the name of the file in it.
    ///
    /// # Errors
    /// [`AssetError::Io`]: a path that ends with no name, or with one that is not UTF-8.
    pub fn beside(file: impl AsRef<Path>) -> Result<(Self, String), AssetError> {
        let file = file.as_ref();
        let name = file.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| AssetError::Io {
            path: file.display().to_string(),
            message: "expected the name of a file".to_owned(),
        })?;
        Ok((Self::new(file.parent().unwrap_or(Path::new(""))), name.to_owned()))
    }

    /// Returns the folder relative to which files are searched for.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

impl AssetSource for FileSystem {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        read(&self.folder.join(path), path, self.limit)
    }

    fn contains(&self, path: &str) -> bool {
        self.folder.join(path).is_file()
    }

    /// Keeps `..` that lead above the folder, and the prefixes of absolute paths. As in MuJoCo, `\` separates like `/`.
    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        if file.is_empty() || file.contains('\0') {
            return Err(AssetError::BadPath(file.to_owned()));
        }
        let file = file.replace('\\', "/");
        let whole = match dir {
            _ if is_absolute(&file) => file,
            "" => file,
            dir => format!("{dir}/{file}"),
        };
        let (root, names) = whole.strip_prefix('/').map_or(("", &*whole), |names| ("/", names));
        let mut parts: Vec<&str> = Vec::new();
        for part in names.split('/') {
            match (part, parts.last()) {
                ("" | ".", _) => {}
                ("..", Some(&last)) if last != ".." => {
                    parts.pop();
                }
                // nothing is above the root
                ("..", _) if !root.is_empty() => {}
                (name, _) => parts.push(name),
            }
        }
        match parts.last() {
            None | Some(&"..") => Err(AssetError::BadPath(whole)),
            Some(_) => Ok(format!("{root}{}", parts.join("/"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_those_of_mujoco() {
        let here = FileSystem::new("");
        let found = |dir, file| here.resolve(dir, file).ok();
        for (dir, file, path) in [
            ("", "a.obj", "a.obj"),
            ("arm", "./b/../a.obj", "arm/a.obj"),
            ("arm", "../a.obj", "a.obj"),
            ("arm", "../../a.obj", "../a.obj"),
            ("../arm", "../../a.obj", "../../a.obj"),
            ("arm", "..\\meshes\\a.obj", "meshes/a.obj"),
            ("arm", "/m/a.obj", "/m/a.obj"),
            ("/", "a.obj", "/a.obj"),
            ("/arm", "../../m/a.obj", "/m/a.obj"),
            ("arm", "C:\\m\\a.obj", "C:/m/a.obj"),
        ] {
            assert_eq!(found(dir, file).as_deref(), Some(path), "{dir} {file}");
        }
        for (dir, file) in [("", ""), ("arm", ".."), ("", "."), ("arm", "../.."), ("", "a\0")] {
            assert_eq!(found(dir, file), None, "{dir} {file}");
        }
        assert_eq!(crate::assets::directory("/a.xml"), "/");
    }
}
