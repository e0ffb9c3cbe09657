//! The renderer: the same bytes every time, no allocation after warm-up, errors for what cannot be drawn.

mod refused;

use std::sync::Arc;

use babybench::assets::{AssetSource, MemoryAssets};
use babybench::config::{Config, Scene, VisionOutput, VisionOutputs};
use babybench::env::Viewer;
use babybench::mimo::{build_model, embedded};
use babybench::render::{CpuRenderer, FreeCamera, Poses, RenderError, Scenery, View};
use babybench::sensors::EyeImages;
use babybench::spaces::Dtype;
use babybench::{Blueprint, Env, EnvError, Model};

use crate::allocations;
use crate::common::seen;

fn env(scene: Scene) -> Env {
    let mut env = Env::new(seen(scene)).expect("embedded assets");
    env.reset(Some(0)).expect("no divergence");
    env
}

fn hash(bytes: &[u8]) -> u64 {
    let mix = |h: u64, b: &u8| (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}

#[test]
fn eyes_are_part_of_the_observation() {
    let mut e = env(Scene::Cubes);
    let keys: Vec<_> = e.observation_space().iter().map(|s| (s.key, s.shape.clone())).collect();
    let place = |key: &str| keys.iter().position(|k| k.0 == key).expect("in the space");
    assert!(place("observation") < place("eye_left") && place("eye_right") == place("eye_left") + 1);
    assert!(place("eye_right") < place("vestibular"));
    assert_eq!(keys[place("eye_left")].1, [64, 64, 3]);
    let action = vec![0.0; e.action_space().len()];
    let step = e.step(&action).expect("no divergence");
    let (left, right) = (step.observation.eye_left.unwrap(), step.observation.eye_right.unwrap());
    assert_eq!((left.len(), right.len()), (64 * 64 * 3, 64 * 64 * 3));
    assert_ne!(left, right);
    // what the observation shows is what the camera sees
    let left = left.to_vec();
    let mut viewer = Viewer::new(e.blueprint()).unwrap();
    assert_eq!(viewer.draw(&e, "eye_left", 64, 64).unwrap(), left);
    let mut blind = Env::new(Config {
        vision_active: false,
        ..seen(Scene::Base)
    })
    .unwrap();
    assert!(blind.reset(None).unwrap().eye_left.is_none());
    let mut viewer = Viewer::new(blind.blueprint()).unwrap();
    assert_eq!(viewer.render(&blind).unwrap().len(), 480 * 480 * 3);
    assert!(viewer.draw(&blind, "nowhere", 8, 8).is_err());
    assert!(viewer.draw(&blind, "top", 0, 8).is_err());
}

#[test]
fn a_picture_is_the_same_every_time_and_from_every_renderer() {
    let e = env(Scene::Cubes);
    let mut viewer = Viewer::new(e.blueprint()).unwrap();
    let first = viewer.draw(&e, "corner", 101, 67).unwrap().to_vec();
    let _ = viewer.draw(&e, "eye_right", 64, 64).unwrap();
    assert_eq!(viewer.draw(&e, "corner", 101, 67).unwrap(), first);
    println!("corner 101 x 67 of cubes: {:016x}", hash(&first));
    let other = env(Scene::Cubes);
    let mut viewer = Viewer::new(other.blueprint()).unwrap();
    assert_eq!(viewer.draw(&other, "corner", 101, 67).unwrap(), first);
}

#[test]
fn a_free_camera_at_the_place_of_another_draws_the_same_picture() {
    let e = env(Scene::Crib);
    let mut viewer = Viewer::new(e.blueprint()).unwrap();
    let closeup = viewer.draw(&e, "closeup", 96, 64).unwrap().to_vec();
    // closeup has the free camera's field of view; where it is and what it looks at
    let id = e.model().camera("closeup").unwrap();
    let (pos, mat) = (e.state().cam_xpos[id], e.state().cam_xmat[id]);
    let forward = [2, 5, 8].map(|k| -mat[k]);
    let camera = FreeCamera {
        lookat: [0, 1, 2].map(|k| pos[k] + forward[k]),
        distance: 1.0,
        azimuth: forward[1].atan2(forward[0]).to_degrees(),
        elevation: forward[2].asin().to_degrees(),
    };
    let free = viewer.draw(&e, camera, 96, 64).unwrap().to_vec();
    let apart: f64 = free.iter().zip(&closeup).map(|(&a, &b)| f64::from(a.abs_diff(b))).sum();
    let mean = apart / free.len() as f64;
    println!("mean difference {mean}");
    assert!(mean < 0.05, "{mean}");
    let rgba = viewer.draw_rgba(&e, camera, 96, 64).unwrap();
    let colours: Vec<u8> = rgba.chunks(4).flat_map(|p| p[..3].to_vec()).collect();
    assert!(colours == free && rgba.chunks(4).all(|p| p[3] == 255));
    let nowhere = FreeCamera {
        distance: f64::NAN,
        ..camera
    };
    assert!(viewer.draw(&e, nowhere, 8, 8).is_err());
}

#[test]
fn a_halved_picture_has_the_pixels_of_the_whole() {
    let e = env(Scene::Cubes);
    let scenery = e.blueprint().scenery().unwrap();
    let poses = Poses::from(e.state());
    let mut renderer = CpuRenderer::new();
    for (camera, width, height) in [("corner", 64, 48), ("top", 33, 21)] {
        let camera = e.model().camera(camera).unwrap();
        let view = View { camera, width, height };
        let (w, h) = (width.div_ceil(2), height.div_ceil(2));
        let (mut whole, mut half) = (vec![0; view.rgb_len()], vec![0; 3 * w * h]);
        renderer.rgb(&scenery, &poses, &view, &mut whole).unwrap();
        renderer.rgb_halved(&scenery, &poses, &view, &mut half).unwrap();
        for i in 0..w * h {
            let at = 2 * (i / w) * width + 2 * (i % w);
            assert_eq!(half[3 * i..3 * i + 3], whole[3 * at..3 * at + 3]);
        }
        assert!(renderer.rgb_halved(&scenery, &poses, &view, &mut whole).is_err());
    }
}

#[test]
fn drawing_allocates_nothing_after_warm_up() {
    let mut e = env(Scene::Cubes);
    let blueprint = e.blueprint().clone();
    let scenery = blueprint.scenery().unwrap();
    let mut renderer = CpuRenderer::new();
    let views = ["eye_left", "eye_right"].map(|name| View {
        camera: e.model().camera(name).unwrap(),
        width: 64,
        height: 64,
    });
    let mut out = vec![0; views[0].rgb_len()];
    let mut action = Vec::new();
    let mut late = 0;
    for k in 0..120 {
        e.sample_action(&mut action);
        e.step(&action).unwrap();
        let before = allocations::of_this_thread();
        for view in &views {
            renderer.rgb(&scenery, &Poses::from(e.state()), view, &mut out).unwrap();
        }
        late += if k < 60 {
            0
        } else {
            allocations::of_this_thread() - before
        };
    }
    // a vector may still grow when more comes into view than ever before
    assert!(late <= 4, "{late} allocations");
}

#[test]
fn depth_segmentation_and_gray_describe_the_same_picture() {
    let e = env(Scene::Cubes);
    let scenery = e.blueprint().scenery().unwrap();
    let camera = e.model().camera("top").unwrap();
    let view = View {
        camera,
        width: 60,
        height: 40,
    };
    let mut renderer = CpuRenderer::new();
    let poses = Poses::from(e.state());
    let (mut depth, mut ids) = (vec![0.0; view.pixels()], vec![0; view.pixels()]);
    renderer.depth(&scenery, &poses, &view, &mut depth).unwrap();
    renderer.segmentation(&scenery, &poses, &view, &mut ids).unwrap();
    let (mut rgb, mut gray) = (vec![0; view.rgb_len()], vec![0; view.pixels()]);
    renderer.gray(&scenery, &poses, &view, &mut rgb, &mut gray).unwrap();
    // the camera hangs 2 m above the floor and sees MIMo, the rug and the floor around it
    let rug = e.model().geom("rug").unwrap() as i32;
    let floor = e.model().geom("floor").unwrap() as i32;
    for (z, id) in depth.iter().zip(&ids) {
        match *id {
            id if id == rug => assert!((z - 2.0005).abs() < 1e-3, "{z}"),
            id if id == floor => assert!((z - 2.01).abs() < 1e-3, "{z}"),
            id => assert!(id >= 0 && *z < 2.0, "{id} {z}"),
        }
    }
    assert!(ids.contains(&rug) && ids.contains(&floor) && ids.iter().any(|&i| i != rug && i != floor));
    assert_eq!(
        rgb,
        Viewer::new(e.blueprint()).unwrap().draw(&e, "top", 60, 40).unwrap()
    );
    assert!(gray.iter().any(|&g| g != gray[0]));
}

#[test]
fn eyes_see_distances_geoms_and_grey() {
    let mut blind = Env::new(Config {
        touch_active: false,
        vision_active: false,
        ..Config::default()
    })
    .unwrap();
    assert!(matches!(
        blind.senses_mut().eye_gray([&mut [], &mut []]),
        Err(EnvError::NoVision)
    ));
    let mut e = Env::new(Config {
        vision_active: true,
        vision_resolution: 32,
        ..seen(Scene::Cubes)
    })
    .unwrap();
    e.reset(Some(0)).unwrap();
    let scenery = e.blueprint().scenery().unwrap();
    let mut gray = [vec![0; 32 * 32], vec![0; 32 * 32]];
    let mut depth = gray.clone().map(|v| vec![0.0; v.len()]);
    let mut geoms = gray.clone().map(|v| vec![0; v.len()]);
    e.senses_mut().eye_gray(gray.each_mut().map(|v| &mut v[..])).unwrap();
    e.senses_mut().eye_depth(depth.each_mut().map(|v| &mut v[..])).unwrap();
    e.senses_mut()
        .eye_segmentation(geoms.each_mut().map(|v| &mut v[..]))
        .unwrap();
    let mut renderer = CpuRenderer::new();
    for (k, eye) in babybench::sensors::EYES.iter().enumerate() {
        let view = View {
            camera: e.model().camera(eye).unwrap(),
            width: 32,
            height: 32,
        };
        let poses = Poses::from(e.state());
        let (mut rgb, mut expected) = (vec![0; view.rgb_len()], vec![0; view.pixels()]);
        renderer.gray(&scenery, &poses, &view, &mut rgb, &mut expected).unwrap();
        assert_eq!(gray[k], expected);
        let mut expected = vec![0.0; view.pixels()];
        renderer.depth(&scenery, &poses, &view, &mut expected).unwrap();
        assert_eq!(depth[k], expected);
        let mut expected = vec![0; view.pixels()];
        renderer.segmentation(&scenery, &poses, &view, &mut expected).unwrap();
        assert_eq!(geoms[k], expected);
        assert!(geoms[k].iter().any(|&g| g >= 0));
    }
    let wrong = e.senses_mut().eye_gray([&mut [0; 3], &mut [0; 3]]);
    assert!(
        matches!(wrong, Err(EnvError::Render(RenderError::Buffer { .. }))),
        "{wrong:?}"
    );
}

/// Images of one view in every kind, drawn one by one.
fn apart(renderer: &mut CpuRenderer, scenery: &Scenery, poses: &Poses, view: &View) -> EyeImages {
    let mut images = EyeImages::new(every_output(), view.pixels());
    renderer.rgb(scenery, poses, view, &mut images.rgb).unwrap();
    let mut rgb = vec![0; view.rgb_len()];
    renderer.gray(scenery, poses, view, &mut rgb, &mut images.gray).unwrap();
    renderer.depth(scenery, poses, view, &mut images.depth).unwrap();
    renderer
        .segmentation(scenery, poses, view, &mut images.segmentation)
        .unwrap();
    images
}

fn every_output() -> VisionOutputs {
    VisionOutputs::new(VisionOutput::ALL.iter().copied())
}

#[test]
fn images_of_one_pass_are_those_drawn_alone() {
    for scene in Scene::BABYBENCH {
        let e = env(scene.clone());
        let poses = Poses::from(e.state());
        let plain = e.blueprint().scenery().unwrap();
        let mut glass = (*plain).clone();
        for drawable in glass.drawables.iter_mut().step_by(3) {
            drawable.rgba[3] = 0.5;
        }
        let mut renderer = CpuRenderer::new();
        for (scenery, camera) in [&*plain, &glass]
            .into_iter()
            .flat_map(|v| (0..v.cameras.len()).map(move |c| (v, c)))
        {
            let view = View {
                camera,
                width: 60,
                height: 45,
            };
            let expected = apart(&mut renderer, scenery, &poses, &view);
            for outputs in 1..1 << VisionOutput::ALL.len() {
                let wanted = VisionOutput::ALL.iter().copied();
                let wanted = VisionOutputs::new(wanted.filter(|&o| outputs >> o as usize & 1 == 1));
                let mut images = EyeImages::new(wanted, view.pixels());
                let before = renderer.passes();
                renderer.draw(scenery, &poses, &view, images.buffers()).unwrap();
                assert_eq!(renderer.passes() - before, 1, "a second drawing");
                for output in wanted.iter() {
                    let same = match output {
                        VisionOutput::Rgb => images.rgb == expected.rgb,
                        VisionOutput::Gray => images.gray == expected.gray,
                        VisionOutput::Depth => images.depth == expected.depth,
                        VisionOutput::Segmentation => images.segmentation == expected.segmentation,
                    };
                    assert!(same, "{scene}, camera {camera}: {output} among {wanted:?}");
                }
            }
        }
    }
}

#[test]
fn the_observation_has_the_images_that_the_configuration_asks_for() {
    let mut e = Env::new(Config {
        vision_outputs: every_output(),
        vision_resolution: 24,
        ..seen(Scene::Cubes)
    })
    .unwrap();
    e.reset(Some(0)).unwrap();
    let passes = |e: &Env| e.senses().vision().unwrap().renderer().passes();
    let before = passes(&e);
    let action = vec![0.0; e.action_space().len()];
    e.step(&action).unwrap();
    assert_eq!(passes(&e) - before, 2, "one pass for each eye");
    let images = || EyeImages::new(every_output(), 24 * 24);
    let mut eyes = [images(), images()];
    e.senses_mut()
        .eye_buffers(eyes.each_mut().map(EyeImages::buffers))
        .unwrap();
    let o = e.observation();
    assert_eq!([o.eye_left, o.eye_right], eyes.each_ref().map(|i| Some(&i.rgb[..])));
    let eyes = eyes.each_ref();
    assert_eq!([o.eye_left_gray, o.eye_right_gray], eyes.map(|i| Some(&i.gray[..])));
    assert_eq!([o.eye_left_depth, o.eye_right_depth], eyes.map(|i| Some(&i.depth[..])));
    let geoms = [o.eye_left_segmentation, o.eye_right_segmentation];
    assert_eq!(geoms, eyes.map(|i| Some(&i.segmentation[..])));
    let spaces = e.observation_space();
    let space = |key: &str| {
        spaces
            .iter()
            .find(|s| s.key == key)
            .unwrap_or_else(|| panic!("no {key}"))
    };
    assert_eq!(space("eye_left").shape, [24, 24, 3]);
    assert_eq!(
        (space("eye_right_gray").dtype, &space("eye_right_gray").shape[..]),
        (Dtype::U8, &[24, 24][..])
    );
    assert_eq!(
        (space("eye_left_depth").dtype, space("eye_left_depth").low),
        (Dtype::F32, 0.0)
    );
    assert_eq!(
        (space("eye_left_segmentation").dtype, space("eye_left_segmentation").low),
        (Dtype::I32, -1.0)
    );
    let mut far = Env::new(Config {
        vision_outputs: VisionOutputs::new([VisionOutput::Depth]),
        ..seen(Scene::Base)
    })
    .unwrap();
    let o = far.reset(Some(0)).unwrap();
    assert!(o.eye_left.is_none() && o.eye_left_gray.is_none() && o.eye_right_segmentation.is_none());
    let depth = [o.eye_left_depth, o.eye_right_depth];
    assert_eq!(depth.map(|image| image.map(<[f32]>::len)), [Some(64 * 64); 2]);
    assert!(far.observation_space().iter().all(|s| s.key != "eye_left"));
}

#[test]
fn environments_of_a_blueprint_share_the_look() {
    let blueprint = Blueprint::new(seen(Scene::Base)).unwrap();
    let (a, b) = (blueprint.env().unwrap(), blueprint.env().unwrap());
    let look = |e: &Env| e.senses().vision().unwrap().scenery().clone();
    assert!(Arc::ptr_eq(&look(&a), &look(&b)));
    assert!(look(&a).texture_bytes() < 32 << 20);
}
