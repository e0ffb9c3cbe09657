//! Forced merges: of facets at edges that more than two share, and of facets that point inwards.

use crate::math::qhull::Builder;
use crate::math::qhull::matching::WIDE;
use crate::math::qhull::parts::{FORCED, HullFailure, HullResult, Id, Merge, MergeReason};
use crate::math::qhull::plane::square_distance;
use crate::math::qhull::tolerance::larger;

/// Largest distance of facets at a shared edge from each other, in greatest widths (`qh_WIDEduplicate`).
const TOO_FAR: f64 = 100.0;

impl Builder<'_> {
    /// Notes merges of new facets at shared edges, and gives them their edges (`qh_mark_dupridges`).
    pub(super) fn mark_shared_edges(&mut self) -> HullResult {
        let all = self.facets_from(self.new_facets);
        for &facet in &all {
            self.facets[facet].merge_ridge = false;
            self.facets[facet].merge_ridge2 = false;
        }
        let mut any = false;
        for &facet in &all {
            if !self.facets[facet].dup_ridge {
                continue;
            }
            for neighbor in self.facets[facet].neighbors.clone() {
                if neighbor == FORCED {
                    self.facets[facet].merge_ridge = true;
                    continue;
                }
                if !self.facets[neighbor].dup_ridge {
                    continue;
                }
                let mutual = self.facets[neighbor].neighbors.contains(&facet);
                let equal = self.facets[facet].vertices == self.facets[neighbor].vertices;
                if !mutual || equal {
                    self.note_merge(facet, neighbor, MergeReason::DupRidge, 0.0)?;
                    self.facets[facet].merge_ridge = true;
                    self.facets[facet].merge_ridge2 = true;
                    any = true;
                }
                if mutual && equal {
                    break;
                }
            }
        }
        if !any {
            return Ok(());
        }
        for &facet in &all {
            if self.facets[facet].merge_ridge && !self.facets[facet].merge_ridge2 {
                self.make_ridges(facet)?;
            }
        }
        for i in 0..self.merges.len() {
            let Merge {
                facet1, facet2, reason, ..
            } = self.merges[i];
            if reason == MergeReason::DupRidge {
                if self.facets[facet2].merge_ridge2 && self.facets[facet2].neighbors.contains(&facet1) {
                    return Err(HullFailure);
                }
                self.facets[facet2].neighbors.push(facet1);
                self.make_ridges(facet1)?;
            }
        }
        Ok(())
    }

    /// Performs these merges (`qh_forcedmerges`); returns whether there were any.
    pub(super) fn merge_shared_edges(&mut self) -> HullResult<bool> {
        let noted = std::mem::take(&mut self.merges);
        let (mut shared, mut merged) = (false, false);
        let mut others = Vec::new();
        for merge in noted {
            if merge.reason != MergeReason::DupRidge {
                others.push(merge);
                continue;
            }
            shared = true;
            let (facet1, facet2) = (self.replacement(merge.facet1)?, self.replacement(merge.facet2)?);
            if facet1 == facet2 {
                continue;
            }
            if !self.facets[facet2].neighbors.contains(&facet1) {
                return Err(HullFailure);
            }
            self.merge_shared(facet1, facet2)?;
            self.merge_degenerate()?;
            merged = true;
        }
        others.append(&mut self.merges);
        self.merges = others;
        if shared {
            for facet in self.facets_from(self.new_facets) {
                if self.facets[facet].dup_ridge {
                    let entry = &mut self.facets[facet];
                    (entry.dup_ridge, entry.merge_ridge, entry.merge_ridge2) = (false, false, false);
                    if entry.neighbors.len() < 3 {
                        self.note_merge(facet, facet, MergeReason::Degenerate, 0.0)?;
                    }
                }
            }
            self.merge_degenerate()?;
        }
        Ok(merged)
    }

    /// Merges the one of two facets that changes less, but preferably one that points inwards.
    fn merge_shared(&mut self, facet1: Id, facet2: Id) -> HullResult {
        let ([dist1, low1, high1], [dist2, low2, high2]) = (self.spread(facet1, facet2), self.spread(facet2, facet1));
        self.check_shared(facet1, if dist1 > dist2 { dist2 } else { dist1 })?;
        let near = WIDE * (self.tolerance.one_merge + self.tolerance.dist);
        let [flipped1, flipped2] = [facet1, facet2].map(|facet| self.facets[facet].flipped);
        let first = if dist1 < dist2 {
            !(flipped2 && !flipped1 && dist2 < near)
        } else {
            flipped1 && !flipped2 && dist1 < near
        };
        if first {
            self.merge_facet(facet1, facet2, MergeReason::DupRidge, Some([low1, high1]))
        } else {
            self.merge_facet(facet2, facet1, MergeReason::DupRidge, Some([low2, high2]))
        }
    }

    /// Refuses a merge that would make a facet much wider than rounding errors (`qh_check_dupridge`).
    fn check_shared(&self, facet: Id, dist: f64) -> HullResult {
        let outer = larger(self.max_outside, self.tolerance.dist) + self.tolerance.dist;
        let inner = self.min_vertex - self.tolerance.dist;
        let widest = larger(
            larger(larger(outer, inner), self.tolerance.one_merge + self.tolerance.dist),
            self.tolerance.outside + self.tolerance.dist,
        );
        if dist / widest > TOO_FAR {
            Err(HullFailure)
        } else {
            Ok(())
        }
        .and_then(|()| self.check_distinct(facet))
    }

    /// Refuses facets with two vertices at the same place, because their plane has no meaning.
    fn check_distinct(&self, facet: Id) -> HullResult {
        let vertices = &self.facets[facet].vertices;
        let twice = |i: usize, j: usize| square_distance(self.place(vertices[i]), self.place(vertices[j])) == 0.0;
        let any = (0..vertices.len()).any(|i| (i + 1..vertices.len()).any(|j| twice(i, j)));
        if any { Err(HullFailure) } else { Ok(()) }
    }

    /// Merges facets that point inwards into their best neighbours (`qh_flippedmerges`); returns whether there were any.
    pub(super) fn merge_flipped(&mut self) -> HullResult<bool> {
        for facet in self.facets_from(self.new_facets) {
            if self.facets[facet].flipped && !self.facets[facet].visible {
                self.note_merge(facet, facet, MergeReason::Flip, 0.0)?;
            }
        }
        let noted = std::mem::take(&mut self.merges);
        let mut merged = false;
        for merge in &noted {
            if merge.reason == MergeReason::Flip && !self.facets[merge.facet1].visible {
                let (neighbor, [_, low, high]) = self.best_neighbor(merge.facet1)?;
                self.merge_facet(merge.facet1, neighbor, MergeReason::Flip, Some([low, high]))?;
                merged = true;
            }
        }
        let gone = |facet: Id| self.facets[facet].visible;
        let left = noted
            .into_iter()
            .filter(|merge| !gone(merge.facet1) && !gone(merge.facet2));
        let mut left: Vec<Merge> = left.collect();
        self.merges.append(&mut left);
        self.merge_degenerate()?;
        Ok(merged)
    }
}
