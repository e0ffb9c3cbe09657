//! The real MuJoCo, loaded at run time; it is not needed to build.
//!
//! `conformance/scripts/fetch_mujoco.sh` puts releases into `target/mujoco/VERSION/`. [`Simulation`] is release 3.3.0 with all its
//! arrays, by the offsets that `scripts/mujoco_offsets.py` took from its headers. [`Release`] is any release, and reads only the state.

mod api;
pub mod layout;
#[path = "generated/offsets.rs"]
pub mod offsets;
mod release;
mod simulation;

pub use api::Mujoco;
pub use release::{Release, load};
pub use simulation::{Contact, Simulation};

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use testkit::harness::Need;
use testkit::yardsticks::{REQUIRED, set_up};

/// The release that babybench reproduces.
pub const REFERENCE: &str = "3.3.0";

/// Returns the folder into which a release is fetched.
pub fn folder(version: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../target/mujoco")
        .join(version)
}

/// Lists the releases that have been fetched, oldest first.
pub fn fetched() -> Vec<String> {
    let entries = std::fs::read_dir(folder("")).into_iter().flatten();
    let names = entries.filter_map(|e| e.ok()?.file_name().into_string().ok());
    let mut versions: Vec<String> = names.filter(|v| library(v).is_file()).collect();
    versions.sort_by_key(|v| v.split('.').map(|n| n.parse().unwrap_or(0)).collect::<Vec<u32>>());
    versions
}

fn library(version: &str) -> PathBuf {
    folder(version).join(format!("mujoco/libmujoco.so.{version}"))
}

/// Returns MuJoCo 3.3.0, loaded once.
///
/// # Errors
/// It is missing (the message says how to get it), it cannot be loaded, or it is another release.
pub fn reference() -> Result<&'static Mujoco, String> {
    static LOADED: OnceLock<Result<Mujoco, String>> = OnceLock::new();
    let load = || {
        let path = library(REFERENCE);
        if !path.is_file() {
            return Err(format!(
                "MuJoCo {REFERENCE} is not at {}: run conformance/scripts/fetch_mujoco.sh",
                folder(REFERENCE).display()
            ));
        }
        let mujoco = Mujoco::load(&path)?;
        match mujoco.version() {
            offsets::VERSION => Ok(mujoco),
            other => Err(format!(
                "{} calls itself {other}, the offsets are those of {}: fetch it again",
                path.display(),
                offsets::VERSION
            )),
        }
    };
    LOADED.get_or_init(load).as_ref().map_err(String::clone)
}

/// MuJoCo 3.3.0, fetched if it is missing.
pub const MUJOCO: Need = Need::new("MuJoCo", Some(REQUIRED), || {
    set_up("fetch_mujoco.sh", &[], &library(REFERENCE))?;
    reference().map(drop)
});

/// Returns MuJoCo 3.3.0 to a test that has the need [`MUJOCO`].
///
/// # Panics
/// If it is missing.
pub fn needed() -> &'static Mujoco {
    reference().unwrap_or_else(|e| panic!("{e}"))
}
