//! Rendering on a GPU, many images at once: any number of views of any number of environments in one submission and
//! one transfer (cargo feature `wgpu`).
//!
//! ```no_run
//! use mjcf_sim::assets::FileSystem;
//! use mjcf_sim::mjcf_loader::load;
//! use mjcf_sim::physics::{Batch, SoftOptions, compile};
//! use mjcf_sim::render::gpu::{GpuRenderer, Rgb};
//! use mjcf_sim::render::{Poses, RenderRequest, Scenery, View};
//!
//! let (assets, file) = FileSystem::beside("arm.xml")?;
//! let model = compile(load(&assets, &file)?)?;
//! let mut gpu = GpuRenderer::new(Scenery::new(&model, &assets)?.into())?;
//! let mut batch = Batch::new(model.into(), SoftOptions::default(), 64);
//! batch.rollout(10, |index, _step, state| state.ctrl[0] = index as f64)?;
//! let view = View { camera: 0, width: 64, height: 64 };
//! let requests: Vec<_> = batch.states().iter().map(|state| RenderRequest { poses: Poses::from(state), view }).collect();
//! let pending = gpu.begin::<Rgb>(&requests)?; // the device works; so may we
//! let images = pending.wait()?; // 64 x 64 x 64 x 3
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The look is that of the CPU renderer, from the same scene. The bytes are not: they depend on the device and its driver,
//! and the invariant of equal bits does not cover them. On one device and driver they are the same every time, and a
//! image does not depend on what else is drawn with it.
//!
//! In browsers nothing can wait for a device: open with [`GpuRenderer::open`] and read with [`Pending::read`]. WebGL needs a
//! canvas, so there the application opens the device: [`GpuRenderer::with_device`].

mod atlas;
mod buffers;
mod channel;
mod device;
mod error;
mod frame;
mod map_status;
mod pending;
mod pipelines;
mod scene;
mod target;
#[cfg(target_arch = "wasm32")]
mod timer;

pub use channel::{Channel, Depth, Gray, Rgb, Segmentation};
pub use error::GpuError;
pub use pending::{Images, Pending};
/// The version of wgpu whose devices [`GpuRenderer::with_device`] takes.
pub use wgpu;

use std::sync::{Arc, PoisonError};

use atlas::Atlas;
use buffers::{Buffers, fits};
use device::Gpu;
use frame::{Submission, SubmissionData};
use pending::{BufferPool, Slot};
use pipelines::{ColourSource, Layouts, Output, Pipelines, Style};
use scene::GpuScene;
use target::Attachments;

use crate::{RenderError, RenderRequest, Scenery};

/// Format of colours: linear, without gamma.
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A renderer of one scene on a GPU.
#[derive(Debug)]
pub struct GpuRenderer {
    gpu: Gpu,
    scenery: Arc<Scenery>,
    layouts: Layouts,
    pipelines: Pipelines,
    scene: GpuScene,
    frame: SubmissionData,
    buffers: Buffers,
    /// Targets for [`Output::Colour`] and [`Output::Measure`].
    targets: [Option<Attachments>; 2],
    pool: BufferPool,
    apart: bool,
    submissions: u64,
}

/// Describes the adapters of this machine, the best first, as [`GpuRenderer::adapter`] does. OpenGL is searched only if no other backend finds a GPU;
/// `WGPU_BACKEND` narrows the search.
#[cfg(not(target_arch = "wasm32"))]
pub fn adapters() -> Vec<String> {
    device::descriptions()
}

