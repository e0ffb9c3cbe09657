//! The facets of each vertex. The order of these sets decides the final order of the edges.

use super::Builder;
use super::parts::{Id, NONE, drop_swapping, push_unique};

impl Builder<'_> {
    /// Finds the facets of all vertices, before the first merge (`qh_vertexneighbors`); from then on they are kept up to date.
    pub(super) fn find_vertex_neighbors(&mut self) {
        if self.has_neighbors {
            return;
        }
        for vertex in self.vertices_from(self.first_vertex) {
            self.vertices[vertex].neighbors.clear();
        }
        for facet in self.facets_from(self.first_facet) {
            if !self.facets[facet].visible {
                for i in 0..self.facets[facet].vertices.len() {
                    let vertex = self.facets[facet].vertices[i];
                    self.vertices[vertex].neighbors.push(facet);
                }
            }
        }
        self.has_neighbors = true;
    }

    /// Removes deleted facets from their vertices and adds the new facets of a point (`qh_update_vertexneighbors_cone`).
    pub(super) fn update_cone_neighbors(&mut self) {
        if self.has_neighbors {
            for vertex in self.vertices_from(self.new_vertices) {
                let mut i = 0;
                while let Some(&neighbor) = self.vertices[vertex].neighbors.get(i) {
                    if self.facets[neighbor].visible {
                        self.vertices[vertex].neighbors.swap_remove(i);
                    } else {
                        i += 1;
                    }
                }
            }
            for facet in self.facets_from(self.new_facets) {
                for i in 0..self.facets[facet].vertices.len() {
                    let vertex = self.facets[facet].vertices[i];
                    self.vertices[vertex].neighbors.push(facet);
                }
            }
        }
        self.drop_unseen_vertices();
    }

    /// The same after merges of vertices and after polygons are split (`qh_update_vertexneighbors`): here the remaining
    /// facets keep their order.
    pub(super) fn update_neighbors(&mut self) {
        if self.has_neighbors {
            for vertex in self.vertices_from(self.new_vertices) {
                let mut neighbors = std::mem::take(&mut self.vertices[vertex].neighbors);
                neighbors.retain(|&facet| !self.facets[facet].visible);
                self.vertices[vertex].neighbors = neighbors;
            }
            for facet in self.facets_from(self.new_facets) {
                let fresh = self.first_new != NONE && facet >= self.first_new;
                for i in 0..self.facets[facet].vertices.len() {
                    let vertex = self.facets[facet].vertices[i];
                    let neighbors = &mut self.vertices[vertex].neighbors;
                    if fresh {
                        neighbors.push(facet);
                    } else {
                        push_unique(neighbors, facet);
                    }
                }
            }
        }
        self.drop_unseen_vertices();
    }

    /// Marks vertices of removed facets that are in no other.
    fn drop_unseen_vertices(&mut self) {
        for visible in self.visible() {
            for vertex in self.facets[visible].vertices.clone() {
                if self.vertices[vertex].new || self.vertices[vertex].deleted {
                    continue;
                }
                let neighbors = &self.vertices[vertex].neighbors;
                if self.has_neighbors && neighbors.iter().any(|&facet| !self.facets[facet].visible) {
                    drop_swapping(&mut self.vertices[vertex].neighbors, visible);
                } else {
                    self.delete_vertex(vertex);
                }
            }
        }
    }

    /// Marks a vertex for removal.
    pub(super) fn delete_vertex(&mut self, vertex: Id) {
        self.vertices[vertex].deleted = true;
        self.dead_vertices.push(vertex);
    }
}
