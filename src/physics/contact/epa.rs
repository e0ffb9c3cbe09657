//! EPA: the depth of two overlapping convex shapes, from the simplex that GJK ended with (van den Bergen, "Proximity
//! queries and penetration depth computation on 3D game objects", Game Developers Conference 2001).

use super::gjk::Simplex;
use super::nearest::{Projection, agree, combine3};
use super::polytope::{Edge, MAX_FACES, Polytope, after};
use super::support::{MinkowskiDifference, Support};
use super::{MAXVAL, dot, sub};
use crate::math::{MINVAL, Vec3, cross, mat_vec, norm, scale};

/// Initial bound: the largest single-precision number.
const UNBOUNDED: f64 = f32::MAX as f64;

/// The overlap of two shapes: `a - b` has the length `depth` and points from the first shape to the second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overlap {
    /// Depth, m, positive.
    pub(super) depth: f64,
    /// Deepest point of the first shape, m.
    pub(super) a: Vec3,
    /// Deepest point of the second shape, m.
    pub(super) b: Vec3,
    /// The face of the polytope that it was read from.
    pub(super) face: u16,
}

/// Expands the simplex (two to four vertices) until its nearest face is on the surface of the Minkowski difference.
/// `None` if the start is degenerate or the polytope breaks down.
pub(super) fn epa<A: Support, B: Support>(
    shape: &MinkowskiDifference<A, B>,
    simplex: &Simplex,
    tolerance: f64,
    iterations: usize,
    polytope: &mut Polytope,
) -> Option<Overlap> {
    let mut expansion = PolytopeExpansion { shape, polytope };
    expansion.polytope.clear();
    match simplex.len {
        2 => expansion.start_from_segment(simplex),
        3 => expansion.start_from_triangle(simplex),
        _ => expansion.start_from_tetrahedron(simplex),
    }?;
    let nearest = expansion.expand(tolerance, iterations)?;
    Some(expansion.witness(nearest))
}

/// A polytope, and the shape inside which it grows.
struct PolytopeExpansion<'a, A, B> {
    shape: &'a MinkowskiDifference<A, B>,
    polytope: &'a mut Polytope,
}

/// Vertices and neighbours of a start face.
type StartFace = ([u16; 3], [u16; 3]);

