//! Convex hulls of points.
//!
//! A Quickhull (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", ACM Transactions on Mathematical
//! Software 22, 1996) of its own: its result decides which sensors exist and which points of a mesh touch, so it uses nothing but
//! `+ - * /` and square roots, which are the same on every target.

use super::*;

/// A face of the hull under construction.
pub struct Face {
    /// Its corners, counterclockwise from outside.
    pub corner: [usize; 3],
    /// Half space of the face.
    pub plane: HalfSpace,
    /// Faces across the edges `corner[i]` to `corner[i + 1]`.
    neighbor: [usize; 3],
    /// Points above the face that are not yet in the hull.
    above: Vec<usize>,
    /// Whether it is part of the hull; the others were removed.
    pub alive: bool,
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

    /// Returns the distance of a point from the plane, negative inside.
    pub fn distance(&self, p: Vec3) -> f64 {
        self.plane.distance(p)
    }
}

/// A half space: `normal . p + offset` is the distance of `p` from its plane, negative inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Outward unit normal.
    pub normal: Vec3,
    /// Distance of the origin from the plane.
    pub offset: f64,
}

impl HalfSpace {
    /// Returns the distance of a point from the plane, negative inside.
    pub fn distance(&self, p: Vec3) -> f64 {
        dot(self.normal, p) + self.offset
    }
}

/// Returns four points that span a volume, the last one below the face of the other three; `None` if there are no such points.
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

/// An edge of the border between removed and other faces: its two corners, and the face beyond it.
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

/// Joins a border to a new corner by new faces; `None` if it is not one closed line. Before and after the call, `starting_at` has an unset entry for
/// each point.
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
    // only the entries that were set: clearing all points for every corner would be quadratic
    border.iter().for_each(|b| starting_at[b.0] = usize::MAX);
    Some(())
}

/// Computes the faces of the hull, including removed ones; `None` if the points span no volume or rounding leaves a hole in it.
/// Points outside the hull by less than `tolerance` count as on it.
pub fn quickhull(points: &[Vec3], tolerance: f64) -> Option<Vec<Face>> {
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
