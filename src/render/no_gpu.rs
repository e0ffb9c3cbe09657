//! Replaces the GPU renderer in programs without one, or that cannot wait for its images, such as a page. Its types have no
//! values, so no other code has to check how the library was built.

use std::sync::Arc;

use super::{ImageBuffers, RenderError, RenderRequest, Scenery};

/// A type without values: this build has no GPU renderer.
#[derive(Debug)]
pub enum NoGpu {}

/// A GPU renderer that several environments share. This build has none.
pub type SharedGpu = Arc<NoGpu>;

/// Returns the reason why there is no GPU.
///
/// # Errors
/// Always.
pub fn open_gpu(_: Arc<Scenery>) -> Result<SharedGpu, RenderError> {
    Err(if cfg!(feature = "wgpu") {
        RenderError::CannotWait
    } else {
        RenderError::NoWgpu
    })
}

pub(super) fn scenery_of(gpu: &SharedGpu) -> Arc<Scenery> {
    match **gpu {}
}

/// Draws nothing: there is no GPU to call it with.
///
/// # Errors
/// None.
pub fn draw_on<'o>(
    gpu: &SharedGpu,
    _: &[RenderRequest],
    _: impl IntoIterator<Item = ImageBuffers<'o>>,
) -> Result<(), RenderError> {
    match **gpu {}
}
