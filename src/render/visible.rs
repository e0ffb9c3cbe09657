//! The parts of a model that are drawn: its visible elements, with their meshes and textures.

use crate::RenderError;
use crate::drawable::{Drawable, Element, OPAQUE, Shape, material};
use crate::flex::FlexLook;
use crate::math::Vec3;
use crate::mesh::Mesh;
use crate::model::{Model, Texture};
use crate::model_mesh::ModelMeshes;
use crate::scenery::Scenery;
use crate::skin::SkinLook;
use crate::tendon::{pieces, ropes};
use crate::texture::{TextureLoader, TexturePixels};

/// Groups of geoms, sites, tendons, flexes and skins that are visible.
const VISIBLE_GROUPS: std::ops::RangeTo<i32> = ..3;
/// The visible drawables of a model, and those among them whose meshes change with the poses.
pub(super) struct SceneryShapes {
    pub drawables: Vec<Drawable>,
    pub flexes: Vec<FlexLook>,
    pub skins: Vec<SkinLook>,
}

/// Makes the visible drawables, except for the placement of their textures, and adds the meshes of the model to `meshes`.
pub(super) fn drawables(
    model: &Model,
    far: f32,
    used: &mut UsedTextures,
    meshes: &mut Vec<Mesh>,
) -> Result<SceneryShapes, RenderError> {
    let (ropes, mut model_meshes) = (ropes(model), ModelMeshes::new(model));
    let (mut drawables, mut soft, mut pipe) = (Vec::new(), Vec::new(), None);
    for element in visible(model, &ropes) {
        let mut drawable = Drawable::new(model, element, far);
        if drawable.rgba[3] <= 0.0 {
            continue;
        }
        if let Element::Tendon { tendon, .. } = element {
            drawable.rope = ropes[tendon];
        }
        // as in MuJoCo, flexes without texture coordinates have no texture
        let plain = match element {
            Element::FlexEdge { .. } => true,
            Element::Flex(flex) => model.flexes[flex].texcoord.is_empty(),
            _ => false,
        };
        let texture = material(model, element).and_then(|m| model.materials[m].texture);
        if let Some(texture) = texture.filter(|_| !plain) {
            drawable.texture = used.texture(texture)?;
            if drawable.rgba[3] < OPAQUE || drawable.shape == Shape::Plane {
                used.blended(texture)?;
            }
        }
        if let Element::FlexEdge { .. } = element {
            let mesh = *pipe.get_or_insert_with(|| {
                meshes.push(Mesh::pipe());
                meshes.len() - 1
            });
            drawables.push(drawable.showing(mesh));
        } else if let Element::Flex(_) | Element::Skin(_) = element {
            soft.push(drawable);
        } else if drawable.shape == Shape::Mesh {
            let parts = model_meshes.parts(model, element, meshes);
            drawables.extend(parts.map(|mesh| drawable.showing(mesh)));
        } else {
            drawables.push(drawable);
        }
    }
    // behind all other meshes, whose number is known now
    let mut mesh = meshes.len();
    let (mut flexes, mut skins) = (Vec::new(), Vec::new());
    for drawable in soft {
        let count = match drawable.element {
            Element::Flex(flex) => {
                flexes.push(FlexLook::new(&model.flexes[flex]));
                flexes.last().map_or(0, |look| look.parts.len())
            }
            Element::Skin(skin) => {
                skins.push(SkinLook::new(&model.skins[skin]));
                skins.last().map_or(0, |look| look.parts.len())
            }
            _ => 0,
        };
        drawables.extend((mesh..mesh + count).map(|mesh| drawable.showing(mesh)));
        mesh += count;
    }
    Ok(SceneryShapes {
        drawables,
        flexes,
        skins,
    })
}

/// Lists the elements of visible groups, in the order in which MuJoCo draws them.
fn visible<'a>(model: &'a Model, ropes: &'a [Vec3]) -> impl Iterator<Item = Element> + 'a {
    let geoms = (0..model.ngeom()).filter(|&g| VISIBLE_GROUPS.contains(&model.geom_group[g]));
    let sites = (0..model.nsite()).filter(|&s| VISIBLE_GROUPS.contains(&model.site_group[s]));
    let tendons = (0..model.ntendon()).filter(|&t| VISIBLE_GROUPS.contains(&model.tendon_group[t]));
    let tendons = tendons.flat_map(move |tendon| pieces(model, tendon, ropes[tendon]));
    let skins = (0..model.nskin()).filter(|&s| VISIBLE_GROUPS.contains(&model.skins[s].group));
    let parts = geoms.map(Element::Geom).chain(sites.map(Element::Site)).chain(tendons);
    parts.chain(flexes(model)).chain(skins.map(Element::Skin))
}

/// Lists the visible flexes: first the edges of flexes of lines, which are not drawn without a radius, then the others.
fn flexes(model: &Model) -> impl Iterator<Item = Element> + '_ {
    let visible = || (0..model.nflex()).filter(|&f| VISIBLE_GROUPS.contains(&model.flexes[f].group));
    let lines = visible().filter(|&f| model.flexes[f].dim == 1 && model.flexes[f].radius > 0.0);
    let edges =
        lines.flat_map(|flex| (0..model.flexes[flex].edge.len()).map(move |edge| Element::FlexEdge { flex, edge }));
    edges.chain(visible().filter(|&f| model.flexes[f].dim > 1).map(Element::Flex))
}

/// The textures that drawables use. Others are not decoded.
pub(super) struct UsedTextures<'a> {
    pub model: &'a Model,
    pub loader: Option<TextureLoader<'a>>,
    /// The scenery whose textures need not be decoded again.
    pub known: Option<&'a Scenery>,
    /// The place of each texture of the model among those that are used.
    pub index: Vec<Option<usize>>,
    pub textures: Vec<TexturePixels>,
    /// Their recipes.
    pub recipes: Vec<Texture>,
}

impl UsedTextures<'_> {
    /// Returns the place of a texture, which is loaded on first use; `None` without a loader.
    pub fn texture(&mut self, id: usize) -> Result<Option<usize>, RenderError> {
        let (Some(recipe), Some(loader)) = (self.model.textures.get(id), &mut self.loader) else {
            return Ok(None);
        };
        if self.index[id].is_none() {
            let known = self.known.and_then(|scenery| {
                let at = scenery.recipes.iter().position(|known| known == recipe)?;
                scenery.textures.get(at)
            });
            self.textures.push(match known {
                Some(texture) => texture.clone(),
                None => loader.texture(recipe)?,
            });
            self.recipes.push(recipe.clone());
            self.index[id] = Some(self.textures.len() - 1);
        }
        Ok(self.index[id])
    }

    /// Checks the texture of a drawable that is blended, at least from some sides.
    fn blended(&self, id: usize) -> Result<(), RenderError> {
        match (self.model.textures.get(id), &self.loader) {
            (Some(recipe), Some(loader)) => loader.blended(recipe),
            _ => Ok(()),
        }
    }
}