impl GpuRenderer {
    /// Opens the best adapter of this machine: a GPU before software, OpenGL last among equals. `WGPU_BACKEND` (vulkan,
    /// gl, metal, dx12) and `WGPU_ADAPTER_NAME` (a part of it) narrow the choice.
    ///
    /// # Errors
    /// Fails if there is no adapter, or the scene does not fit on the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn new(scenery: Arc<Scenery>) -> Result<Self, GpuError> {
        pollster::block_on(Self::open(scenery))
    }

    /// Opens the best adapter without blocking, as browsers need; see [`GpuRenderer::new`].
    ///
    /// # Errors
    /// Fails like [`GpuRenderer::new`].
    pub async fn open(scenery: Arc<Scenery>) -> Result<Self, GpuError> {
        Self::on(Gpu::open().await?, scenery)
    }

    /// Uses a device that the application has opened, with at least the limits
    /// `wgpu::Limits::downlevel_webgl2_defaults()`. The renderer takes over its handlers of lost devices and of errors
    /// outside error scopes.
    ///
    /// # Errors
    /// Fails if the scene does not fit on the device.
    pub fn with_device(device: wgpu::Device, queue: wgpu::Queue, scenery: Arc<Scenery>) -> Result<Self, GpuError> {
        Self::on(Gpu::new(device, queue), scenery)
    }

    fn on(gpu: Gpu, scenery: Arc<Scenery>) -> Result<Self, GpuError> {
        let layouts = Layouts::new(&gpu);
        let scene = GpuScene::new(&gpu, &layouts, &scenery);
        let renderer = Self {
            pipelines: Pipelines::new(&gpu),
            frame: SubmissionData::default(),
            buffers: Buffers::new(&gpu, &layouts, &scene.lights, 256, 2),
            targets: [None, None],
            pool: BufferPool::default(),
            apart: gpu.software,
            submissions: 0,
            gpu,
            scenery,
            layouts,
            scene,
        };
        renderer.gpu.check()?;
        Ok(renderer)
    }

    /// Describes the adapter: name, backend, kind, driver.
    pub fn adapter(&self) -> &str {
        &self.gpu.name
    }

    /// Returns whether the adapter is a program on the CPU, such as Mesa's llvmpipe. The CPU renderer is faster then.
    pub fn is_software(&self) -> bool {
        self.gpu.software
    }

    /// Chooses whether each image of a submission is drawn in its own pass, instead of many in one. That is the
    /// default on software adapters: they gain nothing from large passes, and rounding errors grow with the distance from the corner of a texture.
    pub fn draw_apart(&mut self, apart: bool) {
        self.apart = apart;
    }

    /// Returns the scene that is drawn.
    pub fn scenery(&self) -> &Arc<Scenery> {
        &self.scenery
    }

    /// Returns the number of submissions to the device so far.
    pub fn submissions(&self) -> u64 {
        self.submissions
    }

    /// Starts drawing. Submissions are processed in order; more can be started before earlier ones are read.
    ///
    /// # Errors
    /// Fails like the CPU renderer for each request, if there are more images than the device takes, or if the device is
    /// lost, out of memory or failing.
    pub fn begin<C: Channel>(&mut self, requests: &[RenderRequest]) -> Result<Pending<C>, RenderError> {
        self.gpu.check()?;
        for request in requests {
            self.scenery.check(&request.poses, &request.view)?;
        }
        if requests.is_empty() {
            return Ok(Pending::none(&self.gpu));
        }
        let limits = self.gpu.device.limits();
        let atlas = Atlas::new(
            requests.iter().map(|s| s.view),
            limits.max_texture_dimension_2d,
            self.apart,
        )?;
        let (slots, bytes) = layout(&atlas, C::OUTPUT);
        fits("the pictures, in bytes,", bytes, limits.max_buffer_size)?;
        let size = self.target(C::OUTPUT, &atlas);
        self.frame.build(&Submission {
            scenery: &self.scenery,
            scene: &self.scene,
            requests,
            atlas: &atlas,
            size,
            output: C::OUTPUT,
        });
        self.buffers.write(
            &self.gpu,
            &self.layouts,
            &self.scene.lights,
            &self.frame,
            requests.len(),
        )?;
        let buffer = self.readback(bytes);
        let commands = self.encode(C::OUTPUT, &atlas, &slots, &buffer);
        let submission = self.gpu.queue.submit([commands]);
        self.submissions += 1;
        self.gpu.check()?;
        Ok(Pending::new(&self.gpu, slots, buffer, submission, &self.pool))
    }

    /// Draws and waits.
    ///
    /// # Errors
    /// Fails like [`GpuRenderer::begin`] and [`Pending::read`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn draw<C: Channel>(&mut self, requests: &[RenderRequest]) -> Result<Images<C>, RenderError> {
        self.begin::<C>(requests)?.wait()
    }

    /// Ensures that there are attachments for all chunks, and returns their size.
    fn target(&mut self, output: Output, atlas: &Atlas) -> [u32; 2] {
        let slot = &mut self.targets[output as usize];
        let most = |k: usize| atlas.chunks.iter().map(|c| c[k]).max().unwrap_or(1);
        let needed = [most(0), most(1)];
        let old = slot.as_ref().map_or([0, 0], |t| t.size);
        if old[0] >= needed[0] && old[1] >= needed[1] {
            return old;
        }
        // room for both, so that alternating sizes do not allocate every time, unless that takes much memory
        let both = [needed[0].max(old[0]), needed[1].max(old[1])];
        let size = if both[0].max(both[1]) <= atlas::SIDE {
            both
        } else {
            needed
        };
        // the old attachments go before the new ones are made: both at once might not fit
        *slot = None;
        *slot = Some(Attachments::new(&self.gpu, output, size));
        size
    }

    /// Returns a buffer for reading images back, from the pool if one fits.
    fn readback(&self, bytes: u64) -> wgpu::Buffer {
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        // not much larger than needed, or one large submission would keep its memory for ever
        let fitting = pool.iter().position(|b| (bytes..=4 * bytes).contains(&b.size()));
        match fitting {
            Some(k) => pool.swap_remove(k),
            None => {
                // sizes have changed: buffers that do not fit now would only pile up
                pool.clear();
                self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("readback"),
                    size: bytes,
                    usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                    mapped_at_creation: false,
                })
            }
        }
    }

    fn encode(&self, output: Output, atlas: &Atlas, slots: &[Slot], buffer: &wgpu::Buffer) -> wgpu::CommandBuffer {
        let label = Some("pictures");
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let Some(target) = &self.targets[output as usize] else {
            return encoder.finish();
        };
        for (chunk, [width, height]) in self.frame.chunks.iter().zip(&atlas.chunks) {
            let mut pass = Pass {
                renderer: self,
                pass: target.pass(&mut encoder),
                style: None,
                texture: None,
            };
            pass.chunk(output, chunk, &atlas.tiles, target.size);
            drop(pass);
            // the first image lies in the corner
            let Slot { offset, pitch, .. } = slots[chunk.views.start];
            encoder.copy_texture_to_buffer(
                target.resolved.as_image_copy(),
                wgpu::TexelCopyBufferInfo {
                    buffer,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: offset as u64,
                        bytes_per_row: Some(pitch as u32),
                        rows_per_image: None,
                    },
                },
                wgpu::Extent3d {
                    width: *width,
                    height: *height,
                    depth_or_array_layers: 1,
                },
            );
        }
        encoder.finish()
    }
}

