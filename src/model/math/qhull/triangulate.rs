//! Polygons that are split into triangles (`qh_triangulate`, option `Qt`).

use super::Builder;
use super::parts::{HullFailure, HullResult, Id, Merge, MergeReason, NONE, TAIL, replace};

impl Builder<'_> {
    /// Replaces every polygon in the list by triangles, after the facets that already are triangles.
    pub(super) fn triangulate(&mut self) -> HullResult {
        self.visit += 1;
        self.new_vertices = TAIL;
        let (mut first_facet, mut first_vertex) = (NONE, NONE);
        let mut facet = self.first_facet;
        while Self::listed(facet) {
            let next = self.facets[facet].next;
            if !self.facets[facet].visible && !self.facets[facet].simplicial {
                if first_facet == NONE {
                    first_facet = facet;
                }
                self.split(facet, &mut first_vertex)?;
            }
            facet = next;
        }
        if first_facet == NONE {
            self.reset_lists(true);
            return Ok(());
        }
        self.drop_null_triangles(first_facet)?;
        self.new_vertices = if first_vertex == NONE { TAIL } else { first_vertex };
        self.visible_facets = NONE;
        self.update_neighbors();
        self.reset_lists(false);
        for facet in self.facets_from(self.first_facet) {
            if self.facets[facet].visible {
                self.delete_facet(facet)?;
            }
        }
        Ok(())
    }

    /// Makes a triangle over each edge of a polygon from its latest vertex (`qh_triangulate_facet`).
    fn split(&mut self, polygon: Id, first_vertex: &mut Id) -> HullResult {
        self.first_new = self.facets.len() as Id;
        for neighbor in self.facets[polygon].neighbors.clone() {
            self.facets[neighbor].seen = false;
            self.facets[neighbor].coplanar_horizon = false;
        }
        (self.visible_facets, self.new_facets) = (TAIL, TAIL);
        self.facets[polygon].visit = self.visit;
        let apex = *self.facets[polygon].vertices.first().ok_or(HullFailure)?;
        self.cone_over_ridges(polygon, apex)?;
        self.will_delete(polygon, NONE)?;
        let (normal, offset) = (self.facets[polygon].normal, self.facets[polygon].offset);
        for facet in self.facets_from(self.new_facets) {
            let entry = &mut self.facets[facet];
            (entry.normal, entry.offset, entry.tricoplanar) = (normal, offset, true);
        }
        self.match_new_facets()?;
        if *first_vertex == NONE {
            *first_vertex = self.new_vertices;
        }
        self.new_vertices = NONE;
        self.visible_facets = NONE;
        self.update_neighbors();
        self.reset_lists(false);
        Ok(())
    }

    /// Removes triangles over the two edges that meet at the polygon's own apex, and pairs of triangles with the same vertices.
    fn drop_null_triangles(&mut self, first: Id) -> HullResult {
        for facet in self.facets_from(first) {
            if self.facets[facet].visible {
                continue;
            }
            self.facets[facet].ridges.clear();
            let vertices = &self.facets[facet].vertices;
            if vertices.first() == vertices.get(1) {
                let &[a, b, ..] = self.facets[facet].neighbors.as_slice() else {
                    return Err(HullFailure);
                };
                self.link(facet, a, facet, b)?;
                self.will_delete(facet, NONE)?;
            }
        }
        self.visible_facets = TAIL;
        while let Some(Merge {
            facet1, facet2, reason, ..
        }) = self.degenerates.pop()
        {
            if reason == MergeReason::Mirror {
                self.drop_mirrored(facet1, facet2)?;
            }
        }
        Ok(())
    }

    /// Makes two facets neighbours, in the places of those between them (`qh_triangulate_link`).
    fn link(&mut self, old_a: Id, a: Id, old_b: Id, b: Id) -> HullResult {
        let mutual = self.facets[a].neighbors.contains(&b);
        if mutual != self.facets[b].neighbors.contains(&a) {
            return Err(HullFailure);
        }
        if mutual {
            // two triangles that have two edges in common have all vertices in common
            let marked = self.facets[a].redundant && self.facets[b].redundant && self.mirrors(a, b);
            if !marked {
                if self.facets[a].vertices != self.facets[b].vertices {
                    return Err(HullFailure);
                }
                if !self.facets[b].redundant {
                    if self.facets[a].redundant {
                        return Err(HullFailure);
                    }
                    self.facets[a].redundant = true;
                    self.facets[b].redundant = true;
                    self.degenerates.push(Merge {
                        facet1: a,
                        facet2: b,
                        reason: MergeReason::Mirror,
                        distance: 0.0,
                    });
                }
            }
        }
        replace(&mut self.facets[b].neighbors, old_b, a)?;
        replace(&mut self.facets[a].neighbors, old_a, b)
    }

    fn mirrors(&self, a: Id, b: Id) -> bool {
        let both = |merge: &Merge| [(a, b), (b, a)].contains(&(merge.facet1, merge.facet2));
        self.degenerates
            .iter()
            .any(|merge| merge.reason == MergeReason::Mirror && both(merge))
    }

    /// Removes two triangles with the same vertices, and joins their neighbours (`qh_triangulate_mirror`).
    fn drop_mirrored(&mut self, a: Id, b: Id) -> HullResult {
        for i in 0..self.facets[a].neighbors.len() {
            let near = self.facets[a].neighbors[i];
            let far = *self.facets[b].neighbors.get(i).ok_or(HullFailure)?;
            if near == b && far == a {
                continue;
            }
            if self.facets[near].redundant && self.facets[far].redundant && self.mirrors(near, far) {
                continue;
            }
            if self.facets[near].visible && self.facets[far].visible {
                continue;
            }
            self.link(a, near, b, far)?;
        }
        self.will_delete(a, NONE)?;
        self.will_delete(b, NONE)
    }
}
