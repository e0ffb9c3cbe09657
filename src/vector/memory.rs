//! Estimates of the memory of environments, before they are made.

use crate::env::Env;
use crate::vector::rows::Layout;
use crate::vector::{AutoresetMode, VectorError};

/// The limit on systems that do not report their memory.
const DEFAULT_LIMIT: u64 = if cfg!(target_pointer_width = "32") {
    2 << 30
} else {
    64 << 30
};

/// Estimates the memory of a further environment, bytes, from one that is built.
///
/// Sizes are linear in the number of each kind of element. The factors were measured; a test compares the sum with the allocator.
pub(super) fn estimate(env: &Env, layout: &Layout, mode: AutoresetMode) -> u64 {
    let model = env.model();
    // the array of the vector and the vector of the sense; twice with the ends of episodes
    let copies = if mode == AutoresetMode::SameStep { 4 } else { 2 };
    let rows = copies * layout.row_bytes();
    // what decides how the run continues, and the arguments of the last step; engines and buffers of pictures are shared
    let state = 4_000 + 64 * model.nv + 50 * model.nbody();
    let computed = if env.shares() {
        0
    } else {
        // with space for contacts and their rows
        300_000 + 300 * model.ngeom() + 1_600 * model.nv
    };
    let skin = env
        .senses()
        .touch()
        .map_or(0, |touch| 24_000 + 7 * touch.layout().len());
    (rows + state + computed + skin + env.transform_memory()) as u64
}

/// Returns an error if the environments do not fit.
pub(super) fn check(envs: usize, each: u64, max_memory: Option<u64>) -> Result<(), VectorError> {
    let limit = max_memory.or_else(available).unwrap_or(DEFAULT_LIMIT);
    let bytes = each.saturating_mul(envs as u64);
    if bytes <= limit {
        return Ok(());
    }
    let fit = usize::try_from(limit / each.max(1)).unwrap_or(usize::MAX);
    Err(VectorError::Memory {
        envs,
        each,
        bytes,
        limit,
        fit,
    })
}

/// Returns the memory available from the system and the container, bytes, if they report it.
fn available() -> Option<u64> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.split_whitespace().next()?.parse().ok()?;
    let system = kib.saturating_mul(1024);
    let number = |name| {
        let text = std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?;
        text.trim().parse::<u64>().ok() // "max" means no limit
    };
    let container = number("memory.max").map(|max| max.saturating_sub(number("memory.current").unwrap_or(0)));
    Some(container.map_or(system, |container| container.min(system)))
}
