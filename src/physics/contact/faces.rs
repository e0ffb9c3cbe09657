//! Several contacts of two polytopes, boxes or hulls of meshes, from the one that EPA found: the face of either that it lies on, or an edge and
//! a face, clipped against each other (MuJoCo's `multiccd`).

use super::epa::Overlap;
use super::polytope::Polytope;
use super::{PlacedGeom, add_scaled, dot, sub};
use crate::math::{MINVAL, Vec3, add, cross, mat_t_vec, mat_vec, norm, scale, unit};
use crate::model::{GeomType, Mesh, MeshPolygons};

/// Cosine from which two faces count as parallel, and sine up to which an edge counts as parallel to a face: those of 0.0016 rad (`mjFACE_TOL`,
/// `mjEDGE_TOL`).
const PARALLEL_FACES: f64 = 0.99999872;
const PARALLEL_EDGE: f64 = 0.00159999931;
/// Maximum number of corners of a polygon, and of polygons of a vertex (`mjMAX_POLYVERT`).
const MAX_CORNERS: usize = 150;
/// Maximum number of contacts. If there are more corners, those of the greatest quadrilateral are kept.
const MAX_CONTACTS: usize = 4;

/// Buffers for finding the faces and edges of a multi-contact (multiccd) search.
#[derive(Clone, Debug, Default)]
pub(super) struct MulticcdScratch {
    /// Candidates for the contact face or edge of either shape.
    candidates: [Vec<Candidate>; 2],
    /// Corners of the face that clips.
    clip: Vec<Vec3>,
    /// Corners of the polygon that is clipped, before and after a plane.
    polygon: Vec<Vec3>,
    clipped: Vec<Vec3>,
}

/// A normal of a face, or the direction of an edge.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    along: Vec3,
    of: CandidateSource,
}

#[derive(Clone, Copy, Debug)]
enum CandidateSource {
    /// The face of this number.
    Face(usize),
    /// An edge to this point.
    Edge(Vec3),
}

/// The vertices of one shape at the corners of EPA's nearest face. One, two or three of them are different.
#[derive(Clone, Copy)]
struct ClosestFeature {
    points: [Vec3; 3],
    vertices: [usize; 3],
    dimension: usize,
}

impl ClosestFeature {
    fn new(shape: &Polyhedron, points: [Vec3; 3]) -> Self {
        let (mut points, mut vertices) = (points, points.map(|point| shape.vertex(point)));
        let [a, b, c] = vertices;
        let dimension = match () {
            () if a != b && (c == a || c == b) => 2,
            () if a != b => 3,
            () if a != c => {
                (points[1], vertices[1]) = (points[2], c);
                2
            }
            () => 1,
        };
        Self {
            points,
            vertices,
            dimension,
        }
    }
}

/// Finds the points between two polytopes: on the second, each with the same step to the first. `None` if no faces, or face and edge, are
/// parallel, or if clipping leaves nothing: then the contact that EPA found stays the only one.
pub(super) fn clip<'s>(
    a: &PlacedGeom,
    b: &PlacedGeom,
    overlap: &Overlap,
    polytope: &Polytope,
    space: &'s mut MulticcdScratch,
) -> Option<(&'s [Vec3], Vec3)> {
    let (a, b) = (Polyhedron::new(a)?, Polyhedron::new(b)?);
    let corners = polytope.faces.get(usize::from(overlap.face))?.vertices;
    let corners = corners.map(|k| &polytope.vertices[usize::from(k)]);
    let first = ClosestFeature::new(&a, corners.map(|vertex| vertex.a));
    let second = ClosestFeature::new(&b, corners.map(|vertex| vertex.b));
    let depth = norm(sub(overlap.b, overlap.a));

    let [ours, theirs] = &mut space.candidates;
    a.normals(&first, ours);
    b.normals(&second, theirs);
    if let Some((i, j)) = opposite(ours, theirs) {
        a.corners(ours[i].of, first.points[0], &mut space.clip);
        b.corners(theirs[j].of, second.points[0], &mut space.polygon);
        let step = scale(theirs[j].along, depth);
        let across = ours[i].along;
        return space.cut(across).map(|points| (points, step));
    }
    // an edge of the shape of which less is known lies on a face of the other
    if first.dimension < 3 && first.dimension <= second.dimension {
        a.edges(&first, ours);
        let (i, j) = along(ours, theirs)?;
        b.corners(theirs[j].of, second.points[0], &mut space.clip);
        a.corners(ours[i].of, corners[0].a, &mut space.polygon);
        let across = theirs[j].along;
        return space.cut(across).map(|points| (points, scale(across, depth)));
    }
    if second.dimension < 3 {
        b.edges(&second, theirs);
        let (i, j) = along(theirs, ours)?;
        a.corners(ours[j].of, first.points[0], &mut space.clip);
        b.corners(theirs[i].of, corners[0].b, &mut space.polygon);
        let across = ours[j].along;
        return space.cut(across).map(|points| (points, scale(across, -depth)));
    }
    None
}

