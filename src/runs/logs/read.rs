//! Records from pickles.

use std::collections::VecDeque;
use std::mem::{Discriminant, discriminant};
use std::path::Path;
use std::sync::Arc;

use super::{LogError, training_path};
use crate::env::{BehaviorInfo, Info, InfoSource};
use crate::formats::pickle::{self, PickleError, PickleKind, RecordNode, Value};
use crate::limits::Limits;
use crate::text::quoted;

/// A value of a pickle.
trait PickleField: Copy {
    fn is_dict(self) -> bool;
    fn get(self, key: &str) -> Option<Self>;
    /// Returns a nonnegative whole number.
    fn count(self) -> Option<u64>;
    /// Returns a number; 0 or 1 for false and true.
    fn number(self) -> Option<f64>;
    /// Returns a text.
    fn text(&self) -> Option<&str>;
    /// Returns a list of such numbers, within a limit.
    fn counts(self, most: usize) -> Option<Vec<usize>>;
}

impl PickleField for &Value {
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

    fn text(&self) -> Option<&str> {
        match self {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    fn counts(self, most: usize) -> Option<Vec<usize>> {
        let items = self.items().filter(|l| l.len() <= most)?;
        items.iter().map(|v| v.count().map(|n| n as usize)).collect()
    }
}

impl PickleField for RecordNode<'_, '_> {
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

    fn text(&self) -> Option<&str> {
        RecordNode::text(*self)
    }

    fn counts(self, most: usize) -> Option<Vec<usize>> {
        let items = self.items().filter(|l| l.len() <= most)?;
        items.map(|v| v.count().map(|n| n as usize)).collect()
    }
}

/// A reader of dictionaries as records, which ignores unknown keys.
struct DictSource<'l, F> {
    value: F,
    limits: &'l Limits,
    /// The name of the last task, so that all records share one allocation.
    task: &'l mut Option<Arc<str>>,
}

impl<F: PickleField> InfoSource for DictSource<'_, F> {
    type Error = String;

    fn has(&self, key: &'static str) -> bool {
        self.value.get(key).is_some()
    }

    fn count(&mut self, key: &'static str) -> Result<u64, String> {
        let number = self.value.get(key).and_then(PickleField::count);
        number.ok_or_else(|| format!("`{key}` is not a whole number"))
    }

    fn geoms(&mut self, key: &'static str) -> Result<Vec<usize>, String> {
        let (most, beyond) = (self.limits.record_touches, self.limits.geoms);
        let numbers = self.value.get(key).and_then(|list| list.counts(most));
        // ids become indices into tables of the model
        let numbers = numbers.filter(|ids| ids.iter().all(|&id| id < beyond));
        numbers.ok_or_else(|| format!("`{key}` is not a list of at most {most} geom ids below {beyond}"))
    }

    fn name(&mut self, key: &'static str) -> Result<Arc<str>, String> {
        let value = self.value.get(key);
        let name = value.as_ref().and_then(PickleField::text);
        // messages and pages show it unchanged
        let name = name.filter(|name| quoted(name) == **name);
        let name =
            name.ok_or_else(|| format!("`{key}` is not the name of a task, a line of at most 200 characters"))?;
        // thousands of records share one allocation of their task's name
        let last = self.task.take().filter(|last| **last == *name);
        Ok(self.task.insert(last.unwrap_or_else(|| name.into())).clone())
    }

    fn flag(&mut self, key: &'static str) -> Result<bool, String> {
        Ok(self.number(key)? != 0.0)
    }

    fn number(&mut self, key: &'static str) -> Result<f64, String> {
        let number = self
            .value
            .get(key)
            .and_then(PickleField::number)
            .filter(|v| v.is_finite());
        number.ok_or_else(|| format!("`{key}` is not a number"))
    }
}

/// Converts records one by one. They must have the same behavior, and their number is limited.
struct RecordConverter<'a> {
    limits: &'a Limits,
    number: usize,
    touches: usize,
    behavior: Option<Discriminant<BehaviorInfo>>,
    task: Option<Arc<str>>,
}

impl<'a> RecordConverter<'a> {
    fn new(limits: &'a Limits) -> Self {
        Self {
            limits,
            number: 0,
            touches: 0,
            behavior: None,
            task: None,
        }
    }

    fn next(&mut self, value: impl PickleField) -> Result<Info, String> {
        let (k, limits) = (self.number, self.limits);
        if k >= limits.records {
            return Err(format!("it has more than {} records", limits.records));
        }
        if !value.is_dict() {
            return Err(format!("record {k}: it is not a dictionary"));
        }
        let first = self.task.clone();
        let task = &mut self.task;
        let info = Info::read(&mut DictSource { value, limits, task }).map_err(|e| format!("record {k}: {e}"))?;
        let behavior = discriminant(&info.behavior);
        // a mean over records of two behaviors would mean nothing
        if *self.behavior.get_or_insert(behavior) != behavior || first.is_some() && first != self.task {
            return Err(format!("record {k} has a different behavior from record 0"));
        }
        self.touches += info.behavior.touches().map_or(0, |t| t[0].len() + t[1].len());
        // the memo of a pickle lets a small file hold the same list a million times
        if self.touches > limits.pickle_numbers {
            return Err("it has too many touches".to_string());
        }
        self.number += 1;
        Ok(info)
    }
}

/// Converts a list to records of one behavior.
pub(super) fn records(value: &Value, limits: &Limits) -> Result<Vec<Info>, String> {
    let items = value.items().ok_or("it is not a list of records")?;
    let mut records = RecordConverter::new(limits);
    items.iter().map(|item| records.next(item)).collect()
}

/// A fault that ends the reading of a training log.
enum ReadFault {
    Pickle(PickleError),
    Foreign(String),
}

impl From<PickleError> for ReadFault {
    fn from(error: PickleError) -> Self {
        Self::Pickle(error)
    }
}

/// Visits the records of a training log, one at a time.
pub(super) fn visit(path: &Path, limits: &Limits, each: impl FnMut(Info)) -> Result<(), LogError> {
    visit_bytes(&super::read_bytes(path, limits)?, path, limits, each)
}

/// Visits the records of the bytes of a training log. Errors name `path`.
pub(super) fn visit_bytes(
    bytes: &[u8],
    path: &Path,
    limits: &Limits,
    mut each: impl FnMut(Info),
) -> Result<(), LogError> {
    let mut records = RecordConverter::new(limits);
    let root = pickle::visit_records(bytes, limits, |node| {
        each(records.next(node).map_err(ReadFault::Foreign)?);
        Ok(())
    });
    let reason = match root {
        Ok(PickleKind::List) => return Ok(()),
        // the two kinds of logs stand side by side and are easily confused
        Ok(PickleKind::Dict(keys)) if keys.iter().any(|key| key == "qpos") => {
            "it is the log of an evaluation episode".to_string()
        }
        Ok(PickleKind::Dict(_) | PickleKind::Other) => "it is not a list of records".to_string(),
        Err(ReadFault::Foreign(reason)) => reason,
        Err(ReadFault::Pickle(source)) => {
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
/// A missing file, or one that is damaged or not a log.
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

/// Reads a training log by its path, within the given limits.
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
    /// The last records, oldest first.
    pub records: Vec<Info>,
}

/// Reads the last `most` records of a training log by its path. Memory does not depend on the others.
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
