//! GJK: the distance of two convex shapes, or the answer that they overlap (Gilbert, Johnson and Keerthi, "A fast
//! procedure for computing the distance between complex objects in three-dimensional space", IEEE Journal of Robotics
//! and Automation 4, 1988; Ericson, "Real-Time Collision Detection", 2005, section 9.5).

use super::nearest::{segment_weights, tetrahedron_weights, triangle_weights};
use super::support::{MinkowskiDifference, Support, Vertex};
use super::{MAXVAL, add_scaled, dot, sub};
use crate::math::{MINVAL, Vec3, cross, norm, scale};

/// A simplex of up to four vertices of the Minkowski difference. Only the first `len` count.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Simplex {
    pub(super) vertices: [Vertex; 4],
    pub(super) len: usize,
}

/// The result of GJK.
#[derive(Clone, Copy, Debug)]
pub(super) struct GjkResult {
    /// Distance, m: 0 if the shapes overlap, [`MAXVAL`] if they are known to be apart or beyond the cutoff.
    pub(super) distance: f64,
    /// Nearest point of the first shape.
    pub(super) a: Vec3,
    /// Nearest point of the second shape.
    pub(super) b: Vec3,
}

/// The limits of a GJK search.
#[derive(Clone, Copy)]
pub(super) struct GjkLimits {
    /// Least improvement of the distance that is worth another iteration, m.
    pub(super) tolerance: f64,
    /// Greatest number of iterations.
    pub(super) iterations: usize,
    /// Distance from which the exact value is not needed, m; at 0 the search only decides whether the shapes overlap.
    pub(super) cutoff: f64,
    /// Whether to stop at once, with nothing known, when the centres coincide.
    pub(super) stop_at_same_centre: bool,
}

/// Runs GJK from the line of centres. The simplex it ends with is left in `simplex`.
pub(super) fn gjk<A: Support, B: Support>(
    shape: &MinkowskiDifference<A, B>,
    centre_a: Vec3,
    centre_b: Vec3,
    limits: &GjkLimits,
    simplex: &mut Simplex,
) -> GjkResult {
    let mut search = GjkSearch {
        // any point of the difference would do; this one is there without a support, and near the origin where the
        // shapes are near each other
        nearest: sub(centre_a, centre_b),
        weights: [1.0, 0.0, 0.0, 0.0],
        count: 0,
    };
    let apart = GjkResult {
        distance: MAXVAL,
        a: centre_a,
        b: centre_b,
    };
    match search.run(shape, limits, simplex) {
        OriginEnclosure::Outside => {
            simplex.len = 0;
            apart
        }
        OriginEnclosure::Inside => {
            simplex.len = 4;
            GjkResult { distance: 0.0, ..apart }
        }
        OriginEnclosure::Unknown => {
            let GjkSearch {
                nearest,
                weights,
                count,
            } = search;
            simplex.len = count;
            GjkResult {
                distance: norm(nearest),
                a: combine(&weights, &simplex.vertices, count, |v| v.a).unwrap_or(centre_a),
                b: combine(&weights, &simplex.vertices, count, |v| v.b).unwrap_or(centre_b),
            }
        }
    }
}

/// A GJK search in progress.
struct GjkSearch {
    /// Point of the difference nearest to the origin so far.
    nearest: Vec3,
    /// Weights of the vertices that make up that point.
    weights: [f64; 4],
    /// Number of those vertices.
    count: usize,
}

