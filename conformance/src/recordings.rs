//! Recordings of the reference, in `data/recordings`.

use babybench::config::{Compat, Config, ConfigReader};
use babybench::formats::npz::Npz;
use babybench::runs::{Recording, Replay, replay};
use babybench::{Blueprint, Env};

use crate::data;

/// A recording with its configuration.
pub struct Golden {
    /// Its name.
    pub name: String,
    /// Its configuration, under `compat: reference`.
    pub config: Config,
    /// Its arrays.
    pub npz: Npz,
    /// Its floor: the joint rms distance (rad) per step of MuJoCo from 1e-7 away, mean of two runs.
    pub floor: Vec<f64>,
}

/// Reads the recordings of an actuation model.
pub fn golden(actuation: &str) -> Vec<Golden> {
    let all = data::names("recordings", ".yml").into_iter().map(Golden::read);
    all.filter(|golden| golden.config.actuation_model.name() == actuation)
        .collect()
}

impl Golden {
    fn read(name: String) -> Self {
        let base = Config {
            compat: Compat::Reference,
            ..Config::default()
        };
        let text = data::text(&format!("recordings/{name}.yml"));
        let config = ConfigReader::over(base)
            .read_text(&text, &name)
            .expect("a valid configuration");
        let npz = data::npz(&format!("recordings/{name}.npz"));
        let floor = npz.get_f64("floor").expect("committed data");
        let steps = floor.shape[1];
        let mean = |k: usize| 0.5 * (floor.data[k] + floor.data[steps + k]);
        Self {
            name,
            config,
            floor: (0..steps).map(mean).collect(),
            npz,
        }
    }

    /// Returns an environment of the recording's configuration.
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

    /// Returns the recorded observations, row by row. Columns that are columns of other arrays are stored there only;
    /// `scripts/pack_recordings.py` says how.
    pub fn observation(&self) -> Vec<f64> {
        const SOURCES: [&str; 9] = [
            "observation_own",
            "qpos",
            "qvel",
            "qacc",
            "sensordata",
            "ctrl",
            "gear",
            "actions",
            "vestibular",
        ];
        let sources = SOURCES.map(|name| self.npz.get_f64(name).ok());
        let columns = self.npz.get_i64("observation_from").expect("committed data").data;
        let steps = self.npz.get_f64("qpos").expect("committed data").shape[0];
        let value = |step: usize, from: &[i64]| {
            let source = sources[from[0] as usize].as_ref().expect("committed data");
            source.data[step * source.shape[1] + from[1] as usize]
        };
        let value = &value;
        (0..steps)
            .flat_map(|step| columns.chunks_exact(2).map(move |from| value(step, from)))
            .collect()
    }
}