/// Returns where the images lie in the buffer that is read back, and the size of the buffer in bytes.
fn layout(atlas: &Atlas, output: Output) -> (Vec<Slot>, u64) {
    let pixel = output.bytes();
    let mut starts = Vec::with_capacity(atlas.chunks.len());
    let mut end = 0;
    for &[width, height] in &atlas.chunks {
        let pitch = (width * pixel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT) as usize;
        starts.push((end, pitch));
        end += pitch * height as usize;
    }
    let slot = |t: &atlas::Tile| {
        let (start, pitch) = starts[t.chunk];
        Slot {
            offset: start + t.y as usize * pitch + (t.x * pixel) as usize,
            pitch,
            width: t.width as usize,
            height: t.height as usize,
        }
    };
    (atlas.tiles.iter().map(slot).collect(), end as u64)
}

/// A render pass with its current state.
struct Pass<'r, 'e> {
    renderer: &'r GpuRenderer,
    pass: wgpu::RenderPass<'e>,
    style: Option<Style>,
    texture: Option<usize>,
}

impl Pass<'_, '_> {
    fn chunk(&mut self, output: Output, chunk: &frame::Chunk, tiles: &[atlas::Tile], size: [u32; 2]) {
        let r = self.renderer;
        self.pass.set_bind_group(0, &r.buffers.group, &[]);
        self.pass
            .set_index_buffer(r.scene.indices.slice(..), wgpu::IndexFormat::Uint32);
        self.shapes();
        let opaque = match output {
            Output::Colour => Style::Opaque,
            Output::Measure => |_| Style::Measure,
        };
        self.calls(&chunk.shared, opaque);
        self.own(&chunk.own, tiles, opaque);
        // after the opaque drawables, so that it is shaded only where nothing else is
        if let (Output::Colour, Some(sky)) = (output, r.scenery.sky) {
            self.everywhere(size);
            self.pass.set_vertex_buffer(0, r.buffers.counting.slice(..));
            self.style(Style::Sky);
            self.texture(sky);
            let views = chunk.views.start as u32..chunk.views.end as u32;
            self.pass.draw(0..4, views);
            self.shapes();
        }
        self.own(&chunk.clear, tiles, Style::Transparent);
        // OpenGL averages the samples inside the last scissor only
        self.everywhere(size);
    }

