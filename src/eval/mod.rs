//! Logs of runs, their scores, the evaluation of a policy, recordings and their replay.

mod episodes;
mod evaluation;
mod film;
pub mod logs;
mod make;
pub mod pickle;
mod picture;
mod policy;
#[cfg(feature = "npz")]
mod replay;
#[cfg(feature = "report")]
mod report;
mod scene_file;
mod scores;
mod skin_panel;
pub mod video;

pub use episodes::{EpisodeError, Plan, run_episodes};
pub use evaluation::{Evaluation, EvaluationError, Film, FilmError, eval_logs};
pub use film::RoomFilm;
pub use logs::{EvaluationLog, LogError, TrainingLog, read_training};
pub use make::{for_evaluation, make_env, start_training, start_training_from};
pub use picture::{PictureError, write_png};
pub use policy::{CommandPolicy, DEFAULT_LIMIT, Moment, Policy, PolicyError, PolicySource, RandomPolicy, ZeroPolicy};
#[cfg(feature = "onnx")]
pub use policy::{OnnxError, OnnxPolicy};
#[cfg(feature = "npz")]
pub use replay::{Recording, Replay, ReplayError, TouchRows, replay, replay_with_images};
#[cfg(feature = "report")]
pub use report::{Report, ReportError};
pub use scene_file::{
    KeptScene, SceneFile, SceneFileError, complete_scene, complete_scene_from, keep_scene, read_config, read_scene,
    write_scene, write_scene_from,
};
pub use scores::{MAX_EPISODES, Score, ScoreError, ScoreParts, Touchables};
