//! The bytes of a snapshot: header, checksum, numbers.

use thiserror::Error;

/// First bytes of a snapshot.
pub(super) const MAGIC: [u8; 8] = *b"BBSNAP\r\n";
/// Layout of the bytes that follow.
pub(super) const VERSION: u32 = 1;
/// Magic, version, a zero, fingerprint, checksum.
pub(super) const HEADER: usize = 32;

/// An environment at one moment: [`Env::snapshot`](crate::Env::snapshot) takes it, and [`Env::restore`](crate::Env::restore) returns to
/// it.
///
/// It holds positions, velocities, controls, activations, applied forces, the start of the solver, all parameters with the locks, the
/// random generator, the goals and the memory of the task, the information and counters of the episode, the vectors of the senses that
/// report plain numbers, such as `observation` and `vestibular`, and the memory of delays, pain and other transforms. A continuation has
/// the same bits as the original, in the same environment or in another with the same configuration and scene.
///
/// The bytes are little-endian and the same on all machines: the magic `BBSNAP\r\n`, the version of the layout (`u32`), a zero (`u32`), a
/// fingerprint of configuration and scene (`u64`), a checksum of the rest (`u64`), whole numbers (`u64`), numbers (`f64`), flags (a byte
/// each), touched geoms (`u32`), memory, each part after its length (`u64`), and the keys of the configuration that differ from their
/// defaults, a line each, followed by their length (`u32`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    pub(super) bytes: Vec<u8>,
}

/// The description that a [`Snapshot`] carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "eval", derive(serde::Serialize, serde::Deserialize))]
pub struct SnapshotInfo {
    /// Version of the layout of its bytes.
    pub version: u32,
    /// Fingerprint of the configuration and the scene that it belongs to.
    pub fingerprint: u64,
    /// Physics steps since the scene was last set up.
    pub physics_steps: u64,
    /// Steps of the environment in its episode.
    pub steps: u64,
    /// Whether the episode can continue; otherwise the next step needs a reset.
    pub ready: bool,
    /// Seed of the random generator.
    pub seed: u64,
    /// Numbers that the generator has drawn since it was seeded.
    pub drawn: u64,
    /// Length of the snapshot, bytes.
    pub bytes: u64,
}

/// An error in reading or restoring a snapshot.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotError {
    /// The bytes are not a snapshot.
    #[error("these bytes are not a snapshot: they do not start with its magic bytes")]
    NotASnapshot,
    /// The snapshot was written by another version of this library.
    #[error("the snapshot has layout {found}, but this library reads layout {VERSION}")]
    Version {
        /// Version found.
        found: u32,
    },
    /// The bytes were truncated or changed.
    #[error("the snapshot is damaged: {what}")]
    Damaged {
        /// The fault.
        what: &'static str,
    },
    /// The snapshot was taken with a different configuration, or with another model ([`ModelMut::change`](crate::env::ModelMut::change)).
    #[error("the snapshot was taken with another configuration: {differences}")]
    OtherConfiguration {
        /// The differences: each key with its value then and now.
        differences: String,
    },
    /// The snapshot was taken from an environment of another scene, or of another configuration if the layout cannot tell.
    #[error(
        "the snapshot was taken with another behavior, scene, actuation model, compat, set of actuators or of senses"
    )]
    OtherEnvironment,
}

