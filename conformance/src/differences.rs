//! Compares documents with MuJoCo: random ones, keeping those that differ, and public ones.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

use conformance::differential::reduce::reduce;
use conformance::differential::{in_child, run_in_processes, write_finding};
use conformance::mujoco::reference;
use conformance::worlds::{self, compare_in_processes, table};

/// Makes commands that let this program compare a range of documents.
fn child(arguments: &[&str]) -> Result<impl Fn(&Range<u64>) -> Command + Sync, String> {
    let program = std::env::current_exe().map_err(|e| format!("this program: {e}"))?;
    let arguments: Vec<String> = arguments.iter().map(|argument| argument.to_string()).collect();
    Ok(move |range: &Range<u64>| {
        let mut command = Command::new(&program);
        command.args(&arguments);
        command.args(["--from", &range.start.to_string(), "--to", &range.end.to_string()]);
        command
    })
}

/// Compares `count` documents of a seed, prints the table, and writes the smallest documents that differ into `keep`.
///
/// # Errors
/// MuJoCo is missing, a folder cannot be written to, the sides differ.
pub fn print(count: u64, seed: u64, keep: Option<&Path>) -> Result<(), String> {
    let api = reference()?;
    let seed_text = seed.to_string();
    let tally = run_in_processes(count, child(&["differential", "--seed", &seed_text])?)?;
    println!("{count} documents of seed {seed}\n\n{tally}");
    for (k, finding) in tally.findings().into_iter().enumerate() {
        println!(
            "{}: error {:.1e}, ours {}",
            finding.quantity, finding.error, finding.place
        );
        if let Some(folder) = keep {
            let small = reduce(api, finding);
            let name: String = small
                .quantity
                .chars()
                .map(|c| if c.is_alphanumeric() { c } else { '_' })
                .collect();
            let path = folder.join(format!("{name}_{seed}_{k}.xml"));
            std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
            std::fs::write(&path, write_finding(&small)).map_err(|e| format!("{}: {e}", path.display()))?;
            println!("    {}", path.display());
        }
    }
    match tally.differences() {
        0 => Ok(()),
        n => Err(format!("the sides differ in {n} quantities of documents and states")),
    }
}

/// Compares documents `from..to` of a seed for the process that started this one.
///
/// # Errors
/// MuJoCo is missing, a closed output.
pub fn print_part(seed: u64, range: Range<u64>) -> Result<(), String> {
    in_child(reference()?, seed, range)
}

fn paths(folders: &[String]) -> Vec<PathBuf> {
    folders.iter().map(PathBuf::from).collect()
}

/// Compares documents `range` of those under some folders for the process that started this one.
///
/// # Errors
/// MuJoCo is missing, a folder cannot be read, a closed output.
pub fn print_worlds_part(folders: &[String], range: Range<u64>) -> Result<(), String> {
    worlds::in_child(reference()?, &paths(folders), range)
}

/// Compares all documents under some folders, prints the tables, and writes everything into `json`.
///
/// # Errors
/// MuJoCo is missing, a folder cannot be read, a file cannot be written, or the sides disagree about a document.
pub fn print_worlds(folders: &[String], json: Option<&Path>) -> Result<(), String> {
    if folders.is_empty() {
        return Err(
            "conformance worlds: name a folder, such as target/worlds/gymnasium (conformance/scripts/fetch_worlds.sh)"
                .to_owned(),
        );
    }
    let names: Vec<&str> = std::iter::once("worlds")
        .chain(folders.iter().map(String::as_str))
        .collect();
    let worlds = compare_in_processes(&paths(folders), child(&names)?)?;
    print!("{}", table::text(&worlds));
    if let Some(file) = json {
        let text = format!("{:#}\n", table::json(&worlds));
        std::fs::write(file, text).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    match table::faults(&worlds) {
        0 => Ok(()),
        n => Err(format!("{n} documents mean something else to MuJoCo")),
    }
}
