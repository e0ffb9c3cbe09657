//! Replaying a recorded run: same start, same actions, everything the environment produces.

use std::path::Path;

use thiserror::Error;

use crate::env::{Env, EnvError, Info, Observation, Viewer};
use crate::files::replace_file;
use crate::formats::npz::{Npz, NpzError, NpzWriter};
use crate::json;
use crate::sensors::{EYES, EYES_DEPTH, EYES_GRAY, EYES_SEGMENTATION, EyeImages};

/// An error in reading or replaying a recording.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// The archive cannot be read, or the result not written.
    #[error(transparent)]
    Npz(#[from] NpzError),
    /// An array does not fit the environment.
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

/// The part of a recording that a replay needs. Row `t` is after step `t`.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Positions at the start (nq).
    pub qpos0: Vec<f64>,
    /// Velocities at the start (nv).
    pub qvel0: Vec<f64>,
    /// Activities of the muscles at the start, in the order of an action; empty for models without.
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
}

impl Recording {
    /// Reads `qpos0, qvel0, actions` and, if they are there, `activity0, qpos, qvel, qacc`, for `env`. Without
    /// `activity0` muscles start inactive.
    ///
    /// # Errors
    /// Arrays that are missing, unreadable or of a shape that does not fit the environment.
    pub fn read(archive: &Npz, env: &Env) -> Result<Self, ReplayError> {
        let (nq, nv, na) = (env.model().nq, env.model().nv, env.action_space().len());
        let vector = |name: &'static str, n: usize| {
            let a = archive.get_f64(name)?;
            if a.shape == [n] {
                Ok(a.data)
            } else {
                Err(ReplayError::Shape {
                    name,
                    found: a.shape,
                    expected: format!("({n})"),
                })
            }
        };
        let muscles = env.state().act.len();
        let activity0 = match archive.arrays().any(|a| a.name == "activity0") {
            true => vector("activity0", muscles)?,
            false => vec![0.0; muscles],
        };
        let actions = archive.get_f64("actions")?;
        if actions.shape.len() != 2 || actions.shape[1] != na {
            return Err(ReplayError::Shape {
                name: "actions",
                found: actions.shape,
                expected: format!("(steps, {na})"),
            });
        }
        let len = actions.shape[0];
        let rows = |name: &'static str, n: usize| {
            if !archive.arrays().any(|a| a.name == name) {
                return Ok(Vec::new());
            }
            let a = archive.get_f64(name)?;
            if a.shape == [len, n] {
                Ok(a.data)
            } else {
                Err(ReplayError::Shape {
                    name,
                    found: a.shape,
                    expected: format!("({len}, {n})"),
                })
            }
        };
        Ok(Self {
            qpos0: vector("qpos0", nq)?,
            qvel0: vector("qvel0", nv)?,
            activity0,
            actions: actions.data.iter().map(|&v| v as f32).collect(),
            len,
            qpos: rows("qpos", nq)?,
            qvel: rows("qvel", nv)?,
            qacc: rows("qacc", nv)?,
        })
    }
}

/// Touch values that are not zero, step by step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchRows {
    /// First entry of each step (T + 1).
    pub ptr: Vec<i64>,
    /// Positions in the touch observation, ascending within a step.
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
    /// Vestibular sense (T, 6), if active.
    pub vestibular: Option<Vec<f64>>,
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
    /// What the left eye saw in them (K, H, W, 3).
    pub eye_left: Vec<u8>,
    /// What the right eye saw in them.
    pub eye_right: Vec<u8>,
    /// What else the environment's eyes observed in them, left and right, (K, H, W) each.
    pub eyes: [EyeImages; 2],
    /// Width and height of those pictures, pixels.
    pub eye_size: usize,
    /// Information of each step.
    pub info: Vec<Info>,
}

/// Replays a recording. With `one_step`, each step starts from the recording's previous row (and the solver from its
/// acceleration) instead of the replay's own state.
///
/// # Errors
/// A recording without the rows that `one_step` needs; an environment that fails.
pub fn replay(env: &mut Env, recording: &Recording, one_step: bool) -> Result<Replay, ReplayError> {
    replay_with_images(env, recording, one_step, None)
}

