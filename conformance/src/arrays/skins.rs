//! Skins.

use babybench::Model;
use babybench::model::{Skin, SkinBone};

use super::Named;

/// Returns the arrays of skins.
pub fn of_skins(m: &Model) -> Named {
    let each = |of: fn(&Skin) -> f64| m.skins.iter().map(of).collect::<Vec<_>>();
    let bones = || m.skins.iter().flat_map(|skin| &skin.bones);
    let of_bones = |of: fn(&SkinBone) -> usize| bones().map(|bone| of(bone) as f64).collect::<Vec<_>>();
    let singles = |values: Vec<f32>| values.into_iter().map(f64::from).collect::<Vec<_>>();
    vec![
        ("skin_matid", each(|skin| skin.material.map_or(-1.0, |m| m as f64))),
        ("skin_group", each(|skin| f64::from(skin.group))),
        (
            "skin_rgba",
            m.skins
                .iter()
                .flat_map(|skin| skin.rgba)
                .map(|x| f64::from(x as f32))
                .collect(),
        ),
        ("skin_inflate", each(|skin| f64::from(skin.inflate as f32))),
        ("skin_vertnum", each(|skin| skin.vert.len() as f64)),
        ("skin_facenum", each(|skin| skin.face.len() as f64)),
        ("skin_bonenum", each(|skin| skin.bones.len() as f64)),
        (
            "skin_vert",
            singles(
                m.skins
                    .iter()
                    .flat_map(|skin| skin.vert.as_flattened())
                    .copied()
                    .collect(),
            ),
        ),
        (
            "skin_texcoord",
            singles(
                m.skins
                    .iter()
                    .flat_map(|skin| skin.texcoord.as_flattened())
                    .copied()
                    .collect(),
            ),
        ),
        (
            "skin_face",
            m.skins
                .iter()
                .flat_map(|skin| skin.face.as_flattened())
                .map(|&v| f64::from(v))
                .collect(),
        ),
        ("skin_bonebodyid", of_bones(|bone| bone.body)),
        ("skin_bonevertnum", of_bones(|bone| bone.vertid.len())),
        (
            "skin_bonebindpos",
            singles(bones().flat_map(|bone| bone.bindpos).collect()),
        ),
        (
            "skin_bonebindquat",
            singles(bones().flat_map(|bone| bone.bindquat).collect()),
        ),
        (
            "skin_bonevertid",
            bones().flat_map(|bone| &bone.vertid).map(|&v| f64::from(v)).collect(),
        ),
        (
            "skin_bonevertweight",
            singles(bones().flat_map(|bone| bone.vertweight.clone()).collect()),
        ),
    ]
}
