//! Render pipelines, each made when it is first needed.

use std::sync::OnceLock;

use super::device::Gpu;

/// Number of samples per pixel for colours.
pub const SAMPLES: u32 = 4;

/// Number of values per instance: the attributes of the shader's `Vertex` from `row_x` on.
pub const INSTANCE: usize = 44;

/// The values that a pass writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Red, green, blue and opacity, a byte each.
    Colour,
    /// 1/distance (the bits of a single-precision number) and the geom id, four bytes each.
    Measure,
}

impl Output {
    pub const fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Colour => super::COLOUR,
            Self::Measure => wgpu::TextureFormat::Rg32Uint,
        }
    }

    /// Returns the number of bytes of a pixel.
    pub const fn bytes(self) -> u32 {
        match self {
            Self::Colour => 4,
            Self::Measure => 8,
        }
    }

    pub const fn samples(self) -> u32 {
        match self {
            Self::Colour => SAMPLES,
            Self::Measure => 1,
        }
    }
}

/// The source of a drawable's colour, which decides the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ColourSource {
    Plain,
    Image,
    Cube,
}

/// A way to draw shapes, which decides the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Opaque(ColourSource),
    Transparent(ColourSource),
    Sky,
    Measure,
}

impl Style {
    /// Returns the entry points of the shader, for vertices and fragments.
    fn entry_points(self) -> (&'static str, &'static str) {
        match self {
            Style::Opaque(ColourSource::Plain) | Style::Transparent(ColourSource::Plain) => ("shape", "plain"),
            Style::Opaque(ColourSource::Image) | Style::Transparent(ColourSource::Image) => ("shape", "with_image"),
            Style::Opaque(ColourSource::Cube) | Style::Transparent(ColourSource::Cube) => ("shape", "with_cube"),
            Style::Sky => ("background", "sky"),
            Style::Measure => ("measured_shape", "measure"),
        }
    }
}

const fn stepped<'a>(
    array_stride: u64,
    step_mode: wgpu::VertexStepMode,
    attributes: &'a [wgpu::VertexAttribute],
) -> Option<wgpu::VertexBufferLayout<'a>> {
    Some(wgpu::VertexBufferLayout {
        array_stride,
        step_mode,
        attributes,
    })
}

/// Buffers from which shapes are drawn: vertices and instances.
const SHAPE_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    stepped(
        48,
        wgpu::VertexStepMode::Vertex,
        &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 13 => Float32x4],
    ),
    stepped(
        4 * INSTANCE as u64,
        wgpu::VertexStepMode::Instance,
        &wgpu::vertex_attr_array![
            2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4,
            8 => Float32x4, 9 => Float32x4, 10 => Float32x4, 11 => Float32x4, 12 => Float32x4
        ],
    ),
];
/// Buffer from which the background is drawn: an index for each view.
const VIEW_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 1] = [stepped(
    4,
    wgpu::VertexStepMode::Instance,
    &wgpu::vertex_attr_array![0 => Float32],
)];

/// Layouts of the bind groups.
#[derive(Debug)]
pub struct Layouts {
    /// Layout of lights and views.
    pub views: wgpu::BindGroupLayout,
    /// Layout of a sampler and an image.
    pub image: wgpu::BindGroupLayout,
    /// Layout of a sampler and the sides of a cube.
    pub cube: wgpu::BindGroupLayout,
}

impl Layouts {
    pub fn new(gpu: &Gpu) -> Self {
        use wgpu::ShaderStages as Stages;
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        };
        let texture = |filterable, view_dimension| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension,
            multisampled: false,
        };
        let group = |label, entries: &[_]| {
            let label = Some(label);
            gpu.device
                .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries })
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let filtered = |label, dimension| {
            let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
            group(
                label,
                &[
                    entry(0, Stages::FRAGMENT, sampler),
                    entry(1, Stages::FRAGMENT, texture(true, dimension)),
                ],
            )
        };
        Self {
            views: group(
                "views",
                &[
                    entry(0, Stages::VERTEX, uniform),
                    entry(1, Stages::VERTEX, texture(false, wgpu::TextureViewDimension::D2)),
                ],
            ),
            image: filtered("image", wgpu::TextureViewDimension::D2),
            cube: filtered("cube", wgpu::TextureViewDimension::Cube),
        }
    }
}

/// All pipelines of a device.
#[derive(Debug)]
pub struct Pipelines {
    shader: wgpu::ShaderModule,
    made: [OnceLock<wgpu::RenderPipeline>; 8],
}

impl Pipelines {
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            shader: gpu.device.create_shader_module(wgpu::include_wgsl!("shader.wgsl")),
            made: Default::default(),
        }
    }

    pub fn get(&self, gpu: &Gpu, layouts: &Layouts, style: Style) -> &wgpu::RenderPipeline {
        let slot = match style {
            Style::Opaque(paint) => paint as usize,
            Style::Transparent(paint) => 3 + paint as usize,
            Style::Sky => 6,
            Style::Measure => 7,
        };
        self.made[slot].get_or_init(|| self.make(gpu, layouts, style))
    }

    fn make(&self, gpu: &Gpu, layouts: &Layouts, style: Style) -> wgpu::RenderPipeline {
        let (vertex, fragment) = style.entry_points();
        let texture = match fragment {
            "with_image" => Some(&layouts.image),
            "with_cube" | "sky" => Some(&layouts.cube),
            _ => None,
        };
        let groups = [Some(&layouts.views), texture];
        let used = 1 + usize::from(texture.is_some());
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(fragment),
            bind_group_layouts: &groups[..used],
            immediate_size: 0,
        });
        let sky = style == Style::Sky;
        let output = match style {
            Style::Measure => Output::Measure,
            _ => Output::Colour,
        };
        let blend = matches!(style, Style::Transparent(_)).then_some(wgpu::BlendState::ALPHA_BLENDING);
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(vertex),
                compilation_options: Default::default(),
                buffers: if sky { &VIEW_BUFFERS } else { &SHAPE_BUFFERS },
            },
            primitive: primitive(sky),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: super::DEPTH,
                depth_write_enabled: Some(matches!(style, Style::Opaque(_) | Style::Measure)),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: output.samples(),
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(fragment),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: output.format(),
                    blend,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Returns how vertices form triangles: a strip over each image for the background, a list for shapes.
fn primitive(sky: bool) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        topology: if sky {
            wgpu::PrimitiveTopology::TriangleStrip
        } else {
            wgpu::PrimitiveTopology::TriangleList
        },
        // images are upside down
        front_face: wgpu::FrontFace::Cw,
        cull_mode: (!sky).then_some(wgpu::Face::Back),
        ..Default::default()
    }
}
