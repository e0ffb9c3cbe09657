//! Any release of MuJoCo. Only its state is read, so no offsets are needed.

use super::api::{Handle, Mujoco};
use super::{folder, library};

/// Names and, once read, bits of the parts of a state. Their numbers change between releases, so they come from the
/// release's own headers.
const PARTS: [&str; 5] = ["QPOS", "QVEL", "WARMSTART", "CTRL", "EQ_ACTIVE"];

/// A scene in a release.
pub struct Release {
    api: &'static Mujoco,
    /// The release, such as `3.4.0`.
    pub version: String,
    bits: [u32; PARTS.len()],
    model: Handle,
    data: Handle,
}

impl Drop for Release {
    fn drop(&mut self) {
        // SAFETY: both were made by the constructor and are used by nothing else.
        unsafe {
            (self.api.delete_data)(self.data);
            (self.api.delete_model)(self.model);
        }
    }
}

/// Loads a release for as long as the program runs.
///
/// # Errors
/// It is not there, and how to get it; it cannot be loaded.
pub fn load(version: &str) -> Result<&'static Mujoco, String> {
    let path = library(version);
    if !path.is_file() {
        return Err(format!(
            "MuJoCo {version} is missing: run conformance/scripts/fetch_mujoco.sh {version}"
        ));
    }
    Ok(Box::leak(Box::new(Mujoco::load(&path)?)))
}

/// Reads the bit of each part of the state from the headers, such as `mjSTATE_QPOS = 1<<1`.
fn bits(version: &str) -> Result<[u32; PARTS.len()], String> {
    let headers = folder(version).join("mujoco/include/mujoco");
    let mut text = String::new();
    for entry in std::fs::read_dir(&headers).map_err(|e| format!("{}: {e}", headers.display()))? {
        let path = entry.map_err(|e| e.to_string())?.path();
        text += &std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    let mut out = [0; PARTS.len()];
    for (bit, part) in out.iter_mut().zip(PARTS) {
        let name = format!("mjSTATE_{part} ");
        let value = text.lines().find_map(|line| {
            let (_, shift) = line.trim().strip_prefix(name.as_str())?.split_once("1<<")?;
            shift.split(',').next()?.trim().parse::<u32>().ok()
        });
        *bit = 1 << value.ok_or(format!("the headers of MuJoCo {version} do not define mjSTATE_{part}"))?;
    }
    Ok(out)
}

impl Release {
    /// Compiles the file `path` in the release `api`.
    ///
    /// # Errors
    /// MuJoCo's message; headers that are not there.
    pub fn new(api: &'static Mujoco, version: &str, path: &str) -> Result<Self, String> {
        let bits = bits(version)?;
        let model = api.compile(path, &[])?;
        // SAFETY: the model is valid.
        let data = unsafe { (api.make_data)(model) };
        let version = version.to_string();
        Ok(Self {
            api,
            version,
            bits,
            model,
            data,
        })
    }

    fn set(&mut self, part: usize, values: &[f64]) {
        let bit = self.bits[part];
        // SAFETY: the length is checked against MuJoCo's own.
        unsafe {
            let n = (self.api.state_size)(self.model, bit);
            assert_eq!(
                usize::try_from(n),
                Ok(values.len()),
                "MuJoCo {}: size of {}",
                self.version,
                PARTS[part]
            );
            (self.api.set_state)(self.model, self.data, values.as_ptr(), bit);
        }
    }

    fn get(&self, part: usize) -> Vec<f64> {
        let bit = self.bits[part];
        // SAFETY: the buffer has the size that MuJoCo asks for.
        unsafe {
            let n = (self.api.state_size)(self.model, bit);
            let mut out = vec![0.0; usize::try_from(n).unwrap_or(0)];
            (self.api.get_state)(self.model, self.data, out.as_mut_ptr(), bit);
            out
        }
    }

    /// Sets positions, velocities, the solver's warm start and which equalities are active.
    pub fn set_state(&mut self, qpos: &[f64], qvel: &[f64], warmstart: &[f64], eq_active: &[bool]) {
        self.set(0, qpos);
        self.set(1, qvel);
        self.set(2, warmstart);
        let active: Vec<f64> = eq_active.iter().map(|&v| f64::from(u8::from(v))).collect();
        self.set(4, &active);
    }

    /// Advances by one time step with these controls.
    pub fn step(&mut self, ctrl: &[f64]) {
        self.set(3, ctrl);
        // SAFETY: model and data are valid.
        unsafe { (self.api.step)(self.model, self.data) }
    }

    /// Returns the positions.
    pub fn qpos(&self) -> Vec<f64> {
        self.get(0)
    }

    /// Returns the velocities.
    pub fn qvel(&self) -> Vec<f64> {
        self.get(1)
    }

    /// Returns the acceleration of the last step, which is the warm start of the next step's solver.
    pub fn qacc(&self) -> Vec<f64> {
        self.get(2)
    }
}