impl GjkSearch {
    /// Searches until the nearest point is found, or until a tetrahedron or plane decides the question and leaves the nearest point unknown.
    #[inline(always)]
    fn run<A: Support, B: Support>(
        &mut self,
        shape: &MinkowskiDifference<A, B>,
        limits: &GjkLimits,
        simplex: &mut Simplex,
    ) -> OriginEnclosure {
        let mut may_test_tetrahedron = !limits.wants_distance();
        let tolerance2 = limits.square_tolerance(shape);
        let mut iteration = 0;
        while iteration < limits.iterations {
            let (at_origin, dir) = towards_origin(self.nearest);
            simplex.vertices[self.count] = shape.support(dir);
            let newest = simplex.vertices[self.count].point;

            // twice the product bounds by how much the square of the distance is above the least (the duality gap of
            // Frank and Wolfe for |x|^2, whose gradient is 2 x). At the origin it is 0 whatever the shapes are, hence
            // `may_stop`
            let may_stop = iteration > 0 || !at_origin || limits.stop_at_same_centre;
            if may_stop && 2.0 * dot(self.nearest, sub(self.nearest, newest)) < tolerance2 {
                // the start point is not a vertex; callers read at least one
                if iteration == 0 {
                    self.count = 1;
                }
                break;
            }
            if limits.separates(self.nearest, newest) {
                return OriginEnclosure::Outside;
            }

            // whether the origin is inside can be told from a tetrahedron alone, without nearest points; but not how
            // far away the shapes are, so a search for the distance does not ask
            if self.count == 3 && may_test_tetrahedron {
                match enclose_origin(shape, simplex, &mut iteration, limits.iterations) {
                    // undecided: the weights go on from the tetrahedron as it was
                    OriginEnclosure::Unknown => may_test_tetrahedron = false,
                    known => return known,
                }
            }

            self.weights = simplex_weights(&simplex.vertices, self.count + 1);
            self.count = drop_weightless(&mut simplex.vertices, &mut self.weights);
            let next = combine(&self.weights, &simplex.vertices, self.count, |v| v.point).unwrap_or([0.0; 3]);
            // a point that does not move asks for the same support again, for ever
            if (0..3).all(|k| (next[k] - self.nearest[k]).abs() < MINVAL) {
                break;
            }
            self.nearest = next;
            // a tetrahedron of which no vertex can be spared holds the origin
            if self.count == 4 {
                break;
            }
            iteration += 1;
        }
        OriginEnclosure::Unknown
    }
}

/// Returns whether a point is at the origin, and the unit direction from it to the origin (-x if it is there).
#[inline(always)]
fn towards_origin(point: Vec3) -> (bool, Vec3) {
    let length2 = dot(point, point);
    // NaN ends here as well, so that it never becomes the direction of a support
    let at_origin = length2 <= MINVAL * MINVAL || length2.is_nan();
    let dir = if at_origin {
        [-1.0, 0.0, 0.0]
    } else {
        scale(scale(point, 1.0 / length2.sqrt()), -1.0)
    };
    (at_origin, dir)
}

impl GjkLimits {
    /// Returns whether the distance is needed, and not only whether the shapes overlap.
    #[inline(always)]
    fn wants_distance(&self) -> bool {
        self.cutoff > 0.0
    }

    /// Returns the square of the tolerance; 0 where the search, among finitely many points, ends by itself.
    #[inline(always)]
    fn square_tolerance<A: Support, B: Support>(&self, shape: &MinkowskiDifference<A, B>) -> f64 {
        if shape.a.discrete() && shape.b.discrete() {
            0.0
        } else {
            self.tolerance * self.tolerance
        }
    }

    /// Returns whether the plane through the newest vertex across the direction from the nearest point separates the
    /// shapes by enough to end the search.
    #[inline(always)]
    fn separates(&self, nearest: Vec3, newest: Vec3) -> bool {
        // the newest vertex is the farthest towards the origin: if it is still on this side of the origin, all are. Its
        // height over the origin, the product over |nearest|, is then a lower bound of the distance; squares spare the
        // root
        let overlap = dot(nearest, newest);
        let known = !self.wants_distance()
            || self.cutoff < MAXVAL && overlap * overlap / dot(nearest, nearest) >= self.cutoff * self.cutoff;
        overlap > 0.0 && known
    }
}

/// Removes the vertices without weight, and returns the number of the others.
#[inline(always)]
fn drop_weightless(vertices: &mut [Vertex; 4], weights: &mut [f64; 4]) -> usize {
    let mut count = 0;
    for k in 0..4 {
        if weights[k] != 0.0 {
            // the vertices left keep their order, as the weights prefer the newer of two that are equally near
            if count != k {
                vertices[count] = vertices[k];
                weights[count] = weights[k];
            }
            count += 1;
        }
    }
    count
}

