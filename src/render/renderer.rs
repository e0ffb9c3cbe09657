//! The renderer that a configuration selects.

use std::sync::Arc;

use super::gpu_of_build::{SharedGpu, draw_on, scenery_of};
use super::pair::PairRenderer;
use super::{CpuRenderer, ImageBuffers, RenderError, RenderRequest, Scenery};
use crate::pool::Pool;

/// A renderer of one scene, on the CPU or on a GPU, that waits for its images.
#[derive(Debug)]
pub struct Renderer {
    scenery: Arc<Scenery>,
    backend: Backend,
}

#[derive(Debug)]
enum Backend {
    Cpu {
        memory: BufferSource,
        /// Passes over the scene's geometry by the caller's thread.
        passes: u64,
        /// The second thread, if any, which draws every second image.
        pair: Option<PairRenderer>,
    },
    Gpu(SharedGpu),
}

/// A pool of CPU renderers. Programs that draw one scene in turn share their buffers.
pub type RendererPool = Arc<Pool<CpuRenderer>>;

/// The buffers of a renderer: its own, or from a pool.
#[derive(Debug)]
enum BufferSource {
    Own(Box<CpuRenderer>),
    Shared(RendererPool),
}

impl BufferSource {
    fn lend<R>(&mut self, work: impl FnOnce(&mut CpuRenderer) -> R) -> R {
        match self {
            Self::Own(renderer) => work(renderer),
            Self::Shared(pool) => pool.lend(CpuRenderer::new, work),
        }
    }
}

/// A copy gets buffers of its own if the original has its own, or shares the pool.
impl Clone for BufferSource {
    fn clone(&self) -> Self {
        match self {
            Self::Own(_) => Self::Own(Box::default()),
            Self::Shared(pool) => Self::Shared(pool.clone()),
        }
    }
}

/// A copy draws the same scene with as many threads; on a GPU, both share the renderer.
impl Clone for Renderer {
    fn clone(&self) -> Self {
        let backend = match &self.backend {
            Backend::Cpu { memory, pair, .. } => Backend::Cpu {
                memory: memory.clone(),
                passes: 0,
                pair: pair.as_ref().map(|_| PairRenderer::default()),
            },
            Backend::Gpu(gpu) => Backend::Gpu(gpu.clone()),
        };
        Self {
            scenery: self.scenery.clone(),
            backend,
        }
    }
}

impl Renderer {
    /// Creates a renderer on the CPU.
    pub fn cpu(scenery: Arc<Scenery>) -> Self {
        Self::in_memory(scenery, BufferSource::Own(Box::default()))
    }

    /// Creates a renderer on the CPU that shares its buffers with others.
    pub fn sharing(scenery: Arc<Scenery>, memory: RendererPool) -> Self {
        Self::in_memory(scenery, BufferSource::Shared(memory))
    }

    fn in_memory(scenery: Arc<Scenery>, memory: BufferSource) -> Self {
        Self {
            scenery,
            backend: Backend::Cpu {
                memory,
                passes: 0,
                pair: None,
            },
        }
    }

    /// Creates a renderer on a GPU that others may share.
    pub fn gpu(gpu: SharedGpu) -> Self {
        Self {
            scenery: scenery_of(&gpu),
            backend: Backend::Gpu(gpu),
        }
    }

    /// Returns the scene that is drawn.
    pub fn scenery(&self) -> &Arc<Scenery> {
        &self.scenery
    }

    /// Sets whether two images are drawn at once on the CPU, by the caller and one more thread, which starts with the first
    /// such pair: 2, or 1, the default. The bytes are the same. More than 2 means 2, and 0 means 1; without the feature
    /// `parallel`, in WebAssembly, on one core, and if the system provides no thread, the caller draws alone.
    pub fn set_threads(&mut self, threads: usize) {
        match &mut self.backend {
            Backend::Cpu { pair, .. } if threads > 1 && PairRenderer::is_of_use() => drop(pair.get_or_insert_default()),
            Backend::Cpu { pair, .. } => *pair = None,
            Backend::Gpu(_) => {}
        }
    }

    /// Signals that two images will be requested within about 0.1 ms, so that the second thread can wake up in the meantime. Does
    /// nothing with one thread.
    pub fn prepare(&self) {
        if let Backend::Cpu { pair: Some(pair), .. } = &self.backend {
            pair.wake();
        }
    }

