//! Documents that people have, MuJoCo 3.3.0 and ours side by side.
//!
//! [`find`] lists the documents under some folders, [`World::compare`] puts one beside MuJoCo, and [`table`] writes what came out, for
//! people and for programs.

mod find;
mod measure;
pub mod table;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use babybench::assets::FileSystem;
use babybench::mjcf_loader::load;
use babybench::physics::compile;

pub use find::{Document, find};
pub use measure::{Figures, Rollout};

use crate::differential::compare::Sides;
use crate::live::parallel;
use crate::mujoco::{Mujoco, Simulation};

/// Result of giving a document to both sides.
pub enum Outcome {
    /// MuJoCo refuses it, or it is a part of another document: it does not count.
    NoDocument,
    /// Ours takes what MuJoCo refuses, and why that refuses it.
    OursAlone(String),
    /// Ours refuses it, and why.
    Refused(String),
    /// Both take it.
    Both(Box<Figures>),
}

/// A document beside MuJoCo.
pub struct World {
    /// The folder that was asked for.
    pub folder: PathBuf,
    /// Its path in that folder.
    pub path: String,
    /// Result of giving it to both sides.
    pub outcome: Outcome,
}

impl World {
    /// Compares a document of a folder.
    pub fn compare(api: &'static Mujoco, document: &Document) -> Self {
        Self {
            folder: document.folder.clone(),
            path: document.path.clone(),
            outcome: outcome(api, &document.folder, &document.path),
        }
    }
}

fn outcome(api: &'static Mujoco, folder: &Path, path: &str) -> Outcome {
    // below a relative path MuJoCo does not find what an included document has beside it
    let folder = &std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf());
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
    let all = parallel(&documents, || (), |(), document| World::compare(api, document));
    let counts = |world: &World| !matches!(world.outcome, Outcome::NoDocument);
    Ok(all.into_iter().filter(counts).collect())
}
