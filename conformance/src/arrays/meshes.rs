//! Meshes, their hulls, and height fields.

use babybench::Model;
use babybench::model::{Mesh, MeshHull};

use super::Named;

/// Returns the arrays of meshes. Those without faces have the triangles of their hulls.
pub fn of_meshes(m: &Model) -> Named {
    let number = |of: fn(&Mesh) -> usize| -> Vec<f64> { m.meshes.iter().map(|mesh| of(mesh) as f64).collect() };
    let vert = m.meshes.iter().flat_map(|mesh| mesh.vert.as_flattened());
    vec![
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
    ]
}

fn hulls(m: &Model) -> impl Iterator<Item = Option<&MeshHull>> {
    m.meshes.iter().map(|mesh| mesh.hull.as_ref())
}

/// Returns where in `mesh_graph` the hull of each mesh begins: -1 where it has none.
fn graph_addresses(m: &Model) -> Vec<f64> {
    let mut next = 0;
    let address = |hull: Option<&MeshHull>| {
        let Some(hull) = hull else { return -1.0 };
        next += graph(hull).len();
        (next - graph(hull).len()) as f64
    };
    hulls(m).map(address).collect()
}

/// Returns a hull as `mesh_graph` has it: the numbers of corners and triangles, where the neighbours of each corner begin, the vertices
/// that corners are, the neighbours of each corner with -1 after the last, and the vertices at the corners of each triangle.
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
