//! The renderer on a GPU: many pictures in one submission, each as if drawn alone; errors for what cannot be drawn.

use babybench::config::{Config, RendererKind, Scene};
use babybench::env::{Viewer, draw_eyes};
use babybench::render::gpu::{Depth, GpuError, GpuRenderer, Gray, Pending, Rgb, Segmentation, wgpu};
use babybench::render::{CpuRenderer, Poses, RenderError, RenderRequest, SharedGpu, View};
use babybench::{Blueprint, Env, VectorEnv, VectorOptions};
use testkit::adapters::measured;
use testkit::harness::{Need, Trial};
use testkit::{show, trials};

use crate::common::{infant, seen};

/// Images of both eyes.
fn eyes_of(env: &Env) -> [RenderRequest<'_>; 2] {
    env.senses().vision().unwrap().requests(env.state())
}

pub fn trials() -> Vec<Trial> {
    trials![needs GPU: eyes_of_many_environments_are_drawn_together, a_vector_draws_all_eyes_in_one_submission, images_of_infants_are_transformed, a_picture_does_not_depend_on_its_company, depth_segmentation_and_gray_are_those_of_the_cpu_renderer, several_submissions_may_be_pending, wrong_requests_are_errors, a_lost_device_is_an_error, environments_and_renderers_move_between_threads, renderers_of_several_threads_draw_what_each_draws_alone]
}

fn config(scene: Scene) -> Config {
    Config {
        renderer: RendererKind::Wgpu,
        ..seen(scene)
    }
}

/// An adapter for wgpu of which it is known what it draws.
const GPU: Need = Need::new("GPU", Some("BABYBENCH_GPU"), || {
    let blueprint = Blueprint::new(config(Scene::Base)).expect("embedded assets");
    let gpu = blueprint.gpu().map_err(|e| e.to_string())?;
    let adapter = gpu.lock().expect("no other thread").adapter().to_string();
    measured(&adapter).map(drop)
});

/// A blueprint and its renderer.
fn open(scene: Scene) -> (Blueprint, SharedGpu) {
    let blueprint = Blueprint::new(config(scene)).expect("embedded assets");
    let gpu = blueprint.gpu().expect("a renderer");
    show!("{}", gpu.lock().unwrap().adapter());
    (blueprint, gpu)
}

/// Environments that have done a few random steps.
fn environments(blueprint: &Blueprint, count: usize) -> Vec<Env> {
    let make = |seed: usize| {
        let mut env = blueprint.env().expect("an adapter");
        env.senses_mut().defer_vision(true);
        env.reset(Some(seed as u64)).expect("no divergence");
        let mut action = Vec::new();
        for _ in 0..5 + 3 * seed {
            env.sample_action(&mut action);
            env.step(&action).expect("no divergence");
        }
        env
    };
    (0..count).map(make).collect()
}

fn shot<'a>(env: &'a Env, camera: &str, width: usize, height: usize) -> RenderRequest<'a> {
    RenderRequest {
        poses: Poses::from(env.state()),
        view: View {
            camera: env.model().camera(camera).expect("in every scene"),
            width,
            height,
        },
    }
}

/// Mean absolute difference, and the share of values off by more than 4.
fn difference(a: &[u8], b: &[u8]) -> (f64, f64) {
    assert_eq!(a.len(), b.len());
    let d = a.iter().zip(b).map(|(x, y)| x.abs_diff(*y));
    let (sum, off) = d.fold((0.0, 0), |(s, n), d| (s + f64::from(d), n + usize::from(d > 4)));
    (sum / a.len() as f64, off as f64 / a.len() as f64)
}

/// Whether pictures of the same thing by the same device in different company are the same: to the byte where each has its
/// own pass, else but for single samples at silhouettes.
fn assert_same(gpu: &SharedGpu, a: &[u8], b: &[u8]) {
    if gpu.lock().unwrap().is_software() {
        assert!(a == b, "{:?}", difference(a, b));
    } else {
        let (mean, off) = difference(a, b);
        assert!(mean < 0.02 && off < 1e-3, "mean {mean}, off {off}");
    }
}

/// Whether pictures are those of the CPU renderer, but for rounding and samples at silhouettes. A picture of something else is
/// off by tens.
fn assert_alike(a: &[u8], b: &[u8]) {
    let (mean, off) = difference(a, b);
    assert!(mean < 0.3 && off < 0.01, "mean {mean}, off {off}");
}

fn cpu(env: &Env, s: &RenderRequest) -> Vec<u8> {
    let mut out = vec![0; s.view.rgb_len()];
    let scenery = env.blueprint().scenery().expect("textures");
    CpuRenderer::new()
        .rgb(&scenery, &s.poses, &s.view, &mut out)
        .expect("a fine shot");
    out
}

