//! Documents with all files that they name, as a folder: images, meshes, and attached models, which are separate documents.

use std::collections::BTreeMap;

use super::{SceneFile, SceneFileError};
use crate::assets::AssetSource;
use crate::limits::Limits;
use crate::mjcf_loader::Tree;

/// Folders next to the document: images, meshes and height fields, models.
pub(super) const IMAGES: &str = "tex";
const MESHES: &str = "mesh";
const MODELS: &str = "models";
/// Attributes of textures that name images.
const IMAGE_ATTRIBUTES: [&str; 7] = [
    "file",
    "fileright",
    "fileleft",
    "fileup",
    "filedown",
    "filefront",
    "fileback",
];

/// Writes a document and its includes as one document, with the files that it names, after `comment`.
pub(super) fn complete(
    document: &str,
    path: &str,
    comment: String,
    assets: &dyn AssetSource,
) -> Result<SceneFile, SceneFileError> {
    let (tree, root) = Tree::read(document, path, assets, &Limits::default())?;
    let mut copies = CopiedFiles {
        strips: setting(&tree, root, &["strippath"]).is_some_and(|text| text == "true"),
        tree: &tree,
        assets,
        files: BTreeMap::new(),
    };
    let mut xml = comment;
    tree.write(root, &mut xml, |at, name, value| copies.replaced(at, name, value))?;
    for (k, model) in tree.models().iter().enumerate().skip(1) {
        let mut text = String::new();
        tree.write(model.root, &mut text, |at, name, value| {
            copies.replaced(at, name, value)
        })?;
        copies.files.insert(model_name(k), text.into_bytes());
    }
    let files = copies.files;
    Ok(SceneFile { xml, files })
}

/// The files that a document names, and their new paths.
struct CopiedFiles<'a> {
    tree: &'a Tree,
    assets: &'a dyn AssetSource,
    files: BTreeMap<String, Vec<u8>>,
    /// Whether folders in names of files are ignored.
    strips: bool,
}

impl CopiedFiles<'_> {
    /// Returns the new value of an attribute, if it changes.
    fn replaced(&mut self, at: usize, attribute: &str, value: &str) -> Result<Option<String>, SceneFileError> {
        let kept = match (self.tree.nodes[at].name.as_str(), attribute) {
            // files get new paths, to which these settings must not apply
            ("compiler", "texturedir" | "meshdir" | "assetdir") => return Ok(Some(String::new())),
            ("compiler", "strippath") => return Ok(Some("false".to_string())),
            (_, _) if value.is_empty() => return Ok(None),
            ("texture", name) if IMAGE_ATTRIBUTES.contains(&name) => self.copy(at, value, IMAGES, "texturedir")?,
            ("mesh" | "hfield" | "skin", "file") => self.copy(at, value, MESHES, "meshdir")?,
            ("model", "file") => {
                let named = self.tree.models().iter().skip(1).position(|model| model.of == at);
                match named {
                    Some(k) => model_name(k + 1),
                    None => return Ok(None),
                }
            }
            _ => return Ok(None),
        };
        // a model's paths start at its own folder
        let inside = self.tree.model_of(at) > 0;
        Ok(Some(if inside { format!("../{kept}") } else { kept }))
    }

    /// Includes a file and returns its new path. Files of equal names from different folders go into numbered folders. An element without a name is
    /// named after its file.
    fn copy(&mut self, at: usize, file: &str, folder: &str, setting: &str) -> Result<String, SceneFileError> {
        let own = file.rsplit(['/', '\\']).next().unwrap_or(file);
        let broken = |reason: String| SceneFileError::Asset {
            file: file.to_string(),
            reason,
        };
        let from = self.folder(at, &["assetdir", setting]);
        let path = if self.strips {
            self.tree.named_file(at, own, from, None, self.assets)
        } else {
            let probed = match self.tree.nodes[at].name.as_str() {
                "hfield" | "skin" => self.folder(at, &["assetdir"]),
                _ => from,
            };
            self.tree.named_file(at, file, from, Some(probed), self.assets)
        };
        let path = path.map_err(|e| broken(e.to_string()))?;
        let bytes = self.assets.read(&path).map_err(|e| broken(e.to_string()))?.into_owned();
        let mut name = format!("{folder}/{own}");
        let mut number = 1;
        while self.files.get(&name).is_some_and(|there| *there != bytes) {
            number += 1;
            name = format!("{folder}/{number}/{own}");
        }
        self.files.insert(name.clone(), bytes);
        Ok(name)
    }

    /// Returns the folder of images or meshes for an element: that of its model, or of the model that names it.
    fn folder(&self, at: usize, names: &[&str]) -> &str {
        let mut model = Some(self.tree.model_of(at));
        while let Some(one) = model {
            let found = setting(self.tree, self.tree.models()[one].root, names);
            if let Some(folder) = found.filter(|folder| !folder.is_empty()) {
                return folder;
            }
            model = self.tree.models()[one].within;
        }
        ""
    }
}

/// Returns the last value of an attribute in the `compiler` sections below a root. Within a section, the last value counts.
fn setting<'t>(tree: &'t Tree, root: usize, names: &[&str]) -> Option<&'t str> {
    let sections = tree.nodes[root].children.iter().map(|&at| &tree.nodes[at]);
    let sections = sections.filter(|node| node.name == "compiler");
    sections
        .flat_map(|node| names.iter().filter_map(|name| node.attribute(name)))
        .last()
}

/// Returns the name of the document of a model.
fn model_name(k: usize) -> String {
    format!("{MODELS}/{k}.xml")
}
