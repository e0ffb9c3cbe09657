//! The log of a training run.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::lines::JsonLines;
use super::read::{RecentRecords, visit, visit_bytes};
use super::{LogError, check_inside, own_folder, record, training_path, whole, write};
use crate::config::{Behavior, Compat, Config};
use crate::env::{BehaviorInfo, Info, InfoValue, PartNames, PerEyeAndHand, RegardCounts};
use crate::files::{self, Owner};
use crate::formats::pickle::{DictWriter, ListWriter};
use crate::limits::Limits;

/// Advice if only the lines of a log are left.
const LOST: &str = "it is missing, but training.jsonl beside it has records: bring it back to go on with them, or train anew, \
                    which replaces both";

/// The totals over the records of a training log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TrainingTotals {
    /// Number of records.
    pub records: usize,
    /// Number of steps.
    pub steps: u64,
    /// Number of records of a task with a goal.
    pub tasks: usize,
    /// Number of those records that ended in success.
    pub successes: usize,
    /// Sum of the returns of those records.
    pub returns: f64,
}

impl TrainingTotals {
    fn add(&mut self, info: &Info) {
        self.records += 1;
        self.steps = self.steps.saturating_add(info.steps);
        if let Some(task) = info.behavior.task() {
            self.tasks += 1;
            self.successes += usize::from(task.outcome.is_success);
            self.returns += task.episode_return;
        }
    }
}

/// The log of a training run, saved at the interval of its configuration.
///
/// Under `compat: api` every episode of at least one step is a record, and the log is saved whenever their number is a multiple of
/// `save_logs_every`. Under `compat: reference` every reset adds a record, including the first one (an empty record), and the log is
/// saved when the number of steps of the ended episode is a multiple of `save_logs_every`.
///
/// Records are kept as the bytes of the file, a few tens of bytes each.
#[derive(Clone, Debug)]
pub struct TrainingLog {
    save_dir: PathBuf,
    compat: Compat,
    save_every: u64,
    /// The bytes of `training.pkl`.
    pickle: ListWriter,
    totals: TrainingTotals,
    recent: VecDeque<Info>,
    /// All records, decoded on first use.
    records: OnceLock<Vec<Info>>,
    resumed: bool,
    lines: JsonLines,
    /// Both counters of `hand_regard` by record. Lines have both; pickles, in the kit's format, have one.
    regards: BTreeMap<usize, RegardCounts>,
    /// The lock that keeps other processes from training into the folder.
    _owner: Arc<Owner>,
}

impl TrainingLog {
    /// Maximum number of records of [`TrainingLog::recent`], which is the number that scores use.
    pub const RECENT: usize = 10_001;

    /// Creates a log in the configuration's `save_dir`, which is created if necessary. An existing log is overwritten. Until the log and
    /// its copies are dropped, other processes cannot train into that folder.
    ///
    /// # Errors
    /// A folder into which another process trains; errors of the file system.
    pub fn create(config: &Config) -> Result<Self, LogError> {
        let owner = own_folder(config.save_dir.as_ref())?;
        let log = Self::empty(config, owner, 0);
        // at once, so that a folder that cannot be written is an error before hours of training
        if log.compat == Compat::Api {
            log.save()?;
        }
        Ok(log)
    }

    fn empty(config: &Config, owner: Arc<Owner>, bytes: usize) -> Self {
        Self {
            save_dir: PathBuf::from(&config.save_dir),
            compat: config.compat,
            save_every: config.save_logs_every.max(1),
            // a resumed log grows from the size that it has
            pickle: ListWriter::with_capacity(bytes),
            totals: TrainingTotals::default(),
            recent: VecDeque::new(),
            records: OnceLock::new(),
            resumed: false,
            lines: JsonLines::default(),
            regards: BTreeMap::new(),
            _owner: owner,
        }
    }

    /// Resumes the log in the configuration's `save_dir`, or creates one if there is none. No empty record is added.
    ///
    /// # Errors
    /// A log that cannot be read, or is of another behavior; `training.jsonl` with records, but no `training.pkl`; a folder
    /// into which another process trains.
    pub fn resume(config: &Config) -> Result<Self, LogError> {
        let path = training_path(&config.save_dir);
        if !path.exists() {
            // a new log would replace the lines
            let lines = std::fs::metadata(path.with_extension("jsonl"));
            if lines.is_ok_and(|meta| meta.len() > 0) {
                return Err(LogError::Foreign {
                    path,
                    kind: "training",
                    reason: LOST.to_string(),
                });
            }
            return Self::create(config);
        }
        // its lines are copied to the new file
        check_inside(&path.with_extension("jsonl"))?;
        let mut log = Self::before(config, &path)?;
        let mut first = None;
        log.read(config, &path, &mut first, &mut |_| ())?;
        log.lines = JsonLines::of(first, log.totals.records);
        Ok(log)
    }

