//! The part of a scene that does not move, on the device: meshes, textures, lights.

use std::collections::BTreeMap;
use std::ops::Range;

use wgpu::util::DeviceExt;

use super::device::Gpu;
use super::pipelines::{ColourSource, Layouts};
use crate::drawable::{Drawable, Shape};
use crate::mesh::{Mesh, MeshPart};
use crate::scenery::Scenery;
use crate::texture::{MipChain, MipLevel, TexturePixels};

/// Number of lights in the shader.
pub const LIGHTS: usize = 8;

/// Drawables that share mesh and texture, drawn by one call.
#[derive(Clone, Debug)]
pub struct DrawClass {
    pub paint: ColourSource,
    pub texture: Option<usize>,
    /// Range in the buffer of indices.
    pub indices: Range<u32>,
    /// Index among the meshes of skins, whose vertices are stored elsewhere and differ for each view.
    pub worn: Option<usize>,
}

/// A scene on the device.
#[derive(Debug)]
pub struct GpuScene {
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    /// Classes of drawables, sorted by pipeline, then texture.
    pub classes: Vec<DrawClass>,
    /// Class of each drawable.
    pub class_of: Vec<usize>,
    /// Class of each drawable seen from behind; differs for planes.
    pub class_behind: Vec<usize>,
    /// Bind groups of the textures of the scenery.
    pub textures: Vec<wgpu::BindGroup>,
    pub lights: wgpu::Buffer,
}

impl GpuScene {
    pub fn new(gpu: &Gpu, layouts: &Layouts, scenery: &Scenery) -> Self {
        let Geometry {
            vertices,
            indices,
            ranges,
            grids,
        } = geometry(scenery);
        let worn = scenery.soft_parts().count();
        let flipped = scenery.meshes.len() + worn;
        let buffer = |label, contents: &[u8], usage| {
            let label = Some(label);
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage })
        };
        let paint = |d: &Drawable| match d.texture.map(|t| &scenery.textures[t]) {
            None => ColourSource::Plain,
            Some(TexturePixels::Flat(_)) => ColourSource::Image,
            Some(TexturePixels::Cube(_)) => ColourSource::Cube,
        };
        // meshes of a drawable seen from the front and from behind
        let sides = |(d, grid): (&Drawable, &Option<usize>)| match (grid, d.shape) {
            (Some(grid), _) => [*grid, *grid + 1],
            (None, Shape::Plane) => [d.mesh, flipped],
            (None, _) => [d.mesh; 2],
        };
        // keys in drawing order
        let keys = |side: usize| -> Vec<_> {
            let drawables = scenery.drawables.iter().zip(&grids);
            drawables
                .map(|(d, grid)| (paint(d), d.texture, sides((d, grid))[side]))
                .collect()
        };
        let (front, back) = (keys(0), keys(1));
        let mut index: BTreeMap<_, usize> = front.iter().chain(&back).map(|&k| (k, 0)).collect();
        let mut classes = Vec::with_capacity(index.len());
        for (&(paint, texture, mesh), at) in &mut index {
            *at = classes.len();
            let indices = ranges[mesh].clone();
            classes.push(DrawClass {
                paint,
                texture,
                indices,
                worn: mesh.checked_sub(scenery.meshes.len()).filter(|_| mesh < flipped),
            });
        }
        Self {
            vertices: buffer("vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: buffer("indices", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            classes,
            class_of: front.iter().map(|k| index[k]).collect(),
            class_behind: back.iter().map(|k| index[k]).collect(),
            textures: scenery.textures.iter().map(|t| upload(gpu, layouts, t)).collect(),
            lights: buffer(
                "lights",
                bytemuck::cast_slice(lights(scenery).as_flattened()),
                wgpu::BufferUsages::UNIFORM,
            ),
        }
    }
}

/// Numbers of a vertex.
pub const VERTEX: usize = 12;

/// Adds the vertices of a mesh: position and part, normal, texture coordinates, and whether these are used.
pub fn add_vertices(mesh: &Mesh, vertices: &mut Vec<f32>) {
    for (i, n) in mesh.normal.iter().enumerate() {
        let part = match mesh.part_of(i) {
            MeshPart::Body => 0.0,
            MeshPart::Top => 1.0,
            MeshPart::Bottom => 2.0,
        };
        vertices.extend([mesh.x[i], mesh.y[i], mesh.z[i], part, n[0], n[1], n[2], 0.0]);
        vertices.extend(match mesh.texcoord.get(i) {
            Some([u, v]) => [*u, *v, 1.0, 0.0],
            None => [0.0; 4],
        });
    }
}

/// The vertices and triangles of a scene.
struct Geometry {
    vertices: Vec<f32>,
    indices: Vec<u32>,
    /// The range of indices of each mesh: those of [`Scenery::meshes`], those of skins, which have no vertices, the plane seen from behind,
    /// and for each plane that is lit on a lattice its grid from both sides.
    ranges: Vec<Range<u32>>,
    /// The first index range of the grid of each drawable with a grid.
    grids: Vec<Option<usize>>,
}

