//! The log of an evaluation episode.

use std::path::{Path, PathBuf};

use super::{LogError, evaluation_path, make_folder, read_pickle, records, to_value, write, write_pickle};
#[cfg(feature = "npz")]
use crate::env::{EYE_HAND_PAIRS, PerEyeAndHand};
use crate::env::{Info, InfoWithDetails};
use crate::formats::pickle::{self, Value};
use crate::json;
use crate::limits::Limits;

/// Positions and information of every step of an evaluation episode.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EvaluationLog {
    /// Length of `qpos` in a step.
    pub nq: usize,
    /// Positions (T, nq) after each step.
    pub qpos: Vec<f64>,
    /// Information of each step (T).
    pub info: Vec<Info>,
}

impl EvaluationLog {
    /// Adds a step.
    pub fn push(&mut self, qpos: &[f64], info: &Info) {
        self.nq = qpos.len();
        self.qpos.extend_from_slice(qpos);
        self.info.push(info.clone());
    }

    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.info.len()
    }

    /// Returns whether there are no steps.
    pub fn is_empty(&self) -> bool {
        self.info.is_empty()
    }

    /// Writes `evaluation_N.pkl`, `evaluation_N.jsonl` and, with the feature `npz`, `evaluation_N.npz` into the folder of a run. A line
    /// of the `.jsonl` is the information of a step with its details ([`Info::to_detailed_json`]). The archive holds `qpos`, `steps` and,
    /// by behavior, the four counters and the angles (`gaze_angles`, rad) or, for each hand, the touched geoms (`*_touches`, with those
    /// of step t at `*_ptr[t]..*_ptr[t+1]`).
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, save_dir: impl AsRef<Path>, episode: u64) -> Result<PathBuf, LogError> {
        make_folder(save_dir.as_ref())?;
        let path = evaluation_path(save_dir, episode);
        let rows = self.qpos.chunks_exact(self.nq.max(1)).map(|row| {
            let (shape, data) = (vec![row.len()], row.to_vec());
            Value::Array(pickle::Array { shape, data }.into())
        });
        let info = Value::list(self.info.iter().map(to_value));
        let lines = json::lines(self.info.iter().map(InfoWithDetails::from));
        write(
            path.with_extension("jsonl"),
            &lines.map_err(|e| LogError::Write(e.to_string()))?,
        )?;
        #[cfg(feature = "npz")]
        self.write_npz(&path.with_extension("npz"))
            .map_err(|e| LogError::Write(e.to_string()))?;
        // last, because programs find an episode by its pickle, and the other files are then complete
        write_pickle(
            path.clone(),
            &Value::dict([("qpos", Value::list(rows)), ("info", info)]),
        )?;
        Ok(path)
    }

    #[cfg(feature = "npz")]
    fn write_npz(&self, path: &Path) -> Result<(), crate::formats::npz::NpzError> {
        let t = self.len();
        let mut npz = crate::formats::npz::NpzWriter::new();
        npz.add("qpos", &[t, self.nq], &self.qpos)?;
        let steps: Vec<i64> = self.info.iter().map(|i| i.steps as i64).collect();
        npz.add("steps", &[t], &steps)?;
        for (k, name) in ["right_hand", "left_hand"].iter().enumerate() {
            let lists = self.info.iter().map_while(|i| i.behavior.touches().map(|t| t[k]));
            let (mut flat, mut ptr) = (Vec::new(), vec![0_i64]);
            for list in lists {
                flat.extend(list.iter().map(|&g| g as i64));
                ptr.push(flat.len() as i64);
            }
            if ptr.len() == t + 1 && t > 0 {
                npz.add(&format!("{name}_touches"), &[flat.len()], &flat)?;
                npz.add(&format!("{name}_ptr"), &[ptr.len()], &ptr)?;
            }
        }
        for (k, name) in EYE_HAND_PAIRS.iter().enumerate() {
            let counts = self
                .info
                .iter()
                .map_while(|i| i.behavior.regards().map(|c| c[k] as i64));
            let counts: Vec<i64> = counts.collect();
            if counts.len() == t && t > 0 {
                npz.add(name, &[t], &counts)?;
            }
        }
        let angles: Vec<f64> = self
            .info
            .iter()
            .filter_map(|i| i.details.gaze_angles)
            .flat_map(PerEyeAndHand::to_array)
            .collect();
        if angles.len() == 4 * t && t > 0 {
            npz.add("gaze_angles", &[t, 4], &angles)?;
        }
        npz.write(path)
    }

    /// Reads `evaluation_N.pkl`, ours or the kit's.
    ///
    /// # Errors
    /// A missing file, or one that is damaged or not a log.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, LogError> {
        Self::read_with(path, &Limits::DEFAULT)
    }

    /// Reads `evaluation_N.pkl` as [`EvaluationLog::read`] does, within the given limits.
    ///
    /// # Errors
    /// As [`EvaluationLog::read`].
    pub fn read_with(path: impl AsRef<Path>, limits: &Limits) -> Result<Self, LogError> {
        let path = path.as_ref();
        let foreign = |reason: &str| LogError::Foreign {
            path: path.to_path_buf(),
            kind: "evaluation",
            reason: reason.to_string(),
        };
        let value = read_pickle(path, limits)?;
        let (Some(rows), Some(info)) = (value.get("qpos").and_then(Value::items), value.get("info")) else {
            return Err(foreign("it has no `qpos` and `info`"));
        };
        let info = records(info, limits).map_err(|reason| foreign(&reason))?;
        let mut log = Self {
            info,
            ..Self::default()
        };
        for row in rows {
            let Value::Array(row) = row else {
                return Err(foreign("`qpos` holds something other than arrays"));
            };
            if row.shape.len() != 1 || (log.nq > 0 && row.data.len() != log.nq) {
                return Err(foreign("arrays in `qpos` differ in length"));
            }
            log.nq = row.data.len();
            if log.qpos.len() + log.nq > limits.pickle_numbers {
                return Err(foreign("`qpos` is too large"));
            }
            log.qpos.extend_from_slice(&row.data);
        }
        if rows.len() != log.info.len() {
            return Err(foreign("`qpos` and `info` differ in length"));
        }
        Ok(log)
    }
}
