//! Evaluation episodes with a policy, several at a time.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use thiserror::Error;

use super::evaluation::{Evaluation, EvaluationError};
use crate::config::Compat;
use crate::env::{Blueprint, Env, EnvError, Info};
use crate::policy::{Policy, PolicyError};
use crate::runs::for_evaluation;

/// The plan of an evaluation: number and length of episodes, and videos.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Number of episodes; episode k is seeded with the configuration's seed + k.
    pub episodes: u64,
    /// Maximum number of steps of an episode; it also ends when it is truncated.
    pub duration: u64,
    /// Whether videos are made.
    pub render: bool,
    /// Frames per second of the videos.
    pub fps: u32,
    /// Number of episodes run in parallel; values above the core count have no effect, and results do not depend on it.
    pub jobs: usize,
}

impl Plan {
    /// Returns how many episodes run in parallel: the requested number, limited by episodes and cores.
    pub fn parallel(&self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let episodes = usize::try_from(self.episodes).unwrap_or(usize::MAX);
        self.jobs.min(cores).min(episodes).max(1)
    }
}

/// An error that ends evaluation episodes.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EpisodeError {
    /// Episodes whose counters continue from one to the next cannot run in parallel.
    #[error(
        "under compat: reference each episode continues the counters of the one before, so episodes cannot run in \
         parallel; use --jobs 1"
    )]
    Jobs,
    /// Parallel episodes were requested for a growing MIMo.
    #[error("MIMo grows by `age_schedule` from episode to episode, so episodes cannot run in parallel; use --jobs 1")]
    Growing,
    /// The environment returned an error.
    #[error("episode {episode}: {source}")]
    Env {
        /// The episode.
        episode: u64,
        /// The cause.
        source: Box<EnvError>,
    },
    /// The progress callback stopped the evaluation.
    #[error("stopped after {done} of {planned} episodes; their logs are complete")]
    Stopped {
        /// Number of episodes that are done and logged.
        done: u64,
        /// Number of episodes that were planned.
        planned: u64,
    },
    /// The policy returned an error.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The observer of the episodes returned an error.
    #[error(transparent)]
    Observer(Box<dyn std::error::Error + Send + Sync>),
    /// A log or a video cannot be written.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
}

/// An observer of episodes that steps their environment: a recorder, or one that only steps.
pub trait Observer {
    /// Called at the start of an episode, after the environment was reset and the policy has begun.
    ///
    /// # Errors
    /// Errors that end the evaluation.
    fn begin(&mut self, env: &Env, episode: u64) -> Result<(), EpisodeError> {
        let _ = (env, episode);
        Ok(())
    }

    /// Applies an action of episode `episode` to the environment.
    ///
    /// # Errors
    /// Those of the step, and others that end the evaluation.
    fn step(&mut self, env: &mut Env, action: &[f32], episode: u64) -> Result<(), EpisodeError> {
        let failed = |source| EpisodeError::Env {
            episode,
            source: Box::new(source),
        };
        env.step(action).map(|_| ()).map_err(failed)
    }

    /// Called at the end of an episode.
    ///
    /// # Errors
    /// Errors that end the evaluation.
    fn end(&mut self, env: &Env) -> Result<(), EpisodeError> {
        let _ = env;
        Ok(())
    }
}

/// An observer that only steps.
struct NoObserver;

impl Observer for NoObserver {}

#[cfg(feature = "npz")]
impl Observer for crate::runs::Recorder {
    fn begin(&mut self, env: &Env, episode: u64) -> Result<(), EpisodeError> {
        Self::begin(self, env, episode);
        Ok(())
    }

    fn step(&mut self, env: &mut Env, action: &[f32], episode: u64) -> Result<(), EpisodeError> {
        Self::step(self, env, action).map_err(|e| match e {
            crate::runs::RecordError::Env(source) => EpisodeError::Env {
                episode,
                source: Box::new(source),
            },
            other => EpisodeError::Observer(other.into()),
        })
    }

    fn end(&mut self, env: &Env) -> Result<(), EpisodeError> {
        Self::end(self, env).map_err(|e| EpisodeError::Observer(e.into()))
    }
}