#[inline(always)]
fn simplex_weights(vertices: &[Vertex; 4], count: usize) -> [f64; 4] {
    let [a, b, c, d] = [
        vertices[0].point,
        vertices[1].point,
        vertices[2].point,
        vertices[3].point,
    ];
    match count {
        1 => [1.0, 0.0, 0.0, 0.0],
        2 => {
            let w = segment_weights(a, b);
            [w[0], w[1], 0.0, 0.0]
        }
        3 => {
            let w = triangle_weights(a, b, c);
            [w[0], w[1], w[2], 0.0]
        }
        _ => tetrahedron_weights([a, b, c, d]),
    }
}

/// Returns the weighted sum of one point of each of the first `count` vertices; `None` without vertices.
#[inline(always)]
fn combine(weights: &[f64; 4], vertices: &[Vertex; 4], count: usize, point: impl Fn(&Vertex) -> Vec3) -> Option<Vec3> {
    if count == 0 {
        return None;
    }
    let mut sum = scale(point(&vertices[0]), weights[0]);
    for k in 1..count {
        sum = add_scaled(sum, point(&vertices[k]), weights[k]);
    }
    Some(sum)
}

/// The position of the origin relative to the Minkowski difference.
enum OriginEnclosure {
    Inside,
    Outside,
    Unknown,
}

/// Moves a tetrahedron, vertex by vertex, until it contains the origin or a vertex shows that none can. The simplex is
/// changed only in the first case. Counts in `iteration`.
fn enclose_origin<A: Support, B: Support>(
    shape: &MinkowskiDifference<A, B>,
    simplex: &mut Simplex,
    iteration: &mut usize,
    iterations: usize,
) -> OriginEnclosure {
    /// Corners of the face opposite each vertex, such that its normal points outwards.
    const FACES: [[usize; 3]; 4] = [[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]];
    let mut vertices = simplex.vertices;
    while *iteration < iterations {
        // signed distances of the faces: positive where the origin is on the inner side
        let mut normals = [[0.0; 3]; 4];
        let mut distances = [0.0; 4];
        for (slot, [a, b, c]) in FACES.into_iter().enumerate() {
            let (a, b, c) = (vertices[a].point, vertices[b].point, vertices[c].point);
            let normal = cross(sub(c, a), sub(b, a));
            let length2 = dot(normal, normal);
            // a face without area, or too large to be squared, has no normal; at the distance MAXVAL it is never the worst
            if length2 > MINVAL * MINVAL && length2 < MAXVAL * MAXVAL {
                normals[slot] = scale(normal, 1.0 / length2.sqrt());
                distances[slot] = dot(normals[slot], a);
            } else {
                normals[slot] = normal;
                distances[slot] = MAXVAL;
            }
        }
        // the origin is in the plane of a face, and neither side of it
        if distances.contains(&0.0) {
            return OriginEnclosure::Unknown;
        }

        // the face the origin is farthest outside of
        let i = if distances[0] < distances[1] { 0 } else { 1 };
        let j = if distances[2] < distances[3] { 2 } else { 3 };
        let worst = if distances[i] < distances[j] { i } else { j };
        if distances[worst] > 0.0 {
            simplex.vertices = vertices;
            return OriginEnclosure::Inside;
        }
        // the shape has to reach beyond this face to hold the origin: the support says whether it does, and takes the
        // place of the vertex behind the face
        vertices[worst] = shape.support(normals[worst]);
        if dot(normals[worst], vertices[worst].point) < 0.0 {
            return OriginEnclosure::Outside;
        }
        // the new vertex is on the other side of the face, which turns the tetrahedron inside out; an exchange turns it
        // back
        vertices.swap((worst + 1) & 3, (worst + 2) & 3);
        *iteration += 1;
    }
    OriginEnclosure::Unknown
}
