//! Tables for appearance: textures and materials.

use crate::model::{Builtin, Mark, TextureType};

use super::attribute::Sign::{Any, NonNegative, Positive, Unit};
use super::attribute::{FLAG, Keywords, TEXT, int, real, reals, words};
use super::schema::Element;
use super::table::{Table, table};
use super::words::{BUILTINS, MARKS, MAX_PIXELS, TEXTURES};

table! {
    /// `<texture>`.
    element Texture {
        also cube_files: [Option<String>; 6] = [const { None }; 6];
        set "fileright" => cube_files[0], TEXT, "Image of the right face of a cube.";
        set "fileleft" => cube_files[1], TEXT, "Image of the left face of a cube.";
        set "fileup" => cube_files[2], TEXT, "Image of the upper face of a cube.";
        set "filedown" => cube_files[3], TEXT, "Image of the lower face of a cube.";
        set "filefront" => cube_files[4], TEXT, "Image of the front face of a cube.";
        set "fileback" => cube_files[5], TEXT, "Image of the back face of a cube.";
        "name" name: String = String::new(), TEXT, "Name; else that of the file.";
        "type" kind: TextureType = TextureType::Cube, TEXTURES, "Kind.";
        "builtin" builtin: Builtin = Builtin::None, BUILTINS, "Pattern.";
        "mark" mark: Mark = Mark::None, MARKS, "Marks on the pattern.";
        "rgb1" rgb1: [f64; 3] = [0.8; 3], reals(3, Any), "First colour of the pattern.";
        "rgb2" rgb2: [f64; 3] = [0.5; 3], reals(3, Any), "Second colour of the pattern.";
        "markrgb" markrgb: [f64; 3] = [0.0; 3], reals(3, Any), "Colour of the marks.";
        "random" random: f64 = 0.01, real(Unit), "Probability of a random mark, per pixel.";
        "width" width: usize = 0, int(0, MAX_PIXELS), "Width, pixels.";
        "height" height: usize = 0, int(0, MAX_PIXELS), "Height, pixels.";
        "file" file: Option<String> = None, TEXT, "Image.";
        "gridsize" gridsize: [f64; 2] = [1.0; 2], reals(2, Positive), "Rows and columns of squares in the image of a cube.";
        "gridlayout" gridlayout: Option<String> = None, TEXT, "What each square of the image is, row by row: `R`, `L`, `U`, `D`, `F`, `B` for the right, left, upper, lower, front and back face, `.` for none.";
        "hflip" hflip: bool = false, FLAG, "Whether images are mirrored from left to right.";
        "vflip" vflip: bool = false, FLAG, "Whether images are mirrored from top to bottom.";
        "content_type" content_type: Option<String> = None, TEXT, "Format of the images, whatever the endings of their names: `image/png`.";
        "nchannel" channels: i32 = 3, int(i32::MIN as i64, i32::MAX as i64), "Numbers of a pixel: red, green and blue, and with 4 the opacity, too, as flat images from files and patterns on cubes may have it.";
    }
}

/// The role of the layer that MuJoCo's own renderer draws.
const DRAWN: &str = "rgb";

/// The role of a layer.
const ROLES: Keywords<&str> = words! {
    "rgb" => DRAWN,
    "occlusion" => "occlusion",
    "roughness" => "roughness",
    "metallic" => "metallic",
    "normal" => "normal",
    "opacity" => "opacity",
    "emissive" => "emissive",
    "rgba" => "rgba",
    "orm" => "orm",
};

table! {
    /// A `<layer>` of a material.
    element Layer {
        "texture" texture: String = String::new(), TEXT, required, "Texture.";
        "role" role: Option<&'static str> = None, ROLES, required, "What it is for. Only `rgb` is drawn, as in MuJoCo's own renderer; the others are for other renderers.";
    }
}

impl Material {
    /// Reads the element with its layers. Its texture is the last layer of colours.
    pub fn look(&mut self, e: &Element) {
        self.apply(e);
        self.layers = e.children.iter().map(Layer::read).collect();
        self.two_ways = !self.layers.is_empty() && e.text("texture").is_some();
        if let Some(layer) = self.layers.iter().rfind(|layer| layer.role == Some(DRAWN)) {
            self.texture = Some(layer.texture.clone());
        }
    }
}

table! {
    /// `<material>`.
    element Material {
        also layers: Vec<Layer> = Vec::new();
        also two_ways: bool = false;
        "name" name: String = String::new(), TEXT, required, "Name.";
        "texture" texture: Option<String> = None, TEXT, "Texture.";
        "rgba" rgba: [f64; 4] = [1.0; 4], reals(4, Any), "Colour and opacity.";
        "specular" specular: f64 = 0.5, real(NonNegative), "Strength of highlights.";
        "shininess" shininess: f64 = 0.5, real(Unit), "Sharpness of highlights.";
        "reflectance" reflectance: f64 = 0.0, real(Any), "Strength of reflections, which are not drawn.";
        "emission" emission: f64 = 0.0, real(NonNegative), "Light that the surface emits, times its colour.";
        "texrepeat" texrepeat: [f64; 2] = [1.0; 2], reals(2, Any), "Repetitions of a 2d texture.";
        "texuniform" texuniform: bool = false, FLAG, "Whether the texture repeats per metre instead of per object.";
        check "metallic" | "roughness", real(Any), "Looks of the surface for other renderers. Ignored, as in MuJoCo's own.";
    }
}
