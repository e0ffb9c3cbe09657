//! Files from a program that replace those of the file system.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;

use babybench::assets::{AssetError, AssetSource, FileSystem};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Contents by name over the file system. As in MuJoCo's virtual file system, folders do not matter, nor does case.
pub struct GivenFiles {
    files: HashMap<String, Vec<u8>>,
    beside: FileSystem,
}

impl GivenFiles {
    /// Overlays contents on the file system as seen from a folder.
    pub fn new(files: HashMap<String, Vec<u8>>, folder: PathBuf) -> PyResult<Self> {
        let mut named = HashMap::new();
        for (name, bytes) in files {
            if named.insert(bare(&name), bytes).is_some() {
                let name = bare(&name);
                let what =
                    format!("assets: two files are called {name:?}; folders and case do not matter in these names");
                return Err(PyValueError::new_err(what));
            }
        }
        Ok(Self {
            files: named,
            beside: FileSystem::new(folder),
        })
    }
}

/// Returns the name of a file without its folder.
fn bare(path: &str) -> String {
    path.rsplit(['/', '\\']).next().unwrap_or(path).to_lowercase()
}

impl AssetSource for GivenFiles {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        match self.files.get(&bare(path)) {
            Some(bytes) => Ok(Cow::Borrowed(bytes)),
            None => self.beside.read(path),
        }
    }

    fn contains(&self, path: &str) -> bool {
        self.files.contains_key(&bare(path)) || self.beside.contains(path)
    }

    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        self.beside.resolve(dir, file)
    }
}

/// The files next to a document that lies in a folder of the file system but is read under another path.
pub struct BesideDocument {
    files: GivenFiles,
    /// The folder as whose file the document is read.
    read_in: String,
    folder: PathBuf,
}

impl BesideDocument {
    /// Overlays contents on the folder of a document, which must be absolute.
    pub fn new(files: HashMap<String, Vec<u8>>, folder: PathBuf, read_in: &str) -> PyResult<Self> {
        if !folder.is_absolute() {
            let what = format!("folder is {folder:?}: the folder of a document must be absolute");
            return Err(PyValueError::new_err(what));
        }
        Ok(Self {
            files: GivenFiles::new(files, folder.clone())?,
            read_in: read_in.to_owned(),
            folder,
        })
    }
}

impl AssetSource for BesideDocument {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        self.files.read(path)
    }

    fn contains(&self, path: &str) -> bool {
        self.files.contains(path)
    }

    /// All results are absolute, so only the document itself refers to files relative to `read_in`.
    fn resolve(&self, dir: &str, file: &str) -> Result<String, AssetError> {
        if dir == self.read_in {
            self.files.resolve(&self.folder.to_string_lossy(), file)
        } else {
            self.files.resolve(dir, file)
        }
    }
}
