//! Clipping of triangles at the view volume, as in Mesa's draw module.

use super::camera::{AffineRow, Vec3f, cross, dot};
use super::plane::Vertex;

/// A vertex in clip coordinates: x, y, depth, w.
pub type ClipVertex = [f32; 4];

/// A corner of a clipped triangle: one of its own, or a point on an edge.
#[derive(Clone, Copy, Debug)]
pub struct ClipCorner {
    pub clip: ClipVertex,
    pub from: CornerOrigin,
}

/// The origin of a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerOrigin {
    /// A corner of the triangle.
    Own(usize),
    /// A point on an edge: its index among the new points.
    New(usize),
}

/// A point that clipping created on an edge: `from + share (to - from)`.
#[derive(Clone, Copy, Debug)]
pub struct EdgePoint {
    pub clip: ClipVertex,
    pub from: CornerOrigin,
    pub to: CornerOrigin,
    pub share: f32,
}

/// Upper bounds: each of six planes adds at most one corner, and at most two points.
const MAX_CORNERS: usize = 10;
const MAX_POINTS: usize = 12;

/// A clipped triangle.
pub struct Polygon {
    pub corners: [ClipCorner; MAX_CORNERS],
    pub count: usize,
    pub points: [EdgePoint; MAX_POINTS],
    pub point_count: usize,
}

/// Returns one bit for each clipping plane that a vertex lies beyond.
#[inline(always)]
pub fn outside([x, y, z, w]: ClipVertex) -> u32 {
    u32::from(x > w)
        | u32::from(x + w < 0.0) << 1
        | u32::from(y > w) << 2
        | u32::from(y + w < 0.0) << 3
        | u32::from(z < 0.0) << 4
        | u32::from(z > w) << 5
}

/// The relation of a box to the view volume, valid for any rounding of the projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrustumTest {
    /// All of it lies beyond one clipping plane.
    Outside,
    /// All of it is in view.
    Inside,
    /// It may be cut.
    Across,
}

/// Tests a box that is projected by `rows` against the view volume.
pub fn place(rows: &[AffineRow; 4], low: Vec3f, high: Vec3f) -> FrustumTest {
    // far above the rounding error of a sum of four products, relative to the sum of their magnitudes
    const SAFE: f32 = 1e-5;
    let [x, y, z, w] = rows;
    // positive beyond the plane: a row with its sign, and whether w is subtracted
    let planes = [
        (x, 1.0, 1.0),
        (x, -1.0, 1.0),
        (y, 1.0, 1.0),
        (y, -1.0, 1.0),
        (z, -1.0, 0.0),
        (z, 1.0, 1.0),
    ];
    let mut within = true;
    for (row, sign, by) in planes {
        // the extremes of a linear function over a box, one coordinate at a time
        let mut least = sign * row[3] - by * w[3];
        let mut greatest = least;
        let mut size = row[3].abs() + w[3].abs();
        for k in 0..3 {
            let slope = sign * row[k] - by * w[k];
            least += (slope * low[k]).min(slope * high[k]);
            greatest += (slope * low[k]).max(slope * high[k]);
            size += (row[k].abs() + w[k].abs()) * low[k].abs().max(high[k].abs());
        }
        if least > SAFE * size {
            return FrustumTest::Outside;
        }
        within &= greatest < -SAFE * size;
    }
    if within {
        FrustumTest::Inside
    } else {
        FrustumTest::Across
    }
}

/// Returns the signed distance from a clipping plane; planes are numbered as the bits of [`outside`].
fn distance(plane: usize, [x, y, z, w]: ClipVertex) -> f32 {
    match plane {
        0 => w - x,
        1 => x + w,
        2 => w - y,
        3 => y + w,
        4 => z,
        _ => w - z,
    }
}

impl Polygon {
    pub fn new(triangle: [ClipVertex; 3]) -> Self {
        let own = |k: usize| ClipCorner {
            clip: triangle[k],
            from: CornerOrigin::Own(k),
        };
        let none = EdgePoint {
            clip: [0.0; 4],
            from: CornerOrigin::Own(0),
            to: CornerOrigin::Own(0),
            share: 0.0,
        };
        let mut corners = [own(0); MAX_CORNERS];
        (corners[1], corners[2]) = (own(1), own(2));
        Self {
            corners,
            count: 3,
            points: [none; MAX_POINTS],
            point_count: 0,
        }
    }

    /// Cuts off the parts beyond the planes of `sides`. The result may be empty.
    pub fn cut(&mut self, sides: u32) {
        for plane in 0..6 {
            if sides & (1 << plane) != 0 {
                self.cut_at(plane);
            }
        }
    }

    /// Returns the corners and the new points.
    pub fn parts(&self) -> (&[ClipCorner], &[EdgePoint]) {
        (&self.corners[..self.count], &self.points[..self.point_count])
    }

    fn cut_at(&mut self, plane: usize) {
        // Sutherland and Hodgman's algorithm: the polygon is cut by one plane after the other, each time walking
        // around its edges
        let mut source = [self.corners[0]; MAX_CORNERS];
        let kept = self.count;
        source[..kept].copy_from_slice(&self.corners[..kept]);
        self.count = 0;
        for k in 0..kept {
            let (p, q) = (source[k], source[if k + 1 < kept { k + 1 } else { 0 }]);
            let (a, b) = (distance(plane, p.clip), distance(plane, q.clip));
            // an infinite vertex has no crossing to interpolate
            if !(a.is_finite() && b.is_finite()) {
                self.count = 0;
                return;
            }
            // a corner on the plane is kept, so that an edge in it is not cut away
            if a >= 0.0 {
                self.push(p);
            }
            if (a >= 0.0) != (b >= 0.0) && self.point_count < MAX_POINTS {
                let point = crossing((p, a), (q, b));
                self.points[self.point_count] = point;
                self.point_count += 1;
                self.push(ClipCorner {
                    clip: point.clip,
                    from: CornerOrigin::New(self.point_count - 1),
                });
            }
        }
    }

