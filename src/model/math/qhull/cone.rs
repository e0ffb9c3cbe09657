//! The facets visible from a new point, and the new facets that join the point to their border.

use super::Builder;
use super::parts::{HullFailure, HullResult, Id, NONE, TAIL, drop_swapping, replace};
use super::tolerance::{larger, smaller};

impl Builder<'_> {
    /// Moves the facets that a point sees to the end of the list, in the order in which they are met from the first one on, and
    /// marks those around them that it is nearly on (`qh_findhorizon`).
    pub(super) fn find_horizon(&mut self, point: u32, first: Id) -> HullResult {
        let p = self.point(point);
        self.renew_facet(first)?;
        self.visible_count = 1;
        self.visible_facets = first;
        self.see(first);
        self.visit += 1;
        let mut border = false;
        let mut at = first;
        while Self::listed(at) {
            self.facets[at].visit = self.visit;
            for i in 0..self.facets[at].neighbors.len() {
                let neighbor = self.facets[at].neighbors[i];
                if self.facets[neighbor].visit == self.visit {
                    continue;
                }
                self.facets[neighbor].visit = self.visit;
                let dist = self.distance(p, neighbor);
                if dist > self.tolerance.visible {
                    self.renew_facet(neighbor)?;
                    self.see(neighbor);
                    self.visible_count += 1;
                    continue;
                }
                border = true;
                let coplanar = dist >= -self.tolerance.visible;
                self.facets[neighbor].coplanar_horizon = coplanar;
                if coplanar && dist > 0.0 {
                    self.max_outside = larger(self.max_outside, dist);
                    let entry = &mut self.facets[neighbor];
                    entry.max_outside = larger(entry.max_outside, dist);
                } else if coplanar {
                    self.min_vertex = smaller(self.min_vertex, dist);
                }
            }
            at = self.facets[at].next;
        }
        if border { Ok(()) } else { Err(HullFailure) }
    }

    fn see(&mut self, facet: Id) {
        self.facets[facet].visible = true;
        self.facets[facet].replace = NONE;
    }

    /// Makes the facets of a new point (`qh_buildcone`): their edges, their planes, and which facets vertices belong to.
    pub(super) fn make_cone(&mut self, point: u32) -> HullResult {
        self.first_new = self.facets.len() as Id;
        self.make_new_facets(point)?;
        self.match_new_facets()?;
        for facet in self.facets_from(self.new_facets) {
            // those in the plane of their horizon get that one's
            if !self.facets[facet].merge_horizon {
                self.set_plane(facet)?;
            }
        }
        self.update_cone_neighbors();
        Ok(())
    }

    /// Makes a facet over each edge of the border (`qh_makenewfacets`).
    fn make_new_facets(&mut self, point: u32) -> HullResult {
        self.new_facets = TAIL;
        self.new_vertices = TAIL;
        let apex = self.new_vertex(point);
        self.append_vertex(apex);
        self.visit += 1;
        // which new facet gets the points of a removed one first is left over from one removed facet to the next
        let (mut heir, mut heir_of_polygon) = (NONE, NONE);
        for visible in self.visible() {
            for i in 0..self.facets[visible].neighbors.len() {
                let neighbor = self.facets[visible].neighbors[i];
                self.facets[neighbor].seen = false;
            }
            if self.facets[visible].ridged {
                self.facets[visible].visit = self.visit;
                heir_of_polygon = self.cone_over_ridges(visible, apex)?;
            }
            if self.facets[visible].simplicial {
                heir = self.cone_over_triangle(visible, apex)?;
            }
            if heir_of_polygon != NONE {
                heir = heir_of_polygon;
            }
            if heir != NONE {
                self.facets[visible].replace = heir;
            }
            self.facets[visible].ridges.clear();
            self.facets[visible].neighbors.clear();
        }
        Ok(())
    }

    /// Makes a facet (`qh_makenewfacet`); its vertices go to the end of their list.
    fn make_new_facet(&mut self, vertices: Vec<Id>, top: bool, horizon: Id) -> HullResult<Id> {
        self.renew_vertices(&vertices)?;
        let facet = self.new_facet(vertices, top);
        self.facets[facet].neighbors.push(horizon);
        self.append_facet(facet);
        Ok(facet)
    }

    /// Makes facets over the edges of a polygon, or of a triangle that it shares with polygons (`qh_makenew_nonsimplicial`).
    /// Returns the last one.
    pub(super) fn cone_over_ridges(&mut self, visible: Id, apex: Id) -> HullResult<Id> {
        let mut last = NONE;
        for ridge in self.facets[visible].ridges.clone() {
            let neighbor = self.ridges[ridge].other(visible);
            if !self.facets[neighbor].visible {
                let top = self.ridges[ridge].top == visible;
                let mut vertices = vec![apex];
                vertices.extend(&self.ridges[ridge].vertices);
                last = self.make_new_facet(vertices, top, neighbor)?;
                if self.facets[neighbor].coplanar_horizon {
                    self.join_cycle(last, neighbor);
                }
                if self.facets[neighbor].seen {
                    if self.facets[neighbor].simplicial {
                        return Err(HullFailure);
                    }
                    self.facets[neighbor].neighbors.push(last);
                } else {
                    replace(&mut self.facets[neighbor].neighbors, visible, last)?;
                }
                if self.facets[neighbor].simplicial {
                    drop_swapping(&mut self.facets[neighbor].ridges, ridge);
                } else {
                    self.add_ridge(last, ridge);
                    let entry = &mut self.ridges[ridge];
                    if top {
                        entry.top = last;
                        entry.simplicial_top = true;
                    } else {
                        entry.bottom = last;
                        entry.simplicial_bottom = true;
                    }
                }
            }
            self.facets[neighbor].seen = true;
        }
        Ok(last)
    }

    /// Adds a new facet to the ring of facets that are merged into the same horizon.
    fn join_cycle(&mut self, facet: Id, horizon: Id) {
        self.facets[facet].merge_horizon = true;
        if self.facets[horizon].seen {
            let last = self.facets[horizon].cycle;
            self.facets[facet].cycle = self.facets[last].cycle;
            self.facets[last].cycle = facet;
        } else {
            self.facets[facet].cycle = facet;
            self.facets[horizon].cycle = facet;
        }
    }

    /// Adds an edge to a facet.
    pub(super) fn add_ridge(&mut self, facet: Id, ridge: Id) {
        self.facets[facet].ridges.push(ridge);
        self.facets[facet].ridged = true;
    }

    /// Makes facets over the edges that a triangle shares with triangles (`qh_makenew_simplicial`). Returns the last one.
    fn cone_over_triangle(&mut self, visible: Id, apex: Id) -> HullResult<Id> {
        let mut last = NONE;
        for neighbor in self.facets[visible].neighbors.clone() {
            if self.facets[neighbor].seen || self.facets[neighbor].visible {
                continue;
            }
            let place = |of: Id, what: Id| {
                let place = self.facets[of].neighbors.iter().position(|&other| other == what);
                place.filter(|&place| place < 3).ok_or(HullFailure)
            };
            let beyond = place(neighbor, visible)?;
            place(visible, neighbor)?;
            let mut vertices = self.facets[neighbor].vertices.clone();
            if beyond >= vertices.len() {
                return Err(HullFailure);
            }
            vertices.remove(beyond);
            vertices.insert(0, apex);
            let odd = beyond % 2 == 1;
            let top = if self.facets[neighbor].top { odd } else { !odd };
            last = self.make_new_facet(vertices, top, neighbor)?;
            if self.facets[neighbor].coplanar_horizon {
                self.facets[last].cycle = last;
                self.facets[last].merge_horizon = true;
            }
            self.facets[neighbor].neighbors[beyond] = last;
        }
        Ok(last)
    }
}
