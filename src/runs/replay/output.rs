//! The output of an environment in a replay.

use std::path::Path;

use super::{EpisodeStart, Recording, ReplayError};
use crate::config::VisionOutput;
use crate::env::{Env, EnvError, Info, Viewer};
use crate::files::replace_file;
use crate::formats::npz::{NpzError, NpzWriter};
use crate::json;
use crate::sensors::ObservationEntry;
use crate::sensors::transform::Sense;
use crate::spaces::{Array, Values};

/// Nonzero touch values, step by step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchRows {
    /// First entry of each step (T + 1).
    pub ptr: Vec<i64>,
    /// Indices into the touch observation, ascending within a step.
    pub idx: Vec<i32>,
    /// Values, N.
    pub val: Vec<f32>,
    /// Length of the touch observation.
    pub len: i64,
}

impl TouchRows {
    fn push(&mut self, values: &[f32]) {
        for (i, v) in (0..).zip(values).filter(|(_, v)| **v != 0.0) {
            self.idx.push(i);
            self.val.push(*v);
        }
        self.ptr.push(self.idx.len() as i64);
    }
}

/// Everything an environment produced in a replay, row-major, one row per step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Replay {
    /// Number of steps.
    pub len: usize,
    /// Positions (T, nq).
    pub qpos: Vec<f64>,
    /// Velocities (T, nv).
    pub qvel: Vec<f64>,
    /// Accelerations (T, nv).
    pub qacc: Vec<f64>,
    /// Controls (T, nu).
    pub ctrl: Vec<f64>,
    /// Gears (T, nu).
    pub gear: Vec<f64>,
    /// Sensors (T, nsensordata).
    pub sensordata: Vec<f64>,
    /// Proprioception (T, no).
    pub observation: Vec<f64>,
    /// Touch, if active.
    pub touch: Option<TouchRows>,
    /// The other active senses (T, len); images of the eyes, in the steps whose pictures were taken (K, H, W, ...).
    pub senses: Vec<(&'static ObservationEntry, Array)>,
    /// First contact of each step (T + 1).
    pub contact_ptr: Vec<i64>,
    /// Geoms of each contact (C, 2).
    pub contact_geom: Vec<i64>,
    /// Positions (C, 3), m.
    pub contact_pos: Vec<f64>,
    /// Frames (C, 9).
    pub contact_frame: Vec<f64>,
    /// Distances (C), m.
    pub contact_dist: Vec<f64>,
    /// Force and torque in the contact frame (C, 6), N and N m.
    pub contact_force: Vec<f64>,
    /// Steps whose pictures were taken (K).
    pub eye_steps: Vec<i64>,
    /// Width and height of those pictures of the left and of the right eye, pixels.
    pub eye_sizes: [[usize; 2]; 2],
    /// Information of each step.
    pub info: Vec<Info>,
    /// Rewards and goals, for a task that has them.
    pub task: Option<TaskRows>,
}

/// The output of a task in a replay, row-major, one row per step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TaskRows {
    /// Rewards (T).
    pub reward: Vec<f64>,
    /// Whether success or failure ended the episode (T).
    pub terminated: Vec<bool>,
    /// Whether the episode was truncated (T).
    pub truncated: Vec<bool>,
    /// Achieved goals (T, n).
    pub achieved_goal: Vec<f64>,
    /// Desired goals (T, n).
    pub desired_goal: Vec<f64>,
}

impl TaskRows {
    fn push(&mut self, env: &Env) {
        let last = env.last_step();
        self.reward.push(last.reward);
        self.terminated.push(last.terminated);
        self.truncated.push(last.truncated);
        self.achieved_goal.extend_from_slice(env.goal().achieved);
        self.desired_goal.extend_from_slice(env.goal().desired);
    }

    fn write(&self, npz: &mut NpzWriter) -> Result<(), ReplayError> {
        let t = self.reward.len();
        npz.add("reward", &[t], &self.reward)?;
        for (name, flags) in [("terminated", &self.terminated), ("truncated", &self.truncated)] {
            let bytes: Vec<u8> = flags.iter().map(|flag| u8::from(*flag)).collect();
            npz.add(name, &[t], &bytes)?;
        }
        for (name, goals) in [
            ("achieved_goal", &self.achieved_goal),
            ("desired_goal", &self.desired_goal),
        ] {
            npz.add(name, &[t, goals.len().checked_div(t).unwrap_or(0)], goals)?;
        }
        Ok(())
    }
}

