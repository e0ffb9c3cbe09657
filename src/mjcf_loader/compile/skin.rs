//! Looks through skins: what MuJoCo refuses of them is an error, the rest is not kept.

use super::context::{Context, Ids, named};
use super::surface::asset_path;
use crate::assets::AssetSource;
use crate::mjcf_loader::document::Document;
use crate::mjcf_loader::error::LoadError;

const NO_DATA: &str = "a skin needs a file, or vertices, faces and bones";
const TWICE: &str = "a skin has a file or vertices, faces and bones, not both";

/// Checks all skins. Their files must be in `source`, relative to the folders of the models that name them.
pub(super) fn check_skins(
    context: &Context,
    document: &Document,
    ids: &Ids,
    source: &dyn AssetSource,
) -> Result<(), LoadError> {
    for skin in &document.skins {
        if let Some(material) = named(&skin.material) {
            ids.material.find(context.tree, skin.at, "material", material)?;
        }
        for bone in &skin.bones {
            ids.body.find(context.tree, bone.at, "body", &bone.body)?;
        }
        let given = [skin.vertex.is_empty(), skin.face.is_empty(), skin.bones.is_empty()];
        match &skin.file {
            Some(_) if given.contains(&false) => return Err(context.invalid(skin.at, TWICE)),
            Some(file) => {
                let path = asset_path(context, skin.at, file, context.meshdir(skin.at), source)?;
                source.read(&path).map_err(|e| context.error(skin.at, e))?;
            }
            None if given.contains(&true) => return Err(context.invalid(skin.at, NO_DATA)),
            None => {}
        }
    }
    Ok(())
}
