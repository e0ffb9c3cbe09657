//! Meshes, their hulls, and height fields.

use babybench::Model;
use babybench::model::{Mesh, MeshHull, MeshPolygons};

use super::Named;

/// Returns the arrays of meshes. Those without faces have the triangles of their hulls.
pub fn of_meshes(m: &Model) -> Named {
    let number = |of: fn(&Mesh) -> usize| -> Vec<f64> { m.meshes.iter().map(|mesh| of(mesh) as f64).collect() };
    let vert = m.meshes.iter().flat_map(|mesh| mesh.vert.as_flattened());
    let mut all = vec![
        ("mesh_vertnum", number(|mesh| mesh.vert.len())),
        ("mesh_normalnum", number(|mesh| mesh.normal.len())),
        ("mesh_texcoordnum", number(|mesh| mesh.texcoord.len())),
        ("mesh_facenum", number(|mesh| mesh.face.len())),
        ("mesh_vert", vert.map(|&x| f64::from(x)).collect()),
        ("hfield_size", m.hfields.iter().flat_map(|field| field.size).collect()),
        ("hfield_nrow", m.hfields.iter().map(|field| field.nrow as f64).collect()),
        ("hfield_ncol", m.hfields.iter().map(|field| field.ncol as f64).collect()),
        (
            "hfield_data",
            m.hfields
                .iter()
                .flat_map(|field| &field.data)
                .map(|&x| f64::from(x))
                .collect(),
        ),
        ("mesh_scale", m.meshes.iter().flat_map(|mesh| mesh.scale).collect()),
        ("mesh_pos", m.meshes.iter().flat_map(|mesh| mesh.pos).collect()),
        ("mesh_quat", m.meshes.iter().flat_map(|mesh| mesh.quat).collect()),
        ("mesh_graphadr", graph_addresses(m)),
        ("mesh_graph", hulls(m).flatten().flat_map(graph).collect()),
    ];
    // of a mesh that does not touch, MuJoCo has polygons that nothing uses
    if !m.meshes.is_empty() && m.meshes.iter().all(|mesh| !mesh.polygons.vert.is_empty()) {
        all.extend(of_polygons(m));
    }
    all
}

/// Returns how much a normal magnifies errors of corners: the extent of a mesh over the height of the triangle that defines a polygon's normal, for
/// the narrowest such triangle with a height; at most 1e4.
pub fn needle(m: &Model) -> f64 {
    let of_mesh = |mesh: &Mesh| {
        let polygons = &mesh.polygons;
        let at = |corner: u32| mesh.vert[corner as usize].map(f64::from);
        let extent = mesh
            .vert
            .as_flattened()
            .iter()
            .fold(0.0, |most: f64, x| most.max(f64::from(x.abs())));
        let starts = polygons.vert_adr.iter().take(polygons.normal.len());
        let heights = starts.filter_map(|&start| match &polygons.vert[start as usize..] {
            &[a, b, c, ..] => Some(height([at(a), at(b), at(c)])),
            _ => None,
        });
        let magnified = heights.map(|height| extent / height).filter(|most| most.is_finite());
        magnified.fold(1.0, f64::max).min(1e4)
    };
    m.meshes.iter().map(of_mesh).fold(1.0, f64::max)
}

/// Returns the least height of a triangle.
fn height([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let side = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| q[k] - p[k]) };
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [ab, ac, bc] = [side(a, b), side(a, c), side(b, c)];
    let across = [1, 2, 0].map(|k: usize| ab[k] * ac[(k + 1) % 3] - ab[(k + 1) % 3] * ac[k]);
    norm(across) / norm(ab).max(norm(ac)).max(norm(bc))
}

/// Returns the arrays of polygons.
fn of_polygons(m: &Model) -> Named {
    let polygons = || m.meshes.iter().map(|mesh| &mesh.polygons);
    let sizes = |adr: &[u32]| -> Vec<f64> { adr.windows(2).map(|ends| f64::from(ends[1] - ends[0])).collect() };
    let numbers = |of: fn(&MeshPolygons) -> &Vec<u32>| -> Vec<f64> {
        polygons().flat_map(of).map(|&number| f64::from(number)).collect()
    };
    vec![
        ("mesh_polynum", polygons().map(|p| p.normal.len() as f64).collect()),
        (
            "mesh_polynormal",
            polygons().flat_map(|p| p.normal.as_flattened().to_vec()).collect(),
        ),
        (
            "mesh_polyvertnum",
            polygons().flat_map(|p| sizes(&p.vert_adr)).collect(),
        ),
        ("mesh_polyvert", numbers(|p| &p.vert)),
        ("mesh_polymapnum", polygons().flat_map(|p| sizes(&p.map_adr)).collect()),
        ("mesh_polymap", numbers(|p| &p.map)),
    ]
}

fn hulls(m: &Model) -> impl Iterator<Item = Option<&MeshHull>> {
    m.meshes.iter().map(|mesh| mesh.hull.as_ref())
}

/// Returns the index in `mesh_graph` of the hull of each mesh, or -1 without a hull.
fn graph_addresses(m: &Model) -> Vec<f64> {
    let mut next = 0;
    let address = |hull: Option<&MeshHull>| {
        let Some(hull) = hull else { return -1.0 };
        next += graph(hull).len();
        (next - graph(hull).len()) as f64
    };
    hulls(m).map(address).collect()
}

/// Returns a hull in the layout of `mesh_graph`: the numbers of corners and triangles, where the neighbours of each corner begin, the vertex of each
/// corner, the neighbours of each corner with -1 after the last, and the vertices at the corners of each triangle.
fn graph(hull: &MeshHull) -> Vec<f64> {
    let corners = hull.vert.len();
    let mut graph = vec![corners as f64, hull.face.len() as f64];
    graph.extend((0..corners).map(|corner| f64::from(hull.edge_adr[corner]) + corner as f64));
    graph.extend(hull.vert.iter().map(|&vertex| f64::from(vertex)));
    for ends in hull.edge_adr.windows(2) {
        let neighbours = &hull.edge[ends[0] as usize..ends[1] as usize];
        graph.extend(neighbours.iter().map(|&corner| f64::from(corner)));
        graph.push(-1.0);
    }
    graph.extend(hull.face.as_flattened().iter().map(|&vertex| f64::from(vertex)));
    graph
}
