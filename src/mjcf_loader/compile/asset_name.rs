//! Names of meshes and height fields.

use crate::error::{ErrorKind, LoadError};
use crate::xml::Tree;

/// Returns the name of the asset at a place in the text. An asset without a name is named after its file, without directory and extension.
pub(super) fn asset_name(tree: &Tree, at: usize, name: &str, file: Option<&str>) -> Result<String, LoadError> {
    match stem(name, file) {
        "" => Err(tree.error(at, ErrorKind::MissingAttribute("name"))),
        name => Ok(name.to_owned()),
    }
}

/// Returns `name`, or, if it is empty, the name of a file without directory and extension.
pub(crate) fn stem<'n>(name: &'n str, file: Option<&'n str>) -> &'n str {
    if !name.is_empty() {
        return name;
    }
    let file = file.unwrap_or_default();
    let stem = file.rsplit(['/', '\\']).next().unwrap_or(file);
    stem.rsplit_once('.').map_or(stem, |(name, _)| name)
}
