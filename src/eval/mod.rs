//! Logs of runs, their scores, the evaluation of a policy, recordings and their replay.

mod episodes;
mod evaluation;
mod film;
pub mod logs;
mod make;
pub mod pickle;
mod policy;
#[cfg(feature = "npz")]
mod replay;
mod scene_file;
mod scores;
mod skin_panel;
pub mod video;

pub use episodes::{EpisodeError, Plan, run_episodes};
pub use evaluation::{Evaluation, EvaluationError, Film, FilmError, eval_logs};
pub use film::RoomFilm;
pub use logs::{EvaluationLog, LogError, TrainingLog, read_training};
pub use make::{for_evaluation, make_env, start_training, start_training_from};

pub use policy::{CommandPolicy, Policy, PolicyError, RandomPolicy, ZeroPolicy};
#[cfg(feature = "npz")]
pub use replay::{Recording, Replay, ReplayError, TouchRows, replay, replay_with_images};
pub use scene_file::{
    SceneFile, SceneFileError, complete_scene, complete_scene_from, read_config, read_scene, write_scene,
    write_scene_from,
};
pub use scores::{MAX_EPISODES, Score, ScoreError, ScoreParts, Touchables};
