//! Skins: surfaces that follow bodies and are only drawn.

use crate::math::Vec3;

/// A surface whose vertices follow bodies. Numbers are in single precision, as in MuJoCo's arrays `skin_*`.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Name; may be empty.
    pub name: String,
    /// Vertices where the bones are in their bind poses, m (`skin_vert`).
    pub vert: Vec<[f32; 3]>,
    /// Texture coordinates of the vertices, from the top of the image; empty where there are none (`skin_texcoord`).
    pub texcoord: Vec<[f32; 2]>,
    /// Vertices of each triangle, counterclockwise from outside (`skin_face`).
    pub face: Vec<[u32; 3]>,
    /// The bodies that pull.
    pub bones: Vec<SkinBone>,
    /// Colour and opacity (`skin_rgba`).
    pub rgba: [f64; 4],
    /// Distance by which vertices are moved along their normals, m (`skin_inflate`).
    pub inflate: f64,
    /// Visual group (`skin_group`).
    pub group: i32,
    /// Material, by id (`skin_matid`).
    pub material: Option<usize>,
}

/// A body that pulls vertices of a skin.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinBone {
    /// Body, by id (`skin_bonebodyid`).
    pub body: usize,
    /// Position of the body in the bind pose, m (`skin_bonebindpos`).
    pub bindpos: [f32; 3],
    /// Unit orientation of the body in the bind pose (`skin_bonebindquat`).
    pub bindquat: [f32; 4],
    /// Vertices of the skin that it pulls (`skin_bonevertid`).
    pub vertid: Vec<u32>,
    /// Its share of each of them; those of all bones add up to 1 (`skin_bonevertweight`).
    pub vertweight: Vec<f32>,
}

impl Skin {
    /// Half lengths of every skin in MuJoCo's list of drawables, m. A texture of uniform scale is scaled by them.
    pub const SIZE: Vec3 = [0.1; 3];
}
