//! The skin and the look of a scene's bodies, which its environments share.

use std::sync::{Arc, OnceLock};

use super::Blueprint;
use crate::assets::AssetSource;
use crate::config::RendererKind;
use crate::env::EnvError;
use crate::render::{Renderer, RendererPool, Scenery, SharedGpu, open_gpu};
use crate::sensors::SkinLayout;

/// The skin and the look of a scene's bodies.
#[derive(Clone)]
pub(super) struct SkinAndScenery {
    /// The caller's assets.
    pub(super) given: Arc<dyn AssetSource>,
    /// The same with the files of a custom scene.
    pub(super) assets: Arc<dyn AssetSource>,
    pub(super) skin: Option<Arc<SkinLayout>>,
    /// Meshes and textures, made when they are first needed.
    pub(super) scenery: Arc<OnceLock<Arc<Scenery>>>,
    /// The buffers in which the eyes of environments are drawn on the CPU.
    pub(super) painting: RendererPool,
    /// The renderer on a GPU, opened when it is first needed.
    pub(super) gpu: Arc<OnceLock<SharedGpu>>,
}

impl std::fmt::Debug for SkinAndScenery {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Surface")
            .field("skin", &self.skin)
            .finish_non_exhaustive()
    }
}

impl Blueprint {
    /// Returns the look of the scene, which its environments share.
    ///
    /// # Errors
    /// Textures that cannot be read.
    pub fn scenery(&self) -> Result<Arc<Scenery>, EnvError> {
        let shared = &self.surface.scenery;
        if let Some(scenery) = shared.get() {
            return Ok(scenery.clone());
        }
        // made outside the cell, because it may fail; if two threads make it, the first one wins
        let made = Arc::new(Scenery::new(&self.model, self.assets())?);
        Ok(shared.get_or_init(|| made).clone())
    }

    /// Makes the look of the scene with the textures of another scene of the same assets, if there is one, and keeps it.
    ///
    /// # Errors
    /// Textures that cannot be read.
    pub(super) fn make_scenery(&self, like: Option<&Scenery>) -> Result<(), EnvError> {
        if let (Some(like), None) = (like, self.surface.scenery.get()) {
            let made = Scenery::sharing(&self.model, self.assets(), like)?;
            self.surface.scenery.get_or_init(|| Arc::new(made));
        }
        self.scenery().map(drop)
    }

    /// Creates the renderer that the configuration selects. On a GPU, environments of a blueprint share one.
    ///
    /// # Errors
    /// Textures that cannot be read; for `renderer: wgpu` a missing graphics adapter, a build without it, or a browser.
    pub fn renderer(&self) -> Result<Renderer, EnvError> {
        match self.config.renderer {
            RendererKind::Cpu => Ok(Renderer::cpu(self.scenery()?)),
            RendererKind::Wgpu => Ok(Renderer::gpu(self.gpu()?)),
        }
    }

    /// Creates the renderer of an environment's eyes. The environments of the blueprint share its buffers.
    pub(crate) fn eyes_renderer(&self) -> Result<Renderer, EnvError> {
        match self.config.renderer {
            RendererKind::Cpu => Ok(Renderer::sharing(self.scenery()?, self.surface.painting.clone())),
            RendererKind::Wgpu => self.renderer(),
        }
    }

    /// Returns the GPU renderer that environments of this blueprint share, even if the configuration selects another renderer. It is
    /// opened on first use.
    ///
    /// # Errors
    /// Textures that cannot be read, a missing graphics adapter, a build without `wgpu`, or a browser.
    pub fn gpu(&self) -> Result<SharedGpu, EnvError> {
        if let Some(gpu) = self.surface.gpu.get() {
            return Ok(gpu.clone());
        }
        let opened = open_gpu(self.scenery()?)?;
        Ok(self.surface.gpu.get_or_init(|| opened).clone())
    }
}
