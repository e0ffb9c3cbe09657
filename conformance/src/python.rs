//! The Python in which the kit and MuJoCo's renderer run.

use std::path::{Path, PathBuf};
use std::process::Command;

use testkit::yardsticks::kit_python;

/// Packages that Python must have, as messages name them.
pub const NEEDS: &str = "the packages of conformance/scripts/kit_requirements.txt in the Python that the variable PYTHON names \
                         (or that is made in target/python-kit), and OSMesa (Debian, Ubuntu: apt install libosmesa6)";

/// Returns the Python that the variable `PYTHON` names, or an environment in `target/python-kit`, which is created if necessary.
///
/// # Errors
/// The reason why it could not be created.
pub fn find() -> Result<PathBuf, String> {
    kit_python().map_err(|e| format!("there is no Python to compare with: {e}; it needs {NEEDS}"))
}

/// Returns a command that runs `python` in one thread, with pictures drawn by OSMesa.
pub fn command(python: &Path) -> Command {
    let mut command = Command::new(python);
    command.env("MUJOCO_GL", "osmesa");
    // 0 threads beside its own: they only cost the renderer time
    command.env("LP_NUM_THREADS", "0");
    for pool in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"] {
        command.env(pool, "1");
    }
    command
}

/// Returns the path of a script of `conformance/scripts`.
pub fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(name)
}
