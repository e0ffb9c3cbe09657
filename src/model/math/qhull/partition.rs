//! Assignment of points to the facets that they are above.

use super::Builder;
use super::find::FacetDistance;
use super::parts::{HullFailure, HullResult, Id, NONE, push_second_last};

/// Height above which a coplanar point counts as outside, in greatest widths (`qh_RATIOcoplanaroutside`).
const COPLANAR_OUTSIDE: f64 = 30.0;

impl Builder<'_> {
    /// Removes and returns the next point: the farthest one of the first facet that has any (`qh_nextfurthest`).
    pub(super) fn next_farthest(&mut self) -> Option<(u32, Id)> {
        while Self::listed(self.next_facet) {
            let facet = self.next_facet;
            let entry = &mut self.facets[facet];
            // of a needle only points count that are clearly outside
            if entry.outside.is_empty() {
                self.next_facet = entry.next;
                continue;
            }
            if self.narrow {
                if entry.not_furthest {
                    self.measure_farthest(facet);
                }
                if self.facets[facet].furthest < self.tolerance.outside {
                    self.next_facet = self.facets[facet].next;
                    continue;
                }
            }
            return self.facets[facet].outside.pop().map(|point| (point, facet));
        }
        None
    }

    /// Recomputes the height of the highest point (`qh_furthestout`, which leaves the order as it is).
    fn measure_farthest(&mut self, facet: Id) {
        let mut best = f64::MIN;
        for &point in &self.facets[facet].outside {
            let dist = self.distance(self.point(point), facet);
            if dist > best {
                best = dist;
            }
        }
        self.facets[facet].furthest = best;
        self.facets[facet].not_furthest = false;
    }

    /// Assigns a point to the facet that it is highest above or coplanar with, or drops it (`qh_partitionpoint`).
    pub(super) fn partition_point(&mut self, point: u32, facet: Id) -> HullResult {
        let found = if self.find_best_new {
            self.find_best_of_new(point, facet, false)?
        } else {
            self.find_best(point, facet, false, true)?
        };
        let FacetDistance {
            facet: best,
            dist,
            mut outside,
        } = found;
        if self.facets[best].visible {
            return Err(HullFailure);
        }
        if self.narrow && dist >= -self.tolerance.near_inside {
            outside = true;
        }
        if outside {
            return self.put_outside(point, best, dist);
        }
        if dist >= -self.tolerance.near_inside {
            self.partition_coplanar(point, best, Some(dist), self.find_best_new)?;
        }
        Ok(())
    }

    /// Adds a point to those outside a facet. A facet that gets its first such point is processed later.
    fn put_outside(&mut self, point: u32, facet: Id, dist: f64) -> HullResult {
        let (narrow, least) = (self.narrow, self.tolerance.outside);
        let entry = &mut self.facets[facet];
        let mut first = false;
        if entry.outside.is_empty() {
            entry.outside.push(point);
            entry.furthest = dist;
            first = !narrow || dist > least;
        } else if entry.furthest < dist {
            first = narrow && entry.furthest < least && dist >= least;
            entry.outside.push(point);
            entry.furthest = dist;
        } else {
            push_second_last(&mut entry.outside, point);
        }
        if first && self.next_facet != facet {
            if self.facets[facet].new {
                if self.facets[self.next_facet].new {
                    self.next_facet = self.new_facets;
                }
            } else {
                self.renew_facet(facet)?;
                if self.new_facets != NONE {
                    self.facets[facet].new = true;
                }
            }
        }
        Ok(())
    }

    /// Adds a point to those coplanar with a facet (`qh_partitioncoplanar`). Without a distance, it first looks for the
    /// best facet among all new ones or by a walk. A point that turns out to be far above is outside.
    pub(super) fn partition_coplanar(&mut self, point: u32, facet: Id, dist: Option<f64>, all_new: bool) -> HullResult {
        let (best, height) = match dist {
            Some(dist) => (facet, dist),
            None => {
                let found = if all_new {
                    self.find_best_of_new(point, facet, true)?
                } else {
                    self.find_best(point, facet, true, false)?
                };
                if found.dist < -self.tolerance.near_inside {
                    self.repartitioned = NONE;
                    return Ok(());
                }
                (found.facet, found.dist)
            }
        };
        if self.facets[best].visible {
            return Err(HullFailure);
        }
        if height > self.max_outside {
            let mut outside = dist.is_none() && facet != best && self.cosine(facet, best) < 0.0;
            if !outside && height > self.most_outside * COPLANAR_OUTSIDE {
                if facet == best {
                    if facet == self.repartitioned {
                        return Err(HullFailure); // it would go on for ever
                    }
                    self.repartitioned = facet;
                }
                outside = true;
            }
            if outside {
                let before = std::mem::replace(&mut self.find_best_new, false);
                self.partition_point(point, best)?;
                self.find_best_new = before;
                self.repartitioned = NONE;
                return Ok(());
            }
            self.repartitioned = NONE;
            self.max_outside = height;
        }
        let farthest = self.facets[best].coplanar.last().copied();
        let farther = farthest.is_none_or(|other| self.distance(self.point(other), best) < height);
        let coplanar = &mut self.facets[best].coplanar;
        if farther {
            coplanar.push(point);
        } else {
            push_second_last(coplanar, point);
        }
        Ok(())
    }

    /// Returns the facet that replaces a removed one (`qh_getreplacement`).
    pub(super) fn replacement(&self, facet: Id) -> HullResult<Id> {
        let mut at = facet;
        for _ in 0..=self.facets.len() {
            if at == NONE || !self.facets[at].visible {
                return Ok(at);
            }
            at = self.facets[at].replace;
        }
        Err(HullFailure)
    }

    /// Reassigns the points of the removed facets and of the removed vertices (`qh_partitionvisible`).
    pub(super) fn partition_visible(&mut self) -> HullResult {
        for facet in self.visible() {
            if self.facets[facet].outside.is_empty() && self.facets[facet].coplanar.is_empty() {
                continue;
            }
            let mut heir = self.replacement(facet)?;
            if heir == NONE {
                heir = self.new_facets;
            }
            if !Self::listed(heir) {
                return Err(HullFailure);
            }
            for point in std::mem::take(&mut self.facets[facet].outside) {
                self.partition_point(point, heir)?;
            }
            for point in std::mem::take(&mut self.facets[facet].coplanar) {
                self.partition_coplanar(point, heir, None, self.find_best_new)?;
            }
        }
        for i in 0..self.dead_vertices.len() {
            let vertex = self.dead_vertices[i];
            if !self.vertices[vertex].partitioned {
                self.partition_coplanar(self.vertices[vertex].point, self.new_facets, None, true)?;
                self.vertices[vertex].partitioned = true;
            }
        }
        Ok(())
    }
}