    /// Resumes a log as [`TrainingLog::resume`] does, with the names of the touched parts. If the log has no file of lines, like the
    /// kit's logs, they are written while it is read.
    pub(crate) fn resume_with(config: &Config, names: Option<PartNames>) -> Result<Self, LogError> {
        let path = training_path(&config.save_dir);
        let beside = path.with_extension("jsonl");
        // all lines are written only if a log has no file of lines, while its records are read anyway
        if !path.exists() || beside.exists() {
            return Ok(Self::resume(config)?.with_names(names));
        }
        let mut log = Self::before(config, &path)?;
        let (mut lines, mut first) = (JsonLines::default(), None);
        lines.set_names(names);
        lines.write_all(&beside, |each| log.read(config, &path, &mut first, each))?;
        lines.know(&beside, log.totals.records);
        log.lines = lines;
        Ok(log)
    }

    /// Returns a log without records that has capacity for those of a file.
    fn before(config: &Config, path: &Path) -> Result<Self, LogError> {
        // before the file is read, so that no other process changes it afterwards
        let owner = own_folder(config.save_dir.as_ref())?;
        let bytes = std::fs::metadata(path).map_or(0, |meta| meta.len().min(Limits::DEFAULT.pickle_bytes as u64));
        Ok(Self::empty(config, owner, bytes as usize))
    }

    /// Reads the records of a file and calls `each` for every record. Stores the first one in `first`.
    fn read(
        &mut self,
        config: &Config,
        path: &Path,
        first: &mut Option<Info>,
        each: &mut dyn FnMut(&Info),
    ) -> Result<(), LogError> {
        let known = match config.behavior {
            Behavior::HandRegard => regards_of(&path.with_extension("jsonl")),
            _ => BTreeMap::new(),
        };
        visit(path, &Limits::DEFAULT, |mut info| {
            info.details.regards = known.get(&self.totals.records).copied();
            // the first record is compared with the first line, to see whether lines belong to the log
            first.get_or_insert_with(|| info.clone());
            each(&info);
            self.push(info);
        })?;
        self.resumed = first.is_some();
        let found = first.as_ref().map(|r| r.behavior.name());
        // a name that is not a behavior's belongs to a user-defined task, which the configuration does not know
        let other = |name: &&str| Behavior::from_name(name).is_some_and(|behavior| behavior != config.behavior);
        match found.filter(other) {
            Some(found) => Err(LogError::Foreign {
                path: path.to_path_buf(),
                kind: "training",
                reason: format!("its behavior is {found}, not {}; use another save_dir", config.behavior),
            }),
            None => Ok(()),
        }
    }

    /// Returns an error for the records of another task.
    pub(crate) fn check_task(&self, task: &str) -> Result<(), LogError> {
        let last = self.recent.back().and_then(|info| info.behavior.task());
        match last.filter(|last| *last.task != *task) {
            Some(last) => Err(LogError::Foreign {
                path: training_path(&self.save_dir),
                kind: "training",
                reason: format!("its task is {}, not {task}; use another save_dir", last.task),
            }),
            None => Ok(()),
        }
    }

    /// Adds names of the touched parts to `training.jsonl`.
    #[must_use]
    pub fn with_names(mut self, names: Option<PartNames>) -> Self {
        self.lines.set_names(names);
        self
    }

    fn push(&mut self, info: Info) {
        self.regards
            .extend(info.details.regards.map(|both| (self.totals.records, both)));
        self.totals.add(&info);
        // formatted once, when an episode ends; a save then copies bytes
        self.pickle.push(|dict| fill(dict, &info));
        // only programs that ask for all records pay for keeping them
        if let Some(records) = self.records.get_mut() {
            records.push(info.clone());
        }
        // a score needs the last ten thousand records, and a run may have millions
        if self.recent.len() >= Self::RECENT {
            self.recent.pop_front();
        }
        self.recent.push_back(info);
    }

    /// Returns the records so far. The first call decodes them, a hundred bytes and more each; [`TrainingLog::recent`] and
    /// [`TrainingLog::totals`] need no decoding.
    pub fn records(&self) -> &[Info] {
        self.records.get_or_init(|| {
            let mut records = Vec::with_capacity(self.totals.records);
            // everything that was pushed can be read, except a record of another behavior, which ends a log
            let _ = self.visit(|info| records.push(info));
            records
        })
    }

