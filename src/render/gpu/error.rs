//! The errors of rendering on a GPU.

/// A reason why images cannot be drawn on a GPU. None of them concerns the CPU renderer (`renderer: cpu`).
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
        /// The backends that were searched, and why each adapter was refused.
        tried: String,
    },
    /// A request exceeds a limit of the device.
    #[error(
        "{what} would need {needed}, but the limit of this device is {limit}; draw fewer or smaller pictures at once"
    )]
    TooLarge {
        /// The dimension that is too large.
        what: &'static str,
        /// Its size.
        needed: u64,
        /// The largest allowed.
        limit: u64,
    },
    /// The device is out of memory.
    #[error(
        "the graphics device is out of memory; draw fewer or smaller pictures at once, or use the CPU renderer (renderer: cpu)"
    )]
    OutOfMemory,
    /// The device was lost: its driver was reset, or it was removed.
    #[error("the graphics device was lost ({0}); open a new renderer")]
    Lost(String),
    /// The driver reported an error.
    #[error("the graphics device failed: {0}")]
    Device(String),
}
