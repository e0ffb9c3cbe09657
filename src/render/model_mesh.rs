//! Meshes of the model, as pictures need them.

use std::collections::BTreeMap;
use std::ops::Range;

use super::drawable::Element;
use super::mesh::{LANES, Mesh, MeshPart};
use crate::model::{self, Model};

/// The most vertices of a part: triangles count them in 16 bits, and a part is filled up to whole groups.
const MOST: usize = (1 << 16) - LANES;
/// Least cosine between the normal of a vertex and that of a face for the face to be smooth there.
const SMOOTH: f32 = 0.8;

/// The meshes of a model that are drawn, each cut into parts.
pub struct ModelMeshes {
    parts: Vec<Option<Range<usize>>>,
}

/// A corner of a triangle: vertex, normal to the bit, texture coordinates.
type Corner = (u32, [u32; 3], u32);

impl ModelMeshes {
    pub fn new(model: &Model) -> Self {
        Self {
            parts: vec![None; model.meshes.len()],
        }
    }

    /// Returns the places in `meshes` of the parts of the mesh that an element shows, which are added at the first call.
    pub fn parts(&mut self, model: &Model, element: Element, meshes: &mut Vec<Mesh>) -> Range<usize> {
        let id = match element {
            Element::Geom(g) => model.geom_dataid[g],
            Element::Site(_) => None,
        };
        let (Some(mesh), Some(parts)) = (
            id.and_then(|id| model.meshes.get(id)),
            id.and_then(|id| self.parts.get_mut(id)),
        ) else {
            return 0..0;
        };
        parts
            .get_or_insert_with(|| {
                let first = meshes.len();
                cut(mesh, meshes);
                first..meshes.len()
            })
            .clone()
    }
}

/// A part of a mesh that is being made.
struct Part {
    mesh: Mesh,
    known: BTreeMap<Corner, u16>,
}

impl Part {
    fn new() -> Self {
        let mut mesh = Mesh::default();
        mesh.band(MeshPart::Body);
        Self {
            mesh,
            known: BTreeMap::new(),
        }
    }

    fn finish(mut self, meshes: &mut Vec<Mesh>) {
        self.mesh.fill();
        if let Some(band) = self.mesh.bands.last_mut() {
            band.triangles = 0..self.mesh.triangles.len();
            band.loose = self.mesh.triangles.len();
        }
        if !self.mesh.triangles.is_empty() {
            meshes.push(self.mesh);
        }
    }
}

/// Makes the parts of a mesh. Faces that turn away from the normal of a vertex have their own there, unless the mesh has texture
/// coordinates, as in MuJoCo.
fn cut(source: &model::Mesh, meshes: &mut Vec<Mesh>) {
    let mut part = Part::new();
    for (f, face) in source.face.iter().enumerate() {
        if part.mesh.x.len() + 3 > MOST {
            std::mem::replace(&mut part, Part::new()).finish(meshes);
        }
        let places = face.map(|v| source.vert.get(v as usize).copied().unwrap_or_default());
        let flat = normal(places);
        let mut triangle = [0; 3];
        for k in 0..3 {
            let given = source.facenormal.get(f).and_then(|n| source.normal.get(n[k] as usize));
            let coordinates = source.facetexcoord.get(f).map_or(model::Mesh::NONE, |t| t[k]);
            let normal = match given {
                Some(n) if !source.texcoord.is_empty() || dot(*n, flat) >= SMOOTH => *n,
                _ => flat,
            };
            let corner = (face[k], normal.map(f32::to_bits), coordinates);
            let Part { mesh, known } = &mut part;
            triangle[k] = *known.entry(corner).or_insert_with(|| {
                mesh.push((places[k], normal));
                if !source.texcoord.is_empty() {
                    let given = source.texcoord.get(coordinates as usize);
                    mesh.texcoord.push(given.copied().unwrap_or_default());
                }
                (mesh.x.len() - 1) as u16
            });
        }
        part.mesh.triangles.push(triangle);
    }
    part.finish(meshes);
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the unit normal of a triangle; z for one without area.
fn normal([a, b, c]: [[f32; 3]; 3]) -> [f32; 3] {
    let side = |p: [f32; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (u, v) = (side(b), side(c));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = dot(n, n).sqrt();
    if length < f32::MIN_POSITIVE {
        return [0.0, 0.0, 1.0];
    }
    n.map(|x| x / length)
}
