//! Facets with too few neighbours, and facets whose vertices are all in a neighbour.

use crate::math::qhull::Builder;
use crate::math::qhull::parts::{HullFailure, HullResult, Id, Merge, MergeReason, NONE, drop_swapping};

impl Builder<'_> {
    /// Merges degenerate and redundant facets (`qh_merge_degenredundant`); returns whether there were any.
    pub(super) fn merge_degenerate(&mut self) -> HullResult<bool> {
        let mut any = false;
        while let Some(Merge {
            facet1, facet2, reason, ..
        }) = self.degenerates.pop()
        {
            if self.facets[facet1].visible {
                continue;
            }
            self.facets[facet1].degenerate = false;
            self.facets[facet1].redundant = false;
            if reason == MergeReason::Redundant {
                let into = self.replacement(facet2)?;
                if into == NONE {
                    return Err(HullFailure);
                }
                if facet1 != into {
                    self.merge_facet(facet1, into, reason, None)?;
                    any = true;
                }
                continue;
            }
            let size = self.facets[facet1].neighbors.len();
            if size == 0 {
                self.will_delete(facet1, NONE)?;
                for vertex in self.facets[facet1].vertices.clone() {
                    drop_swapping(&mut self.vertices[vertex].neighbors, facet1);
                    if self.vertices[vertex].neighbors.is_empty() {
                        self.delete_vertex(vertex);
                    }
                }
                any = true;
            } else if size < 3 {
                let (neighbor, [_, low, high]) = self.best_neighbor(facet1)?;
                self.merge_facet(facet1, neighbor, reason, Some([low, high]))?;
                any = true;
            }
        }
        Ok(any)
    }

    /// Notes a facet whose vertices are all in a neighbour, or that has too few neighbours (`qh_degen_redundant_facet`).
    pub(super) fn test_degenerate(&mut self, facet: Id) -> HullResult {
        if self.facets[facet].flipped {
            return Ok(());
        }
        for i in 0..self.facets[facet].neighbors.len() {
            let neighbor = self.facets[facet].neighbors[i];
            if self.facets[neighbor].flipped {
                continue;
            }
            if self.facets[neighbor].visible {
                return Err(HullFailure);
            }
            self.mark_vertices(neighbor);
            if self.all_marked(facet) {
                return self.note_merge(facet, neighbor, MergeReason::Redundant, 0.0);
            }
        }
        if self.facets[facet].neighbors.len() < 3 {
            self.note_merge(facet, facet, MergeReason::Degenerate, 0.0)?;
        }
        Ok(())
    }

    /// Notes neighbours that have too few neighbours (`qh_test_degen_neighbors`).
    pub(super) fn test_degenerate_neighbors(&mut self, facet: Id) -> HullResult {
        for i in 0..self.facets[facet].neighbors.len() {
            let neighbor = self.facets[facet].neighbors[i];
            let entry = &self.facets[neighbor];
            if entry.visible {
                return Err(HullFailure);
            }
            if !entry.degenerate && !entry.redundant && !entry.dup_ridge && entry.neighbors.len() < 3 {
                self.note_merge(neighbor, neighbor, MergeReason::Degenerate, 0.0)?;
            }
        }
        Ok(())
    }

    /// Notes neighbours whose vertices are all in a facet (`qh_test_redundant_neighbors`).
    pub(super) fn test_redundant_neighbors(&mut self, facet: Id) -> HullResult {
        if self.facets[facet].neighbors.len() < 3 {
            return self.note_merge(facet, facet, MergeReason::Degenerate, 0.0);
        }
        self.mark_vertices(facet);
        for i in 0..self.facets[facet].neighbors.len() {
            let neighbor = self.facets[facet].neighbors[i];
            let entry = &self.facets[neighbor];
            if entry.visible {
                return Err(HullFailure);
            }
            let turned = self.facets[facet].flipped && !entry.flipped;
            if !entry.degenerate && !entry.redundant && !entry.dup_ridge && !turned && self.all_marked(neighbor) {
                self.note_merge(neighbor, facet, MergeReason::Redundant, 0.0)?;
            }
        }
        Ok(())
    }

    fn mark_vertices(&mut self, facet: Id) {
        self.vertex_visit += 1;
        for i in 0..self.facets[facet].vertices.len() {
            let vertex = self.facets[facet].vertices[i];
            self.vertices[vertex].visit = self.vertex_visit;
        }
    }

    fn all_marked(&self, facet: Id) -> bool {
        let mut vertices = self.facets[facet].vertices.iter();
        vertices.all(|&vertex| self.vertices[vertex].visit == self.vertex_visit)
    }
}
