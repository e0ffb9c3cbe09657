//! Triangle meshes.

use crate::math::{Quat, Vec3, order};

/// A mesh that geoms use for pictures and contacts, centred and along its principal axes, as in MuJoCo: its entry in each of the
/// arrays `mesh_*`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Name.
    pub name: String,
    /// Vertices, m (`mesh_vert`).
    pub vert: Vec<[f32; 3]>,
    /// Unit normals (`mesh_normal`).
    pub normal: Vec<[f32; 3]>,
    /// Texture coordinates, from the top of the image; empty where there are none (`mesh_texcoord`).
    pub texcoord: Vec<[f32; 2]>,
    /// Vertices of each triangle, counterclockwise from outside (`mesh_face`).
    pub face: Vec<[u32; 3]>,
    /// Normals at the corners of each triangle; [`Mesh::NONE`] where a file gives none (`mesh_facenormal`).
    pub facenormal: Vec<[u32; 3]>,
    /// Texture coordinates at the corners of each triangle; [`Mesh::NONE`] where a file gives none, empty where `texcoord` is
    /// (`mesh_facetexcoord`).
    pub facetexcoord: Vec<[u32; 3]>,
    /// The convex hull, for contacts; `None` for a mesh that is only drawn (`mesh_graph`).
    pub hull: Option<MeshHull>,
    /// The polygons of the hull, or of a mesh without one that touches in a `<pair>`; none unless the document enables `multiccd`, the only feature
    /// that needs them.
    pub polygons: MeshPolygons,
    /// Scale by which the vertices were multiplied (`mesh_scale`).
    pub scale: Vec3,
    /// Position subtracted from the vertices to centre them, m (`mesh_pos`).
    pub pos: Vec3,
    /// Orientation of the principal axes, in which the vertices are given, in the axes of the document (`mesh_quat`).
    pub quat: Quat,
    /// Least and greatest coordinates, m.
    pub bounds: [Vec3; 2],
    /// Volume, m^3; for a shell, the area, m^2.
    pub volume: f64,
    /// Whether volume and inertia are sums over the triangles of the hull. Sums are in single precision, so their last digits differ from MuJoCo's if
    /// the order of triangles does.
    pub of_hull: bool,
    /// Half lengths of the homogeneous box with the same inertia, m.
    pub inertia_box: Vec3,
}

impl Mesh {
    /// Index for a corner of a triangle without a normal or without texture coordinates.
    pub const NONE: u32 = u32::MAX;
}

/// The convex hull of a mesh as a graph of its corners, in MuJoCo's order, which comes from Qhull: if several corners are equally far, the order
/// decides which is found first. If Qhull's steps yield no hull, the order is that of the vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshHull {
    /// Index of each corner's vertex in the mesh.
    pub vert: Vec<u32>,
    /// First entry of each corner's neighbours in `edge`, then the length of `edge`.
    pub edge_adr: Vec<u32>,
    /// Neighbours, by corner.
    pub edge: Vec<u32>,
    /// Vertices of the mesh at the corners of each triangle of the hull, counterclockwise from outside.
    pub face: Vec<[u32; 3]>,
    /// Position of each corner in the mesh, m, padded to four numbers.
    point: Vec<[f32; 4]>,
}

/// The polygons of a hull, or of a mesh without one, in MuJoCo's order: its triangles, joined where they are on one plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshPolygons {
    /// Unit normals (`mesh_polynormal`).
    pub normal: Vec<Vec3>,
    /// First entry of each polygon's corners in `vert` (`mesh_polyvertadr`), then the length of `vert`.
    pub vert_adr: Vec<u32>,
    /// Vertices of the mesh at the corners, counterclockwise from outside (`mesh_polyvert`).
    pub vert: Vec<u32>,
    /// First entry of the polygons of each vertex of the mesh in `map` (`mesh_polymapadr`), then the length of `map`.
    pub map_adr: Vec<u32>,
    /// Polygons, by vertex (`mesh_polymap`).
    pub map: Vec<u32>,
}

impl MeshPolygons {
    /// Returns the number of polygons (`mesh_polynum`).
    pub fn len(&self) -> usize {
        self.vert_adr.len().saturating_sub(1)
    }

    /// Returns whether there are no polygons.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the vertices of a polygon.
    pub fn corners(&self, polygon: usize) -> &[u32] {
        slice(&self.vert_adr, &self.vert, polygon)
    }

