//! Recordings of the reference, in a directory `shared/golden` beside the repository.

use std::path::{Path, PathBuf};

use babybench::config::{Compat, Config};
use babybench::eval::{Recording, Replay, replay};
use babybench::npz::Npz;
use babybench::{Blueprint, Env};

/// A recording with its configuration.
pub struct Golden {
    /// Name.
    pub name: String,
    /// Configuration, under `compat: reference`.
    pub config: Config,
    /// Arrays.
    pub npz: Npz,
    /// The recording's floor: joint rms distance (rad) per step of MuJoCo from 1e-7 away, twice.
    pub floor: Option<Vec<f64>>,
}

/// Why tests skip what they compare with companion material.
pub const NO_SHARED: &str = "no directory ../shared beside the repository";

/// The directory of companion material beside the repository, if it is there.
pub fn shared() -> Option<PathBuf> {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    dir.is_dir().then_some(dir)
}

/// Recordings of an actuation model. Says so when there are none.
pub fn golden(actuation: &str) -> Vec<Golden> {
    let Some(dir) = shared().map(|d| d.join("golden")) else {
        crate::skipped("recordings", NO_SHARED);
        return Vec::new();
    };
    let mut names: Vec<String> = std::fs::read_dir(&dir)
        .into_iter()
        .flatten()
        .filter_map(|e| {
            Some(
                e.ok()?
                    .file_name()
                    .into_string()
                    .ok()?
                    .strip_suffix(".yml")?
                    .to_string(),
            )
        })
        .collect();
    names.sort();
    assert!(!names.is_empty(), "{} holds no recording", dir.display());
    names
        .into_iter()
        .filter_map(|name| {
            let text = std::fs::read_to_string(dir.join(format!("{name}.yml"))).expect("readable configuration");
            let base = Config {
                compat: Compat::Reference,
                ..Config::default()
            };
            let config = base.overlay_yaml(&text, &name).expect("valid configuration");
            if config.actuation_model.name() != actuation {
                return None;
            }
            let npz = Npz::open(dir.join(format!("{name}.npz"))).expect("readable recording");
            let floor = Npz::open(dir.join(format!("{name}_floor.npz")))
                .ok()
                .map(|f| f.get_f64("rms").expect("floor has rms"))
                .map(|a| {
                    let t = a.shape[1];
                    (0..t).map(|k| 0.5 * (a.data[k] + a.data[t + k])).collect()
                });
            Some(Golden {
                name,
                config,
                npz,
                floor,
            })
        })
        .collect()
}

impl Golden {
    /// An environment of the recording's configuration.
    pub fn env(&self) -> Env {
        Blueprint::new(self.config.clone())
            .and_then(|b| b.env())
            .expect("the environment builds")
    }

    /// Replays the recording.
    pub fn replay(&self, env: &mut Env, one_step: bool) -> (Recording, Replay) {
        let recording = Recording::read(&self.npz, env).expect("the recording fits");
        let result = replay(env, &recording, one_step).expect("the replay runs");
        (recording, result)
    }
}
