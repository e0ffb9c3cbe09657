//! Snapshots: everything a continuation depends on, as bytes.

use thiserror::Error;

use crate::config::{Behavior, Config};
use crate::env::{BehaviorInfo, Env, NumpyRng};
use crate::model::Model;

/// First bytes of a snapshot.
const MAGIC: [u8; 8] = *b"BBSNAP\r\n";
/// Layout of the bytes that follow.
const VERSION: u32 = 1;
/// Magic, version, a zero, fingerprint, checksum.
const HEADER: usize = 32;

/// An environment at one moment: [`Env::snapshot`] takes it, [`Env::restore`] goes back to it.
///
/// It holds positions, velocities, controls, applied forces, the start of the solver, all parameters with the locks, what
/// the actuation model remembers, the random generator, the information and counters of the episode, and the vectors
/// `observation` and `vestibular`. A continuation from it has the same bits as the original, in the same environment or
/// in another of the same configuration and scene.
///
/// The bytes are little-endian and the same on all machines: the magic `BBSNAP\r\n`, the version of the layout (`u32`), a
/// zero (`u32`), a fingerprint of configuration and scene (`u64`), a checksum of what follows (`u64`), whole numbers
/// (`u64`), numbers (`f64`), flags (a byte each), touched geoms (`u32`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    bytes: Vec<u8>,
}

/// Why bytes are no snapshot, or not one of this environment.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotError {
    /// The bytes are something else.
    #[error("these bytes are not a snapshot: they do not begin with its magic")]
    NotASnapshot,
    /// Written by another version of this library.
    #[error("the snapshot has layout {found}, but this library reads layout {VERSION}")]
    Version {
        /// Version found.
        found: u32,
    },
    /// The bytes were cut or changed.
    #[error("the snapshot is damaged: {what}")]
    Damaged {
        /// What is wrong.
        what: &'static str,
    },
    /// Taken from an environment of another configuration or scene.
    #[error("the snapshot is of another behavior, scene, actuation model, compat or set of actuators")]
    OtherEnvironment,
}

impl Snapshot {
    /// The bytes, to be kept.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// From bytes that were kept.
    ///
    /// # Errors
    /// Bytes that are no snapshot of this version, or were cut or changed.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, SnapshotError> {
        if !bytes.starts_with(&MAGIC) {
            return Err(SnapshotError::NotASnapshot);
        }
        let mut header = Reader(bytes.get(MAGIC.len()..HEADER).ok_or(CUT)?);
        let version = header.u32().ok_or(CUT)?;
        if version != VERSION {
            return Err(SnapshotError::Version { found: version });
        }
        let (zero, _, sum) = (header.u32(), header.u64(), header.u64());
        if zero != Some(0) || sum != Some(checksum(&bytes[HEADER..])) {
            return Err(damaged("the checksum does not fit"));
        }
        Ok(Self { bytes })
    }

    fn fingerprint(&self) -> Option<u64> {
        Reader(self.bytes.get(MAGIC.len() + 8..HEADER)?).u64()
    }
}

fn damaged(what: &'static str) -> SnapshotError {
    SnapshotError::Damaged { what }
}

const CUT: SnapshotError = SnapshotError::Damaged {
    what: "it is too short",
};

/// Of eight bytes at a time.
fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mix = |h: u64, w: u64| (h ^ w).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let h = words
        .iter()
        .fold(bytes.len() as u64, |h, w| mix(h, u64::from_le_bytes(*w)));
    rest.iter().fold(h, |h, b| mix(h, u64::from(*b)))
}

/// Of what decides the meaning of a snapshot: names and masses of the scene, and what of the configuration shapes an
/// environment's memory.
pub(super) fn fingerprint(model: &Model, config: &Config) -> u64 {
    let mut bytes = Vec::new();
    for names in [
        &model.body_name,
        &model.jnt_name,
        &model.actuator_name,
        &model.geom_name,
    ] {
        for name in names {
            bytes.extend_from_slice(name.as_bytes());
            bytes.push(0);
        }
        bytes.push(1);
    }
    for v in model.qpos0.iter().chain(&model.body_mass) {
        bytes.extend_from_slice(&v.to_le_bytes());
    }
    for name in [
        config.behavior.name(),
        config.scene.name(),
        config.actuation_model.name(),
        config.compat.name(),
        config.engine.name(),
    ] {
        bytes.extend_from_slice(name.as_bytes());
        bytes.push(0);
    }
    checksum(&bytes)
}

