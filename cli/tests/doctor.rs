//! `babybench doctor`, and the table that its self-check compares with.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use common::Folder;
use program::*;

/// Fails if the arithmetic of a step has changed: then write the output of `cargo run --release --example checksum` to
/// `cli/src/commands/doctor/checksums.txt`, after the distances to the reference have been checked.
#[test]
fn the_self_check_compares_bits_with_the_table() {
    let folder = Folder::new("doctor");
    let out = babybench(folder.path(), &["doctor"]);
    let said = text(&out);
    assert!(out.status.success(), "{said}");
    for name in [
        "babybench",
        "system",
        "processor",
        "instructions",
        "threads",
        "onnx",
        "rapier",
        "wgpu",
        "adapter",
    ] {
        assert!(
            said.lines().any(|line| line.split(' ').next() == Some(name)),
            "no {name} in {said}"
        );
    }
    // graphics drivers may have said something after it
    let check = said
        .lines()
        .find(|line| line.starts_with("self-check"))
        .unwrap_or_default();
    assert!(check.contains("passed: "), "{said}");
    assert!(!check.contains(" 0 of "), "{said}");
}

#[test]
fn without_the_self_check_it_only_describes() {
    let folder = Folder::new("doctor-only");
    let out = babybench(folder.path(), &["doctor", "--no-check"]);
    assert!(out.status.success());
    assert!(!text(&out).contains("self-check"));
}
