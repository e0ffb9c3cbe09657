//! Convex hulls of sensor points, for finding the sensors of a body that lie inside another of its geoms.
//!
//! A Quickhull (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", ACM Transactions on Mathematical
//! Software 22, 1996) of its own, since sensors lie on rings, walls and grids, where most points are coplanar with others, and
//! since it decides which sensors exist: it uses nothing but `+ - * /` and square roots, which are the same on every target.

use std::ops::Range;

use crate::math::*;

/// A face of the hull under construction.
struct Face {
    corner: [usize; 3],
    /// Half space of the face.
    plane: HalfSpace,
    /// Faces across the edges `corner[i]` to `corner[i + 1]`.
    neighbor: [usize; 3],
    /// Points above the face that are not yet in the hull.
    above: Vec<usize>,
    alive: bool,
}

impl Face {
    fn new(points: &[Vec3], corner: [usize; 3]) -> Option<Self> {
        let [a, b, c] = corner.map(|i| points[i]);
        let (normal, area) = unit(cross(sub(b, a), sub(c, a)));
        // three corners on a line have no plane; the caller tries another tolerance
        (area > MINVAL).then(|| Self {
            corner,
            plane: HalfSpace {
                normal,
                offset: -dot(normal, a),
            },
            neighbor: [usize::MAX; 3],
            above: Vec::new(),
            alive: true,
        })
    }

    fn distance(&self, p: Vec3) -> f64 {
        self.plane.distance(p)
    }
}

/// A half space: `normal . p + offset` is the distance of `p` from its plane, negative inside.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HalfSpace {
    /// Outward unit normal.
    normal: Vec3,
    offset: f64,
}

impl HalfSpace {
    fn distance(&self, p: Vec3) -> f64 {
        dot(self.normal, p) + self.offset
    }
}

/// Bounds of a run of planes whose normals lie close together; runs are split in two until they are short.
#[derive(Clone, Debug, PartialEq)]
struct Bundle {
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

impl Bundle {
    /// Returns an upper bound of the distance of `p` from the planes.
    fn bound(&self, p: Vec3) -> f64 {
        (0..3).fold(self.offset + ROUNDING, |sum, k| {
            sum + (self.low[k] * p[k]).max(self.high[k] * p[k])
        })
    }
}

/// The convex hull of a set of points, as half spaces in a tree of bundles, most of which are dismissed at once.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    planes: Vec<HalfSpace>,
    bundles: Vec<Bundle>,
}