    /// Returns the polygons of a vertex.
    pub fn at(&self, vertex: usize) -> &[u32] {
        slice(&self.map_adr, &self.map, vertex)
    }

    /// Appends a polygon.
    pub fn push(&mut self, corners: &[u32]) {
        if self.vert_adr.is_empty() {
            self.vert_adr.push(0);
        }
        self.vert.extend(corners);
        self.vert_adr.push(self.vert.len() as u32);
    }

    /// Lists the polygons of each of `vertices` vertices.
    pub fn index(&mut self, vertices: usize) {
        let mut of = vec![Vec::new(); vertices];
        for polygon in 0..self.len() {
            for &vertex in self.corners(polygon) {
                of[vertex as usize].push(polygon as u32);
            }
        }
        self.map = of.concat();
        let ends = of.iter().scan(0, |end, polygons| {
            *end += polygons.len() as u32;
            Some(*end)
        });
        self.map_adr = std::iter::once(0).chain(ends).collect();
    }
}

/// Returns the slice of item `index`; `adr` has the start of each. An index out of range gives an empty slice.
#[inline(always)]
fn slice<'a>(adr: &[u32], all: &'a [u32], of: usize) -> &'a [u32] {
    match (adr.get(of), adr.get(of + 1)) {
        (Some(&from), Some(&to)) => &all[from as usize..to as usize],
        _ => &[],
    }
}

impl MeshHull {
    /// Makes the graph from triangles that form a closed surface.
    pub fn new(face: Vec<[u32; 3]>) -> Self {
        let mut vert = face.as_flattened().to_vec();
        vert.sort_unstable();
        vert.dedup();
        let corner = |vertex: u32| vert.binary_search(&vertex).unwrap_or_default() as u32;
        let mut edges = Vec::with_capacity(3 * face.len());
        for f in &face {
            let [a, b, c] = f.map(corner);
            edges.extend([[a, b], [b, c], [c, a]]);
        }
        // each edge stands once in either direction, as each has two triangles
        edges.sort_unstable();
        edges.dedup();
        let starts = |at: usize| edges.partition_point(|edge| (edge[0] as usize) < at) as u32;
        Self {
            edge_adr: (0..=vert.len()).map(starts).collect(),
            edge: edges.iter().map(|edge| edge[1]).collect(),
            vert,
            face,
            point: Vec::new(),
        }
    }

    /// Stores the positions of the corners, given the vertices of the mesh.
    pub fn place(&mut self, vert: &[[f32; 3]]) {
        let point = |&vertex: &u32| {
            let [x, y, z] = vert[vertex as usize];
            [x, y, z, 0.0]
        };
        self.point = self.vert.iter().map(point).collect();
    }

    /// Creates a hull from corners with their edges, and triangles in the order in which they were found. `None` unless every edge of a
    /// triangle is also an edge of another triangle in the opposite direction, and every corner is known.
    pub fn ordered(vert: Vec<u32>, edges: &[Vec<u32>], face: Vec<[u32; 3]>) -> Option<Self> {
        let plain = Self::new(face);
        let mut corner: Vec<(u32, u32)> = vert.iter().zip(0..).map(|(&vertex, at)| (vertex, at)).collect();
        order::sort(&mut corner);
        let sorted: Vec<u32> = corner.iter().map(|&(vertex, _)| vertex).collect();
        if sorted != plain.vert || edges.len() != vert.len() || plain.edge.len() != 3 * plain.face.len() {
            return None;
        }
        let (mut edge_adr, mut edge) = (vec![0], Vec::new());
        for (&vertex, others) in vert.iter().zip(edges) {
            let mut known = others.clone();
            known.sort_unstable();
            let at = sorted.binary_search(&vertex).ok()?;
            let same = plain.neighbours(at).iter().map(|&k| plain.vert[k as usize]);
            if !same.eq(known) {
                return None;
            }
            for other in others {
                edge.push(corner[sorted.binary_search(other).ok()?].1);
            }
            edge_adr.push(edge.len() as u32);
        }
        Some(Self {
            vert,
            edge_adr,
            edge,
            ..plain
        })
    }

    /// Returns the neighbours of a corner.
    #[inline(always)]
    pub fn neighbours(&self, corner: usize) -> &[u32] {
        slice(&self.edge_adr, &self.edge, corner)
    }

    /// Returns the positions of the corners, m, each padded to four numbers.
    #[inline(always)]
    pub fn points(&self) -> &[[f32; 4]] {
        &self.point
    }
}