fn eyes_of_many_environments_are_drawn_together() {
    for scene in [Scene::Base, Scene::Cubes] {
        let (blueprint, gpu) = open(scene);
        let mut environments = environments(&blueprint, 6);
        assert!(environments[0].observation().eye_left.unwrap().iter().all(|&v| v == 0));
        draw_eyes(&mut environments).unwrap();
        for env in &mut environments {
            let together = env.observation().eye_right.unwrap().to_vec();
            let eyes = eyes_of(env);
            assert_alike(&together, &cpu(env, &eyes[1]));
            // what a step draws
            env.senses_mut().defer_vision(false);
            let (qpos, qvel) = (env.state().qpos.clone(), env.state().qvel.clone());
            env.by_hand().set_state(&qpos, &qvel).unwrap();
            let stepped = env.observation().eye_right.unwrap().to_vec();
            let again = gpu.lock().unwrap().draw::<Rgb>(&eyes_of(env)).unwrap();
            assert_same(&gpu, &stepped, again.get(1).unwrap());
            let mut viewer = Viewer::new(env.blueprint()).unwrap();
            let corner = viewer.draw(env, "corner", 96, 64).unwrap().to_vec();
            assert_alike(&corner, &cpu(env, &shot(env, "corner", 96, 64)));
        }
    }
}

fn a_vector_draws_all_eyes_in_one_submission() {
    const ENVS: usize = 5;
    let (blueprint, gpu) = open(Scene::Base);
    let submissions = || gpu.lock().unwrap().submissions();
    for threads in [1, 2] {
        let options = VectorOptions {
            threads,
            ..VectorOptions::default()
        };
        let mut envs = VectorEnv::new(&blueprint, ENVS, options).unwrap();
        let before = submissions();
        envs.reset(3).unwrap();
        assert_eq!(submissions() - before, 1);
        let mut actions = Vec::new();
        for _ in 0..2 {
            let before = submissions();
            envs.sample_actions(&mut actions).unwrap();
            envs.step(&actions).unwrap();
            assert_eq!(submissions() - before, 1);
        }
        let len = envs.single_action_space().len();
        envs.send(&actions[..2 * len], &[4, 1]).unwrap();
        let before = submissions();
        assert_eq!(envs.recv(2).unwrap().len(), 2);
        assert_eq!(submissions() - before, 1);
        envs.step(&actions).unwrap();
        for k in 0..ENVS {
            let env = envs.env(k).unwrap();
            let row = envs.batch().row(k).unwrap();
            let alone = gpu.lock().unwrap().draw::<Rgb>(&eyes_of(env)).unwrap();
            assert_same(&gpu, row.eye_left.unwrap(), alone.get(0).unwrap());
            assert_alike(row.eye_right.unwrap(), &cpu(env, &eyes_of(env)[1]));
        }
    }
}

fn images_of_infants_are_transformed() {
    let drawn = |renderer: RendererKind, steps: u64| {
        let mut env = Env::new(Config { renderer, ..infant() }).expect("a renderer");
        env.reset(Some(3)).expect("no divergence");
        for _ in 0..steps {
            env.step(&vec![0.5; env.action_space().len()]).expect("no divergence");
        }
        let seen = env.observation();
        [seen.eye_left, seen.eye_right].map(|eye| eye.expect("an eye").to_vec())
    };
    // images are as old, as blurred and as noisy as those of the other renderer
    for (gpu, cpu) in drawn(RendererKind::Wgpu, 9).iter().zip(drawn(RendererKind::Cpu, 9)) {
        assert_alike(gpu, &cpu);
    }
}

fn a_picture_does_not_depend_on_its_company() {
    let (blueprint, gpu) = open(Scene::Cubes);
    let environments = environments(&blueprint, 3);
    let sizes = [
        (64, 64),
        (33, 17),
        (1, 1),
        (640, 480),
        (64, 64),
        (7, 301),
        (128, 96),
        (2, 3),
    ];
    let cameras = ["eye_left", "eye_right", "corner", "closeup", "top"];
    let shots: Vec<_> = (0..40)
        .map(|k| shot(&environments[k % 3], cameras[k % 5], sizes[k % 8].0, sizes[k % 8].1))
        .collect();
    for apart in [true, false] {
        gpu.lock().unwrap().draw_apart(apart);
        let together = gpu.lock().unwrap().draw::<Rgb>(&shots).unwrap();
        assert_eq!(together.len(), shots.len());
        for (one, picture) in shots.iter().zip(together.iter()) {
            let alone = gpu.lock().unwrap().draw::<Rgb>(&[*one]).unwrap();
            if apart {
                assert_eq!(alone.as_slice(), picture);
            } else if one.view.pixels() > 1000 {
                let (mean, off) = difference(alone.as_slice(), picture);
                assert!(mean < 0.03 && off < 1e-3, "{:?}: mean {mean}, off {off}", one.view);
            }
        }
        assert_eq!(
            gpu.lock().unwrap().draw::<Rgb>(&shots).unwrap(),
            together,
            "the same every time"
        );
    }
    assert!(gpu.lock().unwrap().draw::<Rgb>(&[]).unwrap().is_empty());
}