impl<A: Support, B: Support> PolytopeExpansion<'_, A, B> {
    /// Appends the support along a direction that is divided by `length`.
    #[inline(always)]
    fn add_support(&mut self, dir: Vec3, length: f64) -> u16 {
        // a direction without length has none; from any other the support is on the surface as well
        let unit = if length > MINVAL {
            [dir[0] / length, dir[1] / length, dir[2] / length]
        } else {
            [1.0, 0.0, 0.0]
        };
        let vertex = self.shape.support(unit);
        self.polytope.add_vertex(vertex)
    }

    /// Adds the start faces and lists them, or stops at the first one that contains the origin and returns its vertices.
    fn add_start_faces(&mut self, faces: &[StartFace]) -> Result<(), [u16; 3]> {
        for &(vertices, neighbours) in faces {
            // a face through the origin has no foot to expand along, and its distance of 0 would end the search as a
            // depth of 0; the pyramids over that face enclose the origin instead
            if self.polytope.add_face(vertices, neighbours) < MINVAL {
                return Err(vertices);
            }
        }
        Ok(())
    }

    fn list_start_faces(&mut self) {
        for face in 0..self.polytope.faces.len() {
            self.polytope.list(face as u16, true);
        }
    }

    /// Restarts from a triangle of the polytope.
    fn restart(&mut self, triangle: [u16; 3]) -> Option<()> {
        let mut simplex = Simplex::default();
        for (slot, vertex) in triangle.into_iter().enumerate() {
            simplex.vertices[slot] = self.polytope.vertices[vertex as usize];
        }
        self.polytope.clear();
        self.start_from_triangle(&simplex)
    }

    /// Starts from two vertices: three supports around the segment make a double pyramid.
    fn start_from_segment(&mut self, simplex: &Simplex) -> Option<()> {
        /// Cosine and sine of 120 degrees.
        const COS: f64 = -0.5;
        const SIN: f64 = 0.86602540378;
        let [p, q, ..] = &simplex.vertices;
        let edge = sub(q.point, p.point);

        // crossed with the axis most across the segment, since with one along it nothing would be left of the product
        let mut smallest = MAXVAL;
        let mut axis = 0;
        for (k, component) in edge.iter().enumerate() {
            if component.abs() < smallest {
                smallest = component.abs();
                axis = k;
            }
        }
        let mut across = [0.0; 3];
        across[axis] = 1.0;
        let dir1 = cross(across, edge);

        // GJK ended on the segment because the origin is on it: three directions about it, 120 degrees apart, enclose
        // the origin whichever way the first one points; the turn is Rodrigues' formula
        let length = norm(edge);
        let [x, y, z] = [edge[0] / length, edge[1] / length, edge[2] / length];
        let turn = 1.0 - COS;
        let rotation = [
            COS + x * x * turn,
            x * y * turn - z * SIN,
            x * z * turn + y * SIN,
            y * x * turn + z * SIN,
            COS + y * y * turn,
            y * z * turn - x * SIN,
            x * z * turn - y * SIN,
            y * z * turn + x * SIN,
            COS + z * z * turn,
        ];
        let dir2 = mat_vec(&rotation, dir1);
        let dir3 = mat_vec(&rotation, dir2);

        self.polytope.add_simplex_vertex(p);
        self.polytope.add_simplex_vertex(q);
        for dir in [dir1, dir2, dir3] {
            self.add_support(dir, norm(dir));
        }
        let faces = [
            ([0, 2, 3], [1, 3, 2]),
            ([0, 4, 2], [2, 4, 0]),
            ([0, 3, 4], [0, 5, 1]),
            ([1, 3, 2], [5, 0, 4]),
            ([1, 2, 4], [3, 1, 5]),
            ([1, 4, 3], [4, 2, 3]),
        ];
        if let Err(triangle) = self.add_start_faces(&faces) {
            return self.restart(triangle);
        }
        self.list_start_faces();
        Some(())
    }

    /// Starts from three vertices: the supports on either side make a double pyramid.
    fn start_from_triangle(&mut self, simplex: &Simplex) -> Option<()> {
        let [p, q, r, _] = &simplex.vertices;
        let (a, b, c) = (p.point, q.point, r.point);
        let normal = cross(sub(b, a), sub(c, a));
        let length = norm(normal);
        // three vertices on a line have no side to put a pyramid on
        if length < MINVAL {
            return None;
        }
        for vertex in [p, q, r] {
            self.polytope.add_simplex_vertex(vertex);
        }
        // the origin is in the triangle: one pyramid would leave it in the base, two hold it between them
        let below = self.add_support(scale(normal, -1.0), length);
        let above = self.add_support(normal, length);

        // a support in the triangle itself means that the shape is flat: the pyramid has no volume for the origin to be
        // in
        for vertex in [above, below] {
            let point = self.polytope.point(vertex);
            let weights = Projection::of(a, b, c).weights(a, b, c, point);
            let outside = weights.iter().any(|&w| w < 0.0);
            if !outside && norm(sub(combine3(weights, a, b, c), point)) < MINVAL {
                return None;
            }
        }
        let faces = [
            ([above, 0, 1], [1, 3, 2]),
            ([above, 2, 0], [2, 4, 0]),
            ([above, 1, 2], [0, 5, 1]),
            ([below, 1, 0], [5, 0, 4]),
            ([below, 0, 2], [3, 1, 5]),
            ([below, 2, 1], [4, 2, 3]),
        ];
        // no restart from here, as it would lead here again
        self.add_start_faces(&faces).ok()?;
        self.list_start_faces();
        Some(())
    }

    /// Starts from four vertices around the origin.
    fn start_from_tetrahedron(&mut self, simplex: &Simplex) -> Option<()> {
        for vertex in &simplex.vertices {
            self.polytope.add_simplex_vertex(vertex);
        }
        let faces = [
            ([0, 1, 2], [1, 3, 2]),
            ([0, 3, 1], [2, 3, 0]),
            ([0, 2, 3], [0, 3, 1]),
            ([3, 2, 1], [2, 0, 1]),
        ];
        if let Err(triangle) = self.add_start_faces(&faces) {
            return self.restart(triangle);
        }
        // GJK may have kept four vertices by rounding alone; from an origin outside, the feet of some faces point
        // inwards, and their distances bound nothing
        for k in 0..4 {
            let [a, b, c, opposite] = [0, 1, 2, 3].map(|n| self.polytope.point((k + n) & 3));
            let normal = cross(sub(b, a), sub(c, a));
            if !agree(dot(normal, sub(opposite, a)), dot(normal, scale(a, -1.0))) {
                return None;
            }
        }
        self.list_start_faces();
        Some(())
    }

    /// Expands the polytope by support points beyond its nearest face until that brings no improvement. Returns the nearest face.
    fn expand(&mut self, tolerance: f64, iterations: usize) -> Option<u16> {
        let mut upper = UNBOUNDED;
        let mut nearest: Option<u16> = None;
        for _ in 0..iterations {
            // the polytope is inside the shape, so the surface is at least as far as its nearest face: a lower bound of
            // the depth
            let previous = nearest;
            let mut lower = UNBOUNDED;
            for open in &self.polytope.open {
                if open.distance < lower {
                    lower = open.distance;
                    nearest = Some(open.face);
                }
            }
            let face = nearest?;
            // only rounding brings the bounds past each other; the face before was consistent with both
            if lower > upper {
                nearest = previous;
                break;
            }
            // the origin is on the surface: there is no direction to go on in, and no depth
            if lower <= 0.0 {
                break;
            }

            // pushing the shapes apart along this normal takes as much as the support is high: an upper bound of the
            // depth
            let foot = self.polytope.faces[face as usize].foot;
            let apex = self.add_support(foot, lower);
            let w = self.polytope.point(apex);
            let bound = dot(foot, w) / lower;
            if bound < upper {
                upper = bound;
            }
            // bounds that meet: the nearest face is on the surface of the shape
            if upper - lower < tolerance {
                break;
            }

            // replace the faces that the new vertex sees by a fan around it
            self.polytope.carve(face, w);
            let edges = self.polytope.horizon.len();
            // a hole in a closed surface has three edges at least; rounding has torn this one
            if edges < 3 {
                return None;
            }
            // the face is carved out by now, but its foot and vertices are still a lower bound of the depth
            if edges + self.polytope.faces.len() > MAX_FACES {
                break;
            }
            self.add_fan(apex, lower, upper)?;
            if self.polytope.open.is_empty() {
                break;
            }
        }
        nearest
    }

    /// Adds faces from the new vertex to each edge of the horizon; those that can no longer be the nearest are not listed. `None` if a face contains
    /// the origin.
    #[inline(always)]
    fn add_fan(&mut self, apex: u16, lower: f64, upper: f64) -> Option<()> {
        let first = self.polytope.faces.len();
        let count = self.polytope.horizon.len();
        let number = |k: usize| (first + k) as u16;
        for k in 0..count {
            let Edge { face, edge } = self.polytope.horizon[k];
            let outer = &mut self.polytope.faces[face as usize];
            let (start, end) = (outer.vertices[edge as usize], outer.vertices[after(edge) as usize]);
            outer.neighbours[edge as usize] = number(k);
            // `carve` lists the horizon in the order around the hole, so that the fan's neighbours are those next in it
            let before = number(if k == 0 { count - 1 } else { k - 1 });
            let after = number(if k + 1 == count { 0 } else { k + 1 });
            self.polytope.add_face([apex, end, start], [before, face, after]);
        }
        // in a second pass, so that no branch waits for a distance
        for k in 0..count {
            let distance = self.polytope.faces[first + k].distance;
            // a face through the origin, or without area: its foot says nothing about the depth
            if distance == 0.0 {
                return None;
            }
            // a face beyond the upper bound never becomes the nearest; one below the lower bound owes that to rounding,
            // since a convex polytope that grows does not come nearer
            self.polytope.list(number(k), distance >= lower && distance <= upper);
        }
        Some(())
    }

    /// Returns the depth and the deepest points from the nearest face.
    fn witness(&self, nearest: u16) -> Overlap {
        let face = &self.polytope.faces[nearest as usize];
        let [p, q, r] = face.vertices.map(|v| &self.polytope.vertices[v as usize]);
        // points of the difference are differences of points, so one set of weights gives the points of both shapes
        let projection = Projection::of(p.point, q.point, r.point);
        let weights = projection.weights(p.point, q.point, r.point, face.foot);
        Overlap {
            depth: face.distance,
            a: combine3(weights, p.a, q.a, r.a),
            b: combine3(weights, p.b, q.b, r.b),
            face: nearest,
        }
    }
}
