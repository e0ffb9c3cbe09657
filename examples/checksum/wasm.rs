//! A WebAssembly module without imports: `checksum(configuration, steps)`, `vector_checksum(configuration, steps)`.

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
