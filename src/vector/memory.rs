//! Estimates of the memory of environments, before they are made.

use super::layout::RowLayout;
use super::{AutoresetMode, VectorError, VectorOptions, options};
use crate::config::VisionOutput;
use crate::env::Env;

/// The limit for systems that do not report their memory.
const DEFAULT_LIMIT: u64 = if cfg!(target_pointer_width = "32") {
    2 << 30
} else {
    64 << 30
};

/// Memory of environments, bytes.
#[derive(Clone, Copy)]
pub(super) struct MemoryEstimate {
    /// Of a further environment.
    pub each: u64,
    /// Memory with which threads draw, regardless of the number of environments.
    pub drawing: u64,
}

impl MemoryEstimate {
    /// Estimates from an existing environment.
    ///
    /// Sizes are linear in the number of each kind of element. The factors were measured; a test compares the sum with the
    /// allocator.
    pub fn of(env: &Env, layout: &RowLayout, options: &VectorOptions, envs: usize) -> Self {
        let threads = options::threads(options.threads, envs).0;
        Self {
            each: each(env, layout, options),
            drawing: (threads * drawing(env)) as u64,
        }
    }

    /// Refuses more environments than fit.
    pub fn check(self, envs: usize, max_memory: Option<u64>) -> Result<(), VectorError> {
        let Self { each, drawing } = self;
        let limit = max_memory.or_else(available).unwrap_or(DEFAULT_LIMIT);
        let bytes = each.saturating_mul(envs as u64).saturating_add(drawing);
        if bytes <= limit {
            return Ok(());
        }
        let fit = usize::try_from(limit.saturating_sub(drawing) / each.max(1)).unwrap_or(usize::MAX);
        Err(VectorError::Memory {
            envs,
            each,
            bytes,
            limit,
            fit,
        })
    }
}

/// Returns the memory with which a thread draws what an eye sees: the visibility buffers of the larger image, 32 bytes per pixel, for colours and for
/// depth and segmentation.
fn drawing(env: &Env) -> usize {
    let Some(vision) = env.senses().vision() else { return 0 };
    let pixels = vision.views().map(|view| view.width * view.height);
    let outputs = env.config().vision_outputs;
    let any = |of: [VisionOutput; 2]| usize::from(of.iter().any(|&one| outputs.contains(one)));
    let buffers = any([VisionOutput::Rgb, VisionOutput::Gray]) + any([VisionOutput::Depth, VisionOutput::Segmentation]);
    32 * buffers * pixels.into_iter().max().unwrap_or(0)
}

/// Returns the memory of a further environment.
fn each(env: &Env, layout: &RowLayout, options: &VectorOptions) -> u64 {
    let model = env.model();
    // the array of the vector and the vector of the sense; with the ends of episodes, another of each
    let copies = if options.autoreset == AutoresetMode::SameStep {
        4
    } else {
        2
    };
    let mut rows = (copies + options.kept_copies) * layout.row_bytes();
    if options.kept_copies > 0 {
        // skin feels in few places, so that most pages of the array from which callers copy are never written
        rows -= 4 * layout.touch().unwrap_or_default();
    }
    // the dynamic state, and where the last step began; engines and the memory of pictures are shared
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
    // each infant of a population has a model, a skin and a look of his own
    let body = if env.config().individual.random > 0.0 {
        48_000 * model.ngeom()
    } else {
        0
    };
    (rows + state + computed + skin + body + env.transform_memory()) as u64
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
