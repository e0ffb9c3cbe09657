//! Statements of the documents that can be held against the repository.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use babybench::config::Example;
use babybench::{Config, Env};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(path)).expect("UTF-8")
}

/// Lists the files at and below a folder with this extension.
fn files(folder: &Path, extension: &str, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, extension, out);
        } else if path.extension().is_some_and(|e| e == extension) {
            out.push(path);
        }
    }
}

/// Expands the braces of a path, one pair at most: `src/{a,b}.rs`.
fn expand(path: &str) -> Vec<String> {
    match (path.split_once('{'), path.split_once('}')) {
        (Some((before, _)), Some((inner, after))) => inner[before.len() + 1..]
            .split(',')
            .map(|name| format!("{before}{name}{after}"))
            .collect(),
        _ => vec![path.to_string()],
    }
}

/// Returns the words in backticks that are paths from the root of the repository.
fn paths(text: &str) -> BTreeSet<String> {
    let mut prose = String::new();
    for (k, part) in text.split("```").enumerate() {
        if k % 2 == 0 {
            prose.push_str(part);
        }
    }
    let rooted = |word: &str| {
        let first = word.split('/').next().unwrap_or_default();
        word.contains('/') && !word.contains(['<', '*', ' ', '$']) && Path::new(ROOT).join(first).is_dir()
    };
    // where builds put their results
    const BUILT: [&str; 2] = ["target/", "web/dist"];
    let quoted = prose.split('`').skip(1).step_by(2);
    let paths = quoted.filter(|word| rooted(word) && !BUILT.iter().any(|built| word.starts_with(built)));
    paths.flat_map(expand).collect()
}

#[test]
fn files_that_documents_name_exist() {
    let mut count = 0;
    for document in ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md", "docs/adding.md"] {
        for path in paths(&read(document)) {
            count += 1;
            assert!(
                Path::new(ROOT).join(&path).exists(),
                "{document} names {path}, which does not exist"
            );
        }
    }
    assert!(
        count > 80,
        "only {count} paths were found: does the test still read them?"
    );
}

/// Returns the number written as a word before `what` in a text.
fn number_before(text: &str, what: &str) -> usize {
    const WORDS: [&str; 20] = [
        "one",
        "two",
        "three",
        "four",
        "five",
        "six",
        "seven",
        "eight",
        "nine",
        "ten",
        "eleven",
        "twelve",
        "thirteen",
        "fourteen",
        "fifteen",
        "sixteen",
        "seventeen",
        "eighteen",
        "nineteen",
        "twenty",
    ];
    let (before, _) = text.split_once(what).unwrap_or_else(|| panic!("no {what:?}"));
    let word = before.split_whitespace().last().unwrap_or_default();
    let number = WORDS.iter().position(|w| *w == word);
    number.unwrap_or_else(|| panic!("{word:?} before {what:?} is not a number")) + 1
}

#[test]
fn numbers_in_documents_are_counted() {
    let mut configurations = Vec::new();
    files(&Path::new(ROOT).join("configs"), "yml", &mut configurations);
    for document in ["ARCHITECTURE.md", "README.md"] {
        let said = number_before(&read(document), "example configurations");
        assert_eq!(said, configurations.len(), "{document}");
    }
    // besides BabyBench's and one for each task there are an infant and a caregiver's hand
    assert_eq!(Example::ALL.len() + Example::TASKS.len() + 2, configurations.len());
    let tasks = number_before(&read("ARCHITECTURE.md"), "tasks, an infant");
    assert_eq!(tasks, Example::TASKS.len());

    let manifest = read("fuzz/Cargo.toml");
    let targets = manifest.matches("[[bin]]").count();
    assert_eq!(number_before(&read("README.md"), "fuzz targets"), targets);
    let table = read("fuzz/README.md");
    for line in manifest.lines().filter(|line| line.starts_with("path = \"targets/")) {
        let name = line.trim_start_matches("path = \"targets/").trim_end_matches(".rs\"");
        assert!(table.contains(&format!("| `{name}` |")), "fuzz/README.md has no {name}");
    }
}

#[test]
fn rooms_that_follow_compat_are_listed() {
    let architecture = read("ARCHITECTURE.md");
    let section = architecture.split("## `compat`").nth(1).expect("a section on compat");
    let section = section.split("\n## ").next().unwrap_or_default();
    let items = section.lines().filter_map(|line| line.strip_prefix("- `"));
    let listed: BTreeSet<String> = items
        .filter_map(|item| Some(item.split_once('`')?.0.to_string()))
        .collect();
    let mut sources = Vec::new();
    files(&Path::new(ROOT).join("src"), "rs", &mut sources);
    let mut found = BTreeSet::new();
    for path in sources {
        let text = std::fs::read_to_string(&path).expect("UTF-8");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let mut code = code.lines().filter(|line| !line.trim_start().starts_with("//"));
        if !path.ends_with("tests.rs")
            && code.any(|line| line.contains("Compat::Reference") || line.contains("Compat::Api"))
        {
            let below = path.strip_prefix(Path::new(ROOT).join("src")).expect("a source");
            found.insert(
                below
                    .components()
                    .next()
                    .expect("a room")
                    .as_os_str()
                    .to_string_lossy()
                    .into_owned(),
            );
        }
    }
    assert_eq!(listed, found);
}

#[test]
fn keys_of_observations_are_documented() {
    let documentation = [
        "README.md",
        "docs/guide/senses.md",
        "docs/guide/tasks.md",
        "docs/guide/configuration.md",
    ]
    .map(read)
    .concat();
    let text = "behavior: reach\nvestibular_active: true\ntouch_active: true\ntouch_scale: 3\ntouch_pooled: true\npain_active: true\nvision_active: true";
    let task = Config::from_yaml(text, "every sense").expect("it is valid");
    let env = Env::new(task).expect("it is valid");
    let spaces = env.observation_space();
    assert_eq!(spaces.len(), 9);
    let mut goals = 0;
    for space in spaces {
        assert!(
            documentation.contains(&format!("`{}`", space.key)),
            "{} is not documented",
            space.key
        );
        goals += usize::from(space.key.ends_with("_goal"));
    }
    assert_eq!(goals, 2);
}

#[test]
fn the_front_page_lists_the_features_and_the_compiler() {
    let (manifest, page) = (read("Cargo.toml"), read("src/lib.rs"));
    let value = |key: &str| {
        let line = manifest.lines().find_map(|line| line.strip_prefix(key));
        line.map(|line| line.trim_matches([' ', '=', '"']).to_string())
    };
    let version = value("rust-version").expect("a version");
    assert!(page.contains(&format!("minimum supported Rust version is {version}.")));
    let section = manifest
        .split("[features]")
        .nth(1)
        .and_then(|text| text.split("\n[").next());
    let features = section
        .expect("features")
        .lines()
        .filter_map(|line| line.split_once(" = "));
    let mut count = 0;
    for (feature, _) in features.filter(|(feature, _)| *feature != "default") {
        count += 1;
        assert!(
            page.contains(&format!("//! | `{feature}`")),
            "{feature} is missing in the table"
        );
    }
    assert_eq!(count, page.matches("\n//! | `").count());
}
