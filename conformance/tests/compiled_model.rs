//! The compiled model, array by array, against what MuJoCo 3.3.0 compiles from the same text.
//!
//! `data/compiled_*.npz` is written by `scripts/compiled_model.py`. The scenes are assembled from the original files
//! when they are beside the repository, and from the repository's own assets; what is missing is printed and skipped.
//! Looks are compared only for files with the textures of those that the data come from.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use babybench::mjcf_loader::{DirAssets, MemoryAssets, load_str};
use babybench::model::Model;
use babybench::npz::Npz;
use conformance::arrays::{actuators, looks, names, narrowed, physical};
use conformance::skipped;

const TOLERANCE: f64 = 1e-12;
const SCENES: [&str; 6] = ["v1_base", "v1_crib", "v1_cubes", "v2_base", "v2_crib", "v2_cubes"];

type Arrays = BTreeMap<String, Vec<f64>>;

/// Reads every array of a recording as `f64`.
fn recording(path: &Path) -> Arrays {
    let npz = Npz::open(path).unwrap();
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
            }
            let difference = (a - b).abs();
            entry.0 = entry.0.max(difference);
            if difference.is_nan() || difference > TOLERANCE {
                self.failures.push(format!("{scene} {name}[{index}]: {a} against {b}"));
            }
        }
    }

    fn report(self, what: &str) {
        let identical = self.worst.values().filter(|(_, count)| *count == 0).count();
        println!("{what}: {identical} of {} arrays bit-identical", self.worst.len());
        for (name, (worst, count)) in self.worst.iter().filter(|(_, (_, count))| *count > 0) {
            println!("  {name}: {count} values differ, by {worst:.2e} at most");
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

fn data(scene: &str) -> Arrays {
    recording(
        &Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("data")
            .join(format!("compiled_{scene}.npz")),
    )
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
    let recorded = data(scene);
    let load = |name: &str| load_str(&text(&recorded, name), "babybench/scene.xml", assets).unwrap();
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

fn compare_assets(what: &str, root: PathBuf) {
    let complete = root.join("babybench/base.xml").is_file() && root.join("babybench/cubes.xml").is_file();
    let Some(assets) = complete.then(|| DirAssets::new(&root).unwrap()) else {
        return skipped(what, format!("not at {}", root.display()));
    };
    let mut tally = Tally::default();
    for scene in SCENES {
        compare_scene(scene, &assets, &mut tally);
    }
    tally.report(what);
}

#[test]
fn original_files_compile_as_in_mujoco() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    compare_assets("original files", repository.join("../shared/reference/mjcf"));
}

#[test]
fn own_files_compile_as_in_mujoco() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    compare_assets("own files", repository.join("assets"));
}

#[test]
fn features_beyond_the_scenes_compile_as_in_mujoco() {
    let recorded = data("features");
    let model = load_str(&text(&recorded, "xml"), "features.xml", &MemoryAssets::new()).unwrap();
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
