//! A WebAssembly module without imports: `checksum(configuration, steps)`, `vector_checksum(configuration, steps)`,
//! `snapshot_checksum(configuration)`.

mod episode;

/// Returns the checksum of an episode; see `episode.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn checksum(configuration: u32, steps: u32) -> u64 {
    episode::checksum(configuration as usize, steps as usize)
}

/// Returns the checksum of a vector of environments, which has one thread here; see `episode.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn vector_checksum(configuration: u32, steps: u32) -> u64 {
    episode::vector_checksum(configuration as usize, steps as usize, 7)
}

/// Returns the checksum of a snapshot and what follows it; see `episode.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn snapshot_checksum(configuration: u32) -> u64 {
    episode::snapshot_checksum(configuration as usize)
}