    /// Returns the number of threads that draw on the CPU, 1 or 2; 1 if images are drawn on a GPU.
    pub fn threads(&self) -> usize {
        match &self.backend {
            Backend::Cpu { pair: Some(_), .. } => 2,
            _ => 1,
        }
    }

    /// Returns the number of passes over the scene's geometry on the CPU; 0 if images are drawn on a GPU.
    pub fn passes(&self) -> u64 {
        match &self.backend {
            Backend::Cpu { passes, pair, .. } => passes + pair.as_ref().map_or(0, PairRenderer::passes),
            Backend::Gpu(_) => 0,
        }
    }

    /// Returns the renderer on the GPU; `None` if images are drawn on the CPU.
    pub fn shared_gpu(&self) -> Option<&SharedGpu> {
        match &self.backend {
            Backend::Gpu(gpu) => Some(gpu),
            Backend::Cpu { .. } => None,
        }
    }

    /// Draws images of each request, those for which there are buffers, with rows from the top. On the CPU, all images of a
    /// request come from one pass. A GPU draws all requests in one submission for each kind of image.
    ///
    /// # Errors
    /// Fails like the renderer, or if there are fewer sets of buffers than requests.
    pub fn draw<'o>(
        &mut self,
        requests: &[RenderRequest],
        images: impl IntoIterator<Item = ImageBuffers<'o>>,
    ) -> Result<(), RenderError> {
        match &mut self.backend {
            Backend::Cpu { memory, passes, pair } => memory.lend(|renderer| {
                let before = renderer.passes();
                let mut rest = pairs(requests, images);
                while let Some(first) = rest.next() {
                    match pair.as_mut().and_then(|pair| Some((pair, rest.next()?))) {
                        Some((pair, second)) => pair.draw(&self.scenery, renderer, [first, second])?,
                        None => renderer.draw(&self.scenery, &first.0.poses, &first.0.view, first.1)?,
                    }
                }
                *passes += renderer.passes() - before;
                Ok(())
            }),
            Backend::Gpu(gpu) => draw_on(gpu, requests, images),
        }
    }

    /// Draws images, each into its own memory: red, green, blue of each pixel, rows from the top.
    ///
    /// # Errors
    /// Fails like [`Renderer::draw`].
    pub fn rgb<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [u8]>,
    ) -> Result<(), RenderError> {
        self.draw(requests, outs.into_iter().map(ImageBuffers::rgb))
    }

    /// Draws gray images, one byte of brightness for each pixel: see [`CpuRenderer::gray`].
    ///
    /// # Errors
    /// Fails like [`Renderer::draw`].
    pub fn gray<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [u8]>,
    ) -> Result<(), RenderError> {
        self.draw(requests, outs.into_iter().map(ImageBuffers::gray))
    }

    /// Draws depth, the distance (m) of the surface at each pixel: see [`CpuRenderer::depth`].
    ///
    /// # Errors
    /// Fails like [`Renderer::draw`].
    pub fn depth<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [f32]>,
    ) -> Result<(), RenderError> {
        self.draw(requests, outs.into_iter().map(ImageBuffers::depth))
    }

    /// Draws geom ids, the geom at each pixel: see [`CpuRenderer::segmentation`].
    ///
    /// # Errors
    /// Fails like [`Renderer::draw`].
    pub fn segmentation<'o>(
        &mut self,
        requests: &[RenderRequest],
        outs: impl IntoIterator<Item = &'o mut [i32]>,
    ) -> Result<(), RenderError> {
        self.draw(requests, outs.into_iter().map(ImageBuffers::segmentation))
    }
}

/// Pairs requests with their buffers. A request without buffers gets one that is too short, so drawing fails.
pub(super) fn pairs<'r, 's, 'o>(
    requests: &'r [RenderRequest<'s>],
    images: impl IntoIterator<Item = ImageBuffers<'o>>,
) -> impl Iterator<Item = (&'r RenderRequest<'s>, ImageBuffers<'o>)> {
    let mut images = images.into_iter();
    requests
        .iter()
        .map(move |request| (request, images.next().unwrap_or_else(|| ImageBuffers::rgb(&mut []))))
}
