//! GJK: the distance of two convex shapes, or whether they overlap.

use super::nearest::{segment_weights, tetrahedron_weights, triangle_weights};
use super::support::{Difference, Support, Vertex};
use super::{BIG, add_scaled, dot, sub};
use crate::math::{MINVAL, Vec3, cross, norm, scale};

/// Up to four vertices of the Minkowski difference. Only the first `len` count.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Simplex {
    pub(super) vertices: [Vertex; 4],
    pub(super) len: usize,
}

/// What GJK found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest {
    /// Distance, m: 0 when the shapes overlap, [`BIG`] when they are known to be apart or beyond the cutoff.
    pub(super) distance: f64,
    /// Nearest point of the first shape.
    pub(super) a: Vec3,
    /// Nearest point of the second shape.
    pub(super) b: Vec3,
}

/// How GJK ends.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// The distance counts as found when it can improve by no more than this, m.
    pub(super) tolerance: f64,
    /// Greatest number of iterations.
    pub(super) iterations: usize,
    /// Distances from here on need not be known, m. At 0 the question is only whether the shapes overlap.
    pub(super) cutoff: f64,
    /// Whether to stop at once when the centres coincide, with nothing known.
    pub(super) stop_at_same_centre: bool,
}

/// Runs GJK from the line of centres. The simplex it ends with is left in `simplex`.
pub(super) fn gjk<A: Support, B: Support>(
    shape: &Difference<A, B>,
    centre_a: Vec3,
    centre_b: Vec3,
    limits: &Limits,
    simplex: &mut Simplex,
) -> Closest {
    let wants_distance = limits.cutoff > 0.0;
    let mut may_test_tetrahedron = !wants_distance;
    let tolerance2 = limits.tolerance * limits.tolerance;

    let mut nearest = sub(centre_a, centre_b); // best point of the difference so far
    let mut weights = [1.0, 0.0, 0.0, 0.0];
    let mut count = 0;
    let mut iteration = 0;
    let apart = Closest {
        distance: BIG,
        a: centre_a,
        b: centre_b,
    };

    while iteration < limits.iterations {
        // farthest vertex towards the origin
        let length2 = dot(nearest, nearest);
        let at_origin = length2 <= MINVAL * MINVAL || length2.is_nan();
        let dir = if at_origin {
            [-1.0, 0.0, 0.0]
        } else {
            scale(scale(nearest, 1.0 / length2.sqrt()), -1.0)
        };
        simplex.vertices[count] = shape.support(dir);
        let newest = simplex.vertices[count].point;

        // no vertex is much nearer
        let may_stop = iteration > 0 || !at_origin || limits.stop_at_same_centre;
        if may_stop && 2.0 * dot(nearest, sub(nearest, newest)) < tolerance2 {
            if iteration == 0 {
                count = 1;
            }
            break;
        }

        // a plane across the direction keeps the shapes apart
        let overlap = dot(nearest, newest);
        if overlap > 0.0 {
            let decided = if wants_distance {
                limits.cutoff < BIG && overlap * overlap / dot(nearest, nearest) >= limits.cutoff * limits.cutoff
            } else {
                true
            };
            if decided {
                simplex.len = 0;
                return apart;
            }
        }

        // a first tetrahedron is moved towards the origin as a whole
        if count == 3 && may_test_tetrahedron {
            match enclose_origin(shape, simplex, &mut iteration, limits.iterations) {
                Enclosure::Inside => {
                    simplex.len = 4;
                    return Closest { distance: 0.0, ..apart };
                }
                Enclosure::Outside => {
                    simplex.len = 0;
                    return apart;
                }
                Enclosure::Unknown => may_test_tetrahedron = false,
            }
        }

        // nearest point of the simplex; vertices without weight go
        weights = simplex_weights(&simplex.vertices, count + 1);
        count = 0;
        for k in 0..4 {
            if weights[k] != 0.0 {
                if count != k {
                    simplex.vertices[count] = simplex.vertices[k];
                    weights[count] = weights[k];
                }
                count += 1;
            }
        }
        let next = combine(&weights, &simplex.vertices, count, |v| v.point).unwrap_or([0.0; 3]);
        if (0..3).all(|k| (next[k] - nearest[k]).abs() < MINVAL) {
            break;
        }
        nearest = next;
        if count == 4 {
            break;
        }
        iteration += 1;
    }

    simplex.len = count;
    Closest {
        distance: norm(nearest),
        a: combine(&weights, &simplex.vertices, count, |v| v.a).unwrap_or(centre_a),
        b: combine(&weights, &simplex.vertices, count, |v| v.b).unwrap_or(centre_b),
    }
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

/// Weighted sum of one point of each of the first `count` vertices; `None` without vertices.
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

enum Enclosure {
    Inside,
    Outside,
    Unknown,
}

/// Moves a tetrahedron, vertex by vertex, until it holds the origin or a vertex shows that none can. The simplex is
/// changed only in the first case. Counts in `iteration`.
fn enclose_origin<A: Support, B: Support>(
    shape: &Difference<A, B>,
    simplex: &mut Simplex,
    iteration: &mut usize,
    iterations: usize,
) -> Enclosure {
    /// Corners of the face opposite each vertex, such that its normal points outwards.
    const FACES: [[usize; 3]; 4] = [[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]];
    let mut vertices = simplex.vertices;
    while *iteration < iterations {
        // signed distances of the faces from the origin
        let mut normals = [[0.0; 3]; 4];
        let mut distances = [0.0; 4];
        for (slot, [a, b, c]) in FACES.into_iter().enumerate() {
            let (a, b, c) = (vertices[a].point, vertices[b].point, vertices[c].point);
            let normal = cross(sub(c, a), sub(b, a));
            let length2 = dot(normal, normal);
            if length2 > MINVAL * MINVAL && length2 < BIG * BIG {
                normals[slot] = scale(normal, 1.0 / length2.sqrt());
                distances[slot] = dot(normals[slot], a);
            } else {
                normals[slot] = normal;
                distances[slot] = BIG;
            }
        }
        if distances.contains(&0.0) {
            return Enclosure::Unknown;
        }

        // the face the origin is farthest outside of
        let i = if distances[0] < distances[1] { 0 } else { 1 };
        let j = if distances[2] < distances[3] { 2 } else { 3 };
        let worst = if distances[i] < distances[j] { i } else { j };
        if distances[worst] > 0.0 {
            simplex.vertices = vertices;
            return Enclosure::Inside;
        }
        vertices[worst] = shape.support(normals[worst]);
        if dot(normals[worst], vertices[worst].point) < 0.0 {
            return Enclosure::Outside;
        }
        vertices.swap((worst + 1) & 3, (worst + 2) & 3); // keeps the normals outwards
        *iteration += 1;
    }
    Enclosure::Unknown
}