    fn push(&mut self, corner: ClipCorner) {
        if self.count < MAX_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

/// Returns whether a triangle certainly faces away from the camera and is therefore invisible.
pub fn faces_away(&[a, b, c]: &[ClipVertex; 3]) -> bool {
    // far above rounding: triangles that are nearly edge-on are left to the rasteriser, whose integers decide exactly
    const CLEAR: f32 = 1e-3;
    // the triple product of (x, y, w) tells which side is in front without a division, also where a corner is behind
    // the camera (Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", Graphics Hardware 1997)
    let flat = |v: ClipVertex| [v[0], v[1], v[3]];
    let (a, b, c) = (flat(a), flat(b), flat(c));
    let minus = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let normal = cross(minus(b, a), minus(c, a));
    let away = dot(normal, a);
    away < 0.0 && away * away > CLEAR * CLEAR * dot(normal, normal) * dot(a, a)
}

/// Returns the point where an edge crosses a plane, interpolated from the end that is nearer to the plane.
fn crossing((p, a): (ClipCorner, f32), (q, b): (ClipCorner, f32)) -> EdgePoint {
    // from the nearer end, as Mesa does it: two triangles that share the edge walk it in opposite directions, and
    // must find the same point
    let difference = b - a;
    // distances have different signs
    let ((from, to), share) = if b.abs() < a.abs() {
        ((q, p), b / difference)
    } else {
        ((p, q), -a / difference)
    };
    EdgePoint {
        clip: lerp(from.clip, to.clip, share),
        from: from.from,
        to: to.from,
        share,
    }
}

/// Computes `from + share (to - from)`.
pub fn lerp<const N: usize>(from: [f32; N], to: [f32; N], share: f32) -> [f32; N] {
    let mut out = from;
    for (o, t) in out.iter_mut().zip(to) {
        *o += share * (t - *o);
    }
    out
}

/// Projects a point created by clipping.
pub fn project([x, y, z, w]: ClipVertex, half: [f32; 2]) -> Vertex {
    let iw = 1.0 / w;
    Vertex {
        // from -1..1 to pixels in the order of Mesa's viewport transform, since another order falls on another 1/256
        // of a pixel
        x: (x * iw) * half[0] + half[0],
        y: (y * iw) * half[1] + half[1],
        z: z * iw,
        iw,
    }
}

/// Applies the rows of a projection.
#[inline(always)]
pub fn apply(rows: &[AffineRow; 4], [x, y, z]: [f32; 3]) -> ClipVertex {
    let row = |r: &AffineRow| x * r[0] + y * r[1] + z * r[2] + r[3];
    [row(&rows[0]), row(&rows[1]), row(&rows[2]), row(&rows[3])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_lies_within() {
        let cut = |triangle: [ClipVertex; 3], sides: u32| {
            let mut polygon = Polygon::new(triangle);
            polygon.cut(sides);
            polygon
        };
        let triangle = [[-3.0, -3.0, 0.5, 1.0], [3.0, -3.0, 0.5, 1.0], [0.0, 3.0, 0.5, 1.0]];
        let polygon = cut(triangle, triangle.iter().fold(0, |m, &v| m | outside(v)));
        let (corners, points) = polygon.parts();
        assert!(corners.len() >= 3 && !points.is_empty());
        for corner in corners {
            let [x, y, _, w] = corner.clip;
            assert!(x.abs() <= w + 1e-6 && y.abs() <= w + 1e-6);
        }
        let beyond = triangle.map(|[x, y, z, w]| [x + 9.0, y, z, w]);
        assert!(cut(beyond, 1).parts().0.is_empty());
        assert!(cut([[f32::NAN; 4]; 3], 63).parts().0.is_empty());
    }

    #[test]
    fn boxes_are_outside_if_all_their_corners_are() {
        let rows = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.5],
            [0.0, 0.0, 1.0, 3.0],
        ];
        let at = |x: f32| place(&rows, [x, -1.0, -1.0], [x + 2.0, 1.0, 1.0]);
        for (x, expected) in [
            (-1.0, FrustumTest::Inside),
            (0.5, FrustumTest::Across),
            (3.9, FrustumTest::Across),
            (4.1, FrustumTest::Outside),
            (-5.9, FrustumTest::Across),
            (-6.1, FrustumTest::Outside),
        ] {
            assert_eq!(at(x), expected, "{x}");
        }
        assert_eq!(place(&[[f32::NAN; 4]; 4], [0.0; 3], [1.0; 3]), FrustumTest::Across);
    }

    #[test]
    fn backs_are_known() {
        let front = [[-1.0, -1.0, 0.5, 1.0], [1.0, -1.0, 0.5, 1.0], [0.0, 1.0, 0.5, 1.0]];
        let [a, b, c] = front;
        assert!(!faces_away(&front) && faces_away(&[a, c, b]));
    }
}
