//! Existing documents in MuJoCo 3.3.0 and in ours, side by side.
//!
//! [`find`] lists the documents under some folders, [`compare_all`] compares them with MuJoCo, and [`table`] writes the results, for
//! people and for programs.

mod find;
mod measure;
pub mod table;

use std::ops::Range;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;

use babybench::assets::FileSystem;
use babybench::mjcf_loader::load;
use babybench::physics::compile;

pub use find::{Document, find};
pub use measure::{Figures, Rollout};
use serde::{Deserialize, Serialize};

use crate::differential::compare::Sides;
use crate::live::parallel;
use crate::mujoco::{Mujoco, Simulation};
use crate::processes::{self, Ran};

/// Result of giving a document to both sides.
#[derive(Deserialize, Serialize)]
pub enum Outcome {
    /// MuJoCo refuses it, or it is a part of another document: it does not count.
    NoDocument,
    /// Ours accepts what MuJoCo refuses, with MuJoCo's reason.
    OursAlone(String),
    /// Ours refuses it, and why.
    Refused(String),
    /// Both accept it.
    Both(Box<Figures>),
    /// MuJoCo accesses memory out of bounds while it loads or steps the document.
    Fell,
}

/// A document compared with MuJoCo.
pub struct World {
    /// The requested folder.
    pub folder: PathBuf,
    /// Its path in that folder.
    pub path: String,
    /// Result of giving it to both sides.
    pub outcome: Outcome,
}

fn outcome(api: &'static Mujoco, Document { folder, path }: &Document) -> Outcome {
    // below a relative path MuJoCo does not find what an included document has beside it
    let folder = &std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
    let ours = load(&FileSystem::new(folder), path)
        .and_then(compile)
        .map_err(|e| e.to_string());
    let theirs = Simulation::new(api, &folder.join(path).to_string_lossy(), &[]);
    match (ours, theirs) {
        (Err(_), Err(_)) => Outcome::NoDocument,
        (Ok(_), Err(e)) => Outcome::OursAlone(e.trim().to_owned()),
        (Err(e), Ok(_)) => Outcome::Refused(e),
        (Ok(model), Ok(simulation)) => {
            let mut sides = Sides::new(Arc::new(model), simulation);
            Outcome::Both(Box::new(measure::figures(&mut sides)))
        }
    }
}

/// Compares all documents under some folders.
///
/// # Errors
/// A folder that cannot be read.
pub fn compare_all(api: &'static Mujoco, folders: &[PathBuf]) -> Result<Vec<World>, String> {
    let documents = find(folders)?;
    let all = parallel(&documents, || (), |(), document| outcome(api, document));
    Ok(counted(documents, all))
}

/// Compares all documents under some folders in other processes, so that a crash of MuJoCo affects no other document. `child` makes the command that
/// calls [`in_child`] for a range of them.
///
/// # Errors
/// A folder that cannot be read; as [`processes::run`].
pub fn compare_in_processes(
    folders: &[PathBuf],
    child: impl Fn(&Range<u64>) -> Command + Sync,
) -> Result<Vec<World>, String> {
    let documents = find(folders)?;
    let ran = processes::run(documents.len() as u64, 8, child)?;
    let outcomes = ran.into_iter().map(|ran| match ran {
        Ran::Done(outcome) => outcome,
        Ran::Fell => Outcome::Fell,
    });
    Ok(counted(documents, outcomes))
}

/// Compares a range of the documents under some folders in this process, and reports to its parent.
///
/// # Errors
/// A folder that cannot be read, a closed output.
pub fn in_child(api: &'static Mujoco, folders: &[PathBuf], range: Range<u64>) -> Result<(), String> {
    let documents = find(folders)?;
    processes::in_child(range, |k| {
        let document = documents.get(k as usize);
        document.map_or(Outcome::NoDocument, |document| outcome(api, document))
    })
}

/// Combines documents and results, except those that count for neither side.
fn counted(documents: Vec<Document>, outcomes: impl IntoIterator<Item = Outcome>) -> Vec<World> {
    let all = documents.into_iter().zip(outcomes).map(|(document, outcome)| World {
        folder: document.folder,
        path: document.path,
        outcome,
    });
    all.filter(|world| !matches!(world.outcome, Outcome::NoDocument))
        .collect()
}
