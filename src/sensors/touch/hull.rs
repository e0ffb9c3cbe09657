//! Convex hulls of sensor points, for finding the sensors of a body that lie inside another of its geoms.
//!
//! Sensors lie on rings, walls and grids, where most points are coplanar with others.

use std::ops::Range;

use crate::math::hull::{HalfSpace, quickhull};
use crate::math::*;

/// Bounds of a run of planes whose normals lie close together; runs are split in two until they are short.
#[derive(Clone, Debug, PartialEq)]
struct PlaneBundle {
    planes: Range<usize>,
    /// Lower corner of the box around the normals.
    low: Vec3,
    high: Vec3,
    /// Largest offset.
    offset: f64,
    /// Index of the second half, if the bundle is split; the first half follows the bundle itself.
    second: Option<usize>,
}

/// Number of planes in a bundle that is not split.
const BUNDLE: usize = 8;
/// Slack (m) for the rounding of bounds, far below the spacing of sensors.
const ROUNDING: f64 = 1e-12;

impl PlaneBundle {
    /// Returns an upper bound of the distance of `p` from the planes.
    fn bound(&self, p: Vec3) -> f64 {
        (0..3).fold(self.offset + ROUNDING, |sum, k| {
            sum + (self.low[k] * p[k]).max(self.high[k] * p[k])
        })
    }
}

/// The convex hull of a set of points, as half spaces in a tree of bundles, which are mostly rejected together.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    planes: Vec<HalfSpace>,
    bundles: Vec<PlaneBundle>,
}

impl Hull {
    /// Creates the hull of `points`. Any number of them may be coplanar or cospherical. `None` if they span no volume.
    ///
    /// Points that leave the hull by less than 1e-12 times its size are taken to be on it, far below the spacing of
    /// sensors and far above rounding, so that rings, walls and grids need no special treatment.
    pub fn new(points: &[Vec3]) -> Option<Self> {
        let extent = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        // rounding may be inconsistent for points whose distance from a plane is near this tolerance; another tolerance avoids
        // these points
        let faces = [1e-12, 1e-11, 1e-10]
            .iter()
            .find_map(|tolerance| quickhull(points, tolerance * extent))?;
        let planes: Vec<HalfSpace> = faces.iter().filter(|f| f.alive).map(|f| f.plane).collect();
        let all = 0..planes.len();
        let mut hull = Self {
            planes,
            bundles: Vec::new(),
        };
        hull.bundle(all);
        Some(hull)
    }

    /// Sorts `run` of the planes into bundles.
    fn bundle(&mut self, run: Range<usize>) {
        let planes = &mut self.planes[run.clone()];
        let bound = |pick: fn(f64, f64) -> f64, from: f64| {
            std::array::from_fn::<f64, 3, _>(|k| planes.iter().fold(from, |m, p| pick(m, p.normal[k])))
        };
        let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
        let offset = planes.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.offset));
        let index = self.bundles.len();
        self.bundles.push(PlaneBundle {
            planes: run.clone(),
            low,
            high,
            offset,
            second: None,
        });
        if run.len() > BUNDLE {
            let width = sub(high, low);
            let axis = (1..3).fold(0, |best, k| if width[k] > width[best] { k } else { best });
            // halves by count along the widest axis, as in a k-d tree: normals of a bundle point much the same way, so
            // that its bound is tight
            let middle = run.len() / 2;
            planes.select_nth_unstable_by(middle, |a, b| a.normal[axis].total_cmp(&b.normal[axis]));
            self.bundle(run.start..run.start + middle);
            self.bundles[index].second = Some(self.bundles.len());
            self.bundle(run.start + middle..run.end);
        }
    }

    /// Returns whether `p` is inside, or outside by less than `margin` (m) from the plane of every face.
    pub fn contains(&self, p: Vec3, margin: f64) -> bool {
        self.inside(0, p, margin)
    }

    fn inside(&self, bundle: usize, p: Vec3, margin: f64) -> bool {
        let b = &self.bundles[bundle];
        // inside all of its planes; near the surface of a body this dismisses all bundles but those that face the point
        if b.bound(p) < margin {
            return true;
        }
        match b.second {
            Some(second) => self.inside(bundle + 1, p, margin) && self.inside(second, p, margin),
            None => self.planes[b.planes.clone()]
                .iter()
                .all(|plane| plane.distance(p) < margin),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::GeomType;
    use crate::sensors::touch::points::surface_points;

    /// Checks that the faces contain all points, that each touches three of them, and that together they close, by Euler's formula.
    #[test]
    fn hulls_of_sensor_points_contain_them_all() {
        let mut worst = 0.0_f64;
        for (kind, size) in [
            (GeomType::Box, [0.0228, 0.01, 0.0207]),
            (GeomType::Cylinder, [0.0102, 0.023, 0.0]),
            (GeomType::Sphere, [0.0735, 0.0, 0.0]),
            (GeomType::Capsule, [0.052, 0.035, 0.0]),
            (GeomType::Ellipsoid, [0.03, 0.05, 0.02]),
        ] {
            for n in 1..40 {
                let spacing = 0.0015 + 0.0017 * f64::from(n);
                let points = surface_points(kind, size, spacing);
                if points.len() < 4 {
                    continue;
                }
                let faces = quickhull(&points, 1e-12 * 0.1).expect("the first tolerance does");
                let alive = faces.iter().filter(|f| f.alive);
                let mut used: Vec<usize> = alive.clone().flat_map(|f| f.corner).collect();
                used.sort_unstable();
                used.dedup();
                assert_eq!(alive.clone().count(), 2 * used.len() - 4, "{kind:?} at {spacing}");
                for f in alive {
                    for &p in &points {
                        worst = worst.max(f.distance(p));
                    }
                }
            }
        }
        println!("points leave their hull by up to {worst:.1e} m");
        assert!(worst < 1e-12);
    }

    /// Checks that bundles give the same result as all planes tested one by one.
    #[test]
    fn bundles_dismiss_no_plane_that_matters() {
        let points = surface_points(GeomType::Capsule, [0.052, 0.035, 0.0], 0.004);
        let hull = Hull::new(&points).expect("a volume");
        let mut inside = 0;
        for (i, p) in points.iter().enumerate() {
            for stretch in [0.3, 0.9, 0.99, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.01, 1.5] {
                let p = scale(*p, stretch);
                let plain = hull.planes.iter().all(|plane| plane.distance(p) < 1e-9);
                assert_eq!(hull.contains(p, 1e-9), plain, "point {i} at {stretch}");
                inside += usize::from(plain);
            }
        }
        assert!((3 * points.len()..7 * points.len()).contains(&inside), "{inside}");
    }

    #[test]
    fn flat_and_empty_sets_have_no_hull() {
        assert_eq!(Hull::new(&[]), None);
        assert_eq!(Hull::new(&[[0.1; 3]; 7]), None);
        let flat: Vec<Vec3> = (0..20).map(|i| [f64::from(i % 5), f64::from(i / 5), 1.0]).collect();
        assert_eq!(Hull::new(&flat), None);
    }
}