/// Replays a recording and takes pictures of both eyes in every `images_every`-th step, beginning with the first; see
/// [`replay`].
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
    env.reset_to(&recording.qpos0, &recording.qvel0).map_err(at(0))?;
    env.set_activity(&recording.activity0).map_err(at(0))?;
    let mut out = Replay::begin(env, recording.len);
    let mut viewer = match images_every {
        Some(_) => Some(Viewer::new(env.blueprint()).map_err(at(0))?),
        None => None,
    };
    for t in 0..recording.len {
        if one_step && t > 0 {
            let s = env.state_mut();
            s.qpos.copy_from_slice(&recording.qpos[(t - 1) * nq..t * nq]);
            s.qvel.copy_from_slice(&recording.qvel[(t - 1) * nv..t * nv]);
            if !recording.qacc.is_empty() {
                s.qacc_warmstart.copy_from_slice(&recording.qacc[(t - 1) * nv..t * nv]);
            }
        }
        env.step(&recording.actions[t * na..(t + 1) * na]).map_err(at(t))?;
        out.push(env);
        if let (Some(every), Some(viewer)) = (images_every, &mut viewer)
            && every > 0
            && t % every == 0
        {
            out.eye_size = env.config().vision_resolution as usize;
            out.eye_steps.push(t as i64);
            for (key, all) in EYES.into_iter().zip([&mut out.eye_left, &mut out.eye_right]) {
                all.extend_from_slice(viewer.draw(env, key, out.eye_size, out.eye_size).map_err(at(t))?);
            }
            out.push_eyes(&env.observation());
        }
    }
    Ok(out)
}

impl Replay {
    /// Starts a replay of `len` steps with the senses of an environment.
    fn begin(env: &Env, len: usize) -> Self {
        Self {
            len,
            touch: env.touch().map(|t| TouchRows {
                ptr: vec![0],
                len: t.len() as i64,
                ..TouchRows::default()
            }),
            vestibular: env.vestibular().map(|_| Vec::new()),
            contact_ptr: vec![0],
            ..Self::default()
        }
    }

    /// Adds everything but pictures after a step.
    fn push(&mut self, env: &Env) {
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
        if let (Some(all), Some(v)) = (&mut self.vestibular, observation.vestibular) {
            all.extend_from_slice(v);
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
    }

    /// Adds what the eyes observe besides colours.
    fn push_eyes(&mut self, observation: &Observation) {
        let [left, right] = &mut self.eyes;
        if let Some(gray) = observation.eye_gray {
            left.gray.extend_from_slice(gray[0]);
            right.gray.extend_from_slice(gray[1]);
        }
        if let Some(depth) = observation.eye_depth {
            left.depth.extend_from_slice(depth[0]);
            right.depth.extend_from_slice(depth[1]);
        }
        if let Some(ids) = observation.eye_segmentation {
            left.segmentation.extend_from_slice(ids[0]);
            right.segmentation.extend_from_slice(ids[1]);
        }
    }

    /// Writes what the eyes observed besides colours.
    fn write_eyes(&self, npz: &mut NpzWriter) -> Result<(), ReplayError> {
        let shape = [self.eye_steps.len(), self.eye_size, self.eye_size];
        for (k, eye) in self.eyes.iter().enumerate() {
            if !eye.gray.is_empty() {
                npz.add(EYES_GRAY[k], &shape, &eye.gray)?;
            }
            if !eye.depth.is_empty() {
                npz.add(EYES_DEPTH[k], &shape, &eye.depth)?;
            }
            if !eye.segmentation.is_empty() {
                npz.add(EYES_SEGMENTATION[k], &shape, &eye.segmentation)?;
            }
        }
        Ok(())
    }

    /// Writes `replay.npz`, with the recording's own start and actions, and `info.jsonl` into a directory, which is
    /// made if it is not there.
    ///
    /// # Errors
    /// What the file system says.
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
        if let Some(v) = &self.vestibular {
            npz.add("vestibular", &[t, columns(v.len())], v)?;
        }
        if let Some(touch) = &self.touch {
            npz.add("touch_idx", &[touch.idx.len()], &touch.idx)?;
            npz.add("touch_val", &[touch.val.len()], &touch.val)?;
            npz.add("touch_ptr", &[touch.ptr.len()], &touch.ptr)?;
            npz.add("touch_len", &[], &[touch.len])?;
        }
        let (k, side) = (self.eye_steps.len(), self.eye_size);
        if k > 0 {
            npz.add("eye_steps", &[k], &self.eye_steps)?;
            npz.add("eye_left", &[k, side, side, 3], &self.eye_left)?;
            npz.add("eye_right", &[k, side, side, 3], &self.eye_right)?;
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
