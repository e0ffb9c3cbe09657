//! Attributes of a document that have no effect.

use super::{CustomScene, FOLDER};
use crate::assets::AssetSource;
use crate::config::Config;
use crate::limits::Limits;
use crate::mimo::document::{document_path, scene_xml};
use crate::mimo::error::SceneError;
use crate::mjcf_loader::{Location, Tree, elements};

/// An attribute of a custom scene that has no effect here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnusedAttribute {
    /// Place of the element.
    pub place: Location,
    /// The attribute.
    pub attribute: String,
    /// Its meaning, and why it has no effect.
    pub meaning: &'static str,
}

/// Lists the attributes in the files of a custom scene that have no effect here; none for a scene of the library.
///
/// Everything else in a document has an effect, because unknown content is an error.
///
/// # Errors
/// A document that cannot be read.
pub fn unused_attributes(config: &Config, assets: &dyn AssetSource) -> Result<Vec<UnusedAttribute>, SceneError> {
    let Some(room) = CustomScene::open(config, assets)? else {
        return Ok(Vec::new());
    };
    let top = document_path(config);
    let read = Tree::read(&scene_xml(config), top, &room, &Limits::default());
    let (tree, _) = read.map_err(|e| room.localized_load(e))?;
    let known = elements();
    let meaning = |element: &str, attribute: &str| {
        let mut found = known
            .iter()
            .filter(|e| e.path.rsplit('/').next() == Some(element))
            .flat_map(|e| &e.attributes);
        let attribute = found.find(|a| a.name == attribute)?;
        let idle = ["Ignored", "not drawn"]
            .iter()
            .any(|word| attribute.meaning.contains(word));
        idle.then_some(attribute.meaning)
    };
    let mut unused = Vec::new();
    for (at, node) in tree.nodes.iter().enumerate() {
        let own = tree.file(at).strip_prefix(FOLDER).filter(|name| !room.library(name));
        if own.is_none() || tree.file(at) == top {
            continue;
        }
        for (attribute, _) in &node.attributes {
            if let Some(meaning) = meaning(&node.name, attribute) {
                let mut place = tree.place(at);
                room.locate(&mut place);
                unused.push(UnusedAttribute {
                    place,
                    attribute: attribute.clone(),
                    meaning,
                });
            }
        }
    }
    Ok(unused)
}