fn depth_segmentation_and_gray_are_those_of_the_cpu_renderer() {
    let (blueprint, gpu) = open(Scene::Cubes);
    let environments = environments(&blueprint, 2);
    let scenery = blueprint.scenery().unwrap();
    let mut gpu = gpu.lock().unwrap();
    let mut renderer = CpuRenderer::new();
    for camera in ["top", "eye_left", "corner"] {
        let shots: Vec<_> = environments.iter().map(|e| shot(e, camera, 60, 44)).collect();
        let depth = gpu.draw::<Depth>(&shots).unwrap();
        let ids = gpu.draw::<Segmentation>(&shots).unwrap();
        let (gray, rgb) = (gpu.draw::<Gray>(&shots).unwrap(), gpu.draw::<Rgb>(&shots).unwrap());
        for (k, s) in shots.iter().enumerate() {
            let n = s.view.pixels();
            let (mut d, mut i) = (vec![0.0; n], vec![0; n]);
            renderer.depth(&scenery, &s.poses, &s.view, &mut d).unwrap();
            renderer.segmentation(&scenery, &s.poses, &s.view, &mut i).unwrap();
            let same = ids.get(k).unwrap().iter().zip(&i).filter(|(a, b)| a == b).count();
            assert!(same >= n - n / 100, "{camera}: {} pixels show other geoms", n - same);
            let ours = depth.get(k).unwrap();
            let near = |a: f32, b: f32| a == b || (a - b).abs() <= 1e-3 * b;
            let close = ours.iter().zip(&d).filter(|&(&a, &b)| near(a, b)).count();
            assert!(
                close >= n - n / 100,
                "{camera}: {} pixels at other distances",
                n - close
            );
            let brightness = |p: &[u8]| 0.2989 * f32::from(p[0]) + 0.587 * f32::from(p[1]) + 0.114 * f32::from(p[2]);
            let colours = rgb.get(k).unwrap().chunks_exact(3);
            assert!(
                colours
                    .zip(gray.get(k).unwrap())
                    .all(|(p, &g)| brightness(p) as u8 == g)
            );
        }
    }
}

fn several_submissions_may_be_pending() {
    let (blueprint, gpu) = open(Scene::Base);
    let environments = environments(&blueprint, 2);
    let mut gpu = gpu.lock().unwrap();
    let views = [("corner", 50), ("closeup", 90), ("corner", 50)];
    let shots = views.map(|(camera, size)| shot(&environments[0], camera, size, size));
    let [a, b, c] = shots.map(|s| gpu.begin::<Rgb>(&[s]).unwrap());
    let dropped = gpu.begin::<Rgb>(&shots).unwrap();
    let c = pollster::block_on(c.read()).unwrap();
    drop(dropped);
    let mut array = vec![0; 90 * 90 * 3];
    b.wait_into([&mut array[..]]).unwrap();
    assert_alike(&array, &cpu(&environments[0], &shots[1]));
    assert_eq!(a.wait().unwrap(), c);
    // memory of another length
    let again = gpu.begin::<Rgb>(&shots[..1]).unwrap();
    let error = again.wait_into([&mut array[..9]]).unwrap_err();
    assert!(
        matches!(
            error,
            RenderError::Buffer {
                found: 9,
                expected: 7500
            }
        ),
        "{error}"
    );
    assert!(gpu.begin::<Rgb>(&shots).unwrap().wait_into([]).is_err());
    assert_eq!(gpu.draw::<Rgb>(&shots[..1]).unwrap(), c);
}

