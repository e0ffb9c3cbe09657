//! Pictures drawn by wgpu against MuJoCo 3.3.0's own renderer (OSMesa), many in one submission. Skipped, loudly, where there is
//! no adapter, unless `BABYBENCH_GPU=required`.

use std::path::{Path, PathBuf};

use babybench::config::Scene;
use babybench::mimo::{build_model, embedded};
use babybench::mjcf_loader::load_str;
use babybench::model::{CameraId, Model};
use babybench::npz::Npz;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, set_const};
use babybench::render::gpu::{GpuRenderer, Rgb};
use babybench::render::{Poses, Shot, View, Visual};
use conformance::measure::only_print;
use conformance::pictures::{Difference, config, pictures};
use conformance::skipped;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

/// A renderer, and an engine to place the scene; nothing where there is no adapter.
fn open(model: Model) -> Option<(GpuRenderer, SoftEngine)> {
    let visual = Visual::new(&model, &embedded()).expect("the textures load");
    match GpuRenderer::new(visual.into()) {
        Ok(gpu) => {
            println!("{}", gpu.adapter());
            Some((gpu, SoftEngine::new(model.into(), SoftOptions::default())))
        }
        Err(e) => {
            let required = std::env::var("BABYBENCH_GPU").is_ok_and(|v| v == "required");
            assert!(!required, "BABYBENCH_GPU=required, but {e}");
            skipped("pictures by wgpu", e);
            None
        }
    }
}

/// Whether the device computes as the reference did: Mesa's llvmpipe, and not through OpenGL, where wgpu leaves the edges of
/// cube maps unblended.
fn like_the_reference(gpu: &GpuRenderer) -> bool {
    gpu.adapter().contains("llvmpipe") && gpu.adapter().contains("Vulkan")
}

fn state(engine: &mut SoftEngine, qpos: &[f64]) -> State {
    let mut state = engine.new_state();
    state.qpos.copy_from_slice(qpos);
    engine.forward(&mut state).expect("positions are finite");
    state
}

fn shot(state: &State, camera: CameraId, [width, height]: [usize; 2]) -> Shot<'_> {
    Shot {
        poses: Poses::from(state),
        view: View { camera, width, height },
    }
}

/// How far each picture of a submission is from what it should be.
fn differences(gpu: &mut GpuRenderer, shots: &[Shot], theirs: &[Vec<u8>]) -> Vec<Difference> {
    let ours = gpu.draw::<Rgb>(shots).expect("the device draws");
    let compare = |((ours, theirs), shot): ((&[u8], &Vec<u8>), &Shot)| {
        let mut difference = Difference::default();
        difference.add(ours, theirs, shot.view.width);
        difference
    };
    assert_eq!((ours.len(), theirs.len()), (shots.len(), shots.len()));
    ours.iter().zip(theirs).zip(shots).map(compare).collect()
}

fn total(parts: &[Difference]) -> Difference {
    let mut all = Difference::default();
    parts.iter().for_each(|d| all.merge(d));
    all
}

#[test]
fn eyes_and_room_cameras_show_what_mujoco_draws() {
    for &scene in Scene::ALL {
        let config = config(scene);
        let npz = Npz::open(data(&format!("render_{scene}.npz"))).expect("committed data");
        let model = build_model(&config, &embedded()).expect("the scene compiles");
        let Some((mut gpu, mut engine)) = open(model) else {
            return;
        };
        let qpos = npz.get_f64("qpos").expect("committed data").data;
        let nq = engine.model().nq;
        let states: Vec<_> = qpos.chunks_exact(nq).map(|q| state(&mut engine, q)).collect();
        let model = engine.model();

        let (size, theirs) = pictures(&npz, "eyes");
        let eyes = ["eye_left", "eye_right"].map(|name| model.camera(name).expect("MIMo has eyes"));
        let shots: Vec<_> = states.iter().flat_map(|s| eyes.map(|eye| shot(s, eye, size))).collect();
        for apart in [true, false] {
            gpu.draw_apart(apart);
            let all = total(&differences(&mut gpu, &shots, &theirs));
            let passes = if apart { "apart" } else { "in one pass" };
            println!("{scene:6} eyes of {} states, {passes}: {all}", states.len());
            if only_print() {
                continue;
            }
            // when written, lavapipe: mean 0.020, 0.015, 0.038 of 255, max 2; in one pass single samples at silhouettes differ
            assert!(all.least_ssim() >= 0.999, "{all}");
            if apart && like_the_reference(&gpu) {
                assert!(all.mean() <= 0.05 && all.max <= 3, "{all}");
            } else {
                assert!(all.mean() <= 0.1 && all.off()[1] <= 0.1, "{all}");
            }
        }

        gpu.draw_apart(true);
        let (size, theirs) = pictures(&npz, "views");
        let index = |name: &str| npz.get_f64(name).expect("committed data").data;
        let (of_state, of_camera) = (index("view_state"), index("view_camera"));
        let which = of_state.iter().zip(&of_camera);
        let shots: Vec<_> = which
            .map(|(&s, &c)| shot(&states[s as usize], CameraId(c as usize), size))
            .collect();
        for (one, shot) in differences(&mut gpu, &shots, &theirs).iter().zip(&shots) {
            println!("{scene:6} {:10} {one}", model.cam_name[shot.view.camera.0]);
            let fine = one.mean() <= 0.1 && one.off()[0] <= 0.2 && one.least_ssim() >= 0.999;
            assert!(only_print() || fine, "{one}");
        }
    }
}

/// What BabyBench's scenes do not have: transparent geoms, a plane seen from below.
#[test]
fn transparent_geoms_are_what_mujoco_draws() {
    let xml = std::fs::read_to_string(data("glass.xml")).expect("committed data");
    let mut model = load_str(&xml, "glass.xml", &embedded()).expect("the scene compiles");
    set_const(&mut model);
    let Some((mut gpu, mut engine)) = open(model) else {
        return;
    };
    let state = state(&mut engine, &[]);
    let npz = Npz::open(data("render_glass.npz")).expect("committed data");
    let (size, theirs) = pictures(&npz, "views");
    let shots: Vec<_> = (0..theirs.len()).map(|k| shot(&state, CameraId(k), size)).collect();
    for apart in [true, false] {
        gpu.draw_apart(apart);
        for (one, shot) in differences(&mut gpu, &shots, &theirs).iter().zip(&shots) {
            println!("{:10} {one}", engine.model().cam_name[shot.view.camera.0]);
            let fine = one.mean() <= 0.4 && one.off()[0] <= 0.2 && one.least_ssim() >= 0.999;
            assert!(only_print() || fine, "{one}");
        }
    }
}
