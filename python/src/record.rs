//! Records: their measures, and whether they repeat with the same bits.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use babybench::Limits;
use babybench::eval::movement::{MovementError, MovementFrame};
use babybench::eval::{Measures, Movement, MovementOptions};
use babybench::formats::npz::NpzError;
use babybench::runs::{
    Motion, MotionError, MotionMode, Owner, Record, RecordError, RecordOptions, Recorder as Inside, play_motion,
};
use pyo3::exceptions::{PyFileExistsError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::read;
use crate::env::Env;
use crate::errors::{IntoException, detached};

impl IntoException for RecordError {
    fn into_exception(self) -> PyErr {
        exception(self)
    }
}

/// Records an environment into a folder.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct Recorder {
    inner: Mutex<Inside>,
}

impl Recorder {
    fn with<R>(&self, work: impl FnOnce(&mut Inside) -> R) -> R {
        work(&mut self.inner.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[pymethods]
impl Recorder {
    #[new]
    #[pyo3(signature = (env, folder, senses=false, eyes_every=None, policy=""))]
    fn new(env: &Env, folder: PathBuf, senses: bool, eyes_every: Option<u64>, policy: &str) -> PyResult<Self> {
        let options = RecordOptions {
            senses,
            eyes_every,
            policy: policy.to_string(),
        };
        let inner = Inside::create(folder, &env.guard()?.open()?.env, options).map_err(exception)?;
        Ok(Self {
            inner: Mutex::new(inner),
        })
    }

    fn begin(&self, env: &Env, episode: u64) -> PyResult<()> {
        let mut guard = env.guard()?;
        let env = &guard.open()?.env;
        self.with(|recorder| recorder.begin(env, episode));
        Ok(())
    }

    fn step<'py>(
        &self,
        py: Python<'py>,
        env: &Env,
        action: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyDict>, f64, bool, bool)> {
        let mut guard = env.guard()?;
        let inner = guard.open()?;
        let width = inner.env.action_space().len();
        read("action", action, &[width], &mut inner.action)?;
        let (env, action) = (&mut inner.env, &inner.action);
        detached(py, || self.with(|recorder| recorder.step(env, action)))?;
        let last = inner.env.last_step();
        let outcome = (last.reward, last.terminated, last.truncated);
        Ok((Env::observed(py, inner)?, outcome.0, outcome.1, outcome.2))
    }

    /// Writes the episode; returns whether it had steps.
    #[pyo3(signature = (env, unfinished=false))]
    fn end(&self, py: Python<'_>, env: &Env, unfinished: bool) -> PyResult<bool> {
        let mut guard = env.guard()?;
        let env = &guard.open()?.env;
        detached(py, || {
            self.with(|recorder| {
                let steps = recorder.has_steps();
                if unfinished {
                    recorder.give_up(env)?;
                } else {
                    recorder.end(env)?;
                }
                Ok::<_, RecordError>(steps)
            })
        })
    }
}

/// Converts an error of a record to Python's exception.
fn exception(error: RecordError) -> PyErr {
    match error {
        RecordError::Io { ref source, .. } => {
            let text = error.to_string();
            std::io::Error::new(source.kind(), text).into()
        }
        RecordError::Exists { .. } => PyFileExistsError::new_err(error.to_string()),
        RecordError::Env(source) => source.into_exception(),
        other => PyValueError::new_err(other.to_string()),
    }
}

/// A folder that this process owns until the object is dropped.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct Folder {
    _owner: Owner,
}

#[pymethods]
impl Folder {
    #[new]
    fn new(folder: PathBuf) -> PyResult<Self> {
        Ok(Self {
            _owner: Owner::of(&folder)?,
        })
    }
}

/// Returns the measures of an episode of a record, or the means of all, as JSON.
#[pyfunction]
#[pyo3(signature = (folder, episode=None))]
pub fn measure_record(py: Python<'_>, folder: PathBuf, episode: Option<u64>) -> PyResult<String> {
    py.detach(|| {
        let record = Record::open(&folder).map_err(exception)?;
        let all = match episode {
            Some(episode) => vec![Measures::of_episode(&record, episode).map_err(exception)?],
            None => Measures::of_record(&record).map_err(exception)?,
        };
        let mean = Measures::mean(&all);
        let mean =
            mean.ok_or_else(|| PyValueError::new_err(format!("{}: the record has no steps", folder.display())))?;
        Ok(mean.to_json())
    })
}

/// Returns measures of the movements in an episode of a record, or the means of all, as JSON.
#[pyfunction]
#[pyo3(signature = (folder, episode, fps, band, window, jitter, seed, frame))]
#[allow(clippy::too_many_arguments)] // keywords in Python
pub fn movement_of_record(
    py: Python<'_>,
    folder: PathBuf,
    episode: Option<u64>,
    fps: f64,
    band: [f64; 2],
    window: usize,
    jitter: f64,
    seed: u64,
    frame: &str,
) -> PyResult<String> {
    let mut options = MovementOptions::default();
    (options.fps, options.band, options.window) = (fps, band, window);
    (options.jitter, options.seed) = (jitter, seed);
    options.frame = MovementFrame::of(frame)
        .ok_or_else(|| PyValueError::new_err(format!("frame is {frame:?}, expected \"world\" or \"hip\"")))?;
    py.detach(|| {
        let record = Record::open(&folder).map_err(exception)?;
        let all = match episode {
            Some(episode) => Movement::of_episode(&record, episode, &options).map(|one| vec![one]),
            None => Movement::of_record(&record, &options),
        };
        let all = all.map_err(|error| match error {
            MovementError::Record(error) => exception(error),
            other => PyValueError::new_err(other.to_string()),
        })?;
        let mean = Movement::mean(&all)
            .ok_or_else(|| PyValueError::new_err(format!("{}: the record has no steps", folder.display())))?;
        Ok(mean.to_json())
    })
}

/// Repeats an episode of a record in its own configuration; returns the first step whose bits differ.
#[pyfunction]
pub fn replay_record(py: Python<'_>, folder: PathBuf, episode: u64) -> PyResult<Option<u64>> {
    py.detach(|| {
        let record = Record::open(&folder).map_err(exception)?;
        let mut env =
            babybench::Env::new(record.manifest().configuration.clone()).map_err(IntoException::into_exception)?;
        Ok(record.replay(episode, &mut env).map_err(exception)?.first_difference)
    })
}

/// Converts an error of a motion to Python's exception.
fn motion_exception(error: MotionError) -> PyErr {
    match error {
        MotionError::Io { ref source, .. } => {
            let text = error.to_string();
            std::io::Error::new(source.kind(), text).into()
        }
        MotionError::Npz(NpzError::Io { ref source, .. }) => {
            let text = error.to_string();
            std::io::Error::new(source.kind(), text).into()
        }
        MotionError::Env(source) => (*source).into_exception(),
        MotionError::Record(source) => exception(*source),
        other => PyValueError::new_err(other.to_string()),
    }
}

/// Outcome of playing a motion: steps, error, rad, the worst joint with its error, and the joints whose range it leaves.
type PlayedSenses = (u64, f64, Option<(String, f64)>, Vec<String>);

/// Plays a motion in an environment that was reset, and records it.
#[pyfunction]
pub fn play_senses(
    py: Python<'_>,
    env: &Env,
    recorder: &Recorder,
    motion: PathBuf,
    degrees: bool,
    track: bool,
    episode: u64,
) -> PyResult<PlayedSenses> {
    let mut guard = env.guard()?;
    let env = &mut guard.open()?.env;
    let playing = if track {
        MotionMode::Tracking
    } else {
        MotionMode::Kinematic
    };
    let mut interrupted = Ok(());
    let played = py.detach(|| {
        let motion = Motion::read_with(&motion, degrees, &Limits::DEFAULT)?;
        let mut steps = 0_u32;
        recorder.with(|recorder| {
            play_motion(env, &motion, playing, Some((recorder, episode)), |_| {
                steps = steps.wrapping_add(1);
                if steps.is_multiple_of(64) {
                    interrupted = Python::attach(|py| py.check_signals());
                }
                interrupted.is_ok()
            })
        })
    });
    interrupted?;
    let played = played.map_err(motion_exception)?;
    Ok((played.steps, played.error, played.worst, played.beyond_limits))
}
