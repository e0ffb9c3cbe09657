//! The evaluation of a run: scores of its training log, and episodes with a policy, logged and filmed.
//!
//! The API page's Python, line by line:
//!
//! ```
//! use babybench::eval::{Evaluation, TouchableGeoms};
//! use babybench::{Config, make_env};
//! # let save_dir = std::env::temp_dir().join("babybench_page_evaluation").display().to_string();
//! # let text = "behavior: self_touch\nscene: crib\nvision_active: False\ntouch_active: False\nmax_episode_steps: 5";
//! # let config = Config { save_dir, ..Config::from_yaml(text, "my.yml")? };
//! # let mut training = make_env(config.clone(), true)?;
//! # for _ in 0..2 {
//! #     training.reset(None)?;
//! #     training.step(&[0.0; 44])?;
//! # }
//! # training.finish_training()?;
//!
//! // evaluation = bb_eval.EVALS[config['behavior']](env=env, render=True, save_dir=config['save_dir'])
//! let mut env = make_env(config, false)?;
//! let mut evaluation = Evaluation::new(&env).with_video(&env)?;
//!
//! // evaluation.eval_logs()
//! let score = evaluation.eval_logs()?;
//! println!("{score}"); // Preliminary training score: 0.0
//! print!("{}", score.to_text(TouchableGeoms::new(env.model()).as_ref()));
//!
//! // obs, _, _, _, info = env.step(action); evaluation.eval_step(info)
//! env.reset(None)?;
//! evaluation.reset();
//! for _ in 0..2 {
//!     env.step(&[0.0; 44])?;
//!     evaluation.eval_step(&env)?;
//! }
//!
//! // evaluation.end(episode=0)
//! evaluation.end(0)?;
//! # std::fs::remove_dir_all(&env.config().save_dir)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "npz")]
mod benchmark;
mod episodes;
mod evaluation;
pub mod film;
#[cfg(feature = "npz")]
mod measures;
#[cfg(feature = "npz")]
pub mod movement;
#[cfg(feature = "npz")]
mod pack;
#[cfg(feature = "npz")]
pub mod protocol;
mod scores;
#[cfg(feature = "npz")]
mod side_by_side;

#[cfg(feature = "npz")]
pub use benchmark::{
    Benchmark, BenchmarkError, BenchmarkJob, BenchmarkPlan, BenchmarkRow, ConfidenceInterval, Metric, RunResult,
};
pub use episodes::{EpisodeError, Plan, run_episodes};
pub use episodes::{Observer, run_episodes_watched};
pub use evaluation::{Evaluation, EvaluationError, eval_logs};
pub use film::RoomFilm;
pub use film::{Film, FilmError};
#[cfg(feature = "npz")]
pub use measures::{HandMeasures, Measures, RegionMeasures};
#[cfg(feature = "npz")]
pub use movement::{Movement, MovementOptions};
#[cfg(feature = "npz")]
pub use pack::{PackError, PackOptions, PackedSubmission, pack};
pub use scores::{MAX_EPISODES, steps};
pub use scores::{Score, ScoreError, ScoreParts, TouchableGeoms};

pub use crate::formats::avi::DEFAULT_FPS;
