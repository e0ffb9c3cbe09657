//! The renderer that a configuration asks for.

use std::sync::Arc;

#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
use std::sync::{Mutex, PoisonError};

#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
use super::gpu::{Channel, Depth, GpuRenderer, Gray, Rgb, Segmentation};
use super::{CpuRenderer, RenderError, RenderRequest, Visual};

/// A renderer on a GPU that several environments share.
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
pub type SharedGpu = Arc<Mutex<GpuRenderer>>;

/// A renderer of one scene, on the CPU or on a GPU, that waits for its images.
#[derive(Debug)]
pub struct Renderer {
    visual: Arc<Visual>,
    backend: Backend,
    /// Working memory for grey images.
    colours: Vec<u8>,
}

#[derive(Debug)]
enum Backend {
    Cpu(Box<CpuRenderer>),
    #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
    Gpu(SharedGpu),
}

impl Renderer {
    /// Creates a renderer on the CPU.
    pub fn cpu(visual: Arc<Visual>) -> Self {
        Self {
            visual,
            backend: Backend::Cpu(Box::default()),
            colours: Vec::new(),
        }
    }

    /// Creates a renderer on a GPU that others may share.
    #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
    pub fn gpu(gpu: SharedGpu) -> Self {
        let visual = gpu.lock().unwrap_or_else(PoisonError::into_inner).visual().clone();
        Self {
            visual,
            backend: Backend::Gpu(gpu),
            colours: Vec::new(),
        }
    }

    /// Returns the scene that is drawn.
    pub fn visual(&self) -> &Arc<Visual> {
        &self.visual
    }

    /// Returns the renderer on the GPU; `None` if images are drawn on the CPU.
    #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
    pub fn shared_gpu(&self) -> Option<&SharedGpu> {
        match &self.backend {
            Backend::Gpu(gpu) => Some(gpu),
            Backend::Cpu(_) => None,
        }
    }

    /// Draws images, each into its own memory: red, green, blue of each pixel, rows from the top. A GPU draws them in one
    /// submission.
    ///
    /// # Errors
    /// Fails like the renderer, or if there are fewer buffers than requests.
    pub fn rgb<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [u8]>,
    ) -> Result<(), RenderError> {
        match &mut self.backend {
            Backend::Cpu(renderer) => each(requests, outs, |request, out| {
                renderer.rgb(&self.visual, &request.poses, &request.view, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Backend::Gpu(gpu) => submit::<Rgb>(gpu, requests, outs),
        }
    }

    /// Draws images in grey, one byte of brightness for each pixel: see [`CpuRenderer::gray`].
    ///
    /// # Errors
    /// Fails like [`Renderer::rgb`].
    pub fn gray<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [u8]>,
    ) -> Result<(), RenderError> {
        match &mut self.backend {
            Backend::Cpu(renderer) => each(requests, outs, |request, out| {
                self.colours.resize(request.view.rgb_len(), 0);
                renderer.gray(&self.visual, &request.poses, &request.view, &mut self.colours, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Backend::Gpu(gpu) => submit::<Gray>(gpu, requests, outs),
        }
    }

    /// Draws depth, the distance (m) of what each pixel shows: see [`CpuRenderer::depth`].
    ///
    /// # Errors
    /// Fails like [`Renderer::rgb`].
    pub fn depth<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [f32]>,
    ) -> Result<(), RenderError> {
        match &mut self.backend {
            Backend::Cpu(renderer) => each(requests, outs, |request, out| {
                renderer.depth(&self.visual, &request.poses, &request.view, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Backend::Gpu(gpu) => submit::<Depth>(gpu, requests, outs),
        }
    }

    /// Draws geom ids, the geom that each pixel shows: see [`CpuRenderer::segmentation`].
    ///
    /// # Errors
    /// Fails like [`Renderer::rgb`].
    pub fn segmentation<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [i32]>,
    ) -> Result<(), RenderError> {
        match &mut self.backend {
            Backend::Cpu(renderer) => each(requests, outs, |request, out| {
                renderer.segmentation(&self.visual, &request.poses, &request.view, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Backend::Gpu(gpu) => submit::<Segmentation>(gpu, requests, outs),
        }
    }
}

/// Draws one image after the other.
fn each<'o, T: 'o>(
    requests: &[RenderRequest],
    outs: impl IntoIterator<Item = &'o mut [T]>,
    mut draw: impl FnMut(&RenderRequest, &mut [T]) -> Result<(), RenderError>,
) -> Result<(), RenderError> {
    let mut outs = outs.into_iter();
    requests
        .iter()
        .try_for_each(|request| draw(request, outs.next().unwrap_or_default()))
}

/// Draws all images on a GPU.
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
fn submit<'o, C: Channel>(
    gpu: &SharedGpu,
    requests: &[RenderRequest],
    outs: impl IntoIterator<Item = &'o mut [C::Value]>,
) -> Result<(), RenderError> {
    let pending = gpu
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .begin::<C>(requests)?;
    pending.wait_into(outs)
}
