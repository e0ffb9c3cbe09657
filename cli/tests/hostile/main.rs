//! Input that is meant to break the program: each is given to it in a process of its own, with a gibibyte of memory and five seconds of
//! processor time, and what it must answer stands in `expected.txt`.
//!
//! `UPDATE=yes` writes `expected.txt` anew, to be read before it is committed.
#![cfg(target_os = "linux")] // `prlimit`

#[path = "../../../tests/common/mod.rs"]
mod common;

mod archives;
mod arguments;
mod bytes;
mod case;
mod configurations;
mod documents;
mod files;
mod logs;
mod meshes;
mod models;
mod pictures;
mod policies;
mod runs;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use case::Case;

/// The answer that the program must give, by the name of the case.
const EXPECTED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile/expected.txt");
/// Cases that run side by side.
const THREADS: usize = 2;

fn cases() -> Vec<Case> {
    [
        configurations::cases(),
        documents::cases(),
        meshes::cases(),
        pictures::cases(),
        archives::cases(),
        logs::cases(),
        models::cases(),
        policies::cases(),
        files::cases(),
        runs::cases(),
        arguments::cases(),
    ]
    .concat()
}

/// Runs all cases; returns their answers by name.
fn answers(cases: &[Case]) -> BTreeMap<&str, String> {
    let (next, answers) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let answer = case.answer();
                    answers.lock().expect("no panic").insert(&*case.name, answer);
                }
            });
        }
    });
    answers.into_inner().expect("no panic")
}

/// Reads a file of answers: each has a line `== NAME` above it.
fn read(text: &str) -> BTreeMap<&str, String> {
    let mut out = BTreeMap::new();
    for block in text.split("== ").skip(1) {
        let (name, answer) = block.split_once('\n').expect("a name");
        out.insert(name, answer.to_string());
    }
    out
}

#[test]
fn hostile_input_gets_the_error_that_it_must_get() {
    let cases = cases();
    assert!(cases.len() >= 250, "{} cases", cases.len());
    let names: BTreeSet<&str> = cases.iter().map(|case| &*case.name).collect();
    assert_eq!(names.len(), cases.len(), "two cases have one name");
    let answers = answers(&cases);
    if std::env::var_os("UPDATE").is_some() {
        let mut text = String::new();
        for (name, answer) in &answers {
            write!(text, "== {name}\n{answer}").expect("a string");
        }
        std::fs::write(EXPECTED, text).expect("the file is written");
    }
    let text = std::fs::read_to_string(Path::new(EXPECTED)).expect("the answers");
    let (expected, mut faults) = (read(&text), String::new());
    for (name, answer) in &answers {
        let wanted = expected.get(name).map_or("nothing: it is not in expected.txt\n", |a| a);
        let broken = ["panicked", "overflowed its stack", "memory allocation of"];
        let ended = answer.starts_with("exit ") && !broken.iter().any(|b| answer.contains(b));
        if wanted != answer || !ended {
            write!(faults, "== {name}\nmust be:\n{wanted}is:\n{answer}\n").expect("a string");
        }
    }
    for name in expected.keys().filter(|name| !answers.contains_key(*name)) {
        writeln!(faults, "== {name}\nis in expected.txt, but there is no such case").expect("a string");
    }
    assert!(faults.is_empty(), "{faults}");
    println!("{} cases", answers.len());
}
