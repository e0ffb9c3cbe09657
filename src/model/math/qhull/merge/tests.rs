//! Tests of convexity.

use crate::math::order;
use crate::math::qhull::Builder;
use crate::math::qhull::parts::{HullResult, Id, MergeReason, NONE};

impl Builder<'_> {
    /// Returns whether all new facets are clearly convex, by their vertices (`qh_checkzero`). Then nothing is merged.
    pub(super) fn clearly_convex(&mut self) -> HullResult<bool> {
        let all = self.facets_from(self.new_facets);
        for &facet in &all {
            let entry = &self.facets[facet];
            let horizon = entry.neighbors.first().copied().unwrap_or(NONE);
            if !self.facets[horizon].simplicial || entry.flipped || entry.dup_ridge || entry.normal.is_none() {
                return Ok(false);
            }
        }
        let most = -2.0 * self.tolerance.dist;
        for &facet in &all {
            self.vertex_visit += 1;
            for i in 1..self.facets[facet].neighbors.len() {
                let neighbor = self.facets[facet].neighbors[i];
                let vertex = self.facets[facet].vertices.get(i).copied().unwrap_or(NONE);
                self.vertices[vertex].visit = self.vertex_visit;
                if self.distance(self.place(vertex), neighbor) >= most {
                    return Ok(false);
                }
            }
            let horizon = self.facets[facet].neighbors.first().copied().unwrap_or(NONE);
            let opposite = self.facets[horizon].vertices.iter().copied();
            let opposite = opposite
                .into_iter()
                .find(|&vertex| self.vertices[vertex].visit != self.vertex_visit);
            if opposite.is_some_and(|vertex| self.distance(self.place(vertex), facet) >= most) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Tests new facets with their neighbours (`qh_getmergeset_initial`), and sorts the merges that this notes.
    pub(super) fn test_new_facets(&mut self) -> HullResult {
        self.visit += 1;
        let visit = self.visit;
        for facet in self.facets_from(self.new_facets) {
            self.facets[facet].visit = visit;
            for neighbor in self.facets[facet].neighbors.clone() {
                if self.facets[neighbor].visit != visit && self.test_convex(facet, neighbor)? {
                    let ridges = self.facets[neighbor].ridges.iter().copied();
                    let between = ridges
                        .into_iter()
                        .find(|&ridge| self.ridges[ridge].other(neighbor) == facet);
                    if let Some(ridge) = between {
                        self.ridges[ridge].nonconvex = true;
                    }
                }
            }
            self.facets[facet].tested = true;
            for i in 0..self.facets[facet].ridges.len() {
                let ridge = self.facets[facet].ridges[i];
                self.ridges[ridge].tested = true;
            }
        }
        self.sort_merges();
        Ok(())
    }

    /// Tests facets that changed, over the edges that did (`qh_getmergeset`), and sorts the merges.
    pub(super) fn test_changed_facets(&mut self) -> HullResult {
        self.visit += 1;
        let visit = self.visit;
        for facet in self.facets_from(self.new_facets) {
            if self.facets[facet].tested {
                continue;
            }
            self.facets[facet].visit = visit;
            for i in 0..self.facets[facet].neighbors.len() {
                let neighbor = self.facets[facet].neighbors[i];
                self.facets[neighbor].seen = false;
            }
            for ridge in self.facets[facet].ridges.clone() {
                if self.ridges[ridge].tested && !self.ridges[ridge].nonconvex {
                    continue;
                }
                let neighbor = self.ridges[ridge].other(facet);
                if self.facets[neighbor].seen {
                    // one edge speaks for all between the same facets
                    self.ridges[ridge].tested = true;
                    self.ridges[ridge].nonconvex = false;
                } else if self.facets[neighbor].visit != visit {
                    self.facets[neighbor].seen = true;
                    self.ridges[ridge].nonconvex = self.test_convex(facet, neighbor)?;
                    self.ridges[ridge].tested = true;
                }
            }
            self.facets[facet].tested = true;
        }
        self.sort_merges();
        Ok(())
    }

    /// Sorts merges so that the last, which is done first, has the first reason and the least distance
    /// (`qh_compare_facetmerge`); equal ones keep their order.
    fn sort_merges(&mut self) {
        order::sort_by(&mut self.merges, |a, b| {
            let reasons = b.reason.partial_cmp(&a.reason);
            let distances = b.distance.total_cmp(&a.distance);
            reasons.map_or(distances, |order| order.then(distances))
        });
    }

    /// Tests whether the centres of two facets are clearly below each other's plane; if not, notes a merge
    /// (`qh_test_centrum_merge`). Returns whether it did.
    fn test_convex(&mut self, facet: Id, neighbor: Id) -> HullResult<bool> {
        let radius = self.tolerance.centrum;
        let center = self.center(facet);
        let dist = self.distance(center, neighbor);
        let center = self.center(neighbor);
        let dist2 = self.distance(center, facet);
        let concave = dist > radius || dist2 > radius;
        let at_plane = |dist: f64| dist <= radius && dist >= -radius;
        let coplanar = at_plane(dist) || at_plane(dist2);
        if concave && coplanar {
            if dist > dist2 {
                self.note_merge(facet, neighbor, MergeReason::ConcaveCoplanar, dist)?;
            } else {
                self.note_merge(neighbor, facet, MergeReason::ConcaveCoplanar, dist2)?;
            }
        } else if concave {
            let most = if dist < dist2 { dist2 } else { dist };
            self.note_merge(facet, neighbor, MergeReason::Concave, most)?;
        } else if coplanar {
            let (a, b) = (dist.abs(), dist2.abs());
            self.note_merge(facet, neighbor, MergeReason::Coplanar, if a < b { a } else { b })?;
        }
        Ok(concave || coplanar)
    }
}