/// Finds the first two normals that face each other.
fn opposite(ours: &[Candidate], theirs: &[Candidate]) -> Option<(usize, usize)> {
    pairs(ours.len(), theirs.len()).find(|&(i, j)| dot(ours[i].along, theirs[j].along) < -PARALLEL_FACES)
}

/// Finds the first face that is parallel to an edge, and the first such edge.
fn along(edges: &[Candidate], faces: &[Candidate]) -> Option<(usize, usize)> {
    let found =
        pairs(faces.len(), edges.len()).find(|&(j, i)| dot(edges[i].along, faces[j].along).abs() < PARALLEL_EDGE);
    found.map(|(j, i)| (i, j))
}

fn pairs(first: usize, second: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..first).flat_map(move |i| (0..second).map(move |j| (i, j)))
}

impl MulticcdScratch {
    /// Cuts the polygon by the planes through the edges of the clipping face, across it, and keeps at most [`MAX_CONTACTS`] corners
    /// (Sutherland and Hodgman, "Reentrant polygon clipping", Communications of the ACM 17, 1974).
    fn cut(&mut self, across: Vec3) -> Option<&[Vec3]> {
        let (clip, count) = (&self.clip, self.clip.len());
        if count < 3 {
            return None;
        }
        for k in 0..count {
            let (from, to) = (clip[k], clip[(k + 1) % count]);
            // the third point of the plane is beside the edge, and its difference from it has rounding errors of its own
            let plane = cross(sub(to, from), sub(add(from, across), from));
            let height = dot(plane, from);
            let inside = |p: Vec3| dot(sub(p, from), plane) > 0.0;
            self.clipped.clear();
            for i in 0..self.polygon.len() {
                let (p, q) = (self.polygon[i], self.polygon[(i + 1) % self.polygon.len()]);
                let (p_in, q_in) = (inside(p), inside(q));
                if p_in != q_in {
                    let between = sub(q, p);
                    let t = (height - dot(plane, p)) / dot(plane, between);
                    if (0.0..=1.0).contains(&t) {
                        self.clipped.push(add_scaled(p, between, t));
                    }
                }
                if q_in {
                    self.clipped.push(q);
                }
            }
            std::mem::swap(&mut self.polygon, &mut self.clipped);
        }
        self.clipped.clear();
        if self.polygon.len() > MAX_CONTACTS {
            let corners = greatest(&self.polygon);
            self.clipped.extend(corners.map(|k| self.polygon[k]));
        } else {
            for &point in &self.polygon {
                let known = |other: &Vec3| (0..3).all(|k| (other[k] - point[k]).abs() < MINVAL);
                if !self.clipped.iter().any(known) {
                    self.clipped.push(point);
                }
            }
        }
        (!self.clipped.is_empty()).then_some(&self.clipped)
    }
}