/// Runs evaluation episodes into the configuration's `save_dir` and returns the last information of each. `progress` is called after
/// every step and can stop the evaluation. Each job has its own policy.
///
/// # Errors
/// The first that occurs. Other episodes are abandoned.
pub fn run_episodes(
    blueprint: &Blueprint,
    plan: &Plan,
    policy: &(dyn Fn() -> Result<Box<dyn Policy>, PolicyError> + Sync),
    progress: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Vec<Info>, EpisodeError> {
    run_episodes_watched(blueprint, plan, policy, &|| Box::new(NoObserver), progress)
}

/// Runs evaluation episodes as [`run_episodes`] does, with an observer for each job.
///
/// # Errors
/// The first that occurs. Other episodes are abandoned.
pub fn run_episodes_watched<'o>(
    blueprint: &Blueprint,
    plan: &Plan,
    policy: &(dyn Fn() -> Result<Box<dyn Policy>, PolicyError> + Sync),
    observer: &(dyn Fn() -> Box<dyn Observer + 'o> + Sync),
    progress: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Vec<Info>, EpisodeError> {
    let jobs = plan.parallel();
    if plan.jobs > 1 && plan.episodes > 1 && blueprint.config().compat == Compat::Reference {
        return Err(EpisodeError::Jobs);
    }
    if plan.jobs > 1 && plan.episodes > 1 && !blueprint.config().age_schedule.is_empty() {
        return Err(EpisodeError::Growing);
    }
    let (next, failed) = (AtomicU64::new(0), AtomicBool::new(false));
    let done: Mutex<Vec<(u64, Info)>> = Mutex::default();
    let schedule = JobCallbacks {
        next: &|| {
            let episode = next.fetch_add(1, Ordering::Relaxed);
            (episode < plan.episodes && !failed.load(Ordering::Relaxed)).then_some(episode)
        },
        step: progress,
        done: &|episode, info| {
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            done.push((episode, info));
        },
    };
    let job = || {
        let result = episodes(blueprint, plan, policy, &mut *observer(), &schedule);
        failed.fetch_or(result.is_err(), Ordering::Relaxed);
        result
    };
    let results: Vec<Result<(), EpisodeError>> = match jobs {
        1 => vec![job()],
        _ => std::thread::scope(|scope| {
            let threads: Vec<_> = (0..jobs).map(|_| scope.spawn(job)).collect();
            let join =
                |t: std::thread::ScopedJoinHandle<'_, _>| t.join().unwrap_or_else(|e| std::panic::resume_unwind(e));
            threads.into_iter().map(join).collect()
        }),
    };
    let result = results.into_iter().collect::<Result<(), _>>();
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Err(EpisodeError::Stopped { .. }) = result {
        let (done, planned) = (done.len() as u64, plan.episodes);
        return Err(EpisodeError::Stopped { done, planned });
    }
    result?;
    done.sort_by_key(|(episode, _)| *episode);
    Ok(done.into_iter().map(|(_, info)| info).collect())
}

/// The callbacks that jobs share.
struct JobCallbacks<'a> {
    /// Returns the next episode, if there is one.
    next: &'a (dyn Fn() -> Option<u64> + Sync),
    /// Reports a step and returns whether to continue.
    step: &'a (dyn Fn() -> ControlFlow<()> + Sync),
    /// Reports a finished episode with its last information.
    done: &'a (dyn Fn(u64, Info) + Sync),
}

/// Runs the episodes of one job in its own environment.
fn episodes(
    blueprint: &Blueprint,
    plan: &Plan,
    policy: &dyn Fn() -> Result<Box<dyn Policy>, PolicyError>,
    observer: &mut dyn Observer,
    schedule: &JobCallbacks<'_>,
) -> Result<(), EpisodeError> {
    let env_error = |episode: u64| {
        move |e: EnvError| EpisodeError::Env {
            episode,
            source: Box::new(e),
        }
    };
    let mut policy = policy()?;
    let mut env = for_evaluation(blueprint).map_err(env_error(0))?;
    let mut evaluation = Evaluation::new(&env);
    if plan.render {
        evaluation = evaluation.with_video_at(&env, plan.fps)?;
    }
    let mut action = Vec::new();
    while let Some(episode) = (schedule.next)() {
        let seed = blueprint.config().seed.wrapping_add(episode);
        env.reset(Some(seed)).map_err(env_error(episode))?;
        policy.begin(&mut env, episode)?;
        evaluation.reset();
        observer.begin(&env, episode)?;
        for _ in 0..plan.duration {
            policy.act(&mut env, &mut action)?;
            observer.step(&mut env, &action, episode)?;
            let over = env.over();
            evaluation.eval_step(&env)?;
            if (schedule.step)().is_break() {
                let (done, planned) = (0, plan.episodes);
                return Err(EpisodeError::Stopped { done, planned });
            }
            if over {
                break;
            }
        }
        evaluation.end(episode)?;
        observer.end(&env)?;
        (schedule.done)(episode, env.info().clone());
    }
    Ok(())
}
