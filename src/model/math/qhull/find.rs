//! The facet above which a point is highest.

use super::Builder;
use super::parts::{HullFailure, HullResult, Id, NONE};
use super::tolerance::larger;

/// A facet, the distance of a point from its plane, and whether the point is outside.
#[derive(Clone, Copy)]
pub(super) struct FacetDistance {
    pub(super) facet: Id,
    pub(super) dist: f64,
    pub(super) outside: bool,
}

/// A distance below all others.
const BELOW_ALL: f64 = -f64::MAX / 2.0;

impl Builder<'_> {
    /// Returns whether there were so many merges that new facets are searched one by one, with doubled tolerances (`qh_USEfindbestnew`).
    pub(super) fn merged_much(&self) -> bool {
        self.merge_count > 50
    }

    fn doubled(&self, distance: f64) -> f64 {
        if self.merged_much() { 2.0 * distance } else { distance }
    }

    /// Walks from a facet to neighbours that the point is higher above (`qh_findbest`). Unless `best` is set, the walk ends at the
    /// first facet that the point is outside of. If `only_new` is set, it stays among new facets.
    pub(super) fn find_best(&mut self, point: u32, start: Id, best: bool, only_new: bool) -> HullResult<FacetDistance> {
        let (highest, last) = self.climb(point, start, best, only_new);
        if highest.outside {
            return Ok(highest);
        }
        let (mut found, mut height) = (highest.facet, highest.dist);
        let mut horizon = true;
        if only_new {
            if found == NONE {
                FacetDistance {
                    facet: found,
                    dist: height,
                    ..
                } = self.find_best_of_new(point, self.new_facets, best)?;
                horizon = false;
            } else if !self.not_sharp && height < -self.tolerance.dist {
                // the walk may end at a sharp edge before it is at the best
                if self.sharp_new_facets() {
                    FacetDistance {
                        facet: found,
                        dist: height,
                        ..
                    } = self.find_best_of_new(point, found, best)?;
                    horizon = false;
                    self.find_best_new = true;
                } else {
                    self.not_sharp = true;
                }
            }
        }
        if found == NONE {
            // only flipped facets were seen: any that is not
            (found, height) = self.find_lower(point, last)?;
        }
        if horizon {
            (found, height) = self.find_beyond(point, found, height);
        }
        Ok(FacetDistance {
            facet: found,
            dist: height,
            outside: height >= self.tolerance.outside,
        })
    }

    /// Goes from facet to facet as long as the point is higher above one of the neighbours. Returns the highest that is not flipped,
    /// which counts as outside only if that ended the walk, and the facet where the walk ended.
    fn climb(&mut self, point: u32, start: Id, best: bool, only_new: bool) -> (FacetDistance, Id) {
        let p = self.point(point);
        let enough = if best { None } else { Some(self.tolerance.outside) };
        let stand = |facet: Id, dist: f64| FacetDistance {
            facet,
            dist,
            outside: enough.is_some_and(|enough| dist >= enough),
        };
        self.visit += 1;
        let visit = self.visit;
        let mut highest = stand(NONE, BELOW_ALL);
        if !self.facets[start].flipped {
            highest = stand(start, self.distance(p, start));
            if highest.outside {
                return (highest, start);
            }
        }
        self.facets[start].visit = visit;
        let mut at = start;
        'walk: while !highest.outside {
            for i in 0..self.facets[at].neighbors.len() {
                let neighbor = self.facets[at].neighbors[i];
                if (only_new && !self.facets[neighbor].new) || self.facets[neighbor].visit == visit {
                    continue;
                }
                self.facets[neighbor].visit = visit;
                if self.facets[neighbor].flipped {
                    continue;
                }
                let dist = self.distance(p, neighbor);
                if dist > highest.dist {
                    highest = stand(neighbor, dist);
                    at = neighbor;
                    continue 'walk;
                }
            }
            break;
        }
        (highest, at)
    }

    /// Searches all new facets, starting with one (`qh_findbestnew`), then beyond the best.
    pub(super) fn find_best_of_new(&mut self, point: u32, start: Id, best: bool) -> HullResult<FacetDistance> {
        if !Self::listed(start) {
            return Err(HullFailure);
        }
        let p = self.point(point);
        let clearly = self.doubled(larger(2.0 * self.tolerance.outside, self.max_outside));
        let (mut found, mut height) = (NONE, BELOW_ALL);
        for (first, until) in [(start, NONE), (self.new_facets, start)] {
            let mut facet = first;
            while Self::listed(facet) && facet != until {
                if !self.facets[facet].flipped {
                    let dist = self.distance(p, facet);
                    if dist > height {
                        (found, height) = (facet, dist);
                        if !best && dist >= clearly {
                            return Ok(FacetDistance {
                                facet,
                                dist,
                                outside: true,
                            });
                        }
                    }
                }
                facet = self.facets[facet].next;
            }
        }
        let from = if found == NONE { start } else { found };
        let (facet, dist) = self.find_beyond(point, from, height);
        Ok(FacetDistance {
            facet,
            dist,
            outside: dist >= self.tolerance.outside,
        })
    }

    /// Searches the facets around a facet that the point is nearly as high above (`qh_findbesthorizon`).
    fn find_beyond(&mut self, point: u32, start: Id, height: f64) -> (Id, f64) {
        let p = self.point(point);
        let (mut found, mut height) = (start, height);
        let slack = self.doubled(self.max_outside + 2.0 * self.tolerance.dist + self.tolerance.visible);
        let mut least = height - slack;
        self.visit += 1;
        let visit = self.visit;
        self.facets[start].visit = visit;
        let mut stack: Vec<Id> = Vec::new();
        let mut at = start;
        loop {
            // the latest facet is worked on first, those before it later
            let mut next = NONE;
            for i in 0..self.facets[at].neighbors.len() {
                let neighbor = self.facets[at].neighbors[i];
                if self.facets[neighbor].visit == visit {
                    continue;
                }
                self.facets[neighbor].visit = visit;
                if !self.facets[neighbor].flipped {
                    let dist = self.distance(p, neighbor);
                    if dist > height {
                        least = dist - slack;
                        if dist > height + slack {
                            stack.clear();
                        }
                        (found, height) = (neighbor, dist);
                    } else if dist < least {
                        continue;
                    }
                }
                if next != NONE {
                    stack.push(next);
                }
                next = neighbor;
            }
            at = match next {
                NONE => match stack.pop() {
                    Some(facet) => facet,
                    None => return (found, height),
                },
                facet => facet,
            };
        }
    }

    /// Finds a facet that is not flipped among the neighbours of one that is, or among all (`qh_findbestlower`).
    fn find_lower(&mut self, point: u32, flipped: Id) -> HullResult<(Id, f64)> {
        let p = self.point(point);
        let mut best = (NONE, BELOW_ALL);
        let around = self.facets[flipped].neighbors.clone();
        for facet in around.into_iter().chain(self.facets_from(self.first_facet)) {
            // all facets are looked at only if no neighbour will do
            if best.0 != NONE && !self.facets[flipped].neighbors.contains(&facet) {
                break;
            }
            if !self.facets[facet].flipped {
                let dist = self.distance(p, facet);
                if dist > best.1 {
                    best = (facet, dist);
                }
            }
        }
        if best.0 == NONE { Err(HullFailure) } else { Ok(best) }
    }

    /// Returns whether normals of new facets are in several octants (`qh_sharpnewfacets`).
    fn sharp_new_facets(&self) -> bool {
        let octant = |facet: Id| self.facets[facet].normal.unwrap_or([0.0; 3]).map(|x| x > 0.0);
        let all = self.facets_from(self.new_facets);
        all.iter().any(|&facet| octant(facet) != octant(all[0]))
    }
}
