//! What can go wrong on a GPU.

/// Why pictures cannot be drawn on a GPU. None of it concerns the CPU renderer (`renderer: cpu`).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter works.
    #[error(
        "no graphics adapter for wgpu ({tried}). Install a driver (Debian, Ubuntu: apt install mesa-vulkan-drivers, or \
         libegl1 libgl1-mesa-dri), choose another backend with WGPU_BACKEND=vulkan|gl|metal|dx12, or use the CPU renderer \
         (renderer: cpu), which needs nothing"
    )]
    NoAdapter {
        /// Backends, and why each adapter found was refused.
        tried: String,
    },
    /// More than the device takes at once.
    #[error("{what} would need {needed}, but this device takes {limit}; draw fewer or smaller pictures at once")]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// Its size.
        needed: u64,
        /// The largest allowed.
        limit: u64,
    },
    /// The device has no memory left.
    #[error("the graphics device is out of memory; draw fewer or smaller pictures at once, or use renderer: cpu")]
    OutOfMemory,
    /// The device is gone: its driver was reset, or it was taken away.
    #[error("the graphics device was lost ({0}); open a new renderer")]
    Lost(String),
    /// The driver refused something.
    #[error("the graphics device failed: {0}")]
    Device(String),
}
