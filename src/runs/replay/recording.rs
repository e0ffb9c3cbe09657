//! The arrays of a recording that a replay needs.

use super::ReplayError;
use crate::env::Env;
use crate::formats::npz::Npz;

/// The part of a recording that a replay needs. Row `t` is after step `t`.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Positions at the start (nq).
    pub qpos0: Vec<f64>,
    /// Velocities at the start (nv).
    pub qvel0: Vec<f64>,
    /// Activities of the muscles at the start, in the order of an action; empty for models without muscles.
    pub activity0: Vec<f64>,
    /// Actions (T, na), row-major.
    pub actions: Vec<f32>,
    /// Number of steps.
    pub len: usize,
    /// Positions (T, nq) for one-step replay; empty when not recorded.
    pub qpos: Vec<f64>,
    /// Velocities (T, nv) for one-step replay; empty when not recorded.
    pub qvel: Vec<f64>,
    /// Accelerations (T, nv), from which the solver starts in one-step replay; empty when not recorded.
    pub qacc: Vec<f64>,
    /// Activities of the muscles (T, na) for one-step replay; empty when not recorded.
    pub activity: Vec<f64>,
    /// Starts of further episodes, and details of the first one, in recordings of tasks. `qpos0`, `qvel0` and `activity0` belong to the
    /// first.
    pub episodes: Vec<EpisodeStart>,
}

/// The start of an episode in a recording of a task.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EpisodeStart {
    /// Step before which it starts.
    pub row: usize,
    /// Positions (nq).
    pub qpos: Vec<f64>,
    /// Velocities (nv).
    pub qvel: Vec<f64>,
    /// Accelerations (nv) from which the solver starts.
    pub warm: Vec<f64>,
    /// Activities of the muscles (na).
    pub activity: Vec<f64>,
    /// The desired goal.
    pub desired_goal: Vec<f64>,
    /// Radius (m), mass (kg) and moments of inertia (kg m^2) of the ball, if its size varies.
    pub ball: Option<[f64; 5]>,
}

impl Recording {
    /// Reads `qpos0, qvel0, actions` and, if present, `activity0, qpos, qvel, qacc`, for `env`. Without `activity0` muscles start
    /// inactive.
    ///
    /// A recording of a task has several episodes. `reset_row` (E) lists the steps before which they start, and `reset_qpos` and
    /// `reset_qvel` (E, ...) their states. `reset_warm`, `reset_activity`, `reset_desired_goal` and `reset_ball` are read if present.
    ///
    /// # Errors
    /// Arrays that are missing, unreadable or of a shape that does not match the environment.
    pub fn read(archive: &Npz, env: &Env) -> Result<Self, ReplayError> {
        let (nq, nv, na) = (env.model().nq, env.model().nv, env.action_space().len());
        let muscles = env.state().act.len();
        let arrays = RecordingArrays { archive };
        let actions = arrays.table("actions", None, na)?;
        let len = actions.len() / na.max(1);
        let rows = |name: &'static str, n: usize| {
            if arrays.has(name) {
                arrays.table(name, Some(len), n)
            } else {
                Ok(Vec::new())
            }
        };
        let episodes = if arrays.has("reset_row") {
            EpisodeStart::read_all(&arrays, env, len)?
        } else {
            Vec::new()
        };
        // with several episodes the arrays at the top are those of the first
        let (qpos0, qvel0, activity0) = match episodes.first() {
            Some(first) => (first.qpos.clone(), first.qvel.clone(), first.activity.clone()),
            None => (
                arrays.vector("qpos0", nq)?,
                arrays.vector("qvel0", nv)?,
                if arrays.has("activity0") {
                    arrays.vector("activity0", muscles)?
                } else {
                    // recordings of motors have no activity
                    vec![0.0; muscles]
                },
            ),
        };
        Ok(Self {
            qpos0,
            qvel0,
            activity0,
            actions: actions.iter().map(|&v| v as f32).collect(),
            len,
            qpos: rows("qpos", nq)?,
            qvel: rows("qvel", nv)?,
            qacc: rows("qacc", nv)?,
            activity: rows("activity", muscles)?,
            episodes,
        })
    }

    /// Returns the start of an episode before a step, if an episode other than the first starts there.
    pub(super) fn start_at(&self, row: usize) -> Option<&EpisodeStart> {
        self.episodes.iter().find(|start| start.row == row)
    }
}

