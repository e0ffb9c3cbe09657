//! Pictures that cannot be drawn, and images that cannot be read.

use super::*;

#[test]
fn wrong_requests_are_errors() {
    let e = env(Scene::Base);
    let scenery = e.blueprint().scenery().unwrap();
    let mut renderer = CpuRenderer::new();
    let poses = Poses::from(e.state());
    let view = |camera, width| View {
        camera,
        width,
        height: 8,
    };
    let mut out = [0; 8 * 8 * 3];
    let mut draw = |poses: &Poses, view: View, n: usize| renderer.rgb(&scenery, poses, &view, &mut out[..n]);
    assert_eq!(draw(&poses, view(0, 8), 192), Ok(()));
    assert!(matches!(
        draw(&poses, view(99, 8), 192),
        Err(RenderError::Camera { camera: 99, .. })
    ));
    assert!(matches!(
        draw(&poses, view(0, 0), 0),
        Err(RenderError::Size { width: 0, height: 8 })
    ));
    assert!(matches!(draw(&poses, view(0, 8), 191), Err(RenderError::Buffer { .. })));
    let short = Poses {
        geom_xpos: &poses.geom_xpos[1..],
        ..poses
    };
    assert!(matches!(
        draw(&short, view(0, 8), 192),
        Err(RenderError::Poses { what: "geoms", .. })
    ));
}

#[test]
fn poses_that_are_not_numbers_draw_nothing_and_do_not_panic() {
    let e = env(Scene::Base);
    let scenery = e.blueprint().scenery().unwrap();
    let mut renderer = CpuRenderer::new();
    let poses = Poses::from(e.state());
    let view = View {
        camera: 0,
        width: 8,
        height: 8,
    };
    let mut out = [0; 8 * 8 * 3];
    let mut draw = |poses: Poses| renderer.rgb(&scenery, &poses, &view, &mut out);
    let turned = vec![[f64::NAN; 9]; poses.geom_xpos.len()];
    let geom_xmat = &turned[..];
    assert_eq!(draw(Poses { geom_xmat, ..poses }), Ok(()));
    for bad in [f64::NAN, 1e300, f64::INFINITY] {
        let (geoms, eyes) = (
            vec![[bad; 3]; poses.geom_xpos.len()],
            vec![[bad; 3]; poses.cam_xpos.len()],
        );
        let (geom_xpos, cam_xpos) = (&geoms[..], &eyes[..]);
        assert_eq!(draw(Poses { geom_xpos, ..poses }), Ok(()));
        assert_eq!(draw(Poses { cam_xpos, ..poses }), Ok(()));
    }
}

/// The embedded assets with one file replaced.
fn with_file(path: &str, bytes: Vec<u8>) -> (Model, MemoryAssets) {
    let model = build_model(&seen(Scene::Base), &embedded()).unwrap();
    let mut assets = MemoryAssets::new();
    for texture in &model.textures {
        for file in texture.file.iter().chain(texture.cube_files.iter().flatten()) {
            assets
                .insert(file, embedded().read(file).unwrap().into_owned())
                .unwrap();
        }
    }
    assets.insert(path, bytes).unwrap();
    (model, assets)
}

fn png(width: u32, height: u32) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_fn(width, height, |x, y| image::Rgb([x as u8, y as u8, 7]));
    image.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

#[test]
fn broken_images_are_errors_that_name_them() {
    let rug = "tex/rug.png";
    let good = embedded().read(rug).unwrap().into_owned();
    let load = |bytes: Vec<u8>| {
        let (model, assets) = with_file(rug, bytes);
        Scenery::new(&model, &assets)
    };
    assert!(load(good.clone()).is_ok());
    assert!(load(png(300, 300)).is_ok(), "any square will do");
    assert!(matches!(load(png(30, 31)), Err(RenderError::Texture { .. })));
    for bytes in [vec![], b"not a png".to_vec(), good[..40].to_vec()] {
        let error = load(bytes).unwrap_err();
        assert!(
            matches!(&error, RenderError::Image { path, .. } if path == rug),
            "{error}"
        );
    }
    // a header that promises 2^31 pixels a side
    let mut huge = png(8, 8);
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    assert!(load(huge).is_err());
    // no byte, changed, makes it panic
    let mut state = 1u64;
    for _ in 0..300 {
        let mut bytes = good.clone();
        for _ in 0..3 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let at = (state >> 33) as usize % bytes.len();
            bytes[at] = (state >> 20) as u8;
        }
        if let Err(error) = load(bytes) {
            assert!(error.to_string().contains("rug"), "{error}");
        }
    }
}
