//! Motions: joint angles over time, from a video of an infant, a motion capture or a record, and MIMo's sensations while he follows them.

mod check;
mod play;
mod text;
mod track;

use std::path::{Path, PathBuf};

pub use play::{MotionMode, MotionResult, play_motion};
use thiserror::Error;

use super::RecordError;
use crate::env::EnvError;
use crate::files;
use crate::formats::npz::{Npz, NpzError, NpzWriter};
use crate::limits::Limits;
use crate::math::{Quat, Vec3};

/// An error in reading or playing a motion.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MotionError {
    /// The archive cannot be read.
    #[error(transparent)]
    Npz(#[from] NpzError),
    /// The file system returned an error.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The file is neither a NumPy archive nor a table.
    #[error("{}: motions are files whose names end in .npz or .csv", path.display())]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// A line of a table cannot be read.
    #[error("{}, line {line}: {reason}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// Description of the fault.
        reason: String,
    },
    /// The parts of a motion do not match, or exceed a limit.
    #[error("{0}")]
    Unfit(String),
    /// A number is not finite, or not an angle in rad.
    #[error("frame {frame} of {name:?} is {value}: {expected}")]
    Number {
        /// The row, from 0.
        frame: usize,
        /// The joint, or the part of the root.
        name: String,
        /// The number.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// MIMo does not have the joint.
    #[error("MIMo has no joint {name:?} that turns by an angle{hint}")]
    Joint {
        /// The name.
        name: String,
        /// A suggestion of the intended name, in words; may be empty.
        hint: String,
    },
    /// The motion moves the root, but MIMo's is fixed.
    #[error(
        "the motion has root_pos, but MIMo sits in this scene and has no free root: leave it out, or take another scene"
    )]
    Root,
    /// The actuators cannot follow angles.
    #[error(
        "muscles do not follow angles: set actuation_model: spring_damper or positional, or play the motion without tracking"
    )]
    Muscles,
    /// The environment returned an error.
    #[error(transparent)]
    Env(Box<EnvError>),
    /// The record cannot be written.
    #[error(transparent)]
    Record(Box<RecordError>),
}

impl From<EnvError> for MotionError {
    fn from(source: EnvError) -> Self {
        Self::Env(Box::new(source))
    }
}

impl From<RecordError> for MotionError {
    fn from(source: RecordError) -> Self {
        Self::Record(Box::new(source))
    }
}

/// Angles of some of MIMo's joints over time, and the pose of his root, if known.
///
/// ```
/// use babybench::runs::Motion;
///
/// let names = vec!["robot:right_elbow".to_string()];
/// let motion = Motion::new(names, 10.0, vec![0.0, -0.5, -1.0], None)?;
/// assert_eq!((motion.frames(), motion.seconds()), (3, 0.2));
/// # Ok::<(), babybench::runs::MotionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    names: Vec<String>,
    rate: f64,
    angles: Vec<f64>,
    root: Option<Vec<(Vec3, Quat)>>,
}

impl Motion {
    /// Creates a motion from the names of joints, rows per second, angles in rad, shape (frames, joints), and the poses of the root in
    /// the world, m and unit quaternions, one for each frame. Quaternions are normalised.
    ///
    /// # Errors
    /// No frames, wrong lengths, duplicate names, numbers that are not finite, angles beyond two turns, a rate that is not positive, or
    /// more than the limits allow.
    pub fn new(
        names: Vec<String>,
        rate: f64,
        angles: Vec<f64>,
        root: Option<Vec<(Vec3, Quat)>>,
    ) -> Result<Self, MotionError> {
        Self::new_with(names, rate, angles, root, &Limits::DEFAULT)
    }

    /// Creates a motion, as [`Motion::new`] does, within the given limits.
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn new_with(
        names: Vec<String>,
        rate: f64,
        angles: Vec<f64>,
        root: Option<Vec<(Vec3, Quat)>>,
        limits: &Limits,
    ) -> Result<Self, MotionError> {
        let mut motion = Self {
            names,
            rate,
            angles,
            root,
        };
        motion.check(limits)?;
        Ok(motion)
    }