impl Snapshot {
    /// Returns the snapshot's description of itself.
    ///
    /// ```
    /// use babybench::{Config, Env};
    ///
    /// let config = Config { touch_active: false, vision_active: false, ..Config::default() };
    /// let mut env = Env::new(config)?;
    /// env.reset(Some(7))?;
    /// env.step(&vec![0.0; env.action_space().len()])?;
    /// let info = env.snapshot().info();
    /// assert_eq!((info.steps, info.seed, info.ready), (1, 7, true));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    pub fn info(&self) -> SnapshotInfo {
        // a snapshot always has its header and its whole numbers
        let mut header = ByteReader(self.bytes.get(MAGIC.len()..HEADER).unwrap_or_default());
        let (version, _, fingerprint) = (header.u32(), header.u32(), header.u64());
        let mut whole = ByteReader(self.bytes.get(HEADER..).unwrap_or_default());
        let [physics_steps, steps, _, ready, seed, drawn] = std::array::from_fn(|_| whole.u64().unwrap_or_default());
        SnapshotInfo {
            version: version.unwrap_or_default(),
            fingerprint: fingerprint.unwrap_or_default(),
            physics_steps,
            steps,
            ready: ready == 1,
            seed,
            drawn,
            bytes: self.bytes.len() as u64,
        }
    }

    /// Returns the bytes, for storage.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Reads a snapshot from stored bytes.
    ///
    /// # Errors
    /// Bytes that are not a snapshot of this version, or were truncated or changed.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, SnapshotError> {
        if !bytes.starts_with(&MAGIC) {
            return Err(SnapshotError::NotASnapshot);
        }
        let mut header = ByteReader(bytes.get(MAGIC.len()..HEADER).ok_or(CUT)?);
        let version = header.u32().ok_or(CUT)?;
        if version != VERSION {
            return Err(SnapshotError::Version { found: version });
        }
        let (zero, _, sum) = (header.u32(), header.u64(), header.u64());
        if zero != Some(0) || sum != Some(checksum(&bytes[HEADER..])) {
            return Err(damaged("the checksum does not match"));
        }
        if bytes.len() < HEADER + 8 * super::WHOLE {
            return Err(CUT);
        }
        Ok(Self { bytes })
    }

    /// Returns what follows the header: the numbers, and the keys of the configuration.
    pub(super) fn content(&self) -> Result<(&[u8], &str), SnapshotError> {
        let bytes = self.bytes.get(HEADER..).ok_or(CUT)?;
        let (rest, length) = bytes.split_last_chunk().ok_or(CUT)?;
        let length = u32::from_le_bytes(*length) as usize;
        let (numbers, keys) = rest.split_at(rest.len().checked_sub(length).ok_or(CUT)?);
        let keys = std::str::from_utf8(keys).map_err(|_| damaged("its keys are not text"))?;
        Ok((numbers, keys))
    }

    pub(crate) fn fingerprint(&self) -> Option<u64> {
        ByteReader(self.bytes.get(MAGIC.len() + 8..HEADER)?).u64()
    }
}

pub(super) fn damaged(what: &'static str) -> SnapshotError {
    SnapshotError::Damaged { what }
}

pub(super) const CUT: SnapshotError = SnapshotError::Damaged {
    what: "it is too short",
};

/// Computes a checksum, eight bytes at a time.
pub(super) fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mix = |h: u64, w: u64| (h ^ w).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let h = words
        .iter()
        .fold(bytes.len() as u64, |h, w| mix(h, u64::from_le_bytes(*w)));
    rest.iter().fold(h, |h, b| mix(h, u64::from(*b)))
}

/// A reader that takes numbers from the front of bytes.
pub(super) struct ByteReader<'a>(pub(super) &'a [u8]);

impl<'a> ByteReader<'a> {
    pub(super) fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(n)?;
        self.0 = tail;
        Some(head)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    /// Fills `out`. The length was checked before.
    pub(super) fn fill(&mut self, out: &mut [f64]) {
        let (words, _) = self.take(8 * out.len()).unwrap_or(&[]).as_chunks::<8>();
        for (v, w) in out.iter_mut().zip(words) {
            *v = f64::from_le_bytes(*w);
        }
    }

    /// Fills `out`. The length was checked before.
    pub(super) fn fill_flags(&mut self, out: &mut [bool]) {
        let bytes = self.take(out.len()).unwrap_or(&[]);
        for (v, b) in out.iter_mut().zip(bytes) {
            *v = *b != 0;
        }
    }
}
