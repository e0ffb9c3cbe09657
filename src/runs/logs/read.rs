//! Records out of pickles.

use std::collections::VecDeque;
use std::mem::{Discriminant, discriminant};
use std::path::Path;

use super::{LogError, record, training_path};
use crate::config::Behavior;
use crate::env::{BehaviorInfo, EYE_HAND_PAIRS, Info, Outcome, PerHand, TaskInfo};
use crate::formats::pickle::{self, Node, PickleError, Root, Value};
use crate::limits::Limits;

/// A value of a pickle, in any form.
trait Field: Copy {
    fn is_dict(self) -> bool;
    fn get(self, key: &str) -> Option<Self>;
    /// Returns a whole number that is not negative.
    fn count(self) -> Option<u64>;
    /// Returns a number; 0 or 1 for false and true.
    fn number(self) -> Option<f64>;
    /// Returns the value among some names that a text has.
    fn task(self) -> Option<Behavior>;
    /// Returns a list of such numbers, within a limit.
    fn counts(self, most: usize) -> Option<Vec<usize>>;
}

impl Field for &Value {
    fn is_dict(self) -> bool {
        matches!(self, Value::Dict(_))
    }

    fn get(self, key: &str) -> Option<Self> {
        self.get(key)
    }

    fn count(self) -> Option<u64> {
        self.count()
    }

    fn number(self) -> Option<f64> {
        match self {
            Value::Bool(on) => Some(f64::from(u8::from(*on))),
            Value::Int(number) => Some(*number as f64),
            Value::Float(number) => Some(*number),
            _ => None,
        }
    }

    fn task(self) -> Option<Behavior> {
        match self {
            Value::Text(text) => Behavior::from_name(text),
            _ => None,
        }
    }

    fn counts(self, most: usize) -> Option<Vec<usize>> {
        let items = self.items().filter(|l| l.len() <= most)?;
        items.iter().map(|v| v.count().map(|n| n as usize)).collect()
    }
}

impl Field for Node<'_, '_> {
    fn is_dict(self) -> bool {
        self.is_dict()
    }

    fn get(self, key: &str) -> Option<Self> {
        self.get(key)
    }

    fn count(self) -> Option<u64> {
        self.count()
    }

    fn number(self) -> Option<f64> {
        self.number()
    }

    fn task(self) -> Option<Behavior> {
        self.text().and_then(Behavior::from_name)
    }

    fn counts(self, most: usize) -> Option<Vec<usize>> {
        let items = self.items().filter(|l| l.len() <= most)?;
        items.map(|v| v.count().map(|n| n as usize)).collect()
    }
}

/// Converts a dictionary to a record; unknown keys are ignored.
fn from_dict(value: impl Field, limits: &Limits) -> Result<Info, String> {
    if !value.is_dict() {
        return Err("it is not a dictionary".to_string());
    }
    let count = |key: &str| {
        let number = value.get(key).and_then(Field::count);
        number.ok_or_else(|| format!("`{key}` is not a whole number"))
    };
    let geoms = |key: &str| {
        let (most, beyond) = (limits.record_touches, limits.geoms);
        let numbers = value.get(key).and_then(|list| list.counts(most));
        let numbers = numbers.filter(|ids| ids.iter().all(|&id| id < beyond));
        numbers.ok_or_else(|| format!("`{key}` is not a list of at most {most} geom ids below {beyond}"))
    };
    let behavior = if value.get("right_hand_touches").is_some() {
        BehaviorInfo::SelfTouch {
            touches: PerHand {
                right_hand: geoms("right_hand_touches")?,
                left_hand: geoms("left_hand_touches")?,
            },
        }
    } else if value.get("right_eye_right_hand").is_some() {
        let [a, b, c, d] = EYE_HAND_PAIRS.map(count);
        BehaviorInfo::HandRegard {
            counts: [a?, b?, c?, d?].into(),
        }
    } else if let Some(task) = value.get("task") {
        let number = |key: &str| {
            let number = value.get(key).and_then(Field::number).filter(|v| v.is_finite());
            number.ok_or_else(|| format!("`{key}` is not a number"))
        };
        BehaviorInfo::Task(TaskInfo {
            task: task.task().ok_or("`task` is not the name of a task")?,
            outcome: Outcome {
                is_success: number("is_success")? != 0.0,
                is_failure: number("is_failure")? != 0.0,
            },
            episode_return: number("return")?,
        })
    } else {
        BehaviorInfo::None
    };
    let steps = count("steps")?;
    Ok(record(steps, behavior))
}