    /// Visits the records so far, one at a time.
    fn visit(&self, mut each: impl FnMut(Info)) -> Result<(), LogError> {
        // everything already in memory
        let limits = Limits {
            pickle_bytes: usize::MAX,
            pickle_numbers: usize::MAX,
            pickle_objects: usize::MAX,
            records: usize::MAX,
            record_touches: usize::MAX,
            geoms: usize::MAX,
            ..Limits::DEFAULT
        };
        let mut number = 0;
        visit_bytes(
            self.pickle.as_bytes(),
            &training_path(&self.save_dir),
            &limits,
            |mut info| {
                info.details.regards = self.regards.get(&number).copied();
                number += 1;
                each(info);
            },
        )
    }

    /// Returns the last records, at most [`TrainingLog::RECENT`], and the number of all.
    pub fn recent(&self) -> RecentRecords {
        RecentRecords {
            total: self.totals.records,
            records: self.recent.iter().cloned().collect(),
        }
    }

    /// Returns the totals over the records so far.
    pub fn totals(&self) -> &TrainingTotals {
        &self.totals
    }

    /// Returns the folder of the run.
    pub fn save_dir(&self) -> &Path {
        &self.save_dir
    }

    /// Records an episode that ended after `steps` steps, and saves when due. An environment that logs ([`crate::make_env`]) does so
    /// itself; this is for programs that run many environments into one log.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn end_episode(&mut self, steps: u64, behavior: &BehaviorInfo) -> Result<(), LogError> {
        self.end(record(steps, behavior.clone()))
    }

    /// Records an episode as [`TrainingLog::end_episode`] does, including the part of its last information beyond the kit's keys: both
    /// counters of `hand_regard`, as `page_regards` and `kit_regards` in `training.jsonl`.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn end_episode_of(&mut self, steps: u64, last: &Info) -> Result<(), LogError> {
        let mut info = record(steps, last.behavior.clone());
        info.details.regards = last.details.regards;
        self.end(info)
    }

    fn end(&mut self, info: Info) -> Result<(), LogError> {
        let steps = info.steps;
        // a reset right after resuming ends no episode
        let first = std::mem::take(&mut self.resumed);
        if steps == 0 && (first || self.compat == Compat::Api) {
            return Ok(());
        }
        self.push(info);
        let count = match self.compat {
            Compat::Api => self.totals.records as u64,
            Compat::Reference => steps,
        };
        // under `compat: reference` it is the number of steps of the episode, as in the kit's code
        match count % self.save_every {
            0 => self.save(),
            _ => Ok(()),
        }
    }

    /// Writes `training.pkl` and `training.jsonl`, in which touched parts also have names (`right_hand_parts`,
    /// `left_hand_parts`), and `hand_regard` has both counters (`page_regards`, `kit_regards`).
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn save(&self) -> Result<(), LogError> {
        let path = training_path(&self.save_dir);
        let all = |each: &mut dyn FnMut(&Info)| self.visit(|info| each(&info));
        self.lines
            // lines first: if the process dies in between, the pickle is the older one, and resuming it finds that its lines do not fit
            .save(&path.with_extension("jsonl"), self.totals.records, &self.recent, all)?;
        write(path, self.pickle.as_bytes())
    }
}

/// Reads both counters of `hand_regard` from the lines of a log, by record; empty if the lines do not have them.
fn regards_of(path: &Path) -> BTreeMap<usize, RegardCounts> {
    #[derive(serde::Deserialize)]
    struct Line {
        page_regards: PerEyeAndHand<u64>,
        kit_regards: PerEyeAndHand<u64>,
    }
    // the lines are an extra: a log without them is whole
    let Ok(bytes) = files::read(path, Limits::DEFAULT.pickle_bytes as u64) else {
        return BTreeMap::new();
    };
    let lines = bytes.split(|byte| *byte == b'\n').enumerate();
    let both = lines.filter_map(|(record, line)| {
        // a line of another program lacks these counts
        let line: Line = serde_json::from_slice(line).ok()?;
        let (page, kit) = (line.page_regards, line.kit_regards);
        Some((record, RegardCounts { page, kit }))
    });
    both.take(Limits::DEFAULT.records).collect()
}

/// Writes a record with the kit's keys, in its order.
fn fill(dict: &mut DictWriter, info: &Info) {
    for (key, value) in info.fields(None) {
        match value {
            InfoValue::Count(count) => dict.int(key, whole(count)),
            InfoValue::Geoms(geoms) => dict.ints(key, geoms.iter().map(|&geom| whole(geom as u64))),
            InfoValue::Name(name) => dict.text(key, name),
            InfoValue::Flag(flag) => dict.bool(key, flag),
            InfoValue::Number(number) => dict.float(key, number),
            // details, which pickles leave out
            InfoValue::Parts(_) | InfoValue::Angles(_) | InfoValue::Counts(_) => {}
        }
    }
}