/// Finds four corners of a convex polygon with a great area between them. The first corner goes around the polygon once; the others advance as long
/// as the area grows.
fn greatest(polygon: &[Vec3]) -> [usize; 4] {
    let count = polygon.len();
    let next = |k: usize| if k + 1 == count { 0 } else { k + 1 };
    let area = |[a, b, c, d]: [usize; 4]| {
        let [a, b, c, d] = [a, b, c, d].map(|k| polygon[k]);
        let halves = add(cross(sub(d, a), sub(b, d)), cross(sub(c, b), sub(a, c)));
        0.5 * norm(halves)
    };
    let mut at = [0, 1, 2, 3];
    let (mut best, mut most) = (at, area(at));
    for first in 0..count {
        at[0] = first;
        // the last corner leads; after each of its steps the two before it follow
        while step(&mut at, 3, &mut most, next, area) {
            best = at;
            for corner in [2, 1] {
                while step(&mut at, corner, &mut most, next, area) {
                    best = at;
                }
            }
        }
        for corner in 1..4 {
            if at[corner] != at[corner - 1] {
                break;
            }
            at[corner] = next(at[corner]);
        }
    }
    best
}

/// Moves a corner to the next vertex if that makes the area greater.
fn step(
    at: &mut [usize; 4],
    corner: usize,
    most: &mut f64,
    next: impl Fn(usize) -> usize,
    area: impl Fn([usize; 4]) -> f64,
) -> bool {
    let mut moved = *at;
    moved[corner] = next(moved[corner]);
    let size = area(moved);
    // so that NaN ends the search
    let grows = size > *most;
    if grows {
        (*at, *most) = (moved, size);
    }
    grows
}

/// A box or a mesh.
struct Polyhedron<'a> {
    geom: &'a PlacedGeom<'a>,
    mesh: Option<(&'a Mesh, &'a MeshPolygons)>,
}

impl<'a> Polyhedron<'a> {
    /// Creates a polytope from a box, or from a mesh with polygons.
    fn new(geom: &'a PlacedGeom<'a>) -> Option<Self> {
        let mesh = match geom.kind {
            GeomType::Box => None,
            GeomType::Mesh => {
                let mesh = geom.mesh?;
                Some((mesh, &mesh.polygons))
            }
            _ => return None,
        };
        Some(Self { geom, mesh })
    }

    fn place(&self, local: Vec3) -> Vec3 {
        add(mat_vec(self.geom.mat, local), self.geom.pos)
    }

    fn vertex_at(&self, mesh: &Mesh, vertex: u32) -> Vec3 {
        self.place(mesh.vert[vertex as usize].map(f64::from))
    }

    /// Returns the vertex of a support; for a box, its bits are the sides along x, y and z.
    fn vertex(&self, point: Vec3) -> usize {
        match self.mesh {
            None => {
                let local = mat_t_vec(self.geom.mat, sub(point, self.geom.pos));
                (0..3).map(|k| usize::from(local[k] > 0.0) << k).sum()
            }
            // supports are vertices, placed in the same way, so that bits are equal; of two at one place the hull has one, with its polygons
            Some((mesh, _)) => {
                let here = |&vertex: &u32| self.vertex_at(mesh, vertex) == point;
                let found = match &mesh.hull {
                    Some(hull) => hull.vert.iter().copied().find(here),
                    None => (0..mesh.vert.len() as u32).find(here),
                };
                found.unwrap_or(0) as usize
            }
        }
    }

    /// Lists the faces on which the vertices of a feature are.
    fn normals(&self, feature: &ClosestFeature, out: &mut Vec<Candidate>) {
        out.clear();
        match self.mesh {
            None => self.box_normals(feature, out),
            Some((_, polygons)) => {
                let [a, b, c] = feature.vertices.map(|vertex| polygons.at(vertex));
                let common = |polygon: &&u32| b.contains(polygon);
                let listed = |&polygon: &u32| self.polygon(polygons, polygon);
                match feature.dimension {
                    1 => out.extend(a.iter().take(MAX_CORNERS).map(listed)),
                    2 => out.extend(a.iter().filter(common).take(2).map(listed)),
                    // no more than two faces hold an edge, and one of them the third vertex
                    _ => {
                        let edge = a.iter().filter(common).take(2);
                        out.extend(edge.filter(|polygon| c.contains(polygon)).take(1).map(listed));
                    }
                }
            }
        }
    }

