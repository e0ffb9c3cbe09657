//! Drawing: a [`Visual`] is built once from a [`Model`](crate::Model), and drawn from poses.
//!
//! ```
//! use babybench::config::Config;
//! use babybench::mimo::{build_model, embedded};
//! use babybench::physics::{Engine, SoftEngine, SoftOptions};
//! use babybench::render::{Poses, Renderer, View, Visual};
//!
//! let model = build_model(&Config::default(), &embedded())?;
//! let visual = Visual::new(&model, &embedded())?;
//! let camera = model.camera("corner").expect("the base scene has it");
//! let view = View { camera, width: 64, height: 64 };
//!
//! let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
//! let mut state = engine.new_state();
//! engine.forward(&mut state)?;
//! let mut image = vec![0; view.rgb_len()];
//! Renderer::new().rgb(&visual, &Poses::from(&state), &view, &mut image)?;
//! assert!(image.iter().any(|&v| v != image[0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The look is that of MuJoCo's classic renderer: its tessellations, light per vertex, textures with mip levels, four
//! samples per pixel, no shadows, no gamma. [`Renderer`] is pure Rust and gives the same bytes on every target.
//!
//! Not drawn: shadows, reflections, fog, haze. Planes without a size are drawn as far as the far plane.

mod cpu;
#[cfg(feature = "wgpu")]
pub mod gpu;
mod mesh;
mod painter;
mod texture;
mod visual;

pub use cpu::Renderer;
pub(crate) use cpu::luma;
pub use mesh::{Mesh, Part};
pub use painter::Painter;
#[cfg(all(feature = "wgpu", not(target_arch = "wasm32")))]
pub use painter::SharedGpu;
pub use texture::{Face, Level, MAX_TEXTURE, Texture};
pub use visual::{Camera, Drawable, Element, Lamp, Poses, Shape, Shot, View, Visual};

use crate::mjcf_loader::AssetError;

/// Largest width and height of a picture.
pub const MAX_SIZE: usize = 4096;

/// Why something cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// An image cannot be read.
    #[error(transparent)]
    Asset(#[from] AssetError),
    /// An image cannot be decoded.
    #[error("image \"{path}\": {message}")]
    Image {
        /// Its path.
        path: String,
        /// What is wrong.
        message: String,
    },
    /// A texture cannot be made.
    #[error("texture \"{name}\": {message}")]
    Texture {
        /// Its name.
        name: String,
        /// What is wrong.
        message: String,
    },
    /// The model has no such camera.
    #[error("there is no camera {0}; the model has {1}")]
    Camera(usize, usize),
    /// A picture that is empty or too large.
    #[error("a picture cannot have {0} x {1} pixels; allowed are 1 to {MAX_SIZE}")]
    Size(usize, usize),
    /// A buffer has the wrong length.
    #[error("the buffer for the picture has {found} values but needs {expected}")]
    Buffer {
        /// Its length.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// Poses do not fit the model.
    #[error("there are {found} poses of {what} but the model has {expected}")]
    Poses {
        /// Kind of element.
        what: &'static str,
        /// Number of poses.
        found: usize,
        /// Number of elements.
        expected: usize,
    },
    /// The configuration asks for a renderer that this build does not have.
    #[error(
        "renderer: wgpu is not in this build; build with the cargo feature `wgpu` (cargo run --features wgpu), or use \
         renderer: cpu, which needs nothing"
    )]
    NoWgpu,
    /// An environment cannot wait for the GPU.
    #[error(
        "renderer: wgpu cannot be waited for in a browser; use renderer: cpu, or draw with GpuRenderer::begin and \
         Pending::read"
    )]
    CannotWait,
    /// The GPU cannot draw.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] gpu::GpuError),
}