/// Converts records one after the other, which must be of one behavior and not too many.
struct Records<'a> {
    limits: &'a Limits,
    number: usize,
    touches: usize,
    behavior: Option<Discriminant<BehaviorInfo>>,
}

impl<'a> Records<'a> {
    fn new(limits: &'a Limits) -> Self {
        Self {
            limits,
            number: 0,
            touches: 0,
            behavior: None,
        }
    }

    fn next(&mut self, value: impl Field) -> Result<Info, String> {
        let (k, limits) = (self.number, self.limits);
        if k >= limits.records {
            return Err(format!("it has more than {} records", limits.records));
        }
        let info = from_dict(value, limits).map_err(|e| format!("record {k}: {e}"))?;
        let behavior = discriminant(&info.behavior);
        if *self.behavior.get_or_insert(behavior) != behavior {
            return Err(format!("record {k} has another behavior than record 0"));
        }
        self.touches += info.behavior.touches().map_or(0, |t| t[0].len() + t[1].len());
        if self.touches > limits.pickle_numbers {
            return Err("it has too many touches".to_string());
        }
        self.number += 1;
        Ok(info)
    }
}

/// Converts a list to records, which must be of one behavior.
pub(super) fn records(value: &Value, limits: &Limits) -> Result<Vec<Info>, String> {
    let items = value.items().ok_or("it is not a list of records")?;
    let mut records = Records::new(limits);
    items.iter().map(|item| records.next(item)).collect()
}

/// A fault that keeps a training log from being read further.
enum Stop {
    Pickle(PickleError),
    Foreign(String),
}

impl From<PickleError> for Stop {
    fn from(error: PickleError) -> Self {
        Self::Pickle(error)
    }
}

/// Hands out the records of a training log, one at a time.
pub(super) fn visit(path: &Path, limits: &Limits, each: impl FnMut(Info)) -> Result<(), LogError> {
    visit_bytes(&super::read_bytes(path, limits)?, path, limits, each)
}

/// Hands out the records of the bytes of a training log; `path` stands for them in errors.
pub(super) fn visit_bytes(
    bytes: &[u8],
    path: &Path,
    limits: &Limits,
    mut each: impl FnMut(Info),
) -> Result<(), LogError> {
    let mut records = Records::new(limits);
    let root = pickle::visit_records(bytes, limits, |node| {
        each(records.next(node).map_err(Stop::Foreign)?);
        Ok(())
    });
    let reason = match root {
        Ok(Root::List) => return Ok(()),
        Ok(Root::Dict(keys)) if keys.iter().any(|key| key == "qpos") => {
            "it is the log of an evaluation episode".to_string()
        }
        Ok(Root::Dict(_) | Root::Other) => "it is not a list of records".to_string(),
        Err(Stop::Foreign(reason)) => reason,
        Err(Stop::Pickle(source)) => {
            let path = path.to_path_buf();
            return Err(LogError::Pickle { path, source });
        }
    };
    Err(LogError::Foreign {
        path: path.to_path_buf(),
        kind: "training",
        reason,
    })
}

/// Reads the training log of a run: one record for each completed episode.
///
/// # Errors
/// No log, a file that is none, one that is damaged.
pub fn read_training(save_dir: impl AsRef<Path>) -> Result<Vec<Info>, LogError> {
    read_records(training_path(save_dir))
}

/// Reads a training log by its path.
///
/// # Errors
/// As [`read_training`].
pub fn read_records(path: impl AsRef<Path>) -> Result<Vec<Info>, LogError> {
    read_records_with(path, &Limits::DEFAULT)
}

/// Reads a training log by its path, within other limits than the default ones.
///
/// # Errors
/// As [`read_training`].
pub fn read_records_with(path: impl AsRef<Path>, limits: &Limits) -> Result<Vec<Info>, LogError> {
    let mut out = Vec::new();
    visit(path.as_ref(), limits, |info| out.push(info))?;
    Ok(out)
}

/// The last records of a training log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecentRecords {
    /// Number of records in the log.
    pub total: usize,
    /// The last of them, the oldest first.
    pub records: Vec<Info>,
}

/// Reads the last `most` records of a training log by its path. Memory does not grow with the rest.
///
/// # Errors
/// As [`read_training`].
pub fn read_recent(path: impl AsRef<Path>, most: usize) -> Result<RecentRecords, LogError> {
    let (mut total, mut last) = (0, VecDeque::new());
    visit(path.as_ref(), &Limits::DEFAULT, |info| {
        total += 1;
        last.push_back(info);
        if last.len() > most {
            last.pop_front();
        }
    })?;
    let records = last.into();
    Ok(RecentRecords { total, records })
}
