//! File names, for elements that come from other folders.

use super::document::{Document, ElementNode};
use crate::assets::{AssetSource, directory, is_absolute};
use crate::xml::Tree;

/// Attributes that name files.
const FILES: [&str; 7] = [
    "file",
    "fileright",
    "fileleft",
    "fileup",
    "filedown",
    "filefront",
    "fileback",
];

/// Returns the settings of `compiler` for the folder of an element's files; the last one given counts.
fn folders(element: &str) -> Option<[&'static str; 2]> {
    match element {
        "texture" => Some(["assetdir", "texturedir"]),
        "mesh" | "hfield" | "skin" => Some(["assetdir", "meshdir"]),
        "model" => Some([""; 2]),
        _ => None,
    }
}

/// Rewrites the paths of files next to an included document so that the including document finds them.
pub(super) fn rebase(node: &mut ElementNode, tree: &Tree, at: usize, source: &dyn AssetSource) {
    let (main, own) = (&tree.files()[0], tree.file(at));
    let Some(names) = folders(node.rule.name).filter(|_| own != main) else {
        return;
    };
    let root = &tree.nodes[tree.models()[0].root];
    let sections = || {
        root.children
            .iter()
            .map(|&at| &tree.nodes[at])
            .filter(|node| node.name == "compiler")
    };
    let folder = sections()
        .flat_map(|node| names.iter().filter_map(|name| node.attribute(name)))
        .next_back_or_empty();
    let strips = sections()
        .filter_map(|node| node.attribute("strippath"))
        .next_back_or_empty()
        == "true";
    for attribute in FILES {
        let Some(file) = node.attribute(attribute).filter(|file| !file.is_empty()) else {
            continue;
        };
        let file = if strips {
            file.rsplit(['/', '\\']).next().unwrap_or(file)
        } else {
            file
        };
        let probed = match node.rule.name {
            _ if strips => None,
            // an attached model is looked for only next to the file that names it
            "model" => Some("\0"),
            "hfield" | "skin" => Some(
                sections()
                    .filter_map(|node| node.attribute("assetdir"))
                    .next_back_or_empty(),
            ),
            _ => Some(folder),
        };
        let plain = tree.named_file(tree.models()[0].root, file, folder, None, source);
        let found = tree.named_file(at, file, folder, probed, source);
        if let (Ok(plain), Ok(found)) = (plain, found)
            && plain != found
        {
            let text = relative(&joined(directory(main), folder), &found);
            node.put(attribute, text);
        }
    }
}

/// The last of several texts, if any.
trait LastText<'a>: Iterator<Item = &'a str> + Sized {
    fn next_back_or_empty(self) -> &'a str {
        self.last().unwrap_or_default()
    }
}
impl<'a, I: Iterator<Item = &'a str>> LastText<'a> for I {}

/// Returns a folder within another.
fn joined(dir: &str, folder: &str) -> String {
    let folder = folder.trim_end_matches('/');
    match (dir, folder) {
        (dir, "") => dir.to_owned(),
        (_, folder) if is_absolute(folder) => folder.to_owned(),
        ("", folder) => folder.to_owned(),
        (dir, folder) => format!("{}/{folder}", dir.trim_end_matches('/')),
    }
}

/// Returns the name of the file at `path` in a document that looks for files in `folder`.
pub(super) fn relative(folder: &str, path: &str) -> String {
    if is_absolute(path) {
        return path.to_owned();
    }
    let up = folder
        .split('/')
        .filter(|part| !part.is_empty() && *part != ".")
        .count();
    "../".repeat(up) + path
}

impl Document {
    /// Returns the folder in which the files of an element are, as a path in the source.
    fn files_in(&self, element: &str) -> Option<String> {
        let names = folders(element)?;
        let folder = names.iter().filter_map(|name| self.compiler(name)).next_back_or_empty();
        Some(joined(self.folder(), folder))
    }

    /// Returns the files of another document's element under their names in this document.
    pub(super) fn renamed_files(&self, from: &Document, node: &ElementNode) -> Vec<(&'static str, String)> {
        let (Some(here), Some(there)) = (self.files_in(node.rule.name), from.files_in(node.rule.name)) else {
            return Vec::new();
        };
        if here == there {
            return Vec::new();
        }
        let given = FILES.into_iter().filter_map(|name| Some((name, node.attribute(name)?)));
        given
            .filter(|(_, file)| !file.is_empty() && !is_absolute(file))
            .map(|(name, file)| (name, relative(&here, &joined(&there, file))))
            .collect()
    }
}
