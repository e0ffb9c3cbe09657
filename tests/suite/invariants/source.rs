//! Invariants 5, 6, 7, 10, 11: what the source, the loaders and the dependencies promise.

use std::path::Path;
use std::process::Command;

use babybench::Config;
use babybench::assets::{AssetSource, MemoryAssets, Overlay};
use babybench::config::{Behavior, Scene};
use babybench::mimo::{DOCUMENT, embedded, scene_xml};
use babybench::mjcf_loader::load_str;
use testkit::Rng;
use testkit::mutation::{WORDS, mutate};

use crate::common::*;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

#[test]
fn invariant_5_the_library_and_the_command_line_forbid_unsafe_code() {
    for root in [
        include_str!("../../../src/lib.rs"),
        include_str!("../../../src/mjcf_loader/mod.rs"),
        include_str!("../../../src/model/lib.rs"),
        include_str!("../../../src/physics/mod.rs"),
        include_str!("../../../src/physics/rapier/mod.rs"),
        include_str!("../../../src/render/mod.rs"),
        include_str!("../../../engine/src/lib.rs"),
        include_str!("../../../cli/src/main.rs"),
    ] {
        assert!(root.contains("\n#![forbid(unsafe_code)]\n"));
    }
}

/// Rust files below `dir`, with their text up to the unit tests.
fn sources(dir: &Path, out: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(dir)
        .expect("a source folder")
        .map(|e| e.expect("readable"))
    {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") && path.file_stem().is_some_and(|s| s != "tests") {
            let text = std::fs::read_to_string(&path).expect("UTF-8");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default().to_string();
            out.push((path.display().to_string(), code));
        }
    }
}

#[test]
fn invariant_10_the_core_uses_no_file_system_threads_or_clock() {
    let mut files = Vec::new();
    for part in ["physics", "sensors", "actuation", "mimo", "model"] {
        sources(&Path::new(ROOT).join("src").join(part), &mut files);
    }
    // beneath the model lies what does touch the world, for those who ask for it
    let apart = [
        "src/model/assets/",
        "src/model/files/",
        "src/model/formats/",
        "src/model/threads.rs",
        "src/model/pool.rs",
    ];
    files.retain(|(file, _)| !apart.iter().any(|part| file.replace('\\', "/").contains(part)));
    assert!(files.len() > 100);
    for (file, code) in files {
        for word in [
            "std::fs",
            "std::thread",
            "std::time",
            "std::env",
            "std::net",
            "Instant",
            "SystemTime",
            "rayon",
        ] {
            assert!(!code.contains(word), "{file} uses {word}");
        }
    }
}

#[test]
fn invariant_3_physics_uses_no_fused_or_platform_arithmetic() {
    let mut files = Vec::new();
    for part in ["physics", "sensors", "actuation"] {
        sources(&Path::new(ROOT).join("src").join(part), &mut files);
    }
    let platform = [
        ".mul_add(",
        ".sin()",
        ".cos()",
        ".tan()",
        ".sin_cos()",
        ".exp()",
        ".ln()",
        ".powf(",
        ".asin()",
        ".acos()",
        ".atan2(",
        ".atan()",
        "HashMap",
        "HashSet",
    ];
    for (file, code) in files {
        for word in platform {
            assert!(!code.contains(word), "{file} uses {word}");
        }
    }
}

#[test]
fn invariant_11_no_dependency_needs_a_c_compiler() {
    let tree = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--locked",
            "--offline",
            "-p",
            "babybench",
            "-e",
            "normal,build",
            "--features",
            "onnx",
            "--prefix",
            "none",
        ])
        .current_dir(ROOT)
        .output();
    let out = tree.expect("cargo runs, as it does where tests are built");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    let mut names: Vec<&str> = text.lines().filter_map(|l| l.split_whitespace().next()).collect();
    names.sort_unstable();
    names.dedup();
    println!(
        "{} packages with default features and ONNX: {}",
        names.len(),
        names.join(" ")
    );
    // bindings that come as Rust source
    let harmless = ["windows-sys", "linux-raw-sys", "js-sys", "web-sys"];
    for name in names {
        let tool = ["cc", "cmake", "bindgen", "pkg-config", "vcpkg", "nasm-rs"].contains(&name);
        assert!(
            !tool && (!name.ends_with("-sys") || harmless.contains(&name)),
            "{name} needs a C compiler or a system library"
        );
    }
}

