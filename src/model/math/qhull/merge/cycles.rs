//! New facets in the plane of their horizon, which are merged into it together.

use super::{FEW_VERTICES, MOST_MERGES};
use crate::math::qhull::Builder;
use crate::math::qhull::parts::{
    HullFailure, HullResult, Id, MergeReason, NONE, Ridge, TAIL, drop_sorted, drop_swapping, replace,
};

impl Builder<'_> {
    /// Merges new facets without their own plane into their horizon (`qh_mergecycle_all`); returns whether there were any.
    pub(super) fn merge_cycles(&mut self) -> HullResult<bool> {
        let mut any = false;
        let mut facet = self.new_facets;
        while Self::listed(facet) {
            let mut next = self.facets[facet].next;
            if self.facets[facet].normal.is_none() {
                if !self.facets[facet].merge_horizon {
                    return Err(HullFailure);
                }
                let horizon = *self.facets[facet].neighbors.first().ok_or(HullFailure)?;
                self.facets[horizon].cycle = NONE;
                if self.facets[facet].cycle == facet {
                    self.merge_alone(facet, horizon)?;
                } else {
                    let ring = self.ring(facet)?;
                    while Self::listed(next) && self.facets[next].cycle_done {
                        next = self.facets[next].next;
                    }
                    self.merge_ring(&ring, horizon)?;
                    let merges = usize::from(self.facets[horizon].merges) + ring.len();
                    self.facets[horizon].merges = merges.min(MOST_MERGES) as u16;
                }
                any = true;
            }
            facet = next;
        }
        if any {
            for facet in self.facets_from(self.new_facets) {
                if self.facets[facet].coplanar_horizon {
                    self.test_redundant_neighbors(facet)?;
                    self.facets[facet].coplanar_horizon = false;
                }
            }
            self.merge_degenerate()?;
        }
        Ok(any)
    }

    /// Merges a new facet into its horizon if no other new facet has that horizon.
    fn merge_alone(&mut self, facet: Id, horizon: Id) -> HullResult {
        for i in 1..self.facets[facet].vertices.len() {
            let vertex = self.facets[facet].vertices[i];
            self.vertices[vertex].lost_ridge = true;
        }
        self.merge_facet(facet, horizon, MergeReason::Horizon, None)
    }

    /// Returns the new facets of a ring, from the one after `first` on to itself, without those that got a plane since.
    fn ring(&mut self, first: Id) -> HullResult<Vec<Id>> {
        let mut ring = Vec::new();
        let mut at = first;
        loop {
            at = self.facets[at].cycle;
            if at == NONE || at == TAIL || self.facets[at].cycle_done || self.facets[at].visible {
                return Err(HullFailure);
            }
            self.facets[at].cycle_done = true;
            if self.facets[at].normal.is_none() {
                ring.push(at);
            }
            if at == first {
                return Ok(ring);
            }
        }
    }

    /// Merges a ring of new facets into their horizon (`qh_mergecycle`).
    fn merge_ring(&mut self, ring: &[Id], horizon: Id) -> HullResult {
        self.merge_count += 1;
        self.find_vertex_neighbors();
        let first = *ring.last().ok_or(HullFailure)?;
        let apex = *self.facets[first].vertices.first().ok_or(HullFailure)?;
        self.make_ridges(horizon)?;
        let mark = self.ring_neighbors(ring, horizon)?;
        self.ring_ridges(ring, horizon, mark)?;
        self.ring_vertices(ring, horizon, mark, apex);
        if self.facets[horizon].vertices.first() != Some(&apex) {
            self.facets[horizon].vertices.insert(0, apex);
        }
        if !self.facets[horizon].new {
            self.renew_vertices(&self.facets[horizon].vertices.clone())?;
        }
        self.renew_facet(horizon)?;
        let entry = &mut self.facets[horizon];
        entry.new = true;
        entry.simplicial = false;
        entry.new_merge = true;
        for &same in ring {
            self.will_delete(same, horizon)?;
        }
        let entry = &mut self.facets[horizon];
        if entry.vertices.len() <= FEW_VERTICES {
            entry.center = None;
        }
        Ok(())
    }

    /// Transfers the neighbours of the ring to the horizon (`qh_mergecycle_neighbors`). Returns the mark of the ring's facets;
    /// the next mark is that of the horizon's neighbours.
    fn ring_neighbors(&mut self, ring: &[Id], horizon: Id) -> HullResult<u32> {
        self.visit += 1;
        let mark = self.visit;
        for &same in ring {
            if self.facets[same].visit == mark || self.facets[same].visible {
                return Err(HullFailure);
            }
            self.facets[same].visit = mark;
        }
        self.visit += 1;
        let known = self.visit;
        self.facets[horizon].visit = known;
        let mut neighbors = std::mem::take(&mut self.facets[horizon].neighbors);
        neighbors.retain(|&neighbor| self.facets[neighbor].visit != mark);
        for &neighbor in &neighbors {
            self.facets[neighbor].visit = known;
        }
        self.facets[horizon].neighbors = neighbors;
        for &same in ring {
            for neighbor in self.facets[same].neighbors.clone() {
                let visit = self.facets[neighbor].visit;
                if visit == mark {
                    continue;
                }
                let fresh = visit != known;
                if self.facets[neighbor].simplicial && fresh {
                    self.facets[horizon].neighbors.push(neighbor);
                    replace(&mut self.facets[neighbor].neighbors, same, horizon)?;
                    self.facets[neighbor].visit = known;
                    self.hand_first_ridge(neighbor, same, horizon);
                } else if self.facets[neighbor].simplicial {
                    self.make_ridges(neighbor)?;
                    drop_swapping(&mut self.facets[neighbor].neighbors, same);
                } else {
                    drop_swapping(&mut self.facets[neighbor].neighbors, same);
                    if fresh {
                        self.facets[neighbor].neighbors.push(horizon);
                        self.facets[horizon].neighbors.push(neighbor);
                        self.facets[neighbor].visit = known;
                    }
                }
            }
        }
        Ok(mark)
    }

    /// Makes the first edge between two facets one of the horizon.
    fn hand_first_ridge(&mut self, neighbor: Id, same: Id, horizon: Id) {
        for i in 0..self.facets[neighbor].ridges.len() {
            let entry = &mut self.ridges[self.facets[neighbor].ridges[i]];
            if entry.top == same {
                entry.top = horizon;
                return;
            } else if entry.bottom == same {
                entry.bottom = horizon;
                return;
            }
        }
    }

    /// Transfers the edges of the ring to the horizon (`qh_mergecycle_ridges`).
    fn ring_ridges(&mut self, ring: &[Id], horizon: Id, mark: u32) -> HullResult {
        let mut ridges = std::mem::take(&mut self.facets[horizon].ridges);
        ridges.retain(|&ridge| self.facets[self.ridges[ridge].other(horizon)].visit != mark);
        self.facets[horizon].ridges = ridges;
        for &same in ring {
            for ridge in std::mem::take(&mut self.facets[same].ridges) {
                let entry = &mut self.ridges[ridge];
                let neighbor = if entry.top == same {
                    entry.top = horizon;
                    entry.bottom
                } else if entry.bottom == same {
                    entry.bottom = horizon;
                    entry.top
                } else if entry.top == horizon || entry.bottom == horizon {
                    self.add_ridge(horizon, ridge);
                    continue;
                } else {
                    return Err(HullFailure);
                };
                if neighbor == horizon {
                    continue;
                }
                if self.facets[neighbor].visit == mark {
                    drop_swapping(&mut self.facets[neighbor].ridges, ridge);
                } else {
                    self.add_ridge(horizon, ridge);
                }
            }
            if self.facets[same].simplicial {
                self.new_ring_ridges(same, horizon, mark)?;
            }
        }
        Ok(())
    }

    /// Makes entries for the edges between a triangle of the ring and triangles.
    fn new_ring_ridges(&mut self, same: Id, horizon: Id, mark: u32) -> HullResult {
        for i in 0..self.facets[same].neighbors.len() {
            let neighbor = self.facets[same].neighbors[i];
            if self.facets[neighbor].visit == mark || !self.facets[neighbor].simplicial {
                continue;
            }
            let mut vertices = self.facets[same].vertices.clone();
            if i >= vertices.len() {
                return Err(HullFailure);
            }
            vertices.remove(i);
            let top = self.facets[same].top != (i % 2 == 1);
            let ridge = self.ridges.push(Ridge {
                vertices,
                top: if top { horizon } else { neighbor },
                bottom: if top { neighbor } else { horizon },
                simplicial_top: !top,
                simplicial_bottom: top,
                ..Ridge::default()
            });
            self.add_ridge(horizon, ridge);
            self.add_ridge(neighbor, ridge);
        }
        Ok(())
    }

    /// Replaces the ring's facets by the horizon in the vertices of the ring (`qh_mergecycle_vneighbors`).
    fn ring_vertices(&mut self, ring: &[Id], horizon: Id, mark: u32, apex: Id) {
        self.facets[horizon].visit = mark;
        self.vertex_visit += 1;
        self.vertices[apex].visit = self.vertex_visit;
        let mut vertices = Vec::new();
        for &same in ring {
            if self.facets[same].merge_ridge {
                continue;
            }
            for i in 0..self.facets[same].vertices.len() {
                let vertex = self.facets[same].vertices[i];
                if self.vertices[vertex].visit != self.vertex_visit {
                    self.vertices[vertex].visit = self.vertex_visit;
                    self.vertices[vertex].seen = false;
                    vertices.push(vertex);
                }
            }
        }
        vertices.push(apex);
        for vertex in vertices {
            let mut neighbors = std::mem::take(&mut self.vertices[vertex].neighbors);
            neighbors.retain(|&facet| self.facets[facet].visit != mark);
            neighbors.push(horizon);
            let gone = neighbors.len() < 2;
            let entry = &mut self.vertices[vertex];
            entry.neighbors = neighbors;
            entry.lost_ridge = true;
            if gone {
                drop_sorted(&mut self.facets[horizon].vertices, vertex);
                self.delete_vertex(vertex);
            }
        }
    }
}
