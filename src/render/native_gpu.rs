//! A renderer on a GPU that several environments share, for programs that can wait for its images.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::gpu::{Channel, Depth, GpuRenderer, Gray, Rgb, Segmentation};
use super::renderer::pairs;
use super::{ImageBuffers, RenderError, RenderRequest, Scenery};

/// A renderer on a GPU that several environments share.
pub type SharedGpu = Arc<Mutex<GpuRenderer>>;

/// Opens a GPU for a scene.
///
/// # Errors
/// No GPU was found, or it cannot draw the scene.
pub fn open_gpu(scenery: Arc<Scenery>) -> Result<SharedGpu, RenderError> {
    Ok(Arc::new(Mutex::new(GpuRenderer::new(scenery)?)))
}

fn locked(gpu: &SharedGpu) -> MutexGuard<'_, GpuRenderer> {
    gpu.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the scene that a GPU draws.
pub(super) fn scenery_of(gpu: &SharedGpu) -> Arc<Scenery> {
    locked(gpu).scenery().clone()
}

/// Draws images on a GPU, in one submission for each kind.
///
/// # Errors
/// Fails if a request does not fit the scene or the GPU is lost.
pub fn draw_on<'o>(
    gpu: &SharedGpu,
    requests: &[RenderRequest],
    images: impl IntoIterator<Item = ImageBuffers<'o>>,
) -> Result<(), RenderError> {
    let (mut rgb, mut gray) = (Batch::<Rgb>::default(), Batch::<Gray>::default());
    let (mut depth, mut segmentation) = (Batch::<Depth>::default(), Batch::<Segmentation>::default());
    for (request, images) in pairs(requests, images) {
        rgb.add(request, images.rgb);
        gray.add(request, images.gray);
        depth.add(request, images.depth);
        segmentation.add(request, images.segmentation);
    }
    rgb.draw(gpu)?;
    gray.draw(gpu)?;
    depth.draw(gpu)?;
    segmentation.draw(gpu)
}

/// The images of one kind that a GPU draws together.
struct Batch<'r, 'o, C: Channel> {
    requests: Vec<RenderRequest<'r>>,
    outs: Vec<&'o mut [C::Value]>,
}

impl<C: Channel> Default for Batch<'_, '_, C> {
    fn default() -> Self {
        Self {
            requests: Vec::new(),
            outs: Vec::new(),
        }
    }
}

impl<'r, 'o, C: Channel> Batch<'r, 'o, C> {
    fn add(&mut self, request: &RenderRequest<'r>, out: Option<&'o mut [C::Value]>) {
        if let Some(out) = out {
            self.requests.push(*request);
            self.outs.push(out);
        }
    }

    fn draw(self, gpu: &SharedGpu) -> Result<(), RenderError> {
        if self.requests.is_empty() {
            return Ok(());
        }
        let pending = locked(gpu).begin::<C>(&self.requests)?;
        pending.wait_into(self.outs)
    }
}