/// Writes the starts of a recording's episodes, so that the replay is also a recording.
fn write_starts(npz: &mut NpzWriter, recording: &Recording) -> Result<(), ReplayError> {
    let starts = &recording.episodes;
    if starts.is_empty() {
        return Ok(());
    }
    let rows: Vec<i64> = starts.iter().map(|start| start.row as i64).collect();
    npz.add("reset_row", &[rows.len()], &rows)?;
    let ball = |start: &EpisodeStart| match start.ball {
        Some([radius, mass, inertia @ ..]) => {
            let turn = inertia.iter().map(|i| 1.0 / i).sum::<f64>() / 3.0;
            vec![radius, mass, inertia[0], inertia[1], inertia[2], 1.0 / mass, turn]
        }
        None => Vec::new(),
    };
    type Column<'c> = (&'c str, &'c dyn Fn(&EpisodeStart) -> Vec<f64>);
    let tables: [Column<'_>; 6] = [
        ("reset_qpos", &|start| start.qpos.clone()),
        ("reset_qvel", &|start| start.qvel.clone()),
        ("reset_warm", &|start| start.warm.clone()),
        ("reset_activity", &|start| start.activity.clone()),
        ("reset_desired_goal", &|start| start.desired_goal.clone()),
        ("reset_ball", &ball),
    ];
    for (name, of) in tables {
        let data: Vec<f64> = starts.iter().flat_map(of).collect();
        if !data.is_empty() {
            npz.add(name, &[starts.len(), data.len() / starts.len()], &data)?;
        }
    }
    Ok(())
}

/// Returns whether an entry is in [`Replay::senses`]. Goals, proprioception and touch have separate fields.
fn is_sense(entry: &ObservationEntry) -> bool {
    entry
        .sense
        .is_some_and(|sense| !matches!(sense, Sense::Proprioception | Sense::Touch))
}

/// Adds numbers of any type to an archive.
fn add(npz: &mut NpzWriter, name: &str, shape: &[usize], values: Values<'_>) -> Result<(), NpzError> {
    match values {
        Values::F64(values) => npz.add(name, shape, values),
        Values::F32(values) => npz.add(name, shape, values),
        Values::U8(values) => npz.add(name, shape, values),
        Values::I32(values) => npz.add(name, shape, values),
    }
}

impl Replay {
    /// Starts a replay of `len` steps with the senses of an environment.
    pub(super) fn begin(env: &Env, len: usize) -> Self {
        let spaces = env.observation_space();
        let there = |key| spaces.iter().any(|space| space.key == key);
        // pictures are taken whether vision is on or off
        let kept =
            |entry: &&ObservationEntry| is_sense(entry) && (there(entry.key) || entry.image == Some(VisionOutput::Rgb));
        let senses = ObservationEntry::ALL.iter().filter(kept);
        Self {
            len,
            touch: env.senses().touch().map(|t| TouchRows {
                ptr: vec![0],
                len: t.len() as i64,
                ..TouchRows::default()
            }),
            senses: senses.map(|entry| (entry, Array::zeros(entry.dtype, 0))).collect(),
            contact_ptr: vec![0],
            task: env.info().behavior.task().is_some().then(TaskRows::default),
            ..Self::default()
        }
    }

