//! Replays of recordings: same start, same actions, and everything that the environment then produces.

mod output;
mod recording;

pub use output::{Replay, TaskRows, TouchRows};
pub use recording::{EpisodeStart, Recording};
use thiserror::Error;

use crate::env::{Env, EnvError, Viewer};
use crate::formats::npz::NpzError;
use crate::physics::FreeBody;

/// An error in reading or replaying a recording.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// The archive cannot be read, or the result cannot be written.
    #[error(transparent)]
    Npz(#[from] NpzError),
    /// An array does not match the environment.
    #[error("array {name} of the recording has shape {found:?} but the configuration needs {expected}")]
    Shape {
        /// Array.
        name: &'static str,
        /// Shape found.
        found: Vec<usize>,
        /// Shape needed, in words.
        expected: String,
    },
    /// The environment failed.
    #[error("in step {step} of the replay: {source}")]
    Env {
        /// Environment step.
        step: usize,
        /// The cause.
        source: Box<EnvError>,
    },
    /// A file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// File.
        path: String,
        /// The error of the system.
        source: std::io::Error,
    },
}

/// Replays a recording. With `one_step`, each step starts from the recording's previous row (and the solver from its
/// acceleration) instead of the replay's own state.
///
/// # Errors
/// A recording without the rows that `one_step` needs; an environment that fails.
pub fn replay(env: &mut Env, recording: &Recording, one_step: bool) -> Result<Replay, ReplayError> {
    replay_with_images(env, recording, one_step, None)
}

/// Replays a recording and takes pictures of both eyes in every `images_every`-th step, starting with the first; see [`replay`].
///
/// # Errors
/// As [`replay`].
pub fn replay_with_images(
    env: &mut Env,
    recording: &Recording,
    one_step: bool,
    images_every: Option<usize>,
) -> Result<Replay, ReplayError> {
    let (nq, nv, na) = (env.model().nq, env.model().nv, env.action_space().len());
    if one_step && (recording.qpos.is_empty() || recording.qvel.is_empty()) && recording.len > 0 {
        let (name, found) = ("qpos", vec![0]);
        return Err(ReplayError::Shape {
            name,
            found,
            expected: "one row per step, with qvel".to_string(),
        });
    }
    let at = |step: usize| {
        move |e: EnvError| ReplayError::Env {
            step,
            source: Box::new(e),
        }
    };
    env.by_hand()
        .reset_to(&recording.qpos0, &recording.qvel0)
        .map_err(at(0))?;
    // after the reset, which relaxes the muscles
    env.by_hand().set_activity(&recording.activity0).map_err(at(0))?;
    let muscles = recording.activity0.len();
    let mut out = Replay::begin(env, recording.len);
    let mut viewer = match images_every {
        Some(_) => Some(Viewer::new(env.blueprint()).map_err(at(0))?),
        None => None,
    };
    for t in 0..recording.len {
        if let Some(start) = recording.start_at(t) {
            begin_episode(env, start).map_err(at(t))?;
        } else if one_step && t > 0 {
            // the first step of an episode has no row before it
            let s = env.state_mut();
            s.qpos.copy_from_slice(&recording.qpos[(t - 1) * nq..t * nq]);
            s.qvel.copy_from_slice(&recording.qvel[(t - 1) * nv..t * nv]);
            if !recording.qacc.is_empty() {
                s.qacc_warmstart.copy_from_slice(&recording.qacc[(t - 1) * nv..t * nv]);
            }
            if !recording.activity.is_empty() {
                s.act
                    .copy_from_slice(&recording.activity[(t - 1) * muscles..t * muscles]);
            }
        }
        env.step(&recording.actions[t * na..(t + 1) * na]).map_err(at(t))?;
        out.push(env);
        if let (Some(every), Some(viewer)) = (images_every, &mut viewer)
            && every > 0
            && t % every == 0
        {
            out.eye_sizes = env.config().eye_sizes();
            out.eye_steps.push(t as i64);
            env.senses_mut().look().map_err(at(t))?;
            out.push_eyes(env, viewer).map_err(at(t))?;
        }
    }
    Ok(out)
}

/// Starts an episode of a recording of a task.
fn begin_episode(env: &mut Env, start: &EpisodeStart) -> Result<(), EnvError> {
    env.by_hand().reset_to(&start.qpos, &start.qvel)?;
    if let (Some([radius, mass, inertia @ ..]), Some(body)) = (start.ball, env.model().body("target")) {
        let change = FreeBody {
            mass: Some(mass),
            inertia: Some(inertia),
            size: Some([radius, 0.0, 0.0]),
        };
        let model = env.model().clone();
        env.state_mut().set_free_body(&model, body, change)?;
    }
    env.by_hand().set_activity(&start.activity)?;
    if !start.desired_goal.is_empty() {
        env.by_hand().set_goal(&start.desired_goal)?;
    }
    // after the reset, which leaves its own solution as the start of the solver
    if !start.warm.is_empty() {
        env.state_mut().qacc_warmstart.copy_from_slice(&start.warm);
    }
    Ok(())
}
