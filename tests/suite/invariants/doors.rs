//! Invariant 13: rooms look down, never up. `ROOMS` is the order in which the library is built.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The rooms of `src/`, from the ground up. A room may use those on lines before its own; rooms on one line know nothing
/// of each other.
const ROOMS: &[&[&str]] = &[
    &["math", "limits", "files", "json", "text", "threads"],
    &["model", "assets", "spaces"],
    &["mjcf_loader", "formats"],
    &["physics"],
    &["render"],
    &["config"],
    &["mimo"],
    &["actuation"],
    &["sensors"],
    &["env"],
    &["vector"],
    &["runs"],
    &["policy"],
    &["eval"],
    &["report"],
];

/// Returns the line of a room in [`ROOMS`].
fn floor(room: &str) -> usize {
    ROOMS
        .iter()
        .position(|rooms| rooms.contains(&room))
        .unwrap_or_else(|| panic!("src/{room} has no place in the order of rooms"))
}

/// Lists the Rust files at and below a path.
fn files(path: &Path, out: &mut Vec<PathBuf>) {
    if path.is_dir() {
        for entry in std::fs::read_dir(path).expect("a source folder") {
            files(&entry.expect("readable").path(), out);
        }
    } else if path.extension().is_some_and(|e| e == "rs") {
        out.push(path.to_path_buf());
    }
}

/// Returns the words `word` in `word::` and in the first level of `{word::.., word}` behind each `prefix`.
fn named_behind<'t>(code: &'t str, prefix: &str) -> BTreeSet<&'t str> {
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        let rest = &code[at + prefix.len()..];
        let word = |text: &'t str| -> &'t str {
            let end = text.find(|c: char| !c.is_alphanumeric() && c != '_');
            &text[..end.unwrap_or(text.len())]
        };
        match rest.strip_prefix('{') {
            None => drop(names.insert(word(rest))),
            Some(list) => {
                let mut depth = 0;
                let mut start = true;
                for (k, c) in list.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => start = true,
                        c if start && depth == 0 && !c.is_whitespace() => {
                            names.insert(word(&list[k..]));
                            start = false;
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    names
}

/// Returns the code of a file: no comments, no strings that span lines.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("UTF-8");
    text.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(|line| line.split(" // ").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Returns the other rooms that each room's files name, tests included.
fn doors() -> BTreeMap<String, BTreeMap<String, PathBuf>> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut doors: BTreeMap<String, BTreeMap<String, PathBuf>> = BTreeMap::new();
    for entry in std::fs::read_dir(&src).expect("the sources") {
        let path = entry.expect("readable").path();
        let room = path.file_stem().expect("a name").to_string_lossy().into_owned();
        if room == "lib" {
            continue;
        }
        let mut sources = Vec::new();
        files(&path, &mut sources);
        let known = doors.entry(room.clone()).or_default();
        for file in sources {
            for other in named_behind(&code(&file), "crate::") {
                if other != room {
                    known.insert(other.to_string(), file.clone());
                }
            }
        }
    }
    doors
}

/// Tells what a name at the crate's root stands for, if it is not a room.
fn room_of(name: &str) -> &str {
    match name {
        "Config" => "config",
        "Model" => "model",
        "Limits" => "limits",
        "Env" | "Blueprint" | "EnvError" | "Info" | "Observation" | "Step" => "env",
        "AutoresetMode" | "VectorEnv" | "VectorOptions" => "vector",
        "make_env" => "runs",
        room => room,
    }
}

#[test]
fn invariant_13_rooms_use_only_what_is_below_them() {
    let mut wrong = Vec::new();
    let mut opened = 0;
    for (room, others) in doors() {
        let own = floor(&room);
        for (name, file) in others {
            let other = room_of(&name);
            if other == room {
                continue;
            }
            opened += 1;
            if floor(other) >= own {
                wrong.push(format!("{room} uses {other} ({})", file.display()));
            }
        }
    }
    assert!(
        opened > 40,
        "only {opened} doors were found: does the test still read the code?"
    );
    assert!(wrong.is_empty(), "doors that lead up:\n{}", wrong.join("\n"));
}

#[test]
fn names_behind_a_prefix_are_found_in_lists_and_paths() {
    let text = "use crate::{model::{Model, x}, env,\n config::Config}; crate::eval::f(); let x: crate::Env;";
    let found: Vec<_> = named_behind(text, "crate::").into_iter().collect();
    assert_eq!(found, ["Env", "config", "env", "eval", "model"]);
}
