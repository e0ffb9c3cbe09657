//! Options of a vector and its resets.

use std::fmt;

use crate::threads::PARALLEL;

/// When an environment starts the next episode, as in Gymnasium's `AutoresetMode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AutoresetMode {
    /// The step after the last one resets the environment. It ignores its action and returns the first observation of the next episode.
    #[default]
    NextStep,
    /// The last step resets the environment. It returns the first observation of the next episode and keeps the last one of the old episode
    /// ([`VectorStep::finals`](super::VectorStep::finals)).
    SameStep,
    /// The caller resets the environment ([`VectorEnv::reset_where`](super::VectorEnv::reset_where)).
    Disabled,
}

/// The options of a vector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VectorOptions {
    /// When the next episode starts.
    pub autoreset: AutoresetMode,
    /// Number of threads that step environments; 0 means one for each core. Without the feature `parallel`, and on
    /// wasm32, it is one. Results do not depend on it.
    pub threads: usize,
    /// Memory that the environments may take, bytes. The default is the memory that the system reports as available (Linux), and otherwise 64 GiB (2
    /// GiB with 32-bit addresses).
    pub max_memory: Option<u64>,
    /// Number of copies of all observations that the caller keeps in addition to those of the vector; they count as memory that the
    /// environments take.
    pub kept_copies: usize,
}

/// The number of threads per core beyond which threads only take turns.
const THREADS_PER_CORE: usize = 4;

/// A notice that fewer threads were started than requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClippedThreads {
    /// Number of threads requested.
    pub wanted: usize,
    /// Number of threads started.
    pub given: usize,
    /// The reason why more would not help.
    pub because: ThreadLimit,
}

/// The reason why the number of threads is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThreadLimit {
    /// Each thread steps one environment at a time, and there are no more environments.
    Environments,
    /// There are no more cores.
    Cores,
    /// The library was built without the feature `parallel`, or for wasm32.
    Build,
}

impl fmt::Display for ClippedThreads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { wanted, given, because } = self;
        let because = match because {
            ThreadLimit::Environments => "these environments can use",
            ThreadLimit::Cores => "this machine can use",
            ThreadLimit::Build => "this build has (feature parallel)",
        };
        write!(f, "{given} instead of {wanted} threads: that is all {because}")
    }
}

/// Returns how many threads are useful, with a notice if that is fewer than requested.
pub(super) fn threads(wanted: usize, envs: usize) -> (usize, Option<ClippedThreads>) {
    let cores = if PARALLEL {
        std::thread::available_parallelism().map_or(1, usize::from)
    } else {
        1
    };
    let wanted_now = if wanted == 0 { cores } else { wanted };
    let limits = [
        (if PARALLEL { usize::MAX } else { 1 }, ThreadLimit::Build),
        (cores.saturating_mul(THREADS_PER_CORE), ThreadLimit::Cores),
        (envs, ThreadLimit::Environments),
    ];
    let mut given = wanted_now;
    let mut clipped = None;
    for (limit, because) in limits {
        if given > limit {
            given = limit;
            clipped = (wanted > 0).then_some(ClippedThreads { wanted, given, because });
        }
    }
    (given.max(1), clipped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_beyond_sense_are_clipped_and_said() {
        assert_eq!(threads(1, 5), (1, None));
        assert!(threads(0, 5).0 >= 1 && threads(0, 5).1.is_none());
        let (given, clipped) = threads(1_000_000, 3);
        let clipped = clipped.expect("that many are no use");
        assert_eq!(clipped.given, given);
        assert!(given <= 3, "{given}");
        let said = clipped.to_string();
        assert!(said.contains("instead of 1000000 threads"), "{said}");
    }
}
