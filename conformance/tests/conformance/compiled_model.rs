//! The compiled model, array by array, against what MuJoCo 3.3.0 compiles from the same text.
//!
//! `data/compiled_*.npz` is written by `scripts/compiled_model.py`. The scenes are assembled from the kit's original files
//! and from the repository's own assets.
//! Looks are compared only for files with the textures of those that the data come from.

use std::collections::BTreeMap;
use std::path::Path;

use babybench::assets::{AssetSource, DirAssets, MemoryAssets};
use babybench::formats::npz::Npz;
use babybench::mjcf_loader::load_str;
use babybench::model::Model;
use babybench::physics::compile;
use conformance::arrays::{actuators, looks, names, narrowed, physical};
use conformance::data;
use testkit::harness::Trial;
use testkit::yardsticks::{KIT, kit_assets, workspace};
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    [
        trials![needs KIT: original_files_compile_as_in_mujoco],
        trials![
            own_files_compile_as_in_mujoco,
            features_beyond_the_scenes_compile_as_in_mujoco
        ],
    ]
    .concat()
}

/// All arrays but one are bit-identical; that one, centres of mass that lights follow, was within 1.4e-17 when written.
const TOLERANCE: f64 = 1e-16;

const SCENES: [&str; 6] = ["v1_base", "v1_crib", "v1_cubes", "v2_base", "v2_crib", "v2_cubes"];

type Arrays = BTreeMap<String, Vec<f64>>;

/// Reads every array of a recording as `f64`.
fn recording(npz: &Npz) -> Arrays {
    npz.arrays()
        .map(|a| (a.name.clone(), npz.get_f64(&a.name).unwrap().data))
        .collect()
}

fn text(arrays: &Arrays, name: &str) -> String {
    String::from_utf8(arrays[name].iter().map(|&byte| byte as u8).collect()).unwrap()
}

#[derive(Default)]
struct Tally {
    /// Largest difference and how many comparisons were not bit-identical, by array.
    worst: BTreeMap<&'static str, (f64, usize)>,
    failures: Vec<String>,
}

impl Tally {
    fn compare(&mut self, scene: &str, name: &'static str, ours: &[f64], recorded: &[f64]) {
        if ours.len() != recorded.len() {
            self.failures.push(format!(
                "{scene} {name}: {} values, MuJoCo has {}",
                ours.len(),
                recorded.len()
            ));
            return;
        }
        let entry = self.worst.entry(name).or_default();
        for (index, (a, b)) in ours.iter().zip(recorded).enumerate() {
            // The sign of zero is not compared: it never reaches a result.
            if a != b {
                entry.1 += 1;
                entry.0 = entry.0.max((a - b).abs());
                if (a - b).abs() > TOLERANCE || (a - b).is_nan() {
                    self.failures.push(format!("{scene} {name}[{index}]: {a} against {b}"));
                }
            }
        }
    }

    fn report(self, what: &str) {
        let identical = self.worst.values().filter(|(_, count)| *count == 0).count();
        show!("{what}: {identical} of {} arrays bit-identical", self.worst.len());
        for (name, (worst, count)) in self.worst.iter().filter(|(_, (_, count))| *count > 0) {
            show!("  {name}: {count} values differ, by {worst:.2e} at most");
        }
        let shown = &self.failures[..self.failures.len().min(40)];
        assert!(
            shown.is_empty(),
            "{} differences, the first:\n{}",
            self.failures.len(),
            shown.join("\n")
        );
    }

    fn names(&mut self, scene: &str, kind: &str, ours: Vec<&str>, recorded: &str) {
        if ours.join("\n") != recorded {
            self.failures.push(format!("{scene} names of {kind} differ"));
        }
    }
}

fn model(xml: &str, path: &str, assets: &dyn AssetSource) -> Model {
    load_str(xml, path, assets).and_then(compile).unwrap()
}

fn compiled(scene: &str) -> Arrays {
    recording(&data::npz(&format!("compiled_{scene}.npz")))
}

fn compare_names(scene: &str, model: &Model, recorded: &Arrays, with_looks: bool, tally: &mut Tally) {
    for (kind, ours) in names(model) {
        if with_looks || !["tex", "mat", "light"].contains(&kind) {
            let ours = ours.iter().map(String::as_str).collect();
            tally.names(scene, kind, ours, &text(recorded, &format!("{kind}_name")));
        }
    }
}

fn compare_scene(scene: &str, assets: &DirAssets, tally: &mut Tally) {
    let recorded = compiled(scene);
    let load = |name: &str| model(&text(&recorded, name), "babybench/scene.xml", assets);
    let (motor, position) = (load("xml"), load("position_xml"));
    let mut arrays = physical(&motor);
    let textures: Vec<&str> = motor.textures.iter().map(|texture| texture.name.as_str()).collect();
    let with_looks = textures.join("\n") == text(&recorded, "tex_name");
    if with_looks {
        arrays.extend(looks(&motor));
    }
    arrays.extend(actuators(&motor));
    for (name, ours) in &arrays {
        tally.compare(scene, name, ours, &narrowed(name, &recorded[*name]));
    }
    for (name, ours) in actuators(&position) {
        tally.compare(
            scene,
            name,
            &ours,
            &narrowed(name, &recorded[&format!("position_{name}")]),
        );
    }
    // The servos differ in nothing but the actuators.
    for ((name, ours), (_, other)) in physical(&motor).iter().zip(physical(&position)) {
        assert_eq!(*ours, other, "{scene} {name}");
    }
    compare_names(scene, &motor, &recorded, with_looks, tally);
    assert_eq!(motor.name, "MIMo");
}

fn compare_assets(what: &str, root: &Path) {
    let assets = DirAssets::new(root).unwrap();
    let mut tally = Tally::default();
    for scene in SCENES {
        compare_scene(scene, &assets, &mut tally);
    }
    tally.report(what);
}

fn original_files_compile_as_in_mujoco() {
    compare_assets("original files", &kit_assets().expect("needed"));
}

fn own_files_compile_as_in_mujoco() {
    compare_assets("own files", &workspace().join("assets"));
}

fn features_beyond_the_scenes_compile_as_in_mujoco() {
    let recorded = compiled("features");
    let model = model(&text(&recorded, "xml"), "features.xml", &MemoryAssets::new());
    let mut tally = Tally::default();
    for (name, ours) in physical(&model)
        .into_iter()
        .chain(looks(&model))
        .chain(actuators(&model))
    {
        tally.compare("features", name, &ours, &narrowed(name, &recorded[name]));
    }
    compare_names("features", &model, &recorded, true, &mut tally);
    tally.report("features");
}
