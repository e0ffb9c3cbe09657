//! Snapshots: everything a continuation depends on, as bytes.

mod format;
mod identity;
mod memory;

pub use format::{Snapshot, SnapshotError, SnapshotInfo};
pub(super) use identity::Identity;

use std::sync::Arc;

use super::fields::InfoSource;
use super::task::TaskEvent;
use super::{BehaviorInfo, Env, InfoValue};
use crate::physics::Row as _;
use crate::sensors::transform::Sense;
use crate::spaces::NumpyRng;
use format::{ByteReader, CUT, HEADER, MAGIC, VERSION, checksum, damaged};

/// Number of vectors that a snapshot reserves.
const VECTORS: usize = 40;
/// Whole numbers that encode the values of the information.
const COUNTS: usize = 4;
/// Whole numbers at the front of the payload.
const WHOLE: usize = 6 + COUNTS;
/// The largest counter: no run reaches it, and counting from it cannot overflow.
const MAX_COUNT: u64 = 1 << 62;

impl Env {
    /// Returns the task's memory.
    fn task_memory(&self) -> Vec<f64> {
        let mut memory = Vec::new();
        self.task.save(&mut memory);
        memory
    }

    /// Returns the vectors of numbers of a snapshot, in their order; `memory` is that of the task.
    fn numbers<'a>(&'a self, memory: &'a [f64]) -> Vec<&'a [f64]> {
        let mut out = Vec::with_capacity(VECTORS);
        self.physics.dynamic().numbers(&mut out);
        out.push(&self.physics.base.eq_offset);
        out.extend(Sense::ALL.map(|sense| self.senses.numbers(sense)));
        out.extend([
            &self.goals.achieved[..],
            &self.goals.desired,
            &self.goals.terms,
            memory,
            std::slice::from_ref(&self.episode.reward),
        ]);
        out
    }

    /// Returns the vectors of [`Env::numbers`], to write to.
    fn numbers_mut<'a>(&'a mut self, memory: &'a mut [f64]) -> Vec<&'a mut [f64]> {
        let mut out = Vec::with_capacity(VECTORS);
        let (_, state, _, base) = self.physics.parts();
        state.numbers_mut(&mut out);
        out.push(&mut base.eq_offset);
        out.extend(self.senses.numbers_mut());
        out.extend([
            &mut self.goals.achieved[..],
            &mut self.goals.desired,
            &mut self.goals.terms,
            memory,
            std::slice::from_mut(&mut self.episode.reward),
        ]);
        out
    }

    /// Returns the vectors of flags of a snapshot, in their order.
    fn flags(&self) -> Vec<&[bool]> {
        let mut out = Vec::with_capacity(VECTORS);
        self.physics.dynamic().flags(&mut out);
        out.push(&self.physics.base.eq_active);
        out
    }

    /// Returns the vectors of [`Env::flags`], to write to.
    fn flags_mut(&mut self) -> Vec<&mut [bool]> {
        let mut out = Vec::with_capacity(VECTORS);
        let (_, state, _, base) = self.physics.parts();
        state.flags_mut(&mut out);
        out.push(&mut base.eq_active);
        out
    }

