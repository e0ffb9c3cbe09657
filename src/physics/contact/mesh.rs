//! Meshes: their farthest points, and their contacts with planes.

use std::cell::Cell;

use super::plane::push_point;
use super::support::{Pose, Support};
use super::{ContactPoint, PlacedGeom, dot, frame, sub};
use crate::math::{Vec3, add, mat_t_vec, mat_vec, norm, scale};
use crate::model::{Mesh, MeshHull};

/// Meshes of fewer vertices are searched vertex by vertex (MuJoCo's `mjMESH_HILLCLIMB_MIN`).
const CLIMBED: usize = 10;
/// Maximum number of contacts of a plane and a mesh.
const PLANE_CONTACTS: usize = 3;
/// Least distance of the other contacts from the first, in bounding radii.
const PLANE_SPREAD: f64 = 0.3;

/// The height of a vertex along a direction.
#[inline(always)]
fn height(dir: Vec3, v: [f32; 3]) -> f64 {
    dir[0] * f64::from(v[0]) + dir[1] * f64::from(v[1]) + dir[2] * f64::from(v[2])
}

/// A mesh, grown by half the margin, which stores its last farthest point, because the next is usually near.
pub(super) struct MeshShape<'a> {
    pose: Pose<'a>,
    mesh: &'a Mesh,
    hull: Option<&'a MeshHull>,
    last: Cell<Option<usize>>,
}

impl<'a> MeshShape<'a> {
    /// Creates a mesh grown by half the margin.
    pub(super) fn new(geom: &PlacedGeom<'a>, mesh: &'a Mesh, margin: f64) -> Self {
        MeshShape {
            pose: Pose::new(geom, margin),
            mesh,
            hull: mesh.hull.as_ref().filter(|_| mesh.vert.len() >= CLIMBED),
            last: Cell::new(None),
        }
    }

    /// Searches all vertices; the last one found takes precedence over others at the same height.
    fn search(&self, dir: Vec3) -> usize {
        let mut best = self.last.get().unwrap_or(0);
        let mut highest = match self.last.get() {
            Some(last) => height(dir, self.mesh.vert[last]),
            None => f64::from(-f32::MAX),
        };
        for (i, &v) in self.mesh.vert.iter().enumerate() {
            let h = height(dir, v);
            if h > highest {
                (highest, best) = (h, i);
            }
        }
        self.last.set(Some(best));
        best
    }

    /// Climbs over the hull, from the last corner found.
    fn climb(&self, hull: &MeshHull, dir: Vec3) -> usize {
        let mut best = self.last.get().unwrap_or(0);
        // the start does not count, as in MuJoCo: the climb comes back to it if it is the highest
        let mut highest = f64::from(-f32::MAX);
        loop {
            let from = best;
            (best, highest) = higher(hull, from, dir, highest);
            if best == from {
                break;
            }
        }
        self.last.set(Some(best));
        hull.vert[best] as usize
    }
}

/// Returns the highest neighbour of a corner along a direction with its height, the first of several, or the corner and `highest` if
/// none is higher than that.
#[inline(always)]
fn higher(hull: &MeshHull, from: usize, dir: Vec3, mut highest: f64) -> (usize, f64) {
    let (mut best, points) = (from as u32, hull.points());
    let at = |corner: u32| {
        let [x, y, z, _] = points[corner as usize];
        height(dir, [x, y, z])
    };
    let (fours, rest) = hull.neighbours(from).as_chunks::<4>();
    for corners in fours {
        let heights = corners.map(at);
        // by selection, as no branch could be foretold; of equal ones the first stays
        let higher = |a: (f64, u32), b: (f64, u32)| if b.0 > a.0 { b } else { a };
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| (heights[k], corners[k]));
        let top = higher(higher(a, b), higher(c, d));
        (highest, best) = higher((highest, best), top);
    }
    for &corner in rest {
        let h = at(corner);
        if h > highest {
            (highest, best) = (h, corner);
        }
    }
    (best as usize, highest)
}

impl Support for MeshShape<'_> {
    fn support(&self, dir: Vec3) -> Vec3 {
        let local = mat_t_vec(self.pose.mat, dir);
        let vertex = match self.hull {
            Some(hull) => self.climb(hull, local),
            None => self.search(local),
        };
        self.pose.place(self.mesh.vert[vertex].map(f64::from), dir)
    }

    fn discrete(&self) -> bool {
        self.pose.sharp()
    }
}

