//! Meshes and height fields of the model, prepared for pictures.

use std::collections::BTreeMap;
use std::ops::Range;

use super::drawable::Element;
use super::mesh::{MOST, Mesh, MeshPart};
use crate::model::{self, GeomType, HField, Model};

/// Smallest cosine between the normals of a vertex and a face for which the face is smooth there.
const SMOOTH: f32 = 0.8;

/// The meshes and height fields of a model that are drawn, each cut into parts.
pub struct ModelMeshes {
    meshes: Vec<Option<Range<usize>>>,
    hfields: Vec<Option<Range<usize>>>,
}

/// A corner of a triangle: vertex, exact bits of the normal, texture coordinates.
type MeshCorner = (u32, [u32; 3], u32);

impl ModelMeshes {
    pub fn new(model: &Model) -> Self {
        Self {
            meshes: vec![None; model.meshes.len()],
            hfields: vec![None; model.hfields.len()],
        }
    }

    /// Returns the indices in `meshes` of the parts of the mesh or height field that an element shows, which are added at the first call.
    pub fn parts(&mut self, model: &Model, element: Element, meshes: &mut Vec<Mesh>) -> Range<usize> {
        let Element::Geom(g) = element else { return 0..0 };
        let Some(id) = model.geom_dataid[g] else { return 0..0 };
        let mut add = |known: Option<&mut Option<Range<usize>>>, cut: &dyn Fn(&mut Vec<Mesh>)| {
            let known = known?;
            let range = known.get_or_insert_with(|| {
                let first = meshes.len();
                cut(meshes);
                first..meshes.len()
            });
            Some(range.clone())
        };
        let parts = match model.geom_type[g] {
            GeomType::HField => {
                let field = model.hfields.get(id);
                field.and_then(|field| add(self.hfields.get_mut(id), &|meshes| cut_field(field, meshes)))
            }
            _ => {
                let mesh = model.meshes.get(id);
                mesh.and_then(|mesh| add(self.meshes.get_mut(id), &|meshes| cut(mesh, meshes)))
            }
        };
        parts.unwrap_or(0..0)
    }
}

/// A part of a mesh under construction.
struct PartBuilder {
    mesh: Mesh,
    known: BTreeMap<MeshCorner, u16>,
}

impl PartBuilder {
    fn new() -> Self {
        let mut mesh = Mesh::default();
        mesh.band(MeshPart::Body);
        Self {
            mesh,
            known: BTreeMap::new(),
        }
    }

    fn finish(mut self, meshes: &mut Vec<Mesh>) {
        self.mesh.end_loose();
        if !self.mesh.triangles.is_empty() {
            meshes.push(self.mesh);
        }
    }
}

/// Makes the parts of a mesh. Faces that turn away from the normal of a vertex have their own normal there, unless the mesh has texture
/// coordinates, as in MuJoCo.
fn cut(source: &model::Mesh, meshes: &mut Vec<Mesh>) {
    let mut part = PartBuilder::new();
    for (f, face) in source.face.iter().enumerate() {
        if part.mesh.x.len() + 3 > MOST {
            std::mem::replace(&mut part, PartBuilder::new()).finish(meshes);
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
            let PartBuilder { mesh, known } = &mut part;
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

/// Number of rectangles on each side of the base, as in MuJoCo's renderer.
const QUADS: usize = 4;

/// Makes the parts of a height field: flat triangles of its surface, its sides and its base.
fn cut_field(field: &HField, meshes: &mut Vec<Mesh>) {
    let [x, y, top, base] = field.size.map(|v| v as f32);
    let (rows, columns) = (field.nrow, field.ncol);
    let mut part = PartBuilder::new();
    let mut add = |corners: [[f32; 3]; 3], normal: [f32; 3]| {
        if part.mesh.x.len() + 3 > MOST {
            std::mem::replace(&mut part, PartBuilder::new()).finish(meshes);
        }
        let first = part.mesh.x.len() as u16;
        corners.iter().for_each(|&corner| part.mesh.push((corner, normal)));
        part.mesh.triangles.push([first, first + 1, first + 2]);
    };
    let along = |k: usize, count: usize| k as f32 / (0.5 * (count - 1) as f32) - 1.0;
    let height = |r: usize, c: usize| field.data.get(r * columns + c).copied().unwrap_or_default() * top;
    let at = |r: usize, c: usize| [x * along(c, columns), y * along(r, rows), height(r, c)];
    for r in 0..rows - 1 {
        for c in 0..columns - 1 {
            let [a, b, d, e] = [at(r + 1, c), at(r, c), at(r + 1, c + 1), at(r, c + 1)];
            for corners in [[a, b, d], [b, e, d]] {
                add(corners, normal(corners));
            }
        }
    }
    let mut quad = |corners: [[f32; 3]; 4], normal: [f32; 3]| {
        let [a, b, c, d] = corners;
        // as the reference splits them
        add([a, b, d], normal);
        add([b, c, d], normal);
    };
    let low = |[x, y, _]: [f32; 3]| [x, y, -base];
    for r in 0..rows - 1 {
        let (a, b) = (at(r, 0), at(r + 1, 0));
        quad([low(b), low(a), a, b], [-1.0, 0.0, 0.0]);
        let (a, b) = (at(r, columns - 1), at(r + 1, columns - 1));
        quad([low(a), low(b), b, a], [1.0, 0.0, 0.0]);
    }
    for c in 0..columns - 1 {
        let (a, b) = (at(0, c), at(0, c + 1));
        quad([low(a), low(b), b, a], [0.0, -1.0, 0.0]);
        let (a, b) = (at(rows - 1, c), at(rows - 1, c + 1));
        quad([low(b), low(a), a, b], [0.0, 1.0, 0.0]);
    }
    let place = |r: usize, c: usize| [x * along(c, QUADS + 1), y * along(r, QUADS + 1), -base];
    for r in 0..QUADS {
        for c in 0..QUADS {
            quad(
                [place(r, c), place(r + 1, c), place(r + 1, c + 1), place(r, c + 1)],
                [0.0, 0.0, -1.0],
            );
        }
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