fn geometry(scenery: &Scenery) -> Geometry {
    let (mut vertices, mut indices, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
    let mut add = |mesh: &Mesh, first: u32, flipped: bool| {
        let start = indices.len() as u32;
        for &[a, b, c] in &mesh.triangles {
            let corners = if flipped { [a, c, b] } else { [a, b, c] };
            indices.extend(corners.map(|i| first + u32::from(i)));
        }
        ranges.push(start..indices.len() as u32);
    };
    let mut first = 0;
    for mesh in &scenery.meshes {
        add(mesh, first, false);
        add_vertices(mesh, &mut vertices);
        first += mesh.x.len() as u32;
    }
    for part in scenery.soft_parts() {
        add(&part.mesh, 0, false);
    }
    let plane = &scenery.meshes[Shape::Plane as usize];
    add(plane, first, true);
    add_vertices(plane, &mut vertices);
    first += plane.x.len() as u32;
    let mut next = scenery.meshes.len() + scenery.soft_parts().count() + 1;
    let mut grids = vec![None; scenery.drawables.len()];
    for (drawable, grid) in scenery.drawables.iter().zip(&mut grids) {
        let Some(lattice) = &drawable.lattice else { continue };
        let mesh = lattice.mesh();
        add(&mesh, first, false);
        add(&mesh, first, true);
        add_vertices(&mesh, &mut vertices);
        first += mesh.x.len() as u32;
        *grid = Some(next);
        next += 2;
    }
    Geometry {
        vertices,
        indices,
        ranges,
        grids,
    }
}

/// Fills the uniform block `Scene` of the shader.
fn lights(scenery: &Scenery) -> [[f32; 4]; 4 * LIGHTS + 1] {
    let mut block = [[0.0; 4]; 4 * LIGHTS + 1];
    let with = |[a, b, c]: [f32; 3], w: f32| [a, b, c, w];
    let head = scenery.headlight.map(|[ambient, diffuse, specular]| {
        let attenuation = [1.0, 0.0, 0.0, 0.0];
        [
            with(ambient, 0.0),
            with(diffuse, 0.0),
            with(specular, -1.0),
            attenuation,
        ]
    });
    let others = scenery.lights.iter().map(|l| {
        let attenuation = with(l.attenuation, l.exponent);
        [
            with(l.ambient, 0.0),
            with(l.diffuse, 0.0),
            with(l.specular, l.cos_cutoff),
            attenuation,
        ]
    });
    let mut count = 0;
    for light in head.into_iter().chain(others).take(LIGHTS) {
        block[4 * count..4 * count + 4].copy_from_slice(&light);
        count += 1;
    }
    let glow = if count == 0 { 0.3 } else { 0.0 };
    block[4 * LIGHTS] = [count as f32, glow, 0.0, 0.0];
    block
}

/// Uploads one mip level of one side of a texture.
fn write_level(gpu: &Gpu, texture: &wgpu::Texture, [z, mip_level]: [u32; 2], level: &MipLevel) {
    let to = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level,
        origin: wgpu::Origin3d { x: 0, y: 0, z },
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * level.width as u32),
        rows_per_image: None,
    };
    let size = wgpu::Extent3d {
        width: level.width as u32,
        height: level.height as u32,
        depth_or_array_layers: 1,
    };
    gpu.queue.write_texture(to, level.pixels.as_flattened(), layout, size);
}

/// Creates a trilinear sampler.
fn sampler(gpu: &Gpu, wrap: wgpu::AddressMode) -> wgpu::Sampler {
    let linear = wgpu::FilterMode::Linear;
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wrap,
        address_mode_v: wrap,
        address_mode_w: wrap,
        mag_filter: linear,
        min_filter: linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// Uploads a texture, and binds it with its sampler.
fn upload(gpu: &Gpu, layouts: &Layouts, texture: &TexturePixels) -> wgpu::BindGroup {
    let (faces, dimension, wrap, layout): (&[MipChain], _, _, _) = match texture {
        TexturePixels::Flat(face) => (
            std::slice::from_ref(face),
            wgpu::TextureViewDimension::D2,
            wgpu::AddressMode::Repeat,
            &layouts.image,
        ),
        TexturePixels::Cube(cube) => (
            &cube.faces,
            wgpu::TextureViewDimension::Cube,
            wgpu::AddressMode::ClampToEdge,
            &layouts.cube,
        ),
    };
    let made = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("texture"),
        size: wgpu::Extent3d {
            width: faces[0][0].width as u32,
            height: faces[0][0].height as u32,
            depth_or_array_layers: faces.len() as u32,
        },
        mip_level_count: faces[0].len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: super::COLOUR,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (z, face) in faces.iter().enumerate() {
        for (k, level) in face.iter().enumerate() {
            write_level(gpu, &made, [z as u32, k as u32], level);
        }
    }
    let view = made.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(dimension),
        ..Default::default()
    });
    let sampler = sampler(gpu, wrap);
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("texture"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Sampler(&sampler),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&view),
            },
        ],
    })
}