    fn shapes(&mut self) {
        let r = self.renderer;
        self.pass.set_vertex_buffer(0, r.scene.vertices.slice(..));
        self.pass.set_vertex_buffer(1, r.buffers.instances.slice(..));
    }

    /// Draws into the whole texture.
    fn everywhere(&mut self, [w, h]: [u32; 2]) {
        self.pass.set_viewport(0.0, 0.0, w as f32, h as f32, 0.0, 1.0);
        self.pass.set_scissor_rect(0, 0, w, h);
    }

    /// Draws into one image after the other.
    fn own(&mut self, own: &[frame::ViewCalls], tiles: &[atlas::Tile], style: fn(ColourSource) -> Style) {
        for frame::ViewCalls { view, calls } in own {
            let t = &tiles[*view];
            let (x, y, w, h) = (t.x as f32, t.y as f32, t.width as f32, t.height as f32);
            self.pass.set_viewport(x, y, w, h, 0.0, 1.0);
            self.pass.set_scissor_rect(t.x, t.y, t.width, t.height);
            self.calls(calls, style);
        }
    }

    fn calls(&mut self, calls: &std::ops::Range<usize>, style: fn(ColourSource) -> Style) {
        let r = self.renderer;
        for call in &r.frame.calls[calls.clone()] {
            let class = &r.scene.classes[call.class];
            let style = style(class.paint);
            self.style(style);
            if let (Some(texture), true) = (class.texture, style != Style::Measure) {
                self.texture(texture);
            }
            let instances = call.first..call.first + call.count;
            match call.skins {
                None => self.pass.draw_indexed(class.indices.clone(), 0, instances),
                Some(first) => {
                    self.pass.set_vertex_buffer(0, r.buffers.worn.slice(..));
                    self.pass.draw_indexed(class.indices.clone(), first, instances);
                    self.pass.set_vertex_buffer(0, r.scene.vertices.slice(..));
                }
            }
        }
    }

    fn style(&mut self, style: Style) {
        if self.style != Some(style) {
            let r = self.renderer;
            self.pass.set_pipeline(r.pipelines.get(&r.gpu, &r.layouts, style));
            (self.style, self.texture) = (Some(style), None);
        }
    }

    fn texture(&mut self, texture: usize) {
        if self.texture != Some(texture) {
            self.pass.set_bind_group(1, &self.renderer.scene.textures[texture], &[]);
            self.texture = Some(texture);
        }
    }
}