    fn polygon(&self, polygons: &MeshPolygons, polygon: u32) -> Candidate {
        Candidate {
            along: mat_vec(self.geom.mat, polygons.normal[polygon as usize]),
            of: CandidateSource::Face(polygon as usize),
        }
    }

    /// Lists the sides of a box on which all vertices of a feature are, in the order of the axes.
    fn box_normals(&self, feature: &ClosestFeature, out: &mut Vec<Candidate>) {
        let vertices = &feature.vertices[..feature.dimension];
        for axis in 0..3 {
            let upper = |vertex: &usize| vertex >> axis & 1 == 1;
            let count = vertices.iter().filter(|vertex| upper(vertex)).count();
            let sign = match count {
                0 => -1.0,
                _ if count == vertices.len() => 1.0,
                _ => continue,
            };
            let mut local = [0.0; 3];
            local[axis] = sign;
            out.push(Candidate {
                along: mat_vec(self.geom.mat, local),
                of: CandidateSource::Face(2 * axis + usize::from(sign < 0.0)),
            });
        }
    }

    /// Lists the edges on which a feature of one or two vertices may be.
    fn edges(&self, feature: &ClosestFeature, out: &mut Vec<Candidate>) {
        out.clear();
        let [from, to, _] = feature.points;
        let mut push = |end: Vec3| {
            let along = unit(sub(end, from)).0;
            out.push(Candidate {
                along,
                of: CandidateSource::Edge(end),
            });
        };
        if feature.dimension == 2 {
            return push(to);
        }
        let vertex = feature.vertices[0];
        match self.mesh {
            None => {
                let corner: Vec3 = std::array::from_fn(|k| {
                    let half = self.geom.size[k];
                    if vertex >> k & 1 == 1 { half } else { -half }
                });
                for axis in 0..3 {
                    let mut other = corner;
                    other[axis] = -other[axis];
                    push(self.place(other));
                }
            }
            Some((mesh, polygons)) => {
                for &polygon in polygons.at(vertex).iter().take(MAX_CORNERS) {
                    let corners = polygons.corners(polygon as usize);
                    if let Some(at) = corners.iter().position(|&corner| corner as usize == vertex) {
                        let before = if at == 0 { corners.len() } else { at } - 1;
                        // MuJoCo 3.3.0 takes the place among the corners for the vertex
                        push(self.vertex_at(mesh, before as u32));
                    }
                }
            }
        }
    }

    /// Writes the corners of a face, clockwise from outside, or the ends of an edge that begins at `from`.
    fn corners(&self, of: CandidateSource, from: Vec3, out: &mut Vec<Vec3>) {
        out.clear();
        match (of, self.mesh) {
            (CandidateSource::Edge(to), _) => out.extend([from, to]),
            (CandidateSource::Face(face), Some((mesh, polygons))) => {
                let corners = polygons.corners(face);
                let corners = &corners[..corners.len().min(MAX_CORNERS)];
                out.extend(corners.iter().rev().map(|&vertex| self.vertex_at(mesh, vertex)));
            }
            (CandidateSource::Face(side), None) => {
                let corners = BOX_CORNERS[side];
                out.extend(corners.map(|signs| self.place(std::array::from_fn(|k| signs[k] * self.geom.size[k]))));
            }
        }
    }
}

/// Corners of the sides of a box, +x, -x, +y, -y, +z, -z, in the order in which MuJoCo goes around them.
const BOX_CORNERS: [[Vec3; 4]; 6] = [
    [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, -1.0, 1.0]],
    [
        [-1.0, 1.0, -1.0],
        [-1.0, 1.0, 1.0],
        [-1.0, -1.0, 1.0],
        [-1.0, -1.0, -1.0],
    ],
    [[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]],
    [
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, -1.0, -1.0],
    ],
    [[-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]],
    [
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
    ],
];
