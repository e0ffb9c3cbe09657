//! The description of a record.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::RecordOptions;
use super::describe::{GeomDescription, InfantDescription, JointDescription, geoms, limb_joints, meaning};
use crate::config::Config;
use crate::env::Env;
use crate::sensors::EYES;

/// Name of the format, at the start of a description.
pub(super) const FORMAT: &str = "babybench record";
/// The version of the format that this library writes.
pub(super) const VERSION: u32 = 1;

/// The contents of a record, and their origin: `manifest.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Manifest {
    /// `babybench record`.
    pub format: String,
    /// The version of the format.
    pub version: u32,
    /// The version of babybench that made the record.
    pub babybench: String,
    /// The commit that it was built from, if the build named it (the variable `BABYBENCH_COMMIT`).
    pub commit: Option<String>,
    /// The processor and the system on which it ran.
    pub platform: String,
    /// Name of the policy.
    pub policy: String,
    /// The configuration, including the seed.
    pub configuration: Config,
    /// The infant, if the configuration describes an individual.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub infant: Option<InfantDescription>,
    /// Simulated time of a step, s.
    pub dt: f64,
    /// Vertical field of view of MIMo's eyes, degrees; that of the left one if they differ; none if he has no eyes.
    pub fovy: Option<f64>,
    /// Vertical field of view of his right eye, degrees, if it differs from the left one's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fovy_right: Option<f64>,
    /// MIMo's joints, in the order of the observation.
    pub joints: Vec<JointDescription>,
    /// The names of the actions.
    pub actions: Vec<String>,
    /// The names of the bodies of the scene, by id; none in older records.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<String>,
    /// The geoms of the scene, by id.
    pub geoms: Vec<GeomDescription>,
    /// The arrays of the archives of episodes, by name.
    pub arrays: BTreeMap<String, ArrayDescription>,
    /// The episodes, by number.
    pub episodes: Vec<EpisodeDescription>,
}

/// An array of the archives.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArrayDescription {
    /// Its type, in NumPy's notation.
    pub dtype: String,
    /// Its dimensions, in words: T steps, C contacts, N touched sensors.
    pub shape: String,
    /// Its meaning, with units.
    pub meaning: String,
}

/// An episode of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EpisodeDescription {
    /// Its number.
    pub episode: u64,
    /// The archive.
    pub file: String,
    /// Number of steps.
    pub steps: u64,
    /// CRC-32 of the archive.
    pub crc32: u32,
    /// The checksum of the last step, which a replay must reach.
    pub last_checksum: i64,
    /// The information of the last step, with details.
    pub info: serde_json::Value,
    /// MIMo's age in months, if it was not that of the configuration; null for the original proportions.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "other_age")]
    pub age: Option<Option<f64>>,
    /// The number of the infant in the population of the configuration, if it was not the configuration's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body_number: Option<u64>,
    /// Whether the record was written before the episode ended; its end may then not be the end of the episode.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unfinished: bool,
}

/// An age that may stand for the original proportions: null means those, and a missing value means the age of the configuration.
mod other_age {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(age: &Option<Option<f64>>, serializer: S) -> Result<S::Ok, S::Error> {
        age.flatten().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Option<f64>>, D::Error> {
        Option::deserialize(deserializer).map(Some)
    }
}

impl Manifest {
    /// Describes an environment.
    pub(super) fn of(env: &Env, options: &RecordOptions) -> Self {
        let (model, blueprint) = (env.model(), env.blueprint());
        let [left, right] = EYES.map(|eye| model.camera(eye).map(|camera| model.cam_fovy[camera]));
        Self {
            format: FORMAT.to_string(),
            version: VERSION,
            babybench: env!("CARGO_PKG_VERSION").to_string(),
            commit: option_env!("BABYBENCH_COMMIT").map(str::to_string),
            platform: format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            policy: options.policy.clone(),
            configuration: env.config().clone(),
            infant: InfantDescription::of(env),
            dt: blueprint.dt(),
            fovy: left,
            fovy_right: right.filter(|_| right != left),
            joints: limb_joints(env),
            actions: env.blueprint().actuation().action_names(model),
            bodies: model.body_name.clone(),
            geoms: geoms(model),
            arrays: BTreeMap::new(),
            episodes: Vec::new(),
        }
    }

    /// Adds an episode, or replaces the one with its number. `arrays` are those of its archive, with their types.
    pub(super) fn add(&mut self, episode: EpisodeDescription, arrays: Vec<(String, &'static str)>) {
        for (name, dtype) in arrays {
            let (shape, meaning) = meaning(&name);
            self.arrays.entry(name).or_insert_with(|| ArrayDescription {
                dtype: dtype.to_string(),
                shape: shape.to_string(),
                meaning: meaning.to_string(),
            });
        }
        match self.episodes.binary_search_by_key(&episode.episode, |e| e.episode) {
            Ok(at) => self.episodes[at] = episode,
            Err(at) => self.episodes.insert(at, episode),
        }
    }
}