    /// Takes a snapshot of the current moment, which [`Env::restore`] returns to.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
    /// let mut env = Env::new(config)?;
    /// env.reset(Some(0))?;
    /// let before = env.snapshot();
    /// let action = vec![0.3; env.action_space().len()];
    /// let once = env.step(&action)?.observation.proprioception.to_vec();
    /// env.restore(&before)?;
    /// let again = env.step(&action)?.observation.proprioception.to_vec();
    /// assert_eq!(once, again);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    #[doc(alias = "mj_getState")]
    pub fn snapshot(&self) -> Snapshot {
        let (mut counts, mut lists) = ([0; COUNTS], [&[][..]; COUNTS]);
        let counted = self
            .info
            .behavior
            .fields()
            .take(COUNTS)
            .filter_map(|(_, value)| match value {
                InfoValue::Geoms(geoms) => Some((geoms.len() as u64, geoms)),
                InfoValue::Count(count) => Some((count, &[][..])),
                InfoValue::Number(number) => Some((number.to_bits(), &[][..])),
                // the task and its goals determine the rest
                _ => None,
            });
        for (k, (count, geoms)) in counted.take(COUNTS).enumerate() {
            (counts[k], lists[k]) = (count, geoms);
        }
        let memory = self.task_memory();
        let numbers = self.numbers(&memory);
        let length = HEADER + 8 * WHOLE + 8 * numbers.iter().map(|n| n.len()).sum::<usize>();
        let mut bytes = Vec::with_capacity(length + 3 * self.model().neq() + 4 * self.model().ngeom());
        bytes.extend_from_slice(&MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&[0; 4]);
        let identity = self.blueprint.identity();
        bytes.extend_from_slice(&identity.fingerprint.to_le_bytes());
        // the place of the checksum, which covers everything after it
        bytes.extend_from_slice(&[0; 8]);
        let whole = [
            self.physics.dynamic().step,
            self.episode.steps,
            self.info.steps,
            u64::from(self.episode.ready),
            self.rng.seed_value(),
            self.rng.drawn(),
        ];
        for v in whole.into_iter().chain(counts) {
            bytes.extend_from_slice(&v.to_le_bytes());
        }
        for v in numbers.into_iter().flatten() {
            bytes.extend_from_slice(&v.to_le_bytes());
        }
        bytes.extend(self.flags().into_iter().flatten().map(|&b| u8::from(b)));
        for &geom in lists.into_iter().flatten() {
            bytes.extend_from_slice(&(geom as u32).to_le_bytes());
        }
        self.save_memory(&mut bytes);
        // last, so that an error can name the keys that differ even if the numbers do not fit
        bytes.extend_from_slice(identity.keys.as_bytes());
        bytes.extend_from_slice(&(identity.keys.len() as u32).to_le_bytes());
        let sum = checksum(&bytes[HEADER..]);
        bytes[HEADER - 8..HEADER].copy_from_slice(&sum.to_le_bytes());
        Snapshot { bytes }
    }

    /// Restores a snapshot of this environment, or of another with the same configuration and scene. A MIMo who grows by a schedule gets the
    /// age of the snapshot.
    ///
    /// Touch, pain, images, poses and contacts are not in a snapshot. The next step or [`refresh`](crate::env::ManualControl::refresh)
    /// computes them. Until then [`Env::observation`] has no touch, pain and images; its other parts are the original's.
    ///
    /// # Errors
    /// A snapshot of another environment, or a damaged one, which change nothing.
    #[doc(alias = "mj_setState")]
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), SnapshotError> {
        let (content, keys) = snapshot.content()?;
        // before the fingerprints are compared, because they differ between ages
        let before = self.grow_for(snapshot, keys);
        let restored = self.restore_here(snapshot, content, keys);
        if let (Err(_), Some(before)) = (&restored, before) {
            self.shrink_back(before);
        }
        restored
    }

    /// Restores a snapshot of MIMo at his current age.
    fn restore_here(&mut self, snapshot: &Snapshot, content: &[u8], keys: &str) -> Result<(), SnapshotError> {
        if snapshot.fingerprint() != Some(self.blueprint.identity().fingerprint) {
            return Err(self.blueprint.identity().refuse(keys, SnapshotError::OtherEnvironment));
        }
        // numbers of other senses do not fit
        self.restore_content(content)
            .map_err(|e| self.blueprint.identity().refuse(keys, e))
    }

    /// Restores what follows the header of a snapshot, except its keys.
    fn restore_content(&mut self, content: &[u8]) -> Result<(), SnapshotError> {
        let mut r = ByteReader(content);
        let mut whole = [0; WHOLE];
        for v in &mut whole {
            *v = r.u64().ok_or(CUT)?;
        }
        let [step, steps, info_steps, ready, seed, drawn, counts @ ..] = whole;
        // headroom for counting; what tasks have in place of counters is a number
        // tasks store a measure's bits instead of a counter
        let counts_checked = if self.info.behavior.task().is_some() {
            &[][..]
        } else {
            &counts
        };
        if [step, steps, info_steps]
            .iter()
            .chain(counts_checked)
            .any(|c| *c > MAX_COUNT)
            || ready > 1
        {
            return Err(damaged("a counter is out of range"));
        }
        if self.physics.check_shape().is_err() {
            // a vector that a program has cleared cannot take its numbers
            let state = self.physics.reader().new_state();
            *self.physics.state_mut() = state;
            self.blueprint
                .actuation()
                .prepare(self.blueprint.model(), self.physics.state_mut());
        }
        // everything is checked before anything is written, so that a damaged snapshot changes nothing
        let (behavior, memory) = self.parse(&r, counts)?;
        // the last check, which takes back its own changes if the memory does not fit
        self.load_memory(memory)?;

        let mut memory = self.task_memory();
        for numbers in self.numbers_mut(&mut memory) {
            r.fill(numbers);
        }
        // before the information, which the task writes from its memory
        self.task.load(&memory);
        for flags in self.flags_mut() {
            r.fill_flags(flags);
        }
        self.physics.state_mut().step = step;
        self.episode.steps = steps;
        self.info.steps = info_steps;
        self.info.behavior = behavior;
        self.info.details.clear();
        self.date_body();
        self.task.inform(TaskEvent::Restored, &mut self.info);
        let reward = self.episode.reward;
        self.conclude();
        // `conclude` judges as after a step, but right after a reset the reward is 0 and nothing has ended
        (self.episode.reward, self.episode.terminated) = (reward, self.episode.terminated && steps > 0);
        self.episode.ready = ready == 1;
        // the generator's position is stored as a count, which any version of it can restore
        self.rng = NumpyRng::at(seed, drawn);
        // touch and images are not in the snapshot; showing those of the moment before would mix two moments
        self.senses.known = false;
        self.senses.forget_picture();
        Ok(())
    }

    /// Checks everything after the whole numbers except the memory of senses, and reads the information of the behavior. Also returns that memory.
    fn parse<'b>(&self, r: &ByteReader<'b>, counts: [u64; COUNTS]) -> Result<(BehaviorInfo, &'b [u8]), SnapshotError> {
        let mut r = ByteReader(r.0);
        let numbers: usize = self.numbers(&self.task_memory()).iter().map(|n| n.len()).sum();
        let flags: usize = self.flags().iter().map(|f| f.len()).sum();
        let (words, _) = r.take(8 * numbers).ok_or(CUT)?.as_chunks::<8>();
        if !words.iter().all(|w| f64::from_le_bytes(*w).is_finite()) {
            return Err(damaged("a number is not finite"));
        }
        if r.take(flags).ok_or(CUT)?.iter().any(|b| *b > 1) {
            return Err(damaged("a flag is neither 0 nor 1"));
        }
        let mut counted = SnapshotInfoSource {
            now: &self.info.behavior,
            counts: counts.into_iter(),
            ngeom: self.model().ngeom(),
            lists: r,
        };
        let behavior = BehaviorInfo::read(&mut counted)?;
        Ok((behavior, counted.lists.0))
    }
}

