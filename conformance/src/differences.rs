//! Prints how documents fare beside MuJoCo: random ones, of which it keeps what differs, and those that people have.

use std::path::{Path, PathBuf};

use conformance::differential::reduce::reduce;
use conformance::differential::{run, write_finding};
use conformance::mujoco::reference;
use conformance::worlds::{compare_all, table};

/// Compares `count` documents of a seed, prints the table, and writes the smallest documents that differ into `keep`.
///
/// # Errors
/// MuJoCo is missing, a folder cannot be written to, the sides differ.
pub fn print(count: u64, seed: u64, keep: Option<&Path>) -> Result<(), String> {
    let api = reference()?;
    let tally = run(api, seed, count)?;
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

/// Compares all documents under some folders, prints the tables, and writes everything into `json`.
///
/// # Errors
/// MuJoCo is missing, a folder cannot be read, a file cannot be written, the sides mean something else by a document.
pub fn print_worlds(folders: &[String], json: Option<&Path>) -> Result<(), String> {
    if folders.is_empty() {
        return Err(
            "conformance worlds: name a folder, such as target/worlds/gymnasium (conformance/scripts/fetch_worlds.sh)"
                .to_owned(),
        );
    }
    let folders: Vec<PathBuf> = folders.iter().map(PathBuf::from).collect();
    let worlds = compare_all(reference()?, &folders)?;
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
