//! Pictures of each eye's own width, height and field of view.

use babybench::config::{EyeOptions, Scene, VisionOutput, VisionOutputs};
use babybench::env::Viewer;
use babybench::{Blueprint, Config, Env, VectorEnv, VectorOptions};

use crate::common::seen;

/// Eyes that differ in everything.
fn uneven() -> Config {
    Config {
        vision_resolution: 16,
        eyes: EyeOptions {
            width: Some(24),
            height_right: Some(10),
            fovy_left: Some(30.0),
            fovy_right: Some(75.5),
            ..EyeOptions::default()
        },
        ..seen(Scene::Cubes)
    }
}

#[test]
fn each_eye_has_its_own_size_and_field_of_view() {
    let mut env = Env::new(uneven()).expect("embedded assets");
    env.reset(Some(4)).expect("no divergence");
    assert_eq!(env.config().eye_sizes(), [[24, 16], [24, 10]]);
    let model = env.model().clone();
    let fovy = |eye: &str| model.cam_fovy[model.camera(eye).expect("an eye")];
    assert_eq!([fovy("eye_left"), fovy("eye_right")], [30.0, 75.5]);
    let shape = |key: &str| {
        let spaces = env.observation_space();
        let found = spaces.into_iter().find(|space| space.key == key);
        found.map(|space| space.shape)
    };
    assert_eq!(shape("eye_left"), Some(vec![16, 24, 3]));
    assert_eq!(shape("eye_right"), Some(vec![10, 24, 3]));
    let mut viewer = Viewer::new(env.blueprint()).expect("a renderer");
    let own = viewer.eyes_rgba(&env).expect("pictures").len();
    assert_eq!(own, 4 * 24 * (16 + 10));
    for (key, height) in [("eye_left", 16), ("eye_right", 10)] {
        let drawn = viewer.draw(&env, key, 24, height).expect("a picture").to_vec();
        let observation = env.observation();
        let seen = if key == "eye_left" {
            observation.eye_left
        } else {
            observation.eye_right
        };
        assert_eq!(seen, Some(&drawn[..]), "{key}");
    }
}

#[test]
fn a_narrower_field_is_the_middle_of_a_wider_one() {
    let [mut wide, mut narrow] = [
        (60.0, 64),
        (2.0 * (0.5 * 30f64.to_radians().tan()).atan().to_degrees(), 32),
    ]
    .map(|(fovy, vision_resolution)| {
        let eyes = EyeOptions {
            fovy: Some(fovy),
            ..EyeOptions::default()
        };
        Env::new(Config {
            vision_resolution,
            eyes,
            vision_outputs: VisionOutputs::new([VisionOutput::Segmentation, VisionOutput::Depth]),
            ..seen(Scene::Cubes)
        })
        .expect("embedded assets")
    });
    for env in [&mut wide, &mut narrow] {
        env.reset(Some(1)).expect("no divergence");
    }
    let (all, part) = (wide.observation(), narrow.observation());
    let (all, part) = (all.eye_left_segmentation.unwrap(), part.eye_left_segmentation.unwrap());
    let middle = |k: usize| all[(16 + k / 32) * 64 + 16 + k % 32];
    let differing = (0..32 * 32).filter(|&k| middle(k) != part[k]).count();
    // at edges that pass through the centre of a pixel a rounding error decides
    assert!(differing <= 5, "{differing}");
    let mut kinds: Vec<i32> = part.to_vec();
    kinds.sort_unstable();
    kinds.dedup();
    assert!(kinds.len() > 2, "something is to be seen: {kinds:?}");
}

#[test]
fn uneven_eyes_are_blurred_held_delayed_saved_and_drawn_in_vectors() {
    let mut config = uneven();
    config.eyes.acuity = true;
    config.eyes.foveation = 5.0;
    config.noise.vision = 3.0;
    config.delays.vision = Some(2.0);
    config.vision_rate = Some(50.0);
    let blueprint = Blueprint::new(config).expect("embedded assets");
    let mut alone = blueprint.env().expect("an environment");
    let options = VectorOptions {
        threads: 2,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint, 2, options).expect("a vector");
    alone.reset(Some(6)).expect("no divergence");
    envs.reset(6).expect("no divergence");
    let len = alone.action_space().len();
    for step in 0..9 {
        let actions = vec![0.2 - 0.05 * step as f32; 2 * len];
        alone.step(&actions[..len]).expect("no divergence");
        let batch = envs.step(&actions).expect("no divergence");
        let (seen, of_all) = (alone.observation(), batch.observation);
        for (one, all) in [(seen.eye_left, of_all.eye_left), (seen.eye_right, of_all.eye_right)] {
            let (one, all) = (one.expect("an image"), all.expect("images"));
            assert!(all.starts_with(one) && all.len() == 2 * one.len(), "step {step}");
        }
        if step == 4 {
            let snapshot = alone.snapshot();
            let mut other = blueprint.env().expect("an environment");
            other.restore(&snapshot).expect("its own snapshot");
            alone = other;
        }
    }
    let mut other = Env::new(Config {
        vision_resolution: 16,
        ..seen(Scene::Cubes)
    })
    .expect("embedded assets");
    let refused = other.restore(&alone.snapshot()).expect_err("other eyes");
    assert!(refused.to_string().contains("vision_width"), "{refused}");
}