impl EpisodeStart {
    /// Reads the starts of all episodes of a recording of `len` steps.
    fn read_all(arrays: &RecordingArrays, env: &Env, len: usize) -> Result<Vec<Self>, ReplayError> {
        let rows = arrays.archive.get_i64("reset_row")?;
        // resets are looked up row by row, and two in one row would hide each other
        let ascending = rows.data.windows(2).all(|w| w[0] < w[1]);
        let within = rows
            .data
            .iter()
            .all(|row| usize::try_from(*row).is_ok_and(|row| row < len.max(1)));
        if rows.shape.len() != 1 || rows.data.first() != Some(&0) || !ascending || !within {
            return Err(ReplayError::Shape {
                name: "reset_row",
                found: rows.shape,
                expected: format!("(episodes), ascending numbers of steps from 0 to below {len}"),
            });
        }
        let count = rows.data.len();
        let table = |name: &'static str, n: usize| {
            if arrays.has(name) {
                arrays.table(name, Some(count), n).map(|data| (data, n))
            } else {
                Ok((Vec::new(), 0))
            }
        };
        let qpos = arrays.table("reset_qpos", Some(count), env.model().nq)?;
        let qvel = arrays.table("reset_qvel", Some(count), env.model().nv)?;
        let warm = table("reset_warm", env.model().nv)?;
        let activity = table("reset_activity", env.state().act.len())?;
        let desired = table("reset_desired_goal", env.goal().desired.len())?;
        let ball = table("reset_ball", BALL)?;
        let of = |(data, n): &(Vec<f64>, usize), e: usize| data[e * n..(e + 1) * n].to_vec();
        let start = |(e, &row): (usize, &i64)| Self {
            row: row as usize,
            qpos: of(&(qpos.clone(), env.model().nq), e),
            qvel: of(&(qvel.clone(), env.model().nv), e),
            warm: of(&warm, e),
            activity: if arrays.has("reset_activity") {
                of(&activity, e)
            } else {
                vec![0.0; env.state().act.len()]
            },
            desired_goal: of(&desired, e),
            ball: of(&ball, e).first_chunk().copied(),
        };
        Ok(rows.data.iter().enumerate().map(start).collect())
    }
}

/// Numbers of a ball: radius, mass, three moments of inertia, and the two inverse weights derived from them.
const BALL: usize = 7;

/// The arrays of an archive, with their shapes checked.
struct RecordingArrays<'a> {
    archive: &'a Npz,
}

impl RecordingArrays<'_> {
    fn has(&self, name: &str) -> bool {
        self.archive.arrays().any(|a| a.name == name)
    }

    /// Reads an array of `n` numbers.
    fn vector(&self, name: &'static str, n: usize) -> Result<Vec<f64>, ReplayError> {
        let a = self.archive.get_f64(name)?;
        if a.shape == [n] {
            Ok(a.data)
        } else {
            Err(shape(name, a.shape, format!("({n})")))
        }
    }

    /// Reads an array of rows of `n` numbers: a given number of rows, or any.
    fn table(&self, name: &'static str, rows: Option<usize>, n: usize) -> Result<Vec<f64>, ReplayError> {
        let a = self.archive.get_f64(name)?;
        let fits = matches!(a.shape[..], [found, columns] if columns == n && rows.is_none_or(|rows| rows == found));
        let count = rows.map_or_else(|| "steps".to_string(), |rows| rows.to_string());
        if fits {
            Ok(a.data)
        } else {
            Err(shape(name, a.shape, format!("({count}, {n})")))
        }
    }
}

fn shape(name: &'static str, found: Vec<usize>, expected: String) -> ReplayError {
    ReplayError::Shape { name, found, expected }
}
