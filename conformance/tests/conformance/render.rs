//! Pictures against MuJoCo 3.3.0's own renderer (OSMesa): of the embedded assets from `data/render_*.npz`, which
//! `scripts/render_goldens.py` writes and describes, of `data/flexes.xml`, `glass.xml`, `lamps.xml`, `meshes.xml`, `skins.xml` and `strings.xml`, and of the original
//! files from the recordings.

use babybench::assets::{AssetSource, DirAssets, MemoryAssets};
use babybench::config::{Config, Scene};
use babybench::env::BlueprintOptions;
use babybench::mimo::{build_model, embedded};
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State, compile};
use babybench::render::{CpuRenderer, Poses, Scenery, View};
use babybench::{Blueprint, Env};
use conformance::data;
use conformance::measure::only_print;
use conformance::pictures::{Difference, config, pictures};
use conformance::recordings::golden;
use testkit::harness::Trial;
use testkit::yardsticks::{KIT, kit_assets};
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    [
        trials![
            eyes_and_room_cameras_show_what_mujoco_draws,
            transparent_things_look_as_mujoco_draws_them,
            lit_planes_look_as_mujoco_draws_them,
            meshes_look_as_mujoco_draws_them,
            skins_look_as_mujoco_draws_them,
            flexes_look_as_mujoco_draws_them,
            tendons_look_as_mujoco_draws_them
        ],
        trials![needs KIT: recorded_eyes_with_the_original_files],
    ]
    .concat()
}

struct Stage {
    engine: SoftEngine,
    state: State,
    scenery: Scenery,
    renderer: CpuRenderer,
    picture: Vec<u8>,
}

impl Stage {
    fn new(config: &Config, assets: &dyn AssetSource) -> Self {
        let model = build_model(config, assets).expect("the scene compiles");
        let scenery = Scenery::new(&model, assets).expect("the textures load");
        let engine = SoftEngine::new(model.into(), SoftOptions::default());
        Self {
            state: engine.new_state(),
            engine,
            scenery,
            renderer: CpuRenderer::new(),
            picture: Vec::new(),
        }
    }

    fn at(&mut self, qpos: &[f64]) {
        self.state.qpos.copy_from_slice(qpos);
        self.state.qvel.fill(0.0);
        self.engine.forward(&mut self.state).expect("positions are finite");
    }

    fn draw(&mut self, camera: usize, size: usize) -> &[u8] {
        let view = View {
            camera,
            width: size,
            height: size,
        };
        self.picture.resize(view.rgb_len(), 0);
        self.renderer
            .rgb(&self.scenery, &Poses::from(&self.state), &view, &mut self.picture)
            .expect("the view is fine");
        &self.picture
    }
}

fn eyes_and_room_cameras_show_what_mujoco_draws() {
    for scene in Scene::BABYBENCH {
        let config = config(scene.clone());
        let npz = data::npz(&format!("render_{scene}.npz"));
        let mut stage = Stage::new(&config, &embedded());
        let qpos = npz.get_f64("qpos").expect("committed data");
        let nq = qpos.shape[1];
        let model = stage.engine.model().clone();
        let eyes = ["eye_left", "eye_right"].map(|name| model.camera(name).expect("MIMo has eyes"));

        let ([size, _], theirs) = pictures(&npz, "eyes");
        let mut difference = Difference::default();
        for (k, pair) in theirs.chunks_exact(2).enumerate() {
            stage.at(&qpos.data[k * nq..(k + 1) * nq]);
            for (camera, expect) in eyes.iter().zip(pair) {
                difference.add(stage.draw(*camera, size), expect, size);
            }
        }
        show!("{scene:6} eyes of {} states: {difference}", qpos.shape[0]);
        // when written: mean 0.021, 0.019, 0.042 of 255; max 2
        if !only_print() {
            assert!(difference.mean() <= 0.1 && difference.max <= 4, "{difference}");
            assert!(difference.least_ssim() >= 0.999, "{difference}");
        }

        let ([size, _], theirs) = pictures(&npz, "views");
        let states = npz.get_f64("view_state").expect("committed data").data;
        let cameras = npz.get_f64("view_camera").expect("committed data").data;
        for ((state, camera), expect) in states.iter().zip(&cameras).zip(&theirs) {
            let (state, camera) = (*state as usize, *camera as usize);
            stage.at(&qpos.data[state * nq..(state + 1) * nq]);
            let mut difference = Difference::default();
            difference.add(stage.draw(camera, size), expect, size);
            show!("{scene:6} {:10} {difference}", model.cam_name[camera]);
            // when written: mean up to 0.030, max 3, up to 0.0026 % of pixels off by more than 2
            if !only_print() {
                assert!(difference.mean() <= 0.1 && difference.off()[0] <= 0.02, "{difference}");
                assert!(difference.least_ssim() >= 0.999, "{difference}");
            }
        }
    }
}

/// Things one sees through, planes from behind, marks on textures.
fn transparent_things_look_as_mujoco_draws_them() {
    // when written: mean 0.32 below the floor, where most is blended, otherwise up to 0.09; a pixel off by more than 2
    small_scene("glass", 0.4, 0.02);
}

/// Planes under lamps, a spotlight and highlights: with fine and coarse grids, without an end, transparent, from behind.
fn lit_planes_look_as_mujoco_draws_them() {
    // when written: mean 0.32 below the floor, where most is blended, otherwise up to 0.043; 11 pixels off by more than 2
    small_scene("lamps", 0.4, 0.1);
}

