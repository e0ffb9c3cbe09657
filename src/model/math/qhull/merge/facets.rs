//! The merge of one facet into another.

use super::{FEW_VERTICES, MOST_MERGES, TOO_WIDE};
use crate::math::qhull::Builder;
use crate::math::qhull::parts::{
    FORCED, HullFailure, HullResult, Id, MergeReason, NONE, Ridge, drop_sorted, drop_swapping, replace,
};
use crate::math::qhull::tolerance::{larger, smaller};

impl Builder<'_> {
    /// Merges a facet into another (`qh_mergefacet`). The bounds are how far its vertices are from the other's plane.
    pub(super) fn merge_facet(
        &mut self,
        facet: Id,
        into: Id,
        reason: MergeReason,
        bounds: Option<[f64; 2]>,
    ) -> HullResult {
        self.merge_count += 1;
        if let Some([low, high]) = bounds {
            let most = larger(TOO_WIDE * self.tolerance.one_merge, self.facets[facet].max_outside);
            let most = larger(most, self.facets[into].max_outside);
            if high > most || -low > most {
                return Err(HullFailure);
            }
        }
        let left = self.facet_count.saturating_sub(self.visible_count);
        if facet == into || self.facets[facet].visible || self.facets[into].visible || left <= 4 {
            return Err(HullFailure);
        }
        self.find_vertex_neighbors();
        self.make_ridges(facet)?;
        self.make_ridges(into)?;
        if let Some([low, high]) = bounds {
            self.max_outside = larger(self.max_outside, high);
            self.min_vertex = smaller(self.min_vertex, low);
            let wide = self.tolerance.wide;
            let entry = &mut self.facets[into];
            entry.max_outside = larger(entry.max_outside, high);
            entry.keep_center |= high > wide || low < -wide;
        }
        let merges = usize::from(self.facets[facet].merges) + usize::from(self.facets[into].merges) + 1;
        let entry = &mut self.facets[into];
        entry.merges = merges.min(MOST_MERGES) as u16;
        entry.new_merge = true;
        entry.dup_ridge = false;
        self.update_tested(facet, into);
        if self.facets[facet].vertices.len() == 3 {
            self.merge_triangle(facet, into, reason == MergeReason::Horizon)?;
        } else {
            self.merge_polygon(facet, into)?;
        }
        self.renew_facet(into)?;
        self.facets[into].new = true;
        self.facets[into].tested = false;
        if reason != MergeReason::Horizon {
            self.test_redundant_neighbors(into)?;
            self.test_degenerate_neighbors(facet)?;
            self.test_degenerate(into)?;
        }
        self.will_delete(facet, into)
    }

    /// Clears the marks of tested ridges, and the centre of facets that are not large (`qh_updatetested`).
    fn update_tested(&mut self, facet: Id, into: Id) {
        self.facets[into].tested = false;
        for i in 0..self.facets[facet].ridges.len() {
            let ridge = self.facets[facet].ridges[i];
            self.ridges[ridge].tested = false;
        }
        let entry = &mut self.facets[into];
        if entry.center.is_none() {
            return;
        }
        let size = entry.vertices.len();
        if !entry.keep_center {
            entry.keep_center = size > FEW_VERTICES;
        } else if size == 3 {
            entry.keep_center = false;
        }
        if !entry.keep_center {
            entry.center = None;
            for i in 0..self.facets[into].ridges.len() {
                let ridge = self.facets[into].ridges[i];
                self.ridges[ridge].tested = false;
            }
        }
    }

    /// Creates the ridges of a facet that has stopped being a simplex (`qh_makeridges`).
    pub(super) fn make_ridges(&mut self, facet: Id) -> HullResult {
        if !self.facets[facet].simplicial {
            return Ok(());
        }
        self.facets[facet].simplicial = false;
        let neighbors = self.facets[facet].neighbors.clone();
        let forced = neighbors.contains(&FORCED);
        for &neighbor in &neighbors {
            self.facets[neighbor].seen = false;
        }
        for i in 0..self.facets[facet].ridges.len() {
            let other = self.ridges[self.facets[facet].ridges[i]].other(facet);
            self.facets[other].seen = true;
        }
        for (i, &neighbor) in neighbors.iter().enumerate() {
            if neighbor == FORCED || self.facets[neighbor].seen {
                continue;
            }
            let mut vertices = self.facets[facet].vertices.clone();
            if i >= vertices.len() {
                return Err(HullFailure);
            }
            vertices.remove(i);
            let simplicial = self.facets[neighbor].simplicial;
            let top = self.facets[facet].top != (i % 2 == 1);
            let ridge = self.ridges.push(Ridge {
                vertices,
                top: if top { facet } else { neighbor },
                bottom: if top { neighbor } else { facet },
                simplicial_top: top || simplicial,
                simplicial_bottom: !top || simplicial,
                tested: self.facets[facet].tested && !forced,
                ..Ridge::default()
            });
            self.add_ridge(facet, ridge);
            self.add_ridge(neighbor, ridge);
        }
        if forced {
            while drop_swapping(&mut self.facets[facet].neighbors, FORCED) {}
        }
        Ok(())
    }

    /// Merges a facet of more than three vertices (`qh_mergeneighbors`, `qh_mergevertices`, `qh_mergeridges`,
    /// `qh_mergevertex_neighbors`).
    fn merge_polygon(&mut self, facet: Id, into: Id) -> HullResult {
        self.vertex_visit += 1;
        let visit = self.vertex_visit;
        for i in 0..self.facets[into].vertices.len() {
            let vertex = self.facets[into].vertices[i];
            self.vertices[vertex].visit = visit;
        }
        self.merge_neighbors(facet, into)?;
        let (ours, theirs) = (self.facets[facet].vertices.clone(), &self.facets[into].vertices);
        let mut both: Vec<Id> = ours.iter().chain(theirs).copied().collect();
        both.sort_unstable();
        both.reverse();
        both.dedup();
        self.facets[into].vertices = both;
        self.merge_ridges(facet, into)?;
        for vertex in ours {
            if self.vertices[vertex].visit != visit {
                replace(&mut self.vertices[vertex].neighbors, facet, into)?;
            } else {
                self.leave_facet(vertex, facet, into);
            }
        }
        if !self.facets[into].new {
            self.renew_vertices(&self.facets[into].vertices.clone())?;
        }
        Ok(())
    }

    /// Removes a facet from a vertex; a vertex with fewer than two remaining facets is not a corner.
    fn leave_facet(&mut self, vertex: Id, facet: Id, into: Id) {
        drop_swapping(&mut self.vertices[vertex].neighbors, facet);
        if self.vertices[vertex].neighbors.len() < 2 {
            drop_sorted(&mut self.facets[into].vertices, vertex);
            self.delete_vertex(vertex);
        }
    }

    fn merge_neighbors(&mut self, facet: Id, into: Id) -> HullResult {
        self.visit += 1;
        for i in 0..self.facets[into].neighbors.len() {
            let neighbor = self.facets[into].neighbors[i];
            self.facets[neighbor].visit = self.visit;
        }
        for neighbor in self.facets[facet].neighbors.clone() {
            if self.facets[neighbor].visit == self.visit {
                self.make_ridges(neighbor)?;
                self.replace_beside(neighbor, facet, into)?;
            } else if neighbor != into {
                self.facets[into].neighbors.push(neighbor);
                replace(&mut self.facets[neighbor].neighbors, facet, into)?;
            }
        }
        drop_swapping(&mut self.facets[facet].neighbors, into);
        drop_swapping(&mut self.facets[into].neighbors, facet);
        Ok(())
    }

    /// Removes a merged facet from a neighbour of both; the neighbour's first neighbour stays first, because that is the
    /// horizon.
    fn replace_beside(&mut self, neighbor: Id, facet: Id, into: Id) -> HullResult {
        let neighbors = &mut self.facets[neighbor].neighbors;
        if neighbors.first() == Some(&facet) {
            drop_swapping(neighbors, into);
            return replace(neighbors, facet, into);
        }
        drop_swapping(neighbors, facet);
        Ok(())
    }

    fn merge_ridges(&mut self, facet: Id, into: Id) -> HullResult {
        let mut i = 0;
        while let Some(&ridge) = self.facets[into].ridges.get(i) {
            if self.ridges[ridge].top == facet || self.ridges[ridge].bottom == facet {
                self.delete_ridge(ridge);
            } else {
                i += 1;
            }
        }
        for ridge in self.facets[facet].ridges.clone() {
            self.hand_ridge(ridge, facet, into);
            self.add_ridge(into, ridge);
        }
        Ok(())
    }

    /// Makes an edge of a facet one of another.
    fn hand_ridge(&mut self, ridge: Id, facet: Id, into: Id) {
        let entry = &mut self.ridges[ridge];
        if entry.top == facet {
            entry.top = into;
            entry.simplicial_top = false;
        } else {
            entry.bottom = into;
            entry.simplicial_bottom = false;
        }
    }

    /// Removes an edge from both facets (`qh_delridge_merge`).
    pub(super) fn delete_ridge(&mut self, ridge: Id) {
        if self.ridges[ridge].nonconvex {
            self.copy_nonconvex(ridge);
        }
        for i in 0..self.ridges[ridge].vertices.len() {
            let vertex = self.ridges[ridge].vertices[i];
            self.vertices[vertex].lost_ridge = true;
        }
        let mut i = 0;
        while let Some(&merge) = self.vertex_merges.get(i) {
            if merge.ridges.contains(&ridge) {
                self.vertex_merges.swap_remove(i);
            } else {
                i += 1;
            }
        }
        let (top, bottom) = (self.ridges[ridge].top, self.ridges[ridge].bottom);
        drop_swapping(&mut self.facets[top].ridges, ridge);
        drop_swapping(&mut self.facets[bottom].ridges, ridge);
    }

    /// Copies the mark of an edge to another edge between the same facets (`qh_copynonconvex`).
    pub(super) fn copy_nonconvex(&mut self, ridge: Id) {
        let (top, bottom) = (self.ridges[ridge].top, self.ridges[ridge].bottom);
        self.ridges[ridge].nonconvex = false;
        let between = |&&other: &&Id| {
            let entry = &self.ridges[other];
            other != ridge && (entry.top == bottom || entry.bottom == bottom)
        };
        if let Some(&other) = self.facets[top].ridges.iter().find(between) {
            self.ridges[other].nonconvex = true;
        }
    }

    /// Merges a triangle (`qh_mergesimplex`): the other facet gets the vertex that is opposite to their edge.
    fn merge_triangle(&mut self, facet: Id, into: Id, apex: bool) -> HullResult {
        let vertices = self.facets[facet].vertices.clone();
        let fresh = self.facets[into].new;
        let (opposite, added) = if apex {
            let opposite = *vertices.first().ok_or(HullFailure)?;
            if !fresh {
                self.renew_vertices(&self.facets[into].vertices.clone())?;
            }
            let added = self.facets[into].vertices.first() != Some(&opposite);
            if added {
                self.facets[into].vertices.insert(0, opposite);
            }
            (opposite, added)
        } else {
            let opposite = self.opposite(facet, into).ok_or(HullFailure)?;
            let added = self.add_vertex(into, opposite);
            if !fresh {
                self.renew_vertices(&self.facets[into].vertices.clone())?;
            } else {
                self.renew_vertices(&[opposite])?;
            }
            (opposite, added)
        };
        for vertex in vertices {
            if vertex == opposite && added {
                replace(&mut self.vertices[vertex].neighbors, facet, into)?;
            } else {
                self.leave_facet(vertex, facet, into);
            }
        }
        self.merge_triangle_ridges(facet, into)
    }

    /// Finds the vertex of a triangle that is not on its edge to a neighbour; those that are lose that edge.
    fn opposite(&mut self, facet: Id, neighbor: Id) -> Option<Id> {
        let ridges = self.facets[facet].ridges.iter().copied();
        let between = ridges
            .into_iter()
            .find(|&ridge| self.ridges[ridge].other(facet) == neighbor);
        let edge = between.map_or_else(Vec::new, |ridge| self.ridges[ridge].vertices.clone());
        for &vertex in &edge {
            self.vertices[vertex].lost_ridge = true;
        }
        self.facets[facet]
            .vertices
            .iter()
            .copied()
            .find(|vertex| !edge.contains(vertex))
    }

    /// Adds a vertex in its place; returns whether it was new (`qh_addfacetvertex`).
    pub(super) fn add_vertex(&mut self, facet: Id, vertex: Id) -> bool {
        let vertices = &mut self.facets[facet].vertices;
        let place = vertices
            .iter()
            .position(|&other| other <= vertex)
            .unwrap_or(vertices.len());
        let added = vertices.get(place) != Some(&vertex);
        if added {
            vertices.insert(place, vertex);
        }
        added
    }

    fn merge_triangle_ridges(&mut self, facet: Id, into: Id) -> HullResult {
        self.visit += 1;
        for i in 0..self.facets[into].neighbors.len() {
            let neighbor = self.facets[into].neighbors[i];
            self.facets[neighbor].visit = self.visit;
        }
        let mut i = 0;
        while let Some(&ridge) = self.facets[facet].ridges.get(i) {
            let other = self.ridges[ridge].other(facet);
            if other == into {
                self.delete_ridge(ridge);
                drop_swapping(&mut self.facets[into].neighbors, facet);
                continue;
            }
            if other == NONE || (self.facets[other].dup_ridge && !self.facets[other].neighbors.contains(&facet)) {
                return Err(HullFailure);
            }
            self.add_ridge(into, ridge);
            if self.facets[other].visit != self.visit {
                self.facets[into].neighbors.push(other);
                replace(&mut self.facets[other].neighbors, facet, into)?;
                self.facets[other].visit = self.visit;
            } else {
                self.make_ridges(other)?;
                self.replace_beside(other, facet, into)?;
            }
            self.hand_ridge(ridge, facet, into);
            i += 1;
        }
        Ok(())
    }
}
