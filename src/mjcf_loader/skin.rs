//! The tables of skins: surfaces that bodies pull along, which are looked through, and not drawn.

use super::attribute::Sign::Any;
use super::attribute::{Kind, TEXT, int, real, reals};
use super::table::table;
use super::words::MAX_GROUP;

table! {
    /// `<skin>`.
    element Skin {
        also bones: Vec<Bone> = Vec::new();
        "name" name: String = String::new(), TEXT, own, "Name.";
        "file" file: Option<String> = None, TEXT, "File, which must be there. Ignored: skins are not drawn.";
        "material" material: Option<String> = None, TEXT, "Material. Ignored: skins are not drawn.";
        "vertex" vertex: Vec<f64> = Vec::new(), Kind::Data, "Vertices, m, three numbers each. Ignored: skins are not drawn.";
        "face" face: Vec<f64> = Vec::new(), Kind::Data, "Vertices of each triangle. Ignored: skins are not drawn.";
        check "texcoord", Kind::Data, "Texture coordinates of the vertices. Ignored: skins are not drawn.";
        check "rgba", reals(4, Any), "Colour and opacity. Ignored: skins are not drawn.";
        check "inflate", real(Any), "How far it is blown up, m. Ignored: skins are not drawn.";
        check "group", int(0, MAX_GROUP), "Visual group. Ignored: skins are not drawn.";
    }
}

table! {
    /// `<bone>` of a skin.
    element Bone {
        "body" body: String = String::new(), TEXT, required, "Body that pulls.";
        check "bindpos", reals(3, Any), "Position of the body where the skin is as written, m. Ignored: skins are not drawn.";
        check "bindquat", reals(4, Any), "Its orientation. Ignored: skins are not drawn.";
        check "vertid" | "vertweight", Kind::Data, "Vertices that it pulls, and how much. Ignored: skins are not drawn.";
    }
}
