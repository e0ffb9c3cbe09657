//! Vertices that merged facets no longer need.

use crate::math::qhull::Builder;
use crate::math::qhull::parts::{HullResult, Id, drop_sorted, drop_swapping};

impl Builder<'_> {
    /// Removes vertices without edges, and those in two facets only, from merged facets (`qh_reducevertices`). Returns whether
    /// facets became degenerate or redundant by it.
    pub(super) fn reduce_vertices(&mut self) -> HullResult<bool> {
        let mut any = self.merge_degenerate()?;
        'again: loop {
            self.check_pace()?;
            for facet in self.facets_from(self.new_facets) {
                if self.facets[facet].new_merge && self.remove_extra_vertices(facet) {
                    self.test_degenerate(facet)?;
                    if self.merge_degenerate()? {
                        any = true;
                        continue 'again;
                    }
                }
            }
            for facet in self.facets_from(self.new_facets) {
                if !self.facets[facet].new_merge {
                    continue;
                }
                self.facets[facet].new_merge = false;
                let mut i = 0;
                while let Some(&vertex) = self.facets[facet].vertices.get(i) {
                    if self.vertices[vertex].lost_ridge && self.rename_shared(vertex, facet)? {
                        if self.merge_degenerate()? {
                            any = true;
                            continue 'again;
                        }
                    } else {
                        i += 1;
                    }
                }
            }
            break;
        }
        for vertex in self.vertices_from(self.new_vertices) {
            if !self.vertices[vertex].deleted {
                self.vertices[vertex].lost_ridge = false;
            }
        }
        Ok(any)
    }

    /// Removes vertices of a merged facet that are on none of its edges (`qh_remove_extravertices`); returns whether there were
    /// any.
    pub(super) fn remove_extra_vertices(&mut self, facet: Id) -> bool {
        if self.facets[facet].simplicial {
            return false;
        }
        // a facet that grows to a cap of thousands of edges is asked at each merge, so that each vertex must not look through all edges
        let ridges = self.facets[facet].ridges.iter();
        let mut on_edges: Vec<Id> = ridges
            .flat_map(|&ridge| &self.ridges[ridge].vertices)
            .copied()
            .collect();
        on_edges.sort_unstable();
        self.work += on_edges.len();
        let vertices = self.facets[facet].vertices.iter().copied();
        let extra: Vec<Id> = vertices
            .filter(|vertex| on_edges.binary_search(vertex).is_err())
            .collect();
        for &vertex in &extra {
            drop_sorted(&mut self.facets[facet].vertices, vertex);
            drop_swapping(&mut self.vertices[vertex].neighbors, facet);
            if self.vertices[vertex].neighbors.is_empty() {
                self.delete_vertex(vertex);
            }
        }
        !extra.is_empty()
    }
}