    /// Reads a motion: a NumPy archive (`.npz`) or a table (`.csv`).
    ///
    /// An archive has `names` (joints), `angles` (frames, joints), rad, and `rate`, Hz; if the root is known, also `root_pos` (frames,
    /// 3), m, and `root_quat` (frames, 4), w first. A table has a line of names; the first one is `time`, s. Each further line is a
    /// frame, evenly spaced in time. The columns `root_x`, `root_y`, `root_z`, `root_qw`, `root_qx`, `root_qy` and `root_qz` are the
    /// root.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged; as [`Motion::new`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, MotionError> {
        Self::read_with(path, false, &Limits::DEFAULT)
    }

    /// Reads a motion, as [`Motion::read`] does, from a file whose angles are in degrees if `degrees` is true, and otherwise in rad.
    ///
    /// # Errors
    /// As [`Motion::read`].
    pub fn read_with(path: impl AsRef<Path>, degrees: bool, limits: &Limits) -> Result<Self, MotionError> {
        let path = path.as_ref();
        let ends = |end: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(end));
        if ends("csv") {
            let bytes = files::read(path, limits.motion_text_bytes).map_err(|source| MotionError::Io {
                path: path.to_path_buf(),
                source,
            })?;
            return text::parse(path, &bytes, degrees, limits);
        }
        if !ends("npz") {
            return Err(MotionError::Kind {
                path: path.to_path_buf(),
            });
        }
        Self::of_archive(&Npz::open_with(path, limits)?, degrees, limits)
    }

    /// Reads the arrays of an archive.
    fn of_archive(npz: &Npz, degrees: bool, limits: &Limits) -> Result<Self, MotionError> {
        let unfit = |reason: String| Err(MotionError::Unfit(reason));
        let (names, angles, rate) = (npz.get_text("names")?, npz.get_f64("angles")?, npz.get_f64("rate")?);
        let [frames, joints] = angles.shape[..] else {
            return unfit(format!(
                "angles have the shape {:?}; expected (frames, joints)",
                angles.shape
            ));
        };
        if names.data.len() != joints {
            return unfit(format!(
                "there are {} names for {joints} columns of angles",
                names.data.len()
            ));
        }
        let &[rate] = &rate.data[..] else {
            return unfit(format!("rate has the shape {:?}; expected one number", rate.shape));
        };
        let has = |name: &str| npz.arrays().any(|array| array.name == name);
        let root = match (has("root_pos"), has("root_quat")) {
            (false, false) => None,
            (true, true) => {
                let (pos, quat) = (npz.get_f64("root_pos")?, npz.get_f64("root_quat")?);
                if pos.shape != [frames, 3] || quat.shape != [frames, 4] {
                    return unfit(format!(
                        "root_pos and root_quat have the shapes {:?} and {:?}; expected ({frames}, 3) and ({frames}, 4)",
                        pos.shape, quat.shape
                    ));
                }
                let (pos, quat) = (pos.data.as_chunks::<3>().0, quat.data.as_chunks::<4>().0);
                Some(pos.iter().copied().zip(quat.iter().copied()).collect())
            }
            _ => return unfit("root_pos and root_quat belong together: there is only one of them".to_string()),
        };
        let scale = if degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
        let angles = angles.data.iter().map(|angle| angle * scale).collect();
        Self::new_with(names.data, rate, angles, root, limits)
    }

    /// Writes the motion as a NumPy archive, which [`Motion::read`] reads.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), MotionError> {
        let (frames, mut npz) = (self.frames(), NpzWriter::new());
        npz.add_text("names", &self.names)?;
        npz.add("rate", &[], &[self.rate])?;
        npz.add("angles", &[frames, self.names.len()], &self.angles)?;
        if let Some(root) = &self.root {
            let pos: Vec<f64> = root.iter().flat_map(|(pos, _)| *pos).collect();
            let quat: Vec<f64> = root.iter().flat_map(|(_, quat)| *quat).collect();
            npz.add("root_pos", &[frames, 3], &pos)?;
            npz.add("root_quat", &[frames, 4], &quat)?;
        }
        Ok(npz.write(path)?)
    }

    /// Returns the names of the joints.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the number of frames per second.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Returns the angles, rad, shape (frames, joints).
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// Returns the pose of the root in each frame, if known.
    pub fn root(&self) -> Option<&[(Vec3, Quat)]> {
        self.root.as_deref()
    }

    /// Returns the number of frames.
    pub fn frames(&self) -> usize {
        match (&self.root, self.names.len()) {
            // a motion of the root alone has no column of angles to count
            (Some(root), 0) => root.len(),
            (_, joints) => self.angles.len().checked_div(joints).unwrap_or(0),
        }
    }

    /// Returns the time from the first frame to the last, s.
    pub fn seconds(&self) -> f64 {
        self.frames().saturating_sub(1) as f64 / self.rate
    }
}
