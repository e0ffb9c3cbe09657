//! The guide says what the program says, and all that it points to is there.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The pages of the guide with their text.
fn pages() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide");
    let entries = std::fs::read_dir(&folder).expect("the guide");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut pages: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .map(|path| (path.clone(), std::fs::read_to_string(&path).expect("text")))
        .collect();
    pages.sort();
    pages
}

#[test]
fn the_chapter_on_configuration_is_what_inspect_prints() {
    let out = Command::new(env!("CARGO_BIN_EXE_babybench"))
        .args(["inspect", "--keys"])
        .output()
        .expect("the program runs");
    assert!(out.status.success());
    let printed = String::from_utf8(out.stdout).expect("text");
    let (_, page) = pages()
        .into_iter()
        .find(|(path, _)| path.ends_with("configuration.md"))
        .expect("the chapter");
    assert!(
        printed == page,
        "docs/guide/configuration.md is old: cargo run --release -- inspect --keys > docs/guide/configuration.md"
    );
}

#[test]
fn the_tables_of_infants_are_what_inspect_prints() {
    let out = Command::new(env!("CARGO_BIN_EXE_babybench"))
        .args(["inspect", "--sources"])
        .output()
        .expect("the program runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let printed = String::from_utf8(out.stdout).expect("text");
    let pages = pages();
    let page = pages.iter().find(|(path, _)| path.ends_with("infant.md"));
    let (_, page) = page.expect("the chapter");
    let tables: Vec<&str> = printed.split("\n\n").map(str::trim).collect();
    assert_eq!(tables.len(), 5);
    for table in tables {
        assert!(
            page.contains(table),
            "docs/guide/infant.md is old: inspect --sources prints\n{table}"
        );
    }
}

#[test]
fn links_and_pictures_of_the_guide_lead_somewhere() {
    let mut found = 0;
    for (path, text) in pages() {
        let folder = path.parent().expect("a folder");
        for rest in text.split("](").skip(1) {
            let target = rest.split(')').next().unwrap_or("");
            if target.contains("://") {
                continue;
            }
            let file = target.split('#').next().unwrap_or("");
            assert!(folder.join(file).exists(), "{}: {target} is not there", path.display());
            found += 1;
        }
    }
    assert!(found > 20, "{found} links");
}

#[test]
fn every_chapter_is_in_the_contents() {
    let pages = pages();
    let text = |name: &str| {
        let page = pages.iter().find(|(path, _)| path.ends_with(name));
        page.map(|(_, text)| text.clone()).expect("a page")
    };
    let readme = text("README.md");
    for (path, _) in &pages {
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
        if name != "README.md" {
            assert!(readme.contains(name), "{name} is not in the contents");
        }
    }
}

#[test]
fn the_plots_are_what_the_example_draws() {
    let folder = std::env::temp_dir().join(format!("babybench_guide_{}", std::process::id()));
    // built with the tests, unless one target alone was asked for
    let example = Path::new(env!("CARGO_BIN_EXE_babybench")).with_file_name("examples/guide");
    let out = Command::new(&example).arg(&folder).output();
    let out = out.unwrap_or_else(|e| panic!("{}: {e}; cargo test -p babybench-cli builds it", example.display()));
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let plots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/plots");
    for name in ["growth.svg", "acuity.svg"] {
        let [drawn, kept] = [&folder, &plots].map(|folder| std::fs::read(folder.join(name)).expect("a plot"));
        assert!(
            drawn == kept,
            "{name} is old: cargo run --release -p babybench-cli --example guide"
        );
    }
    std::fs::remove_dir_all(&folder).expect("the folder was made");
}
