//! Pictures on a GPU from the command line.

use std::process::Command;

/// The command line, on the backend of another system.
#[test]
fn without_an_adapter_the_error_says_what_to_do() {
    let out = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("render_gpu.png");
    let config = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/config_test_installation.yml");
    let run = |backend: &str, renderer: &str| {
        Command::new(env!("CARGO_BIN_EXE_babybench"))
            .args(["render", "--size", "32", "--renderer", renderer, "--config"])
            .arg(&config)
            .arg("--out")
            .arg(&out)
            .env("WGPU_BACKEND", backend)
            .output()
            .expect("the binary runs")
    };
    let elsewhere = if cfg!(target_os = "windows") { "metal" } else { "dx12" };
    let failed = run(elsewhere, "wgpu");
    let text = String::from_utf8_lossy(&failed.stderr).into_owned();
    assert!(!failed.status.success(), "{text}");
    for part in ["no graphics adapter", elsewhere, "mesa-vulkan-drivers", "renderer: cpu"] {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
    assert!(run(elsewhere, "cpu").status.success(), "the CPU renderer needs nothing");
}