/// Takes numbers from the front of bytes.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(n)?;
        self.0 = tail;
        Some(head)
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn u64(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    /// Fills `out`. The length was checked before.
    fn fill(&mut self, out: &mut [f64]) {
        let (words, _) = self.take(8 * out.len()).unwrap_or(&[]).as_chunks::<8>();
        for (v, w) in out.iter_mut().zip(words) {
            *v = f64::from_le_bytes(*w);
        }
    }

    /// Fills `out`. The length was checked before.
    fn fill_flags(&mut self, out: &mut [bool]) {
        let bytes = self.take(out.len()).unwrap_or(&[]);
        for (v, b) in out.iter_mut().zip(bytes) {
            *v = *b != 0;
        }
    }
}

/// Whole numbers at the front of the payload.
const WHOLE: usize = 10;
/// The largest counter: no run gets there, and counting on from it does not overflow.
const MAX_COUNT: u64 = 1 << 62;

impl Env {
    /// Vectors of numbers of a snapshot, in their order.
    fn numbers(&self) -> Vec<&[f64]> {
        let (s, p) = (&self.state, &self.state.params);
        let mut all: Vec<&[f64]> = vec![
            std::slice::from_ref(&s.time),
            &s.qpos,
            &s.qvel,
            &s.ctrl,
            &s.qfrc_applied,
            &s.qacc_warmstart,
            &p.eq_offset,
            &p.jnt_stiffness,
            &p.dof_damping,
            &p.actuator_gear,
            &self.base.eq_offset,
            &self.proprioception_values,
            &self.vestibular_values,
        ];
        all.extend(self.actuation.memory());
        all
    }

    /// [`Env::numbers`], to write them.
    fn numbers_mut(&mut self) -> Vec<&mut [f64]> {
        let s = &mut self.state;
        let p = &mut s.params;
        let mut all: Vec<&mut [f64]> = vec![
            std::slice::from_mut(&mut s.time),
            &mut s.qpos,
            &mut s.qvel,
            &mut s.ctrl,
            &mut s.qfrc_applied,
            &mut s.qacc_warmstart,
            &mut p.eq_offset,
            &mut p.jnt_stiffness,
            &mut p.dof_damping,
            &mut p.actuator_gear,
            &mut self.base.eq_offset,
            &mut self.proprioception_values,
            &mut self.vestibular_values,
        ];
        all.extend(self.actuation.memory_mut());
        all
    }

    fn flags(&self) -> [&[bool]; 3] {
        let p = &self.state.params;
        [&p.eq_active, &p.actuator_forcelimited, &self.base.eq_active]
    }

    /// The present moment, to come back to with [`Env::restore`].
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
    /// let mut env = Env::new(config)?;
    /// env.reset(Some(0))?;
    /// let before = env.snapshot();
    /// let action = vec![0.3; env.action_space().len()];
    /// let once = env.step(&action)?.observation.observation.to_vec();
    /// env.restore(&before)?;
    /// let again = env.step(&action)?.observation.observation.to_vec();
    /// assert_eq!(once, again);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    pub fn snapshot(&self) -> Snapshot {
        let (counts, lists): ([u64; 4], [&[usize]; 2]) = match &self.info.behavior {
            BehaviorInfo::None => ([0; 4], [&[], &[]]),
            BehaviorInfo::SelfTouch {
                right_hand_touches: r,
                left_hand_touches: l,
            } => ([r.len() as u64, l.len() as u64, 0, 0], [r, l]),
            BehaviorInfo::HandRegard {
                right_eye_right_hand: a,
                right_eye_left_hand: b,
                left_eye_right_hand: c,
                left_eye_left_hand: d,
            } => ([*a, *b, *c, *d], [&[], &[]]),
        };
        let numbers = self.numbers();
        let length = HEADER + 8 * WHOLE + 8 * numbers.iter().map(|n| n.len()).sum::<usize>();
        let mut bytes = Vec::with_capacity(length + 3 * self.model().neq() + 4 * self.model().ngeom());
        bytes.extend_from_slice(&MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&[0; 4]);
        bytes.extend_from_slice(&self.fingerprint.to_le_bytes());
        bytes.extend_from_slice(&[0; 8]);
        let whole = [
            self.state.step,
            self.steps,
            self.info.steps,
            u64::from(self.ready),
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
        let sum = checksum(&bytes[HEADER..]);
        bytes[HEADER - 8..HEADER].copy_from_slice(&sum.to_le_bytes());
        Snapshot { bytes }
    }

