//! New facets that are joined to each other at the edges to their apex.

use std::collections::BTreeMap;

use super::Builder;
use super::parts::{FORCED, HullFailure, HullResult, Id, NONE, SHARED};

/// Distance up to which two facets of a shared edge are joined before others, in greatest widths (`qh_WIDEdupridge`).
pub(super) const WIDE: f64 = 50.0;

/// New facets by the other vertex of an edge to the apex.
type Edges = BTreeMap<Id, Vec<Id>>;

/// Two facets that may be joined, with the indices of their neighbours.
type FacetPair = (Id, usize, Id, usize);

/// The best pair of facets found so far at a shared edge.
#[derive(Default)]
struct FacetMatch {
    /// The nearest facets, if they are not far from each other, and their distance.
    good: Option<(FacetPair, f64)>,
    /// Otherwise the farthest facets.
    far: Option<(FacetPair, f64)>,
    /// Two facets have all vertices in common.
    duplicate: bool,
}

impl Builder<'_> {
    /// Joins new facets whose edges have the same vertices (`qh_matchnewfacets`).
    pub(super) fn match_new_facets(&mut self) -> HullResult {
        let all = self.facets_from(self.new_facets);
        for &facet in &all {
            self.facets[facet].neighbors.resize(1, NONE);
            self.facets[facet].neighbors.resize(3, NONE);
        }
        let mut edges = Edges::new();
        let mut open: isize = 0;
        for &facet in &all {
            for skip in [1, 2] {
                open += self.match_edge(&mut edges, facet, skip)?;
            }
        }
        if open == 0 {
            return Ok(());
        }
        for &facet in &all {
            for skip in 0..3 {
                if self.facets[facet].dup_ridge && self.facets[facet].neighbors.get(skip) == Some(&SHARED) {
                    open -= self.match_shared(&edges, facet, skip)?;
                }
            }
        }
        if open == 0 { Ok(()) } else { Err(HullFailure) }
    }

    /// The vertex of an edge besides the apex, for the place of the neighbour beyond it.
    fn edge_vertex(&self, facet: Id, skip: usize) -> HullResult<Id> {
        self.facets[facet].vertices.get(3 - skip).copied().ok_or(HullFailure)
    }

    /// Returns the index of the neighbour of a facet beyond the edge to a vertex.
    fn edge_place(&self, facet: Id, vertex: Id) -> usize {
        if self.facets[facet].vertices.get(1) == Some(&vertex) {
            2
        } else {
            1
        }
    }

    /// Returns whether two facets wind consistently at an edge.
    fn consistent(&self, (a, skip_a): (Id, usize), (b, skip_b): (Id, usize)) -> bool {
        let same = skip_a % 2 == skip_b % 2;
        same == (self.facets[a].top != self.facets[b].top)
    }

    /// Joins a facet at an edge to the one that waits there, or makes it wait; a third one makes the edge shared
    /// (`qh_matchneighbor`). Returns the change of the number of open edges.
    fn match_edge(&mut self, edges: &mut Edges, facet: Id, skip: usize) -> HullResult<isize> {
        let waiting = edges.entry(self.edge_vertex(facet, skip)?).or_default();
        let Some(&first) = waiting.iter().find(|&&other| other != facet) else {
            if !waiting.contains(&facet) {
                waiting.push(facet);
            }
            return Ok(1);
        };
        let place = self.edge_place(first, self.edge_vertex(facet, skip)?);
        let partner = self.facets[first].neighbors[place];
        if self.consistent((facet, skip), (first, place)) && partner == NONE {
            self.facets[first].neighbors[place] = facet;
            self.facets[facet].neighbors[skip] = first;
            return Ok(-1);
        }
        let mut open = 1;
        self.share(facet, skip);
        waiting.push(facet);
        if partner != SHARED {
            self.share(first, place);
            if partner != NONE {
                let place = self.facets[partner].neighbors.iter().position(|&other| other == first);
                self.share(partner, place.ok_or(HullFailure)?);
                if !waiting.contains(&partner) {
                    waiting.push(partner);
                }
                open += 2;
            }
        }
        Ok(open)
    }

    fn share(&mut self, facet: Id, place: usize) {
        self.facets[facet].neighbors[place] = SHARED;
        self.facets[facet].dup_ridge = true;
    }

    /// Joins the facets of a shared edge in pairs (`qh_matchdupridge`): first those that are nearest to each other, or else those
    /// that are farthest; the others are to be merged. Returns the number of open edges that this closes.
    fn match_shared(&mut self, edges: &Edges, at: Id, skip: usize) -> HullResult<isize> {
        let vertex = self.edge_vertex(at, skip)?;
        let waiting = edges.get(&vertex).ok_or(HullFailure)?;
        let choice = self.choose_pair(waiting, vertex, at)?;
        let (a, place_a, b, place_b) = choice.good.or(choice.far).ok_or(HullFailure)?.0;
        self.facets[a].neighbors[place_a] = b;
        self.facets[b].neighbors[place_b] = a;
        let mut closed = 2;
        let mut forced = choice.good.map(|(pair, _)| (pair.2, pair.3));
        self.visit += 1;
        let mut facet = at;
        while facet != NONE {
            let mut next = NONE;
            let (skip, others) = self.beside(facet, waiting, vertex);
            for (other, place) in others {
                if self.facets[other].neighbors[place] != SHARED {
                    continue;
                }
                if !self.consistent((facet, skip), (other, place)) {
                    next = other;
                } else if self.facets[facet].neighbors[skip] == SHARED {
                    self.facets[other].neighbors[place] = facet;
                    self.facets[facet].neighbors[skip] = if self.facets[facet].tricoplanar {
                        other
                    } else if let Some((good, place)) = forced.take() {
                        self.facets[good].neighbors[place] = FORCED;
                        other
                    } else {
                        FORCED
                    };
                    closed += 2;
                }
            }
            if self.facets[facet].neighbors[skip] == SHARED {
                return Err(HullFailure);
            }
            facet = next;
        }
        Ok(closed)
    }

    /// Marks a facet at a shared edge as seen. Returns the place of the neighbour beyond the edge, and the unseen facets there with their places.
    fn beside(&mut self, facet: Id, waiting: &[Id], vertex: Id) -> (usize, Vec<(Id, usize)>) {
        self.facets[facet].visit = self.visit;
        let unseen = |other: &Id| self.facets[*other].dup_ridge && self.facets[*other].visit != self.visit;
        let others = waiting.iter().copied().filter(unseen);
        let others = others.map(|other| (other, self.edge_place(other, vertex))).collect();
        (self.edge_place(facet, vertex), others)
    }

    /// Searches the consistent pairs at a shared edge.
    fn choose_pair(&mut self, waiting: &[Id], vertex: Id, at: Id) -> HullResult<FacetMatch> {
        let mut choice = FacetMatch::default();
        self.visit += 1;
        let mut facet = at;
        while facet != NONE {
            let mut next = NONE;
            let (skip, others) = self.beside(facet, waiting, vertex);
            for (other, place) in others {
                choice.duplicate |= self.facets[facet].vertices.get(skip) == self.facets[other].vertices.get(place);
                if self.facets[other].neighbors[place] != SHARED {
                    return Err(HullFailure);
                }
                if !self.consistent((facet, skip), (other, place)) {
                    next = other;
                } else if self.facets[facet].neighbors[skip] == SHARED {
                    self.weigh_pair(&mut choice, (other, place, facet, skip))?;
                    if choice.duplicate {
                        break;
                    }
                }
            }
            facet = next;
        }
        Ok(choice)
    }

    /// Keeps a pair if it is better than the best one so far.
    fn weigh_pair(&mut self, choice: &mut FacetMatch, pair: FacetPair) -> HullResult {
        let (a, place_a, b, place_b) = pair;
        for facet in [a, b] {
            if self.facets[facet].normal.is_none() {
                self.set_plane(facet)?;
            }
        }
        let turned = (b, place_b, a, place_a);
        let (dist, back) = (self.spread(a, b)[0], self.spread(b, a)[0]);
        let nearest = if dist > back { back } else { dist };
        let near = WIDE * (self.tolerance.one_merge + self.tolerance.dist);
        let [flipped_a, flipped_b] = [a, b].map(|facet| self.facets[facet].flipped);
        let kept = choice
            .good
            .map(|((first, ..), dist)| (self.facets[first].flipped, dist));
        let better_flipped = |dist: f64| kept.is_none_or(|(flipped, least)| !flipped || dist < least);
        let better = |dist: f64| kept.is_none_or(|(flipped, least)| !flipped && dist < least);
        if choice.duplicate {
            choice.good = None;
            choice.far = Some((pair, nearest));
        } else if flipped_a && !flipped_b && dist < near {
            if better_flipped(dist) {
                choice.good = Some((pair, dist));
            }
        } else if flipped_b && !flipped_a && back < near {
            if better_flipped(back) {
                choice.good = Some((turned, back));
            }
        } else if dist < near && (!flipped_b || flipped_a) {
            if better(dist) {
                choice.good = Some((pair, dist));
            }
        } else if back < near && (!flipped_a || flipped_b) {
            if better(back) {
                choice.good = Some((turned, back));
            }
        } else if choice.good.is_none() {
            let apart = if !flipped_b || flipped_a { nearest } else { dist };
            if choice.far.is_none_or(|(_, most)| apart > most) {
                choice.far = Some((pair, apart));
            }
        }
        Ok(())
    }
}
