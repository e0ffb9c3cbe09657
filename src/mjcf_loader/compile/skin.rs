//! Compiles skins. Numbers are in single precision in all steps, as in MuJoCo.

use super::context::{Context, Ids, Names, named};
use super::mesh::{indices, rows};
use crate::assets::AssetSource;
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError};
use crate::formats::skn::{BoneFile, SkinFile};
use crate::math::MINVAL;
use crate::model::{self, SkinBone};
use crate::skin::{SKIN_ELEMENTS, Skin};

const NO_DATA: &str = "a skin needs a file, or vertices, faces and bones";
const TWICE: &str = "a skin has a file or vertices, faces, texture coordinates and bones, not both";
const TEXCOORDS: &str = "there must be two texture coordinates for each vertex";
const VERTEX: &str = "vertex must have three numbers for each vertex";
const VERTID: &str = "vertid must have whole numbers from 0";
const WEIGHTS: &str = "a bone needs as many vertweight as vertid, one at least";
const FACES: &str = "face names a vertex that the skin does not have";
const VERTICES: &str = "vertid names a vertex that the skin does not have";
const FINITE: &str = "a number of the skin is not finite";
const TOTAL: &str = "each vertex of a skin needs bones whose vertweight is above 0 in total";

/// Compiles all skins. Their files are looked up in `source`; their vertices, texture coordinates, faces and weights together count towards the limit
/// on mesh elements.
pub(super) fn compile_skins(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    source: &dyn AssetSource,
) -> Result<Vec<model::Skin>, LoadError> {
    let names = document.skins.iter().map(|skin| (skin.at, &skin.name));
    Names::new(context.tree, "skin", names)?;
    let mut left = context.tree.limits.mesh_elements;
    let mut skins = Vec::with_capacity(document.skins.len());
    for skin in &document.skins {
        let file = read(context, skin, source)?;
        left = left.checked_sub(file.elements()).ok_or_else(|| {
            let limit = context.tree.limits.mesh_elements;
            let what = SKIN_ELEMENTS;
            context.error(skin.at, ErrorKind::TooMuch { what, limit })
        })?;
        skins.push(compile(context, skin, file, ids)?);
    }
    Ok(skins)
}

fn compile(context: &Context, skin: &Skin, file: SkinFile, ids: &Ids) -> Result<model::Skin, LoadError> {
    let material = match named(&skin.material) {
        Some(name) => Some(ids.material.find(context.tree, skin.at, "material", name)?),
        None => None,
    };
    let bodies = file.bones.iter().enumerate().map(|(k, bone)| {
        // of a file, the skin alone has a place in the document
        let at = skin.bones.get(k).map_or(skin.at, |bone| bone.at);
        ids.body.find(context.tree, at, "body", &bone.body)
    });
    let bodies = bodies.collect::<Result<Vec<_>, _>>()?;
    let file = check(file).map_err(|message| context.invalid(skin.at, message))?;
    Ok(model::Skin {
        name: skin.name.clone(),
        vert: file.vert,
        texcoord: file.texcoord,
        face: file.face,
        bones: bodies.into_iter().zip(file.bones).map(compiled).collect(),
        rgba: skin.rgba,
        inflate: skin.inflate,
        group: skin.group,
        material,
    })
}

/// Reads the file of a skin, or the data in the document.
fn read(context: &Context, skin: &Skin, source: &dyn AssetSource) -> Result<SkinFile, LoadError> {
    let given = [skin.vertex.is_empty(), skin.face.is_empty(), skin.bones.is_empty()];
    match &skin.file {
        Some(_) if given.contains(&false) || !skin.texcoord.is_empty() => Err(context.invalid(skin.at, TWICE)),
        Some(file) => {
            let path = context.asset_path(skin.at, file, context.mesh_dirs(skin.at), source)?;
            let bytes = source.read(&path).map_err(|e| context.error(skin.at, e))?;
            SkinFile::read(&bytes).map_err(|error| {
                let (file, message) = (Some(path), error.to_string());
                context.error(skin.at, ErrorKind::Mesh { file, message })
            })
        }
        None => written(skin).map_err(|message| context.invalid(skin.at, message)),
    }
}

/// Uses the data in the document.
fn written(skin: &Skin) -> Result<SkinFile, &'static str> {
    let bones = skin.bones.iter().map(|bone| {
        let index = |&x: &f64| (x.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&x)).then_some(x as u32);
        Ok(BoneFile {
            body: bone.body.clone(),
            bindpos: bone.bindpos.map(|x| x as f32),
            bindquat: bone.bindquat.map(|x| x as f32),
            vertid: bone.vertid.iter().map(index).collect::<Option<_>>().ok_or(VERTID)?,
            vertweight: bone.vertweight.iter().map(|&x| x as f32).collect(),
        })
    });
    Ok(SkinFile {
        vert: rows(&skin.vertex, VERTEX)?,
        texcoord: rows(&skin.texcoord, TEXCOORDS)?,
        face: indices(&skin.face)?,
        bones: bones.collect::<Result<_, &'static str>>()?,
    })
}

/// Checks a skin, and scales its weights.
fn check(mut skin: SkinFile) -> Result<SkinFile, &'static str> {
    if skin.vert.is_empty() || skin.face.is_empty() || skin.bones.is_empty() {
        return Err(NO_DATA);
    }
    if !skin.texcoord.is_empty() && skin.texcoord.len() != skin.vert.len() {
        return Err(TEXCOORDS);
    }
    let count = skin.vert.len();
    let known = |&vertex: &u32| (vertex as usize) < count;
    // MuJoCo takes these, and draws whatever follows the vertices in its memory
    if !skin.face.as_flattened().iter().all(known) {
        return Err(FACES);
    }
    let finite = |numbers: &[f32]| numbers.iter().all(|x| x.is_finite());
    let poses = |bone: &BoneFile| finite(&bone.bindpos) && finite(&bone.bindquat) && finite(&bone.vertweight);
    if !finite(skin.vert.as_flattened()) || !finite(skin.texcoord.as_flattened()) || !skin.bones.iter().all(poses) {
        return Err(FINITE);
    }
    let mut total = vec![0.0_f32; count];
    for bone in &skin.bones {
        if bone.vertid.is_empty() || bone.vertid.len() != bone.vertweight.len() {
            return Err(WEIGHTS);
        }
        for (&vertex, &weight) in bone.vertid.iter().zip(&bone.vertweight) {
            *total.get_mut(vertex as usize).ok_or(VERTICES)? += weight;
        }
    }
    if total
        .iter()
        .any(|&total| f64::from(total) <= MINVAL || !total.is_finite())
    {
        return Err(TOTAL);
    }
    for bone in &mut skin.bones {
        for (&vertex, weight) in bone.vertid.iter().zip(&mut bone.vertweight) {
            *weight /= total[vertex as usize];
        }
    }
    Ok(skin)
}

/// Returns a bone with its body, its orientation scaled to a unit quaternion; as in MuJoCo, a quaternion of zeros stays.
fn compiled((body, bone): (usize, BoneFile)) -> SkinBone {
    let quat = bone.bindquat.map(f64::from);
    let norm = quat.iter().map(|x| x * x).sum::<f64>().sqrt();
    let bindquat = if norm < MINVAL {
        bone.bindquat
    } else {
        quat.map(|x| (x / norm) as f32)
    };
    SkinBone {
        body,
        bindpos: bone.bindpos,
        bindquat,
        vertid: bone.vertid,
        vertweight: bone.vertweight,
    }
}
