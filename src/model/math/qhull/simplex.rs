//! The first four corners, and the facets between them.

use super::Builder;
use super::parts::{HullFailure, HullResult, Id, NONE, TAIL};
use super::tolerance::larger;
use crate::math::Vec3;

/// The least ratio of a determinant to its largest possible value; below it all points are searched (`qh_RATIOmaxsimplex`).
const SMALL_DETERMINANT: f64 = 1e-3;
/// The cosine of two facets of a needle (`qh_MAXnarrow`).
const NARROW: f64 = -0.99999999;

/// Returns the points at the least and the greatest coordinate along each axis, the first of several (`qh_maxmin`).
pub(super) fn extremes(points: &[Vec3]) -> [[u32; 2]; 3] {
    std::array::from_fn(|k| {
        let [mut low, mut high] = [0; 2];
        for (i, point) in points.iter().enumerate() {
            if points[high][k] < point[k] {
                high = i;
            } else if points[low][k] > point[k] {
                low = i;
            }
        }
        [low as u32, high as u32]
    })
}

/// The determinant of two rows of two numbers.
fn det2(a1: f64, a2: f64, b1: f64, b2: f64) -> f64 {
    a1 * b2 - a2 * b1
}

impl Builder<'_> {
    /// Returns the absolute determinant of a simplex of two or three points and another one, and whether it may be 0
    /// (`qh_detsimplex`). Of three points the first two coordinates count.
    fn determinant(&self, apex: u32, simplex: &[u32]) -> (f64, bool) {
        let apex = self.point(apex);
        let row = |i: usize| -> Vec3 {
            let point = self.point(simplex[i]);
            std::array::from_fn(|k| point[k] - apex[k])
        };
        let (a, b) = (row(0), row(1));
        if simplex.len() < 3 {
            let det = det2(a[0], a[1], b[0], b[1]).abs();
            return (det, det < 10.0 * self.tolerance.near_zero[1]);
        }
        let c = row(2);
        let det = a[0] * det2(b[1], b[2], c[1], c[2]) - b[0] * det2(a[1], a[2], c[1], c[2])
            + c[0] * det2(a[1], a[2], b[1], b[2]);
        (det.abs(), det.abs() < 10.0 * self.tolerance.near_zero[2])
    }

    /// Chooses four points: the two farthest along x, then those that make the greatest determinants, among the extremes first
    /// (`qh_maxsimplex`).
    fn first_corners(&self, extremes: &[u32]) -> HullResult<Vec<u32>> {
        let x = |point: u32| self.point(point)[0];
        let [mut low, mut high] = [*extremes.first().ok_or(HullFailure)?; 2];
        for &point in extremes {
            if x(high) < x(point) {
                high = point;
            }
            if x(low) > x(point) {
                low = point;
            }
        }
        if low == high {
            return Err(HullFailure);
        }
        let mut simplex = vec![low, high];
        let mut greatest = x(high) - x(low);
        while simplex.len() < 4 {
            let possible = greatest * self.tolerance.width;
            let enough = 10.0 * SMALL_DETERMINANT * possible;
            let (mut best, mut small) = (NONE, false);
            greatest = -1.0;
            for &point in extremes {
                if !simplex.contains(&point) && point != best {
                    let (det, near_zero) = self.determinant(point, &simplex);
                    if det > greatest {
                        (greatest, best, small) = (det, point, near_zero);
                    }
                }
            }
            // a flat simplex of the extremes may be the fault of their choice
            if best == NONE || small || (greatest > 0.0 && greatest / possible < SMALL_DETERMINANT) {
                for point in 0..self.points.len() as u32 {
                    if extremes.contains(&point) || simplex.contains(&point) {
                        continue;
                    }
                    let (det, near_zero) = self.determinant(point, &simplex);
                    if det > greatest {
                        (greatest, best, small) = (det, point, near_zero);
                        if !small && greatest > enough {
                            break;
                        }
                    }
                }
            }
            if best == NONE {
                return Err(HullFailure);
            }
            simplex.push(best);
        }
        Ok(simplex)
    }

    /// Builds the simplex, with facets that wind the right way, and the point inside (`qh_initialhull`).
    pub(super) fn first_hull(&mut self, extremes: &[u32]) -> HullResult<Vec<u32>> {
        let corners = self.first_corners(extremes)?;
        let mut vertices: Vec<Id> = corners.iter().map(|&point| self.new_vertex(point)).collect();
        vertices.reverse();
        self.create_simplex(&vertices)?;
        self.reset_lists(true);
        self.next_facet = self.first_facet;
        self.interior = self.mean(&vertices);
        let all = self.facets_from(self.first_facet);
        let first = *all.first().ok_or(HullFailure)?;
        self.set_plane(first)?;
        self.facets[first].flipped = false;
        if self.distance(self.interior, first) > self.tolerance.dist {
            for &facet in &all {
                self.facets[facet].top = !self.facets[facet].top;
            }
            self.set_plane(first)?;
        }
        for &facet in &all[1..] {
            self.set_plane(facet)?;
        }
        self.orient_first(&all)?;
        Ok(corners)
    }

    /// Flips all facets if the interior point is above one of them; notes whether the hull is a needle.
    fn orient_first(&mut self, all: &[Id]) -> HullResult {
        for &facet in all {
            self.facets[facet].flipped = false;
            if self.distance(self.interior, facet) > self.tolerance.dist {
                for &facet in all {
                    self.facets[facet].flipped = false;
                    self.facets[facet].top = !self.facets[facet].top;
                    self.orient_outside(facet);
                }
                break;
            }
        }
        let mut least = f64::MAX;
        for &facet in all {
            if !self.check_flipped(facet) {
                return Err(HullFailure); // the simplex is flat
            }
            for &neighbor in &self.facets[facet].neighbors {
                let cosine = self.cosine(facet, neighbor);
                if cosine < least {
                    least = cosine;
                }
            }
        }
        self.narrow = least < NARROW;
        Ok(())
    }

    /// Makes four facets, each without one of the vertices (`qh_createsimplex`).
    fn create_simplex(&mut self, vertices: &[Id]) -> HullResult {
        let mut top = true;
        for (i, &vertex) in vertices.iter().enumerate() {
            let mut others = vertices.to_vec();
            others.remove(i);
            let facet = self.new_facet(others, top);
            self.append_facet(facet);
            self.append_vertex(vertex);
            top = !top;
        }
        let all = self.facets_from(self.first_facet);
        for &facet in &all {
            self.facets[facet].neighbors = all.iter().copied().filter(|&other| other != facet).collect();
        }
        if all.len() == 4 { Ok(()) } else { Err(HullFailure) }
    }

    /// Assigns every point to the first facet that it is clearly above, and each of the others to the nearest facet
    /// (`qh_partitionall`).
    pub(super) fn partition_all(&mut self, corners: &[u32]) -> HullResult {
        let mut left: Vec<u32> = (0..self.points.len() as u32).collect();
        left.retain(|point| !corners.contains(point));
        let clearly = larger(2.0 * self.tolerance.outside, self.max_outside);
        for facet in self.facets_from(self.first_facet) {
            let mut best: Option<(u32, f64)> = None;
            let mut above = Vec::new();
            let mut rest = Vec::with_capacity(left.len());
            for &point in &left {
                let dist = self.distance(self.point(point), facet);
                if dist < clearly {
                    rest.push(point);
                    continue;
                }
                // the farthest is last, the others in their order but where one was farthest for a while
                match best {
                    Some((farthest, height)) if dist > height => {
                        above.push(farthest);
                        best = Some((point, dist));
                    }
                    Some(_) => above.push(point),
                    None => best = Some((point, dist)),
                }
            }
            if let Some((farthest, height)) = best {
                above.push(farthest);
                self.facets[facet].furthest = height;
            }
            self.facets[facet].outside = above;
            left = rest;
        }
        self.find_best_new = true;
        for point in left {
            self.partition_point(point, self.first_facet)?;
        }
        self.find_best_new = false;
        Ok(())
    }

    /// Begins with the facet below the farthest point (`qh_furthestnext`).
    pub(super) fn begin_farthest(&mut self) -> HullResult {
        self.next_facet = self.first_facet;
        let mut best = (TAIL, f64::MIN);
        for facet in self.facets_from(self.first_facet) {
            let entry = &self.facets[facet];
            if !entry.outside.is_empty() && entry.furthest > best.1 {
                best = (facet, entry.furthest);
            }
        }
        if best.0 == TAIL {
            Ok(())
        } else {
            self.work_on_next(best.0)
        }
    }
}
