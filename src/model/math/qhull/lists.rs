//! The lists of facets and of vertices. Their order determines that of the hull: new and changed ones go to the end.

use super::Builder;
use super::parts::{Facet, HullFailure, HullResult, Id, NONE, TAIL, Vertex};

impl Builder<'_> {
    /// Returns whether a place in a list is a facet or vertex, and not its end.
    #[inline(always)]
    pub(super) fn listed(id: Id) -> bool {
        id != NONE && id != TAIL
    }

    /// Returns the current facets of a list, starting with one (`FORALLfacet_`).
    pub(super) fn facets_from(&self, first: Id) -> Vec<Id> {
        let mut all = Vec::new();
        let mut facet = first;
        while Self::listed(facet) && all.len() <= self.facets.len() {
            all.push(facet);
            facet = self.facets[facet].next;
        }
        all
    }

    /// Creates a facet (`qh_newfacet`).
    pub(super) fn new_facet(&mut self, vertices: Vec<Id>, top: bool) -> Id {
        self.facets.push(Facet {
            vertices,
            max_outside: self.tolerance.dist,
            replace: NONE,
            cycle: NONE,
            simplicial: true,
            new: true,
            top,
            ..Facet::default()
        })
    }

    /// Creates a vertex (`qh_newvertex`).
    pub(super) fn new_vertex(&mut self, point: u32) -> Id {
        self.vertices.push(Vertex {
            point,
            ..Vertex::default()
        })
    }

    /// Appends a facet. Marks at the end of the list move to it, because it is the first facet after them.
    pub(super) fn append_facet(&mut self, facet: Id) {
        if self.new_facets == TAIL {
            self.new_facets = facet;
            if self.visible_facets == TAIL {
                self.visible_facets = facet;
            }
        }
        if self.next_facet == TAIL {
            self.next_facet = facet;
        }
        let before = self.facets[TAIL].previous;
        self.facets[facet].previous = before;
        self.facets[facet].next = TAIL;
        if before == NONE {
            self.first_facet = facet;
        } else {
            self.facets[before].next = facet;
        }
        self.facets[TAIL].previous = facet;
        self.facet_count += 1;
    }

    /// Removes a facet from the list.
    pub(super) fn remove_facet(&mut self, facet: Id) -> HullResult {
        if !Self::listed(facet) || self.facet_count == 0 {
            return Err(HullFailure);
        }
        let (previous, next) = (self.facets[facet].previous, self.facets[facet].next);
        for mark in [&mut self.new_facets, &mut self.next_facet, &mut self.visible_facets] {
            if *mark == facet {
                *mark = next;
            }
        }
        self.facets[next].previous = previous;
        if previous == NONE {
            self.first_facet = next;
        } else {
            self.facets[previous].next = next;
        }
        self.facet_count -= 1;
        Ok(())
    }

    /// Inserts a facet before another.
    fn insert_facet(&mut self, facet: Id, before: Id) {
        let previous = self.facets[before].previous;
        self.facets[facet].previous = previous;
        if previous != NONE {
            self.facets[previous].next = facet;
        }
        self.facets[before].previous = facet;
        self.facets[facet].next = before;
        if self.first_facet == before {
            self.first_facet = facet;
        }
        if self.next_facet == before {
            self.next_facet = facet;
        }
        self.facet_count += 1;
    }

    /// Moves a facet to the end.
    pub(super) fn renew_facet(&mut self, facet: Id) -> HullResult {
        self.remove_facet(facet)?;
        self.append_facet(facet);
        Ok(())
    }

    /// Moves a facet before the one that is processed next.
    pub(super) fn work_on_next(&mut self, facet: Id) -> HullResult {
        self.remove_facet(facet)?;
        self.insert_facet(facet, self.next_facet);
        self.next_facet = facet;
        Ok(())
    }

    /// Marks a facet for removal and notes its replacement. The facet moves before the others to be removed (`qh_willdelete`).
    pub(super) fn will_delete(&mut self, facet: Id, replace: Id) -> HullResult {
        if self.visible_facets == NONE && self.new_facets != NONE {
            return Err(HullFailure);
        }
        self.remove_facet(facet)?;
        if self.visible_facets == NONE {
            self.visible_facets = TAIL;
        }
        self.insert_facet(facet, self.visible_facets);
        self.visible_facets = facet;
        self.visible_count += 1;
        let facet = &mut self.facets[facet];
        facet.visible = true;
        facet.replace = replace;
        facet.ridges.clear();
        facet.neighbors.clear();
        Ok(())
    }

    /// Removes a facet for good.
    pub(super) fn delete_facet(&mut self, facet: Id) -> HullResult {
        self.remove_facet(facet)?;
        let facet = &mut self.facets[facet];
        for set in [
            &mut facet.vertices,
            &mut facet.neighbors,
            &mut facet.ridges,
            &mut facet.outside,
            &mut facet.coplanar,
        ] {
            *set = Vec::new();
        }
        Ok(())
    }

    /// Appends a vertex.
    pub(super) fn append_vertex(&mut self, vertex: Id) {
        if self.new_vertices == TAIL {
            self.new_vertices = vertex;
        }
        let before = self.vertices[TAIL].previous;
        let entry = &mut self.vertices[vertex];
        entry.new = true;
        entry.previous = before;
        entry.next = TAIL;
        if before == NONE {
            self.first_vertex = vertex;
        } else {
            self.vertices[before].next = vertex;
        }
        self.vertices[TAIL].previous = vertex;
        self.vertex_count += 1;
    }

    /// Removes a vertex from the list.
    pub(super) fn remove_vertex(&mut self, vertex: Id) -> HullResult {
        if !Self::listed(vertex) || self.vertex_count == 0 {
            return Err(HullFailure);
        }
        let (previous, next) = (self.vertices[vertex].previous, self.vertices[vertex].next);
        if self.new_vertices == vertex {
            self.new_vertices = next;
        }
        self.vertices[next].previous = previous;
        if previous == NONE {
            self.first_vertex = next;
        } else {
            self.vertices[previous].next = next;
        }
        self.vertex_count -= 1;
        Ok(())
    }

    /// Moves vertices that are not yet among the new ones to the end (`qh_newvertices`).
    pub(super) fn renew_vertices(&mut self, vertices: &[Id]) -> HullResult {
        for &vertex in vertices {
            if !self.vertices[vertex].new {
                self.remove_vertex(vertex)?;
                self.append_vertex(vertex);
            }
        }
        Ok(())
    }

    /// Returns the current vertices of a list, starting with one.
    pub(super) fn vertices_from(&self, first: Id) -> Vec<Id> {
        let mut all = Vec::new();
        let mut vertex = first;
        while Self::listed(vertex) && all.len() <= self.vertices.len() {
            all.push(vertex);
            vertex = self.vertices[vertex].next;
        }
        all
    }

    /// Returns the facets that are currently to be removed.
    pub(super) fn visible(&self) -> Vec<Id> {
        let mut all = Vec::new();
        let mut facet = self.visible_facets;
        while Self::listed(facet) && self.facets[facet].visible && all.len() <= self.facets.len() {
            all.push(facet);
            facet = self.facets[facet].next;
        }
        all
    }

    /// Clears the list of new facets (`qh_resetlists`) and, if requested, that of facets to be removed.
    pub(super) fn reset_lists(&mut self, visible_too: bool) {
        for vertex in self.vertices_from(self.new_vertices) {
            self.vertices[vertex].new = false;
        }
        self.new_vertices = NONE;
        self.first_new = NONE;
        for facet in self.facets_from(self.new_facets) {
            self.facets[facet].new = false;
            self.facets[facet].dup_ridge = false;
        }
        self.new_facets = NONE;
        if visible_too {
            for facet in self.visible() {
                self.facets[facet].replace = NONE;
                self.facets[facet].visible = false;
            }
            self.visible_count = 0;
        }
        self.visible_facets = NONE;
    }
}
