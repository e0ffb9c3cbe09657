//! The data that each submission uploads: instances and views.

use super::GpuError;
use super::device::Gpu;
use super::frame::{SubmissionData, VIEW_ROWS, views_size};
use super::pipelines::INSTANCE;
use super::pipelines::Layouts;

/// The buffers for instances and views; they grow with the largest submission.
#[derive(Debug)]
pub struct Buffers {
    pub instances: wgpu::Buffer,
    /// Vertices of skins.
    pub worn: wgpu::Buffer,
    /// 0, 1, 2...: indices of views, for the background.
    pub counting: wgpu::Buffer,
    views: wgpu::Texture,
    /// Bind group of lights and views.
    pub group: wgpu::BindGroup,
    /// Number of views that fit into the buffers.
    room: usize,
}

impl Buffers {
    pub fn new(gpu: &Gpu, layouts: &Layouts, lights: &wgpu::Buffer, instances: usize, views: usize) -> Self {
        let buffer = |label, numbers: usize| buffer(gpu, label, 4 * numbers as u64);
        let counting = buffer("counting", views);
        let numbers: Vec<f32> = (0..views).map(|k| k as f32).collect();
        gpu.queue.write_buffer(&counting, 0, bytemuck::cast_slice(&numbers));
        let [width, height] = views_size(views).map(|n| n as u32);
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("views"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("views"),
            layout: &layouts.views,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: lights.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(&view),
                },
            ],
        });
        Self {
            instances: buffer("instances", INSTANCE * instances),
            worn: buffer("skins", 1),
            counting,
            views: texture,
            group,
            room: views,
        }
    }

    /// Uploads a frame of `views` views, after enlarging the buffers if necessary.
    pub fn write(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        lights: &wgpu::Buffer,
        frame: &SubmissionData,
        views: usize,
    ) -> Result<(), GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(frame.instances.as_flattened());
        fits(
            "the list of what is in view, in bytes,",
            bytes.len() as u64,
            gpu.device.limits().max_buffer_size,
        )?;
        let side = u64::from(gpu.device.limits().max_texture_dimension_2d);
        fits("the list of views", views_size(views)[0] as u64, side)?;
        if self.instances.size() < bytes.len() as u64 || self.room < views {
            let instances = frame.instances.len().next_power_of_two();
            let most = gpu.device.limits().max_buffer_size as usize / (4 * INSTANCE);
            let instances = instances.min(most).max(self.instances.size() as usize / (4 * INSTANCE));
            *self = Self::new(gpu, layouts, lights, instances, room_for(views.max(self.room)));
        }
        gpu.queue.write_buffer(&self.instances, 0, bytes);
        let worn: &[u8] = bytemuck::cast_slice(&frame.worn_vertices);
        fits(
            "the list of vertices of skins, in bytes,",
            worn.len() as u64,
            gpu.device.limits().max_buffer_size,
        )?;
        if self.worn.size() < worn.len() as u64 {
            self.worn = buffer(gpu, "skins", worn.len() as u64);
        }
        gpu.queue.write_buffer(&self.worn, 0, worn);
        let [width, height] = views_size(views).map(|n| n as u32);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(16 * width),
            rows_per_image: None,
        };
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let views = bytemuck::cast_slice(frame.views.as_flattened());
        gpu.queue.write_texture(self.views.as_image_copy(), views, layout, size);
        Ok(())
    }
}

/// Makes a buffer of vertices or instances.
fn buffer(gpu: &Gpu, label: &str, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Rounds a number of views up, so that buffers are not reallocated for every submission.
fn room_for(views: usize) -> usize {
    if views <= VIEW_ROWS {
        views.next_power_of_two()
    } else {
        views.next_multiple_of(VIEW_ROWS)
    }
}

/// Checks a size against a limit of the device.
pub fn fits(what: &'static str, needed: u64, limit: u64) -> Result<(), GpuError> {
    if needed <= limit {
        Ok(())
    } else {
        Err(GpuError::TooLarge { what, needed, limit })
    }
}
