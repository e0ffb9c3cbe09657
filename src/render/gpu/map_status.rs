//! The state of a buffer that is being mapped, shared by the device and the task that waits.

use std::task::Waker;

/// The result of mapping the buffer, and the task that waits for it.
#[derive(Debug, Default)]
pub struct MapStatus {
    pub mapped: Option<Result<(), wgpu::BufferAsyncError>>,
    pub waker: Option<Waker>,
}

#[cfg(target_arch = "wasm32")]
impl MapStatus {
    /// Hands over the task that waits, to be woken.
    pub fn waiting(&mut self) -> Option<Waker> {
        self.waker.take()
    }
}
