//! Runs in folders: training with its log, the scene that belongs to the logs, recordings and their replay.

pub mod logs;
mod many;
#[cfg(feature = "npz")]
mod replay;
mod scene_file;
mod training;

pub use logs::{EvaluationLog, LogError, TrainingLog, TrainingTotals, read_training};
pub use many::RunVector;
#[cfg(feature = "npz")]
pub use replay::{EpisodeStart, Recording, Replay, ReplayError, TaskRows, TouchRows, replay, replay_with_images};
#[cfg(feature = "report")]
pub(crate) use scene_file::scene_config;
pub use scene_file::{
    KeptScene, SceneFile, SceneFileError, complete_scene, complete_scene_from, keep_scene, read_config, read_scene,
    write_scene, write_scene_from,
};
pub use training::{RunEnv, RunError, for_evaluation, make_env, start_training, start_training_from};
