//! Pictures drawn by wgpu against MuJoCo 3.3.0's own renderer (OSMesa, Mesa's llvmpipe), many in one submission. Bounds are those of the
//! adapter: a GPU filters textures and places samples in its own way, and so does MuJoCo's renderer on it.

use babybench::config::Scene;
use babybench::mimo::{build_model, embedded};
use babybench::mjcf_loader::load_str;
use babybench::model::Model;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};
use babybench::render::gpu::{GpuRenderer, Rgb};
use babybench::render::{Poses, RenderRequest, Scenery, View};
use conformance::data;
use conformance::measure::only_print;
use conformance::pictures::{Difference, config, pictures};
use testkit::adapters::{Adapter, measured};
use testkit::harness::{Need, Trial};
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs GPU: eyes_and_room_cameras_show_what_mujoco_draws, small_scenes_are_what_mujoco_draws]
}

/// An adapter for wgpu of which it is known what it draws.
const GPU: Need = Need::new("GPU", Some("BABYBENCH_GPU"), || {
    let gpu = GpuRenderer::new(small("glass").1.into()).map_err(|e| e.to_string())?;
    measured(gpu.adapter()).map(drop)
});

/// Returns a scene of what BabyBench's scenes do not have: transparent geoms and a plane seen from below, meshes, skins, or tendons.
fn small(name: &str) -> (Model, Scenery) {
    let model = load_str(&data::text(&format!("{name}.xml")), name, &embedded())
        .and_then(compile)
        .expect("the scene compiles");
    let scenery = Scenery::new(&model, &embedded()).expect("the textures load");
    (model, scenery)
}

/// A renderer, what its adapter is, and an engine to place the scene.
fn open(model: Model) -> (GpuRenderer, Adapter, SoftEngine) {
    let scenery = Scenery::new(&model, &embedded()).expect("the textures load");
    let gpu = GpuRenderer::new(scenery.into()).expect("a renderer");
    show!("{}", gpu.adapter());
    let adapter = measured(gpu.adapter()).expect("the need was met");
    (gpu, adapter, SoftEngine::new(model.into(), SoftOptions::default()))
}

fn state(engine: &mut SoftEngine, qpos: &[f64]) -> State {
    let mut state = engine.new_state();
    state.qpos.copy_from_slice(qpos);
    engine.forward(&mut state).expect("positions are finite");
    state
}

fn shot(state: &State, camera: usize, [width, height]: [usize; 2]) -> RenderRequest<'_> {
    RenderRequest {
        poses: Poses::from(state),
        view: View { camera, width, height },
    }
}

/// How far each picture of a submission is from what it should be.
fn differences(gpu: &mut GpuRenderer, shots: &[RenderRequest], theirs: &[Vec<u8>]) -> Vec<Difference> {
    let ours = gpu.draw::<Rgb>(shots).expect("the device draws");
    let compare = |((ours, theirs), shot): ((&[u8], &Vec<u8>), &RenderRequest)| {
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

fn eyes_and_room_cameras_show_what_mujoco_draws() {
    for scene in Scene::BABYBENCH {
        let config = config(scene.clone());
        let npz = data::npz(&format!("render_{scene}.npz"));
        let model = build_model(&config, &embedded()).expect("the scene compiles");
        let (mut gpu, adapter, mut engine) = open(model);
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
            show!("{scene:6} eyes of {} states, {passes}: {all}", states.len());
            if only_print() {
                continue;
            }
            // when written, lavapipe: mean 0.020, 0.015, 0.038 of 255, max 2; in one pass single samples at silhouettes differ;
            // H200: 0.070, 0.095, 0.135, where MuJoCo's own renderer is 0.169, 0.521, 0.436 from the reference
            let [mean, ssim] = match adapter {
                Adapter::Vulkan | Adapter::OpenGl => [0.1, 0.999],
                Adapter::Nvidia => [0.25, 0.995],
            };
            assert!(
                all.least_ssim() >= ssim && all.mean() <= mean && all.off()[1] <= 0.1,
                "{all}"
            );
            if apart && adapter == Adapter::Vulkan {
                assert!(all.mean() <= 0.05 && all.max <= 3, "{all}");
            }
        }

        gpu.draw_apart(true);
        let (size, theirs) = pictures(&npz, "views");
        let index = |name: &str| npz.get_f64(name).expect("committed data").data;
        let (of_state, of_camera) = (index("view_state"), index("view_camera"));
        let which = of_state.iter().zip(&of_camera);
        let shots: Vec<_> = which
            .map(|(&s, &c)| shot(&states[s as usize], c as usize, size))
            .collect();
        for (one, shot) in differences(&mut gpu, &shots, &theirs).iter().zip(&shots) {
            show!("{scene:6} {:10} {one}", model.cam_name[shot.view.camera]);
            let fine = one.mean() <= 0.1 && one.off()[0] <= 0.2 && one.least_ssim() >= 0.999;
            assert!(only_print() || fine, "{one}");
        }
    }
}

fn small_scenes_are_what_mujoco_draws() {
    for (name, mean) in [
        ("flexes", 0.05),
        ("glass", 0.4),
        ("lamps", 0.4),
        ("meshes", 0.05),
        ("skins", 0.05),
        ("strings", 0.05),
    ] {
        let (mut gpu, adapter, mut engine) = open(small(name).0);
        let qpos0 = engine.model().qpos0.clone();
        let state = state(&mut engine, &qpos0);
        let npz = data::npz(&format!("render_{name}.npz"));
        let (size, theirs) = pictures(&npz, "views");
        let shots: Vec<_> = (0..theirs.len()).map(|k| shot(&state, k, size)).collect();
        for apart in [true, false] {
            gpu.draw_apart(apart);
            let [mean, off] = match adapter {
                Adapter::Vulkan => [mean, 0.2],
                // up to 0.2135 % at the edges of cube maps, with Mesa 22.3 and 25.0
                Adapter::OpenGl => [mean, 0.5],
                // on H200 up to 0.37 and 5.4 % for what is transparent, 0.30 and 5.4 % for textures seen from near
                Adapter::Nvidia => [0.5, 8.0],
            };
            for (one, shot) in differences(&mut gpu, &shots, &theirs).iter().zip(&shots) {
                show!("{name} {:10} {one}", engine.model().cam_name[shot.view.camera]);
                let fine = one.mean() <= mean && one.off()[0] <= off && one.least_ssim() >= 0.999;
                assert!(only_print() || fine, "{one}");
            }
        }
    }
}
