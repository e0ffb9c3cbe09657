//! Pictures against MuJoCo 3.3.0's own renderer (OSMesa): of the embedded assets from `data/render_*.npz`, which
//! `scripts/render_goldens.py` writes and describes, and of the original files from the recordings.

use std::path::Path;

use babybench::config::{Behavior, Config, Scene};
use babybench::mimo::{build_model, embedded};
use babybench::mjcf_loader::{AssetSource, DirAssets};
use babybench::model::CameraId;
use babybench::npz::Npz;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State};
use babybench::render::{Poses, Renderer, View, Visual};
use babybench::{Blueprint, Env};
use conformance::measure::only_print;
use conformance::recordings::{golden, shared};

/// Differences of two sets of pictures, bytes.
#[derive(Default)]
struct Difference {
    values: usize,
    sum: u64,
    max: u8,
    /// Pixels off by more than 2, and by more than 4, in some colour.
    off: [usize; 2],
    ssim: Vec<f64>,
}

impl Difference {
    fn add(&mut self, ours: &[u8], theirs: &[u8], width: usize) {
        assert_eq!(ours.len(), theirs.len());
        for (a, b) in ours.chunks_exact(3).zip(theirs.chunks_exact(3)) {
            let d = [0, 1, 2].map(|k| a[k].abs_diff(b[k]));
            self.sum += d.iter().map(|&v| u64::from(v)).sum::<u64>();
            let most = d.into_iter().max().unwrap();
            self.max = self.max.max(most);
            self.off[0] += usize::from(most > 2);
            self.off[1] += usize::from(most > 4);
        }
        self.values += ours.len();
        self.ssim.push(ssim(ours, theirs, width));
    }

    fn mean(&self) -> f64 {
        self.sum as f64 / self.values as f64
    }

    /// Percentage of pixels off by more than 2, and by more than 4.
    fn off(&self) -> [f64; 2] {
        self.off.map(|n| 100.0 * n as f64 / (self.values / 3) as f64)
    }

    fn least_ssim(&self) -> f64 {
        self.ssim.iter().copied().fold(1.0, f64::min)
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let [two, four] = self.off();
        write!(
            f,
            "mean {:.4}, max {}, {two:.4} % of pixels off by more than 2, {four:.4} % by more than 4, SSIM >= {:.5}",
            self.mean(),
            self.max,
            self.least_ssim()
        )
    }
}

/// Mean structural similarity of the brightness over windows of 8 x 8 pixels, 4 apart.
fn ssim(a: &[u8], b: &[u8], width: usize) -> f64 {
    const C: [f64; 2] = [(0.01 * 255.0) * (0.01 * 255.0), (0.03 * 255.0) * (0.03 * 255.0)];
    let gray = |v: &[u8]| -> Vec<f64> {
        let luma = |p: &[u8]| 0.299 * f64::from(p[0]) + 0.587 * f64::from(p[1]) + 0.114 * f64::from(p[2]);
        v.chunks_exact(3).map(luma).collect()
    };
    let (a, b) = (gray(a), gray(b));
    let (mut sum, mut count) = (0.0, 0);
    for y in (0..a.len() / width - 7).step_by(4) {
        for x in (0..width - 7).step_by(4) {
            let at = (0..64).map(|k| (y + k / 8) * width + x + k % 8);
            let [mut ma, mut mb, mut aa, mut bb, mut ab] = [0.0; 5];
            for i in at {
                ma += a[i] / 64.0;
                mb += b[i] / 64.0;
                aa += a[i] * a[i] / 64.0;
                bb += b[i] * b[i] / 64.0;
                ab += a[i] * b[i] / 64.0;
            }
            let (va, vb, cov) = (aa - ma * ma, bb - mb * mb, ab - ma * mb);
            sum += (2.0 * ma * mb + C[0]) * (2.0 * cov + C[1]) / ((ma * ma + mb * mb + C[0]) * (va + vb + C[1]));
            count += 1;
        }
    }
    sum / f64::from(count)
}

/// Pictures of an array of the data, each of which stores differences to the left.
fn pictures(npz: &Npz, name: &str) -> (usize, Vec<Vec<u8>>) {
    let a = npz.get_f64(name).expect("committed data");
    let width = a.shape[a.shape.len() - 2];
    let mut bytes: Vec<u8> = a.data.iter().map(|&v| v as u8).collect();
    for row in bytes.chunks_exact_mut(3 * width) {
        for i in 3..row.len() {
            row[i] = row[i].wrapping_add(row[i - 3]);
        }
    }
    (
        width,
        bytes.chunks_exact(3 * width * width).map(<[u8]>::to_vec).collect(),
    )
}

