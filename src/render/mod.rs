//! Rendering: a [`Scenery`] is built once from a [`Model`](mjcf_sim_model::Model), and drawn from poses.
//!
//! ```
//! use mjcf_sim::assets::MemoryAssets;
//! use mjcf_sim::mjcf_loader::load_str;
//! use mjcf_sim::physics::{Engine, SoftEngine, SoftOptions, compile};
//! use mjcf_sim::render::{Poses, RenderRequest, Renderer, Scenery, View};
//!
//! let text = "<mujoco><worldbody><light pos='0 0 3'/><geom size='.5' rgba='1 0 0 1'/>
//!   <camera name='side' pos='0 -3 0' xyaxes='1 0 0 0 0 1'/></worldbody></mujoco>";
//! let assets = MemoryAssets::new();
//! let model = compile(load_str(text, "ball.xml", &assets)?)?;
//! let mut renderer = Renderer::cpu(Scenery::new(&model, &assets)?.into());
//! let camera = model.camera("side").ok_or("no such camera")?;
//! let view = View { camera, width: 64, height: 64 };
//!
//! let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
//! let mut state = engine.new_state();
//! engine.forward(&mut state)?;
//! let mut image = vec![0; view.rgb_len()];
//! let poses = Poses::from(&state);
//! renderer.rgb(&[RenderRequest { poses, view }], [&mut image[..]])?;
//! assert!(image.iter().any(|&v| v != image[0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The look is that of MuJoCo's classic renderer: its tessellations, the grids of its planes, light per vertex, textures with mip levels, four
//! samples per pixel, no shadows, no gamma. [`Renderer::cpu`] is pure Rust and gives the same bytes on every target.
//!
//! Not drawn: shadows, reflections, fog, haze. Planes without a size are drawn as far as the far plane.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod cpu;
mod drawable;
mod flex;
#[cfg(feature = "wgpu")]
pub mod gpu;
#[cfg_attr(all(feature = "wgpu", not(target_arch = "wasm32")), path = "native_gpu.rs")]
#[cfg_attr(not(all(feature = "wgpu", not(target_arch = "wasm32"))), path = "no_gpu.rs")]
mod gpu_of_build;
mod lattice;
mod mesh;
mod model_mesh;
mod pair;
mod patch;
mod posed_skins;
mod renderer;
mod scenery;
mod single;
mod skin;
mod strip;
mod tendon;
mod texture;
mod view;
mod visible;

pub use cpu::CpuRenderer;
pub use cpu::luma;
pub use drawable::{Drawable, Element, Shape};
#[cfg(feature = "wgpu")]
pub use gpu::GpuError;
pub use gpu_of_build::SharedGpu;
pub use gpu_of_build::{draw_on, open_gpu};
pub use mesh::{Mesh, MeshPart};
pub use posed_skins::PosedSkins;
pub use renderer::Renderer;
pub use renderer::RendererPool;
pub use scenery::Scenery;
pub use scenery::{Camera, LightAim, LightSource};
pub use texture::{MAX_TEXTURE, MipChain, MipLevel, TexturePixels};
pub use view::{FreeCamera, ImageBuffers, Poses, RenderRequest, View};

use mjcf_sim_model::assets::AssetError;
use mjcf_sim_model::text::quoted;
// Paths of other files of this crate begin with `crate` for these, too.
use mjcf_sim_model::{assets, formats, limits, math, model, pool, threads};

/// Longest side of a picture, pixels.
pub const MAX_SIZE: usize = 4096;

/// An error in drawing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// An image cannot be read.
    #[error(transparent)]
    Asset(#[from] AssetError),
    /// An image cannot be decoded.
    #[error("image \"{}\": {message}", quoted(.path))]
    Image {
        /// Path of the image.
        path: String,
        /// Description of the fault.
        message: String,
    },
    /// A texture cannot be made.
    #[error("texture \"{}\": {message}", quoted(.name))]
    Texture {
        /// Name of the texture.
        name: String,
        /// Description of the fault.
        message: String,
    },
    /// The model has no such camera.
    #[error("camera {camera} does not exist: the model has {count}, numbered from 0")]
    Camera {
        /// Requested camera, by id.
        camera: usize,
        /// Number of cameras.
        count: usize,
    },
    /// The axis of the camera's lens does not meet the middle of its sensor.
    #[error(
        "pictures have their camera's axis in the middle: camera {camera} has a principal point off it; leave out principal and principalpixel"
    )]
    OffCentre {
        /// Requested camera, by id.
        camera: usize,
    },
    /// The rays of the camera are parallel.
    #[error(
        "pictures are drawn in perspective: camera {camera} is orthographic; leave that out, and put it further away with a smaller fovy"
    )]
    Orthographic {
        /// Requested camera, by id.
        camera: usize,
    },
    /// The free camera has no pose.
    #[error("the free camera has no finite pose: give Poses::free finite numbers")]
    FreeCamera,
    /// The image is empty or too large.
    #[error("an image cannot have {width} x {height} pixels; a side has 1 to {MAX_SIZE}")]
    Size {
        /// Requested width, pixels.
        width: usize,
        /// Requested height, pixels.
        height: usize,
    },
    /// The buffer has the wrong length.
    #[error("the buffer for the image has {found} values but needs {expected}")]
    Buffer {
        /// Length of the buffer.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// The poses do not fit the model.
    #[error("there are {found} poses of {what} but the model has {expected}")]
    Poses {
        /// Kind of element.
        what: &'static str,
        /// Number of poses.
        found: usize,
        /// Number of elements.
        expected: usize,
    },
    /// The configuration selects a renderer that this build does not have.
    #[error(
        "this build has no wgpu renderer: build with the cargo feature `wgpu` (cargo run --features wgpu), or use \
         renderer: cpu, which needs nothing"
    )]
    NoWgpu,
    /// An environment cannot wait for the GPU in a browser.
    #[error(
        "a browser cannot wait for renderer: wgpu; use renderer: cpu, or draw with GpuRenderer::begin and Pending::read"
    )]
    CannotWait,
    /// The GPU cannot draw.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] gpu::GpuError),
}
