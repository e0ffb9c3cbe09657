//! The tables of skins: surfaces that follow bodies.

use super::attribute::Sign::Any;
use super::attribute::{AttributeKind, TEXT, int, real, reals};
use super::table::table;
use super::words::MAX_SKIN_GROUP;
use crate::math::{Quat, Vec3};

table! {
    /// `<skin>`.
    element Skin {
        also bones: Vec<Bone> = Vec::new();
        "name" name: String = String::new(), TEXT, own, "Name.";
        "file" file: Option<String> = None, TEXT, "SKN file, which has vertices, faces, texture coordinates and bones.";
        "material" material: Option<String> = None, TEXT, "Material.";
        "vertex" vertex: Vec<f64> = Vec::new(), AttributeKind::Data, "Vertices, m, three numbers each.";
        "face" face: Vec<f64> = Vec::new(), AttributeKind::Indices, "Vertices of each triangle, counterclockwise from outside.";
        "texcoord" texcoord: Vec<f64> = Vec::new(), AttributeKind::Data, "Texture coordinates of the vertices, two numbers each.";
        "rgba" rgba: [f64; 4] = [0.5, 0.5, 0.5, 1.0], reals(4, Any), "Colour and opacity.";
        "inflate" inflate: f64 = 0.0, real(Any), "How far vertices are moved along their normals, m.";
        "group" group: i32 = 0, int(0, MAX_SKIN_GROUP), "Visual group; 0 to 2 are drawn.";
    }
}

/// The name of the elements that count towards a limit on skins.
pub(super) const SKIN_ELEMENTS: &str = "vertices, texture coordinates, faces and weights of skins";

impl Skin {
    /// Returns the number of elements given in the document itself.
    pub fn elements(&self) -> usize {
        let weights: usize = self.bones.iter().map(|bone| bone.vertid.len()).sum();
        self.vertex.len() / 3 + self.texcoord.len() / 2 + self.face.len() / 3 + weights
    }
}

table! {
    /// `<bone>` of a skin.
    element Bone {
        "body" body: String = String::new(), TEXT, required, "Body that pulls.";
        "bindpos" bindpos: Vec3 = [0.0; 3], reals(3, Any), required, "Position of the body where the skin is as written, m.";
        "bindquat" bindquat: Quat = [1.0, 0.0, 0.0, 0.0], reals(4, Any), required, "Its orientation.";
        "vertid" vertid: Vec<f64> = Vec::new(), AttributeKind::Indices, required, "Vertices that it pulls.";
        "vertweight" vertweight: Vec<f64> = Vec::new(), AttributeKind::Data, required, "How much it pulls each of them; those of all bones are scaled so that they add up to 1.";
    }
}