struct Stage {
    engine: SoftEngine,
    state: State,
    visual: Visual,
    renderer: Renderer,
    picture: Vec<u8>,
}

impl Stage {
    fn new(config: &Config, assets: &dyn AssetSource) -> Self {
        let model = build_model(config, assets).expect("the scene compiles");
        let visual = Visual::new(&model, assets).expect("the textures load");
        let engine = SoftEngine::new(model.into(), SoftOptions::default());
        Self {
            state: engine.new_state(),
            engine,
            visual,
            renderer: Renderer::new(),
            picture: Vec::new(),
        }
    }

    fn at(&mut self, qpos: &[f64]) {
        self.state.qpos.copy_from_slice(qpos);
        self.state.qvel.fill(0.0);
        self.engine.forward(&mut self.state).expect("positions are finite");
    }

    fn draw(&mut self, camera: CameraId, size: usize) -> &[u8] {
        let view = View {
            camera,
            width: size,
            height: size,
        };
        self.picture.resize(view.rgb_len(), 0);
        self.renderer
            .rgb(&self.visual, &Poses::from(&self.state), &view, &mut self.picture)
            .expect("the view is fine");
        &self.picture
    }
}

#[test]
fn eyes_and_room_cameras_show_what_mujoco_draws() {
    for &scene in Scene::ALL {
        let config = Config {
            scene,
            behavior: if scene == Scene::Cubes {
                Behavior::HandRegard
            } else {
                Behavior::None
            },
            ..Config::default()
        };
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/render_{scene}.npz"));
        let npz = Npz::open(data).expect("committed data");
        let mut stage = Stage::new(&config, &embedded());
        let qpos = npz.get_f64("qpos").expect("committed data");
        let nq = qpos.shape[1];
        let model = stage.engine.model().clone();
        let eyes = ["eye_left", "eye_right"].map(|name| model.camera(name).expect("MIMo has eyes"));

        let (size, theirs) = pictures(&npz, "eyes");
        let mut difference = Difference::default();
        for (k, pair) in theirs.chunks_exact(2).enumerate() {
            stage.at(&qpos.data[k * nq..(k + 1) * nq]);
            for (camera, expect) in eyes.iter().zip(pair) {
                difference.add(stage.draw(*camera, size), expect, size);
            }
        }
        println!("{scene:6} eyes of {} states: {difference}", qpos.shape[0]);
        // when written: mean 0.023, 0.022, 0.047 of 255; 0.01, 0.01, 0.03 % of pixels off by more than 4, at silhouettes
        if !only_print() {
            assert!(difference.mean() <= 0.1 && difference.least_ssim() >= 0.999);
            assert!(difference.off()[1] <= 0.1, "{difference}");
        }

        let (size, theirs) = pictures(&npz, "views");
        let states = npz.get_f64("view_state").expect("committed data").data;
        let cameras = npz.get_f64("view_camera").expect("committed data").data;
        for ((state, camera), expect) in states.iter().zip(&cameras).zip(&theirs) {
            let (state, camera) = (*state as usize, CameraId(*camera as usize));
            stage.at(&qpos.data[state * nq..(state + 1) * nq]);
            let mut difference = Difference::default();
            difference.add(stage.draw(camera, size), expect, size);
            println!("{scene:6} {:10} {difference}", model.cam_name[camera.0]);
            if !only_print() {
                assert!(difference.mean() <= 0.1 && difference.off()[0] <= 0.2, "{difference}");
                assert!(difference.least_ssim() >= 0.999, "{difference}");
            }
        }
    }
}

/// The original files, whose textures need gigabytes elsewhere, against the pictures in the recordings.
#[test]
fn recorded_eyes_with_the_original_files() {
    let Some(assets) = shared().and_then(|d| DirAssets::new(d.join("reference/mjcf")).ok()) else {
        eprintln!("SKIPPED recorded eyes: no original files beside the repository");
        return;
    };
    for g in golden("spring_damper") {
        let Ok(steps) = g.npz.get_f64("eye_steps") else {
            continue;
        };
        let config = Config {
            vision_active: true,
            touch_active: false,
            ..g.config.clone()
        };
        let blueprint = Blueprint::with_assets(config, &assets).expect("the original files load");
        let bytes = blueprint.visual().expect("textures").texture_bytes();
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
            env.reset_to(&before(&qpos, &qpos0, nq), &before(&qvel, &qvel0, nv))
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
        println!("{:24} {} pictures: {difference}", g.name, 2 * steps.data.len());
        assert!(only_print() || difference.mean() <= 0.5, "{}: {difference}", g.name);
    }
}