/// The information in a snapshot, for the current behavior of an environment.
struct SnapshotInfoSource<'n, 'b> {
    now: &'n BehaviorInfo,
    counts: std::array::IntoIter<u64, COUNTS>,
    /// Number of geoms of the scene.
    ngeom: usize,
    lists: ByteReader<'b>,
}

impl SnapshotInfoSource<'_, '_> {
    /// Returns the environment's current value of a key.
    fn now(&self, key: &str) -> Option<InfoValue<'_>> {
        self.now.fields().find(|field| field.0 == key).map(|field| field.1)
    }
}

impl InfoSource for SnapshotInfoSource<'_, '_> {
    type Error = SnapshotError;

    fn has(&self, key: &'static str) -> bool {
        self.now(key).is_some()
    }

    fn count(&mut self, _: &'static str) -> Result<u64, SnapshotError> {
        self.counts.next().ok_or(CUT)
    }

    fn geoms(&mut self, key: &'static str) -> Result<Vec<usize>, SnapshotError> {
        let (n, ngeom) = (self.count(key)?, self.ngeom);
        if n > ngeom as u64 {
            return Err(damaged("more parts are touched than exist"));
        }
        // space for all parts, as after a reset, so that later steps need not allocate
        let mut geoms = Vec::with_capacity(ngeom);
        for _ in 0..n {
            let geom = self.lists.u32().ok_or(CUT)? as usize;
            if geom >= ngeom {
                return Err(damaged("a touched part does not exist"));
            }
            geoms.push(geom);
        }
        Ok(geoms)
    }

    fn name(&mut self, _: &'static str) -> Result<Arc<str>, SnapshotError> {
        Ok(self.now.task().map_or_else(Arc::default, |task| task.task.clone()))
    }

    fn flag(&mut self, key: &'static str) -> Result<bool, SnapshotError> {
        Ok(self.now(key) == Some(InfoValue::Flag(true)))
    }

    fn number(&mut self, key: &'static str) -> Result<f64, SnapshotError> {
        let number = f64::from_bits(self.count(key)?);
        if number.is_finite() {
            Ok(number)
        } else {
            Err(damaged("a number is not finite"))
        }
    }

    /// Returns the current measures. The task's memory holds those of the snapshot, which the task reports when it is restored.
    fn measure(&mut self, key: &'static str) -> Result<f64, SnapshotError> {
        match self.now(key) {
            Some(InfoValue::Number(number)) => Ok(number),
            _ => Ok(0.0),
        }
    }
}