#[test]
fn invariant_6_damaged_configurations_never_panic() {
    let mut rng = Rng::with_seed(6);
    let (mut good, n) = (0, 3000);
    for k in 0..n {
        let (name, text) = EXAMPLES[k % 3];
        let bytes = mutate(text.as_bytes(), WORDS, &mut rng);
        match Config::from_yaml(&String::from_utf8_lossy(&bytes), "damaged.yml") {
            Ok(config) => {
                config.validate().expect("what loads is valid");
                good += 1;
            }
            Err(e) => assert!(e.to_string().contains("damaged.yml"), "{name}: {e} names no file"),
        }
    }
    println!("{good} of {n} damaged configurations are still valid");
}

#[test]
fn invariant_6_damaged_scenes_never_panic() {
    let mut rng = Rng::with_seed(7);
    let files = [
        "mimo_v1",
        "meta_v1",
        "base",
        "cubes",
        "crib",
        "classes_common",
        "motor_arms",
    ];
    let (mut good, n) = (0, if cfg!(debug_assertions) { 150 } else { 1500 });
    for k in 0..n {
        let scene = if k % 2 == 0 { Scene::Cubes } else { Scene::Crib };
        let path = format!("babybench/{}.xml", files[k % files.len()]);
        let assets = embedded();
        let text = mutate(&assets.read(&path).expect("embedded"), WORDS, &mut rng);
        let mut damaged = MemoryAssets::new();
        damaged.insert(&path, text).expect("a path of the assets");
        let source = Overlay::new(assets).with(damaged);
        match load_str(&scene_xml(&free(Behavior::None, scene)), DOCUMENT, &source) {
            Ok(_) => good += 1,
            Err(e) => assert!(!e.place.file.is_empty(), "{e} names no file"),
        }
    }
    println!("{good} of {n} damaged scenes still load");
}

#[test]
fn invariant_7_unsupported_mjcf_is_an_error_that_names_the_element() {
    for (element, xml) in [
        (
            "flexcomp",
            r#"<mujoco><worldbody><flexcomp name="a" dof="trilinear"/></worldbody></mujoco>"#,
        ),
        (
            "skin",
            r#"<mujoco><asset><skin name="a" file="a.skn"/></asset></mujoco>"#,
        ),
        (
            "planar",
            r#"<mujoco><worldbody><body><joint type="planar"/><geom size=".1"/></body></worldbody></mujoco>"#,
        ),
        (
            "composite",
            r#"<mujoco><worldbody><body><composite type="cable"/></body></worldbody></mujoco>"#,
        ),
        (
            "extension",
            r#"<mujoco><extension><plugin plugin="a"/></extension></mujoco>"#,
        ),
        (
            "colour",
            r#"<mujoco><worldbody><geom size=".1" colour="1 0 0 1"/></worldbody></mujoco>"#,
        ),
    ] {
        let error = load_str(xml, "unsupported.xml", &MemoryAssets::new())
            .expect_err(element)
            .to_string();
        println!("{error}");
        assert!(
            error.contains("unsupported.xml:1:") && error.contains(element),
            "{error} does not name {element}"
        );
    }
}

/// A harness of its own takes what is listed in `trials`, and would never run what is only marked as a test.
#[test]
fn no_test_is_lost_where_tests_are_listed() {
    let mut folders = vec![
        Path::new(ROOT).join("tests/yardsticks"),
        Path::new(ROOT).join("conformance/tests"),
    ];
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a source file");
            assert!(
                !text.contains("#[test]"),
                "{} marks a test that never runs",
                path.display()
            );
            files += 1;
        }
    }
    assert!(files > 15, "{files} files");
}
