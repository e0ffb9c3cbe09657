//! The polytope that EPA expands: vertices, triangular faces with their neighbours, and the open faces.

use super::nearest::foot_on_plane;
use super::support::Vertex;
use super::{dot, sub};
use crate::math::{Vec3, norm};

/// Greatest number of faces, deleted ones included.
pub(super) const MAX_FACES: usize = 1000;

/// A triangle of the polytope. Edge k runs from vertex k to vertex k + 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Vertex numbers.
    pub(super) vertices: [u16; 3],
    /// Face across each edge.
    pub(super) neighbours: [u16; 3],
    state: ListState,
    /// Foot of the perpendicular from the origin to the plane of the face.
    pub(super) foot: Vec3,
    /// Distance of the plane from the origin.
    pub(super) distance: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum ListState {
    /// The face is not in the open list, and serves as a neighbour only.
    Unlisted,
    /// The face is at this index of the open list.
    Listed(u16),
    Deleted,
}

/// Returns the next edge or vertex of a face.
#[inline(always)]
pub(super) fn after(edge: u8) -> u8 {
    if edge == 2 { 0 } else { edge + 1 }
}

/// Returns the previous edge or vertex of a face.
#[inline(always)]
fn before(edge: u8) -> u8 {
    if edge == 0 { 2 } else { edge - 1 }
}

/// An entry of the open list.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenEntry {
    pub(super) distance: f64,
    pub(super) face: u16,
}

/// An edge, as seen from one of its faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) face: u16,
    pub(super) edge: u8,
}

/// A polytope. Its buffers keep their memory from one use to the next.
#[derive(Clone, Debug)]
pub(super) struct Polytope {
    pub(super) vertices: Vec<Vertex>,
    pub(super) faces: Vec<Face>,
    /// Faces that may be nearest to the origin.
    pub(super) open: Vec<OpenEntry>,
    /// Edges between the faces that the newest vertex sees and those it does not, in order.
    pub(super) horizon: Vec<Edge>,
    /// Edges still to be crossed in the search for the horizon.
    pending: Vec<Edge>,
}

impl Polytope {
    /// Creates an empty polytope with room for the greatest number of faces.
    pub(super) fn new() -> Self {
        Polytope {
            vertices: Vec::with_capacity(128),
            faces: Vec::with_capacity(MAX_FACES),
            open: Vec::with_capacity(MAX_FACES),
            horizon: Vec::with_capacity(2 * MAX_FACES + 8),
            pending: Vec::with_capacity(2 * MAX_FACES + 8),
        }
    }

    /// Removes everything.
    pub(super) fn clear(&mut self) {
        self.vertices.clear();
        self.faces.clear();
        self.open.clear();
    }

    /// Appends a vertex and returns its number.
    #[inline(always)]
    pub(super) fn add_vertex(&mut self, vertex: Vertex) -> u16 {
        self.vertices.push(vertex);
        (self.vertices.len() - 1) as u16
    }

    /// Appends a vertex of a simplex, with its point recomputed from its two sources.
    pub(super) fn add_simplex_vertex(&mut self, vertex: &Vertex) -> u16 {
        let point = sub(vertex.a, vertex.b);
        self.add_vertex(Vertex { point, ..*vertex })
    }

    /// Returns the point of the Minkowski difference at a vertex.
    #[inline(always)]
    pub(super) fn point(&self, vertex: u16) -> Vec3 {
        self.vertices[vertex as usize].point
    }

    /// Appends a face and returns its distance, 0 if its vertices are on a line.
    #[inline(always)]
    pub(super) fn add_face(&mut self, vertices: [u16; 3], neighbours: [u16; 3]) -> f64 {
        let (a, b, c) = (
            self.point(vertices[0]),
            self.point(vertices[1]),
            self.point(vertices[2]),
        );
        let (foot, distance) = match foot_on_plane(c, b, a) {
            Some(foot) => (foot, norm(foot)),
            None => ([0.0; 3], 0.0),
        };
        self.faces.push(Face {
            vertices,
            neighbours,
            state: ListState::Unlisted,
            foot,
            distance,
        });
        distance
    }

    /// Appends a face to the open list, if `wanted`.
    #[inline(always)]
    pub(super) fn list(&mut self, face: u16, wanted: bool) {
        // without a branch, since for most faces of EPA it is hard to predict
        let entry = &mut self.faces[face as usize];
        // a wanted face stays, another one is truncated at once
        let place = self.open.len();
        entry.state = if wanted {
            ListState::Listed(place as u16)
        } else {
            ListState::Unlisted
        };
        let distance = entry.distance;
        self.open.push(OpenEntry { distance, face });
        self.open.truncate(place + wanted as usize);
    }

    /// Deletes a face. The last entry of the open list takes its place there.
    #[inline]
    fn delete(&mut self, face: u16) {
        if let ListState::Listed(place) = self.faces[face as usize].state {
            // constant time; the order that it leaves is MuJoCo's, and decides between faces of equal distance
            self.open.swap_remove(place as usize);
            if let Some(moved) = self.open.get(place as usize) {
                self.faces[moved.face as usize].state = ListState::Listed(place);
            }
        }
        // the face keeps its place and its values: neighbours refer to it by number, and EPA may still end with it
        self.faces[face as usize].state = ListState::Deleted;
    }

    /// Returns which edge of `face` starts at the vertex.
    #[inline(always)]
    fn edge_from(&self, face: u16, vertex: u16) -> u8 {
        let [first, second, _] = self.faces[face as usize].vertices;
        // a face found across an edge has the vertex, so two comparisons tell which of three it is, and no branch
        (first != vertex) as u8 * (1 + (second != vertex) as u8)
    }

    /// Deletes the faces that see the point `w`, from the face `seed` outwards, depth first, and collects the horizon.
    pub(super) fn carve(&mut self, seed: u16, w: Vec3) {
        self.horizon.clear();
        self.pending.clear();
        self.delete(seed);
        // a stack gives the last first: edges 0, 1, 2 in turn, each followed to its end, walk the horizon once around,
        // and the fan of new faces relies on that order
        self.pending.push(Edge { face: seed, edge: 2 });
        self.pending.push(Edge { face: seed, edge: 1 });
        // as MuJoCo does, without asking whether this neighbour is deleted: in a closed polytope only the seed is so
        // far
        self.cross_edge(Edge { face: seed, edge: 0 }, w);
        while let Some(next) = self.pending.pop() {
            let neighbour = self.faces[next.face as usize].neighbours[next.edge as usize];
            if self.faces[neighbour as usize].state != ListState::Deleted {
                self.cross_edge(next, w);
            }
        }
    }

    /// Examines the face across an edge: deletes it and notes its other two edges, or adds the edge to the horizon.
    #[inline(always)]
    fn cross_edge(&mut self, from: Edge, w: Vec3) {
        let here = &self.faces[from.face as usize];
        let face = here.neighbours[from.edge as usize];
        let edge = self.edge_from(face, here.vertices[after(from.edge) as usize]);
        let there = &self.faces[face as usize];
        // `foot` is the normal, as long as the distance: the face sees the points beyond its plane, where the product
        // exceeds the square. A face whose plane holds the point is replaced as well
        if dot(there.foot, w) < there.distance * there.distance {
            self.horizon.push(Edge { face, edge });
            return;
        }
        self.delete(face);
        self.pending.push(Edge {
            face,
            // below the other edge on the stack, for the order around the horizon
            edge: before(edge),
        });
        self.pending.push(Edge {
            face,
            edge: after(edge),
        });
    }
}
