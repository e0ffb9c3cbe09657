//! The evaluation of a run: scores of its training log, and episodes with a policy, logged and filmed.

mod episodes;
mod evaluation;
pub mod film;
mod scores;

pub use episodes::{EpisodeError, Plan, run_episodes};
pub use evaluation::{Evaluation, EvaluationError, eval_logs};
pub use film::{Film, FilmError, RoomFilm};
pub use scores::{MAX_EPISODES, Score, ScoreError, ScoreParts, Touchables, steps};
