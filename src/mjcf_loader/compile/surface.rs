//! Compiles textures and materials.

use super::context::{Context, Ids};
use crate::assets::AssetSource;
use crate::error::{ErrorKind, LoadError};
use crate::formats::png::check_png;
use crate::model::{self, Builtin, TextureType};
use crate::settings::single;
use crate::surface;

/// Compiles a texture. Its images are looked up in `source` and checked, but not decoded.
pub(super) fn compile_texture(
    context: &Context,
    texture: &surface::Texture,
    source: &dyn AssetSource,
) -> Result<model::Texture, LoadError> {
    // the faces of a builtin cube are as high as wide
    let flat = texture.kind == TextureType::Flat2d;
    let builtin = texture.builtin != Builtin::None;
    let invalid = |message| Err(context.invalid(texture.at, message));
    let path = |file: &String| context.asset_path(texture.at, file, [context.texturedir(texture.at); 2], source);
    // a pattern has no images; file names are ignored
    let named = |file: &Option<String>| file.as_ref().filter(|_| !builtin).map(path).transpose();
    let mut cube_files = [const { None }; 6];
    for (to, from) in cube_files.iter_mut().zip(&texture.cube_files) {
        *to = named(from)?;
    }
    let file = named(&texture.file)?;
    if !builtin {
        if file.is_none() && cube_files.iter().all(Option::is_none) {
            return invalid("the texture has neither a builtin nor a file");
        }
    } else if texture.width == 0 || flat && texture.height == 0 {
        return invalid("a builtin texture needs a width, and if it is flat a height");
    } else if texture.width * height(texture) >= MOST_NUMBERS / 3 {
        return invalid("the pattern has more numbers than MuJoCo counts: make it smaller");
    }
    let channels = channels(texture).map_err(|message| context.invalid(texture.at, message))?;
    let (gridsize, gridlayout) = if builtin {
        ([1; 2], Vec::new())
    } else {
        grid(context, texture)?
    };
    check_images(context, texture, (&file, &cube_files), gridsize, source)?;
    Ok(model::Texture {
        name: texture_name(context, texture)?,
        kind: texture.kind,
        builtin: texture.builtin,
        mark: texture.mark,
        rgb1: texture.rgb1,
        rgb2: texture.rgb2,
        markrgb: texture.markrgb,
        random: texture.random,
        width: texture.width,
        height: if builtin { height(texture) } else { texture.height },
        file,
        gridsize,
        gridlayout,
        flip: [texture.hflip, texture.vflip],
        channels,
        cube_files,
    })
}

/// Returns the height of a pattern, pixels; that of a cube includes the six faces.
fn height(texture: &surface::Texture) -> usize {
    match texture.kind {
        TextureType::Flat2d => texture.height,
        TextureType::Cube | TextureType::Skybox => 6 * texture.width,
    }
}

/// Maximum number of values of a texture in MuJoCo.
const MOST_NUMBERS: usize = i32::MAX as usize;

/// Checks the images of a texture, so that it can be drawn: their format, and their sizes where it is a cube.
fn check_images(
    context: &Context,
    texture: &surface::Texture,
    (file, cube_files): (&Option<String>, &[Option<String>; 6]),
    [rows, columns]: [usize; 2],
    source: &dyn AssetSource,
) -> Result<(), LoadError> {
    let cube = texture.kind != TextureType::Flat2d;
    let fault = |path: &str, message: String| {
        let (file, message) = (Some(path.to_owned()), message);
        Err(context.error(texture.at, ErrorKind::Mesh { file, message }))
    };
    let [rows, columns] = [rows, columns].map(|count| u32::try_from(count).unwrap_or(u32::MAX).max(1));
    let mut side = None;
    // as in MuJoCo, faces count where there is no single image
    let faces: &[Option<String>] = if file.is_some() { &[] } else { cube_files.as_slice() };
    for path in file.iter().chain(faces.iter().flatten()) {
        let [width, height] = match image_size(context, texture, path, source) {
            Ok(Some(size)) => size,
            Ok(None) => continue,
            Err(message) => return fault(path, message),
        };
        let fits = if file.is_some() {
            width % columns == 0 && height % rows == 0 && width / columns == height / rows
        } else {
            width == height && side.is_none_or(|side| side == width)
        };
        side = Some(width);
        if cube && !fits {
            let what =
                "the faces of a cube are squares of one size, each a square of gridsize where one image holds them";
            return fault(path, format!("{width} x {height} pixels: {what}"));
        }
    }
    Ok(())
}

