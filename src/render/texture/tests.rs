use super::*;

/// A pattern with a side of `width` pixels.
fn pattern(kind: TextureType, width: usize) -> Recipe {
    let text = format!(
        "<mujoco><asset><texture name='t' type='2d' builtin='flat' width='{width}' height='{width}'/></asset></mujoco>"
    );
    let spec = mjcf_sim_loader::load_str(&text, "t.xml", &crate::assets::MemoryAssets::new());
    let recipe = spec.expect("it is valid").into_parts().0.textures.remove(0);
    Recipe { kind, ..recipe }
}

#[test]
fn parts_and_mirrored_images_are_those_of_the_image() {
    let level = || MipLevel::from_fn(3, 2, |row, column| [row as u8, column as u8, 0]);
    let at = |level: &MipLevel| level.pixels.iter().map(|p| 10 * p[0] + p[1]).collect::<Vec<u8>>();
    assert_eq!(at(&level()), [0, 1, 2, 10, 11, 12]);
    assert_eq!(at(&level().part(0, 1, 2)), [1, 2, 11, 12]);
    let mut flipped = level();
    flipped.flip([true, false]);
    assert_eq!(at(&flipped), [2, 1, 0, 12, 11, 10]);
    flipped.flip([true, true]);
    assert_eq!(at(&flipped), [10, 11, 12, 0, 1, 2]);
}

#[test]
fn a_grid_deals_its_squares_to_the_faces_of_a_cube() {
    // columns of 2 pixels, red by number
    let image = image::RgbImage::from_fn(8, 6, |x, y| image::Rgb([(x / 2) as u8, (y / 2) as u8, 7]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("a picture");
    let mut assets = crate::assets::MemoryAssets::new();
    assets.insert("a.png", bytes.into_inner()).expect("a path");
    let cube = |grid: &str| {
        let text = format!("<mujoco><asset><texture file='a.png' rgb1='1 0 0' {grid}/></asset></mujoco>");
        let spec = mjcf_sim_loader::load_str(&text, "t.xml", &assets).map_err(|e| e.to_string())?;
        let recipe = spec.into_parts().0.textures.remove(0);
        match TextureLoader::new(&assets).texture(&recipe) {
            Ok(TexturePixels::Cube(cube)) => Ok(cube
                .faces
                .map(|face| (face[0].width, [0, 1, 2].map(|c| face[0].pixels[0][c])))),
            Ok(_) => Err("not a cube".to_string()),
            Err(e) => Err(e.to_string()),
        }
    };
    let faces = cube("gridsize='3 4' gridlayout='.U..LFRB.D..'").expect("squares");
    let expected = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]];
    assert_eq!(faces, expected.map(|[column, row]| (2, [column, row, 7])));
    let plain = cube("gridsize='3 4' gridlayout='.U..........'").expect("squares");
    assert_eq!(plain[0], (2, [255, 0, 0]));
    // found when the document is loaded
    for grid in ["gridsize='2 4' gridlayout='RLUDFB..'", ""] {
        let error = cube(grid).expect_err("no squares");
        assert!(error.contains("squares of one size"), "{error}");
    }
}

/// Four channels only affect blended drawables, which are refused.
#[test]
fn four_channels_look_like_three() {
    let picture = |opacity: u8| {
        let image = image::RgbaImage::from_fn(4, 4, |x, y| image::Rgba([40 * x as u8, 50 * y as u8, 7, opacity]));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("a picture");
        bytes.into_inner()
    };
    let mut assets = crate::assets::MemoryAssets::new();
    assets.insert("clear.png", picture(100)).expect("a path");
    assets.insert("full.png", picture(255)).expect("a path");
    let recipe = |texture: &str, channels: usize| {
        let text = format!("<mujoco><asset><texture name='t' {texture} nchannel='{channels}'/></asset></mujoco>");
        let spec = mjcf_sim_loader::load_str(&text, "t.xml", &assets);
        spec.map(|spec| spec.into_parts().0.textures.remove(0))
            .map_err(|e| e.to_string())
    };
    for texture in [
        "type='2d' file='clear.png'",
        "type='2d' file='full.png'",
        "builtin='gradient' width='8' mark='random'",
        "type='skybox' builtin='flat' width='8'",
    ] {
        let (four, three) = (recipe(texture, 4).expect(texture), recipe(texture, 3).expect(texture));
        assert_eq!((four.channels, three.channels), (4, 3));
        let mut loader = TextureLoader::new(&assets);
        assert_eq!(
            loader.texture(&four).expect(texture),
            loader.texture(&three).expect(texture),
            "{texture}"
        );
        assert!(loader.blended(&three).is_ok(), "{texture}");
        let error = loader.blended(&four).err().map(|e| e.to_string()).unwrap_or_default();
        assert_eq!(
            error.contains("clear.png") && error.contains("has opacities"),
            texture.contains("clear"),
            "{error}"
        );
    }
    for (texture, channels, expected) in [
        (
            "type='2d' file='full.png'",
            1,
            "leave nchannel out, with which grey images are drawn grey",
        ),
        ("type='2d' file='full.png'", 2, "three channels, or four"),
        (
            "type='2d' builtin='flat' width='4' height='4'",
            5,
            "three channels, or four",
        ),
        (
            "type='2d' builtin='flat' width='4' height='4'",
            4,
            "scrambles a flat pattern",
        ),
        ("file='full.png'", 4, "scrambles images of four channels on a cube"),
        (
            "type='skybox' fileup='full.png'",
            4,
            "scrambles images of four channels on a cube",
        ),
    ] {
        let error = recipe(texture, channels).expect_err(texture);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn all_textures_together_have_a_limit() {
    let none = crate::assets::MemoryAssets::new();
    let mut loader = TextureLoader::new(&none);
    let before = loader.left;
    let small = loader.texture(&pattern(TextureType::Flat2d, 16));
    assert!(small.is_ok());
    let small = loader.texture(&pattern(TextureType::Cube, 16));
    assert!(small.is_ok());
    assert_eq!(loader.left, before - 7 * 256);
    let large = loader.texture(&pattern(TextureType::Cube, 8192));
    let error = large.expect_err("400 million pixels").to_string();
    assert_eq!(
        error,
        "texture \"t\": with it the textures have more than 268435456 pixels; make them smaller, or fewer"
    );
    // what is left is there for smaller ones
    assert!(loader.texture(&pattern(TextureType::Flat2d, 16)).is_ok());
}
