//! Merging of facets that rounding errors leave not clearly convex.

mod cycles;
mod degenerate;
mod facets;
mod forced;
mod reduce;
mod rename;
mod tests;

use super::Builder;
use super::parts::{HullFailure, HullResult, Id, Merge, MergeReason};

/// Number of vertices above which facets are compared by their centres (`qh_BESTcentrum2 * 3 + qh_BESTcentrum`).
const MANY_VERTICES: usize = 26;
/// Number of vertices above which only neighbours across edges that were found not convex are compared (`3 + qh_BESTnonconvex`).
const SOME_VERTICES: usize = 18;
/// Distance by which a merge may move a plane before it is an error, in greatest widths (`qh_WIDEmaxoutside`).
const TOO_WIDE: f64 = 100.0;
/// Number of vertices up to which a facet gets a new centre with every merge (`3 + qh_MAXnewcentrum`).
const FEW_VERTICES: usize = 8;
/// The greatest number of merges that is counted (`qh_MAXnummerge`).
const MOST_MERGES: usize = 511;
/// Limit on the visited ends of edges of merged facets, which takes about a quarter of a minute.
const MOST_WORK: usize = 500_000_000;

impl Builder<'_> {
    /// Merges the new facets of a point that are not clearly convex (`qh_premerge`): those in the plane of their horizon
    /// first, then those at shared edges, then those that point inwards, then by convexity.
    pub(super) fn merge_new_facets(&mut self) -> HullResult {
        if self.clearly_convex()? {
            return Ok(());
        }
        self.mark_shared_edges()?;
        let mut merged = self.merge_cycles()?;
        merged |= self.merge_shared_edges()?;
        merged |= self.merge_flipped()?;
        self.test_new_facets()?;
        self.merge_all(merged)
    }

    /// Performs all noted merges, tests the facets that they changed, and repeats until nothing is left (`qh_all_merges`).
    pub(super) fn merge_all(&mut self, merged_before: bool) -> HullResult {
        let mut before = merged_before;
        loop {
            let mut merged = false;
            while !self.merges.is_empty() || !self.degenerates.is_empty() {
                self.check_pace()?;
                if !self.degenerates.is_empty() {
                    self.merge_degenerate()?;
                    merged = true;
                }
                while let Some(merge) = self.merges.pop() {
                    merged |= self.do_merge(merge)?;
                }
                self.test_changed_facets()?;
            }
            if !self.has_neighbors || !(merged || before) {
                return Ok(());
            }
            before = false;
            if !self.reduce_vertices()? {
                return Ok(());
            }
            self.test_changed_facets()?;
        }
    }

    /// Performs a merge if both facets still exist and have not changed since it was noted.
    fn do_merge(&mut self, merge: Merge) -> HullResult<bool> {
        let Merge {
            facet1, facet2, reason, ..
        } = merge;
        if self.facets[facet1].visible || self.facets[facet2].visible {
            return Ok(false);
        }
        // coplanar facets are merged one pair at a time: what changed is tested again
        let changed = |facet: Id| !self.facets[facet].tested && self.facets[facet].new;
        if reason == MergeReason::Coplanar && (changed(facet1) || changed(facet2)) {
            return Ok(false);
        }
        self.merge_nonconvex(facet1, facet2, reason)?;
        self.merge_degenerate()?;
        Ok(true)
    }

    /// Merges one of two facets into its best neighbour: the one that changes less (`qh_merge_nonconvex`).
    fn merge_nonconvex(&mut self, facet1: Id, facet2: Id, reason: MergeReason) -> HullResult {
        let (first, second) = if self.facets[facet1].new {
            (facet1, facet2)
        } else {
            (facet2, facet1)
        };
        let (neighbor1, spread1) = self.best_neighbor(first)?;
        let (neighbor2, spread2) = self.best_neighbor(second)?;
        if spread1[0] < spread2[0] {
            self.merge_facet(first, neighbor1, reason, Some([spread1[1], spread1[2]]))
        } else {
            self.merge_facet(second, neighbor2, reason, Some([spread2[1], spread2[2]]))
        }
    }

    /// Finds the neighbour nearest to a facet, and the facet's distance from its plane (`qh_findbestneighbor`).
    fn best_neighbor(&mut self, facet: Id) -> HullResult<(Id, [f64; 3])> {
        let size = self.facets[facet].vertices.len();
        let by_center = size > MANY_VERTICES;
        let center = if by_center { Some(self.center(facet)) } else { None };
        let mut candidates = Vec::new();
        if size > SOME_VERTICES {
            let ridges = self.facets[facet].ridges.iter();
            let nonconvex = ridges.filter(|&&ridge| self.ridges[ridge].nonconvex);
            candidates.extend(nonconvex.map(|&ridge| self.ridges[ridge].other(facet)));
        }
        let mut best: Option<(Id, [f64; 3])> = None;
        for all in [false, true] {
            if all {
                candidates.clone_from(&self.facets[facet].neighbors);
            }
            for &neighbor in &candidates {
                if self.facets[facet].flipped
                    && self.facets[neighbor].flipped
                    && best.is_some_and(|(best, _)| !self.facets[best].flipped)
                {
                    continue;
                }
                let spread = match center {
                    Some(center) => {
                        let dist = self.distance(center, neighbor) * 3.0;
                        if dist < 0.0 {
                            [-dist, dist, 0.0]
                        } else {
                            [dist, 0.0, dist]
                        }
                    }
                    None => self.spread(facet, neighbor),
                };
                if spread[0] < best.map_or(f64::MAX, |(_, spread)| spread[0]) {
                    best = Some((neighbor, spread));
                }
            }
            if best.is_some() {
                break;
            }
        }
        let (neighbor, mut spread) = best.ok_or(HullFailure)?;
        if by_center {
            let [_, low, high] = self.spread(facet, neighbor);
            spread = [spread[0], low, high];
        }
        Ok((neighbor, spread))
    }

    /// Notes a merge (`qh_appendmergeset`).
    fn note_merge(&mut self, facet1: Id, facet2: Id, reason: MergeReason, distance: f64) -> HullResult {
        if self.facets[facet1].redundant || self.facets[facet2].redundant {
            return Ok(());
        }
        let degenerate = reason == MergeReason::Degenerate;
        if self.facets[facet1].degenerate && degenerate {
            return Ok(());
        }
        if self.facets[facet2].flipped && !self.facets[facet1].flipped && reason != MergeReason::DupRidge {
            return Err(HullFailure);
        }
        let merge = Merge {
            facet1,
            facet2,
            reason,
            distance,
        };
        if reason == MergeReason::Redundant {
            self.facets[facet1].redundant = true;
            self.degenerates.push(merge);
        } else if degenerate {
            self.facets[facet1].degenerate = true;
            // redundant ones are done before others
            match self.degenerates.last() {
                Some(last) if last.reason != MergeReason::Degenerate => self.degenerates.insert(0, merge),
                _ => self.degenerates.push(merge),
            }
        } else {
            self.merges.push(merge);
        }
        Ok(())
    }

    /// Fails for hulls that would take minutes or never end. Real hulls finish long before they have so many facets and merges. Even a cap of ten
    /// thousand edges, all visited by each of its merges, needs less work.
    fn check_pace(&self) -> HullResult {
        let most = 1000 + 200 * self.points.len();
        if self.facets.len() > most || self.merge_count as usize > most || self.work > MOST_WORK {
            Err(HullFailure)
        } else {
            Ok(())
        }
    }
}