    /// Goes back to a snapshot of this environment, or of another of the same configuration and scene. Whatever is not in
    /// a snapshot (touch, images, poses, contacts) is brought up to date by the next step.
    ///
    /// # Errors
    /// A snapshot of another environment, or a damaged one; nothing is changed then.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), SnapshotError> {
        if snapshot.fingerprint() != Some(self.fingerprint) {
            return Err(SnapshotError::OtherEnvironment);
        }
        let mut r = Reader(snapshot.bytes.get(HEADER..).ok_or(CUT)?);
        let mut whole = [0; WHOLE];
        for v in &mut whole {
            *v = r.u64().ok_or(CUT)?;
        }
        let [step, steps, info_steps, ready, seed, drawn, counts @ ..] = whole;
        // room to count on
        if [step, steps, info_steps].iter().chain(&counts).any(|c| *c > MAX_COUNT) || ready > 1 {
            return Err(damaged("a counter is out of range"));
        }
        let behavior = self.parse(&r, counts)?;

        for numbers in self.numbers_mut() {
            r.fill(numbers);
        }
        let p = &mut self.state.params;
        for flags in [&mut p.eq_active, &mut p.actuator_forcelimited, &mut self.base.eq_active] {
            r.fill_flags(flags);
        }
        self.state.step = step;
        self.steps = steps;
        self.info.steps = info_steps;
        self.info.behavior = behavior;
        self.info.details.clear();
        self.watcher.describe(None, &mut self.info);
        self.ready = ready == 1;
        self.rng = NumpyRng::at(seed, drawn);
        Ok(())
    }

    /// Checks everything that follows the whole numbers, and reads the information of the behavior.
    fn parse(&self, r: &Reader, counts: [u64; 4]) -> Result<BehaviorInfo, SnapshotError> {
        let mut r = Reader(r.0);
        let numbers: usize = self.numbers().iter().map(|n| n.len()).sum();
        let flags: usize = self.flags().iter().map(|f| f.len()).sum();
        let (words, _) = r.take(8 * numbers).ok_or(CUT)?.as_chunks::<8>();
        if !words.iter().all(|w| f64::from_le_bytes(*w).is_finite()) {
            return Err(damaged("a number is not finite"));
        }
        if r.take(flags).ok_or(CUT)?.iter().any(|b| *b > 1) {
            return Err(damaged("a flag is neither 0 nor 1"));
        }
        let ngeom = self.model().ngeom();
        let mut list = |n: u64| {
            if n > ngeom as u64 {
                return Err(damaged("more parts are touched than there are"));
            }
            // room for all parts, as after a reset, so that later steps need not allocate
            let mut geoms = Vec::with_capacity(ngeom);
            for _ in 0..n {
                let geom = r.u32().ok_or(CUT)? as usize;
                if geom >= ngeom {
                    return Err(damaged("a touched part does not exist"));
                }
                geoms.push(geom);
            }
            Ok(geoms)
        };
        let [a, b, c, d] = counts;
        let behavior = match self.config().behavior {
            Behavior::None => BehaviorInfo::None,
            Behavior::SelfTouch => BehaviorInfo::SelfTouch {
                right_hand_touches: list(a)?,
                left_hand_touches: list(b)?,
            },
            Behavior::HandRegard => BehaviorInfo::HandRegard {
                right_eye_right_hand: a,
                right_eye_left_hand: b,
                left_eye_right_hand: c,
                left_eye_left_hand: d,
            },
        };
        if r.0.is_empty() {
            Ok(behavior)
        } else {
            Err(damaged("it is too long"))
        }
    }
}