/// Checks an image; returns its width and height, pixels, if the source has it.
fn image_size(
    context: &Context,
    texture: &surface::Texture,
    path: &str,
    source: &dyn AssetSource,
) -> Result<Option<[u32; 2]>, String> {
    let png = match texture.content_type.as_deref() {
        Some(format) => format == "image/png",
        None => path.to_ascii_lowercase().ends_with(".png"),
    };
    if !png {
        return Err(ONLY_PNG.to_owned());
    }
    // programs may leave images out that they do not draw
    let bytes = source.read(path).unwrap_or_default();
    if bytes.is_empty() {
        return Ok(None);
    }
    let size = check_png(&bytes, &context.tree.limits).map_err(|message| {
        // a broken picture is no reason to convert it
        let broken = bytes.starts_with(b"\x89PNG");
        if broken {
            message
        } else {
            format!("{message}; {ONLY_PNG}")
        }
    })?;
    Ok(Some(size))
}

const ONLY_PNG: &str =
    "textures are read from PNG pictures: convert it, and let its name end with .png or content_type be image/png";

/// Returns the number of values of a pixel, if MuJoCo 3.3.0 draws them with their meaning.
fn channels(texture: &surface::Texture) -> Result<usize, &'static str> {
    let flat = texture.kind == TextureType::Flat2d;
    match (texture.channels, texture.builtin != Builtin::None) {
        (3, _) => Ok(3),
        (4, builtin) if builtin != flat => Ok(4),
        (4, true) => Err(PACKED),
        (4, false) => Err(FACES),
        _ => Err(CHANNELS),
    }
}

const CHANNELS: &str =
    "MuJoCo 3.3.0 draws textures of three channels, or four: leave nchannel out, with which grey images are drawn grey";
// the pattern has three numbers for each pixel wherever it is, and is read by four, or the images have four and are read by three
const PACKED: &str = "MuJoCo 3.3.0 scrambles a flat pattern of four channels: leave nchannel out";
const FACES: &str = "MuJoCo 3.3.0 scrambles images of four channels on a cube: leave nchannel out";

/// Maximum number of squares of a grid.
const SQUARES: usize = 12;

/// Returns the rows and columns of the grid of a cube's image, and the face of each square.
fn grid(context: &Context, texture: &surface::Texture) -> Result<([usize; 2], Vec<Option<usize>>), LoadError> {
    let invalid = |message| context.invalid(texture.at, message);
    let [rows, columns] = texture.gridsize;
    if rows.fract() != 0.0 || columns.fract() != 0.0 || rows * columns > SQUARES as f64 {
        return Err(invalid(
            "gridsize must be two whole numbers, of no more than 12 squares in all",
        ));
    }
    let size = [rows as usize, columns as usize];
    let Some(layout) = &texture.gridlayout else {
        return Ok((size, Vec::new()));
    };
    if layout.chars().count() != size[0] * size[1] {
        return Err(invalid(
            "gridlayout must have a letter for each square of gridsize, row by row",
        ));
    }
    let face = |letter: char| match letter {
        '.' => Ok(None),
        _ => match "RLUDFB".find(letter) {
            Some(face) => Ok(Some(face)),
            None => Err(invalid("gridlayout may have the letters R, L, U, D, F and B, and dots")),
        },
    };
    Ok((size, layout.chars().map(face).collect::<Result<_, _>>()?))
}

/// Returns the name of a texture; one without a name is named after its file, without directory and extension.
fn texture_name(context: &Context, texture: &surface::Texture) -> Result<String, LoadError> {
    if !texture.name.is_empty() {
        return Ok(texture.name.clone());
    }
    let file = texture.file.as_deref();
    let stem = file.map(|file| file.rsplit('/').next().unwrap_or(file));
    let name = stem.map(|stem| stem.rsplit_once('.').map_or(stem, |(name, _)| name));
    match name.unwrap_or_default() {
        // nothing refers to a skybox, so it needs no name
        "" if texture.kind != TextureType::Skybox => {
            Err(context.error(texture.at, ErrorKind::MissingAttribute("name")))
        }
        name => Ok(name.to_owned()),
    }
}

/// Compiles a material, which may refer to a texture.
pub(super) fn compile_material(
    context: &Context,
    material: &surface::Material,
    ids: &Ids,
) -> Result<model::Material, LoadError> {
    let find = |name: &String| ids.texture.find(context.tree, material.at, "texture", name);
    if material.two_ways {
        return Err(context.invalid(material.at, "give the attribute texture or layers, not both"));
    }
    // textures of layers that are not drawn must exist, too
    for layer in &material.layers {
        ids.texture.find(context.tree, layer.at, "texture", &layer.texture)?;
    }
    Ok(model::Material {
        name: material.name.clone(),
        texture: material.texture.as_ref().map(find).transpose()?,
        rgba: material.rgba.map(single),
        specular: single(material.specular),
        shininess: single(material.shininess),
        reflectance: single(material.reflectance),
        emission: single(material.emission),
        texrepeat: material.texrepeat.map(single),
        texuniform: material.texuniform,
    })
}
