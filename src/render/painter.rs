//! The renderer that a configuration asks for.

use std::sync::Arc;

#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
use std::sync::{Mutex, PoisonError};

#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
use super::gpu::{Channel, Depth, GpuRenderer, Gray, Rgb, Segmentation};
use super::{RenderError, Renderer, Shot, Visual};

/// A renderer on a GPU that environments share.
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
pub type SharedGpu = Arc<Mutex<GpuRenderer>>;

/// Draws a scene by one renderer or another, waiting for the pictures.
#[derive(Debug)]
pub struct Painter {
    visual: Arc<Visual>,
    kind: Kind,
    /// Working space for grey pictures.
    colours: Vec<u8>,
}

#[derive(Debug)]
enum Kind {
    Cpu(Box<Renderer>),
    #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
    Gpu(SharedGpu),
}

impl Painter {
    /// By the CPU renderer.
    pub fn cpu(visual: Arc<Visual>) -> Self {
        Self {
            visual,
            kind: Kind::Cpu(Box::default()),
            colours: Vec::new(),
        }
    }

    /// By a renderer on a GPU, together with others.
    #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
    pub fn gpu(gpu: SharedGpu) -> Self {
        let visual = gpu.lock().unwrap_or_else(PoisonError::into_inner).visual().clone();
        Self {
            visual,
            kind: Kind::Gpu(gpu),
            colours: Vec::new(),
        }
    }

    /// The scene that is drawn.
    pub fn visual(&self) -> &Arc<Visual> {
        &self.visual
    }

    /// The renderer on a GPU, if it is one.
    #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
    pub fn shared_gpu(&self) -> Option<&SharedGpu> {
        match &self.kind {
            Kind::Gpu(gpu) => Some(gpu),
            Kind::Cpu(_) => None,
        }
    }

    /// Draws pictures, each into its own memory: red, green, blue of each pixel, rows from the top. A GPU draws them in one
    /// submission.
    ///
    /// # Errors
    /// As the renderers; less memory than shots.
    pub fn rgb<'o>(&mut self, shots: &[Shot], outs: impl IntoIterator<Item = &'o mut [u8]>) -> Result<(), RenderError> {
        match &mut self.kind {
            Kind::Cpu(renderer) => each(shots, outs, |shot, out| {
                renderer.rgb(&self.visual, &shot.poses, &shot.view, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Kind::Gpu(gpu) => submit::<Rgb>(gpu, shots, outs),
        }
    }

    /// As [`Painter::rgb`], one byte of brightness for each pixel: see [`Renderer::gray`].
    ///
    /// # Errors
    /// As [`Painter::rgb`].
    pub fn gray<'o>(
        &mut self,
        shots: &[Shot],
        outs: impl IntoIterator<Item = &'o mut [u8]>,
    ) -> Result<(), RenderError> {
        match &mut self.kind {
            Kind::Cpu(renderer) => each(shots, outs, |shot, out| {
                self.colours.resize(shot.view.rgb_len(), 0);
                renderer.gray(&self.visual, &shot.poses, &shot.view, &mut self.colours, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Kind::Gpu(gpu) => submit::<Gray>(gpu, shots, outs),
        }
    }

    /// As [`Painter::rgb`], the distance of what each pixel shows: see [`Renderer::depth`].
    ///
    /// # Errors
    /// As [`Painter::rgb`].
    pub fn depth<'o>(
        &mut self,
        shots: &[Shot],
        outs: impl IntoIterator<Item = &'o mut [f32]>,
    ) -> Result<(), RenderError> {
        match &mut self.kind {
            Kind::Cpu(renderer) => each(shots, outs, |shot, out| {
                renderer.depth(&self.visual, &shot.poses, &shot.view, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Kind::Gpu(gpu) => submit::<Depth>(gpu, shots, outs),
        }
    }

    /// As [`Painter::rgb`], the geom that each pixel shows: see [`Renderer::segmentation`].
    ///
    /// # Errors
    /// As [`Painter::rgb`].
    pub fn segmentation<'o>(
        &mut self,
        shots: &[Shot],
        outs: impl IntoIterator<Item = &'o mut [i32]>,
    ) -> Result<(), RenderError> {
        match &mut self.kind {
            Kind::Cpu(renderer) => each(shots, outs, |shot, out| {
                renderer.segmentation(&self.visual, &shot.poses, &shot.view, out)
            }),
            #[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
            Kind::Gpu(gpu) => submit::<Segmentation>(gpu, shots, outs),
        }
    }
}

/// Draws one picture after the other.
fn each<'o, T: 'o>(
    shots: &[Shot],
    outs: impl IntoIterator<Item = &'o mut [T]>,
    mut draw: impl FnMut(&Shot, &mut [T]) -> Result<(), RenderError>,
) -> Result<(), RenderError> {
    let mut outs = outs.into_iter();
    shots
        .iter()
        .try_for_each(|shot| draw(shot, outs.next().unwrap_or_default()))
}

/// Draws all pictures on a GPU.
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
fn submit<'o, C: Channel>(
    gpu: &SharedGpu,
    shots: &[Shot],
    outs: impl IntoIterator<Item = &'o mut [C::Value]>,
) -> Result<(), RenderError> {
    let pending = gpu.lock().unwrap_or_else(PoisonError::into_inner).begin::<C>(shots)?;
    pending.wait_into(outs)
}
