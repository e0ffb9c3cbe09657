//! Invariant 13: rooms look down, never up, as the picture in `ARCHITECTURE.md` shows them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A line of the picture: rooms, and the rooms that their arrows lead to.
struct Line {
    rooms: Vec<String>,
    arrows: BTreeSet<String>,
}

/// Reads the picture of rooms, from the top down.
fn picture() -> Vec<Line> {
    let text = include_str!("../../../ARCHITECTURE.md");
    let section = text.split("## The rooms").nth(1).expect("a section on rooms");
    let block = section.split("```").nth(1).expect("a picture");
    let words = |list: &str| list.split(',').map(|word| word.trim().to_string()).collect::<Vec<_>>();
    block
        .lines()
        .filter(|line| !line.is_empty())
        .map(|line| match line.split_once(" ─> ") {
            Some((room, others)) => Line {
                rooms: words(room),
                arrows: words(others).into_iter().collect(),
            },
            None => Line {
                rooms: words(line),
                arrows: BTreeSet::new(),
            },
        })
        .collect()
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

/// Returns the code of a file, without its unit tests: no comments, no strings that span lines.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("UTF-8");
    let is_test =
        path.components().any(|part| part.as_os_str() == "tests") || path.to_string_lossy().ends_with("tests.rs");
    let text = if is_test {
        ""
    } else {
        text.split("#[cfg(test)]").next().unwrap_or_default()
    };
    text.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(|line| line.split(" // ").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Returns the other rooms that the code of each room names, each with a file that does.
fn doors() -> BTreeMap<String, BTreeMap<String, PathBuf>> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut doors: BTreeMap<String, BTreeMap<String, PathBuf>> = BTreeMap::new();
    for entry in std::fs::read_dir(&src).expect("the sources") {
        let path = entry.expect("readable").path();
        let room = path.file_stem().expect("a name").to_string_lossy().into_owned();
        // crates of their own look after themselves
        if room == "lib" || path.join("Cargo.toml").exists() {
            continue;
        }
        let mut sources = Vec::new();
        files(&path, &mut sources);
        let known = doors.entry(room.clone()).or_default();
        for file in sources {
            let code = code(&file);
            for other in named_behind(&code, "crate::") {
                let other = room_of(other);
                if other != room {
                    known.insert(other.to_string(), file.clone());
                }
            }
            if code.contains("mjcf_sim::") {
                known.insert("engine".to_string(), file.clone());
            }
        }
    }
    doors.insert("engine".to_string(), BTreeMap::new());
    doors
}

/// Returns the room of a name at the crate's root.
fn room_of(name: &str) -> &str {
    match name {
        "Config" => "config",
        // what lib.rs re-exports of the engine's crates
        "Limits" | "Model" | "assets" | "files" | "limits" | "math" | "mjcf_loader" | "model" | "physics"
        | "rapier" | "render" | "pool" | "text" | "threads" => "engine",
        "Env" | "Blueprint" | "EnvError" | "Info" | "Observation" | "Step" => "env",
        "AutoresetMode" | "VectorEnv" | "VectorOptions" => "vector",
        "make_env" => "runs",
        room => room,
    }
}

/// Returns a room and all rooms that it uses, directly or through others.
fn reached(room: &str, doors: &BTreeMap<String, BTreeMap<String, PathBuf>>) -> BTreeSet<String> {
    let mut found = BTreeSet::from([room.to_string()]);
    let mut rest = vec![room.to_string()];
    while let Some(room) = rest.pop() {
        for other in doors.get(&room).into_iter().flat_map(BTreeMap::keys) {
            if found.insert(other.clone()) {
                rest.push(other.clone());
            }
        }
    }
    found
}

#[test]
fn invariant_13_rooms_use_only_what_is_below_them() {
    let (doors, picture) = (doors(), picture());
    let line = |room: &str| {
        let line = picture.iter().position(|line| line.rooms.iter().any(|r| r == room));
        line.unwrap_or_else(|| panic!("src/{room} has no place in ARCHITECTURE.md"))
    };
    let mut wrong = Vec::new();
    let mut opened = 0;
    for (room, others) in &doors {
        for (other, file) in others {
            opened += 1;
            if line(other) <= line(room) {
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
fn the_picture_of_rooms_is_drawn_from_the_code() {
    let doors = doors();
    let drawn = picture();
    let count: usize = drawn.iter().map(|line| line.rooms.len()).sum();
    assert_eq!(count, doors.len(), "a room is missing, drawn twice, or gone");
    for Line { rooms, arrows } in drawn {
        for room in rooms {
            let direct: BTreeSet<String> = doors[&room].keys().cloned().collect();
            let spared = |other: &String| {
                direct
                    .iter()
                    .any(|via| via != other && reached(via, &doors).contains(other))
            };
            let needed: BTreeSet<String> = direct.iter().filter(|other| !spared(other)).cloned().collect();
            let list = needed.iter().cloned().collect::<Vec<_>>().join(", ");
            assert_eq!(arrows, needed, "ARCHITECTURE.md should say: {room} ─> {list}");
        }
    }
}

#[test]
fn names_behind_a_prefix_are_found_in_lists_and_paths() {
    let text = "use crate::{model::{Model, x}, env,\n config::Config}; crate::eval::f(); let x: crate::Env;";
    let found: Vec<_> = named_behind(text, "crate::").into_iter().collect();
    assert_eq!(found, ["Env", "config", "env", "eval", "model"]);
}

/// Returns the path of a file's module in its crate.
fn module_of(file: &Path, root: &Path) -> Vec<String> {
    let inside = file.strip_prefix(root).expect("below its crate").with_extension("");
    let mut path: Vec<String> = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    path.pop_if(|last| ["mod", "lib", "main"].contains(&&**last));
    path
}

#[test]
fn paths_and_visibility_follow_the_rule_of_the_architecture() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let crates = [
        "src/physics/rapier",
        "src/physics",
        "src/mjcf_loader",
        "src/render",
        "src/model",
        "engine/src",
        "src",
        "cli/src",
    ];
    let mut sources = Vec::new();
    for folder in ["src", "engine/src", "cli/src"].map(|folder| home.join(folder)) {
        files(&folder, &mut sources);
    }
    let mut wrong = Vec::new();
    for file in &sources {
        let code = code(file);
        let root = crates
            .iter()
            .map(|folder| home.join(folder))
            .find(|root| file.starts_with(root));
        let module = module_of(file, &root.expect("it is in a crate"));
        let parent = module.split_last().map_or(&[][..], |(_, parent)| parent);
        let of_parent = format!("\nuse crate::{}::", parent.join("::"));
        for (found, advice) in [
            ("pub(in ", "pub(super) or pub(crate)"),
            ("super::super::", "crate::"),
            (&*of_parent, "super::"),
        ] {
            if code.contains(found) && (found != of_parent || !parent.is_empty()) {
                wrong.push(format!(
                    "{}: use {advice} instead of {:?}",
                    file.display(),
                    found.trim()
                ));
            }
        }
    }
    assert!(sources.len() > 500, "only {} files were read", sources.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