/// Meshes with flat images and cubes on them, smooth and faceted, with normals of their own and without.
fn meshes_look_as_mujoco_draws_them() {
    // when written: mean up to 0.046; 17 pixels off by more than 2 at the edge of a glass
    small_scene("meshes", 0.05, 0.1);
}

/// Skins that several bodies bend, with images and without.
fn skins_look_as_mujoco_draws_them() {
    // when written: mean up to 0.034; no pixel off by more than 2
    small_scene("skins", 0.05, 0.1);
}

/// Ropes, sheets and solids, smooth and flat, with images and without.
fn flexes_look_as_mujoco_draws_them() {
    // when written: mean up to 0.040; no pixel off by more than 2
    small_scene("flexes", 0.05, 0.1);
}

/// Tendons over and within geoms, by pulleys, straight and hanging.
fn tendons_look_as_mujoco_draws_them() {
    // when written: mean up to 0.036; 6 pixels off by more than 2 at edges
    small_scene("strings", 0.05, 0.1);
}

/// Compares the views of all cameras of a scene of `data` that needs no other files: mean difference, and percentage of pixels that are
/// off by more than 2.
fn small_scene(name: &str, mean: f64, off: f64) {
    let text = data::text(&format!("{name}.xml"));
    let model = load_str(&text, name, &MemoryAssets::new())
        .and_then(compile)
        .expect("the scene compiles");
    let scenery = Scenery::new(&model, &MemoryAssets::new()).expect("textures are procedures");
    let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
    let mut state = engine.new_state();
    engine.forward(&mut state).expect("positions are finite");
    let npz = data::npz(&format!("render_{name}.npz"));
    let ([width, height], theirs) = pictures(&npz, "views");
    let mut renderer = CpuRenderer::new();
    assert_eq!(theirs.len(), engine.model().ncam());
    for (camera, expect) in theirs.iter().enumerate() {
        let view = View { camera, width, height };
        let mut ours = vec![0; view.rgb_len()];
        renderer
            .rgb(&scenery, &Poses::from(&state), &view, &mut ours)
            .expect("the view is fine");
        let mut difference = Difference::default();
        difference.add(&ours, expect, width);
        show!("{name} {:8} {difference}", engine.model().cam_name[camera]);
        if !only_print() {
            assert!(difference.mean() <= mean && difference.off()[0] <= off, "{difference}");
        }
    }
}

/// The original files, whose textures need gigabytes elsewhere, against the pictures in the recordings.
fn recorded_eyes_with_the_original_files() {
    let assets = DirAssets::new(kit_assets().expect("needed")).expect("a folder");
    let mut recordings = 0;
    for g in golden("spring_damper") {
        let Ok(steps) = g.npz.get_f64("eye_steps") else {
            continue;
        };
        let config = Config {
            vision_active: true,
            touch_active: false,
            ..g.config.clone()
        };
        let blueprint = Blueprint::with(config, BlueprintOptions::default().with_assets(assets.clone()))
            .expect("the original files load");
        let bytes = blueprint.scenery().expect("textures").texture_bytes();
        assert!(bytes < 128 << 20, "{bytes} bytes of textures");
        let mut env: Env = blueprint.env().expect("the environment builds");
        let nq = env.model().nq;
        let array = |name: &str| g.npz.get_f64(name).expect("recorded");
        let (qpos, qvel) = (array("qpos").data, array("qvel").data);
        let (qpos0, qvel0) = (array("qpos0").data, array("qvel0").data);
        let (actions, nv) = (array("actions"), env.model().nv);
        let na = actions.shape[1];
        let mut difference = Difference::default();
        let eyes = ["eye_left", "eye_right"].map(array);
        for (k, &t) in steps.data.iter().enumerate() {
            // one step from the recorded state before
            let t = t as usize;
            let before = |all: &[f64], start: &[f64], n: usize| match t {
                0 => start.to_vec(),
                t => all[(t - 1) * n..t * n].to_vec(),
            };
            env.by_hand()
                .reset_to(&before(&qpos, &qpos0, nq), &before(&qvel, &qvel0, nv))
                .expect("a state");
            let action: Vec<f32> = actions.data[t * na..(t + 1) * na].iter().map(|&v| v as f32).collect();
            let step = env.step(&action).expect("no divergence");
            for (ours, theirs) in [step.observation.eye_left, step.observation.eye_right]
                .into_iter()
                .zip(&eyes)
            {
                let n: usize = theirs.shape[1..].iter().product();
                let expect: Vec<u8> = theirs.data[k * n..(k + 1) * n].iter().map(|&v| v as u8).collect();
                difference.add(ours.expect("vision is on"), &expect, theirs.shape[2]);
            }
        }
        show!("{:24} {} pictures: {difference}", g.name, 2 * steps.data.len());
        recordings += 1;
        // when written: mean up to 0.017, max 2
        if !only_print() {
            assert!(
                difference.mean() <= 0.1 && difference.max <= 4,
                "{}: {difference}",
                g.name
            );
            assert!(difference.least_ssim() >= 0.999, "{}: {difference}", g.name);
        }
    }
    assert!(recordings > 0, "no recording has pictures");
}
