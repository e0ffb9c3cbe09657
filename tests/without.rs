//! Builds without all parts: messages about parts that a build lacks say how to build them, and what is left is whole. With
//! `--no-default-features --features eval` alone all of these run.

/// Checks that a configuration is refused with an error that has all of `words`.
#[cfg(not(all(feature = "wgpu", feature = "rapier")))]
fn assert_says(config: babybench::Config, words: [&str; 2]) {
    let error = babybench::Env::new(config).expect_err("not in this build").to_string();
    assert!(words.iter().all(|w| error.contains(w)), "{error}");
}

/// A renderer that is not in this build is an error before anything is built.
#[cfg(not(feature = "wgpu"))]
#[test]
fn without_the_feature_the_error_says_how_to_build() {
    let config = babybench::Config {
        renderer: babybench::config::RendererKind::Wgpu,
        ..Default::default()
    };
    assert_says(config, ["--features wgpu", "renderer: cpu"]);
}

/// So is an engine.
#[cfg(not(feature = "rapier"))]
#[test]
fn without_the_engine_the_error_says_how_to_build() {
    let config = babybench::Config {
        engine: babybench::config::EngineKind::Rapier,
        ..Default::default()
    };
    assert_says(config, ["--features rapier", "engine: soft"]);
}

/// So is a policy.
#[cfg(not(feature = "onnx"))]
#[test]
fn without_onnx_a_model_says_how_to_build() {
    let source = babybench::policy::PolicySource::new("some/model.onnx");
    let Err(error) = source.open(std::time::Duration::from_secs(1)) else {
        panic!("not in this build");
    };
    let error = error.to_string();
    assert!(
        ["some/model.onnx", "--features onnx"].iter().all(|w| error.contains(w)),
        "{error}"
    );
}

/// The folder of a run has the whole scene, all faces included.
#[test]
fn the_scene_of_a_run_is_whole() {
    let folder = std::env::temp_dir().join(format!("babybench-without-{}", std::process::id()));
    babybench::runs::write_scene(&babybench::Config::default(), &folder).expect("all that it names is there");
    let images = std::fs::read_dir(folder.join("tex")).expect("its images");
    let names = images.map(|entry| entry.expect("a file").file_name());
    let faces = names.filter(|name| name.to_string_lossy().starts_with("face_")).count();
    assert_eq!(faces, babybench::config::FacialExpression::ALL.len());
    std::fs::remove_dir_all(folder).expect("its own folder");
}
