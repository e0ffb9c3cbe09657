//! The part of the typed document that tells how things look: textures and materials.

use crate::model::{Builtin, Mark, TextureType};

use super::schema::Element;

pub(super) struct Texture {
    pub at: usize,
    pub name: String,
    pub kind: TextureType,
    pub builtin: Builtin,
    pub mark: Mark,
    pub rgb1: [f64; 3],
    pub rgb2: [f64; 3],
    pub markrgb: [f64; 3],
    pub random: f64,
    pub width: usize,
    pub height: usize,
    pub file: Option<String>,
    pub cube_files: [Option<String>; 6],
}

/// In the order of `cube_files`.
const FACES: [&str; 6] = ["fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"];

impl Texture {
    pub fn read(e: &Element) -> Texture {
        let owned = |name: &str| e.text(name).map(str::to_owned);
        let mut texture = Texture {
            at: e.at,
            name: owned("name").unwrap_or_default(),
            kind: TextureType::Cube,
            builtin: Builtin::None,
            mark: Mark::None,
            rgb1: e.array("rgb1").unwrap_or([0.8; 3]),
            rgb2: e.array("rgb2").unwrap_or([0.5; 3]),
            markrgb: e.array("markrgb").unwrap_or([0.0; 3]),
            random: e.array("random").map_or(0.01, |[random]| random),
            width: 0,
            height: 0,
            file: owned("file"),
            cube_files: FACES.map(owned),
        };
        let kinds = [TextureType::Flat2d, TextureType::Cube, TextureType::Skybox];
        e.set_word("type", &kinds, &mut texture.kind);
        let builtins = [Builtin::None, Builtin::Gradient, Builtin::Checker, Builtin::Flat];
        e.set_word("builtin", &builtins, &mut texture.builtin);
        e.set_word(
            "mark",
            &[Mark::None, Mark::Edge, Mark::Cross, Mark::Random],
            &mut texture.mark,
        );
        e.set_int("width", &mut texture.width);
        e.set_int("height", &mut texture.height);
        texture
    }
}

#[derive(Clone)]
pub(super) struct Material {
    pub at: usize,
    pub name: String,
    pub texture: Option<String>,
    pub rgba: [f64; 4],
    pub specular: f64,
    pub shininess: f64,
    pub reflectance: f64,
    pub emission: f64,
    pub texrepeat: [f64; 2],
    pub texuniform: bool,
}

impl Default for Material {
    fn default() -> Self {
        Material {
            at: 0,
            name: String::new(),
            texture: None,
            rgba: [1.0; 4],
            specular: 0.5,
            shininess: 0.5,
            reflectance: 0.0,
            emission: 0.0,
            texrepeat: [1.0; 2],
            texuniform: false,
        }
    }
}

impl Material {
    pub fn apply(&mut self, e: &Element) {
        self.at = e.at;
        e.set_text("name", &mut self.name);
        e.set_optional_text("texture", &mut self.texture);
        e.fill("rgba", &mut self.rgba);
        e.set_real("specular", &mut self.specular);
        e.set_real("shininess", &mut self.shininess);
        e.set_real("reflectance", &mut self.reflectance);
        e.set_real("emission", &mut self.emission);
        e.fill("texrepeat", &mut self.texrepeat);
        e.set_flag("texuniform", &mut self.texuniform);
    }
}
