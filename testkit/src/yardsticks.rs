//! References for tests that are not in the repository: they are found, or set up by the scripts in `conformance/scripts`.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime};

use crate::harness::Need;

/// The variable with which a reference that cannot be set up is a failure: `MUJOCO_CONFORMANCE=required`.
pub const REQUIRED: &str = "MUJOCO_CONFORMANCE";

/// A Python with NumPy.
pub const PYTHON: Need = Need::new("Python", Some(REQUIRED), || python().map(drop));

/// A Python with MuJoCo, whose wheels do not cover every Python version.
pub const PYTHON_MUJOCO: Need = Need::new("MuJoCo in Python", None, || {
    let python = python()?;
    has_module(&python, "mujoco")
});

/// A checkout of the BabyBench starter kit.
pub const KIT: Need = Need::new("kit", None, || kit().map(drop));

/// Time after a failure during which other processes do not retry.
const PATIENCE: Duration = Duration::from_secs(600);

/// Returns the folder of the workspace.
pub fn workspace() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own)
}

/// Returns the folder of the BabyBench starter kit, which the variable `BABYBENCH_KIT` names.
///
/// # Errors
/// Returns the reason: the variable is not set, or its folder is not the kit.
pub fn kit() -> Result<PathBuf, String> {
    let folder = std::env::var_os("BABYBENCH_KIT").ok_or(
        "BABYBENCH_KIT names no checkout of the BabyBench starter kit, whose files are not part of this repository",
    )?;
    let folder = workspace().join(folder);
    check_kit(&folder)
        .map(|()| folder)
        .map_err(|e| format!("BABYBENCH_KIT: {e}"))
}

/// Returns whether a folder is a checkout of the BabyBench starter kit.
///
/// # Errors
/// Returns what is missing.
pub fn check_kit(folder: &Path) -> Result<(), String> {
    for part in ["MIMo/mimoEnv/assets/babybench", "babybench/utils.py"] {
        let part = folder.join(part);
        if !part.exists() {
            return Err(format!(
                "{} is no checkout of the BabyBench starter kit: there is no {}",
                folder.display(),
                part.display()
            ));
        }
    }
    Ok(())
}

/// Returns the folder with the kit's MJCF and textures.
///
/// # Errors
/// Those of [`kit`].
pub fn kit_assets() -> Result<PathBuf, String> {
    Ok(kit()?.join("MIMo/mimoEnv/assets"))
}

/// Returns a Python with NumPy: the one that the variable `PYTHON` names, or an environment in `target/python`, which is created if
/// necessary.
///
/// # Errors
/// Returns what is missing.
pub fn python() -> Result<PathBuf, String> {
    python_with("numpy", "target/python", &[])
}

/// Returns a Python that runs the BabyBench starter kit: the one that the variable `PYTHON` names, or an environment in
/// `target/python-kit`, which is created if necessary.
///
/// # Errors
/// Returns what is missing.
pub fn kit_python() -> Result<PathBuf, String> {
    python_with("mujoco", "target/python-kit", &["kit"])
}

/// Returns the Python that the variable `PYTHON` names, which must have a module, or an environment that
/// `fetch_python.sh` makes.
fn python_with(module: &str, environment: &str, arguments: &[&str]) -> Result<PathBuf, String> {
    if let Some(python) = std::env::var_os("PYTHON") {
        let python = PathBuf::from(python);
        return has_module(&python, module).map(|()| python);
    }
    let environment = workspace().join(environment);
    set_up("fetch_python.sh", arguments, &environment.join("ready"))?;
    Ok(environment.join("bin/python"))
}

fn has_module(python: &Path, module: &str) -> Result<(), String> {
    let import = format!("import {module}");
    let found = Command::new(python).args(["-c", import.as_str()]).output();
    if found.is_ok_and(|out| out.status.success()) {
        Ok(())
    } else {
        Err(format!("{} has no module {module}", python.display()))
    }
}

/// Runs a script of `conformance/scripts` with its arguments unless `result` is there. Processes take turns; after a failure they share its
/// reason for ten minutes instead of trying again.
///
/// # Errors
/// Returns why the script failed.
pub fn set_up(script: &str, arguments: &[&str], result: &Path) -> Result<(), String> {
    if result.exists() {
        return Ok(());
    }
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return Err(format!("conformance/scripts/{script} works on 64-bit Linux only"));
    }
    let target = workspace().join("target");
    let name = [&[script], arguments].concat().join("-");
    let failed = target.join(format!("{name}.failed"));
    let lock = std::fs::create_dir_all(&target)
        .and_then(|()| File::create(target.join(format!("{name}.lock"))))
        .and_then(|file| file.lock().map(|()| file))
        .map_err(|e| format!("{}: {e}", target.display()))?;
    if result.exists() {
        return Ok(());
    }
    if let Some(reason) = recent(&failed) {
        return Err(reason);
    }
    let outcome = run_script(script, arguments);
    match &outcome {
        Ok(()) => drop(std::fs::remove_file(&failed)),
        Err(reason) => drop(std::fs::write(&failed, reason)),
    }
    drop(lock);
    outcome
}

/// Returns the reason of a recent failure.
fn recent(failed: &Path) -> Option<String> {
    let written = failed.metadata().and_then(|about| about.modified()).ok()?;
    let age = SystemTime::now().duration_since(written).unwrap_or_default();
    (age < PATIENCE).then(|| std::fs::read_to_string(failed).ok()).flatten()
}

fn run_script(script: &str, arguments: &[&str]) -> Result<(), String> {
    let path = workspace().join("conformance/scripts").join(script);
    let words = [&[script], arguments].concat().join(" ");
    eprintln!("running conformance/scripts/{words}, once");
    let out = Command::new("bash")
        .arg(&path)
        .args(arguments)
        .stdin(Stdio::null())
        .output();
    let out = out.map_err(|e| format!("bash does not start: {e}"))?;
    if out.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&out.stderr);
    let last = said.lines().rev().find(|line| !line.trim().is_empty());
    let last = last.unwrap_or("it does not say why").trim();
    Err(format!("conformance/scripts/{words} failed: {last}"))
}