impl Hull {
    /// Creates the hull of `points`, of which any number may be coplanar or cospherical. `None` if they span no volume.
    ///
    /// Points that leave the hull by less than 1e-12 times its size are taken to be on it, far below the spacing of
    /// sensors and far above rounding, so that rings, walls and grids need no special treatment.
    pub fn new(points: &[Vec3]) -> Option<Self> {
        let extent = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        // rounding may contradict itself for points near a plane at just this tolerance; at another one other points
        // are near
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
        self.bundles.push(Bundle {
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

/// Returns four points that span a volume, the last below the face of the others; `None` if there are none.
fn first_corners(points: &[Vec3], tolerance: f64) -> Option<[usize; 4]> {
    let farthest = |measure: &dyn Fn(Vec3) -> f64| {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, &p) in points.iter().enumerate() {
            let m = measure(p);
            if m > best.1 {
                best = (i, m);
            }
        }
        (best.1 > tolerance).then_some(best.0)
    };
    // Extremes make a large tetrahedron: few points are left outside it, and its faces have reliable normals.
    let origin = *points.first()?;
    let a = farthest(&|p| norm(sub(p, origin)))?;
    let b = farthest(&|p| norm(sub(p, points[a])))?;
    let line = unit(sub(points[b], points[a])).0;
    let c = farthest(&|p| norm(cross(line, sub(p, points[a]))))?;
    let normal = unit(cross(sub(points[b], points[a]), sub(points[c], points[a]))).0;
    let d = farthest(&|p| dot(normal, sub(p, points[a])).abs())?;
    let above = dot(normal, sub(points[d], points[a])) > 0.0;
    // faces wind counterclockwise from outside, so the fourth corner has to be below the first three
    Some(if above { [a, c, b, d] } else { [a, b, c, d] })
}

/// Creates the faces of a tetrahedron; `None` if one has no area.
fn tetrahedron(points: &[Vec3], [a, b, c, d]: [usize; 4]) -> Option<Vec<Face>> {
    let mut faces = Vec::new();
    for (corner, neighbor) in [
        ([a, b, c], [1, 2, 3]),
        ([b, a, d], [0, 3, 2]),
        ([c, b, d], [0, 1, 3]),
        ([a, c, d], [0, 2, 1]),
    ] {
        let mut face = Face::new(points, corner)?;
        face.neighbor = neighbor;
        faces.push(face);
    }
    Some(faces)
}

/// An edge of the border between removed faces and others: its two corners, and the face beyond it.
type BorderEdge = (usize, usize, usize);

/// Removes the faces that a new corner sees, beginning with `first`; returns their border and the points above them.
fn remove_seen(faces: &mut [Face], first: usize, sees: impl Fn(&Face) -> bool) -> (Vec<BorderEdge>, Vec<usize>) {
    let (mut stack, mut border, mut orphans) = (vec![first], Vec::new(), Vec::new());
    faces[first].alive = false;
    while let Some(k) = stack.pop() {
        // points above a removed face are above a new one or inside; others keep the face they are above
        orphans.append(&mut faces[k].above);
        for e in 0..3 {
            let other = faces[k].neighbor[e];
            if !faces[other].alive {
                continue;
            }
            if sees(&faces[other]) {
                faces[other].alive = false;
                stack.push(other);
            } else {
                border.push((faces[k].corner[e], faces[k].corner[(e + 1) % 3], other));
            }
        }
    }
    (border, orphans)
}

/// Joins a border to a new corner by new faces; `None` if it is not one closed line. `starting_at` has an unset entry for
/// each point before and after.
fn join(
    points: &[Vec3],
    faces: &mut Vec<Face>,
    eye: usize,
    border: &[BorderEdge],
    starting_at: &mut [usize],
) -> Option<()> {
    let first = faces.len();
    for (n, &(from, to, other)) in border.iter().enumerate() {
        let mut face = Face::new(points, [from, to, eye])?;
        face.neighbor[0] = other;
        // a second border edge from the same corner: rounding has made a border that touches itself
        if starting_at[from] != usize::MAX {
            return None;
        }
        starting_at[from] = first + n;
        let edge = (0..3).find(|&e| faces[other].corner[e] == to && faces[other].corner[(e + 1) % 3] == from)?;
        faces[other].neighbor[edge] = first + n;
        faces.push(face);
    }
    for (n, &(_, to, _)) in border.iter().enumerate() {
        let next = starting_at[to];
        // no edge begins where this one ends: the border is open
        faces.get(next)?;
        faces[first + n].neighbor[1] = next;
        faces[next].neighbor[2] = first + n;
    }
    // only what was set, as clearing all points for every corner would make the whole quadratic
    border.iter().for_each(|b| starting_at[b.0] = usize::MAX);
    Some(())
}

/// Computes the faces of the hull; `None` if rounding leaves a hole in it.
fn quickhull(points: &[Vec3], tolerance: f64) -> Option<Vec<Face>> {
    let mut faces = tetrahedron(points, first_corners(points, tolerance)?)?;
    let assign = |i: usize, faces: &mut [Face]| {
        // one face is enough: the point is looked at again when that face goes
        if let Some(face) = faces.iter_mut().find(|f| f.distance(points[i]) > tolerance) {
            face.above.push(i);
        }
    };
    (0..points.len()).for_each(|i| assign(i, &mut faces));
    let mut starting_at = vec![usize::MAX; points.len()];
    let mut pending: Vec<usize> = vec![0, 1, 2, 3];
    while let Some(f) = pending.pop() {
        if !faces[f].alive || faces[f].above.is_empty() {
            continue;
        }
        let height = |i: &usize| faces[f].distance(points[*i]);
        // the farthest point is certainly a corner of the hull; any other might have to be removed again
        let eye = *faces[f].above.iter().max_by(|i, j| height(i).total_cmp(&height(j)))?;

        let (border, orphans) = remove_seen(&mut faces, f, |other| other.distance(points[eye]) > tolerance);
        let first = faces.len();
        join(points, &mut faces, eye, &border, &mut starting_at)?;
        orphans
            .into_iter()
            .filter(|&i| i != eye)
            .for_each(|i| assign(i, &mut faces[first..]));
        pending.extend(first..faces.len());
    }
    Some(faces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::GeomType;
    use crate::sensors::touch::points::surface_points;

    /// Checks that the faces contain all points, that each touches three of them, and that together they close: Euler's
    /// formula.
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

    /// Checks that bundles give what all planes give, one by one.
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
