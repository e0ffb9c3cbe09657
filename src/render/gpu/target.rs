//! The textures into which a pass draws.

use super::device::Gpu;
use super::pipelines::Output;

/// Attachments of one size, used by one chunk after the other.
#[derive(Debug)]
pub struct Attachments {
    pub size: [u32; 2],
    /// Texture that is copied to the buffer.
    pub resolved: wgpu::Texture,
    resolved_view: wgpu::TextureView,
    /// Texture with several samples per pixel, if the output has them.
    sampled: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

impl Attachments {
    pub fn new(gpu: &Gpu, output: Output, size: [u32; 2]) -> Self {
        let make = |label, format, sample_count, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let samples = output.samples();
        let resolved = make(
            "pictures",
            output.format(),
            1,
            attachment | wgpu::TextureUsages::COPY_SRC,
        );
        let sampled = (samples > 1).then(|| view(&make("samples", output.format(), samples, attachment)));
        Self {
            size,
            resolved_view: view(&resolved),
            resolved,
            sampled,
            depth: view(&make("depth", super::DEPTH, samples, attachment)),
        }
    }

    /// Begins a pass on cleared attachments.
    pub fn pass<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        let (view, resolve_target, store) = match &self.sampled {
            Some(view) => (view, Some(&self.resolved_view), wgpu::StoreOp::Discard),
            None => (&self.resolved_view, None, wgpu::StoreOp::Store),
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("pictures"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}