/// The farthest vertex in a direction of the mesh's frame, by the search that MuJoCo uses outside its own convex routine: the corner of the hull, if
/// there is one, and the vertex. The search runs over the hull, even a small one, from the corner `start`.
pub(super) fn climb_from(mesh: &Mesh, start: usize, dir: Vec3) -> (Option<usize>, usize) {
    if let Some(hull) = &mesh.hull {
        let mut best = start.min(hull.vert.len().saturating_sub(1));
        let mut highest = height(dir, mesh.vert[hull.vert[best] as usize]);
        loop {
            let before = best;
            (best, highest) = higher(hull, best, dir, highest);
            if best == before {
                return (Some(best), hull.vert[best] as usize);
            }
        }
    }
    let (mut best, mut highest) = (0, -1e10);
    for (i, &v) in mesh.vert.iter().enumerate() {
        let h = height(dir, v);
        if h > highest {
            (highest, best) = (h, i);
        }
    }
    (None, best)
}

/// Finds the contacts of a plane and a mesh: the deepest vertex, and up to two more at some distance from it, among its neighbours
/// on the hull.
pub(super) fn plane_mesh(a: &PlacedGeom, b: &PlacedGeom, mesh: &Mesh, margin: f64, out: &mut Vec<ContactPoint>) {
    let normal = a.axis();
    let down = mat_t_vec(b.mat, scale(normal, -1.0));
    let (corner, deepest) = climb_from(mesh, 0, down);
    let lowest = add(mat_vec(b.mat, mesh.vert[deepest].map(f64::from)), b.pos);
    let dist = dot(normal, sub(lowest, a.pos));
    if dist > margin || dist.is_nan() {
        return;
    }
    let frame = frame::from_normal(normal);
    push_point(out, lowest, normal, dist, frame);
    let reach = PLANE_SPREAD * mesh_radius(mesh);
    match (corner, &mesh.hull) {
        (Some(corner), Some(hull)) => {
            let around = hull.neighbours(corner).iter().map(|&k| hull.vert[k as usize] as usize);
            more(a, b, mesh, (margin, reach), around, out);
        }
        _ => {
            let others = (0..mesh.vert.len()).filter(|&v| v != deepest);
            more(a, b, mesh, (margin, reach), others, out);
        }
    }
}

/// Finds the contacts that MuJoCo adds to that of a plane and an ellipsoid which was fitted to a mesh without a hull: contacts of the vertices, as if
/// they were on the ellipsoid.
pub(super) fn plane_fitted(a: &PlacedGeom, b: &PlacedGeom, mesh: &Mesh, margin: f64, out: &mut Vec<ContactPoint>) {
    if mesh.hull.is_none() {
        let radius = b.size.iter().fold(0.0, |most: f64, &half| most.max(half));
        more(a, b, mesh, (margin, PLANE_SPREAD * radius), 0..mesh.vert.len(), out);
    }
}

/// Appends contacts of the first vertices that are below the plane and at least `reach` from the existing contact.
fn more(
    a: &PlacedGeom,
    b: &PlacedGeom,
    mesh: &Mesh,
    (margin, reach): (f64, f64),
    vertices: impl Iterator<Item = usize>,
    out: &mut Vec<ContactPoint>,
) {
    let Some(&ContactPoint { pos: first, frame, .. }) = out.last() else {
        return;
    };
    let normal = a.axis();
    let down = mat_t_vec(b.mat, scale(normal, -1.0));
    let threshold = dot(normal, sub(b.pos, a.pos)) - margin;
    let mut left = PLANE_CONTACTS - 1;
    for vertex in vertices {
        if left == 0 {
            return;
        }
        let point = add(mat_vec(b.mat, mesh.vert[vertex].map(f64::from)), b.pos);
        if height(down, mesh.vert[vertex]) > threshold && norm(sub(point, first)) >= reach {
            push_point(out, point, normal, dot(normal, sub(point, a.pos)), frame);
            left -= 1;
        }
    }
}

/// Returns the radius of the sphere about the origin around the bounds of a mesh, m.
pub(super) fn mesh_radius(mesh: &Mesh) -> f64 {
    let [low, high] = mesh.bounds;
    let reach: Vec3 = std::array::from_fn(|k| low[k].abs().max(high[k].abs()));
    norm(reach)
}