    /// Returns the rows of a sense by its key in the observation, if it is in [`Replay::senses`].
    pub fn sense(&self, key: &str) -> Option<Values<'_>> {
        let found = self.senses.iter().find(|(entry, _)| entry.key == key);
        found.map(|(_, rows)| rows.values())
    }

    /// Adds everything except pictures after a step.
    pub(super) fn push(&mut self, env: &Env) {
        let (s, observation) = (env.state(), env.observation());
        self.qpos.extend_from_slice(&s.qpos);
        self.qvel.extend_from_slice(&s.qvel);
        self.qacc.extend_from_slice(&s.qacc);
        self.ctrl.extend_from_slice(&s.ctrl);
        self.gear.extend_from_slice(s.reference_gear());
        self.sensordata.extend_from_slice(&s.sensordata);
        self.observation.extend_from_slice(observation.proprioception);
        if let (Some(all), Some(v)) = (&mut self.touch, observation.touch) {
            all.push(v);
        }
        for (entry, rows) in self.senses.iter_mut().filter(|(entry, _)| entry.image.is_none()) {
            if let Some(values) = observation.get(entry.key) {
                rows.extend(values);
            }
        }
        for c in &s.contact {
            self.contact_geom.extend(c.geom.map(|g| g as i64));
            self.contact_pos.extend(c.pos);
            self.contact_frame.extend(c.frame);
            self.contact_dist.push(c.dist);
            self.contact_force.extend(c.force);
        }
        self.contact_ptr.push(self.contact_dist.len() as i64);
        self.info.push(env.info().clone());
        if let Some(task) = &mut self.task {
            task.push(env);
        }
    }

    /// Adds the images of the eyes. A viewer draws the colours if they are not observed.
    pub(super) fn push_eyes(&mut self, env: &Env, viewer: &mut Viewer) -> Result<(), EnvError> {
        let (observation, sizes) = (env.observation(), self.eye_sizes);
        for (entry, rows) in self.senses.iter_mut().filter(|(entry, _)| entry.image.is_some()) {
            match observation.get(entry.key) {
                Some(image) => rows.extend(image),
                None => {
                    let [width, height] = sizes[eye_of(entry)];
                    rows.extend(viewer.draw(env, entry.key, width, height)?.into());
                }
            }
        }
        Ok(())
    }

    /// Writes the images of the eyes: the colours, then each eye's other images.
    fn write_eyes(&self, npz: &mut NpzWriter) -> Result<(), NpzError> {
        let k = self.eye_steps.len();
        let images = |chosen: &dyn Fn(Sense, VisionOutput) -> bool, npz: &mut NpzWriter| {
            self.senses
                .iter()
                .try_for_each(|(entry, rows)| match (entry.sense, entry.image) {
                    (Some(eye), Some(image)) if chosen(eye, image) => {
                        let [width, height] = self.eye_sizes[eye_of(entry)];
                        let shape = [k, height, width, 3];
                        // only colours have a last axis
                        let dimensions = if image == VisionOutput::Rgb { 4 } else { 3 };
                        add(npz, entry.key, &shape[..dimensions], rows.values())
                    }
                    _ => Ok(()),
                })
        };
        images(&|_, image| image == VisionOutput::Rgb, npz)?;
        Sense::EYES
            .into_iter()
            .try_for_each(|own| images(&|eye, image| eye == own && image != VisionOutput::Rgb, npz))
    }

    /// Writes `replay.npz`, with the recording's own start and actions, and `info.jsonl` into a directory, which is created if necessary.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, dir: &Path, recording: &Recording) -> Result<(), ReplayError> {
        let write_error = |path: &Path| {
            let path = path.display().to_string();
            move |source| ReplayError::Write { path, source }
        };
        std::fs::create_dir_all(dir).map_err(write_error(dir))?;
        let t = self.len;
        let columns = |n: usize| n.checked_div(t).unwrap_or(0);
        let mut npz = NpzWriter::new();
        npz.add("qpos0", &[recording.qpos0.len()], &recording.qpos0)?;
        npz.add("qvel0", &[recording.qvel0.len()], &recording.qvel0)?;
        npz.add("activity0", &[recording.activity0.len()], &recording.activity0)?;
        npz.add("actions", &[t, columns(recording.actions.len())], &recording.actions)?;
        let tables = [
            ("ctrl", &self.ctrl),
            ("gear", &self.gear),
            ("qpos", &self.qpos),
            ("qvel", &self.qvel),
            ("qacc", &self.qacc),
            ("sensordata", &self.sensordata),
            ("observation", &self.observation),
        ];
        for (name, data) in tables {
            npz.add(name, &[t, columns(data.len())], data)?;
        }
        if let Some(task) = &self.task {
            task.write(&mut npz)?;
        }
        write_starts(&mut npz, recording)?;
        for (entry, rows) in self.senses.iter().filter(|(entry, _)| entry.image.is_none()) {
            let values = rows.values();
            add(&mut npz, entry.key, &[t, columns(values.len())], values)?;
        }
        if let Some(touch) = &self.touch {
            npz.add("touch_idx", &[touch.idx.len()], &touch.idx)?;
            npz.add("touch_val", &[touch.val.len()], &touch.val)?;
            npz.add("touch_ptr", &[touch.ptr.len()], &touch.ptr)?;
            npz.add("touch_len", &[], &[touch.len])?;
        }
        if !self.eye_steps.is_empty() {
            npz.add("eye_steps", &[self.eye_steps.len()], &self.eye_steps)?;
            self.write_eyes(&mut npz)?;
        }
        let n = self.contact_dist.len();
        npz.add("contact_ptr", &[self.contact_ptr.len()], &self.contact_ptr)?;
        npz.add("contact_geom", &[n, 2], &self.contact_geom)?;
        npz.add("contact_pos", &[n, 3], &self.contact_pos)?;
        npz.add("contact_frame", &[n, 9], &self.contact_frame)?;
        npz.add("contact_dist", &[n], &self.contact_dist)?;
        npz.add("contact_force", &[n, 6], &self.contact_force)?;
        npz.write(dir.join("replay.npz"))?;
        let path = dir.join("info.jsonl");
        let lines = json::lines(&self.info);
        let written = lines.and_then(|lines| replace_file(&path, &lines));
        written.map_err(write_error(&path))
    }
}

/// Returns the eye of an image entry: 0 for the left, 1 for the right.
fn eye_of(entry: &ObservationEntry) -> usize {
    entry.sense.and_then(Sense::eye).unwrap_or_default()
}
