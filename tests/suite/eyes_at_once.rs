//! Two threads draw both eyes at once: the same bytes, the same errors, nothing left behind.

use babybench::config::{Scene, VisionOutput, VisionOutputs};
use babybench::render::{RenderError, Renderer};
use babybench::sensors::EyeImages;
use babybench::{Blueprint, Config, Env, EnvError, VectorEnv, VectorOptions};

use crate::common::{infant, seen};

/// Threads there are with `vision_threads: 2`.
fn two() -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    if cfg!(feature = "parallel") { cores.min(2) } else { 1 }
}

fn every_output(scene: Scene) -> Config {
    Config {
        vision_outputs: VisionOutputs::new(VisionOutput::ALL.iter().copied()),
        ..seen(scene)
    }
}

fn with_threads(config: &Config, vision_threads: u32) -> Env {
    let config = Config {
        vision_threads,
        ..config.clone()
    };
    Env::new(config).expect("embedded assets")
}

fn step(env: &mut Env) {
    let mut action = Vec::new();
    env.sample_action(&mut action);
    env.step(&action).expect("no divergence");
}

#[test]
fn two_threads_draw_the_same_bytes_as_one() {
    let scenes = Scene::BABYBENCH.iter().map(|scene| every_output(scene.clone()));
    for config in scenes.chain([infant()]) {
        let [mut one, mut other] = [1, 2].map(|threads| with_threads(&config, threads));
        assert_eq!(
            (one.senses().vision_threads(), other.senses().vision_threads()),
            (1, two())
        );
        for env in [&mut one, &mut other] {
            env.reset(Some(3)).expect("no divergence");
        }
        for k in 0..10 {
            assert!(one.observation() == other.observation(), "{}: step {k}", config.scene);
            step(&mut one);
            step(&mut other);
            if k == 4 {
                other.senses_mut().set_vision_threads(1); // the thread ends, and another begins
                other.senses_mut().set_vision_threads(2);
            }
        }
    }
}

#[test]
fn both_eyes_cost_one_pass_each() {
    let mut env = with_threads(&seen(Scene::Cubes), 2);
    env.reset(Some(0)).expect("no divergence");
    let passes = |env: &Env| env.senses().vision().expect("it sees").renderer().passes();
    let before = passes(&env);
    step(&mut env);
    assert_eq!(passes(&env) - before, 2);
}

#[test]
fn what_one_eye_cannot_draw_is_an_error_and_the_next_images_are_right() {
    let mut env = with_threads(&seen(Scene::Base), 2);
    env.reset(Some(0)).expect("no divergence");
    let pixels = 64 * 64;
    let mut expected = [vec![0; pixels], vec![0; pixels]];
    env.senses_mut()
        .eye_gray(expected.each_mut().map(|v| &mut v[..]))
        .expect("both fit");
    for lengths in [[pixels, 3], [3, pixels], [3, 5]] {
        let mut eyes = lengths.map(|n| vec![0; n]);
        let wrong = env.senses_mut().eye_gray(eyes.each_mut().map(|v| &mut v[..]));
        let found = lengths.into_iter().find(|&n| n != pixels).expect("one is wrong");
        let error = RenderError::Buffer {
            found,
            expected: pixels,
        };
        assert!(matches!(&wrong, Err(EnvError::Render(e)) if *e == error), "{wrong:?}");
        let mut eyes = [vec![0; pixels], vec![0; pixels]];
        env.senses_mut()
            .eye_gray(eyes.each_mut().map(|v| &mut v[..]))
            .expect("both fit");
        assert!(eyes == expected);
    }
}

#[test]
fn any_number_of_images_is_drawn_two_by_two() {
    let env = with_threads(&every_output(Scene::Cubes), 1);
    let view = |vision: &babybench::sensors::Vision| vision.requests(env.state());
    let [left, right] = view(env.senses().vision().expect("it sees"));
    let draw = |threads, count: usize| {
        let mut renderer = Renderer::cpu(env.blueprint().scenery().expect("embedded"));
        renderer.set_threads(threads);
        let requests: Vec<_> = [left, right].into_iter().cycle().take(count).collect();
        let images = || EyeImages::new(env.config().vision_outputs, 64 * 64);
        let mut eyes: Vec<_> = (0..count).map(|_| images()).collect();
        let drawn = renderer.draw(&requests, eyes.iter_mut().map(EyeImages::buffers));
        drawn.expect("all fit");
        eyes
    };
    for count in 0..6 {
        assert!(draw(1, count) == draw(2, count), "{count} images");
    }
    let mut renderer = Renderer::cpu(env.blueprint().scenery().expect("embedded"));
    for (asked, given) in [(0, 1), (1, 1), (2, two()), (usize::MAX, two())] {
        renderer.set_threads(asked);
        assert_eq!(renderer.threads(), given, "{asked}");
    }
}

#[test]
fn growing_keeps_the_thread_and_a_vector_has_its_own() {
    let config = Config {
        age: Some(9.0),
        vision_threads: 2,
        ..seen(Scene::Base)
    };
    let blueprint = Blueprint::new(config).expect("embedded assets");
    let mut env = blueprint.env().expect("embedded assets");
    env.senses_mut().set_vision_threads(1);
    env.mimo_mut().set_age(Some(3.0)).expect("any age");
    assert_eq!(env.senses().vision_threads(), 1);
    env.senses_mut().set_vision_threads(2);
    env.mimo_mut().set_age(Some(5.0)).expect("any age");
    assert_eq!(env.senses().vision_threads(), two());
    let mut envs = VectorEnv::new(&blueprint, 2, VectorOptions::default()).expect("memory and threads");
    assert_eq!(envs.env(0).expect("it is here").senses().vision_threads(), 1);
    envs.set_age(1, Some(3.0)).expect("any age");
    assert_eq!(envs.env(1).expect("it is here").senses().vision_threads(), 1);
}
