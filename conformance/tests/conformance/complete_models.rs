//! Every public path from MJCF text to `Engine::step`: whichever is taken, the model has all constants that need dynamics,
//! and they are those that MuJoCo 3.3.0 compiles (`data/compiled_*.npz`).

use std::sync::Arc;

use babybench::assets::{DirAssets, MemoryAssets, Overlay};
use babybench::config::{ActuationModel, Behavior, Config, Scene};
use babybench::env::BlueprintOptions;
use babybench::formats::npz::Npz;
use babybench::mimo::{DOCUMENT, Version, build_model, embedded, scene_xml};
use babybench::mjcf_loader::{Spec, load, load_str, load_str_with, load_with};
use babybench::physics::{Engine, SoftEngine, SoftOptions, compile};
use babybench::rapier::{RapierEngine, RapierOptions};
use babybench::runs::{complete_scene, make_env, read_scene, write_scene};
use babybench::{Blueprint, Env, Limits, Model};
use conformance::arrays::derived;
use conformance::data;
use conformance::measure::{max_abs, only_print, relative, relative_each};
use testkit::harness::Trial;
use testkit::yardsticks::workspace;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        every_path_to_an_engine_gives_a_model_with_mujocos_constants,
        constants_of_every_element_are_mujocos
    ]
}

fn compiled(spec: Spec) -> Arc<Model> {
    Arc::new(compile(spec).expect("the scenes compile"))
}

fn own_files() -> DirAssets {
    DirAssets::new(workspace().join("assets")).expect("the repository's assets")
}