fn wrong_requests_are_errors() {
    let (blueprint, gpu) = open(Scene::Base);
    let environments = environments(&blueprint, 1);
    let mut gpu = gpu.lock().unwrap();
    let good = shot(&environments[0], "corner", 64, 64);
    let view = |camera, width| RenderRequest {
        view: View {
            camera,
            width,
            height: 8,
        },
        ..good
    };
    let mut fails = |s: RenderRequest| gpu.draw::<Rgb>(&[good, s]).unwrap_err();
    assert!(matches!(fails(view(99, 8)), RenderError::Camera { camera: 99, .. }));
    assert!(matches!(fails(view(0, 0)), RenderError::Size { width: 0, height: 8 }));
    assert!(matches!(
        fails(view(0, 5000)),
        RenderError::Size { width: 5000, height: 8 }
    ));
    let mut short = good;
    short.poses.cam_xpos = &[];
    assert!(matches!(fails(short), RenderError::Poses { what: "cameras", .. }));
    // more than fits into one transfer
    let huge = RenderRequest {
        view: View {
            width: 4096,
            height: 4096,
            ..good.view
        },
        ..good
    };
    let error = gpu.begin::<Rgb>(&vec![huge; 100_000]).unwrap_err();
    assert!(matches!(error, RenderError::Gpu(GpuError::TooLarge { .. })), "{error}");
    // poses that are not numbers draw nothing, and do not panic
    let n = good.poses.geom_xpos.len();
    for bad in [f64::NAN, f64::INFINITY, 1e300, -1e30] {
        let (places, turns) = (vec![[bad; 3]; n], vec![[bad; 9]; n]);
        let eyes = vec![[bad; 3]; good.poses.cam_xpos.len()];
        let mut shots = [good; 3];
        shots[0].poses.geom_xpos = &places;
        shots[1].poses.geom_xmat = &turns;
        shots[2].poses.cam_xpos = &eyes;
        assert_eq!(gpu.draw::<Rgb>(&shots).unwrap().len(), 3);
        assert_eq!(gpu.draw::<Depth>(&shots).unwrap().len(), 3);
    }
    let picture = gpu.draw::<Rgb>(&[good]).unwrap();
    assert_alike(picture.as_slice(), &cpu(&environments[0], &good));
}

fn a_lost_device_is_an_error() {
    let (blueprint, _) = open(Scene::Base);
    let environments = environments(&blueprint, 1);
    let description = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    let instance = wgpu::Instance::new(description);
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::downlevel_webgl2_defaults(),
        ..Default::default()
    }))
    .unwrap();
    let mut gpu = GpuRenderer::with_device(device.clone(), queue, blueprint.scenery().unwrap()).unwrap();
    let shots = [shot(&environments[0], "corner", 40, 40)];
    let pending = gpu.begin::<Rgb>(&shots).unwrap();
    assert_alike(
        gpu.draw::<Rgb>(&shots).unwrap().as_slice(),
        &cpu(&environments[0], &shots[0]),
    );
    // NVIDIA's drivers wait for ever when a device is closed while another thread ends, as those of the other tests do
    std::mem::forget(device.clone());
    device.destroy();
    let lost = |e: RenderError| assert!(matches!(e, RenderError::Gpu(GpuError::Lost(_))), "{e}");
    if let Err(e) = pending.wait() {
        lost(e);
    }
    for _ in 0..2 {
        lost(gpu.draw::<Rgb>(&shots).unwrap_err());
    }
}

fn environments_and_renderers_move_between_threads() {
    fn sendable<T: Send>() {}
    sendable::<Env>();
    sendable::<GpuRenderer>();
    sendable::<Pending<Depth>>();
    let (blueprint, _) = open(Scene::Base);
    let draw = |env: Env| Viewer::new(env.blueprint())?.render(&env).map(<[u8]>::to_vec);
    let pictures: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = environments(&blueprint, 2)
            .into_iter()
            .map(|env| scope.spawn(move || draw(env)))
            .collect();
        threads.into_iter().map(|t| t.join().unwrap().unwrap()).collect()
    });
    assert!(pictures[0].iter().any(|&v| v > 0) && pictures[0] != pictures[1]);
}

/// They share a device, whose answers to one come up while another asks.
fn renderers_of_several_threads_draw_what_each_draws_alone() {
    let scenes = [Scene::Base, Scene::Crib, Scene::Cubes, Scene::Base];
    let drawn = |scene: &Scene| {
        let blueprint = Blueprint::new(config(scene.clone())).expect("embedded assets");
        let environments = environments(&blueprint, 2);
        let mut gpu = GpuRenderer::new(blueprint.scenery().expect("textures")).expect("a renderer");
        let shots: Vec<_> = environments.iter().flat_map(eyes_of).collect();
        let first = gpu.draw::<Rgb>(&shots).expect("pictures").into_vec();
        for _ in 0..20 {
            assert_eq!(gpu.draw::<Rgb>(&shots).expect("pictures").as_slice(), first);
        }
        first
    };
    let alone = scenes.each_ref().map(drawn);
    std::thread::scope(|scope| {
        let threads = scenes.each_ref().map(|scene| scope.spawn(|| drawn(scene)));
        for (thread, alone) in threads.into_iter().zip(&alone) {
            assert_eq!(&thread.join().expect("no error"), alone);
        }
    });
}
