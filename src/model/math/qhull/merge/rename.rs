//! Replaces vertices by a neighbouring one.

use crate::math::order;
use crate::math::qhull::Builder;
use crate::math::qhull::parts::{
    HullFailure, HullResult, Id, MergeReason, NONE, TAIL, VertexMerge, drop_sorted, drop_swapping, push_unique,
};

/// Largest distance of vertices that are merged, in greatest widths (`qh_WIDEpinched`).
const PINCHED: f64 = 100.0;

impl Builder<'_> {
    /// Replaces a vertex of only two facets, in one of them, by another vertex of both (`qh_rename_sharedvertex`); returns whether there is one.
    pub(super) fn rename_shared(&mut self, vertex: Id, facet: Id) -> HullResult<bool> {
        let &[a, b] = self.vertices[vertex].neighbors.as_slice() else {
            return Ok(false);
        };
        let other = if a == facet { b } else { a };
        self.visit += 1;
        self.facets[other].visit = self.visit;
        let ridges = self.vertex_ridges(vertex, facet);
        let shared = self.facets[facet].vertices.iter().copied();
        let mut shared: Vec<Id> = shared
            .filter(|vertex| self.facets[other].vertices.contains(vertex))
            .collect();
        drop_swapping(&mut shared, vertex);
        let Some(into) = self.find_new_vertex(vertex, shared, &ridges) else {
            return Ok(false);
        };
        self.rename(vertex, into, &ridges, Some((facet, other)))?;
        Ok(true)
    }

    /// Returns the edges of a facet at a vertex that lead to marked facets; marks the facet (`qh_vertexridges_facet`).
    fn vertex_ridges(&mut self, vertex: Id, facet: Id) -> Vec<Id> {
        let ridges = self.facets[facet].ridges.iter().copied().filter(|&ridge| {
            let entry = &self.ridges[ridge];
            self.facets[entry.other(facet)].visit == self.visit && entry.vertices.contains(&vertex)
        });
        let ridges = ridges.collect();
        self.facets[facet].visit = self.visit - 1;
        ridges
    }

    /// Returns the edges at a vertex (`qh_vertexridges`); the last facet adds none, and is left out unless requested.
    fn all_vertex_ridges(&mut self, vertex: Id, last_too: bool) -> Vec<Id> {
        self.visit += 2;
        let neighbors = self.vertices[vertex].neighbors.clone();
        for &facet in &neighbors {
            self.facets[facet].visit = self.visit;
        }
        let count = neighbors.len().saturating_sub(usize::from(!last_too));
        neighbors
            .iter()
            .take(count)
            .flat_map(|&facet| self.vertex_ridges(vertex, facet))
            .collect()
    }

    /// Finds a vertex that can replace another without making two edges equal, preferring the one on the fewest edges
    /// (`qh_find_newvertex`).
    fn find_new_vertex(&mut self, old: Id, vertices: Vec<Id>, ridges: &[Id]) -> Option<Id> {
        let on = |vertex: Id| {
            ridges
                .iter()
                .filter(|&&ridge| self.ridges[ridge].vertices.contains(&vertex))
                .count()
        };
        let mut counted: Vec<(usize, Id)> = vertices.into_iter().map(|vertex| (on(vertex), vertex)).collect();
        // those on none go, and the last takes their place
        let mut i = 0;
        while let Some(&(count, _)) = counted.get(i) {
            if count == 0 {
                counted.swap_remove(i);
            } else {
                i += 1;
            }
        }
        order::sort_by(&mut counted, |a, b| a.0.cmp(&b.0));
        self.vertex_visit = self.vertex_visit.max(ridges.len() as u32) + 1;
        let rest = |builder: &Self, ridge: Id, without: Id| {
            let vertices = &builder.ridges[ridge].vertices;
            let rest: Vec<Id> = vertices.iter().copied().filter(|&vertex| vertex != without).collect();
            (rest.len() + 1 == vertices.len()).then_some(rest)
        };
        let old_ones: Vec<Option<Vec<Id>>> = ridges.iter().map(|&ridge| rest(self, ridge, old)).collect();
        counted.into_iter().map(|(_, vertex)| vertex).find(|&vertex| {
            let theirs = self.all_vertex_ridges(vertex, false);
            !theirs.iter().any(|&ridge| {
                let ours = rest(self, ridge, vertex);
                let same = |(&other, old): (&Id, &Option<Vec<Id>>)| other != ridge && ours.is_some() && *old == ours;
                ridges.iter().zip(&old_ones).any(same)
            })
        })
    }

    /// Replaces a vertex on edges and in facets (`qh_renamevertex`): in one of two, or wherever it is.
    fn rename(&mut self, old: Id, into: Id, ridges: &[Id], between: Option<(Id, Id)>) -> HullResult {
        for &ridge in ridges {
            if self.rename_on_ridge(ridge, old, into)? {
                let entry = &self.ridges[ridge];
                let doubtful = |facet: Id| {
                    let facet = &self.facets[facet];
                    let size = facet.vertices.len();
                    size < 3 || (size == 3 && !facet.simplicial && facet.vertices.contains(&into))
                };
                if !doubtful(entry.top) && !doubtful(entry.bottom) {
                    self.note_same_edges(ridge);
                }
            }
        }
        let Some((facet, other)) = between else {
            return self.leave_all(old);
        };
        if self.vertices[old].neighbors.len() == 2 {
            for neighbor in self.vertices[old].neighbors.clone() {
                drop_sorted(&mut self.facets[neighbor].vertices, old);
                self.test_degenerate(neighbor)?;
            }
            self.delete_vertex(old);
        } else {
            drop_sorted(&mut self.facets[facet].vertices, old);
            drop_swapping(&mut self.vertices[old].neighbors, facet);
            if self.remove_extra_vertices(other) {
                self.test_degenerate(other)?;
            }
        }
        self.test_degenerate(facet)
    }

    /// Removes a vertex from all its facets.
    fn leave_all(&mut self, old: Id) -> HullResult {
        let mut i = 0;
        while let Some(&neighbor) = self.vertices[old].neighbors.get(i) {
            i += 1;
            if self.facets[neighbor].simplicial {
                self.test_degenerate(neighbor)?;
                continue;
            }
            self.drop_neighbors(neighbor)?;
            drop_sorted(&mut self.facets[neighbor].vertices, old);
            if self.remove_extra_vertices(neighbor) {
                i -= 1;
            }
            self.test_degenerate(neighbor)?;
            self.test_redundant_neighbors(neighbor)?;
            self.test_degenerate_neighbors(neighbor)?;
        }
        if !self.vertices[old].deleted {
            self.delete_vertex(old);
        }
        Ok(())
    }

    /// Drops neighbours with which a facet no longer shares an edge (`qh_maydropneighbor`).
    fn drop_neighbors(&mut self, facet: Id) -> HullResult {
        let ridges = &self.facets[facet].ridges;
        let beyond: Vec<Id> = ridges.iter().map(|&ridge| self.ridges[ridge].other(facet)).collect();
        let mut i = 0;
        while let Some(&neighbor) = self.facets[facet].neighbors.get(i) {
            if self.facets[neighbor].visible {
                return Err(HullFailure);
            }
            if beyond.contains(&neighbor) {
                i += 1;
                continue;
            }
            if self.facets[neighbor].simplicial {
                return Err(HullFailure);
            }
            drop_swapping(&mut self.facets[neighbor].neighbors, facet);
            if self.facets[neighbor].neighbors.len() < 3 {
                self.note_merge(neighbor, neighbor, MergeReason::Degenerate, 0.0)?;
            }
            self.facets[facet].neighbors.swap_remove(i);
        }
        if self.facets[facet].neighbors.len() < 3 {
            self.note_merge(facet, facet, MergeReason::Degenerate, 0.0)?;
        }
        Ok(())
    }

    /// Replaces a vertex of an edge; an edge that has both vertices is removed (`qh_renameridgevertex`). Returns whether it remains.
    fn rename_on_ridge(&mut self, ridge: Id, old: Id, into: Id) -> HullResult<bool> {
        let vertices = &mut self.ridges[ridge].vertices;
        let before = vertices.iter().position(|&vertex| vertex == old).ok_or(HullFailure)?;
        vertices.remove(before);
        if vertices.contains(&into) {
            self.delete_ridge(ridge);
            return Ok(false);
        }
        let after = vertices
            .iter()
            .position(|&vertex| vertex < into)
            .unwrap_or(vertices.len());
        vertices.insert(after, into);
        let entry = &mut self.ridges[ridge];
        entry.simplicial_top = false;
        entry.simplicial_bottom = false;
        if before.abs_diff(after) % 2 == 1 {
            (entry.top, entry.bottom) = (entry.bottom, entry.top);
        }
        Ok(true)
    }

    /// Notes a merge of the vertices of an edge for every other edge that joins the same ones (`qh_maybe_duplicateridge`).
    fn note_same_edges(&mut self, ridge: Id) {
        for facet in [self.ridges[ridge].top, self.ridges[ridge].bottom] {
            if self.facets[facet].simplicial || self.facets[facet].merges == 0 {
                continue;
            }
            for other in self.facets[facet].ridges.clone() {
                if other != ridge && self.ridges[other].vertices == self.ridges[ridge].vertices {
                    let (into, vertex, distance) = self.nearest_pair(&self.ridges[other].vertices);
                    self.vertex_merges.push(VertexMerge {
                        vertex,
                        into,
                        ridges: [ridge, other],
                        distance,
                    });
                }
            }
        }
    }

    /// Performs the noted merges of vertices, after the point was added, until none is left (`qh_all_vertexmerges`).
    pub(crate) fn merge_vertices(&mut self) -> HullResult {
        while !self.vertex_merges.is_empty() {
            self.check_pace()?;
            self.find_vertex_neighbors();
            (self.visible_facets, self.new_facets) = (TAIL, TAIL);
            self.new_vertices = TAIL;
            while let Some(VertexMerge { vertex, into, .. }) = self.next_vertex_merge()? {
                self.rename_everywhere(vertex, into)?;
                self.merge_degenerate()?;
            }
            self.update_neighbors();
            self.test_changed_facets()?;
            self.merge_all(true)?;
            self.partition_visible()?;
            self.delete_visible()?;
            self.reset_lists(true);
        }
        if self.merges.is_empty() && self.degenerates.is_empty() {
            Ok(())
        } else {
            Err(HullFailure)
        }
    }

    /// Removes and returns the merge of the nearest vertices (`qh_next_vertexmerge`).
    fn next_vertex_merge(&mut self) -> HullResult<Option<VertexMerge>> {
        let mut best = (NONE as usize, f64::MAX);
        let mut i = 0;
        while let Some(&merge) = self.vertex_merges.get(i) {
            if self.vertices[merge.vertex].deleted || self.vertices[merge.into].deleted {
                self.vertex_merges.swap_remove(i);
                continue;
            }
            if merge.distance < best.1 {
                best = (i, merge.distance);
            }
            i += 1;
        }
        if best.0 >= self.vertex_merges.len() {
            return Ok(None);
        }
        if best.1 / self.tolerance.one_merge > PINCHED {
            return Err(HullFailure);
        }
        Ok(Some(self.vertex_merges.swap_remove(best.0)))
    }

    /// Replaces a vertex by an adjacent one in all facets (`qh_rename_adjacentvertex`); its point is reassigned.
    fn rename_everywhere(&mut self, old: Id, into: Id) -> HullResult {
        self.merge_count += 1;
        if self.vertices[old].deleted || self.vertices[into].deleted {
            return Ok(());
        }
        if self.vertices[old].neighbors.is_empty() || self.vertices[into].neighbors.is_empty() {
            return Err(HullFailure);
        }
        for facet in self.vertices[old].neighbors.clone() {
            if !self.facets[facet].simplicial {
                continue;
            }
            if self.facets[facet].vertices.contains(&into) {
                self.make_ridges(facet)?; // it becomes degenerate
            } else {
                self.replace_vertex(facet, old, into)?;
                push_unique(&mut self.vertices[into].neighbors, facet);
                self.renew_vertices(&self.facets[facet].vertices.clone())?;
            }
        }
        let ridges = self.all_vertex_ridges(old, true);
        for facet in self.vertices[old].neighbors.clone() {
            if !self.facets[facet].simplicial {
                self.add_vertex(facet, into);
                push_unique(&mut self.vertices[into].neighbors, facet);
                self.renew_vertices(&self.facets[facet].vertices.clone())?;
                if self.new_facets == TAIL {
                    self.renew_facet(facet)?;
                    self.facets[facet].new = true;
                }
            }
        }
        self.rename(old, into, &ridges, None)?;
        if self.vertices[old].deleted && !self.vertices[old].partitioned {
            let place = self.place(old);
            let mut best = (NONE, f64::MIN);
            for &facet in &self.vertices[into].neighbors {
                let dist = self.distance(place, facet);
                if !self.facets[facet].visible && dist > best.1 {
                    best = (facet, dist);
                }
            }
            if best.0 == NONE {
                return Err(HullFailure);
            }
            self.partition_coplanar(self.vertices[old].point, best.0, None, false)?;
            self.vertices[old].partitioned = true;
        }
        Ok(())
    }

    /// Replaces a vertex of a triangle by one with another place in the order (`qh_replacefacetvertex`).
    fn replace_vertex(&mut self, facet: Id, old: Id, into: Id) -> HullResult {
        let entry = &mut self.facets[facet];
        let before = entry
            .vertices
            .iter()
            .position(|&vertex| vertex == old)
            .ok_or(HullFailure)?;
        let mut after = entry
            .vertices
            .iter()
            .position(|&vertex| vertex < into)
            .unwrap_or(entry.vertices.len());
        if before < after {
            after -= 1;
        }
        if before % 2 != after % 2 {
            entry.top = !entry.top;
        }
        if before >= entry.neighbors.len() || after >= entry.neighbors.len() {
            return Err(HullFailure);
        }
        entry.vertices.remove(before);
        entry.vertices.insert(after, into);
        let neighbor = entry.neighbors.remove(before);
        entry.neighbors.insert(after, neighbor);
        Ok(())
    }
}