/// A folder that is removed at the end.
struct Folder(std::path::PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = format!("babybench_complete_models_{}_{name}", std::process::id());
        Self(std::env::temp_dir().join(folder))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The models that all paths through the loader give.
fn loaded(config: &Config, text: &str) -> Vec<(&'static str, Arc<Model>)> {
    let (limits, files, own) = (Limits::default(), embedded(), own_files());
    let mut memory = MemoryAssets::new();
    memory.insert(DOCUMENT, scene_xml(config)).expect("a relative path");
    let layers = Overlay::new(own_files()).with(memory);
    let mut flat = MemoryAssets::new();
    let scene = complete_scene(config).expect("the embedded assets load");
    flat.insert("flat.xml", scene.xml).expect("a relative path");
    for (path, file) in scene.files {
        flat.insert(&path, file).expect("a relative path");
    }
    let folder = Folder::new(&format!("{:?}_{}", config.behavior, config.scene));
    write_scene(config, &folder.0).expect("a folder that can be written");
    let written = DirAssets::new(&folder.0).expect("the folder was made");
    let good = "the scenes load";
    vec![
        (
            "load from a directory",
            compiled(load(&written, "scene.xml").expect(good)),
        ),
        ("load from layers", compiled(load(&layers, DOCUMENT).expect(good))),
        ("load from memory", compiled(load(&flat, "flat.xml").expect(good))),
        (
            "load_with",
            compiled(load_with(&layers, DOCUMENT, &limits).expect(good)),
        ),
        ("load_str", compiled(load_str(text, DOCUMENT, &files).expect(good))),
        (
            "load_str_with",
            compiled(load_str_with(text, DOCUMENT, &own, &limits).expect(good)),
        ),
        ("build_model", Arc::new(build_model(config, &files).expect(good))),
        ("read_scene", Arc::new(read_scene(&folder.0).expect(good))),
    ]
}

/// The models of environments.
fn of_environments(config: &Config) -> Vec<(&'static str, Arc<Model>)> {
    let blueprint = Blueprint::new(config.clone()).expect("the scenes settle");
    let own = Blueprint::with(config.clone(), BlueprintOptions::default().with_assets(own_files()))
        .expect("the scenes settle");
    let there_and_back = blueprint
        .with_actuation(ActuationModel::Positional)
        .and_then(|servos| servos.with_actuation(ActuationModel::SpringDamper))
        .expect("embedded");
    let env = Env::new(config.clone()).expect("an environment");
    let evaluation = make_env(config.clone(), false).expect("an environment");
    vec![
        ("Blueprint::new", blueprint.model().clone()),
        ("Blueprint::with", own.model().clone()),
        ("Blueprint::with_actuation", there_and_back.model().clone()),
        ("Env::new", env.model().clone()),
        ("make_env", evaluation.model().clone()),
    ]
}

/// The largest relative error of the constants. The centre is relative to the extent of the model.
fn error(model: &Model, recorded: &Npz) -> f64 {
    let array = |name: &str| {
        let found = recorded
            .get_f64(name)
            .or_else(|_| recorded.get_f64(&format!("stat_{name}")));
        found.expect("committed data").data
    };
    let mut worst = 0.0_f64;
    for (name, ours) in derived(model) {
        let theirs = array(name);
        assert_eq!(ours.len(), theirs.len(), "{name}");
        let e = match name {
            "center" => max_abs(&ours, &theirs) / model.stat.extent,
            _ if theirs.iter().all(|&v| v == 0.0) => relative(&ours, &theirs),
            _ => relative_each(&ours, &theirs),
        };
        assert!(!e.is_nan(), "{name}: {ours:?}");
        worst = worst.max(e);
    }
    worst
}

/// Both engines step the model; both give what `expect` holds, which the first path fills.
fn step(model: &Arc<Model>, expect: &mut [Option<Vec<f64>>; 2]) {
    let soft = SoftEngine::new(model.clone(), SoftOptions::default());
    let rapier = RapierEngine::new(model.clone(), RapierOptions::default()).expect("a model for Rapier");
    let engines: [Box<dyn Engine>; 2] = [Box::new(soft), Box::new(rapier)];
    for (mut engine, expect) in engines.into_iter().zip(expect) {
        let mut state = engine.new_state();
        engine.step(&mut state).expect("no divergence");
        let expect = expect.get_or_insert_with(|| state.qvel.clone());
        assert_eq!(*expect, state.qvel);
    }
}

fn every_path_to_an_engine_gives_a_model_with_mujocos_constants() {
    let mut worst = 0.0_f64;
    for behavior in [Behavior::None, Behavior::HandRegard] {
        for scene in Scene::BABYBENCH {
            let config = Config {
                behavior,
                scene: scene.clone(),
                touch_active: false,
                vision_active: false,
                ..Config::default()
            };
            let name = format!("{}_{scene}", Version::of(behavior).name());
            let recorded = data::npz(&format!("compiled_{name}.npz"));
            let text: Vec<u8> = recorded
                .get_f64("xml")
                .expect("committed data")
                .data
                .iter()
                .map(|&b| b as u8)
                .collect();
            let text = String::from_utf8(text).expect("UTF-8");
            let mut steps = [None, None];
            for (path, model) in loaded(&config, &text).into_iter().chain(of_environments(&config)) {
                let e = error(&model, &recorded);
                show!("{name:9} {path:26} {e:.1e}");
                worst = worst.max(e);
                assert!(only_print() || e <= 1e-13, "{name}: {path}: {e:e}");
                step(&model, &mut steps);
            }
        }
    }
    // 1.7e-14 when written
    show!("largest relative error of a constant: {worst:.1e}");
}

/// Sliding bodies, springs, tendons, welds with and without a pose, bodies without mass: a document with every element.
fn constants_of_every_element_are_mujocos() {
    let recorded = data::npz("compiled_features.npz");
    let text: Vec<u8> = recorded
        .get_f64("xml")
        .expect("committed data")
        .data
        .iter()
        .map(|&b| b as u8)
        .collect();
    let text = String::from_utf8(text).expect("UTF-8");
    let spec = load_str(&text, "features.xml", &MemoryAssets::new()).expect("all of it is understood");
    let e = error(&compiled(spec), &recorded);
    // 8.3e-14 when written
    show!("largest relative error of a constant: {e:.1e}");
    assert!(only_print() || e <= 5e-13, "{e:e}");
}
